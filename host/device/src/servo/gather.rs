//! Asking members for blocks of their registers, until each has answered or has certainly not.
//!
//! Who can be asked together is asked together first; whoever is missing then is asked alone, for in a group read the
//! servos behind an absent one may stay silent too. After each silence the line is given time, and nothing is asked
//! for with a length that is still owed.

use super::block::{BLOCK_BYTES_MAX, Block};
use super::bus::Bus;
use super::framing::{self, StatusError};
use super::line::{Answer, Line, Progress};
use super::register::Field;
use super::slot::Slot;
use crate::clock::Instant;
use crate::transport::TransportError;
use device_profiles::ServoProtocol;
use std::time::Duration;

/// How often a member is asked alone before it counts as absent.
const ALONE_MAX: u8 = 3;

/// One member's answer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gathered {
    bytes: [u8; BLOCK_BYTES_MAX],
    length: usize,
    /// Whether the data are there; otherwise it is a refusal.
    pub(super) whole: bool,
    /// Where the bytes begin.
    pub(super) address: u16,
    pub(super) error: StatusError,
    pub(super) sent: Instant,
    pub(super) turn: Duration,
    pub(super) measured: Instant,
    pub(super) received: Instant,
}

impl Gathered {
    pub(super) fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }
}

/// One block of one member.
#[derive(Debug, Clone)]
struct Question {
    member: usize,
    id: u8,
    protocol: ServoProtocol,
    /// Whether it may be asked in a sync read.
    sync: bool,
    block: Block,
    answer: Option<Gathered>,
    asked_together: bool,
    asked_alone: u8,
}

/// Questions under way.
#[derive(Debug, Clone, Default)]
pub(super) struct Gather {
    questions: Vec<Question>,
    /// What is being asked: place in `questions`, where its read begins.
    asking: Vec<(usize, u16)>,
    must_be_quiet: bool,
    not_before: Instant,
}

impl Gather {
    /// Blocks of each member; those without any are not asked.
    pub(super) fn new(slots: &[Slot], blocks: impl Fn(&Slot) -> Vec<Block>) -> Self {
        let mut questions = Vec::new();
        for (member, slot) in slots.iter().enumerate() {
            for block in blocks(slot) {
                questions.push(Question {
                    member,
                    id: slot.member.id(),
                    protocol: slot.table.protocol,
                    sync: slot.member.servo().sync_read,
                    block,
                    answer: None,
                    asked_together: false,
                    asked_alone: 0,
                });
            }
        }
        Self {
            questions,
            ..Self::default()
        }
    }

    /// Waits for silence before the first question.
    pub(super) fn after_silence(mut self) -> Self {
        self.must_be_quiet = true;
        self
    }

    /// Asks nothing before `at`, as while servos are deaf.
    pub(super) fn not_before(mut self, at: Instant) -> Self {
        self.not_before = at;
        self
    }

    /// A member's answer that holds a row.
    pub(super) fn holding(&self, member: usize, row: Field) -> Option<&Gathered> {
        let mut of_member = self.questions.iter().filter(|question| question.member == member);
        of_member
            .find(|question| question.block.holds(row))?
            .answer
            .as_ref()
            .filter(|answer| answer.whole)
    }

    /// A row's value as a member told it.
    pub(super) fn value(&self, member: usize, row: Field) -> Option<i64> {
        let answer = self.holding(member, row)?;
        row.get(answer.bytes(), answer.address)
    }

    /// Members that have not answered every question, each once.
    pub(super) fn missing(&self) -> Vec<usize> {
        let open = self.questions.iter().filter(|question| question.answer.is_none());
        let mut members: Vec<usize> = open.map(|question| question.member).collect();
        members.dedup();
        members
    }

    /// Members that refused a question, with what they said and the first byte they were asked for.
    pub(super) fn refusals(&self) -> impl Iterator<Item = (usize, StatusError, u16)> + '_ {
        self.questions.iter().filter_map(|question| {
            let answer = question.answer.filter(|answer| !answer.whole)?;
            Some((question.member, answer.error, question.block.address))
        })
    }

    /// Goes on as far as possible without waiting; true when nothing is left to ask.
    pub(super) fn advance(
        &mut self,
        line: &mut Line,
        quiet: Duration,
        now: Instant,
    ) -> Result<bool, TransportError> {
        let Self {
            questions, asking, ..
        } = self;
        let progress = line.poll(now, &mut |answer| keep(questions, asking, &answer, now))?;
        if progress == Progress::Waiting || now < self.not_before {
            return Ok(false);
        }
        if progress == Progress::Done && line.missing().next().is_some() {
            self.must_be_quiet = true;
        }
        if self.must_be_quiet && line.quiet_for(now) < quiet {
            return Ok(false);
        }
        self.must_be_quiet = false;
        self.ask(line, now)
    }

    fn ask(&mut self, line: &mut Line, now: Instant) -> Result<bool, TransportError> {
        self.asking.clear();
        if self.ask_together(line, now)? {
            return Ok(false);
        }
        loop {
            let mut open = self.questions.iter_mut().enumerate();
            let next =
                open.find(|(_, question)| question.answer.is_none() && question.asked_alone < ALONE_MAX);
            let Some((at, question)) = next else {
                return Ok(true);
            };
            question.asked_alone += 1;
            let block = question.block;
            let id = question.id;
            let Some(bytes) = line.owed().free_length(&std::iter::once(id), block.lengths()) else {
                continue;
            };
            let address = block.address_for(bytes);
            self.asking.push((at, address));
            line.packet();
            line.speak(question.protocol);
            // An id and lengths of a member cannot be wrong.
            let _ = framing::read(question.protocol, line.packet_so_far(), id, address, bytes);
            line.send(now, [id], bytes.into())?;
            return Ok(false);
        }
    }

    /// Asks all at once who have not been and whose questions are alike. False: there is nobody.
    fn ask_together(&mut self, line: &mut Line, now: Instant) -> Result<bool, TransportError> {
        loop {
            let fits =
                |question: &Question| question.sync && !question.asked_together && question.answer.is_none();
            let Some(first) = self.questions.iter().find(|question| fits(question)) else {
                return Ok(false);
            };
            let (protocol, block) = (first.protocol, first.block);
            let alike = |question: &Question| {
                fits(question) && question.protocol == protocol && question.block == block
            };
            let chosen: Vec<usize> = (0..self.questions.len())
                .filter(|at| self.questions.get(*at).is_some_and(alike))
                .collect();
            let questions = &self.questions;
            let ids = || {
                chosen
                    .iter()
                    .filter_map(|at| questions.get(*at))
                    .map(|question| question.id)
            };
            let bytes = line.owed().free_length(&ids(), block.lengths());
            if let Some(bytes) = bytes {
                let address = block.address_for(bytes);
                line.packet();
                line.speak(protocol);
                // Packets of this size cannot be too long: at most 253 ids behind four bytes.
                let _ = framing::sync_read(protocol, line.packet_so_far(), address, bytes, ids());
                line.send(now, ids(), bytes.into())?;
                self.asking.extend(chosen.iter().map(|at| (*at, address)));
            }
            for at in &chosen {
                if let Some(question) = self.questions.get_mut(*at) {
                    question.asked_together = true;
                }
            }
            if bytes.is_some() {
                return Ok(true);
            }
        }
    }
}

fn keep(questions: &mut [Question], asking: &[(usize, u16)], answer: &Answer<'_>, now: Instant) {
    for &(at, address) in asking {
        let Some(question) = questions
            .get_mut(at)
            .filter(|question| question.id == answer.status.id)
        else {
            continue;
        };
        let mut bytes = [0; BLOCK_BYTES_MAX];
        let length = answer.status.data.len().min(BLOCK_BYTES_MAX);
        for (to, from) in bytes.iter_mut().zip(answer.status.data) {
            *to = *from;
        }
        question.answer = Some(Gathered {
            bytes,
            length,
            whole: answer.whole,
            address,
            error: answer.status.error,
            sent: answer.sent,
            turn: answer.turn,
            measured: answer.measured,
            received: now,
        });
    }
}

impl Bus {
    /// Questions for rows of each member.
    pub(super) fn gather(&self, rows: impl Fn(&Slot) -> Vec<Field>) -> Gather {
        Gather::new(&self.slots, |slot| {
            Block::covering(slot.member.servo(), &rows(slot))
        })
    }
}
