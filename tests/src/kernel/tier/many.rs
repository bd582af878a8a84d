//! Many devices, much load, and cables that do not stay in.

use super::Claim;

pub(super) const CLAIMS: &[Claim] = &[];
