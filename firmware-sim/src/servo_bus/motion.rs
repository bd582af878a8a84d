//! From what the goal registers ask for to a planned path.

use super::goal::Demand;
use super::servo::Servo;
use super::table::Reg;
use super::trajectory::{Plan, State};

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
