//! The cycle: goals out and readings in, in one write, and health in what is left of the period.
//!
//! A servo that does not answer can silence those behind it (some firmware waits for the one before), so
//! members are asked in an order: those that answered first, then those that did not, the one to blame last.
//! Only a member whose predecessors all answered is blamed.

use super::bus::{Bus, BusError, Mode};
use super::event::{Armed, BusEvent, Commanded, Goal, Intervention, Presence};
use super::framing::dynamixel2;
use super::freshness::Verdict;
use super::health::{CONFIRMATIONS, Item};
use super::line::{Answer, Progress};
use super::slot::Slot;
use super::table::Table;
use crate::clock::Instant;
use std::time::Duration;

/// So often in a row a member must be the one to blame before it counts as absent: at one answer in ten lost
/// this happens by chance once in 10^10 cycles.
const MISSES_MAX: u32 = 10;
/// Time left in a period, beyond an exchange's own, for it to be begun.
const MARGIN: Duration = Duration::from_millis(2);

/// What is being read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Asked {
    Status,
    Health(Item),
}

/// Where the cycle stands.
#[derive(Debug)]
pub(super) struct Cycle {
    asked: Option<Asked>,
    /// Members in the order in which they are asked.
    order: Vec<usize>,
    asked_count: usize,
    commanded: Instant,
    health_at: Instant,
    item: Item,
    urgent: bool,
    since_probe: u32,
    /// What was found out while goals were sent; told at the next poll.
    pending: Vec<BusEvent>,
    /// Confirmations so far that a member has lost torque, or tripped.
    lost: Vec<[u8; 2]>,
}

impl Cycle {
    pub(super) fn new(members: usize) -> Self {
        Self {
            asked: None,
            order: (0..members).collect(),
            asked_count: 0,
            commanded: Instant::ZERO,
            health_at: Instant::ZERO,
            item: Item::Errors,
            urgent: false,
            since_probe: 0,
            pending: Vec::with_capacity(members),
            lost: vec![[0; 2]; members],
        }
    }

    pub(super) fn commanded(&self) -> Instant {
        self.commanded
    }

    pub(super) fn restart(&mut self, now: Instant) {
        self.asked = None;
        self.commanded = now;
        self.health_at = now;
        self.urgent = false;
        self.lost.fill([0; 2]);
    }
}

impl Bus {
    /// Limits the goals, sends them, and asks for readings in the same write. Call it once a period, after
    /// [`Bus::poll`]. The time since the last goals is taken from `now`; after a stall the goals brake.
    pub fn command(
        &mut self,
        goal: Goal<'_>,
        now: Instant,
        note: &mut dyn FnMut(Intervention),
    ) -> Result<Commanded, BusError> {
        if self.armed() != Armed::Yes {
            return Err(BusError::NotArmed {
                bus: self.settings.name.clone(),
            });
        }
        if let Goal::Positions(positions) = goal
            && positions.len() != self.slots.len()
        {
            let (want, got) = (self.slots.len(), positions.len());
            return Err(BusError::GoalCount {
                bus: self.settings.name.clone(),
                want,
                got,
            });
        }
        let since = now.since(self.cycle.commanded);
        // The servos count from the last packet they understood; a tenth is left for the way there.
        if since >= self.settings.watchdog.mul_f64(0.9) {
            self.begin_pinning(now)?;
            return Ok(Commanded::Lapsed);
        }
        if !self.line.is_wire_free(now) {
            self.counters.busy += 1;
            return Ok(Commanded::Busy);
        }
        self.settle();
        self.cycle.commanded = now;
        self.counters.cycles += 1;
        self.limit(goal, since.as_secs_f64(), note);
        let goal_address = self.table.goal.address;
        let Self { line, slots, .. } = self;
        let goals = slots.iter().filter_map(|slot| {
            let rad = slot.limiter.as_ref()?.position_rad();
            Some((
                slot.member.id(),
                (slot.member.position_counts(rad) as u32).to_le_bytes(),
            ))
        });
        // At most 253 ids with 5 bytes each: cannot be too long.
        let _ = dynamixel2::sync_write(line.packet(), goal_address, goals);
        self.ask_due(now)?;
        Ok(Commanded::Sent)
    }

    /// Asks for readings without giving goals, as while torque is off. Call it once a period.
    pub fn observe(&mut self, now: Instant) -> Result<Commanded, BusError> {
        if !matches!(self.mode, Mode::Loose | Mode::Armed) || !self.line.is_wire_free(now) {
            self.counters.busy += 1;
            return Ok(Commanded::Busy);
        }
        self.settle();
        self.line.packet();
        self.ask_due(now)?;
        Ok(Commanded::Sent)
    }

    /// Takes in what has arrived and carries on what is under way. Never waits.
    pub fn poll(&mut self, now: Instant, emit: &mut dyn FnMut(BusEvent)) -> Result<(), BusError> {
        self.cycle.pending.drain(..).for_each(&mut *emit);
        match self.mode {
            Mode::Arming(_) => self.poll_arming(now, emit),
            Mode::Releasing(_) => self.poll_releasing(now, emit),
            Mode::Loose | Mode::Armed => self.poll_cycle(now, emit),
        }
    }

    fn limit(&mut self, goal: Goal<'_>, dt_secs: f64, note: &mut dyn FnMut(Intervention)) {
        if dt_secs == 0.0 {
            // The tick that completed arming: the pinned goals stand.
            return;
        }
        for (member, slot) in self.slots.iter_mut().enumerate() {
            let Some(limiter) = &mut slot.limiter else {
                continue;
            };
            let wanted = match goal {
                Goal::Positions(positions) => positions.get(member).copied(),
                Goal::Standstill => None,
            };
            let limited = match wanted {
                Some(rad) => limiter.step(rad, dt_secs),
                None => limiter.brake(dt_secs),
            };
            if let Some(change) = limited.change {
                note(Intervention { member, change });
            }
        }
    }

    /// Appends the read that is due to the packets waiting to be sent, and sends them.
    fn ask_due(&mut self, now: Instant) -> Result<(), BusError> {
        let overdue = now.since(self.cycle.health_at) >= self.settings.health_interval * 2;
        let asked = if self.cycle.urgent || overdue {
            self.next_health(now)
        } else {
            Asked::Status
        };
        self.ask(asked, now)
    }

    fn next_health(&mut self, now: Instant) -> Asked {
        self.cycle.health_at = now;
        if std::mem::take(&mut self.cycle.urgent) {
            return Asked::Health(Item::Errors);
        }
        let item = self.cycle.item;
        self.cycle.item = item.next();
        Asked::Health(item)
    }

    fn ask(&mut self, asked: Asked, now: Instant) -> Result<(), BusError> {
        let block = match asked {
            Asked::Status => self.table.status,
            Asked::Health(item) => item.block(&self.table),
        };
        self.cycle.since_probe += 1;
        let probing = asked == Asked::Status && self.cycle.since_probe >= self.settings.probe_cycles;
        if probing {
            self.cycle.since_probe = 0;
        }
        let slots = &self.slots;
        let wanted = |at: &usize| match slots.get(*at).map(|slot| slot.presence) {
            Some(Presence::Present) => true,
            Some(Presence::Doubtful) => asked == Asked::Status,
            Some(Presence::Absent) => probing,
            None => false,
        };
        let rank = |at: &usize| slots.get(*at).map(|slot| (slot.presence as u8, slot.misses));
        // Stable, so that it changes nothing while all answer. A merge sort of a list that is nearly in order
        // already; lists of up to 20 are sorted in place without allocating.
        self.cycle.order.sort_by_key(rank);
        let ids = || {
            let chosen = self.cycle.order.iter().filter(|at| wanted(at));
            chosen
                .filter_map(|at| slots.get(*at))
                .map(|slot| slot.member.id())
        };
        let count = ids().count();
        if count > 0 {
            let _ = dynamixel2::sync_read(self.line.packet_so_far(), block.address, block.bytes, ids());
        }
        self.cycle.asked = (count > 0).then_some(asked);
        self.cycle.asked_count = count;
        let sent = self.line.send(now, ids(), usize::from(block.bytes));
        sent.map_err(|source| BusError::transport(&self.settings.name, source))
    }

    fn poll_cycle(&mut self, now: Instant, emit: &mut dyn FnMut(BusEvent)) -> Result<(), BusError> {
        let Self {
            line,
            slots,
            table,
            counters,
            cycle,
            settings,
            ..
        } = self;
        let asked = cycle.asked;
        let mut urgent = false;
        let lost = &mut cycle.lost;
        let progress = line
            .poll(now, &mut |answer| {
                let at = slots.iter().position(|slot| slot.member.id() == answer.status.id);
                let Some((member, slot)) = at.and_then(|at| Some((at, slots.get_mut(at)?))) else {
                    return;
                };
                urgent |= answer.status.error.alert() && slot.supply.error_bits == 0;
                if answer.status.error.number() != 0 {
                    emit(BusEvent::Refused {
                        member,
                        error: answer.status.error.number(),
                    });
                    return;
                }
                match asked {
                    Some(Asked::Status) => {
                        if let Some(event) = slot.take_status(table, member, &answer, now) {
                            counters.stale += u64::from(matches!(event, BusEvent::Stale { .. }));
                            counters.implausible += u64::from(matches!(event, BusEvent::Implausible { .. }));
                            emit(event);
                        }
                    }
                    Some(Asked::Health(item)) => {
                        let confirmed = lost.get_mut(member);
                        let event = slot.take_health(table, member, item, &answer, confirmed, settings.hot_c);
                        if let Some(event) = event {
                            emit(event);
                        }
                    }
                    None => {}
                }
            })
            .map_err(|source| BusError::transport(&settings.name, source))?;
        cycle.urgent |= urgent;
        if progress == Progress::Done {
            self.settle_and_tell(emit);
        }
        let tripped = self.cycle.lost.iter().any(|lost| lost[1] >= CONFIRMATIONS);
        let doubted = self
            .slots
            .iter()
            .any(|slot| slot.late_in_a_row >= LATE_IN_A_ROW_MAX);
        if matches!(self.mode, Mode::Armed) && (tripped || doubted) {
            self.slots.iter_mut().for_each(|slot| slot.late_in_a_row = 0);
            self.begin_pinning(now)?;
        }
        Ok(())
    }

    /// Uses time in which no goals are due, until `until`, for the next health reading. Never waits. Without
    /// it, health is read instead of positions now and then.
    pub fn use_pause(&mut self, now: Instant, until: Instant) -> Result<(), BusError> {
        let idle = matches!(self.mode, Mode::Loose | Mode::Armed) && self.line.deadline().is_none();
        let due = self.cycle.urgent || now.since(self.cycle.health_at) >= self.settings.health_interval;
        let bytes = self.slots.len() + dynamixel2::INSTRUCTION_OVERHEAD_BYTES + 4;
        let takes = self
            .line
            .exchange_time(bytes, self.slots.len(), usize::from(self.table.supply.bytes));
        if !idle || !due || now.after(takes + MARGIN) > until {
            return Ok(());
        }
        self.line.packet();
        let asked = self.next_health(now);
        self.ask(asked, now)
    }

    /// Closes an exchange of which nothing more is expected.
    fn settle(&mut self) {
        let mut pending = std::mem::take(&mut self.cycle.pending);
        let room = pending.capacity();
        self.settle_and_tell(&mut |event| {
            // Whoever never polls is not told everything.
            if pending.len() < room {
                pending.push(event);
            }
        });
        self.cycle.pending = pending;
    }

    fn settle_and_tell(&mut self, emit: &mut dyn FnMut(BusEvent)) {
        let asked = self.cycle.asked.take();
        if asked == Some(Asked::Status) {
            let mut to_blame = true;
            for id in self.line.missing() {
                let at = self.slots.iter().position(|slot| slot.member.id() == id);
                let Some((member, slot)) = at.and_then(|at| Some((at, self.slots.get_mut(at)?))) else {
                    continue;
                };
                // Only the first is certainly to blame: the others may have waited for it.
                if to_blame && slot.presence != Presence::Absent {
                    slot.misses += 1;
                    if slot.misses >= MISSES_MAX {
                        slot.presence = Presence::Absent;
                        emit(BusEvent::Silent { member });
                    }
                }
                if slot.presence == Presence::Present {
                    slot.presence = Presence::Doubtful;
                }
                to_blame = false;
            }
        }
        self.line.abandon();
    }
}

/// After so many answers in a row that were taken for late, what is known of that servo's clock is doubted: the
/// line is let fall silent, and all are measured and pinned again.
const LATE_IN_A_ROW_MAX: u8 = 6;

impl Slot {
    /// Takes in one answer to the status read; the event says what was wrong with it, or that it is back.
    fn take_status(
        &mut self,
        table: &Table,
        member: usize,
        answer: &Answer<'_>,
        now: Instant,
    ) -> Option<BusEvent> {
        let was = self.presence;
        let reading = match self
            .member
            .reading(answer.status.data, table.status.address, answer.measured)
        {
            Ok(reading) => reading,
            Err(counts) => return Some(BusEvent::Implausible { member, counts }),
        };
        match self.freshness.judge(reading.tick, answer.sent, answer.turn, now) {
            Verdict::Fresh => self.late_in_a_row = 0,
            Verdict::Stale { by_ms } => {
                self.late_in_a_row = self.late_in_a_row.saturating_add(1);
                return Some(BusEvent::Stale { member, by_ms });
            }
            Verdict::Restarted => return Some(BusEvent::Restarted { member }),
        }
        self.reading = Some(reading);
        self.presence = Presence::Present;
        self.misses = 0;
        (was == Presence::Absent).then_some(BusEvent::Returned { member })
    }
}
