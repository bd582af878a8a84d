//! From bytes to Dynamixel Protocol 2.0 packets, a piece at a time.
//!
//! Source: ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0", order of reception: header (not
//! `FF FF FD FD`), id, length, that many bytes, CRC, and only then the stuffing is taken out.
//! Garbage is normal: it is skipped and counted, and a packet that fails its CRC costs no
//! byte of the packets inside or behind it.

use super::dynamixel2::{BODY_AT, HEADER, STATUS, Stuffing, crc};

/// Longest packet accepted unless told otherwise, in bytes of the length field.
/// A whole control table of an X-series servo (662 bytes) fits, stuffed at its worst.
const LENGTH_MAX_DEFAULT: usize = 1024;
/// Shortest value of the length field: instruction and CRC.
const LENGTH_MIN: usize = 3;
/// Header, id and length field.
const PREFIX_BYTES: usize = BODY_AT;
/// Bytes of the CRC.
const CRC_BYTES: usize = 2;

/// One packet with a right CRC, its parameters unstuffed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet<'a> {
    /// Who it is for, or who answers.
    pub id: u8,
    /// Instruction byte; [`STATUS`] in an answer.
    pub instruction: u8,
    /// Everything between the instruction and the CRC; in an answer the error byte comes first.
    pub params: &'a [u8],
}

/// An answer, taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Status<'a> {
    /// Who answers.
    pub id: u8,
    /// What is wrong, if anything.
    pub error: StatusError,
    /// The data behind the error byte.
    pub data: &'a [u8],
}

impl<'a> Packet<'a> {
    /// The packet as an answer; none when it is an instruction (our own echo, or another host's).
    pub fn status(&self) -> Option<Status<'a>> {
        if self.instruction != STATUS {
            return None;
        }
        let (&error, data) = self.params.split_first()?;
        Some(Status {
            id: self.id,
            error: StatusError(error),
            data,
        })
    }
}

/// The error byte of an answer: bit 7 says that a hardware error is latched,
/// the lower bits number what was wrong with the instruction (0: nothing).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct StatusError(
    /// As received.
    pub u8,
);

impl StatusError {
    /// A bit of Hardware Error Status is set; the data are good all the same.
    pub fn alert(self) -> bool {
        self.0 & 0x80 != 0
    }

    /// 0 for success, else the number in the e-manual's table.
    pub fn number(self) -> u8 {
        self.0 & 0x7f
    }

    /// The e-manual's name of the number, for messages.
    pub fn name(self) -> &'static str {
        match self.number() {
            0 => "no error",
            1 => "result fail",
            2 => "instruction error",
            3 => "CRC error",
            4 => "data range error",
            5 => "data length error",
            6 => "data limit error",
            7 => "access error",
            _ => "unknown error number",
        }
    }
}

/// What went by so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DecoderCounters {
    /// Packets given out.
    pub packets: u64,
    /// Headers whose packet had an impossible length, a wrong CRC or no stuffing where it must be.
    pub rejected: u64,
    /// Bytes that belonged to no packet.
    pub skipped_bytes: u64,
}

/// Takes bytes in pieces of any size and gives out packets.
/// Keeps at most one packet's bytes; allocates only while its two buffers grow to that.
#[derive(Debug, Clone)]
pub struct Decoder {
    waiting: Vec<u8>,
    params: Vec<u8>,
    length_max: usize,
    counters: DecoderCounters,
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

/// What the bytes at the front of the buffer are.
enum Front {
    /// Not the start of a packet: drop so many bytes.
    Skip(usize),
    /// A header whose packet cannot be right: drop its first byte and look again.
    Reject,
    /// More bytes are needed to tell.
    Short,
    /// A packet of so many bytes in all.
    Whole(usize),
}

impl Decoder {
    /// For packets of up to 1024 bytes.
    pub fn new() -> Self {
        Self {
            waiting: Vec::with_capacity(LENGTH_MAX_DEFAULT),
            params: Vec::with_capacity(LENGTH_MAX_DEFAULT),
            length_max: LENGTH_MAX_DEFAULT,
            counters: DecoderCounters::default(),
        }
    }

    /// What went by so far.
    pub fn counters(&self) -> DecoderCounters {
        self.counters
    }

    /// Forgets an unfinished packet, which is counted as skipped bytes.
    pub fn clear(&mut self) {
        self.counters.skipped_bytes += self.waiting.len() as u64;
        self.waiting.clear();
    }

    /// Takes the next bytes and gives out every packet that they complete.
    pub fn push(&mut self, bytes: &[u8], emit: &mut dyn FnMut(Packet<'_>)) {
        self.waiting.extend_from_slice(bytes);
        self.advance(emit);
    }

    /// Nothing more will come for the packet at the front: looks for packets behind its header.
    pub fn give_up(&mut self, emit: &mut dyn FnMut(Packet<'_>)) {
        while !self.waiting.is_empty() {
            self.counters.rejected += 1;
            self.drop_front(1);
            self.advance(emit);
        }
    }

    fn advance(&mut self, emit: &mut dyn FnMut(Packet<'_>)) {
        loop {
            match self.front() {
                Front::Short => return,
                Front::Skip(bytes) => self.drop_front(bytes),
                Front::Reject => {
                    self.counters.rejected += 1;
                    self.drop_front(1);
                }
                Front::Whole(bytes) => self.take(bytes, emit),
            }
        }
    }

    fn front(&self) -> Front {
        let header = self
            .waiting
            .iter()
            .zip(HEADER)
            .take_while(|(have, want)| *have == want)
            .count();
        if header < HEADER.len() {
            if header == self.waiting.len() {
                return Front::Short;
            }
            let next = self.waiting.iter().skip(1).position(|&byte| byte == HEADER[0]);
            return Front::Skip(next.map_or(self.waiting.len(), |at| at + 1));
        }
        let &[_, _, _, _, id, low, high, ..] = self.waiting.as_slice() else {
            return Front::Short;
        };
        let length = usize::from(u16::from_le_bytes([low, high]));
        if id == 0xff || length < LENGTH_MIN || length > self.length_max {
            return Front::Reject;
        }
        let whole = PREFIX_BYTES + length;
        let Some(packet) = self.waiting.get(..whole) else {
            return Front::Short;
        };
        let (covered, sum) = packet.split_at(whole - CRC_BYTES);
        if sum == crc(covered).to_le_bytes() {
            Front::Whole(whole)
        } else {
            Front::Reject
        }
    }

    fn take(&mut self, bytes: usize, emit: &mut dyn FnMut(Packet<'_>)) {
        let id = self.waiting.get(4).copied().unwrap_or_default();
        let body = self.waiting.get(BODY_AT..bytes - CRC_BYTES).unwrap_or_default();
        let plain = unstuff(body, &mut self.params);
        if plain && let Some((&instruction, params)) = self.params.split_first() {
            self.counters.packets += 1;
            emit(Packet {
                id,
                instruction,
                params,
            });
        } else {
            self.counters.rejected += 1;
        }
        self.waiting.drain(..bytes);
    }

    fn drop_front(&mut self, bytes: usize) {
        self.counters.skipped_bytes += bytes as u64;
        self.waiting.drain(..bytes);
    }
}

/// Takes out the `FD` behind each `FF FF FD`. False when one is missing: the sender does not
/// stuff, so its data are ambiguous and must not be believed.
fn unstuff(body: &[u8], plain: &mut Vec<u8>) -> bool {
    plain.clear();
    let mut matcher = Stuffing::default();
    let mut bytes = body.iter();
    while let Some(&byte) = bytes.next() {
        plain.push(byte);
        if matcher.completes(byte) && bytes.next() != Some(&0xfd) {
            return false;
        }
    }
    true
}

#[cfg(test)]
#[path = "decoder_tests.rs"]
mod tests;
