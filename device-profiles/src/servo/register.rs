//! One row of a control table: where it lies, what a count of it means, what may be written to it.

use super::Role;
use serde::{Deserialize, Serialize};

/// Where a register lives: EEPROM survives power-off and refuses writes while torque is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Area {
    /// Kept without power; wears out; locked while torque is on.
    Eeprom,
    /// Start value at every power-up.
    Ram,
}

/// What a host may do with a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Access {
    /// Read only.
    R,
    /// Read and write.
    Rw,
}

/// The SI unit that one count is a multiple of (see [`Register::unit_per_count`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unit {
    /// Radians at the horn.
    #[serde(rename = "rad")]
    Radian,
    /// Radians per second at the horn.
    #[serde(rename = "rad/s")]
    RadianPerSecond,
    /// Radians per second squared at the horn.
    #[serde(rename = "rad/s2")]
    RadianPerSecondSquared,
    /// Seconds.
    #[serde(rename = "s")]
    Second,
    /// Volts.
    #[serde(rename = "V")]
    Volt,
    /// Volts per second.
    #[serde(rename = "V/s")]
    VoltPerSecond,
    /// Amperes.
    #[serde(rename = "A")]
    Ampere,
    /// Degrees Celsius.
    #[serde(rename = "C")]
    Celsius,
    /// 1 is all there is.
    #[serde(rename = "ratio")]
    Ratio,
    /// A bit field; no factor.
    #[serde(rename = "bits")]
    Bits,
}

impl std::fmt::Display for Unit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Radian => "rad",
            Self::RadianPerSecond => "rad/s",
            Self::RadianPerSecondSquared => "rad/s2",
            Self::Second => "s",
            Self::Volt => "V",
            Self::VoltPerSecond => "V/s",
            Self::Ampere => "A",
            Self::Celsius => "C",
            Self::Ratio => "ratio",
            Self::Bits => "bits",
        })
    }
}

/// One row of a control table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Register {
    /// First byte.
    pub address: u16,
    /// Bytes of one value: 1, 2 or 4, in the servo's word order.
    pub size: u8,
    /// Values in a row; more than one only for the indirect blocks.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub count: u16,
    /// The maker's name.
    pub name: String,
    /// What it is for, if hosts need to find it; at most one row has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<Role>,
    /// EEPROM or RAM.
    pub area: Area,
    /// Read only or read and write.
    pub access: Access,
    /// What one count measures; absent for pure numbers and switches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// How many of `unit` one count is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit_per_count: Option<f64>,
    /// Two's complement in `size` bytes.
    #[serde(default, skip_serializing_if = "is_false")]
    pub signed: bool,
    /// Sign and magnitude: this bit set means negative, the bits below it are the magnitude.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sign_bit: Option<u8>,
    /// Factory value (EEPROM) or value at power-up (RAM); absent: the document gives none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub init: Option<i64>,
    /// For `count > 1`: how much each further value starts above the one before.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub init_step: i64,
    /// Smallest legal value, counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<i64>,
    /// Largest legal value, counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<i64>,
    /// The only legal values, where they are not a range.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<i64>,
    /// Register whose present value is the smallest legal one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_register: Option<String>,
    /// Register whose present value is the largest legal one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_register: Option<String>,
    /// Register whose present value bounds this one's magnitude.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub magnitude_register: Option<String>,
}

impl Register {
    /// Bytes of the whole row.
    pub fn bytes(&self) -> u16 {
        u16::from(self.size).saturating_mul(self.count)
    }

    /// One past the last byte; wider than an address, so that a wrong file cannot overflow it.
    pub(super) fn end(&self) -> u32 {
        u32::from(self.address) + u32::from(self.bytes())
    }
}

fn one() -> u16 {
    1
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands references to `skip_serializing_if`"
)]
fn is_one(count: &u16) -> bool {
    *count == 1
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands references to `skip_serializing_if`"
)]
fn is_zero(step: &i64) -> bool {
    *step == 0
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands references to `skip_serializing_if`"
)]
fn is_false(flag: &bool) -> bool {
    !*flag
}
