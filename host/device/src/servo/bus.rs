//! A bus of servos as one thing: limited goals out, fresh readings in.
//!
//! The bus owns the limits, so there is no way around them: only [`Bus::command`] and the pinning of arming
//! write Goal Position, the first through the limiter, the second with the measured position. Nothing here
//! waits, but for the functions called `..._blocking`.

use super::arming::{Arming, Refusal};
use super::company::Company;
use super::cycle::Cycle;
use super::event::{Armed, BusCounters, Presence};
use super::limit::Limiter;
use super::line::Line;
use super::member::{Member, Reading, Supply};
use super::register::RegisterError;
use super::release::Releasing;
use super::settings::BusSettings;
use super::slot::Slot;
use super::table::Table;
use super::writes::GoalGroup;
use crate::clock::{Clock, Instant};
use crate::transport::{Awaited, LINES_MAX, Transport, TransportError, wait_any};

/// Why a bus cannot do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum BusError {
    /// The line itself failed.
    #[error("bus \"{bus}\": {source}")]
    Transport {
        /// The bus's name.
        bus: String,
        /// What the line says.
        source: TransportError,
    },
    /// Goals are only taken while armed.
    #[error("bus \"{bus}\" is not armed: arm it first, so that goals start from measured positions")]
    NotArmed {
        /// The bus's name.
        bus: String,
    },
    /// A pose of another puppet.
    #[error("bus \"{bus}\": got {got} goals for {want} members; give one for each, in member order")]
    GoalCount {
        /// The bus's name.
        bus: String,
        /// Members.
        want: usize,
        /// Goals.
        got: usize,
    },
    /// Two servos would answer at once.
    #[error("bus \"{bus}\": joints \"{first}\" and \"{second}\" both use id {id}; give one another id")]
    SameId {
        /// The bus's name.
        bus: String,
        /// One joint.
        first: String,
        /// The other.
        second: String,
        /// Their id.
        id: u8,
    },
    /// A bus without servos.
    #[error("bus \"{bus}\" has no members; list at least one joint on it")]
    Empty {
        /// The bus's name.
        bus: String,
    },
    /// A control table lacks what driving needs.
    #[error("bus \"{bus}\": {source}")]
    Register {
        /// The bus's name.
        bus: String,
        /// What is missing.
        source: RegisterError,
    },
}

impl BusError {
    pub(super) fn transport(bus: &str, source: TransportError) -> Self {
        Self::Transport {
            bus: bus.to_owned(),
            source,
        }
    }
}

/// What the bus is about.
#[derive(Debug, Clone)]
pub(super) enum Mode {
    Loose,
    Arming(Arming),
    Armed,
    Releasing(Releasing),
}

/// Servos on one line. See the module's opening for what it guarantees.
pub struct Bus {
    pub(super) settings: BusSettings,
    pub(super) slots: Vec<Slot>,
    pub(super) companies: Vec<Company>,
    pub(super) goals: Vec<GoalGroup>,
    pub(super) line: Line,
    pub(super) mode: Mode,
    pub(super) cycle: Cycle,
    pub(super) refusals: Vec<Refusal>,
    pub(super) counters: BusCounters,
}

impl std::fmt::Debug for Bus {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let members: Vec<(&str, u8)> = self
            .slots
            .iter()
            .map(|slot| (slot.member.joint(), slot.member.id()))
            .collect();
        f.debug_struct("Bus")
            .field("name", &self.settings.name)
            .field("members", &members)
            .finish_non_exhaustive()
    }
}

impl Bus {
    /// Takes over a line. Sends nothing yet.
    pub fn new(
        transport: Box<dyn Transport>,
        members: Vec<Member>,
        settings: BusSettings,
    ) -> Result<Self, BusError> {
        let bus = settings.name.clone();
        if members.is_empty() {
            return Err(BusError::Empty { bus });
        }
        let mut slots: Vec<Slot> = Vec::with_capacity(members.len());
        for member in members {
            if let Some(other) = slots.iter().find(|other| other.member.id() == member.id()) {
                let [first, second] = [&other.member, &member].map(|member| member.joint().to_owned());
                return Err(BusError::SameId {
                    bus,
                    first,
                    second,
                    id: member.id(),
                });
            }
            let table = Table::of(member.servo(), settings.readings);
            let table = table.map_err(|source| BusError::Register {
                bus: bus.clone(),
                source,
            })?;
            slots.push(Slot::new(member, &table));
        }
        let mut line = Line::new(transport, settings.baud, settings.answer_slack);
        line.set_alert(settings.alert);
        line.set_baud(settings.baud)
            .map_err(|source| BusError::transport(&bus, source))?;
        let companies = Company::all(&slots);
        Ok(Self {
            cycle: Cycle::new(&slots, &companies),
            goals: GoalGroup::all(&slots),
            companies,
            slots,
            settings,
            line,
            mode: Mode::Loose,
            refusals: Vec::new(),
            counters: BusCounters::default(),
        })
    }

    /// The bus's name.
    pub fn name(&self) -> &str {
        &self.settings.name
    }

    /// How it is run.
    pub fn settings(&self) -> &BusSettings {
        &self.settings
    }

    /// The members, in the order of goals and readings.
    pub fn members(&self) -> impl ExactSizeIterator<Item = &Member> {
        self.slots.iter().map(|slot| &slot.member)
    }

    /// The member at a place, if there is one.
    pub fn member(&self, member: usize) -> Option<&Member> {
        self.slots.get(member).map(|slot| &slot.member)
    }

    /// A member's last fresh reading; look at its age.
    pub fn reading(&self, member: usize) -> Option<Reading> {
        self.slots.get(member)?.reading
    }

    /// A member's last limited goal before it was rounded to counts; none while not armed.
    pub fn goal_rad(&self, member: usize) -> Option<f64> {
        Some(self.slots.get(member)?.limiter.as_ref()?.position_rad())
    }

    /// When goals were last sent, or pinned; none while not armed. Differences of goals mean something only
    /// between such moments.
    pub fn goals_at(&self) -> Option<Instant> {
        matches!(self.mode, Mode::Armed).then_some(self.cycle.commanded())
    }

    /// Whether every goal stands.
    pub fn is_still(&self) -> bool {
        self.slots
            .iter()
            .all(|slot| slot.limiter.as_ref().is_none_or(Limiter::is_still))
    }

    /// What was read in turn from a member.
    pub fn supply(&self, member: usize) -> Option<Supply> {
        Some(self.slots.get(member)?.supply)
    }

    /// Whether a member answers.
    pub fn presence(&self, member: usize) -> Option<Presence> {
        Some(self.slots.get(member)?.presence)
    }

    /// Whether goals are taken.
    pub fn armed(&self) -> Armed {
        match self.mode {
            Mode::Loose => Armed::No,
            Mode::Arming(_) => Armed::Arming,
            Mode::Armed => Armed::Yes,
            Mode::Releasing(_) => Armed::Releasing,
        }
    }

    /// Why the last arming was refused, or which members kept their torque when it was switched off.
    pub fn refusals(&self) -> &[Refusal] {
        &self.refusals
    }

    /// Counts since the bus was made.
    pub fn counters(&self) -> BusCounters {
        let line = self.line.counters();
        BusCounters {
            stale: self.counters.stale + line.late_answers,
            strays: line.stray_answers,
            timeouts: line.timeouts,
            rejected: line.rejected,
            echoes: line.echoes,
            sent_bytes: line.sent_bytes,
            received_bytes: line.received_bytes,
            ..self.counters
        }
    }

    /// Waits until it is worth calling [`Bus::poll`]: answers are there, or overdue; at the latest until the clock reads
    /// `until`. Answers that come one by one do not wake it before the last is due.
    pub fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.line.wait(clock, until);
    }

    /// The same for several buses: returns when it is worth polling one of them. None of them waits for another.
    /// At most [`crate::transport::LINES_MAX`] buses are watched.
    pub fn wait_any<'a>(buses: impl IntoIterator<Item = &'a mut Self>, clock: &dyn Clock, until: Instant) {
        let mut buses = buses.into_iter();
        let mut until = until;
        let mut lines: [Option<Awaited<'a>>; LINES_MAX] = std::array::from_fn(|_| {
            let bus = buses.next()?;
            until = bus.deadline().map_or(until, |deadline| deadline.min(until));
            Some(bus.line.awaited())
        });
        wait_any(&mut lines, clock, until);
    }

    /// When [`Bus::poll`] should be called again at the latest, if answers are outstanding.
    pub fn deadline(&self) -> Option<Instant> {
        self.line.deadline()
    }

    /// Puts the bus on another line, as after a cable was plugged in again. Nothing is assumed about the
    /// servos: they must be armed anew.
    pub fn reconnect(&mut self, transport: Box<dyn Transport>) -> Result<(), BusError> {
        self.line.replace(transport);
        self.mode = Mode::Loose;
        for slot in &mut self.slots {
            slot.limiter = None;
            slot.let_go = false;
            slot.reading = None;
            slot.pin = None;
            slot.presence = Presence::Present;
            slot.misses = 0;
            slot.firmware = None;
            slot.freshness.forget();
        }
        let baud = self.settings.baud;
        self.line
            .set_baud(baud)
            .map_err(|source| BusError::transport(&self.settings.name, source))
    }

    /// Throws away what is on the line.
    pub(super) fn drain(&mut self, now: Instant) -> Result<(), BusError> {
        self.line
            .drain(now)
            .map_err(|source| BusError::transport(&self.settings.name, source))
    }

    /// Sends what is in the packet buffer; nobody answers it.
    pub(super) fn send_unanswered(&mut self, now: Instant) -> Result<(), BusError> {
        self.line
            .send(now, [], 0)
            .map_err(|source| BusError::transport(&self.settings.name, source))
    }
}

#[cfg(test)]
#[path = "bus_tests.rs"]
mod tests;
