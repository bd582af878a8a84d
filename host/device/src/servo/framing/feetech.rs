//! Building Feetech packets, STS and SCS: the frame of Dynamixel 1.0 with instructions of its own.
//!
//! Sources: Feetech's `INST.h` and the users' protocol notes named in `docs/protocols/feetech.md`. The two families
//! differ in what the bytes of a word mean, which is the registers' matter, and in that SCS has no sync read and no
//! calibration. The way back is [`super::decoder`].

use super::error::FramingError;
use super::instruction::{Instruction, code, servo_id};
use super::summed;
use device_profiles::ServoProtocol;

pub use super::dynamixel1::{
    ID_MAX, INSTRUCTION_OVERHEAD_BYTES, STATUS_OVERHEAD_BYTES, action, checksum, encode, ping, read,
    reg_write, sync_write, write,
};

const THIS: ServoProtocol = ServoProtocol::Sts;

/// Appends a sync read of `length` bytes from `address`: each of `ids` answers in this order. STS only.
pub fn sync_read(
    out: &mut Vec<u8>,
    address: u8,
    length: u8,
    ids: impl IntoIterator<Item = u8>,
) -> Result<(), FramingError> {
    summed::sync_read(out, address, length, ids)
}

/// Appends what brings factory settings back but for the id.
pub fn recovery(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    alone(out, id, Instruction::FactoryReset)
}

/// Appends a reboot, which is not answered and takes about 0.8 s.
pub fn reboot(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    alone(out, id, Instruction::Reboot)
}

/// Appends what keeps a copy of the settings.
pub fn backup(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    alone(out, id, Instruction::Backup)
}

/// Appends what forgets the turns counted.
pub fn reset(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    alone(out, id, Instruction::Clear)
}

/// Appends what makes the present position the middle of the turn, 2048. STS from firmware 3.10.
pub fn calibrate(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    alone(out, id, Instruction::Calibrate)
}

fn alone(out: &mut Vec<u8>, id: u8, instruction: Instruction) -> Result<(), FramingError> {
    summed::encode(out, servo_id(THIS, id)?, code(THIS, instruction)?, &[])
}
