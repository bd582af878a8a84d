//! How punctually answers come on a line, learned from those that came: when it is worth waking up for them, and how
//! long to wait for one that does not come.
//!
//! Only exchanges that somebody waited for are learned from; who looks once in a period learns nothing about the line.

use crate::clock::Instant;
use std::time::Duration;

/// Exchanges after which what was learned is believed.
const LEARNED_AFTER: u32 = 16;
/// How much of the worst delay is forgotten with each exchange: half of it in 350.
const FORGET: f64 = 0.998;
/// How quickly the usual delay follows.
const FOLLOW: f64 = 0.05;
/// Who woke up too late looks so much sooner next time.
const SOONER_SECS: f64 = 5e-6;
/// Silence is not believed sooner than this after the time an answer should be there: a busy machine's usual
/// delay in waking a thread up.
const SLACK_MIN: Duration = Duration::from_millis(2);
/// How many times the worst delay seen lately is waited for.
const SLACK_TIMES: f64 = 3.0;

/// What is known of a line's punctuality.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tempo {
    /// What is waited for while nothing is known, and at most.
    slack_max: Duration,
    learned: u32,
    usual_secs: f64,
    worst_secs: f64,
}

impl Tempo {
    pub(super) fn new(slack_max: Duration) -> Self {
        Self {
            slack_max,
            learned: 0,
            usual_secs: 0.0,
            worst_secs: 0.0,
        }
    }

    /// All answers were there at `now`; the wire alone would have been done with them at `done`. `looked`: somebody
    /// had looked just before and they were not there yet. Otherwise they had been there for who knows how long.
    pub(super) fn learn(&mut self, done: Instant, now: Instant, looked: bool) {
        self.learned = self.learned.saturating_add(1);
        if !looked {
            self.usual_secs = (self.usual_secs * (1.0 - FOLLOW) - SOONER_SECS).max(0.0);
            return;
        }
        let secs = now.since(done).as_secs_f64();
        self.usual_secs += FOLLOW * (secs - self.usual_secs);
        self.worst_secs = secs.max(self.worst_secs * FORGET);
    }

    /// An answer came after it had been given up, so much later than the wire's own time.
    pub(super) fn learn_of_late(&mut self, by: Duration) {
        self.worst_secs = self.worst_secs.max(by.as_secs_f64());
    }

    /// How long after the wire's own time a missing answer is waited for.
    pub(super) fn slack(&self) -> Duration {
        if self.learned < LEARNED_AFTER {
            return self.slack_max;
        }
        let worst = Duration::try_from_secs_f64(self.worst_secs * SLACK_TIMES).unwrap_or(self.slack_max);
        worst.max(SLACK_MIN).min(self.slack_max)
    }

    /// How long after the wire's own time answers usually are there.
    pub(super) fn usual(&self) -> Duration {
        if self.learned < LEARNED_AFTER {
            return Duration::ZERO;
        }
        Duration::try_from_secs_f64(self.usual_secs).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLACK_MAX: Duration = Duration::from_millis(20);

    #[test]
    fn a_punctual_line_is_not_waited_for_long_and_a_slow_one_is() {
        let done = Instant::from_nanos(1_000_000_000);
        let mut tempo = Tempo::new(SLACK_MAX);
        assert_eq!(tempo.slack(), SLACK_MAX, "nothing is known yet");
        for _ in 0..100 {
            tempo.learn(done, done.after(Duration::from_micros(50)), true);
        }
        assert_eq!(tempo.slack(), SLACK_MIN);
        assert!(tempo.usual() > Duration::from_micros(40) && tempo.usual() <= Duration::from_micros(50));
        tempo.learn(done, done.after(Duration::from_millis(4)), true);
        assert_eq!(tempo.slack(), Duration::from_millis(12));
        let usual = tempo.usual();
        tempo.learn(done, done.after(Duration::from_millis(90)), false);
        assert!(tempo.usual() < usual, "whoever overslept looks sooner");
        assert!(
            tempo.slack() <= Duration::from_millis(12),
            "and knows nothing of lateness"
        );
        tempo.learn_of_late(Duration::from_secs(1));
        assert_eq!(tempo.slack(), SLACK_MAX);
    }
}
