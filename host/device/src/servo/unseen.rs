//! Servos that have been silent for so long that they may have started over unseen.
//!
//! A servo with a Realtime Tick tells that it was restarted, and one with torque off stays loose until it is armed. A
//! Feetech servo, an AX or an MX of protocol 1.0 has no such clock, and takes torque from the next goal it is sent:
//! back from a failure of its power it would jump to where the others were going. Starting takes it a while, so
//! whoever answers within that while has not been away. Everybody else gets no goal until pinned again.
//! Source of torque by goal: simulator notes in `docs/protocols/feetech.md` and `docs/protocols/dynamixel1.md`.

use super::event::Presence;
use super::slot::Slot;
use crate::clock::Instant;
use std::time::Duration;

/// Shorter than any servo takes to start: 250 ms and more, with room for a host that is late itself.
const UNSEEN_MAX: Duration = Duration::from_millis(100);

impl Slot {
    /// Takes the goal from a servo that may have started over since it answered last.
    pub(super) fn let_go_unseen(&mut self, now: Instant) {
        let missed = self.presence != Presence::Present && self.table.tick.is_none();
        let seen = self.reading.is_some_and(|reading| reading.age(now) <= UNSEEN_MAX);
        if missed && !seen && self.limiter.take().is_some() {
            self.let_go = true;
        }
    }
}
