//! Asking every member for the same block, until each has answered or has certainly not.
//!
//! One sync read first; whoever is missing then is asked alone, for in a sync read the servos behind an absent
//! one may stay silent too. After each silence the line is given time, so that a late answer cannot be taken
//! for the answer to the next question.

use super::framing::{StatusError, dynamixel2};
use super::line::{Answer, Line, Progress};
use super::table::Block;
use crate::clock::Instant;
use crate::transport::TransportError;
use std::time::Duration;

/// Longest block that is gathered: Goal Position to Present Position of the X series, and some.
pub(super) const BLOCK_BYTES_MAX: usize = 32;
/// How often a member is asked alone before it counts as absent.
const ALONE_MAX: u8 = 3;

/// One member's answer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gathered {
    bytes: [u8; BLOCK_BYTES_MAX],
    length: usize,
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

/// A question under way.
#[derive(Debug, Clone)]
pub(super) struct Gather {
    block: Block,
    ids: Vec<u8>,
    answers: Vec<Option<Gathered>>,
    asked_together: bool,
    asked_alone: Vec<u8>,
    must_be_quiet: bool,
}

impl Gather {
    pub(super) fn new(block: Block, ids: Vec<u8>) -> Self {
        let count = ids.len();
        Self {
            block,
            ids,
            answers: vec![None; count],
            asked_together: false,
            asked_alone: vec![0; count],
            must_be_quiet: false,
        }
    }

    /// Also waits for silence before the first question.
    pub(super) fn after_silence(mut self) -> Self {
        self.must_be_quiet = true;
        self
    }

    pub(super) fn block(&self) -> Block {
        self.block
    }

    /// In the order of the ids; none has not answered.
    pub(super) fn answers(&self) -> &[Option<Gathered>] {
        &self.answers
    }

    /// Goes on as far as possible without waiting; true when nothing is left to ask.
    pub(super) fn advance(
        &mut self,
        line: &mut Line,
        quiet: Duration,
        now: Instant,
    ) -> Result<bool, TransportError> {
        let Self { ids, answers, .. } = self;
        let progress = line.poll(now, &mut |answer| keep(ids, answers, &answer, now))?;
        if progress == Progress::Waiting {
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
        let Block { address, bytes } = self.block;
        let out = line.packet();
        // Packets of this size cannot be too long: at most 253 ids behind four bytes.
        if !self.asked_together {
            self.asked_together = true;
            let _ = dynamixel2::sync_read(out, address, bytes, self.ids.iter().copied());
            line.send(now, self.ids.iter().copied(), usize::from(bytes))?;
            return Ok(self.ids.is_empty());
        }
        let unanswered = self.answers.iter().zip(&mut self.asked_alone).zip(&self.ids);
        let next = unanswered
            .filter(|((answer, _), _)| answer.is_none())
            .find(|((_, tries), _)| **tries < ALONE_MAX);
        let Some(((_, tries), &id)) = next else {
            return Ok(true);
        };
        *tries += 1;
        let _ = dynamixel2::read(out, id, address, bytes);
        line.send(now, [id], usize::from(bytes))?;
        Ok(false)
    }
}

fn keep(ids: &[u8], answers: &mut [Option<Gathered>], answer: &Answer<'_>, now: Instant) {
    let at = ids.iter().position(|&id| id == answer.status.id);
    if let Some(slot) = at.and_then(|at| answers.get_mut(at)) {
        let mut bytes = [0; BLOCK_BYTES_MAX];
        let length = answer.status.data.len().min(BLOCK_BYTES_MAX);
        for (to, from) in bytes.iter_mut().zip(answer.status.data) {
            *to = *from;
        }
        *slot = Some(Gathered {
            bytes,
            length,
            error: answer.status.error,
            sent: answer.sent,
            turn: answer.turn,
            measured: answer.measured,
            received: now,
        });
    }
}
