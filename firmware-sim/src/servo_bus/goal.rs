//! What the goal registers ask of the shaft, and between register values and the shaft.
//!
//! Source: the makers' control table pages: "Operating Mode", "Drive Mode", "Homing Offset", "Profile
//! Velocity" (X series); "CW/CCW Angle Limit", "Moving Speed", "Compliance Margin" (protocol 1.0); Feetech's
//! memory tables (`docs/protocols/feetech.md`).

use super::reg::Reg;
use super::servo::Servo;
use super::trajectory::Shape;
use device_profiles::ServoProtocol;

/// Full scale of an effort below zero or above, where it is told in sign and tenths of a per cent.
const TENTHS_FULL: f64 = 1000.0;
/// Bits of Feetech's Phase register: both turn everything round; several turns are counted; unit of speed.
const PHASE_REVERSED: i64 = 0x81;
const PHASE_TURNS: i64 = 0x10;
const PHASE_FINE_SPEED: i64 = 0x04;
/// How much coarser a unit of speed is without the bit above: 50 steps a second to one.
const COARSE_SPEED: f64 = 50.0;

/// Slower than this a shaft counts as standing. Ours.
const REST_COUNTS_PER_SEC: f64 = 1.0;

/// What the goals mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// Within one turn, or what the servo has of it.
    Position,
    /// Over several turns.
    Extended,
    Velocity,
    Current,
    /// A share of the supply.
    Effort,
    /// So far from here.
    Step,
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
    pub(super) fn mode(&self) -> Mode {
        let limits = [Reg::MinPosition, Reg::MaxPosition].map(|reg| self.table.get(reg));
        let code = self
            .table
            .row(Reg::OperatingMode)
            .map(|row| self.table.value(row));
        match (self.facts.protocol, code) {
            (ServoProtocol::Dynamixel2, Some(0)) => Mode::Current,
            (ServoProtocol::Dynamixel2 | ServoProtocol::Sts, Some(1)) => Mode::Velocity,
            // 2 is the XL-320's joint mode.
            (ServoProtocol::Dynamixel2, None | Some(2 | 3)) => Mode::Position,
            (ServoProtocol::Dynamixel2, Some(16)) | (ServoProtocol::Sts, Some(2)) => Mode::Effort,
            (ServoProtocol::Dynamixel2, Some(_)) => Mode::Extended,
            (ServoProtocol::Sts, Some(3)) => Mode::Step,
            (ServoProtocol::Dynamixel1, _) if limits == [0, 0] => Mode::Velocity,
            (ServoProtocol::Scs, _) if limits == [0, 0] => Mode::Effort,
            // An MX with both limits at the end, an STS with both at the start: no limits.
            (ServoProtocol::Dynamixel1 | ServoProtocol::Sts, _) if limits[0] == limits[1] => Mode::Extended,
            _ => Mode::Position,
        }
    }

    /// What the goal registers ask for as the operating mode understands them.
    pub(super) fn demand(&self) -> Demand {
        match self.mode() {
            Mode::Position | Mode::Extended => {
                return self.hold_in_margin(self.shaft_counts(self.goal_counts()));
            }
            Mode::Step => {
                return Demand::Position {
                    counts: self.step_goal,
                    shape: self.shape(),
                };
            }
            Mode::Velocity | Mode::Current | Mode::Effort => {}
        }
        let sign = if self.is_reversed() { -1.0 } else { 1.0 };
        Demand::Speed {
            counts_per_sec: sign * self.goal_share() * self.facts.speed_max,
            acceleration: match self.shape() {
                Shape::Speed { acceleration, .. } => acceleration,
                Shape::Step | Shape::Time { .. } => 0.0,
            },
        }
    }

    /// What is asked for where the goal is not a position, as a share of all there is.
    pub(super) fn goal_share(&self) -> f64 {
        match self.mode() {
            Mode::Velocity if self.facts.protocol == ServoProtocol::Dynamixel1 => self.wheel_share(),
            Mode::Velocity => {
                self.table.get(Reg::GoalVelocity) as f64 * self.speed_unit() / self.facts.speed_max
            }
            Mode::Current => self.share(Reg::GoalCurrent, Reg::CurrentLimit),
            Mode::Effort if self.is_feetech() => self.effort_in_time(),
            Mode::Effort => self.share(Reg::GoalTorque, Reg::TorqueLimit),
            Mode::Position | Mode::Extended | Mode::Step => 0.0,
        }
    }

    /// `goal` as a share of what the factory's `limit` allows.
    fn share(&self, goal: Reg, limit: Reg) -> f64 {
        let limit = self.table.row(limit).and_then(|row| row.init).unwrap_or(1).max(1);
        self.table.get(goal) as f64 / limit as f64
    }

    /// Endless turning with protocol 1.0: a share of the supply where there is a potentiometer, else a speed.
    fn wheel_share(&self) -> f64 {
        let goal = self.table.get(Reg::GoalVelocity) as f64;
        if self.facts.partial.is_some() {
            goal / TENTHS_FULL
        } else {
            goal * self.speed_unit() / self.facts.speed_max
        }
    }

    /// Feetech's effort stands in Goal Time, bit 10 its sign.
    fn effort_in_time(&self) -> f64 {
        let raw = self.table.get(Reg::GoalTime).unsigned_abs();
        let magnitude = (raw & 0x3FF) as f64 / TENTHS_FULL;
        let negative = raw & 0x400 != 0 || self.table.get(Reg::GoalTime) < 0;
        if negative { -magnitude } else { magnitude }
    }

    /// Goal Position; Feetech's servos go no further than their limits, whatever they are told.
    pub(super) fn goal_counts(&self) -> i64 {
        let goal = self.table.get(Reg::GoalPosition);
        let (min, max) = (self.table.get(Reg::MinPosition), self.table.get(Reg::MaxPosition));
        if self.is_feetech() && min < max {
            goal.clamp(min, max)
        } else {
            goal
        }
    }

    /// A goal nearer than the margin (protocol 1.0) or the dead zone (Feetech) moves nothing.
    fn hold_in_margin(&self, counts: f64) -> Demand {
        let here = self.plant.position;
        let regs = if counts < here {
            [Reg::ClockwiseMargin, Reg::ClockwiseDeadZone]
        } else {
            [Reg::AnticlockwiseMargin, Reg::AnticlockwiseDeadZone]
        };
        let margin = regs.into_iter().map(|reg| self.table.get(reg)).sum::<i64>();
        let near = margin > 0
            && (counts - here).abs() <= margin as f64
            && self.plant.velocity.abs() < REST_COUNTS_PER_SEC;
        Demand::Position {
            counts: if near { here } else { counts },
            shape: self.shape(),
        }
    }

    /// Whether moves to a position have registers of their own for speed and acceleration.
    pub(super) fn has_profile(&self) -> bool {
        self.table.row(Reg::ProfileVelocity).is_some()
    }

    /// What the registers of speed, acceleration and time ask for.
    fn shape(&self) -> Shape {
        let (velocity, acceleration) = if self.has_profile() {
            (Reg::ProfileVelocity, Reg::ProfileAcceleration)
        } else {
            (Reg::GoalVelocity, Reg::GoalAcceleration)
        };
        let [velocity, acceleration] = [velocity, acceleration].map(|reg| self.table.get(reg).abs() as f64);
        let total = self.table.get(Reg::GoalTime).max(0) as f64 / 1000.0;
        if self.is_time_based() && velocity > 0.0 {
            let total = velocity / 1000.0;
            return Shape::Time {
                total,
                acceleration: (acceleration / 1000.0).min(total / 2.0),
            };
        }
        if total > 0.0 && self.mode() != Mode::Effort {
            return Shape::Time {
                total,
                acceleration: 0.0,
            };
        }
        let acceleration = acceleration * self.facts.acceleration_unit;
        if velocity > 0.0 {
            Shape::Speed {
                velocity: velocity * self.speed_unit(),
                acceleration,
            }
        } else if acceleration > 0.0 && !self.has_profile() {
            Shape::Speed {
                velocity: self.facts.speed_max,
                acceleration,
            }
        } else {
            Shape::Step
        }
    }

    /// Counts per second for one count of a velocity register.
    pub(super) fn speed_unit(&self) -> f64 {
        let Some(row) = self.table.row(Reg::Phase) else {
            return self.facts.speed_unit;
        };
        // The profile's unit is that of the factory's setting of the bit.
        let now = self.table.value(row) & PHASE_FINE_SPEED;
        let factory = row.init.unwrap_or(0) & PHASE_FINE_SPEED;
        match now.cmp(&factory) {
            std::cmp::Ordering::Less => self.facts.speed_unit * COARSE_SPEED,
            std::cmp::Ordering::Equal => self.facts.speed_unit,
            std::cmp::Ordering::Greater => self.facts.speed_unit / COARSE_SPEED,
        }
    }

    pub(super) fn is_reversed(&self) -> bool {
        if self.is_feetech() {
            self.table.get(Reg::Phase) & PHASE_REVERSED == PHASE_REVERSED
        } else {
            self.table.get(Reg::DriveMode) & 1 != 0
        }
    }

    pub(super) fn is_time_based(&self) -> bool {
        self.table.get(Reg::DriveMode) & 4 != 0
    }

    /// What Homing Offset adds to the shaft's count: ignored beyond a quarter turn in position mode of an X servo,
    /// taken away by Feetech.
    fn offset(&self) -> f64 {
        let offset = self.table.get(Reg::HomingOffset) as f64;
        if self.is_feetech() {
            return -offset;
        }
        if self.mode() == Mode::Position && offset.abs() > self.facts.counts_per_turn / 4.0 {
            0.0
        } else {
            offset
        }
    }

    /// Whether positions start over after one turn: an STS, until it is told to count turns.
    fn wraps(&self) -> bool {
        self.facts.protocol == ServoProtocol::Sts && self.table.get(Reg::Phase) & PHASE_TURNS == 0
    }

    /// The register value for shaft position `shaft`: reversed first, then offset.
    pub(super) fn register_counts(&self, shaft: f64) -> i64 {
        let turned = if self.is_reversed() {
            self.facts.counts_per_turn - shaft
        } else {
            shaft
        };
        let counts = (turned + self.offset()).round();
        let counts = if self.wraps() {
            counts.rem_euclid(self.facts.counts_per_turn)
        } else {
            counts
        };
        let seen = self
            .facts
            .partial
            .map_or(counts, |[low, high]| counts.clamp(low, high));
        seen as i64
    }

    /// The inverse of `register_counts`, in the turn the shaft is in.
    fn shaft_counts(&self, register: i64) -> f64 {
        let turn = self.facts.counts_per_turn;
        let turned = register as f64 - self.offset();
        let shaft = if self.is_reversed() { turn - turned } else { turned };
        if self.wraps() {
            // Where the register would read 0: the shaft does not cross it on its way.
            let here = self.register_counts(self.plant.position) as f64;
            let way = if self.is_reversed() {
                here - register as f64
            } else {
                register as f64 - here
            };
            self.plant.position.round() + way
        } else {
            shaft
        }
    }

    /// Present Position.
    pub(super) fn present_counts(&self) -> i64 {
        self.register_counts(self.plant.encoder())
    }
}
