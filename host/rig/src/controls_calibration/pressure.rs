//! What pressing comes to: from counts to a share, and when a tip counts as down.
//!
//! A worn pen presses a little while it hovers, so the curve begins at what is pressed then; the tip goes down at one
//! threshold and up at a lower one, so that a hand that trembles on the threshold does not draw dots.

use serde::{Deserialize, Serialize};

/// The curve from nothing to full, and the tip's thresholds; all shares of the tablet's own full pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PressureCurve {
    /// Up to here nothing is pressed.
    pub nothing: f64,
    /// From here on all is.
    pub full: f64,
    /// The exponent between: 1 straight, above 1 softer at first, below 1 harder.
    pub gamma: f64,
    /// The tip is down from here.
    pub tip_down: f64,
    /// And up again below this.
    pub tip_up: f64,
}

impl Default for PressureCurve {
    /// As the tablet says; the thresholds are one and a half and a half of the noise of a 2048-step pen, which libinput
    /// takes for its own (1 % of the range).
    fn default() -> Self {
        Self {
            nothing: 0.0,
            full: 1.0,
            gamma: 1.0,
            tip_down: 0.01,
            tip_up: 0.005,
        }
    }
}

impl PressureCurve {
    /// How hard it is pressed, 0 to 1.
    pub fn share(&self, counts: u32, max_counts: u32) -> f64 {
        let raw = f64::from(counts) / f64::from(max_counts.max(1));
        let span = self.full - self.nothing;
        if span <= 0.0 {
            return if raw > self.nothing { 1.0 } else { 0.0 };
        }
        ((raw - self.nothing) / span).clamp(0.0, 1.0).powf(self.gamma)
    }

    /// Whether the tip is down, which was so or not before.
    pub fn tip(&self, was_down: bool, counts: u32, max_counts: u32) -> bool {
        let raw = f64::from(counts) / f64::from(max_counts.max(1));
        if was_down {
            raw > self.tip_up
        } else {
            raw >= self.tip_down
        }
    }

    /// What is wrong with it; `None` if nothing is.
    pub fn fault(&self) -> Option<String> {
        let shares = [self.nothing, self.full, self.tip_down, self.tip_up];
        if !shares.iter().all(|share| (0.0..=1.0).contains(share)) {
            return Some("pressures are shares from 0 to 1".into());
        }
        if self.full - self.nothing < 0.05 {
            return Some("between nothing and full there must be a twentieth of the range".into());
        }
        if !(0.2..=5.0).contains(&self.gamma) {
            return Some(format!("an exponent must be 0.2 to 5, found {}", self.gamma));
        }
        (self.tip_up >= self.tip_down).then(|| "the tip must go up below where it goes down".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_worn_pen_begins_where_it_hovers() {
        let curve = PressureCurve {
            nothing: 0.1,
            full: 0.9,
            gamma: 2.0,
            ..PressureCurve::default()
        };
        assert_eq!(
            [0, 100, 500, 900, 1000].map(|p| curve.share(p, 1000)),
            [0.0, 0.0, 0.25, 1.0, 1.0]
        );
    }

    #[test]
    fn a_hand_that_trembles_on_the_threshold_draws_one_stroke() {
        let curve = PressureCurve {
            tip_down: 0.05,
            tip_up: 0.02,
            ..PressureCurve::default()
        };
        let mut down = false;
        let tips: Vec<bool> = [10, 49, 50, 45, 52, 40, 30, 20, 45, 49, 60]
            .iter()
            .map(|&counts| {
                down = curve.tip(down, counts, 1000);
                down
            })
            .collect();
        let want = [
            false, false, true, true, true, true, true, false, false, false, true,
        ];
        assert_eq!(tips, want);
    }

    proptest! {
        #[test]
        fn pressing_harder_never_gives_less(
            nothing in 0.0..0.5_f64, span in 0.06..0.5_f64, gamma in 0.2..5.0_f64, max in 1_u32..9000,
        ) {
            let curve = PressureCurve { nothing, full: nothing + span, gamma, ..PressureCurve::default() };
            prop_assert_eq!(curve.fault(), None);
            let mut before = 0.0;
            for counts in 0..=max {
                let share = curve.share(counts, max);
                prop_assert!((before..=1.0).contains(&share));
                before = share;
            }
            prop_assert_eq!(curve.share(max, max), 1.0);
        }
    }
}
