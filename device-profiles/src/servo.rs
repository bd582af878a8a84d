//! Servos: the control table with its units, limits and start values, row by row as the maker prints it.

use crate::Status;
use crate::read::{Check, Flaw};
use serde::{Deserialize, Serialize};

/// One servo model. Names of registers are the e-manual's ("Goal Position", "Torque Enable").
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ServoProfile {
    /// The file's name without its ending; what programs ask for.
    #[serde(skip)]
    pub key: String,
    /// As printed on the case.
    pub name: String,
    /// How far it was tried.
    pub status: Status,
    /// Where the numbers are from.
    pub source: String,
    /// The language on the wire.
    pub protocol: ServoProtocol,
    /// What a ping answers and register "Model Number" holds.
    pub model_number: u16,
    /// The firmware version whose table this is.
    pub firmware: u8,
    /// Counts of "Present Position" in one turn of the horn.
    pub counts_per_turn: u32,
    /// The count in the middle of the position range.
    pub centre_counts: i32,
    /// Line speeds in baud; the index is the value of register "Baud Rate".
    pub bauds: Vec<u32>,
    /// First firmware with register "Bus Watchdog" working; absent: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bus_watchdog_from_firmware: Option<u8>,
    /// First firmware that answers Fast Sync Read; absent: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fast_sync_read_from_firmware: Option<u8>,
    /// The control table, addresses ascending.
    pub registers: Vec<Register>,
}

/// The language a servo speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ServoProtocol {
    /// ROBOTIS DYNAMIXEL protocol 2.0.
    Dynamixel2,
}

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
    /// Bytes of one value: 1, 2 or 4, low byte first.
    pub size: u8,
    /// Values in a row; more than one only for the indirect blocks.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub count: u16,
    /// The e-manual's name.
    pub name: String,
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

impl ServoProfile {
    /// The row of that name, exactly as the e-manual spells it.
    pub fn register(&self, name: &str) -> Option<&Register> {
        self.registers.iter().find(|r| r.name == name)
    }

    /// The row that covers `address`, if any.
    pub fn register_at(&self, address: u16) -> Option<&Register> {
        self.registers
            .iter()
            .find(|r| r.address <= address && u32::from(address) < r.end())
    }

    /// Radians at the horn for one count of position.
    pub fn rad_per_count(&self) -> f64 {
        std::f64::consts::TAU / f64::from(self.counts_per_turn)
    }

    /// Radians per second for one count of "Present Velocity"; 0 if the table has no such row or unit.
    pub fn rad_per_s_per_count(&self) -> f64 {
        self.register("Present Velocity")
            .and_then(|r| r.unit_per_count)
            .unwrap_or(0.0)
    }

    /// The value of register "Baud Rate" for a line speed, if the servo has it.
    pub fn baud_code(&self, baud: u32) -> Option<u8> {
        let at = self.bauds.iter().position(|&b| b == baud)?;
        u8::try_from(at).ok()
    }

    /// One past the table's last byte.
    pub fn table_bytes(&self) -> usize {
        self.registers.iter().map(Register::end).max().unwrap_or(0) as usize
    }
}

impl Register {
    /// Bytes of the whole row.
    pub fn bytes(&self) -> u16 {
        u16::from(self.size).saturating_mul(self.count)
    }

    /// One past the last byte; wider than an address, so that a wrong file cannot overflow it.
    fn end(&self) -> u32 {
        u32::from(self.address) + u32::from(self.bytes())
    }
}

impl Check for ServoProfile {
    fn flaws(&self, flaws: &mut Vec<Flaw>) {
        self.flaws_of_head(flaws);
        for (at, row) in self.registers.iter().enumerate() {
            let end_before = if at == 0 { 0 } else { self.registers[at - 1].end() };
            self.flaws_of_row(row, end_before, flaws);
        }
    }
}

impl ServoProfile {
    fn flaws_of_head(&self, flaws: &mut Vec<Flaw>) {
        if self.counts_per_turn == 0 {
            flaws.push(Flaw::at_key(
                "counts_per_turn",
                "counts_per_turn must be at least 1, found 0",
            ));
        }
        if self.bauds.is_empty() {
            flaws.push(Flaw::at_key(
                "bauds",
                "bauds must list at least one line speed, found none",
            ));
        }
        if self.registers.is_empty() {
            flaws.push(Flaw::at_key(
                "registers",
                "registers must have at least one row, found none",
            ));
        }
    }

    fn flaws_of_row(&self, row: &Register, end_before: u32, flaws: &mut Vec<Flaw>) {
        let mut flaw =
            |message: String| flaws.push(Flaw::at_text(format!("name = \"{}\"", row.name), message));
        let name = &row.name;
        if ![1, 2, 4].contains(&row.size) || row.count == 0 {
            flaw(format!(
                "\"{name}\" must have size 1, 2 or 4 and a count of at least 1, found {} × {}",
                row.size, row.count
            ));
        }
        if u32::from(row.address) < end_before {
            flaw(format!(
                "\"{name}\" at {} overlaps the row before it, which ends at {end_before}",
                row.address
            ));
        }
        if row.end() > 0x1_0000 {
            flaw(format!(
                "\"{name}\" ends at {}, beyond the last address 65535",
                row.end()
            ));
        }
        if self.registers.iter().filter(|r| r.name == row.name).count() > 1 {
            flaw(format!(
                "\"{name}\" occurs more than once; names of registers must differ"
            ));
        }
        if row.unit.is_some_and(|u| u != Unit::Bits) != row.unit_per_count.is_some() {
            flaw(format!(
                "\"{name}\" must have both unit and unit_per_count, or neither (bits: unit alone)"
            ));
        }
        if row.unit_per_count.is_some_and(|k| !(k.is_finite() && k > 0.0)) {
            flaw(format!("\"{name}\" must have a finite unit_per_count above 0"));
        }
        if let (Some(min), Some(max)) = (row.min, row.max)
            && min > max
        {
            flaw(format!("\"{name}\" has min {min} above max {max}"));
        }
        let named = [&row.min_register, &row.max_register, &row.magnitude_register];
        for other in named.into_iter().flatten().filter(|o| self.register(o).is_none()) {
            flaw(format!(
                "\"{name}\" is bounded by \"{other}\", which the table does not have"
            ));
        }
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
