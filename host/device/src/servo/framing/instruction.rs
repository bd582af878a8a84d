//! What can be asked of servos, under one name for all protocols, and the byte that says it in each.
//!
//! Sources: ROBOTIS e-manual, "DYNAMIXEL Protocol 1.0" and "2.0"; Feetech's `INST.h` and protocol notes.
//! `docs/protocols/` has the facts.

use super::error::FramingError;
use device_profiles::ServoProtocol;
use std::fmt;

/// What a packet asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instruction {
    /// Answered whatever the status return level.
    Ping,
    /// One block of one servo.
    Read,
    /// One block of one servo, at once.
    Write,
    /// One block of one servo, carried out by the next action.
    RegWrite,
    /// Carries out what was registered.
    Action,
    /// Back to factory settings; see [`Keep`].
    FactoryReset,
    /// On Dynamixel the only instruction that ends a shutdown.
    Reboot,
    /// Forgets turns.
    Clear,
    /// Keeps or restores the EEPROM; see [`Backup`].
    Backup,
    /// Makes the present position the middle (Feetech STS).
    Calibrate,
    /// The same block of several servos, answered one after another.
    SyncRead,
    /// The same block of several servos, unanswered.
    SyncWrite,
    /// As sync read, answered in a single packet.
    FastSyncRead,
    /// A block of its own from each servo.
    BulkRead,
    /// A block of its own to each servo.
    BulkWrite,
    /// As bulk read, answered in a single packet.
    FastBulkRead,
}

impl fmt::Display for Instruction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ping => "ping",
            Self::Read => "read",
            Self::Write => "write",
            Self::RegWrite => "reg write",
            Self::Action => "action",
            Self::FactoryReset => "factory reset that keeps so much",
            Self::Reboot => "reboot",
            Self::Clear => "clear",
            Self::Backup => "such backup",
            Self::Calibrate => "calibration",
            Self::SyncRead => "sync read",
            Self::SyncWrite => "sync write",
            Self::FastSyncRead => "fast sync read",
            Self::BulkRead => "bulk read",
            Self::BulkWrite => "bulk write",
            Self::FastBulkRead => "fast bulk read",
        })
    }
}

/// What a factory reset leaves alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Nothing. Protocol 2.0 (a broadcast of it is ignored from firmware 42 on) and 1.0.
    Nothing,
    /// The id. Protocol 2.0 and Feetech.
    Id,
    /// Id and line speed. Protocol 2.0 alone.
    IdAndBaud,
}

/// Which way a backup goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Backup {
    /// From the control table to the copy.
    Store,
    /// From the copy to the control table; the servo reboots. Protocol 2.0 alone.
    Restore,
}

/// Highest id a servo can have: 252 in protocol 2.0, where 253 and 255 are unused; 253 in the others.
pub const fn id_max(protocol: ServoProtocol) -> u8 {
    match protocol {
        ServoProtocol::Dynamixel2 => super::dynamixel2::ID_MAX,
        ServoProtocol::Dynamixel1 | ServoProtocol::Sts | ServoProtocol::Scs => super::dynamixel1::ID_MAX,
    }
}

/// Whether a protocol has an instruction at all; single models and firmwares may still lack it.
pub fn has(protocol: ServoProtocol, instruction: Instruction) -> bool {
    code(protocol, instruction).is_ok()
}

/// The instruction byte.
pub(super) fn code(protocol: ServoProtocol, instruction: Instruction) -> Result<u8, FramingError> {
    use Instruction as I;
    use ServoProtocol::{Dynamixel1, Dynamixel2, Scs, Sts};
    let code = match (instruction, protocol) {
        (I::Ping, _) => 0x01,
        (I::Read, _) => 0x02,
        (I::Write, _) => 0x03,
        (I::RegWrite, _) => 0x04,
        (I::Action, _) => 0x05,
        (I::FactoryReset, _) => 0x06,
        (I::Reboot, Dynamixel2 | Sts | Scs) => 0x08,
        (I::Clear, Dynamixel2) => 0x10,
        (I::Clear, Sts | Scs) => 0x0a,
        (I::Backup, Dynamixel2) => 0x20,
        (I::Backup, Sts | Scs) => 0x09,
        (I::Calibrate, Sts) => 0x0b,
        (I::SyncRead, Dynamixel2 | Sts) => 0x82,
        (I::SyncWrite, _) => 0x83,
        (I::FastSyncRead, Dynamixel2) => 0x8a,
        (I::BulkRead, Dynamixel2 | Dynamixel1) => 0x92,
        (I::BulkWrite, Dynamixel2) => 0x93,
        (I::FastBulkRead, Dynamixel2) => 0x9a,
        _ => {
            return Err(FramingError::Lacks {
                protocol,
                instruction,
            });
        }
    };
    Ok(code)
}

/// `id` if a servo can have it.
pub(super) fn servo_id(protocol: ServoProtocol, id: u8) -> Result<u8, FramingError> {
    let max = id_max(protocol);
    if id <= max {
        Ok(id)
    } else {
        Err(FramingError::NotAnId { id, max })
    }
}
