//! Instructions that several servos answer one after the other: broadcast ping, sync, bulk and fast reads.
//!
//! Each servo measures when its turn has come and answers after its Return Delay Time; of a fast read only
//! the first servo pays it. What happens behind a servo that does not answer is not documented for a plain
//! read ("in order" is all the page says), so both readings are here; a fast read is one packet and ends.

use super::bus::ServoBus;
use super::crc;
use super::packet::{self, ALERT, BROADCAST, HEADER, STATUS, instruction};
use super::table::Reg;

/// What servos do when the one before them in a sync or bulk read does not answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Absent {
    /// They wait for it: silence to the end.
    #[default]
    Silence,
    /// They wait this many microseconds, then the next one answers.
    GoOnAfter(u32),
}

/// One answer expected: of whom, and which bytes.
#[derive(Clone, Copy, Debug)]
struct Turn {
    id: u8,
    address: u16,
    length: u16,
}

/// A read being answered.
#[derive(Clone, Debug, Default)]
pub(super) struct Chain {
    code: u8,
    turns: Vec<Turn>,
    next: usize,
    at_ns: u64,
    crc: u16,
}

impl Chain {
    /// When the next servo's turn comes.
    pub(super) fn next_ns(&self) -> Option<u64> {
        (self.next < self.turns.len()).then_some(self.at_ns)
    }

    /// Nobody answers any more.
    pub(super) fn stop(&mut self) {
        self.turns.clear();
        self.next = 0;
    }

    fn start(&mut self, code: u8, at_ns: u64) {
        self.stop();
        self.code = code;
        self.at_ns = at_ns;
    }

    /// A broadcast ping: every servo of `ids`, which are in order.
    pub(super) fn ping(&mut self, at_ns: u64, ids: impl Iterator<Item = u8>) {
        self.start(instruction::PING, at_ns);
        self.turns.extend(ids.map(|id| Turn {
            id,
            address: 0,
            length: 0,
        }));
        self.turns.sort_by_key(|turn| turn.id);
        self.turns.dedup_by_key(|turn| turn.id);
    }

    /// A sync read, plain or fast.
    pub(super) fn sync(&mut self, at_ns: u64, code: u8, params: &[u8]) {
        self.start(code, at_ns);
        let &[a, b, c, d, ref ids @ ..] = params else {
            return;
        };
        let (address, length) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]));
        self.turns
            .extend(ids.iter().map(|&id| Turn { id, address, length }));
    }

    /// A bulk read, plain or fast; a servo named twice answers once.
    pub(super) fn bulk(&mut self, at_ns: u64, code: u8, params: &[u8]) {
        self.start(code, at_ns);
        for &[id, a, b, c, d] in params.as_chunks().0 {
            if !self.turns.iter().any(|turn| turn.id == id) {
                let (address, length) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]));
                self.turns.push(Turn { id, address, length });
            }
        }
    }

    fn is_fast(&self) -> bool {
        matches!(
            self.code,
            instruction::FAST_SYNC_READ | instruction::FAST_BULK_READ
        )
    }

    /// LEN of the one packet of a fast read: instruction, then per servo error, id, data and checksum.
    fn fast_length(&self) -> u16 {
        self.turns.iter().fold(1, |length: u16, turn| {
            length.saturating_add(turn.length.saturating_add(4))
        })
    }
}

impl ServoBus {
    /// The servo whose turn it is answers, or does not.
    pub(super) fn step_chain(&mut self) {
        let Some(&turn) = self.chain.turns.get(self.chain.next) else {
            return;
        };
        let (code, at_ns, fast) = (self.chain.code, self.chain.at_ns, self.chain.is_fast());
        let first = self.chain.next == 0;
        self.chain.next += 1;
        self.begin_answer();
        for place in 0..self.servos.len() {
            let servo = &mut self.servos[place];
            let may = servo.id() == turn.id
                && servo.hears(at_ns, self.options.baud)
                && servo.answers(code)
                && !servo.silent
                && (!fast || servo.reads_fast());
            if !may {
                continue;
            }
            servo.advance(at_ns);
            self.answer_params.clear();
            let error = if code == instruction::PING {
                servo
                    .execute(at_ns, code, &[], true, &mut self.answer_params)
                    .error
            } else {
                servo.read(at_ns, turn.address, turn.length, &mut self.answer_params)
            };
            let alert = if servo.table.get(Reg::HardwareErrorStatus) != 0 {
                ALERT
            } else {
                0
            };
            let delay_ns = if fast && !first { 0 } else { servo.delay_ns() };
            self.one_answer.clear();
            if fast {
                self.fast_block(turn, first, error | alert);
            } else {
                packet::status(turn.id, error | alert, &self.answer_params, &mut self.one_answer);
            }
            self.add_answer(delay_ns);
        }
        match self.finish_answer(turn.id, at_ns) {
            Some(end_ns) => self.chain.at_ns = end_ns,
            None => match self.options.absent {
                Absent::GoOnAfter(us) if !fast => self.chain.at_ns += u64::from(us) * 1000,
                _ => self.chain.stop(),
            },
        }
    }

    /// Writes one servo's part of a fast read to `one_answer`; the checksum runs on through the packet.
    fn fast_block(&mut self, turn: Turn, first: bool, error: u8) {
        if first {
            self.chain.crc = 0;
            self.one_answer.extend_from_slice(&HEADER);
            self.one_answer.push(BROADCAST);
            self.one_answer
                .extend_from_slice(&self.chain.fast_length().to_le_bytes());
            self.one_answer.push(STATUS);
        }
        self.one_answer.extend_from_slice(&[error, turn.id]);
        // A refused read still fills its place, or the servos behind would stand elsewhere.
        self.answer_params.resize(usize::from(turn.length), 0);
        self.one_answer.extend_from_slice(&self.answer_params);
        let checksum = crc::extend(self.chain.crc, &self.one_answer);
        self.one_answer.extend_from_slice(&checksum.to_le_bytes());
        self.chain.crc = crc::extend(checksum, &checksum.to_le_bytes());
    }
}
