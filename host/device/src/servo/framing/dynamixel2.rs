//! Building Dynamixel Protocol 2.0 packets.
//!
//! Source: ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0"; facts and decisions in
//! `docs/protocols/dynamixel2.md`. The way back is [`super::decoder`].

use crc::{CRC_16_UMTS, Crc, Table};

/// First bytes of every packet; the fourth is reserved and zero.
pub const HEADER: [u8; 4] = [0xff, 0xff, 0xfd, 0x00];
/// The id all servos listen to. None answers it, but for ping and sync or bulk reads.
pub const BROADCAST_ID: u8 = 0xfe;
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

/// Why a packet could not be built.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FramingError {
    /// The length field has 16 bits.
    #[error(
        "a packet with {bytes} bytes of parameters does not fit the 16-bit length field: send less at once"
    )]
    TooLong {
        /// Parameters after stuffing.
        bytes: usize,
    },
    /// 253 and 255 are not ids, and 254 is the broadcast id, which this instruction cannot use.
    #[error("{id} is not the id of a servo: ids run from 0 to {ID_MAX}")]
    NotAnId {
        /// What was asked for.
        id: u8,
    },
}

/// What a packet asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Instruction {
    /// Answered even at status return level 0.
    Ping = 0x01,
    /// One block of one servo.
    Read = 0x02,
    /// One block of one servo, at once.
    Write = 0x03,
    /// One block of one servo, carried out by the next action.
    RegWrite = 0x04,
    /// Carries out what was registered.
    Action = 0x05,
    /// Back to factory settings.
    FactoryReset = 0x06,
    /// The only instruction that ends a shutdown.
    Reboot = 0x08,
    /// Forgets turns.
    Clear = 0x10,
    /// Keeps or restores the EEPROM.
    Backup = 0x20,
    /// The same block of several servos, answered one after another.
    SyncRead = 0x82,
    /// The same block of several servos, unanswered.
    SyncWrite = 0x83,
    /// As sync read, answered in a single packet.
    FastSyncRead = 0x8a,
    /// A block of its own from each servo.
    BulkRead = 0x92,
    /// A block of its own to each servo.
    BulkWrite = 0x93,
    /// As bulk read, answered in a single packet.
    FastBulkRead = 0x9a,
}

/// The checksum over everything before it, stuffed bytes included.
pub fn crc(bytes: &[u8]) -> u16 {
    CRC.checksum(bytes)
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
    encode(out, id, Instruction::Ping as u8, &[])
}

/// Appends a read of `length` bytes from `address`.
pub fn read(out: &mut Vec<u8>, id: u8, address: u16, length: u16) -> Result<(), FramingError> {
    let id = servo_id(id)?;
    let frame = Frame::begin(out, id, Instruction::Read as u8);
    frame
        .extend(&address.to_le_bytes())
        .extend(&length.to_le_bytes())
        .finish()
}

/// Appends a write of `bytes` at `address`.
pub fn write(out: &mut Vec<u8>, id: u8, address: u16, bytes: &[u8]) -> Result<(), FramingError> {
    let frame = Frame::begin(out, id, Instruction::Write as u8);
    frame.extend(&address.to_le_bytes()).extend(bytes).finish()
}

/// Appends a reboot. The servo comes back with torque off and RAM registers at their start values.
pub fn reboot(out: &mut Vec<u8>, id: u8) -> Result<(), FramingError> {
    encode(out, servo_id(id)?, Instruction::Reboot as u8, &[])
}

/// Appends a sync read: each of `ids` answers in this order with `length` bytes from `address`.
pub fn sync_read(
    out: &mut Vec<u8>,
    address: u16,
    length: u16,
    ids: impl IntoIterator<Item = u8>,
) -> Result<(), FramingError> {
    let mut frame = Frame::begin(out, BROADCAST_ID, Instruction::SyncRead as u8);
    frame = frame.extend(&address.to_le_bytes()).extend(&length.to_le_bytes());
    for id in ids {
        frame = frame.extend(&[id]);
    }
    frame.finish()
}

/// Appends a sync write of `WIDTH` bytes at `address` to each servo named. Nobody answers it.
pub fn sync_write<const WIDTH: usize>(
    out: &mut Vec<u8>,
    address: u16,
    items: impl IntoIterator<Item = (u8, [u8; WIDTH])>,
) -> Result<(), FramingError> {
    let mut frame = Frame::begin(out, BROADCAST_ID, Instruction::SyncWrite as u8);
    frame = frame
        .extend(&address.to_le_bytes())
        .extend(&(WIDTH as u16).to_le_bytes());
    for (id, bytes) in items {
        frame = frame.extend(&[id]).extend(&bytes);
    }
    frame.finish()
}

fn servo_id(id: u8) -> Result<u8, FramingError> {
    if id <= ID_MAX {
        Ok(id)
    } else {
        Err(FramingError::NotAnId { id })
    }
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

    fn finish(self) -> Result<(), FramingError> {
        let params = self.out.len().saturating_sub(self.start + BODY_AT + 1);
        let Ok(length) = u16::try_from(params + LENGTH_OVERHEAD_BYTES) else {
            self.out.truncate(self.start);
            return Err(FramingError::TooLong { bytes: params });
        };
        let at = self.start + LENGTH_AT;
        self.out.splice(at..at + 2, length.to_le_bytes());
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
#[path = "dynamixel2_tests.rs"]
mod tests;
