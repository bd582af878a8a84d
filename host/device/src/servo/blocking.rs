//! The bus for callers that have nothing else to do: measuring, calibrating, tests on the bench.
//!
//! Apart from the rest because these are the only functions here that wait. The player uses none of them.

use super::bus::{Bus, BusError};
use super::event::{Armed, BusEvent, Commanded, Goal, Intervention};
use crate::clock::{Clock, Instant};
use std::time::Duration;

/// How long to wait for bytes while nothing is due: the time within which a command should be noticed.
const IDLE_STEP: Duration = Duration::from_millis(1);

impl Bus {
    /// One whole cycle: goals out, then waits until every member has answered or is given up.
    pub fn cycle_blocking(
        &mut self,
        goal: Goal<'_>,
        clock: &dyn Clock,
        note: &mut dyn FnMut(Intervention),
        emit: &mut dyn FnMut(BusEvent),
    ) -> Result<Commanded, BusError> {
        self.finish_blocking(clock, emit)?;
        let commanded = self.command(goal, clock.now(), note)?;
        self.finish_blocking(clock, emit)?;
        Ok(commanded)
    }

    /// One reading of every member without goals; waits until it is complete.
    pub fn observe_blocking(
        &mut self,
        clock: &dyn Clock,
        emit: &mut dyn FnMut(BusEvent),
    ) -> Result<Commanded, BusError> {
        self.finish_blocking(clock, emit)?;
        let observed = self.observe(clock.now())?;
        self.finish_blocking(clock, emit)?;
        Ok(observed)
    }

    /// Arms all members, or says through [`Bus::refusals`] why not. Takes well under a second.
    pub fn arm_blocking(
        &mut self,
        clock: &dyn Clock,
        emit: &mut dyn FnMut(BusEvent),
    ) -> Result<Armed, BusError> {
        self.begin_arming(clock.now())?;
        self.settle_blocking(clock, emit)
    }

    /// Switches torque off and waits for the servos' confirmation.
    pub fn release_blocking(
        &mut self,
        clock: &dyn Clock,
        emit: &mut dyn FnMut(BusEvent),
    ) -> Result<Armed, BusError> {
        self.release(clock.now())?;
        self.settle_blocking(clock, emit)
    }

    /// Waits until arming or releasing has come to its end.
    fn settle_blocking(
        &mut self,
        clock: &dyn Clock,
        emit: &mut dyn FnMut(BusEvent),
    ) -> Result<Armed, BusError> {
        loop {
            self.poll(clock.now(), emit)?;
            let armed = self.armed();
            if armed == Armed::Yes || armed == Armed::No {
                return Ok(armed);
            }
            self.pause(clock);
        }
    }

    /// Waits until no answer is outstanding.
    fn finish_blocking(&mut self, clock: &dyn Clock, emit: &mut dyn FnMut(BusEvent)) -> Result<(), BusError> {
        loop {
            self.poll(clock.now(), emit)?;
            // Companies that did not fit into the same write follow here.
            self.read_on(clock.now(), Instant::from_nanos(u64::MAX))?;
            let Some(deadline) = self.deadline() else {
                return Ok(());
            };
            self.wait(clock, deadline);
        }
    }

    fn pause(&mut self, clock: &dyn Clock) {
        let step = clock.now().after(IDLE_STEP);
        let until = self.deadline().map_or(step, |deadline| deadline.min(step));
        self.wait(clock, until);
        if clock.now() < until {
            // Bytes are there; if they turn out to be nothing useful the next look must not spin.
            return;
        }
        clock.sleep_until(until);
    }
}
