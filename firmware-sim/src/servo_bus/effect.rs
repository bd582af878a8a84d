//! What a write sets off beside storing values: torque, new paths, modes, calibration.
//!
//! One instruction may write several registers (an STS takes acceleration, goal, time and speed in one go), so
//! everything is stored before anything moves. Source: the makers' control table pages; that a goal switches the
//! torque of a Feetech servo on: kisaragi-mochi/stackchan-mcp#173 ("implicit re-arm"); of a DYNAMIXEL with
//! protocol 1.0: common practice, the page does not say.

use super::goal::Mode;
use super::reg::{Reg, Regs};
use super::servo::Servo;
use device_profiles::ServoProtocol;

/// Goals that set something off.
const GOALS: &[Reg] = &[
    Reg::GoalPosition,
    Reg::GoalVelocity,
    Reg::GoalTorque,
    Reg::GoalCurrent,
    Reg::GoalTime,
];
/// What else changes a move under way of a servo that has no profile registers.
const MANNERS: &[Reg] = &[Reg::GoalVelocity, Reg::GoalAcceleration, Reg::GoalTime];
/// Drive Mode, bit 3: a goal switches torque on.
const TORQUE_BY_GOAL: i64 = 8;

impl Servo {
    /// `written` have been stored, `changed` of them with another value than before.
    pub(super) fn set_off(&mut self, at_ns: u64, written: Regs, changed: Regs) {
        for reg in written.iter() {
            match reg {
                Reg::TorqueEnable => self.switch_torque(at_ns, changed.contains(reg)),
                Reg::OperatingMode if changed.contains(reg) => self.change_mode(),
                Reg::BusWatchdog => {
                    self.last_heard_ns = at_ns;
                    if self.facts.watchdog_from.is_none_or(|from| self.firmware() < from) {
                        self.table.set(Reg::BusWatchdog, 0);
                    }
                }
                _ => {}
            }
        }
        if written.contains_any(GOALS) {
            self.aim(at_ns, written);
        }
    }

    fn switch_torque(&mut self, at_ns: u64, changed: bool) {
        let on = self.torque_is_on();
        // The value is stored already; a change of state wants the state before it.
        if on && changed {
            self.table.set(Reg::TorqueEnable, 0);
            if !self.shut_down {
                self.torque_on(at_ns);
            }
        } else if !on {
            let stored = self.table.get(Reg::TorqueEnable);
            self.torque_off();
            self.table.set(Reg::TorqueEnable, stored);
        }
    }

    /// Goals were written.
    fn aim(&mut self, at_ns: u64, written: Regs) {
        self.counters.goal_writes += 1;
        let goal = self.goal_of_mode();
        if goal == Reg::GoalPosition && written.contains(goal) && self.mode() == Mode::Step {
            self.step_goal = self.plant.position + self.table.get(goal) as f64;
        }
        let asks = written.contains(goal) || !self.has_profile() && written.contains_any(MANNERS);
        let arms = match self.facts.protocol {
            ServoProtocol::Dynamixel2 => self.table.get(Reg::DriveMode) & TORQUE_BY_GOAL != 0,
            _ => written.contains(goal),
        };
        if arms && !self.torque_is_on() && !self.shut_down {
            self.torque_on(at_ns);
        } else if asks {
            self.pursue(at_ns);
        }
    }

    fn goal_of_mode(&self) -> Reg {
        match self.mode() {
            Mode::Velocity => Reg::GoalVelocity,
            Mode::Current => Reg::GoalCurrent,
            Mode::Effort if self.is_feetech() => Reg::GoalTime,
            Mode::Effort => Reg::GoalTorque,
            Mode::Position | Mode::Extended | Mode::Step => Reg::GoalPosition,
        }
    }

    /// A new operating mode: gains as at start, no profile, goals at their limits, turns forgotten.
    fn change_mode(&mut self) {
        if self.is_feetech() {
            self.step_goal = self.plant.position;
            self.rest();
            self.table.set(Reg::GoalPosition, self.present_counts());
            self.table.set(Reg::GoalVelocity, 0);
            self.table.set(Reg::GoalTime, 0);
            return;
        }
        for reg in [
            Reg::VelocityIGain,
            Reg::VelocityPGain,
            Reg::PositionDGain,
            Reg::PositionIGain,
            Reg::PositionPGain,
            Reg::FeedforwardSecond,
            Reg::FeedforwardFirst,
        ] {
            let init = self.table.row(reg).and_then(|row| row.init).unwrap_or(0);
            self.table.set(reg, init);
        }
        self.table.set(Reg::ProfileVelocity, 0);
        self.table.set(Reg::ProfileAcceleration, 0);
        self.table.set(Reg::GoalTorque, self.table.get(Reg::TorqueLimit));
        self.table
            .set(Reg::GoalCurrent, self.table.get(Reg::CurrentLimit));
        self.table.set(Reg::GoalVelocity, 0);
        self.forget_turns();
        self.table.set(Reg::GoalPosition, self.present_counts());
    }

    /// The offset becomes such that the present position reads `counts`, and is kept whatever the lock says.
    pub(super) fn calibrate(&mut self, counts: f64) {
        let turn = self.facts.counts_per_turn;
        let off = (self.plant.position - counts).rem_euclid(turn);
        let off = if off > turn / 2.0 { off - turn } else { off };
        self.table.set(Reg::HomingOffset, off.round() as i64);
        self.table.keep_register(Reg::HomingOffset);
        self.counters.eeprom_writes += 1;
        self.rest();
        self.table.set(Reg::GoalPosition, self.present_counts());
    }
}
