//! The cycle: goals out and readings in, in one write, and what is left to read in what is left of the period.
//!
//! A bus of one company is read whole with every command. Where there are several companies (two protocols, or servos
//! without group reads) the first of those whose turn it is goes with the command, and the others follow one by one
//! as long as there is time ([`Bus::use_pause`]); who was not reached comes first next time. Goals go to all, always.
//!
//! A servo that does not answer can silence those behind it (some firmware waits for the one before), so
//! members are asked in an order: those that answered first, then those that did not, the one to blame last.
//! Only a member whose predecessors all answered is blamed.

use super::ask::{Asked, Chosen};
use super::bus::{Bus, BusError, Mode};
use super::company::Company;
use super::event::{Armed, BusEvent, Commanded, Goal, Intervention, Presence};
use super::health::{CONFIRMATIONS, Item};
use super::line::Progress;
use super::slot::Slot;
use crate::clock::Instant;

/// So often in a row a member must be the one to blame before it counts as absent: at one answer in ten lost
/// this happens by chance once in 10^10 cycles.
const MISSES_MAX: u32 = 10;
/// After so many answers in a row that were taken for late, what is known of that servo's clock is doubted: the
/// line is let fall silent, and all are measured and pinned again.
const LATE_IN_A_ROW_MAX: u8 = 6;
/// So often in one cycle those are asked again whom a silence before them may have kept from answering: once after a
/// failed fast read, once more when it is known who is to blame.
const AGAIN_MAX: u8 = 2;
/// Health readings in one health interval on a bus of one company; more companies are read as often.
const ITEMS: u32 = Item::ALL.len() as u32;

/// Where the cycle stands.
#[derive(Debug)]
pub(super) struct Cycle {
    pub(super) asked: Option<Asked>,
    /// The company that is asked.
    pub(super) company: usize,
    /// By a fast read.
    pub(super) fast: bool,
    pub(super) chosen: Vec<Chosen>,
    /// Counts commands and observations.
    pub(super) number: u64,
    /// The company whose positions are read next.
    turn: usize,
    /// Companies that are still to be read in this cycle.
    left: usize,
    /// A company of which somebody unexpectedly did not answer, and who is asked again if there is time.
    again: Option<usize>,
    again_left: u8,
    /// What is read beside positions, in turn.
    rounds: Vec<(usize, Item)>,
    round: usize,
    commanded: Instant,
    health_at: Instant,
    /// A company of which a servo says that something is wrong.
    pub(super) urgent: Option<usize>,
    /// When the first ping was sent of those not answered yet.
    pub(super) pinging_since: Option<Instant>,
    /// What was found out while goals were sent; told at the next poll.
    pending: Vec<BusEvent>,
    /// Confirmations so far that a member has lost torque, or tripped.
    pub(super) lost: Vec<[u8; 2]>,
}

impl Cycle {
    pub(super) fn new(slots: &[Slot], companies: &[Company]) -> Self {
        let rounds = companies.iter().enumerate().flat_map(|(at, company)| {
            let items = company.health(slots).into_iter();
            items.map(move |item| (at, item))
        });
        Self {
            asked: None,
            company: 0,
            fast: false,
            chosen: Vec::with_capacity(slots.len()),
            number: 0,
            turn: 0,
            left: 0,
            again: None,
            again_left: 0,
            rounds: rounds.collect(),
            round: 0,
            commanded: Instant::ZERO,
            health_at: Instant::ZERO,
            urgent: None,
            pinging_since: None,
            pending: Vec::with_capacity(slots.len() * 2),
            lost: vec![[0; 2]; slots.len()],
        }
    }

    pub(super) fn commanded(&self) -> Instant {
        self.commanded
    }

    pub(super) fn restart(&mut self, now: Instant) {
        self.asked = None;
        self.left = 0;
        self.again = None;
        self.commanded = now;
        self.health_at = now;
        self.urgent = None;
        self.lost.fill([0; 2]);
    }

    /// The company whose turn it is, which goes to the next.
    fn take_turn(&mut self, companies: usize) -> usize {
        let turn = self.turn;
        self.turn = (turn + 1) % companies.max(1);
        self.left = self.left.saturating_sub(1);
        turn
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
        for slot in &mut self.slots {
            slot.let_go_unseen(now);
        }
        self.limit(goal, since.as_secs_f64(), note);
        self.line.packet();
        let first = self.begin_cycle();
        self.append_goals(first);
        self.ask_first(first, now)?;
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
        let first = self.begin_cycle();
        self.ask_first(first, now)?;
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

    /// Uses time in which no goals are due, until `until`, for what is still to be read in this cycle, then for the
    /// next health reading. Never waits; call it whenever [`Bus::poll`] was called. Without it companies are read in
    /// turn, one with each command, and health is read instead of positions now and then.
    pub fn use_pause(&mut self, now: Instant, until: Instant) -> Result<(), BusError> {
        if !self.is_idle() {
            return Ok(());
        }
        self.read_on(now, until)?;
        let due = self.cycle.urgent.is_some() || now.since(self.cycle.health_at) >= self.health_interval();
        if !self.is_idle() || !due {
            return Ok(());
        }
        let Some((company, item)) = self.next_health() else {
            return Ok(());
        };
        if now.after(self.time_for(company)) > until {
            return Ok(());
        }
        self.take_health_turn(now);
        self.line.packet();
        self.ask(company, Asked::Health(item), now)?;
        Ok(())
    }

    /// Goes on with the companies that are still to be read, if there is time.
    pub(super) fn read_on(&mut self, now: Instant, until: Instant) -> Result<(), BusError> {
        while let Some(company) = self.cycle.again.filter(|_| self.is_idle()) {
            if now.after(self.time_for(company)) > until {
                break;
            }
            self.cycle.again = None;
            self.line.packet();
            self.ask(company, Asked::Again, now)?;
        }
        while self.is_idle() && self.cycle.left > 0 {
            if now.after(self.time_for(self.cycle.turn)) > until {
                return Ok(());
            }
            let company = self.cycle.take_turn(self.companies.len());
            self.line.packet();
            self.ask(company, Asked::Status, now)?;
        }
        Ok(())
    }

    /// Whether nothing is on the line, or under way.
    fn is_idle(&self) -> bool {
        matches!(self.mode, Mode::Loose | Mode::Armed) && self.line.deadline().is_none()
    }

    /// Starts counting anew, and gives the company that is read first.
    fn begin_cycle(&mut self) -> usize {
        let companies = self.companies.len();
        self.cycle.number += 1;
        self.cycle.left = companies;
        self.cycle.again = None;
        self.cycle.again_left = AGAIN_MAX;
        // Whoever is not there need not be asked with the goals.
        for _ in 1..companies {
            let absent = self
                .companies
                .get(self.cycle.turn)
                .is_some_and(|company| company.is_absent(&self.slots));
            if !absent {
                break;
            }
            self.cycle.turn = (self.cycle.turn + 1) % companies.max(1);
        }
        self.cycle.turn
    }

    /// The goals of all, those in the protocol of the company that is read first behind the others.
    fn append_goals(&mut self, first: usize) {
        let Self {
            line,
            slots,
            goals,
            companies,
            ..
        } = self;
        let Some(protocol) = companies.get(first).map(|company| company.protocol) else {
            return;
        };
        for group in goals.iter().filter(|group| group.protocol != protocol) {
            group.append(line, slots);
        }
        line.speak(protocol);
        line.begin_own();
        for group in goals.iter().filter(|group| group.protocol == protocol) {
            group.append(line, slots);
        }
    }

    /// Appends the read that is due to the packets waiting to be sent, and sends them.
    fn ask_first(&mut self, first: usize, now: Instant) -> Result<(), BusError> {
        let overdue = now.since(self.cycle.health_at) >= self.health_interval() * 2;
        let health = (self.cycle.urgent.is_some() || overdue).then(|| self.next_health());
        let asked = if let Some((company, item)) = health.flatten() {
            self.take_health_turn(now);
            self.ask(company, Asked::Health(item), now)?
        } else {
            self.cycle.take_turn(self.companies.len());
            self.ask(first, Asked::Status, now)?
        };
        if !asked {
            // Goals are for those who cannot be asked, too.
            self.send_unanswered(now)?;
        }
        Ok(())
    }

    fn health_interval(&self) -> std::time::Duration {
        let rounds = u32::try_from(self.cycle.rounds.len()).unwrap_or(u32::MAX);
        self.settings.health_interval * ITEMS / rounds.max(ITEMS)
    }

    /// What is to be read next beside the positions.
    fn next_health(&self) -> Option<(usize, Item)> {
        let next = self.cycle.rounds.get(self.cycle.round).copied();
        let errors = |company| (company, Item::Errors);
        self.cycle.urgent.map(errors).or(next)
    }

    fn take_health_turn(&mut self, now: Instant) {
        self.cycle.health_at = now;
        if self.cycle.urgent.take().is_none() {
            self.cycle.round = (self.cycle.round + 1) % self.cycle.rounds.len().max(1);
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

    fn poll_cycle(&mut self, now: Instant, emit: &mut dyn FnMut(BusEvent)) -> Result<(), BusError> {
        if self.take_answers(now, emit)? == Progress::Done {
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
        if matches!(asked, Some(Asked::Status | Asked::Again)) {
            let well = self.line.missing().next().is_none();
            if self.cycle.fast {
                if let Some(company) = self.companies.get_mut(self.cycle.company) {
                    company.fast.went(well);
                }
                self.counters.fast_failures += u64::from(!well);
            }
            if !well && self.blame(emit) && self.cycle.again_left > 0 {
                self.cycle.again_left -= 1;
                self.cycle.again = Some(self.cycle.company);
            }
        }
        self.line.abandon();
    }

    /// Finds out who is to blame for answers that did not come. True if somebody is missing who was there before.
    fn blame(&mut self, emit: &mut dyn FnMut(BusEvent)) -> bool {
        let mut to_blame = true;
        let mut unexpected = false;
        for id in self.line.missing() {
            let chosen = self.cycle.chosen.iter().find(|chosen| chosen.id == id);
            let at = chosen.map(|chosen| chosen.member);
            let Some((member, slot)) = at.and_then(|at| Some((at, self.slots.get_mut(at)?))) else {
                continue;
            };
            unexpected |= slot.presence == Presence::Present;
            if self.cycle.fast {
                // One damaged part of the one packet condemns nobody: the next read is plain, and this one last in it.
                if to_blame {
                    slot.presence = Presence::Doubtful;
                }
                to_blame = false;
                continue;
            }
            // Only the first is certainly to blame: the others may have waited for it.
            if to_blame && slot.presence != Presence::Absent {
                slot.misses += 1;
                if slot.misses >= MISSES_MAX {
                    slot.presence = Presence::Absent;
                    emit(BusEvent::Silent { member });
                }
            }
            if slot.presence == Presence::Absent {
                slot.probe_at = self.cycle.number + u64::from(self.settings.probe_cycles);
            }
            if slot.presence == Presence::Present {
                slot.presence = Presence::Doubtful;
            }
            to_blame = false;
        }
        unexpected
    }
}
