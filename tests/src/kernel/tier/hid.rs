//! Input devices one at a time: found, made to report, heard exactly, shown to, refused to others.

use super::Claim;

pub(super) const CLAIMS: &[Claim] = &[];
