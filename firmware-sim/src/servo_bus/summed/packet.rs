//! Protocol 1.0 and Feetech as bytes: numbers of instructions, error bits, status packets.
//!
//! Source: the maker's protocol 1.0 page; Feetech's `INST.h`.

use crate::servo_bus::heard::Refusal;

/// Every packet begins with two of these.
pub(in crate::servo_bus) const HEADER: u8 = 0xFF;
/// Largest number a servo may have.
pub(in crate::servo_bus) const ID_MAX: u8 = 253;
/// Bits of the DYNAMIXEL error byte that tell of the servo's state rather than of the instruction:
/// supply, heat, overload.
const STATE: u8 = 1 << 0 | 1 << 2 | 1 << 5;

/// Instruction numbers.
pub(in crate::servo_bus) mod instruction {
    pub(crate) const PING: u8 = 0x01;
    pub(crate) const READ: u8 = 0x02;
    pub(crate) const WRITE: u8 = 0x03;
    pub(crate) const REG_WRITE: u8 = 0x04;
    pub(crate) const ACTION: u8 = 0x05;
    /// Feetech calls it recovery.
    pub(crate) const FACTORY_RESET: u8 = 0x06;
    /// Feetech only, as the four below.
    pub(crate) const REBOOT: u8 = 0x08;
    pub(crate) const BACKUP: u8 = 0x09;
    pub(crate) const RESET_TURNS: u8 = 0x0A;
    pub(crate) const CALIBRATE: u8 = 0x0B;
    pub(crate) const SYNC_READ: u8 = 0x82;
    pub(crate) const SYNC_WRITE: u8 = 0x83;
    /// DYNAMIXEL MX only.
    pub(crate) const BULK_READ: u8 = 0x92;
}

/// The error byte of a DYNAMIXEL 1.0: one bit for what is wrong with the instruction, and what is wrong with the
/// servo whatever the instruction was.
pub(in crate::servo_bus) fn error_bits(refusal: Option<Refusal>, alarms: u8) -> u8 {
    let instruction = match refusal {
        None => 0,
        Some(Refusal::Instruction | Refusal::Fail) => 1 << 6,
        Some(Refusal::Checksum) => 1 << 4,
        // The page has no bit of its own for read only and undefined addresses: "out of the range for use".
        Some(Refusal::Range | Refusal::Length | Refusal::Access) => 1 << 3,
        Some(Refusal::Limit) => 1 << 1,
    };
    instruction | alarms & STATE
}

/// Appends the status packet of `id` with `params`.
pub(in crate::servo_bus) fn status(id: u8, error: u8, params: &[u8], out: &mut Vec<u8>) {
    let start = out.len() + 2;
    out.extend_from_slice(&[HEADER, HEADER, id, params.len() as u8 + 2, error]);
    out.extend_from_slice(params);
    out.push(sum(&out[start..]));
}

/// The last byte of a packet for the bytes between header and it.
pub(super) fn sum(bytes: &[u8]) -> u8 {
    !bytes.iter().fold(0u8, |sum, &byte| sum.wrapping_add(byte))
}
