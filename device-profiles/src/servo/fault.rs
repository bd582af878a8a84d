//! What can be wrong with a servo, whichever bit its maker chose for it.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A fault that servos watch for themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum HardwareFault {
    /// The supply is above or below its limits.
    InputVoltage,
    /// The goal lies outside the position limits.
    AngleLimit,
    /// Hotter than its limit.
    Overheating,
    /// The position sensor gives no sense.
    Encoder,
    /// The circuit is hurt, or the motor gets too little.
    ElectricalShock,
    /// More current than allowed.
    Overcurrent,
    /// More load than it can move, for too long.
    Overload,
}

impl fmt::Display for HardwareFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::InputVoltage => "input voltage",
            Self::AngleLimit => "angle limit",
            Self::Overheating => "overheating",
            Self::Encoder => "encoder",
            Self::ElectricalShock => "electrical shock",
            Self::Overcurrent => "overcurrent",
            Self::Overload => "overload",
        })
    }
}
