//! Waking up just when a byte is due: sleep most of the way, look at the clock for the rest.

use std::time::Duration;

use device::clock::{Clock, Instant};

use super::line::ServeLine;

/// How much before its time a sleep is aimed. An idle Linux machine wakes a thread that asked for exact
/// timers within some tens of microseconds.
const AHEAD_US: u64 = 60;
/// Longest sleep: how soon a stop, another line speed, or a hand's doing is noticed when no byte is under way.
const LOOK_US: u64 = 1000;
/// Bits of a byte on the wire, start and stop included.
const BYTE_BITS: u64 = 10;

/// When the loop must look again.
#[derive(Debug)]
pub(super) struct Pace {
    /// When what the host wrote has reached the device.
    host_done_us: u64,
}

impl Pace {
    pub(super) fn new() -> Self {
        // Without this the kernel may let any sleep last 50 us longer (prctl(2), PR_SET_TIMERSLACK). Where it
        // refuses, bytes come that much later.
        let exact = std::num::NonZeroU64::MIN;
        let _ = rustix::thread::set_current_timer_slack(Some(exact));
        Self { host_done_us: 0 }
    }

    pub(super) fn host_wrote(&mut self, now_us: u64, count: usize, baud: u32) {
        let wire_us = (count as u64 * BYTE_BITS * 1_000_000).div_ceil(u64::from(baud.max(1)));
        self.host_done_us = self.host_done_us.max(now_us) + wire_us;
    }

    /// Sleeps until `wakes_us`, or until the host's bytes have arrived, or until it writes more.
    pub(super) fn rest(
        &self,
        line: &mut ServeLine,
        clock: &dyn Clock,
        began: Instant,
        wakes_us: Option<u64>,
    ) {
        let now_us = clock.now().since(began).as_micros() as u64;
        let arrival_us = (self.host_done_us > now_us).then_some(self.host_done_us);
        let due_us = wakes_us.into_iter().chain(arrival_us).min();
        let look_us = now_us + LOOK_US;
        let until_us = due_us.map_or(look_us, |due_us| due_us.saturating_sub(AHEAD_US).min(look_us));
        if until_us > now_us {
            line.wait(clock, began.after(Duration::from_micros(until_us)));
            return;
        }
        let due = began.after(Duration::from_micros(due_us.unwrap_or(now_us)));
        while clock.now() < due {
            std::hint::spin_loop();
        }
    }
}
