//! A bus of servos as one thing: limited goals out, fresh readings in.
//!
//! The bus owns the limits, so there is no way around them: only [`Bus::command`] and the pinning of arming
//! write Goal Position, the first through the limiter, the second with the measured position. Nothing here
//! waits, but for the functions called `..._blocking`.

use super::arming::{Arming, Refusal};
use super::cycle::Cycle;
use super::freshness::{Freshness, Verdict};
use super::gather::{Gather, Gathered};
use super::limit::{Change, Limiter};
use super::line::Line;
use super::member::{Member, Reading, Supply};
use super::register::RegisterError;
use super::table::Table;
use crate::clock::{Clock, Instant};
use crate::transport::{Transport, TransportError};
use std::time::Duration;

/// One count of Bus Watchdog (e-manual).
const WATCHDOG_STEP: Duration = Duration::from_millis(20);
/// Highest count of Bus Watchdog (e-manual).
const WATCHDOG_COUNTS_MAX: u128 = 127;
/// One count of Return Delay Time (e-manual).
const RETURN_DELAY_STEP: Duration = Duration::from_micros(2);

/// How a bus is run. The defaults suit a USB adapter whose latency timer is at 1 to 4 ms.
#[derive(Debug, Clone, PartialEq)]
pub struct BusSettings {
    /// What the puppet calls the bus; for messages.
    pub name: String,
    /// Line speed.
    pub baud: u32,
    /// How long after the wire's own time an answer may come before the servo counts as silent.
    pub answer_slack: Duration,
    /// After so long without packets servos stop by themselves; 20 ms to 2540 ms.
    pub watchdog: Duration,
    /// Return Delay Time in steps of 2 us; 0 is fastest, some chains need 1.
    pub return_delay_counts: u8,
    /// Silence on the line after a missing answer, before the next question of arming or maintenance.
    pub quiet: Duration,
    /// A servo this warm is not armed, and reported while it runs.
    pub hot_c: f64,
    /// How often errors, torque, watchdog and supply are read in turn.
    pub health_interval: Duration,
    /// Cycles between attempts to hear a servo that does not answer.
    pub probe_cycles: u32,
}

impl BusSettings {
    /// The usual settings.
    pub fn new(name: &str, baud: u32) -> Self {
        Self {
            name: name.to_owned(),
            baud,
            answer_slack: Duration::from_millis(8),
            watchdog: Duration::from_millis(200),
            return_delay_counts: 0,
            quiet: Duration::from_millis(40),
            // 5 below the lowest factory Temperature Limit of the X series (70 C).
            hot_c: 65.0,
            health_interval: Duration::from_millis(100),
            probe_cycles: 50,
        }
    }

    pub(super) fn watchdog_counts(&self) -> u8 {
        let counts = self.watchdog.as_nanos().div_ceil(WATCHDOG_STEP.as_nanos());
        counts.clamp(1, WATCHDOG_COUNTS_MAX) as u8
    }

    pub(super) fn return_delay(&self) -> Duration {
        RETURN_DELAY_STEP * u32::from(self.return_delay_counts)
    }
}

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
    /// Two models whose registers lie in different places cannot share sync instructions.
    #[error(
        "bus \"{bus}\": \"{first}\" and \"{second}\" have different control tables; put them on two buses"
    )]
    MixedTables {
        /// The bus's name.
        bus: String,
        /// One model.
        first: String,
        /// The other.
        second: String,
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

/// What somebody would like.
#[derive(Debug, Clone, Copy)]
pub enum Goal<'a> {
    /// An angle for each member, in member order; limited before it is sent.
    Positions(&'a [f64]),
    /// The shortest stop of every member.
    Standstill,
}

/// What the limits changed about one member's goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intervention {
    /// Place in member order.
    pub member: usize,
    /// What was changed.
    pub change: Change,
}

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Commanded {
    /// Goals were limited and sent.
    Sent,
    /// Answers are still on the wire: nothing was sent, and the goals did not move.
    Busy,
    /// The pause was so long that the servos' watchdogs have stopped them: they are measured and pinned
    /// again, and goals are taken when [`Bus::armed`] says so.
    Lapsed,
}

/// Whether goals are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Armed {
    /// Torque is off, or as somebody else left it.
    No,
    /// Being measured, configured and pinned.
    Arming,
    /// Pinned, torque on, watchdog armed.
    Yes,
    /// Torque is being switched off and this is being checked.
    Releasing,
}

/// Whether a servo answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// It answered the last time it was asked.
    Present,
    /// It did not, which may be the fault of one before it.
    Doubtful,
    /// It did not, twice, while all others did.
    Absent,
}

/// Something the bus found out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BusEvent {
    /// All members are pinned and have torque.
    Armed,
    /// See [`Bus::refusals`]; torque is being switched off.
    ArmingRefused,
    /// Torque is off, as far as members answer; see [`Bus::refusals`] for any that keep it.
    Released,
    /// A servo counts as absent now.
    Silent {
        /// Place in member order.
        member: usize,
    },
    /// It answers again.
    Returned {
        /// Place in member order.
        member: usize,
    },
    /// A late answer was recognised and thrown away.
    Stale {
        /// Place in member order.
        member: usize,
        /// How late, as far as its clock tells.
        by_ms: f64,
    },
    /// A position that cannot be was thrown away.
    Implausible {
        /// Place in member order.
        member: usize,
        /// As sent.
        counts: i64,
    },
    /// The servo's clock began again: it was rebooted and has lost torque and settings.
    Restarted {
        /// Place in member order.
        member: usize,
    },
    /// It refused an instruction; the number is the e-manual's.
    Refused {
        /// Place in member order.
        member: usize,
        /// Number of the error.
        error: u8,
    },
    /// Hardware Error Status is not zero.
    HardwareError {
        /// Place in member order.
        member: usize,
        /// Hardware Error Status.
        bits: u8,
    },
    /// Warmer than the settings allow.
    Hot {
        /// Place in member order.
        member: usize,
        /// Present Temperature.
        temperature_c: f64,
    },
    /// Torque is off although the bus is armed.
    TorqueLost {
        /// Place in member order.
        member: usize,
    },
    /// The servo's watchdog has stopped it: all are being measured and pinned again.
    WatchdogTripped {
        /// Place in member order.
        member: usize,
    },
}

/// Counts since the bus was made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BusCounters {
    /// Cycles sent.
    pub cycles: u64,
    /// Commands that found the wire busy.
    pub busy: u64,
    /// Late answers thrown away, whichever way they were recognised.
    pub stale: u64,
    /// Positions that cannot be.
    pub implausible: u64,
    /// Answers missing at their deadline.
    pub timeouts: u64,
    /// Damaged packets.
    pub rejected: u64,
    /// Our own instructions heard back.
    pub echoes: u64,
    /// Bytes written.
    pub sent_bytes: u64,
    /// Bytes read.
    pub received_bytes: u64,
}

/// What the bus is about.
#[derive(Debug, Clone)]
pub(super) enum Mode {
    Loose,
    Arming(Arming),
    Armed,
    Releasing(Releasing),
}

/// Torque going off, until every member that answers has confirmed it.
#[derive(Debug, Clone)]
pub(super) struct Releasing {
    pub(super) written: u8,
    pub(super) gather: Gather,
}

/// A member and all that is known about it.
#[derive(Debug)]
pub(super) struct Slot {
    pub(super) member: Member,
    pub(super) reading: Option<Reading>,
    pub(super) supply: Supply,
    pub(super) presence: Presence,
    pub(super) misses: u32,
    pub(super) freshness: Freshness,
    pub(super) limiter: Option<Limiter>,
    /// The measured position that the goal is pinned to while arming.
    pub(super) pin: Option<Reading>,
    /// Min and Max Position Limit; none until read.
    pub(super) accepts: Option<[i64; 2]>,
}

impl Slot {
    fn new(member: Member) -> Self {
        Self {
            member,
            reading: None,
            supply: Supply::default(),
            presence: Presence::Present,
            misses: 0,
            freshness: Freshness::default(),
            limiter: None,
            pin: None,
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
        match self.freshness.judge(reading.tick, answer.sent, answer.received) {
            Verdict::Fresh => {
                self.reading = Some(reading);
                self.presence = Presence::Present;
                self.misses = 0;
                Some(reading)
            }
            // A restarted servo is asked once more, then its clock is known again.
            Verdict::Stale { .. } | Verdict::Restarted => None,
        }
    }
}

/// Servos on one line. See the module's opening for what it guarantees.
pub struct Bus {
    pub(super) settings: BusSettings,
    pub(super) slots: Vec<Slot>,
    pub(super) table: Table,
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
        let Some(first) = members.first() else {
            return Err(BusError::Empty { bus });
        };
        let register = |source| BusError::Register {
            bus: settings.name.clone(),
            source,
        };
        let table = Table::of(first).map_err(register)?;
        for (at, member) in members.iter().enumerate() {
            if !Table::of(member).map_err(register)?.same_places(&table) {
                let [first, second] = [first, member].map(|member| member.servo().name.clone());
                return Err(BusError::MixedTables { bus, first, second });
            }
            if let Some(other) = members.iter().take(at).find(|other| other.id() == member.id()) {
                let [first, second] = [other, member].map(|member| member.joint().to_owned());
                return Err(BusError::SameId {
                    bus,
                    first,
                    second,
                    id: member.id(),
                });
            }
        }
        let mut line = Line::new(transport, settings.baud, settings.answer_slack);
        line.set_baud(settings.baud)
            .map_err(|source| BusError::transport(&bus, source))?;
        Ok(Self {
            cycle: Cycle::new(members.len()),
            slots: members.into_iter().map(Slot::new).collect(),
            settings,
            table,
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
            stale: self.counters.stale + line.stray_answers,
            timeouts: line.timeouts,
            rejected: line.rejected,
            echoes: line.echoes,
            sent_bytes: line.sent_bytes,
            received_bytes: line.received_bytes,
            ..self.counters
        }
    }

    /// Waits on the line for bytes, until the clock reads `until`.
    pub fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.line.transport_mut().wait(clock, until);
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
            slot.reading = None;
            slot.pin = None;
            slot.presence = Presence::Present;
            slot.misses = 0;
            slot.freshness.forget();
        }
        let baud = self.settings.baud;
        self.line
            .set_baud(baud)
            .map_err(|source| BusError::transport(&self.settings.name, source))
    }

    pub(super) fn ids(&self) -> Vec<u8> {
        self.slots.iter().map(|slot| slot.member.id()).collect()
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
