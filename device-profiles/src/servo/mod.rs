//! Servos: the control table with its units, limits and start values, row by row as the maker prints it.

mod check;
mod fault;
mod motor;
mod register;
mod role;
mod variant;

pub use fault::HardwareFault;
pub use motor::Motor;
pub use register::{Access, Area, Register, Unit};
pub use role::Role;
pub use variant::Variant;

use crate::Status;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One servo model. Registers keep the maker's names, for people; programs find them by [`Role`].
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
    /// How the bytes of a word follow each other; absent: low byte first.
    #[serde(default, skip_serializing_if = "WordOrder::is_little")]
    pub word_order: WordOrder,
    /// What its register with role `model-number` holds; on DYNAMIXEL a ping answers it too.
    pub model_number: u16,
    /// The firmware version whose table this is: the value with role `firmware-version`.
    pub firmware: u8,
    /// Counts of position in a whole turn of the horn, also where the servo turns only a part of one;
    /// not always a whole number.
    pub counts_per_turn: f64,
    /// The count in the middle of the position range.
    pub centre_counts: i32,
    /// First and last count that a goal may name in position mode.
    pub position_counts: [i64; 2],
    /// Line speeds in baud; without `baud_codes` the index is what the register with role `baud-rate` holds.
    pub bauds: Vec<u32>,
    /// The register's value for each of `bauds`, where that is not the index.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub baud_codes: Vec<u8>,
    /// Whether it answers a ping to all without garbling its neighbours' answers.
    pub broadcast_ping: bool,
    /// Whether it answers Sync Read.
    pub sync_read: bool,
    /// Whether it answers Bulk Read.
    pub bulk_read: bool,
    /// First firmware that answers Fast Sync Read; absent: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fast_sync_read_from_firmware: Option<u8>,
    /// First firmware whose register with role `bus-watchdog` works; absent: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bus_watchdog_from_firmware: Option<u8>,
    /// For this long after an EEPROM write, for each byte written, it hears nothing; absent: not known of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eeprom_deaf_us_per_byte: Option<u32>,
    /// Which bit stands for which fault, in the registers with roles `hardware-error` and `shutdown`; where the
    /// protocol is DYNAMIXEL 1.0 or Feetech's, in the error byte of every answer too.
    pub fault_bits: BTreeMap<HardwareFault, u8>,
    /// The control table, addresses ascending.
    pub registers: Vec<Register>,
    /// What motor and gears can do; absent: not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motor: Option<Motor>,
    /// Firmware with another table.
    #[serde(rename = "variant", default, skip_serializing_if = "Vec::is_empty")]
    pub variants: Vec<Variant>,
}

/// The language a servo speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ServoProtocol {
    /// ROBOTIS DYNAMIXEL protocol 2.0.
    Dynamixel2,
    /// ROBOTIS DYNAMIXEL protocol 1.0.
    Dynamixel1,
    /// Feetech's servos with magnetic encoders (STS, SMS, HLS): framing as DYNAMIXEL 1.0, instructions of their own.
    Sts,
    /// Feetech's servos with potentiometers (SCS): as STS, without group reads.
    Scs,
}

impl std::fmt::Display for ServoProtocol {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Dynamixel2 => "DYNAMIXEL 2.0",
            Self::Dynamixel1 => "DYNAMIXEL 1.0",
            Self::Sts => "Feetech STS",
            Self::Scs => "Feetech SCS",
        })
    }
}

/// How the bytes of a word follow each other on the wire and in the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WordOrder {
    /// Low byte first.
    #[default]
    Little,
    /// High byte first in each word of two bytes; of four bytes the low word comes first.
    /// (Source: LeRobot's tests: 0x12345678 is sent as 56 78 12 34.)
    Big,
}

impl WordOrder {
    #[allow(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands references to `skip_serializing_if`"
    )]
    fn is_little(&self) -> bool {
        *self == Self::Little
    }
}

impl ServoProfile {
    /// The row of that name, exactly as the file spells it.
    pub fn register(&self, name: &str) -> Option<&Register> {
        self.registers.iter().find(|r| r.name == name)
    }

    /// The row with that purpose, if the servo has one.
    pub fn role(&self, role: Role) -> Option<&Register> {
        self.registers.iter().find(|r| r.role == Some(role))
    }

    /// The row that bounds the speed of a move to a position: `profile-velocity`, or where there is only one
    /// speed for all modes `goal-velocity`.
    pub fn move_velocity(&self) -> Option<&Register> {
        self.role(Role::ProfileVelocity)
            .or_else(|| self.role(Role::GoalVelocity))
    }

    /// The row that bounds the acceleration of a move to a position.
    pub fn move_acceleration(&self) -> Option<&Register> {
        self.role(Role::ProfileAcceleration)
            .or_else(|| self.role(Role::GoalAcceleration))
    }

    /// How the bytes of a word follow each other.
    pub fn word_order(&self) -> WordOrder {
        self.word_order
    }

    /// The row that covers `address`, if any.
    pub fn register_at(&self, address: u16) -> Option<&Register> {
        self.registers
            .iter()
            .find(|r| r.address <= address && u32::from(address) < r.end())
    }

    /// Radians at the horn for one count of position.
    pub fn rad_per_count(&self) -> f64 {
        std::f64::consts::TAU / self.counts_per_turn
    }

    /// Radians per second for one count of present velocity; 0 if the table has no such row or unit.
    pub fn rad_per_s_per_count(&self) -> f64 {
        self.role(Role::PresentVelocity)
            .and_then(|r| r.unit_per_count)
            .unwrap_or(0.0)
    }

    /// What the register with role `baud-rate` holds for a line speed, if the servo has it.
    pub fn baud_code(&self, baud: u32) -> Option<u8> {
        let at = self.bauds.iter().position(|&b| b == baud)?;
        if self.baud_codes.is_empty() {
            u8::try_from(at).ok()
        } else {
            self.baud_codes.get(at).copied()
        }
    }

    /// The line speed for a value of the register with role `baud-rate`, if it stands for one.
    pub fn baud_of_code(&self, code: u8) -> Option<u32> {
        let at = if self.baud_codes.is_empty() {
            usize::from(code)
        } else {
            self.baud_codes.iter().position(|&known| known == code)?
        };
        self.bauds.get(at).copied()
    }

    /// The faults that a value of `hardware-error` tells of; bits without a meaning are left out.
    pub fn faults(&self, bits: u8) -> impl Iterator<Item = HardwareFault> + '_ {
        self.fault_bits
            .iter()
            .filter(move |&(_, &bit)| bits >> bit & 1 == 1)
            .map(|(&fault, _)| fault)
    }

    /// The bit that stands for a fault, alone in a byte; 0 where the servo has none for it.
    pub fn fault_mask(&self, fault: HardwareFault) -> u8 {
        self.fault_bits.get(&fault).map_or(0, |&bit| 1 << bit)
    }

    /// One past the table's last byte.
    pub fn table_bytes(&self) -> usize {
        self.registers.iter().map(Register::end).max().unwrap_or(0) as usize
    }
}
