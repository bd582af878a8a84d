//! From goal registers to a planned path, and between register values and the shaft.
//!
//! Source: the maker's control table pages, "Operating Mode", "Drive Mode", "Homing Offset", "Profile
//! Velocity".

use super::servo::Servo;
use super::table::Reg;
use super::trajectory::{Plan, Shape, State};

/// Values of Operating Mode.
pub(super) mod mode {
    pub(crate) const CURRENT: i64 = 0;
    pub(crate) const VELOCITY: i64 = 1;
    pub(crate) const POSITION: i64 = 3;
    pub(crate) const PWM: i64 = 16;
}

impl Servo {
    /// Where the profile generator is at `at_ns`, and whether it is still under way.
    pub(super) fn trajectory(&self, at_ns: u64) -> (State, bool) {
        self.plan
            .at(at_ns.saturating_sub(self.plan_from_ns) as f64 * 1e-9)
    }

    pub(super) fn rest(&mut self) {
        self.plant.settle();
        self.plan = Plan::rest(self.plant.position);
        self.plan_from_ns = self.stepped_ns;
    }

    pub(super) fn torque_on(&mut self, at_ns: u64) {
        if self.torque_is_on() {
            return;
        }
        self.rest();
        self.counters.torque_ons += 1;
        self.table.set(Reg::TorqueEnable, 1);
        self.last_heard_ns = at_ns;
        self.pursue(at_ns);
    }

    pub(super) fn torque_off(&mut self) {
        self.table.set(Reg::TorqueEnable, 0);
        self.rest();
    }

    /// Plans the way to the goal registers as the operating mode understands them.
    pub(super) fn pursue(&mut self, at_ns: u64) {
        if !self.torque_is_on() {
            return;
        }
        let (from, _) = self.trajectory(at_ns);
        let speed_max = self
            .table
            .row(Reg::VelocityLimit)
            .and_then(|row| row.init)
            .unwrap_or(0) as f64;
        let share = |goal: Reg, limit: Reg| {
            let limit = self.table.row(limit).and_then(|row| row.init).unwrap_or(1).max(1);
            self.table.get(goal) as f64 / limit as f64 * speed_max
        };
        let velocity = match self.table.get(Reg::OperatingMode) {
            mode::VELOCITY => Some(self.table.get(Reg::GoalVelocity) as f64),
            mode::CURRENT => Some(share(Reg::GoalCurrent, Reg::CurrentLimit)),
            mode::PWM => Some(share(Reg::GoalPwm, Reg::PwmLimit)),
            _ => None,
        };
        self.plan = match velocity {
            Some(counts) => {
                let acceleration = match self.shape() {
                    Shape::Speed { acceleration, .. } => acceleration,
                    Shape::Step | Shape::Time { .. } => 0.0,
                };
                let sign = if self.is_reversed() { -1.0 } else { 1.0 };
                Plan::at_speed(sign * counts * self.facts.speed_unit, from, acceleration)
            }
            None => Plan::to(
                self.shaft_counts(self.table.get(Reg::GoalPosition)),
                from,
                self.shape(),
            ),
        };
        self.plan_from_ns = at_ns;
    }

    /// What Profile Velocity and Profile Acceleration ask for.
    fn shape(&self) -> Shape {
        let velocity = self.table.get(Reg::ProfileVelocity) as f64;
        let acceleration = self.table.get(Reg::ProfileAcceleration) as f64;
        if velocity <= 0.0 {
            Shape::Step
        } else if self.is_time_based() {
            let total = velocity / 1000.0;
            Shape::Time {
                total,
                acceleration: (acceleration / 1000.0).min(total / 2.0),
            }
        } else {
            Shape::Speed {
                velocity: velocity * self.facts.speed_unit,
                acceleration: acceleration * self.facts.acceleration_unit,
            }
        }
    }

    pub(super) fn is_reversed(&self) -> bool {
        self.table.get(Reg::DriveMode) & 1 != 0
    }

    pub(super) fn is_time_based(&self) -> bool {
        self.table.get(Reg::DriveMode) & 4 != 0
    }

    /// Homing Offset as it takes effect: ignored beyond a quarter turn in position mode.
    fn offset(&self) -> f64 {
        let offset = self.table.get(Reg::HomingOffset) as f64;
        let single_turn = self.table.get(Reg::OperatingMode) == mode::POSITION;
        if single_turn && offset.abs() > self.facts.counts_per_turn / 4.0 {
            0.0
        } else {
            offset
        }
    }

    /// The register value for shaft position `shaft`: reversed first, then offset.
    pub(super) fn register_counts(&self, shaft: f64) -> i64 {
        let turned = if self.is_reversed() {
            self.facts.counts_per_turn - shaft
        } else {
            shaft
        };
        (turned + self.offset()).round() as i64
    }

    /// The inverse of `register_counts`.
    fn shaft_counts(&self, register: i64) -> f64 {
        let turned = register as f64 - self.offset();
        if self.is_reversed() {
            self.facts.counts_per_turn - turned
        } else {
            turned
        }
    }

    /// Present Position.
    pub(super) fn present_counts(&self) -> i64 {
        self.register_counts(self.plant.position)
    }
}
