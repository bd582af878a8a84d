//! One line of a journal.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use crate::command::Command;
use crate::controls_calibration::ControlsCalibration;
use crate::ports::Found;

/// Version of the journal's lines.
pub(crate) const VERSION: u32 = 1;

/// One line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Record {
    /// First line: what the rig was started with.
    Start {
        /// Version of the lines.
        version: u32,
        /// Files of the show, name to text.
        show: BTreeMap<String, String>,
    },
    /// What was calibrated on input devices, by what they are known by; not there where nothing was.
    Calibrated {
        /// All of it.
        devices: BTreeMap<String, ControlsCalibration>,
    },
    /// A step begins.
    Step {
        /// Machine time, nanoseconds.
        now: u64,
        /// Commands given to this step.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        commands: Vec<Command>,
    },
    /// A port was opened, or not.
    Open {
        /// Where.
        address: String,
        /// Number of the opening, counted over all ports.
        port: u32,
        /// Whether each read is one report.
        #[serde(default, skip_serializing_if = "is_false")]
        reports: bool,
        /// Why not, if it failed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        failed: Option<Failure>,
    },
    /// What is plugged in has changed.
    Listed {
        /// Which listing it was, from 0; those that found the same as the one before are not written down.
        call: u64,
        /// All that is there.
        found: Vec<Found>,
    },
    /// A read returned bytes.
    Read {
        /// Number of the opening.
        port: u32,
        /// Which read of this port it was, from 0; reads that returned nothing are not written down.
        call: u64,
        /// The bytes, two hexadecimal digits each.
        hex: String,
        /// When its last byte arrived, nanoseconds of machine time, where that was noted.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<u64>,
    },
    /// A question beside the reads was answered: a feature report, a string or the report descriptor.
    Answer {
        /// Number of the opening.
        port: u32,
        /// Which question of this port it was, from 0; those that were not answered yet are not written down.
        call: u64,
        /// The answer, two hexadecimal digits a byte.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        hex: Option<String>,
        /// Or how it failed. Setting a feature report is a question whose answer is empty.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        failure: Option<Failure>,
    },
    /// A read or write failed.
    Fail {
        /// Number of the opening.
        port: u32,
        /// Which read or write of this port it was.
        call: u64,
        /// Whether it was a write.
        write: bool,
        /// How it failed.
        failure: Failure,
    },
    /// Last line: what came out, as digests.
    End(Ending),
}

// The shape `skip_serializing_if` wants.
#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde calls it with a reference"
)]
fn is_false(flag: &bool) -> bool {
    !flag
}

/// How an operation on a port failed, as far as a replay needs to know.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Failure {
    /// The device is gone.
    Gone,
    /// Anything else, in words.
    Other(String),
}

/// Digests of what the rig produced.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ending {
    /// Number of steps.
    pub steps: u64,
    /// Digest over all snapshots.
    pub snapshots: String,
    /// Digest over the bytes written to each port: `NUMBER ADDRESS` to digest.
    pub written: BTreeMap<String, String>,
}

/// A running SHA-256.
#[derive(Clone, Debug, Default)]
pub struct Digest(Sha256);

impl Digest {
    /// Takes in bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Takes in a number, exactly.
    pub fn real(&mut self, value: f64) {
        self.bytes(&value.to_bits().to_le_bytes());
    }

    /// Takes in a text with its length, so that neighbours cannot run together.
    pub fn text(&mut self, text: &str) {
        self.bytes(&(text.len() as u64).to_le_bytes());
        self.bytes(text.as_bytes());
    }

    /// The digest so far, 64 hexadecimal digits.
    pub fn hex(&self) -> String {
        to_hex(&self.0.clone().finalize())
    }
}

pub(crate) fn to_hex(bytes: &[u8]) -> String {
    const DIGITS: [char; 16] = [
        '0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'a', 'b', 'c', 'd', 'e', 'f',
    ];
    bytes
        .iter()
        .flat_map(|b| [DIGITS[usize::from(b >> 4)], DIGITS[usize::from(b & 15)]])
        .collect()
}

pub(crate) fn from_hex(hex: &str) -> Option<Vec<u8>> {
    let digits: Option<Vec<u8>> = hex.chars().map(|c| c.to_digit(16).map(|d| d as u8)).collect();
    let digits = digits?;
    (digits.len() % 2 == 0).then(|| digits.chunks_exact(2).map(|d| d[0] << 4 | d[1]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_is_read_back() {
        let bytes: Vec<u8> = (0..=255).collect();
        assert_eq!(from_hex(&to_hex(&bytes)), Some(bytes));
        assert_eq!(from_hex("0"), None);
        assert_eq!(from_hex("zz"), None);
    }

    #[test]
    fn texts_do_not_run_together() {
        let (mut a, mut b) = (Digest::default(), Digest::default());
        a.text("ab");
        a.text("c");
        b.text("a");
        b.text("bc");
        assert_ne!(a.hex(), b.hex());
    }
}
