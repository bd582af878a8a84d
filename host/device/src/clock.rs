//! Machine time, and the only way to wait for it.
//!
//! Apart from everything else so that a whole rig can run on a clock that a test moves by hand.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// A moment of machine time: monotonic, counted from when the clock was made.
/// Never wall-clock time, never animation time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Instant {
    nanos: u64,
}

impl Instant {
    /// The clock's beginning.
    pub const ZERO: Self = Self { nanos: 0 };

    /// `nanos` after the clock's beginning.
    pub const fn from_nanos(nanos: u64) -> Self {
        Self { nanos }
    }

    /// Nanoseconds since the clock's beginning; 64 bits last for 584 years.
    pub const fn as_nanos(self) -> u64 {
        self.nanos
    }

    /// Whole microseconds since the clock's beginning.
    pub const fn as_micros(self) -> u64 {
        self.nanos / 1_000
    }

    /// Seconds since the clock's beginning.
    pub fn as_secs_f64(self) -> f64 {
        // Exact to a nanosecond for the first 104 days, which is what a double holds.
        self.nanos as f64 * 1e-9
    }

    /// `span` later; stays at the end of time rather than wrapping.
    #[must_use]
    pub fn after(self, span: Duration) -> Self {
        let nanos = u64::try_from(span.as_nanos()).unwrap_or(u64::MAX);
        Self {
            nanos: self.nanos.saturating_add(nanos),
        }
    }

    /// How long ago `earlier` was; zero if it is still to come.
    pub fn since(self, earlier: Self) -> Duration {
        Duration::from_nanos(self.nanos.saturating_sub(earlier.nanos))
    }
}

/// Injected wherever something waits, never global.
pub trait Clock: Send + Sync {
    /// Now; never less than an earlier answer.
    fn now(&self) -> Instant;
    /// Returns at `deadline` or later; at once if it has passed.
    fn sleep_until(&self, deadline: Instant);
    /// The time of day, since the beginning of 1970 in UTC: only for what other machines say of it. `None`: this clock
    /// knows none.
    fn time_of_day(&self) -> Option<Duration> {
        None
    }
}

impl<C: Clock + ?Sized> Clock for Arc<C> {
    fn now(&self) -> Instant {
        (**self).now()
    }

    fn sleep_until(&self, deadline: Instant) {
        (**self).sleep_until(deadline);
    }

    fn time_of_day(&self) -> Option<Duration> {
        (**self).time_of_day()
    }
}

/// The operating system's monotonic clock.
#[derive(Clone, Copy, Debug)]
pub struct MonotonicClock {
    began: std::time::Instant,
}

impl MonotonicClock {
    /// A clock that reads zero now.
    pub fn new() -> Self {
        // The one place where machine time comes from outside.
        #[allow(clippy::disallowed_methods)]
        let began = std::time::Instant::now();
        Self { began }
    }
}

impl Default for MonotonicClock {
    fn default() -> Self {
        Self::new()
    }
}

impl Clock for MonotonicClock {
    fn now(&self) -> Instant {
        Instant::ZERO.after(self.began.elapsed())
    }

    fn sleep_until(&self, deadline: Instant) {
        // A sleep may end early only by a signal, and `thread::sleep` goes on after one.
        #[allow(clippy::disallowed_methods)]
        std::thread::sleep(deadline.since(self.now()));
    }

    fn time_of_day(&self) -> Option<Duration> {
        // The one place where the time of day comes from outside, for what others dated by it.
        #[allow(clippy::disallowed_methods)]
        let now = std::time::SystemTime::now();
        now.duration_since(std::time::UNIX_EPOCH).ok()
    }
}

/// A clock that moves only when told to. Sleeping moves it to the deadline and returns at once.
/// Clones share the same time.
#[derive(Clone, Debug, Default)]
pub struct VirtualClock {
    nanos: Arc<AtomicU64>,
}

impl VirtualClock {
    /// A clock that reads zero.
    pub fn new() -> Self {
        Self::default()
    }

    /// Moves the clock on by `span`.
    pub fn advance(&self, span: Duration) {
        self.sleep_until(self.now().after(span));
    }
}

impl Clock for VirtualClock {
    fn now(&self) -> Instant {
        Instant::from_nanos(self.nanos.load(Ordering::SeqCst))
    }

    fn sleep_until(&self, deadline: Instant) {
        self.nanos.fetch_max(deadline.as_nanos(), Ordering::SeqCst);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_saturates_at_both_ends() {
        let late = Instant::from_nanos(u64::MAX);
        assert_eq!(late.after(Duration::from_secs(1)), late);
        assert_eq!(Instant::ZERO.since(late), Duration::ZERO);
        assert_eq!(Instant::from_nanos(1_500_000_000).as_secs_f64(), 1.5);
    }

    #[test]
    fn a_virtual_sleep_moves_the_clock_and_never_back() {
        let clock = VirtualClock::new();
        let other = clock.clone();
        clock.sleep_until(Instant::from_nanos(5));
        clock.sleep_until(Instant::from_nanos(3));
        other.advance(Duration::from_nanos(2));
        assert_eq!(clock.now(), Instant::from_nanos(7));
    }

    #[test]
    fn a_real_sleep_is_not_early() {
        let clock = MonotonicClock::new();
        let deadline = clock.now().after(Duration::from_millis(3));
        clock.sleep_until(deadline);
        assert!(clock.now() >= deadline);
    }
}
