//! A body that is on its trajectory as smoothly as can be.
//!
//! The horn follows the trajectory through two equal first-order lags, which is a critically damped second
//! order system that cannot overshoot, so the true speed is an average of past trajectory speeds and never
//! exceeds them; before that, the motor's own top speed bounds what it can follow. The numbers are ours.

use super::STEP_SECS;

/// Rate of each lag: 20 ms in all behind a moving goal.
const BANDWIDTH_PER_SEC: f64 = 100.0;
/// Distance behind the trajectory at which the motor pulls with all it has.
const FULL_EFFORT_COUNTS: f64 = 180.0;

/// The shaft and what it follows, counts.
#[derive(Clone, Debug)]
pub(super) struct Ideal {
    pub(super) position: f64,
    /// Top speed of the motor, counts per second.
    pub(super) speed_max: f64,
    /// What the motor can follow, then the first lag.
    followed: f64,
    lagged: f64,
    lag_share: f64,
}

impl Ideal {
    pub(super) fn new(position: f64, speed_max: f64) -> Self {
        Self {
            position,
            speed_max,
            followed: position,
            lagged: position,
            lag_share: 1.0 - (-BANDWIDTH_PER_SEC * STEP_SECS).exp(),
        }
    }

    /// One step towards the trajectory's `target`.
    pub(super) fn follow(&mut self, target: f64, stuck: bool) {
        let reach = self.speed_max * STEP_SECS;
        self.followed += (target - self.followed).clamp(-reach, reach);
        self.lagged += self.lag_share * (self.followed - self.lagged);
        let step = (self.lag_share * (self.lagged - self.position)).clamp(-reach, reach);
        self.position += if stuck { 0.0 } else { step };
    }

    /// What the motor does about being behind, −1 to 1 and beyond.
    pub(super) fn effort(&self) -> f64 {
        (self.followed - self.position) / FULL_EFFORT_COUNTS
    }

    /// Something other than the motor puts it there.
    pub(super) fn place(&mut self, position: f64) {
        self.position = position;
        self.settle();
    }

    /// Moved away, while the trajectory stays where it is.
    pub(super) fn push(&mut self, counts: f64) {
        self.position += counts;
    }

    pub(super) fn settle(&mut self) {
        self.followed = self.position;
        self.lagged = self.position;
    }

    pub(super) fn stop_within(&mut self, low: f64, high: f64) {
        self.position = self.position.clamp(low, high);
    }
}
