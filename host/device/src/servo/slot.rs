//! A member of a bus and all that is known about it at the moment.

use super::block::Block;
use super::event::Presence;
use super::freshness::{Freshness, Verdict};
use super::gather::Gathered;
use super::health::Item;
use super::limit::Limiter;
use super::member::{Member, Reading, Supply};
use super::table::Table;

/// A member and all that is known about it.
#[derive(Debug)]
pub(super) struct Slot {
    pub(super) member: Member,
    pub(super) table: Table,
    /// What is read for each health item, in the order of [`Item::ALL`].
    health: [Option<Block>; Item::ALL.len()],
    /// Firmware Version; none until read.
    pub(super) firmware: Option<u8>,
    pub(super) reading: Option<Reading>,
    pub(super) supply: Supply,
    pub(super) presence: Presence,
    pub(super) misses: u32,
    /// The cycle in which it was read last.
    pub(super) read_in: u64,
    /// Cycle at which an absent servo is tried again.
    pub(super) probe_at: u64,
    pub(super) freshness: Freshness,
    /// Answers in a row that were taken for late.
    pub(super) late_in_a_row: u8,
    pub(super) limiter: Option<Limiter>,
    /// Its goal was taken from it because it may have started over; see `unseen`.
    pub(super) let_go: bool,
    /// The measured position that the goal is pinned to while arming.
    pub(super) pin: Option<Reading>,
    /// The goal that the servo holds after arming: where the limiter starts.
    pub(super) held_rad: Option<f64>,
    /// Smallest and largest goal position; none until read.
    pub(super) accepts: Option<[i64; 2]>,
}

impl Slot {
    pub(super) fn new(member: Member, table: &Table) -> Self {
        let mut slot = Self {
            member,
            table: *table,
            health: [None; Item::ALL.len()],
            firmware: None,
            reading: None,
            supply: Supply::default(),
            presence: Presence::Present,
            misses: 0,
            read_in: 0,
            probe_at: 0,
            freshness: Freshness::default(),
            late_in_a_row: 0,
            limiter: None,
            let_go: false,
            pin: None,
            held_rad: None,
            accepts: None,
        };
        slot.health = Item::ALL.map(|item| item.block(&slot));
        slot
    }

    /// What is read for a health item; none where there is nothing to read.
    pub(super) fn health_block(&self, item: Item) -> Option<Block> {
        let at = Item::ALL.iter().position(|other| *other == item)?;
        *self.health.get(at)?
    }

    /// Voltage and temperature, as far as the block that starts at `address` holds them.
    pub(super) fn take_supply(&mut self, block: &[u8], address: u16) {
        let si = |row: Option<super::register::Field>| row.and_then(|row| row.get_si(block, address));
        self.supply.voltage_v = si(self.table.voltage).or(self.supply.voltage_v);
        self.supply.temperature_c = si(self.table.temperature).or(self.supply.temperature_c);
    }

    /// The reading in a gathered block, if it was measured after it was asked for.
    pub(super) fn fresh_reading(&mut self, answer: &Gathered) -> Option<Reading> {
        let (bytes, start) = (answer.bytes(), answer.address);
        let reading = self
            .member
            .reading(&self.table, bytes, start, answer.measured, self.reading)
            .ok()?;
        let verdict = reading.tick.map_or(Verdict::Fresh, |tick| {
            self.freshness
                .judge(tick, answer.sent, answer.turn, answer.received)
        });
        match verdict {
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
