//! Firmware whose table differs from the one a profile gives in full.

use super::{Register, ServoProfile};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// What is different in a range of firmware versions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// First and last version it holds for, both included.
    pub firmware: [u8; 2],
    /// Names of rows this firmware lacks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub removed: Vec<String>,
    /// Rows that take the place of those with their name, or are added.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub registers: Vec<Register>,
}

impl Variant {
    /// Whether a firmware has these rows.
    pub fn covers(&self, firmware: u8) -> bool {
        (self.firmware[0]..=self.firmware[1]).contains(&firmware)
    }

    pub(super) fn applied(&self, table: &[Register]) -> Vec<Register> {
        let goes = |row: &Register| {
            self.removed.contains(&row.name) || self.registers.iter().any(|r| r.name == row.name)
        };
        let kept = table.iter().filter(|row| !goes(row));
        let mut rows: Vec<Register> = kept.chain(&self.registers).cloned().collect();
        rows.sort_by_key(|row| row.address);
        rows
    }
}

impl ServoProfile {
    /// The profile as one firmware version has it: every variant that covers it applied, in the file's order.
    pub fn at_firmware(&self, firmware: u8) -> Cow<'_, Self> {
        let mut covering = self.variants.iter().filter(|v| v.covers(firmware)).peekable();
        if firmware == self.firmware || covering.peek().is_none() {
            return Cow::Borrowed(self);
        }
        let mut own = self.clone();
        own.firmware = firmware;
        own.registers = covering.fold(own.registers, |rows, variant| variant.applied(&rows));
        Cow::Owned(own)
    }
}
