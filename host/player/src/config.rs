//! How a player behaves when nobody says otherwise.

use std::time::Duration;

/// What happens to torque after a stop, once the joints stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// Torque goes off: nothing can move by itself, but the joints sag.
    Release,
    /// The joints are held where they stand.
    Hold,
}

/// The numbers are this project's choices for puppets of small servos.
#[derive(Debug, Clone, PartialEq)]
pub struct PlayerConfig {
    /// Time between ticks, as whoever ticks intends it; 0.5 to 50 ms.
    pub period: Duration,
    /// What follows a stop or a fault.
    pub ending: Ending,
    /// Share of each joint's speed and acceleration limits that an approach may use, 0 to 1.
    pub approach_share: f64,
    /// How near all goals must be before the clip's time begins to run.
    pub arrived_rad: f64,
    /// How near the measured joints must be; a joint that sags more than this is waited for, but not longer
    /// than `arrival_patience`.
    pub settled_rad: f64,
    /// How long to wait for joints to settle at the end of an approach.
    pub arrival_patience: Duration,
    /// A loop whose last and first pose differ by no more is played through without an approach.
    pub seam_rad: f64,
    /// A tick that comes later than this after its time is late.
    pub late_after: Duration,
    /// So many late ticks in a row are a fault.
    pub late_ticks_max: u32,
    /// A member without a fresh reading for so long is a fault.
    pub silence_max: Duration,
    /// A joint this far from its goal ...
    pub strain_rad: f64,
    /// ... for so long is blocked, and a fault.
    pub strain_max: Duration,
    /// Without any order for so long while there is torque, the operator is gone; none: not watched.
    pub operator_max: Option<Duration>,
    /// Without [`crate::Order::Heartbeat`] for so long the puppet cannot be armed, and with torque it is a fault;
    /// none: no heartbeat is needed.
    pub heartbeat_max: Option<Duration>,
    /// Longest time that a stop waits for joints to stand before it ends anyway.
    pub braking_max: Duration,
    /// How much longer torque is switched off again and again while not every servo has said that it is.
    pub confirm_max: Duration,
}

impl Default for PlayerConfig {
    fn default() -> Self {
        Self {
            period: Duration::from_millis(20),
            ending: Ending::Release,
            approach_share: 0.5,
            arrived_rad: 0.002,
            settled_rad: 0.05,
            arrival_patience: Duration::from_secs(1),
            seam_rad: 0.02,
            late_after: Duration::from_millis(20),
            late_ticks_max: 10,
            // Longer than a busy host's or adapter's stall; the servos' own watchdogs act long before.
            silence_max: Duration::from_millis(500),
            strain_rad: 0.6,
            strain_max: Duration::from_secs(1),
            operator_max: None,
            heartbeat_max: None,
            braking_max: Duration::from_secs(2),
            confirm_max: Duration::from_secs(2),
        }
    }
}
