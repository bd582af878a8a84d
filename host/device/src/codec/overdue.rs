//! Since when something unfinished has been lying there, and whether that is too long.

use crate::clock::Instant;
use std::time::Duration;

/// A report takes some milliseconds on the slowest line; one that has not ended long after that never will.
const LIMIT: Duration = Duration::from_millis(100);

/// Watches over reports that do not end.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Overdue {
    since: Option<Instant>,
}

impl Overdue {
    /// Something has ended: the next one has its own time.
    pub(super) fn restart(&mut self) {
        self.since = None;
    }

    /// True, once: what is unfinished has been so for longer than it may be.
    pub(super) fn given_up(&mut self, unfinished: bool, now: Instant) -> bool {
        if !unfinished {
            self.since = None;
            return false;
        }
        let since = *self.since.get_or_insert(now);
        let late = now.since(since) > LIMIT;
        if late {
            self.since = None;
        }
        late
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_stays_unfinished_is_given_up() {
        let at = |ms| Instant::ZERO.after(Duration::from_millis(ms));
        let mut overdue = Overdue::default();
        assert!(!overdue.given_up(true, at(0)));
        assert!(!overdue.given_up(true, at(100)));
        assert!(overdue.given_up(true, at(101)));
        assert!(!overdue.given_up(true, at(102)));
        overdue.restart();
        assert!(!overdue.given_up(true, at(300)));
        assert!(!overdue.given_up(false, at(500)));
        assert!(!overdue.given_up(true, at(501)));
    }
}
