//! What a puppet does when something goes wrong.

use crate::read::Flaw;
use serde::{Deserialize, Serialize};

/// How a puppet answers each kind of trouble. A puppet that names none has [`Policy::default`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Policy {
    /// A servo is hotter than `hot_c`.
    pub on_heat: Reaction,
    /// A servo works at the edge of what it can, or says that it is overloaded.
    pub on_overload: Reaction,
    /// A bus's voltage falls below what its servos need.
    pub on_brownout: Reaction,
    /// The host has been silent for `heartbeat_ms`: it died, or the cable did.
    pub on_lost_host: Reaction,
    /// Silence that counts as a lost host, milliseconds; 20 to 2540, the range of DYNAMIXEL's Bus Watchdog.
    pub heartbeat_ms: u32,
    /// Degrees Celsius in a servo that count as hot; below the servo's own limit, at which it lets go by itself.
    pub hot_c: f64,
}

/// What to do about trouble.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reaction {
    /// Go on with less: slower, and with less effort.
    BackOff,
    /// Stop where it is, torque on.
    Hold,
    /// Stop and let the shafts turn freely.
    Release,
}

impl Default for Policy {
    /// Nothing falls down that stood: a puppet goes on more gently where that helps and stands still where not.
    fn default() -> Self {
        Self {
            on_heat: Reaction::BackOff,
            on_overload: Reaction::BackOff,
            on_brownout: Reaction::Hold,
            on_lost_host: Reaction::Hold,
            heartbeat_ms: 200,
            hot_c: 60.0,
        }
    }
}

impl Policy {
    pub(crate) fn flaws(&self, flaws: &mut Vec<Flaw>) {
        if !(20..=2540).contains(&self.heartbeat_ms) {
            flaws.push(Flaw::at_key(
                "heartbeat_ms",
                format!("heartbeat_ms must be 20 to 2540, found {}", self.heartbeat_ms),
            ));
        }
        if !(30.0..=100.0).contains(&self.hot_c) {
            flaws.push(Flaw::at_key(
                "hot_c",
                format!("hot_c must be 30 to 100, found {}", self.hot_c),
            ));
        }
        if self.on_lost_host == Reaction::BackOff {
            flaws.push(Flaw::at_key(
                "on_lost_host",
                "on_lost_host must be \"hold\" or \"release\", found \"back-off\": without a host nobody moves",
            ));
        }
    }
}
