//! Building Dynamixel Protocol 1.0 packets.
//!
//! Source: ROBOTIS e-manual, "DYNAMIXEL Protocol 1.0"; facts and decisions in `docs/protocols/dynamixel1.md`.
//! The way back is [`super::decoder`].

use super::error::FramingError;
use super::instruction::{Instruction, code, servo_id};
use super::summed::{self, Frame};
use device_profiles::ServoProtocol;

pub use super::summed::checksum;

/// Highest id a servo can have.
pub const ID_MAX: u8 = 253;
/// Bytes of a status packet around its data: header 2, id, length, error, sum.
pub const STATUS_OVERHEAD_BYTES: usize = 6;
/// Bytes of an instruction packet around its parameters: header 2, id, length, instruction, sum.
pub const INSTRUCTION_OVERHEAD_BYTES: usize = 6;

const THIS: ServoProtocol = ServoProtocol::Dynamixel1;

/// Appends one packet with any instruction byte; in a status packet that byte is the error.
pub fn encode(out: &mut Vec<u8>, id: u8, instruction: u8, params: &[u8]) -> Result<(), FramingError> {
    summed::encode(out, id, instruction, params)
}

/// Appends a ping.
pub fn ping(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    summed::encode(out, id, code(THIS, Instruction::Ping)?, &[])
}

/// Appends a read of `length` bytes from `address`.
pub fn read(out: &mut Vec<u8>, id: u8, address: u8, length: u8) -> Result<(), FramingError> {
    summed::encode(
        out,
        servo_id(THIS, id)?,
        code(THIS, Instruction::Read)?,
        &[address, length],
    )
}

/// Appends a write of `bytes` at `address`; a broadcast is obeyed by all and answered by none.
pub fn write(out: &mut Vec<u8>, id: u8, address: u8, bytes: &[u8]) -> Result<(), FramingError> {
    summed::at_address(out, id, code(THIS, Instruction::Write)?, address, bytes)
}

/// Appends a write that waits for [`action`].
pub fn reg_write(out: &mut Vec<u8>, id: u8, address: u8, bytes: &[u8]) -> Result<(), FramingError> {
    summed::at_address(out, id, code(THIS, Instruction::RegWrite)?, address, bytes)
}

/// Appends what sets off registered writes.
pub fn action(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    summed::encode(out, id, code(THIS, Instruction::Action)?, &[])
}

/// Appends a factory reset. The id becomes 1 and the line speed the factory's. ROBOTIS says that AX-12 does not
/// have it (DynamixelSDK#367).
pub fn factory_reset(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    summed::encode(
        out,
        servo_id(THIS, id)?,
        code(THIS, Instruction::FactoryReset)?,
        &[],
    )
}

/// Appends a sync write at `address`; the first servo's bytes give the width for all. Nobody answers it.
pub fn sync_write<Bytes: AsRef<[u8]>>(
    out: &mut Vec<u8>,
    address: u8,
    items: impl IntoIterator<Item = (u8, Bytes)>,
) -> Result<(), FramingError> {
    summed::sync_write(out, address, items)
}

/// Appends a bulk read: id, address and length for each servo. MX series only; a servo answers when it has heard
/// the one before.
pub fn bulk_read(
    out: &mut Vec<u8>,
    items: impl IntoIterator<Item = (u8, u8, u8)>,
) -> Result<(), FramingError> {
    let mut named = [false; 256];
    let mut frame = Frame::begin(out, super::BROADCAST_ID, code(THIS, Instruction::BulkRead)?).extend(&[0]);
    for (id, address, length) in items {
        if super::dynamixel2::is_second(&mut named, id) {
            return frame.fail(FramingError::Twice { id });
        }
        frame = frame.extend(&[length, id, address]);
    }
    frame.finish()
}
