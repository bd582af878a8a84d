//! One delay: for each candidate the recent squared difference of a measured value from a course so long ago.

use super::course::Course;

/// From one candidate to the next, seconds.
const STEP_SECS: f64 = 0.01;
/// Candidates, from none to one beyond the longest lag, seen from ahead of the clip.
const CANDIDATES: usize = ((super::LAG_MAX_SECS + super::AHEAD_SECS) / STEP_SECS + 2.5) as usize;
/// What counts fades with this time constant of movement, seconds; standing still changes nothing.
const MEMORY_SECS: f64 = 3.0;
/// So much movement must be known before anything is said, seconds.
const KNOWN_SECS: f64 = 0.6;
/// Over the longest delay the course must have changed by this much to tell anything, radians: about ten counts of
/// 4096 a turn.
const MOVED_RAD: f64 = 0.015;
/// Price of a constant difference, as a share of its square.
const OFFSET_PRICE: f64 = 0.05;
/// The best candidate must leave no more than this share of what the worst leaves, or the joint is not following.
const LEFT_MAX: f64 = 0.5;

/// See the module.
#[derive(Debug, Clone)]
pub(super) struct Delay {
    weight_secs: f64,
    sums: [f64; CANDIDATES],
    squares: [f64; CANDIDATES],
}

impl Default for Delay {
    fn default() -> Self {
        Self {
            weight_secs: 0.0,
            sums: [0.0; CANDIDATES],
            squares: [0.0; CANDIDATES],
        }
    }
}

impl Delay {
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Takes in a measurement that stands for `since_secs`.
    pub(super) fn take(&mut self, course: &Course, at_secs: f64, value: f64, since_secs: f64) {
        let mut differences = [0.0; CANDIDATES];
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut steps = 0;
        for (candidate, difference) in differences.iter_mut().enumerate() {
            let secs = at_secs - candidate as f64 * STEP_SECS;
            let Some(asked) = course.at_before(&mut steps, secs) else {
                return;
            };
            least = least.min(asked);
            most = most.max(asked);
            *difference = value - asked;
        }
        if most - least < MOVED_RAD {
            return;
        }
        let keep = (-since_secs / MEMORY_SECS).exp();
        self.weight_secs = self.weight_secs * keep + since_secs;
        let cells = self.sums.iter_mut().zip(&mut self.squares).zip(&differences);
        for ((sum, square), difference) in cells {
            *sum = *sum * keep + difference * since_secs;
            *square = *square * keep + difference * difference * since_secs;
        }
    }

    /// What a candidate leaves unexplained, with the best constant difference that is worth its price.
    fn left(&self, candidate: usize) -> Option<f64> {
        let mean = self.sums.get(candidate)? / self.weight_secs;
        let square = self.squares.get(candidate)? / self.weight_secs;
        Some(square - mean * mean / (1.0 + OFFSET_PRICE))
    }

    /// The delay, seconds; none while nothing fits, or too little was seen.
    pub(super) fn secs(&self) -> Option<f64> {
        if self.weight_secs < KNOWN_SECS {
            return None;
        }
        let (mut best, mut least, mut most) = (0, f64::INFINITY, 0.0_f64);
        for candidate in 0..CANDIDATES {
            let left = self.left(candidate)?;
            most = most.max(left);
            if left < least {
                (best, least) = (candidate, left);
            }
        }
        // At the far end the minimum may lie beyond: nothing is known then.
        if best + 1 >= CANDIDATES || least > LEFT_MAX * most {
            return None;
        }
        let here = best as f64 * STEP_SECS;
        let Some(before) = best.checked_sub(1) else {
            return Some(here);
        };
        let (before, after) = (self.left(before)?, self.left(best + 1)?);
        let bend = before - 2.0 * least + after;
        let share = if bend > 0.0 {
            0.5 * (before - after) / bend
        } else {
            0.0
        };
        Some(here + share.clamp(-0.5, 0.5) * STEP_SECS)
    }
}
