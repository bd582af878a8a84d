//! The serial line a device hangs on.

use super::is_default;
use serde::{Deserialize, Serialize};

/// A line's speed and manners.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Bits per second, after whatever handshake there is.
    pub baud: u32,
    /// None unless said.
    #[serde(default, skip_serializing_if = "is_default")]
    pub parity: Parity,
    /// 8 unless said.
    #[serde(default = "eight", skip_serializing_if = "is_eight")]
    pub data_bits: u8,
    /// 1 unless said.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub stop_bits: u8,
    /// Whether both sides hold each other up by RTS and CTS.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rts_cts: bool,
    /// Silence after opening, milliseconds: boards that start anew when a port is opened need it.
    #[serde(default, skip_serializing_if = "is_default")]
    pub boot_wait_ms: u32,
}

/// The bit that is sent beside the data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Parity {
    /// There is none.
    #[default]
    None,
    /// It makes the number of ones odd.
    Odd,
    /// It makes the number of ones even.
    Even,
}

fn eight() -> u8 {
    8
}

fn one() -> u8 {
    1
}

// serde hands over references.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_eight(bits: &u8) -> bool {
    *bits == eight()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_one(bits: &u8) -> bool {
    *bits == one()
}
