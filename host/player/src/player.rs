//! The state machine: orders in, goals out, once a period.
//!
//! Everything moves through `device::servo`'s limiter; what is decided here is what is wished for. Faults are
//! latched. Torque comes on only by arming, which pins every goal to the measured position first.

use crate::config::{Ending, PlayerConfig};
use crate::fault::Fault;
use crate::joints::Lines;
use crate::lag::Follower;
use crate::order::Order;
use crate::playback::Playback;
use crate::policy;
use crate::puppet::{Puppet, PuppetError};
use crate::report::{JointReport, Report};
use crate::trouble::{Bounds, Troubled};
use device::servo::{Armed, Bus, BusEvent, Commanded, Refusal};
use device::{Instant, Transport};

/// Events of one poll that are kept; more can only repeat themselves.
const EVENTS_MAX: usize = 256;

/// What the player is doing.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum State {
    /// Torque is off, or was never switched on.
    #[default]
    Released,
    /// Servos are measured, configured and pinned.
    Arming,
    /// Torque is on and the joints stand, or are coming to a stand.
    Holding,
    /// A clip or live pose is approached or followed.
    Playing,
    /// Stopped, and left only by [`Order::Reset`].
    Faulted(Fault),
}

impl State {
    /// A short name for scenarios and logs.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Released => "released",
            Self::Arming => "arming",
            Self::Holding => "holding",
            Self::Playing => "playing",
            Self::Faulted(_) => "faulted",
        }
    }
}

/// A stop under way.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stopping {
    pub(crate) since: Instant,
    pub(crate) ending: Ending,
    /// Of a hold: joints that something keeps from their goals are held where they are.
    pub(crate) settled: bool,
}

impl Stopping {
    pub(crate) fn new(since: Instant, ending: Ending) -> Self {
        Self {
            since,
            ending,
            settled: false,
        }
    }
}

/// What is wished for when nothing is being played.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stance {
    /// To stand as soon as possible.
    Stand,
    /// The pose in `wanted`.
    Pose,
}

/// Plays a puppet. See the crate's opening.
#[derive(Debug)]
pub struct Player {
    pub(crate) config: PlayerConfig,
    puppet: Puppet,
    pub(crate) lines: Lines,
    pub(crate) state: State,
    pub(crate) playback: Option<Playback>,
    pub(crate) stance: Stance,
    pub(crate) stopping: Option<Stopping>,
    pub(crate) reset_pending: bool,
    pub(crate) wanted: Vec<f64>,
    events: Vec<(usize, BusEvent)>,
    pub(crate) ticked: Option<Instant>,
    pub(crate) late_run: u32,
    /// Since when ticks have come often enough to hear every servo.
    pub(crate) listening_since: Instant,
    pub(crate) heard_operator: Instant,
    pub(crate) heartbeat_at: Option<Instant>,
    /// How each joint follows.
    pub(crate) followers: Vec<Follower>,
    /// Seconds by which each joint's goal is ahead of the clip's time.
    pub(crate) leads: Vec<f64>,
    pub(crate) troubled: Vec<Troubled>,
    pub(crate) bounds: Vec<Bounds>,
    /// How fast time runs for what is played, as a share.
    pub(crate) pace: f64,
    /// The pose in `wanted` after backing off.
    pub(crate) eased: Vec<f64>,
    /// Arming was refused since the last report, perhaps between two ticks.
    pub(crate) refused: bool,
    pub(crate) report: Report,
}

impl Player {
    /// Takes over the puppet's buses, in the puppet's order. Nothing is sent before the first tick.
    pub fn new(puppet: Puppet, buses: Vec<Bus>, config: PlayerConfig) -> Result<Self, PuppetError> {
        puppet.check(&buses)?;
        let lines = Lines::new(buses, &puppet);
        let count = lines.count();
        let bounds = policy::bounds(&puppet, &config);
        Ok(Self {
            config,
            puppet,
            lines,
            state: State::Released,
            playback: None,
            stance: Stance::Stand,
            stopping: None,
            reset_pending: false,
            wanted: vec![0.0; count],
            events: Vec::with_capacity(EVENTS_MAX),
            ticked: None,
            late_run: 0,
            listening_since: Instant::ZERO,
            heard_operator: Instant::ZERO,
            heartbeat_at: None,
            followers: vec![Follower::default(); count],
            leads: vec![0.0; count],
            troubled: vec![Troubled::default(); count],
            bounds,
            pace: 1.0,
            eased: vec![0.0; count],
            refused: false,
            report: Report {
                joints: vec![JointReport::default(); count],
                ..Report::default()
            },
        })
    }

    /// The puppet it plays.
    pub fn puppet(&self) -> &Puppet {
        &self.puppet
    }

    /// How it behaves.
    pub fn config(&self) -> &PlayerConfig {
        &self.config
    }

    /// What it is doing.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What the last tick did.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Its buses, in the puppet's order.
    pub fn buses(&self) -> impl Iterator<Item = &Bus> {
        self.lines.all.iter().map(|line| &line.bus)
    }

    /// Why arming was refused last, or which servos kept their torque: servo by servo, with the remedy.
    pub fn refusals(&self) -> impl Iterator<Item = &Refusal> {
        self.lines.all.iter().flat_map(|line| line.bus.refusals())
    }

    /// Puts one bus on a new line, as after a cable was plugged in again. Only while faulted or released;
    /// the servos must be armed anew and start from where they are measured.
    pub fn reconnect(&mut self, bus: &str, transport: Box<dyn Transport>) -> Result<(), PuppetError> {
        if let Some(line) = self.lines.all.iter_mut().find(|line| line.bus.name() == bus) {
            line.bus.reconnect(transport)?;
            line.lost = false;
            // A servo that kept its torque through the gap must not keep it unseen.
            line.release_due = true;
        }
        Ok(())
    }

    /// Gives the buses back, for maintenance. Torque is as it is: release first.
    pub fn into_buses(self) -> Vec<Bus> {
        self.lines.all.into_iter().map(|line| line.bus).collect()
    }

    /// One period: takes in answers, follows orders, judges, and sends goals. Does not wait, and does not
    /// allocate unless an order brings something new to play or something goes wrong.
    pub fn tick(&mut self, now: Instant, orders: &mut dyn Iterator<Item = Order>) -> &Report {
        self.report.rejected = None;
        let dt = self.note_time(now);
        self.take_in(now);
        for order in orders {
            self.obey(order, now);
        }
        self.watch(now, dt);
        self.proceed(now, dt * self.pace);
        self.drive(now);
        self.note_following(now);
        self.fill_report(now);
        self.report.arming_refused = std::mem::take(&mut self.refused);
        &self.report
    }

    /// Takes in answers between ticks and uses what is left of the period. Never needed, never waits.
    pub fn poll(&mut self, now: Instant) {
        self.take_in(now);
        let until = self.ticked.unwrap_or(now).after(self.config.period);
        for at in 0..self.lines.all.len() {
            let Some(line) = self.lines.all.get_mut(at) else {
                continue;
            };
            if line.lost {
                continue;
            }
            if let Err(error) = line.bus.use_pause(now, until) {
                self.lose(at, error.to_string(), now);
            }
        }
    }

    fn take_in(&mut self, now: Instant) {
        let mut events = std::mem::take(&mut self.events);
        for at in 0..self.lines.all.len() {
            let Some(line) = self.lines.all.get_mut(at) else {
                continue;
            };
            let failed = line.poll(now, &mut |event| {
                if events.len() < EVENTS_MAX {
                    events.push((at, event));
                }
            });
            if let Some(why) = failed {
                self.lose(at, why, now);
            }
        }
        for (at, event) in events.drain(..) {
            self.hear(at, event, now);
        }
        self.events = events;
    }

    /// Waits on all lines until `until`, or until it is worth listening to one of them.
    pub(crate) fn wait(&mut self, clock: &dyn device::Clock, until: Instant) {
        let there = self.lines.all.iter_mut().filter(|line| !line.lost);
        Bus::wait_any(there.map(|line| &mut line.bus), clock, until);
    }

    pub(crate) fn lose(&mut self, at: usize, why: String, now: Instant) {
        if let Some(line) = self.lines.all.get_mut(at) {
            line.lost = true;
            let bus = line.bus.name().to_owned();
            self.fault(Fault::BusLost { bus, why }, now);
        }
    }

    /// Latches a fault and begins to stop. The first fault stays, but a pressed stop is always shown.
    pub(crate) fn fault(&mut self, fault: Fault, now: Instant) {
        let faulted = matches!(self.state, State::Faulted(_));
        if faulted && fault != Fault::StopPressed {
            return;
        }
        tracing::warn!(fault = fault.name(), "{fault}");
        let was_released = self.state == State::Released;
        if was_released {
            self.lines.release_all(now);
        }
        let ending = self.ending_of(&fault);
        self.state = State::Faulted(fault);
        self.playback = None;
        self.reset_pending = false;
        let holds = self
            .stopping
            .is_none_or(|stopping| stopping.ending == Ending::Hold);
        if !faulted || holds {
            let ending = if was_released { Ending::Release } else { ending };
            self.stopping = Some(Stopping::new(now, ending));
        }
    }

    /// Sends goals where there is torque, looks where there is none.
    fn drive(&mut self, now: Instant) {
        let posed = self.ease();
        self.report.goals_sent = !self.lines.all.is_empty();
        for at in 0..self.lines.all.len() {
            let Some(line) = self.lines.all.get_mut(at) else {
                continue;
            };
            if line.release_due {
                line.release(now);
            }
            let pose = posed.then_some(self.eased.as_slice());
            let result = match line.bus.armed() {
                _ if line.lost => Ok(Commanded::Busy),
                Armed::Yes => line.command(pose, now, &mut self.report.interventions),
                Armed::No => line.bus.observe(now).map(|_| Commanded::Busy),
                Armed::Arming | Armed::Releasing => Ok(Commanded::Busy),
            };
            match result {
                Ok(commanded) => self.report.goals_sent &= commanded == Commanded::Sent,
                Err(error) => {
                    self.report.goals_sent = false;
                    self.lose(at, error.to_string(), now);
                }
            }
        }
    }

    fn fill_report(&mut self, now: Instant) {
        let Self {
            report,
            lines,
            followers,
            troubled,
            ..
        } = self;
        report.at = now;
        if report.state != self.state {
            report.state.clone_from(&self.state);
        }
        report.phase = self
            .playback
            .as_ref()
            .map(|playback| playback.phase)
            .unwrap_or_default();
        report.pace = self.pace;
        report.clip_secs = self.playback.as_ref().and_then(Playback::secs);
        report.torque = !lines.all_loose() || lines.any_torque();
        report.torque_unknown = lines.torque_unknown();
        report.stale_discarded = 0;
        report.timeouts = 0;
        for line in &lines.all {
            let counters = line.bus.counters();
            report.stale_discarded = report.stale_discarded.saturating_add(counters.stale);
            report.timeouts = report.timeouts.saturating_add(counters.timeouts);
        }
        for (at, joint) in report.joints.iter_mut().enumerate() {
            *joint = lines.joint_report(at);
            let tracking = followers.get(at).map(Follower::tracking).unwrap_or_default();
            joint.lag_secs = tracking.lag_secs;
            joint.tracking = tracking;
            if let Some(troubled) = troubled.get(at) {
                joint.trouble = troubled.worst();
                joint.retreat = troubled.retreat();
            }
        }
    }

    /// Goes from one state to the next where that needs no order.
    fn proceed(&mut self, now: Instant, dt_secs: f64) {
        if let Some(stopping) = self.stopping {
            self.stop_further(stopping, now);
        }
        match self.state {
            State::Arming if self.lines.all_armed() => {
                self.state = State::Holding;
                self.stance = Stance::Stand;
            }
            State::Playing => self.play_further(now, dt_secs),
            State::Faulted(_) if self.reset_pending && self.stopping.is_none() && self.lines.all_loose() => {
                self.reset_pending = false;
                self.state = State::Released;
            }
            _ => {}
        }
    }

    /// Waits until the joints stand, then ends as wished.
    fn stop_further(&mut self, stopping: Stopping, now: Instant) {
        for line in &mut self.lines.all {
            // What is not pinned yet does not move: it can be switched off at once.
            if line.bus.armed() == Armed::Arming {
                line.release(now);
            }
        }
        let waited_enough = now.since(stopping.since) >= self.config.braking_max;
        if !(self.lines.all_still() || waited_enough) {
            return;
        }
        if stopping.ending == Ending::Hold {
            self.hold_where_joints_are(stopping);
            return;
        }
        for line in &mut self.lines.all {
            if matches!(line.bus.armed(), Armed::Yes | Armed::Arming) {
                line.release(now);
            }
        }
        let patient = now.since(stopping.since) < self.config.braking_max + self.config.confirm_max;
        if self.lines.all_loose() && !(patient && self.lines.release_unconfirmed(now)) {
            self.stopping = None;
            if self.state == State::Holding {
                self.state = State::Released;
            }
        }
    }
}

#[cfg(test)]
#[path = "player_tests.rs"]
mod tests;
