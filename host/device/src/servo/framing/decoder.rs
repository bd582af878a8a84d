//! From bytes to packets, a piece at a time, in any of the protocols.
//!
//! Garbage is normal: it is skipped and counted, and a packet whose checksum is wrong costs no byte of the packets
//! inside or behind it. Told what is sent ([`Decoder::sent`]), the decoder knows its own words when the adapter
//! gives them back, believes no length that no answer can have, and takes the one packet that answers a fast read
//! apart into one status for each servo. Nothing is allocated after construction, whatever comes.

use super::asked::{Asked, Source};
use super::dynamixel2::{BODY_AT, STATUS, Stuffing};
use super::fast::{FastRun, HEAD_BYTES, Step};
use super::front::{CRC_BYTES, Front, LENGTH_MAX, stuffed, summed};
use super::status::{Status, StatusError};
use super::summed::PREFIX_BYTES;
use device_profiles::ServoProtocol;

/// Bytes taken in before the next look at what they make.
const PIECE_BYTES: usize = 512;

/// An instruction heard on the line, its parameters unstuffed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet<'a> {
    /// Who it is for.
    pub id: u8,
    /// Instruction byte.
    pub instruction: u8,
    /// Everything between the instruction and the checksum.
    pub params: &'a [u8],
}

/// Something whole that was heard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heard<'a> {
    /// A servo's answer. One for each servo of a fast read.
    Status(Status<'a>),
    /// Our own instruction, given back by the adapter.
    Echo,
    /// An instruction that was not sent here: another host's.
    Instruction(Packet<'a>),
    /// In the answer to a fast read, this servo's part arrived damaged.
    Damaged {
        /// Who was to answer there.
        id: u8,
    },
}

impl<'a> Heard<'a> {
    /// The answer, if it is one.
    pub fn status(self) -> Option<Status<'a>> {
        match self {
            Heard::Status(status) => Some(status),
            _ => None,
        }
    }
}

/// What went by so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DecoderCounters {
    /// Answers and instructions given out.
    pub packets: u64,
    /// Our own packets heard back.
    pub echoes: u64,
    /// Headers whose packet had an impossible length, a wrong checksum or no stuffing where it must be, and damaged
    /// parts of fast reads.
    pub rejected: u64,
    /// Bytes that belonged to no packet.
    pub skipped_bytes: u64,
}

/// Takes bytes in pieces of any size and gives out what they make. See the module's opening.
#[derive(Debug, Clone)]
pub struct Decoder {
    protocol: ServoProtocol,
    /// Never more than one packet and one piece.
    waiting: Vec<u8>,
    /// Bytes at the front of `waiting` that are done with.
    done: usize,
    plain: Vec<u8>,
    asked: Asked,
    fast: Option<FastRun>,
    counters: DecoderCounters,
    counters_when_sent: DecoderCounters,
}

impl Decoder {
    /// For one protocol. Servos of several on one line need a decoder each.
    pub fn new(protocol: ServoProtocol) -> Self {
        Self {
            protocol,
            waiting: Vec::with_capacity(BODY_AT + LENGTH_MAX + PIECE_BYTES),
            done: 0,
            plain: Vec::with_capacity(LENGTH_MAX),
            asked: Asked::new(protocol),
            fast: None,
            counters: DecoderCounters::default(),
            counters_when_sent: DecoderCounters::default(),
        }
    }

    /// The protocol it understands.
    pub fn protocol(&self) -> ServoProtocol {
        self.protocol
    }

    /// What went by so far.
    pub fn counters(&self) -> DecoderCounters {
        self.counters
    }

    /// Takes note of the whole packets that are put on the line now. What remains of the answer to a fast read
    /// before is given up.
    pub fn sent(&mut self, packets: &[u8]) {
        self.fast = None;
        self.asked.note(packets);
        self.counters_when_sent = self.counters;
    }

    /// Forgets an unfinished packet, which is counted as skipped bytes.
    pub fn clear(&mut self) {
        self.fast = None;
        self.counters.skipped_bytes += self.rest().len() as u64;
        self.waiting.clear();
        self.done = 0;
    }

    /// Takes the next bytes and gives out everything that they complete.
    pub fn push(&mut self, bytes: &[u8], emit: &mut dyn FnMut(Heard<'_>)) {
        for piece in bytes.chunks(PIECE_BYTES) {
            self.waiting.drain(..self.done);
            self.done = 0;
            self.waiting.extend_from_slice(piece);
            self.advance(false, emit);
        }
    }

    /// Nothing more will come for the packet at the front: looks for packets behind its header.
    pub fn give_up(&mut self, emit: &mut dyn FnMut(Heard<'_>)) {
        self.advance(true, emit);
        while !self.rest().is_empty() {
            self.counters.rejected += 1;
            self.skip(1);
            self.advance(true, emit);
        }
    }

    fn rest(&self) -> &[u8] {
        self.waiting.get(self.done..).unwrap_or_default()
    }

    fn skip(&mut self, bytes: usize) {
        self.counters.skipped_bytes += bytes as u64;
        self.done += bytes;
    }

    fn advance(&mut self, ended: bool, emit: &mut dyn FnMut(Heard<'_>)) {
        loop {
            if self.fast.is_some() {
                if !self.advance_fast(ended, emit) {
                    return;
                }
                continue;
            }
            match self.front() {
                Front::Short => return,
                Front::Skip(bytes) => self.skip(bytes),
                Front::Reject => {
                    self.counters.rejected += 1;
                    self.skip(1);
                }
                Front::Whole(bytes) => {
                    self.take(bytes, emit);
                    self.done += bytes;
                }
                Front::Fast => {
                    let head = self
                        .waiting
                        .get(self.done..self.done + HEAD_BYTES)
                        .unwrap_or_default();
                    let length = self.asked.fast_length().unwrap_or(0);
                    self.fast = Some(FastRun::new(head, length));
                    self.done += HEAD_BYTES;
                }
            }
        }
    }

    fn front(&self) -> Front {
        let bytes = self.rest();
        let answer_max = self.asked.answer_length_max();
        match self.protocol {
            ServoProtocol::Dynamixel2 => stuffed(bytes, answer_max, self.asked.fast_length()),
            _ if self.asked.begins_echo(bytes) => summed(bytes, LENGTH_MAX),
            _ => summed(bytes, answer_max),
        }
    }

    /// Gives out a packet at the front whose checksum is right.
    fn take(&mut self, bytes: usize, emit: &mut dyn FnMut(Heard<'_>)) {
        let undisturbed = self.counters == self.counters_when_sent;
        let packet = self.waiting.get(self.done..self.done + bytes).unwrap_or_default();
        let source = self.asked.source(packet, undisturbed);
        let (id, body) = match self.protocol {
            ServoProtocol::Dynamixel2 => (packet.get(4), packet.get(BODY_AT..bytes - CRC_BYTES)),
            _ => (packet.get(2), packet.get(PREFIX_BYTES..bytes - 1)),
        };
        let (id, body) = (id.copied().unwrap_or_default(), body.unwrap_or_default());
        let body = if self.protocol == ServoProtocol::Dynamixel2 {
            if !unstuff(body, &mut self.plain) {
                self.counters.rejected += 1;
                self.counters.skipped_bytes += bytes as u64;
                return;
            }
            self.plain.as_slice()
        } else {
            body
        };
        let heard = match source {
            Source::Own => Some(Heard::Echo),
            Source::Servo => status(self.protocol, id, body).map(Heard::Status),
            Source::Foreign => body.split_first().map(|(&instruction, params)| {
                Heard::Instruction(Packet {
                    id,
                    instruction,
                    params,
                })
            }),
        };
        match heard {
            Some(Heard::Echo) => self.counters.echoes += 1,
            Some(_) => self.counters.packets += 1,
            None => {
                self.counters.rejected += 1;
                self.counters.skipped_bytes += bytes as u64;
            }
        }
        if let Some(heard) = heard {
            emit(heard);
        }
    }

    /// One step through the answer to a fast read. False when more bytes are needed.
    fn advance_fast(&mut self, ended: bool, emit: &mut dyn FnMut(Heard<'_>)) -> bool {
        let Some(run) = &mut self.fast else {
            return true;
        };
        let list = self.asked.fast();
        let name = |index: usize| list.get(index).map_or(super::BROADCAST_ID, |&(id, _)| id);
        let rest = self.waiting.get(self.done..).unwrap_or_default();
        match run.step(rest, list, ended) {
            Step::Short => return false,
            Step::Skip(bytes) => {
                self.counters.skipped_bytes += bytes as u64;
                self.done += bytes;
            }
            Step::Block {
                lead,
                bytes,
                index,
                damaged,
            } => {
                if let Some(damaged) = damaged {
                    self.counters.rejected += 1;
                    emit(Heard::Damaged { id: name(damaged) });
                }
                let block = rest.get(lead..lead + bytes - CRC_BYTES).unwrap_or_default();
                if let &[error, id, ref data @ ..] = block {
                    self.counters.packets += 1;
                    let error = StatusError::new(self.protocol, error);
                    emit(Heard::Status(Status { id, error, data }));
                }
                debug_assert!(block.get(1) == Some(&name(index)));
                self.counters.skipped_bytes += lead as u64;
                self.done += lead + bytes;
            }
            Step::End { damaged } => {
                self.fast = None;
                if let Some(damaged) = damaged {
                    self.counters.rejected += 1;
                    emit(Heard::Damaged { id: name(damaged) });
                }
            }
        }
        true
    }
}

/// The body of a packet as an answer. In protocol 2.0 the instruction comes before the error.
fn status(protocol: ServoProtocol, id: u8, body: &[u8]) -> Option<Status<'_>> {
    let body = match protocol {
        ServoProtocol::Dynamixel2 => body.strip_prefix(&[STATUS])?,
        _ => body,
    };
    let (&error, data) = body.split_first()?;
    Some(Status {
        id,
        error: StatusError::new(protocol, error),
        data,
    })
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
