//! A member of a bus and all that is known about it at the moment.

use super::event::Presence;
use super::freshness::{Freshness, Verdict};
use super::gather::Gathered;
use super::limit::Limiter;
use super::member::{Member, Reading, Supply};

/// A member and all that is known about it.
#[derive(Debug)]
pub(super) struct Slot {
    pub(super) member: Member,
    pub(super) reading: Option<Reading>,
    pub(super) supply: Supply,
    pub(super) presence: Presence,
    pub(super) misses: u32,
    pub(super) freshness: Freshness,
    /// Answers in a row that were taken for late.
    pub(super) late_in_a_row: u8,
    pub(super) limiter: Option<Limiter>,
    /// The measured position that the goal is pinned to while arming.
    pub(super) pin: Option<Reading>,
    /// The goal that the servo holds after arming: where the limiter starts.
    pub(super) held_rad: Option<f64>,
    /// Min and Max Position Limit; none until read.
    pub(super) accepts: Option<[i64; 2]>,
}

impl Slot {
    pub(super) fn new(member: Member) -> Self {
        Self {
            member,
            reading: None,
            supply: Supply::default(),
            presence: Presence::Present,
            misses: 0,
            freshness: Freshness::default(),
            late_in_a_row: 0,
            limiter: None,
            pin: None,
            held_rad: None,
            accepts: None,
        }
    }

    pub(super) fn take_supply(&mut self, block: &[u8], address: u16) {
        let fields = self.member.fields();
        self.supply.voltage_v = fields.voltage.get_si(block, address).or(self.supply.voltage_v);
        self.supply.temperature_c = fields
            .temperature
            .get_si(block, address)
            .or(self.supply.temperature_c);
    }

    /// The reading in a gathered block, if it was measured after it was asked for.
    pub(super) fn fresh_reading(&mut self, answer: &Gathered, address: u16) -> Option<Reading> {
        let reading = self
            .member
            .reading(answer.bytes(), address, answer.measured)
            .ok()?;
        match self
            .freshness
            .judge(reading.tick, answer.sent, answer.turn, answer.received)
        {
            Verdict::Fresh => {
                self.reading = Some(reading);
                self.presence = Presence::Present;
                self.misses = 0;
                Some(reading)
            }
            // A restarted servo is asked once more, then its clock is known again. A late answer may as well be a
            // prompt one after a first that was held up; asked again after a silence, there is no doubt.
            Verdict::Stale { .. } | Verdict::Restarted => {
                self.freshness.forget();
                None
            }
        }
    }
}
