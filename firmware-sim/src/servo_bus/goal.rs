//! What the goal registers ask of the shaft, and between register values and the shaft.
//!
//! Source: the maker's control table pages, "Operating Mode", "Drive Mode", "Homing Offset", "Profile
//! Velocity".

use super::servo::Servo;
use super::table::Reg;
use super::trajectory::Shape;

/// Values of Operating Mode.
pub(super) mod mode {
    pub(crate) const CURRENT: i64 = 0;
    pub(crate) const VELOCITY: i64 = 1;
    pub(crate) const POSITION: i64 = 3;
    pub(crate) const PWM: i64 = 16;
}

/// What is asked of the shaft: counts, counts per second, counts per second squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Demand {
    /// Be there, on a way of this shape.
    Position { counts: f64, shape: Shape },
    /// Turn steadily; an acceleration of 0 means at once.
    Speed { counts_per_sec: f64, acceleration: f64 },
}

impl Servo {
    /// What the goal registers ask for as the operating mode understands them.
    pub(super) fn demand(&self) -> Demand {
        let speed_max = self
            .table
            .row(Reg::VelocityLimit)
            .and_then(|row| row.init)
            .unwrap_or(0) as f64;
        let share = |goal: Reg, limit: Reg| {
            let limit = self.table.row(limit).and_then(|row| row.init).unwrap_or(1).max(1);
            self.table.get(goal) as f64 / limit as f64 * speed_max
        };
        let counts = match self.table.get(Reg::OperatingMode) {
            mode::VELOCITY => self.table.get(Reg::GoalVelocity) as f64,
            mode::CURRENT => share(Reg::GoalCurrent, Reg::CurrentLimit),
            mode::PWM => share(Reg::GoalPwm, Reg::PwmLimit),
            _ => {
                return Demand::Position {
                    counts: self.shaft_counts(self.table.get(Reg::GoalPosition)),
                    shape: self.shape(),
                };
            }
        };
        let sign = if self.is_reversed() { -1.0 } else { 1.0 };
        Demand::Speed {
            counts_per_sec: sign * counts * self.facts.speed_unit,
            acceleration: match self.shape() {
                Shape::Speed { acceleration, .. } => acceleration,
                Shape::Step | Shape::Time { .. } => 0.0,
            },
        }
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
        self.register_counts(self.plant.encoder())
    }
}
