//! One bus under one fault: cycle after cycle, every value judged.
//!
//! A value that is not the servo's own of this cycle is an old one of it, or one of another servo, or nobody's: damaged
//! on the way with a sum that happens to be right. Where bytes are damaged any number may come, so there only what was
//! true of somebody within the last cycles is taken for old or another's; nothing comes late there.

use super::chain::Chain;
use crate::simulated::Line;
use device::servo::{Bus, BusSettings, Commanded};
use device::{Clock, Instant, VirtualClock};
use device_profiles::Role;
use firmware_sim::servo_bus::{BusOptions, Servo};
use firmware_sim::{Fault, ServoBus};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// Counts that belong to one servo: no other is ever there.
const BAND_COUNTS: i64 = 160;
/// Positions in a band, one a cycle; a prime, so that each comes again only after all others.
const PLACES: u64 = 157;
/// How far apart the positions of two cycles are.
const STRIDE: u64 = 37;
/// Cycles within which a value counts as somebody's where bytes are damaged.
const RECENT: usize = 8;
/// Longest pause between two cycles that somebody who ticks makes.
const PAUSE_MAX_US: u64 = 6000;

/// What came back.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Judged {
    pub(crate) cycles: u64,
    /// Values as the servo had them in this cycle.
    pub(crate) fresh: u64,
    /// Values that this servo had in an earlier cycle.
    pub(crate) stale: u64,
    /// Values that another servo has or had.
    pub(crate) of_another: u64,
    /// Values that nobody had: damaged ones whose sum was right.
    pub(crate) damaged: u64,
}

impl Judged {
    pub(crate) fn add(&mut self, other: &Self) {
        self.cycles += other.cycles;
        self.fresh += other.fresh;
        self.stale += other.stale;
        self.of_another += other.of_another;
        self.damaged += other.damaged;
    }
}

/// A bus, its far end, and a hand.
pub(crate) struct Trial {
    clock: VirtualClock,
    far: Line<ServoBus>,
    bus: Bus,
    random: fastrand::Rng,
    cycle: u64,
    /// Whether bytes are damaged on the way.
    damaging: bool,
    /// What the register of each place on the bench holds in this cycle.
    now: Vec<i64>,
    /// The same of the cycles before, the last at the end.
    before: VecDeque<Vec<i64>>,
    /// Cycles before this one whose answers may still be on the line, because nothing was asked since.
    busy: usize,
    /// The id that each place has in this cycle: a fault may have given it another's.
    ids: Vec<u8>,
    /// When each last reading was measured.
    read: Vec<Option<Instant>>,
    rad_per_count: Vec<f64>,
}

impl Trial {
    pub(crate) fn new(chain: &Chain, fault: &str, seed: u64) -> anyhow::Result<Self> {
        let clock = VirtualClock::new();
        clock.advance(Duration::from_secs(1));
        let options = BusOptions {
            seed,
            ..BusOptions::default()
        };
        let far = Line::new(chain.bus(options)?, Arc::new(clock.clone()));
        let members = chain.members()?;
        let rad_per_count = members
            .iter()
            .map(|member| member.servo().rad_per_count())
            .collect();
        let settings = BusSettings {
            health_interval: Duration::from_millis(20),
            ..BusSettings::new("tried", 1_000_000)
        };
        let bus = Bus::new(Box::new(far.clone()), members, settings)?;
        if !fault.is_empty() {
            let fault = Fault::parse(fault)?;
            far.with(|bus, now_us| bus.inject(now_us, &fault));
        }
        Ok(Self {
            clock,
            far,
            damaging: ["noise", "flips", "id"].iter().any(|word| fault.contains(word)),
            now: vec![0; chain.models.len()],
            before: VecDeque::with_capacity(RECENT),
            busy: 0,
            ids: (1..).take(chain.models.len()).collect(),
            read: vec![None; chain.models.len()],
            bus,
            random: fastrand::Rng::with_seed(seed),
            cycle: 0,
            rad_per_count,
        })
    }

    /// So many cycles, and what came of them.
    pub(crate) fn run(&mut self, cycles: u64) -> anyhow::Result<Judged> {
        let mut judged = Judged::default();
        for _ in 0..cycles {
            let waits = self.random.bool();
            while waits && let Some(deadline) = self.bus.deadline() {
                self.bus.wait(&self.clock, deadline);
                self.bus.poll(self.clock.now(), &mut |_| {})?;
            }
            // What has come by now was asked for in the cycle before.
            self.bus.poll(self.clock.now(), &mut |_| {})?;
            self.judge(&mut judged);
            self.move_by_hand();
            if waits {
                self.bus.observe_blocking(&self.clock, &mut |_| {})?;
                self.busy = 0;
            } else {
                self.tick()?;
            }
            self.judge(&mut judged);
            self.cycle += 1;
        }
        judged.cycles = cycles;
        Ok(judged)
    }

    /// As a player does it that looks at the line now and then, and asks again whether all is there or not.
    fn tick(&mut self) -> anyhow::Result<()> {
        let sent = self.bus.observe(self.clock.now())? == Commanded::Sent;
        self.busy = if sent { 0 } else { self.busy + 1 };
        let pause = Duration::from_micros(self.random.u64(500..PAUSE_MAX_US));
        let until = self.clock.now().after(pause);
        while self.clock.now() < until {
            self.bus.wait(&self.clock, until);
            self.bus.poll(self.clock.now(), &mut |_| {})?;
            self.bus.use_pause(self.clock.now(), until)?;
        }
        Ok(())
    }

    fn move_by_hand(&mut self) {
        if self.before.len() == RECENT {
            self.before.pop_front();
        }
        self.before.push_back(self.now.clone());
        let Self {
            far,
            now,
            ids,
            cycle,
            rad_per_count,
            ..
        } = self;
        far.with(|bus, now_us| {
            for (member, unit) in rad_per_count.iter().enumerate() {
                let id = bus.servos().get(member).map_or(0, Servo::id);
                let first = bus.servos().iter().position(|servo| servo.id() == id);
                let place = (*cycle * STRIDE + member as u64) % PLACES;
                let wanted = member as i64 * BAND_COUNTS + place as i64;
                let there = position(bus, member).unwrap_or(wanted);
                // A hand that is told an id takes the first of that id.
                if first == Some(member) {
                    bus.push(now_us, id, (wanted - there) as f64 * unit);
                }
            }
            for (member, (now, own)) in now.iter_mut().zip(ids).enumerate() {
                *now = position(bus, member).unwrap_or(*now);
                *own = bus.servos().get(member).map_or(0, Servo::id);
            }
        });
    }

    fn judge(&mut self, judged: &mut Judged) {
        for member in 0..self.read.len() {
            let last = self.read.get(member).copied().flatten();
            let Some(reading) = self
                .bus
                .reading(member)
                .filter(|reading| Some(reading.at) != last)
            else {
                continue;
            };
            if let Some(read) = self.read.get_mut(member) {
                *read = Some(reading.at);
            }
            *match self.owner(member, reading.position_counts) {
                Owner::Itself => &mut judged.fresh,
                Owner::Past => &mut judged.stale,
                Owner::Another => &mut judged.of_another,
                Owner::Nobody => &mut judged.damaged,
            } += 1;
        }
    }

    /// Whose a value is that came as `member`'s.
    fn owner(&self, member: usize, counts: i64) -> Owner {
        let id = member as u8 + 1;
        let own = |at: &usize| self.ids.get(*at) == Some(&id) || *at == member;
        let true_since = || self.before.iter().rev().take(self.busy).chain([&self.now]);
        let mut places = (0..self.now.len()).filter(own);
        if places.any(|at| true_since().any(|values| values.get(at) == Some(&counts))) {
            return Owner::Itself;
        }
        let had = |at: usize| self.before.iter().any(|values| values.get(at) == Some(&counts));
        let band = usize::try_from(counts.div_euclid(BAND_COUNTS)).unwrap_or(usize::MAX);
        let in_band = counts.rem_euclid(BAND_COUNTS) < PLACES as i64 && band < self.now.len();
        match self.damaging {
            true if had(member) => Owner::Past,
            true if (0..self.now.len()).any(|at| had(at) || self.now.get(at) == Some(&counts)) => {
                Owner::Another
            }
            false if in_band && band == member => Owner::Past,
            false if in_band => Owner::Another,
            _ => Owner::Nobody,
        }
    }
}

/// Whose a value is.
enum Owner {
    Itself,
    Past,
    Another,
    Nobody,
}

fn position(bus: &ServoBus, place: usize) -> Option<i64> {
    bus.servos().get(place)?.register_of(Role::PresentPosition)
}
