//! Instructions that several servos answer one after the other: pings to all, sync, bulk and fast reads.
//!
//! Each servo measures when its turn has come and answers after its Return Delay Time; of a fast read only
//! the first servo pays it. What happens behind a servo that does not answer is not documented for a plain
//! read ("in order" is all the page says), so both readings are here; a fast read is one packet and ends; in a
//! bulk read of protocol 1.0 each servo waits for the one before.

use super::bus::ServoBus;
use super::dispatch::write_status;
use super::dynamixel2::crc;
use super::dynamixel2::packet::{HEADER, STATUS};
use super::heard::{BROADCAST, Framing, Order};
use super::servo::Servo;

/// What servos do when the one before them in a sync or bulk read does not answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Absent {
    /// They wait for it: silence to the end.
    #[default]
    Silence,
    /// They wait this many microseconds, then the next one answers.
    GoOnAfter(u32),
}

/// What is being answered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Kind {
    #[default]
    Ping,
    SyncRead,
    BulkRead,
    /// Sync or bulk, all in one packet.
    FastRead,
}

/// One answer expected: of whom, and which bytes.
#[derive(Clone, Copy, Debug)]
struct Turn {
    id: u8,
    address: u16,
    length: u16,
}

/// A read being answered.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    kind: Kind,
    framing: Framing,
    turns: Vec<Turn>,
    next: usize,
    at_ns: u64,
    crc: u16,
}

impl Chain {
    pub(super) fn new() -> Self {
        Self {
            kind: Kind::default(),
            framing: Framing::Dynamixel2,
            turns: Vec::new(),
            next: 0,
            at_ns: 0,
            crc: 0,
        }
    }

    /// When the next servo's turn comes.
    pub(super) fn next_ns(&self) -> Option<u64> {
        (self.next < self.turns.len()).then_some(self.at_ns)
    }

    /// Nobody answers any more.
    pub(super) fn stop(&mut self) {
        self.turns.clear();
        self.next = 0;
    }

    fn start(&mut self, kind: Kind, framing: Framing, at_ns: u64) {
        self.stop();
        self.kind = kind;
        self.framing = framing;
        self.at_ns = at_ns;
    }

    /// A ping to all: those of `ids`, in their order.
    pub(super) fn ping(&mut self, at_ns: u64, framing: Framing, ids: impl Iterator<Item = u8>) {
        self.start(Kind::Ping, framing, at_ns);
        self.turns.extend(ids.map(|id| Turn {
            id,
            address: 0,
            length: 0,
        }));
        self.turns.sort_by_key(|turn| turn.id);
        self.turns.dedup_by_key(|turn| turn.id);
    }

    pub(super) fn sync_read(&mut self, at_ns: u64, params: &[u8]) {
        self.start(Kind::SyncRead, Framing::Dynamixel2, at_ns);
        self.take_sync(params);
    }

    pub(super) fn fast_sync_read(&mut self, at_ns: u64, params: &[u8]) {
        self.start(Kind::FastRead, Framing::Dynamixel2, at_ns);
        self.take_sync(params);
    }

    pub(super) fn bulk_read(&mut self, at_ns: u64, params: &[u8]) {
        self.start(Kind::BulkRead, Framing::Dynamixel2, at_ns);
        self.take_bulk(params);
    }

    pub(super) fn fast_bulk_read(&mut self, at_ns: u64, params: &[u8]) {
        self.start(Kind::FastRead, Framing::Dynamixel2, at_ns);
        self.take_bulk(params);
    }

    /// Feetech's sync read: one byte of address, one of length.
    pub(super) fn summed_sync_read(&mut self, at_ns: u64, address: u16, length: u16, ids: &[u8]) {
        self.start(Kind::SyncRead, Framing::Summed, at_ns);
        self.turns
            .extend(ids.iter().map(|&id| Turn { id, address, length }));
    }

    /// The bulk read of protocol 1.0: length, number and address of each.
    pub(super) fn summed_bulk_read(&mut self, at_ns: u64, blocks: &[u8]) {
        self.start(Kind::BulkRead, Framing::Summed, at_ns);
        for &[length, id, address] in blocks.as_chunks().0 {
            self.take_once(Turn {
                id,
                address: address.into(),
                length: length.into(),
            });
        }
    }

    fn take_sync(&mut self, params: &[u8]) {
        let &[a, b, c, d, ref ids @ ..] = params else {
            return;
        };
        let (address, length) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]));
        self.turns
            .extend(ids.iter().map(|&id| Turn { id, address, length }));
    }

    fn take_bulk(&mut self, params: &[u8]) {
        for &[id, a, b, c, d] in params.as_chunks().0 {
            let (address, length) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]));
            self.take_once(Turn { id, address, length });
        }
    }

    /// A servo named twice answers once.
    fn take_once(&mut self, turn: Turn) {
        if !self.turns.iter().any(|other| other.id == turn.id) {
            self.turns.push(turn);
        }
    }

    /// LEN of the one packet of a fast read: instruction, then per servo error, id, data and checksum.
    fn fast_length(&self) -> u16 {
        self.turns.iter().fold(1, |length: u16, turn| {
            length.saturating_add(turn.length.saturating_add(4))
        })
    }

    /// Whether those behind a servo that did not answer have their turn all the same.
    fn goes_on(&self) -> bool {
        match self.kind {
            Kind::Ping | Kind::SyncRead => true,
            Kind::BulkRead => self.framing == Framing::Dynamixel2,
            Kind::FastRead => false,
        }
    }
}

impl Servo {
    fn takes_part(&self, kind: Kind) -> bool {
        match kind {
            Kind::Ping => self.facts.broadcast_ping,
            Kind::SyncRead => self.facts.sync_read && self.answers_group_reads(),
            Kind::BulkRead => self.facts.bulk_read && self.answers_group_reads(),
            Kind::FastRead => self.reads_fast() && self.answers_group_reads(),
        }
    }
}

impl ServoBus {
    /// The servo whose turn it is answers, or does not.
    pub(super) fn step_chain(&mut self) {
        let Some(&turn) = self.chain.turns.get(self.chain.next) else {
            return;
        };
        let (kind, framing, at_ns) = (self.chain.kind, self.chain.framing, self.chain.at_ns);
        let fast = kind == Kind::FastRead;
        let first = self.chain.next == 0;
        self.chain.next += 1;
        self.begin_answer();
        for place in 0..self.servos.len() {
            let servo = &mut self.servos[place];
            let may = servo.id() == turn.id
                && servo.framing() == framing
                && servo.hears(at_ns, self.options.baud)
                && servo.takes_part(kind)
                && !servo.silent;
            if !may {
                continue;
            }
            servo.advance(at_ns);
            self.answer_params.clear();
            let order = match kind {
                Kind::Ping => Order::Ping,
                _ => Order::Read {
                    address: turn.address,
                    length: turn.length,
                },
            };
            let done = servo.execute(at_ns, order, true, &mut self.answer_params);
            let error = servo.error_byte(done.refusal);
            let delay_ns = if fast && !first { 0 } else { servo.delay_ns() };
            self.one_answer.clear();
            if fast {
                self.fast_block(turn, first, error);
            } else {
                write_status(framing, turn.id, error, &self.answer_params, &mut self.one_answer);
            }
            self.add_answer(delay_ns);
        }
        match self.finish_answer(turn.id, at_ns) {
            Some(end_ns) => self.chain.at_ns = end_ns,
            None => match self.options.absent {
                Absent::GoOnAfter(us) if self.chain.goes_on() => self.chain.at_ns += u64::from(us) * 1000,
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
