//! What a motor is, from the few numbers its maker prints.

/// Friction that is there while the shaft turns, as a share of stall torque. Measured motors: MX-64 1.1 %, STS3215
/// 1.6 %, XL330 0.5 %, XL-320 13 % (Rhoban BAM, identified on pendulums).
const COULOMB_SHARE: f64 = 0.015;
/// What it takes more to break away, as a share of stall torque. BAM: MX-64 1.6 %, XL330 1.3 %.
const BREAK_AWAY_SHARE: f64 = 0.015;
/// Friction that grows with speed, as a share of stall torque at no-load speed. BAM: MX-64 3 %, STS3215 11 %.
const VISCOUS_SHARE: f64 = 0.05;
/// Time in which full torque takes an unloaded motor to its no-load speed, for models whose rotor inertia nobody has
/// measured. BAM: MX-64 18 ms, XL330 73 ms, STS3215 52 ms.
const START_SECS: f64 = 0.04;

/// Which body a servo has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlantKind {
    /// Follows the trajectory smoothly, never faster: what is wrong in a motion is the driver's doing.
    #[default]
    Ideal,
    /// A motor with torque, inertia and friction under the servo's position loop.
    Real,
}

/// A motor with its gear, seen at the horn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::servo_bus) struct MotorFacts {
    pub(in crate::servo_bus) stall_nm: f64,
    pub(in crate::servo_bus) no_load_rad_per_s: f64,
    pub(in crate::servo_bus) volts: f64,
    pub(in crate::servo_bus) stall_a: f64,
    pub(in crate::servo_bus) standby_a: f64,
    pub(in crate::servo_bus) inertia_kg_m2: f64,
    /// While it turns.
    pub(in crate::servo_bus) friction_nm: f64,
    pub(in crate::servo_bus) break_away_nm: f64,
    pub(in crate::servo_bus) viscous_nm_s: f64,
    pub(in crate::servo_bus) ohms: f64,
    /// Torque for an ampere.
    pub(in crate::servo_bus) nm_per_a: f64,
    /// Volts for a radian a second.
    pub(in crate::servo_bus) volts_s: f64,
}

/// As printed by a maker.
#[derive(Clone, Copy, Debug)]
pub(in crate::servo_bus) struct Printed {
    pub(in crate::servo_bus) stall_nm: f64,
    pub(in crate::servo_bus) no_load_rad_per_s: f64,
    pub(in crate::servo_bus) volts: f64,
    pub(in crate::servo_bus) stall_a: f64,
    pub(in crate::servo_bus) standby_a: f64,
    pub(in crate::servo_bus) inertia_kg_m2: Option<f64>,
}

impl MotorFacts {
    /// Constants chosen so that the model stalls at the printed torque and current and runs at the printed speed,
    /// friction included.
    pub(in crate::servo_bus) fn of(printed: Printed) -> Self {
        let Printed {
            stall_nm,
            no_load_rad_per_s,
            volts,
            stall_a,
            standby_a,
            inertia_kg_m2,
        } = printed;
        let friction_nm = COULOMB_SHARE * stall_nm;
        let viscous_nm_s = VISCOUS_SHARE * stall_nm / no_load_rad_per_s;
        let ohms = volts / stall_a;
        let nm_per_a = (stall_nm + friction_nm) / stall_a;
        let idle_a = (friction_nm + viscous_nm_s * no_load_rad_per_s) / nm_per_a;
        Self {
            stall_nm,
            no_load_rad_per_s,
            volts,
            stall_a,
            standby_a,
            inertia_kg_m2: inertia_kg_m2.unwrap_or(START_SECS * stall_nm / no_load_rad_per_s),
            friction_nm,
            break_away_nm: friction_nm + BREAK_AWAY_SHARE * stall_nm,
            viscous_nm_s,
            ohms,
            nm_per_a,
            volts_s: (volts - ohms * idle_a) / no_load_rad_per_s,
        }
    }
}
