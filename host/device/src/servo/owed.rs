//! Answers that are still owed: what makes it certain that no value returned is an old one.
//!
//! No servo protocol has a sequence number. But the length of an answer is the host's choice, and an answer's length
//! cannot be mistaken. So as long as an answer of some length may still come from a servo, that servo is never
//! asked for that length again: the next question reads a byte more than is needed, the one after that two. A late
//! answer is known by its length, is counted, and is thrown away; and nobody has to wait for silence.
//!
//! A debt ends when its answer comes, or when it cannot come any more: bytes keep their order on a line, so an
//! answer to a question asked much later ([`Owed::heard_of`]) proves that everything before it has come or is lost.
//! Source: this project's method; the fault it prevents is in the servo reference, 0.4.

use crate::clock::Instant;
use std::time::Duration;

/// Debts kept at once: sixteen lengths of 64 servos. Who cannot be noted down is not asked.
const DEBTS_MAX: usize = 1024;

#[derive(Debug, Clone, Copy)]
struct Debt {
    id: u8,
    bytes: u16,
    asked: Instant,
}

/// All answers of a line that may still come although nobody waits for them.
#[derive(Debug)]
pub(super) struct Owed {
    debts: Vec<Debt>,
    /// How late a servo itself may answer, apart from its line: the longest by which answers overtake each other.
    late_max: Duration,
}

impl Owed {
    pub(super) fn new(late_max: Duration) -> Self {
        Self {
            debts: Vec::with_capacity(DEBTS_MAX),
            late_max,
        }
    }

    /// Forgets all, as on another line.
    pub(super) fn clear(&mut self) {
        self.debts.clear();
    }

    /// Whether nothing is owed at all.
    pub(super) fn is_empty(&self) -> bool {
        self.debts.is_empty()
    }

    /// Whether so many more answers can be noted down, should they not come.
    pub(super) fn has_room_for(&self, answers: usize) -> bool {
        self.debts.len() + answers <= DEBTS_MAX
    }

    /// An answer to a question asked at `asked` has not come and is not waited for any more.
    pub(super) fn note(&mut self, id: u8, bytes: u16, asked: Instant) {
        if self.has_room_for(1) {
            self.debts.push(Debt { id, bytes, asked });
        }
    }

    /// Whether this servo may still send an answer of that length.
    pub(super) fn owes(&self, id: u8, bytes: u16) -> bool {
        self.debts.iter().any(|debt| debt.id == id && debt.bytes == bytes)
    }

    /// An answer came that nobody waits for: settles the debt it stands for, and gives when it was asked.
    pub(super) fn settle(&mut self, id: u8, bytes: u16) -> Option<Instant> {
        let at = self
            .debts
            .iter()
            .position(|debt| debt.id == id && debt.bytes == bytes)?;
        Some(self.debts.remove(at).asked)
    }

    /// An answer to the question asked at `asked` was heard: what is older by more than a servo can be late will
    /// not come any more.
    pub(super) fn heard_of(&mut self, asked: Instant) {
        let late_max = self.late_max;
        self.debts
            .retain(|debt| debt.asked >= asked || asked.since(debt.asked) < late_max);
    }

    /// The first of `lengths` that none of `ids` owes.
    pub(super) fn free_length(
        &self,
        ids: &(impl Iterator<Item = u8> + Clone),
        mut lengths: impl Iterator<Item = u16>,
    ) -> Option<u16> {
        let mut taken = 0_u64;
        for debt in &self.debts {
            if debt.bytes < u64::BITS as u16 && ids.clone().any(|id| id == debt.id) {
                taken |= 1 << debt.bytes;
            }
        }
        lengths.find(|bytes| *bytes < u64::BITS as u16 && taken >> *bytes & 1 == 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATE_MAX: Duration = Duration::from_millis(100);

    fn at(ms: u64) -> Instant {
        Instant::from_nanos(ms * 1_000_000)
    }

    #[test]
    fn an_owed_length_is_not_asked_for_again() {
        let mut owed = Owed::new(LATE_MAX);
        let ids = || [1, 2, 3].into_iter();
        assert_eq!(owed.free_length(&ids(), 4..9), Some(4));
        owed.note(2, 4, at(0));
        owed.note(3, 5, at(20));
        assert_eq!(owed.free_length(&ids(), 4..9), Some(6));
        assert_eq!(
            owed.free_length(&[1].into_iter(), 4..9),
            Some(4),
            "it owes nothing"
        );
        assert_eq!(owed.free_length(&[3].into_iter(), 4..9), Some(4));
        assert_eq!(owed.settle(2, 5), None, "of another length");
        assert_eq!(owed.settle(2, 4), Some(at(0)));
        assert_eq!(owed.free_length(&ids(), 4..9), Some(4));
        owed.note(1, 4, at(30));
        assert_eq!(
            owed.free_length(&ids(), 4..6),
            None,
            "every length is owed by somebody"
        );
    }

    #[test]
    fn only_a_much_later_answer_ends_a_debt() {
        let mut owed = Owed::new(LATE_MAX);
        owed.note(1, 4, at(1000));
        owed.heard_of(at(1050));
        owed.heard_of(at(990));
        assert!(
            owed.owes(1, 4),
            "an answer may be overtaken by a prompter servo's"
        );
        owed.heard_of(at(1100));
        assert!(owed.is_empty(), "what was asked later has been answered");
    }
}
