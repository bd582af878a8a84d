//! The last half second of a value, or somewhat more: a ring of moments, read between them.

/// Moments kept: half a second at 500 a second, the fastest rate there is.
const KEPT: usize = 256;

/// Values at ascending times.
#[derive(Debug, Clone)]
pub(super) struct Course {
    moments: [(f64, f64); KEPT],
    newest: usize,
    count: usize,
}

impl Default for Course {
    fn default() -> Self {
        Self {
            moments: [(0.0, 0.0); KEPT],
            newest: 0,
            count: 0,
        }
    }
}

impl Course {
    /// Adds a moment; one that is no later than the last begins a new course.
    pub(super) fn push(&mut self, at_secs: f64, value: f64) {
        if self.back(0).is_some_and(|(last_secs, _)| at_secs <= last_secs) {
            self.clear();
        }
        self.newest = (self.newest + 1) % KEPT;
        if let Some(place) = self.moments.get_mut(self.newest) {
            *place = (at_secs, value);
        }
        self.count = (self.count + 1).min(KEPT);
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// The moment `steps` before the newest.
    fn back(&self, steps: usize) -> Option<(f64, f64)> {
        if steps >= self.count {
            return None;
        }
        self.moments.get((self.newest + KEPT - steps) % KEPT).copied()
    }

    /// The value at a time, on the line between its neighbours; after the newest moment that one's, which a servo
    /// still holds; none before the oldest.
    pub(super) fn at(&self, secs: f64) -> Option<f64> {
        let mut steps = 0;
        self.at_before(&mut steps, secs)
    }

    /// The same for times that fall from call to call: `steps` is where the last one was found.
    pub(super) fn at_before(&self, steps: &mut usize, secs: f64) -> Option<f64> {
        loop {
            let (at_secs, value) = self.back(*steps)?;
            if secs < at_secs {
                *steps += 1;
                continue;
            }
            let Some(after) = steps.checked_sub(1).and_then(|after| self.back(after)) else {
                return Some(value);
            };
            let (after_secs, after) = after;
            let share = (secs - at_secs) / (after_secs - at_secs);
            return Some(value + (after - value) * share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_between_moments_and_held_after_the_last() {
        let mut course = Course::default();
        assert_eq!(course.at(1.0), None);
        for step in 0..600_u32 {
            course.push(f64::from(step) * 0.25, f64::from(step));
        }
        for (secs, want) in [
            (599.0 * 0.25, Some(599.0)),
            (1000.0, Some(599.0)),
            (100.125, Some(400.5)),
            (599.0 * 0.25 - 255.0 * 0.25, Some(344.0)),
            (80.0, None),
        ] {
            assert_eq!(course.at(secs), want, "{secs}");
        }
        course.push(3.0, 7.0);
        assert_eq!(course.at(3.5), Some(7.0), "time went back: a new course");
        assert_eq!(course.at(2.5), None);
    }
}
