//! What one tick did, for logs and windows. Owned by the player and overwritten each tick.

use crate::lag::Tracking;
use crate::order::Rejection;
use crate::player::State;
use crate::trouble::Trouble;
use device::Instant;
use device::servo::{Change, Load, Presence};
use std::time::Duration;

/// Where playing stands.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Phase {
    /// Not playing.
    #[default]
    Idle,
    /// Coming to a stand before anything else.
    Braking,
    /// On the way to the first pose; the clip's time stands still.
    Approaching,
    /// The clip's time runs, or the live pose is followed.
    Running,
    /// Servos stopped during a pause of the host are being measured and pinned again.
    Pinning,
}

/// What the limits changed, counted since the player was made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Interventions {
    /// Wishes that were no numbers.
    pub not_finite: u64,
    /// Wishes outside a range.
    pub position: u64,
    /// Wishes too fast.
    pub velocity: u64,
    /// Wishes too sudden.
    pub acceleration: u64,
    /// Pauses of the host after which goals braked.
    pub stalled: u64,
}

impl Interventions {
    pub(crate) fn add(&mut self, change: Change) {
        let count = match change {
            Change::NotFinite => &mut self.not_finite,
            Change::Position { .. } => &mut self.position,
            Change::Velocity => &mut self.velocity,
            Change::Acceleration => &mut self.acceleration,
            Change::Stalled => &mut self.stalled,
        };
        *count = count.saturating_add(1);
    }

    /// All together.
    pub fn total(&self) -> u64 {
        [
            self.not_finite,
            self.position,
            self.velocity,
            self.acceleration,
            self.stalled,
        ]
        .iter()
        .fold(0, |sum, count| sum.saturating_add(*count))
    }
}

/// One joint after a tick.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JointReport {
    /// The limited goal before it is rounded to counts; none without torque.
    pub goal_rad: Option<f64>,
    /// When that goal was sent. Speeds and accelerations by differences are only meaningful between goals
    /// that were.
    pub goal_at: Option<Instant>,
    /// The last fresh measurement; none before the first.
    pub measured_rad: Option<f64>,
    /// When that was measured.
    pub measured_at: Option<Instant>,
    /// Measured speed.
    pub velocity_rad_per_s: f64,
    /// Measured current or load.
    pub load: Option<Load>,
    /// Volts at the servo.
    pub voltage_v: Option<f64>,
    /// Degrees Celsius in the servo.
    pub temperature_c: Option<f64>,
    /// Hardware Error Status.
    pub error_bits: u8,
    /// Whether it answers.
    pub presence: Option<Presence>,
    /// Whether the limits changed this tick's goal.
    pub limited: bool,
    /// How long after its goals the joint is where they were, seconds; none until it has moved enough.
    pub lag_secs: Option<f64>,
    /// How well it follows.
    pub tracking: Tracking,
    /// What is wrong with it that can still be helped.
    pub trouble: Option<Trouble>,
    /// Share of the way from wish to joint that its goal has retreated, 0 to 1.
    pub retreat: f64,
}

/// One tick.
#[derive(Debug, Clone, Default)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct Report {
    /// When.
    pub at: Instant,
    /// The state after it.
    pub state: State,
    /// Where playing stands.
    pub phase: Phase,
    /// How fast time runs for what is played, as a share of what was asked for; less than 1 while backing off.
    pub pace: f64,
    /// What the puppet backs off for, and the joint; the worst, and the first that has it.
    pub backing_off: Option<(Trouble, usize)>,
    /// The clip's time, while one is loaded.
    pub clip_secs: Option<f64>,
    /// Whether goals went out on every bus in this tick.
    pub goals_sent: bool,
    /// Whether any bus may have torque.
    pub torque: bool,
    /// Whether servos that had torque can no longer be asked, or have not answered that it is off.
    pub torque_unknown: bool,
    /// Whether goals are taken ahead of time by each joint's lag.
    pub compensates_lag: bool,
    /// Joints in the puppet's order.
    pub joints: Vec<JointReport>,
    /// How late this tick was.
    pub lateness: Duration,
    /// Late ticks since the player was made.
    pub late_ticks: u64,
    /// What the limits changed since the player was made.
    pub interventions: Interventions,
    /// Late answers thrown away since the player was made.
    pub stale_discarded: u64,
    /// Answers that did not come in time since the player was made.
    pub timeouts: u64,
    /// The last order of this tick that was not followed.
    pub rejected: Option<Rejection>,
    /// Arming was refused in this tick or since the one before; [`crate::Player::refusals`] says why.
    pub arming_refused: bool,
}
