//! Registers that are measured, not stored: brought up to date when they are read.

use super::reg::Reg;
use super::servo::Servo;
use super::trajectory::Kind;

/// Largest difference between trajectory and shaft that is not a following error, counts. Ours: twice the
/// distance the motor is behind at its top speed.
const FOLLOWING_ERROR_COUNTS: f64 = 200.0;
/// Largest distance from the goal that counts as being there, counts. Ours.
const IN_POSITION_COUNTS: i64 = 8;
/// Share of all there is in a count of load, where the profile does not say.
const LOAD_UNIT: f64 = 0.001;

/// Everything `fresh` knows.
const MEASURED: &[Reg] = &[
    Reg::RealtimeTick,
    Reg::Moving,
    Reg::MovingStatus,
    Reg::PresentPwm,
    Reg::PresentCurrent,
    Reg::PresentLoad,
    Reg::PresentVelocity,
    Reg::PresentPosition,
    Reg::VelocityTrajectory,
    Reg::PositionTrajectory,
    Reg::TargetPosition,
    Reg::PresentInputVoltage,
    Reg::PresentTemperature,
];

impl Servo {
    /// Measures everything at `at_ns`; the plant has been advanced to there.
    pub(super) fn refresh(&mut self, at_ns: u64) {
        for &reg in MEASURED {
            if let Some(value) = self.fresh(reg, at_ns) {
                self.table.set(reg, value);
            }
        }
    }

    /// What `reg` would measure at `at_ns`; none if it is stored.
    pub(super) fn fresh(&self, reg: Reg, at_ns: u64) -> Option<i64> {
        let sign = if self.is_reversed() { -1.0 } else { 1.0 };
        let speed = |counts: f64| (sign * counts / self.facts.speed_unit).round() as i64;
        let in_counts = |value: f64| {
            let unit = self.table.row(reg).and_then(|row| row.unit_per_count);
            (sign * value / unit.unwrap_or(LOAD_UNIT)).round() as i64
        };
        Some(match reg {
            Reg::RealtimeTick => self.tick_ms(at_ns),
            Reg::Moving => i64::from(speed(self.plant.velocity).abs() > self.table.get(Reg::MovingThreshold)),
            Reg::MovingStatus => self.moving_status(at_ns),
            Reg::PresentPwm => in_counts(self.plant.duty),
            Reg::PresentCurrent => in_counts(self.plant.effort * self.plant.motor.stall_a),
            Reg::PresentLoad => in_counts(self.plant.effort),
            Reg::PresentVelocity => speed(self.plant.velocity),
            Reg::PresentPosition => self.present_counts(),
            Reg::VelocityTrajectory => speed(self.trajectory(at_ns).0.velocity),
            Reg::PositionTrajectory => self.register_counts(self.trajectory(at_ns).0.position),
            Reg::TargetPosition => self.goal_counts(),
            Reg::PresentInputVoltage => self.voltage_tenths(),
            Reg::PresentTemperature => self.plant.heat.housing_c.round() as i64,
            _ => return None,
        })
    }

    fn moving_status(&self, at_ns: u64) -> i64 {
        let (state, going) = self.trajectory(at_ns);
        let kind = if going { self.plan.kind } else { Kind::Step };
        let behind = (state.position - self.plant.position).abs() > FOLLOWING_ERROR_COUNTS;
        let there =
            self.present_counts().abs_diff(self.table.get(Reg::GoalPosition)) as i64 <= IN_POSITION_COUNTS;
        (kind as i64) << 4 | i64::from(behind) << 3 | i64::from(going) << 1 | i64::from(there && !going)
    }
}
