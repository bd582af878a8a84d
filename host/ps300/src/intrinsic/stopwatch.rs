//! How much network time has passed, for functions in which something lasts.
//!
//! Apart from what they remember: spans are remembered, the time of day is the machine's.

use super::function::Now;

/// Measures from one look to the next.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stopwatch {
    seen: Option<u64>,
}

impl Stopwatch {
    /// Microseconds since the last look; 0 at the first.
    pub(super) fn lap(&mut self, now: Now) -> u64 {
        let now = now.micros();
        now.saturating_sub(self.seen.replace(now).unwrap_or(now))
    }

    /// The same in seconds.
    pub(super) fn lap_secs(&mut self, now: Now) -> f64 {
        self.lap(now) as f64 * 1e-6
    }
}
