//! Building Dynamixel Protocol 2.0 packets.
//!
//! Source: ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0"; facts and decisions in
//! `docs/protocols/dynamixel2.md`. The way back is [`super::decoder`].

use super::error::FramingError;
use super::instruction::{Backup, Instruction, Keep, code, servo_id};
use crc::{CRC_16_UMTS, Crc, Table};
use device_profiles::ServoProtocol;

/// First bytes of every packet; the fourth is reserved and zero.
pub const HEADER: [u8; 4] = [0xff, 0xff, 0xfd, 0x00];
pub use super::BROADCAST_ID;
/// Highest id a servo can have; 253 and 255 are unused.
pub const ID_MAX: u8 = 252;
/// Instruction byte of an answer.
pub const STATUS: u8 = 0x55;
/// Bytes of a status packet around its data: header 4, id, length 2, instruction, error, CRC 2.
pub const STATUS_OVERHEAD_BYTES: usize = 11;
/// Bytes of an instruction packet around its parameters: header 4, id, length 2, instruction, CRC 2.
pub const INSTRUCTION_OVERHEAD_BYTES: usize = 10;
/// Bytes counted by the length field beside the parameters: instruction and CRC.
const LENGTH_OVERHEAD_BYTES: usize = 3;
/// Where the length field stands.
const LENGTH_AT: usize = 5;
/// Where the instruction stands; byte stuffing begins here.
pub(super) const BODY_AT: usize = 7;

/// CRC-16 with polynomial 0x8005, initial value 0, not reflected: the catalogue's CRC-16/UMTS.
static CRC: Crc<u16, Table<16>> = Crc::<u16, Table<16>>::new(&CRC_16_UMTS);

const THIS: ServoProtocol = ServoProtocol::Dynamixel2;

/// The checksum over everything before it, stuffed bytes included.
pub fn crc(bytes: &[u8]) -> u16 {
    CRC.checksum(bytes)
}

/// The checksum of `bytes` behind others whose checksum was `before`.
pub(super) fn crc_behind(before: u16, bytes: &[u8]) -> u16 {
    let mut digest = CRC.digest_with_initial(before);
    digest.update(bytes);
    digest.finalize()
}

/// Appends one packet with any `instruction` byte (also [`STATUS`]) to `out`.
/// `params` are given plain and are stuffed on the way: after each `FF FF FD` an `FD` is put in.
/// On an error nothing is appended.
pub fn encode(out: &mut Vec<u8>, id: u8, instruction: u8, params: &[u8]) -> Result<(), FramingError> {
    let frame = Frame::begin(out, id, instruction);
    frame.extend(params).finish()
}

/// Appends a ping; with [`BROADCAST_ID`] every servo answers.
pub fn ping(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    encode(out, id, code(THIS, Instruction::Ping)?, &[])
}

/// Appends a read of `length` bytes from `address`.
pub fn read(out: &mut Vec<u8>, id: u8, address: u16, length: u16) -> Result<(), FramingError> {
    begin(out, servo_id(THIS, id)?, Instruction::Read)?
        .extend(&address.to_le_bytes())
        .extend(&length.to_le_bytes())
        .finish()
}

/// Appends a write of `bytes` at `address`.
pub fn write(out: &mut Vec<u8>, id: u8, address: u16, bytes: &[u8]) -> Result<(), FramingError> {
    let frame = begin(out, id, Instruction::Write)?;
    frame.extend(&address.to_le_bytes()).extend(bytes).finish()
}

/// Appends a write that waits for [`action`].
pub fn reg_write(out: &mut Vec<u8>, id: u8, address: u16, bytes: &[u8]) -> Result<(), FramingError> {
    let frame = begin(out, id, Instruction::RegWrite)?;
    frame.extend(&address.to_le_bytes()).extend(bytes).finish()
}

/// Appends what sets off registered writes. A servo with nothing registered answers instruction error.
pub fn action(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    encode(out, id, code(THIS, Instruction::Action)?, &[])
}

/// Appends a factory reset, after which the servo reboots. A broadcast that keeps nothing is ignored from
/// firmware 42 on.
pub fn factory_reset(out: &mut Vec<u8>, id: u8, keep: Keep) -> Result<(), FramingError> {
    let option = match keep {
        Keep::Nothing => 0xff,
        Keep::Id => 0x01,
        Keep::IdAndBaud => 0x02,
    };
    encode(out, id, code(THIS, Instruction::FactoryReset)?, &[option])
}

/// Appends a reboot. The servo comes back with torque off and RAM registers at their start values.
pub fn reboot(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    encode(out, servo_id(THIS, id)?, code(THIS, Instruction::Reboot)?, &[])
}

/// Appends what brings Present Position back into one turn. Fails while the servo moves.
pub fn clear_turns(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    encode(out, id, code(THIS, Instruction::Clear)?, b"\x01DXL\"")
}

/// Appends what copies the control table, or brings the copy back, after which the servo reboots. Fails while
/// torque is on.
pub fn backup(out: &mut Vec<u8>, id: u8, way: Backup) -> Result<(), FramingError> {
    let params = match way {
        Backup::Store => b"\x01CTRL",
        Backup::Restore => b"\x02CTRL",
    };
    encode(out, id, code(THIS, Instruction::Backup)?, params)
}

/// Appends a sync read: each of `ids` answers in this order with `length` bytes from `address`.
pub fn sync_read(
    out: &mut Vec<u8>,
    address: u16,
    length: u16,
    ids: impl IntoIterator<Item = u8>,
) -> Result<(), FramingError> {
    same_block(out, Instruction::SyncRead, address, length, ids)
}

/// Appends a fast sync read: as [`sync_read`], but all answer in one packet.
pub fn fast_sync_read(
    out: &mut Vec<u8>,
    address: u16,
    length: u16,
    ids: impl IntoIterator<Item = u8>,
) -> Result<(), FramingError> {
    same_block(out, Instruction::FastSyncRead, address, length, ids)
}

/// Appends a sync write at `address` to each servo named; the first one's bytes give the width for all. Nobody
/// answers it.
pub fn sync_write<Bytes: AsRef<[u8]>>(
    out: &mut Vec<u8>,
    address: u16,
    items: impl IntoIterator<Item = (u8, Bytes)>,
) -> Result<(), FramingError> {
    let mut items = items.into_iter().peekable();
    let want = items.peek().map_or(0, |(_, bytes)| bytes.as_ref().len());
    let frame = begin(out, BROADCAST_ID, Instruction::SyncWrite)?;
    let Ok(width) = u16::try_from(want) else {
        return frame.fail(FramingError::TooLong { bytes: want });
    };
    let mut frame = frame.extend(&address.to_le_bytes()).extend(&width.to_le_bytes());
    for (id, bytes) in items {
        let bytes = bytes.as_ref();
        let got = bytes.len();
        if got != want {
            return frame.fail(FramingError::Width { id, want, got });
        }
        frame = frame.extend(&[id]).extend(bytes);
    }
    frame.finish()
}

/// Appends a bulk read: id, address and length for each servo, who answer in this order.
pub fn bulk_read(
    out: &mut Vec<u8>,
    items: impl IntoIterator<Item = (u8, u16, u16)>,
) -> Result<(), FramingError> {
    own_blocks(out, Instruction::BulkRead, items)
}

/// Appends a fast bulk read: as [`bulk_read`], but all answer in one packet.
pub fn fast_bulk_read(
    out: &mut Vec<u8>,
    items: impl IntoIterator<Item = (u8, u16, u16)>,
) -> Result<(), FramingError> {
    own_blocks(out, Instruction::FastBulkRead, items)
}

/// Appends a bulk write: id, address and bytes for each servo. Nobody answers it.
pub fn bulk_write<Bytes: AsRef<[u8]>>(
    out: &mut Vec<u8>,
    items: impl IntoIterator<Item = (u8, u16, Bytes)>,
) -> Result<(), FramingError> {
    let mut named = [false; 256];
    let mut frame = begin(out, BROADCAST_ID, Instruction::BulkWrite)?;
    for (id, address, bytes) in items {
        let bytes = bytes.as_ref();
        let Ok(width) = u16::try_from(bytes.len()) else {
            return frame.fail(FramingError::TooLong { bytes: bytes.len() });
        };
        if is_second(&mut named, id) {
            return frame.fail(FramingError::Twice { id });
        }
        frame = frame.extend(&[id]).extend(&address.to_le_bytes());
        frame = frame.extend(&width.to_le_bytes()).extend(bytes);
    }
    frame.finish()
}

fn same_block(
    out: &mut Vec<u8>,
    instruction: Instruction,
    address: u16,
    length: u16,
    ids: impl IntoIterator<Item = u8>,
) -> Result<(), FramingError> {
    let mut frame = begin(out, BROADCAST_ID, instruction)?;
    frame = frame.extend(&address.to_le_bytes()).extend(&length.to_le_bytes());
    for id in ids {
        frame = frame.extend(&[id]);
    }
    frame.finish()
}

fn own_blocks(
    out: &mut Vec<u8>,
    instruction: Instruction,
    items: impl IntoIterator<Item = (u8, u16, u16)>,
) -> Result<(), FramingError> {
    let mut named = [false; 256];
    let mut frame = begin(out, BROADCAST_ID, instruction)?;
    for (id, address, length) in items {
        if is_second(&mut named, id) {
            return frame.fail(FramingError::Twice { id });
        }
        frame = frame.extend(&[id]).extend(&address.to_le_bytes());
        frame = frame.extend(&length.to_le_bytes());
    }
    frame.finish()
}

/// Whether `id` was named before; now it is.
pub(super) fn is_second(named: &mut [bool; 256], id: u8) -> bool {
    named
        .get_mut(usize::from(id))
        .is_some_and(|named| std::mem::replace(named, true))
}

fn begin(out: &mut Vec<u8>, id: u8, instruction: Instruction) -> Result<Frame<'_>, FramingError> {
    Ok(Frame::begin(out, id, code(THIS, instruction)?))
}

/// A packet under construction at the end of a buffer, so that a cycle needs no other buffer.
struct Frame<'a> {
    out: &'a mut Vec<u8>,
    start: usize,
    matcher: Stuffing,
}

impl<'a> Frame<'a> {
    fn begin(out: &'a mut Vec<u8>, id: u8, instruction: u8) -> Self {
        let start = out.len();
        out.extend_from_slice(&HEADER);
        out.extend_from_slice(&[id, 0, 0]);
        Self {
            out,
            start,
            matcher: Stuffing::default(),
        }
        .extend(&[instruction])
    }

    fn extend(mut self, bytes: &[u8]) -> Self {
        for &byte in bytes {
            self.out.push(byte);
            if self.matcher.completes(byte) {
                self.out.push(0xfd);
            }
        }
        self
    }

    /// Takes back what was begun.
    fn fail(self, error: FramingError) -> Result<(), FramingError> {
        self.out.truncate(self.start);
        Err(error)
    }

    fn finish(self) -> Result<(), FramingError> {
        let params = self.out.len().saturating_sub(self.start + BODY_AT + 1);
        let Ok(length) = u16::try_from(params + LENGTH_OVERHEAD_BYTES) else {
            return self.fail(FramingError::TooLong { bytes: params });
        };
        let at = self.start + LENGTH_AT;
        if let Some(field) = self.out.get_mut(at..at + 2) {
            field.copy_from_slice(&length.to_le_bytes());
        }
        let sum = self.out.get(self.start..).map_or(0, crc);
        self.out.extend_from_slice(&sum.to_le_bytes());
        Ok(())
    }
}

/// A sliding window over the original bytes that says where `FF FF FD` ends.
/// `FF FF FF FD` is a match too, and a byte put in starts no new one.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Stuffing {
    run_of_ff: u8,
}

impl Stuffing {
    /// Whether `byte` ends a match, so that one more `FD` belongs behind it.
    pub(super) fn completes(&mut self, byte: u8) -> bool {
        let complete = byte == 0xfd && self.run_of_ff >= 2;
        self.run_of_ff = if byte == 0xff {
            self.run_of_ff.saturating_add(1)
        } else {
            0
        };
        complete
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crc_agrees_with_its_catalogue_and_the_manuals_table() {
        assert_eq!(crc(b"123456789"), 0xfee8);
        assert_eq!(crc_behind(crc(b"1234"), b"56789"), 0xfee8);
        for (byte, sum) in [
            (0, 0x0000),
            (1, 0x8005),
            (2, 0x800f),
            (3, 0x000a),
            (4, 0x801b),
            (127, 0x8101),
            (128, 0x8303),
            (254, 0x8207),
            (255, 0x0202),
        ] {
            assert_eq!(crc(&[byte]), sum, "table entry {byte}");
        }
    }
}
