//! What the motor and its gears can do, for simulating them and for telling what a clip asks too much of.

use serde::{Deserialize, Serialize};

/// The motor at its rated voltage, seen from the horn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motor {
    /// Where the numbers are from, and which are estimates.
    pub source: String,
    /// The supply the numbers below are for.
    pub rated_voltage_v: f64,
    /// Torque at standstill.
    pub stall_torque_nm: f64,
    /// Speed without load.
    pub no_load_speed_rad_per_s: f64,
    /// Current at standstill under full drive.
    pub stall_current_a: f64,
    /// Current with torque off; absent: not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standby_current_a: Option<f64>,
    /// Inertia of rotor and gears as the horn feels it: the rotor's times the square of the reduction.
    pub rotor_inertia_kg_m2: f64,
    /// The inertia was not identified on this model but reckoned from a similar one.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub inertia_estimated: bool,
}

impl Motor {
    /// Every number that must be finite and above 0, with its key.
    pub(super) fn numbers(&self) -> [(&'static str, f64); 5] {
        [
            ("rated_voltage_v", self.rated_voltage_v),
            ("stall_torque_nm", self.stall_torque_nm),
            ("no_load_speed_rad_per_s", self.no_load_speed_rad_per_s),
            ("stall_current_a", self.stall_current_a),
            ("rotor_inertia_kg_m2", self.rotor_inertia_kg_m2),
        ]
    }
}
