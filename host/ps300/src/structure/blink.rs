//! What changes in a picture by time alone.

use super::effect::Effect;
use super::{Change, Structure};

impl Structure {
    /// Notes an operation that blinks.
    pub(super) fn note_rate(&mut self, change: &Change) {
        if let Effect::Rate(rate) = change.effect
            && !self.rates.contains(&rate)
        {
            self.rates.push(rate);
        }
    }

    /// Counts a change where, between two displayed frames, something began or ceased to be seen.
    pub(crate) fn pass_frames(&mut self, before: u64, now: u64) {
        let changed = |rate: &super::Rate| rate.phase(before) != rate.phase(now);
        if self.rates.iter().any(changed) {
            self.revision += 1;
        }
    }
}
