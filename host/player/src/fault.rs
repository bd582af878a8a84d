//! Why a player stopped by itself. Left only by [`crate::Order::Reset`].

use device::servo::member::error_names;

/// One servo, named as people know it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The bus's name.
    pub bus: String,
    /// The joint's name.
    pub joint: String,
    /// The servo's id.
    pub id: u8,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "joint \"{}\" (bus \"{}\", servo {})",
            self.joint, self.bus, self.id
        )
    }
}

/// What was wrong, and what helps.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// Somebody pressed stop.
    #[error("stop was pressed; reset, then arm again")]
    StopPressed,
    /// The host cannot keep the period.
    #[error("{count} ticks in a row came late; close other programs or play at a lower rate")]
    LateTicks {
        /// How many.
        count: u32,
    },
    /// A servo has not been heard.
    #[error("{0} does not answer; check its cable and the one before it, then power")]
    BusSilent(Place),
    /// The line itself failed.
    #[error("{why}; its servos stop by themselves and stand with torque on: plug it in again, then reset")]
    BusLost {
        /// The bus's name.
        bus: String,
        /// What the line says, with the bus's name.
        why: String,
    },
    /// A hardware error is latched.
    #[error("{place} reports {}; remove the cause, then switch its power off and on, or reboot it: dialrig servo reboot --id {} --port PORT", error_names(*bits), place.id)]
    ServoError {
        /// Which servo.
        place: Place,
        /// Hardware Error Status.
        bits: u8,
    },
    /// Too warm.
    #[error("{place} is at {temperature_c} C; let it cool down")]
    Hot {
        /// Which servo.
        place: Place,
        /// Present Temperature.
        temperature_c: f64,
    },
    /// It is far from its goal and stays there.
    #[error("{place} is {by_rad:.2} rad from its goal; look for what blocks it")]
    Strained {
        /// Which servo.
        place: Place,
        /// Distance from the goal.
        by_rad: f64,
    },
    /// It pulls with nearly all it has, for long, and backing off has not helped or is not wanted.
    #[error("{0} pulls with nearly all it has; take load off it, or look for what blocks it")]
    Overloaded(Place),
    /// Its supply fails.
    #[error(
        "{place} has only {voltage_v:.1} V; check the supply and its cable, or move fewer joints at once"
    )]
    BrownOut {
        /// Which servo.
        place: Place,
        /// Present Input Voltage.
        voltage_v: f64,
    },
    /// It was rebooted, or its power failed for a moment.
    #[error("{0} has restarted; check its power supply, then arm again")]
    Restarted(Place),
    /// Torque is off although it was switched on.
    #[error("{0} has lost its torque; look at its lamp and power, then arm again")]
    TorqueLost(Place),
    /// Pinning it again after a pause was refused.
    #[error("{0}")]
    Refused(String),
    /// No sign of life from whoever is in charge.
    #[error("no sign of life from the operator; reset, then arm again")]
    OperatorGone,
    /// The heartbeat that this puppet needs has stopped.
    #[error("the heartbeat has stopped; see to whoever sends it, reset, then arm again")]
    HeartbeatLost,
}

impl Fault {
    /// A short name for scenarios and logs.
    pub fn name(&self) -> &'static str {
        match self {
            Self::StopPressed => "stop-pressed",
            Self::LateTicks { .. } => "late-ticks",
            Self::BusSilent(_) => "bus-silent",
            Self::BusLost { .. } => "bus-lost",
            Self::ServoError { .. } => "servo-error",
            Self::Hot { .. } => "hot",
            Self::Strained { .. } => "strained",
            Self::Overloaded(_) => "overloaded",
            Self::BrownOut { .. } => "brown-out",
            Self::Restarted(_) => "restarted",
            Self::TorqueLost(_) => "torque-lost",
            Self::Refused(_) => "refused",
            Self::OperatorGone => "operator-gone",
            Self::HeartbeatLost => "heartbeat-lost",
        }
    }
}
