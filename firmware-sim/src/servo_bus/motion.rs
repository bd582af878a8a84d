//! From what the goal registers ask for to a planned path.

use super::goal::{Demand, Mode};
use super::plant::{Gains, Order, STEP_SECS};
use super::reg::Reg;
use super::servo::Servo;
use super::trajectory::{Plan, State};

/// All of register Punch.
const PUNCH_FULL: f64 = 1023.0;
/// All of Feetech's startup force, 0.1 % a count.
const STARTUP_FULL: f64 = 1000.0;

impl Servo {
    /// Where the profile generator is at `at_ns`, and whether it is still under way.
    pub(super) fn trajectory(&self, at_ns: u64) -> (State, bool) {
        self.plan
            .at(at_ns.saturating_sub(self.plan_from_ns) as f64 * 1e-9)
    }

    /// What the motor is to do in the step that ends now.
    pub(super) fn order(&self) -> Order {
        let (state, _) = self.trajectory(self.stepped_ns);
        let counts = state.position;
        let sign = if self.is_reversed() { -1.0 } else { 1.0 };
        match self.mode() {
            Mode::Velocity => Order::Speed {
                counts,
                velocity: state.velocity,
            },
            Mode::Current => Order::Current {
                counts,
                share: sign * self.goal_amperes() / self.plant.motor.stall_a,
            },
            Mode::Effort => Order::Duty {
                counts,
                share: sign * self.goal_share(),
            },
            _ => Order::Position {
                counts,
                velocity: state.velocity,
                gains: self.gains(),
            },
        }
    }

    fn goal_amperes(&self) -> f64 {
        let unit = self
            .table
            .row(Reg::GoalCurrent)
            .and_then(|row| row.unit_per_count);
        self.table.get(Reg::GoalCurrent) as f64 * unit.unwrap_or(0.0)
    }

    /// The position loop's gains. X series: P/128, I/65536, D/16 and feed forward/4 on counts, of 885 ("Position PID
    /// Gain"); one-byte gains: P/8, D 4/1000 and I 1000/2048 (MX pages), of 500, as an oscilloscope showed for MX,
    /// XL-320 and STS3215 alike (BAM: duty 0.158 to 0.166 for a radian and a P of 1). AX: all it has at as many counts
    /// as the compliance slope says, and the punch at once ("CW/CCW Compliance Slope", "Punch"). Sums and
    /// differences are of milliseconds.
    fn gains(&self) -> Gains {
        let gain = |reg: Reg| self.table.get(reg) as f64;
        let share = |reg: Reg| {
            let unit = self.table.row(reg).and_then(|row| row.unit_per_count);
            unit.map_or(1.0, |unit| (gain(reg) * unit).abs().min(1.0))
        };
        let common = Gains {
            punch: gain(Reg::Punch) / PUNCH_FULL + gain(Reg::StartupForce) / STARTUP_FULL,
            duty_max: share(Reg::TorqueLimit).min(share(Reg::GoalTorque)),
            ..Gains::default()
        };
        match self.table.row(Reg::PositionPGain).map(|row| row.size) {
            None => {
                let slope = if self.plan.goes_down() {
                    Reg::ClockwiseSlope
                } else {
                    Reg::AnticlockwiseSlope
                };
                Gains {
                    p: 1.0 / gain(slope).max(1.0),
                    ..common
                }
            }
            Some(1) => Gains {
                p: gain(Reg::PositionPGain) / 8.0 / 500.0,
                i: gain(Reg::PositionIGain) * 1000.0 / 2048.0 / 500.0,
                d: gain(Reg::PositionDGain) * 4.0 / 1000.0 / 500.0,
                ..common
            },
            Some(_) => Gains {
                p: gain(Reg::PositionPGain) / 128.0 / 885.0,
                i: gain(Reg::PositionIGain) / 65_536.0 / 885.0 / STEP_SECS,
                d: gain(Reg::PositionDGain) / 16.0 / 885.0 * STEP_SECS,
                feed_forward: gain(Reg::FeedforwardFirst) / 4.0 / 885.0 * STEP_SECS,
                ..common
            },
        }
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

    /// Plans the way to what the goal registers ask for.
    pub(super) fn pursue(&mut self, at_ns: u64) {
        if !self.torque_is_on() {
            return;
        }
        let (from, _) = self.trajectory(at_ns);
        self.plan = match self.demand() {
            Demand::Position { counts, shape } => Plan::to(counts, from, shape),
            Demand::Speed {
                counts_per_sec,
                acceleration,
            } => Plan::at_speed(counts_per_sec, from, acceleration),
        };
        self.plan_from_ns = at_ns;
    }
}
