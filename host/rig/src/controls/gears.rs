//! Gears: how far a value goes for a turn, a push or a deflection.
//!
//! Pure. Gears multiply what relative controls send; curves do so by how fast they are turned; dead zones keep the
//! middle of what springs back quiet. What fine gear is to absolute controls, `pickup` says.

/// Speed up to which a dial is taken as it is, turns per second. The project's own: slower is aiming.
const SLOW_TURNS_PER_SEC: f64 = 0.5;
/// Speed from which it goes no farther for being turned faster, turns per second: a flick of the wrist.
const FAST_TURNS_PER_SEC: f64 = 4.0;
/// Between two reports of one movement of a dial, seconds: what is farther apart began anew.
const APART_SECS_MAX: f64 = 0.2;
/// Reports that come in one piece are taken for this far apart, seconds: one USB frame.
const APART_SECS_MIN: f64 = 0.001;

/// How much farther a dial goes when it is turned fast.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Curve {
    /// No farther.
    #[default]
    Straight,
    /// Twice as far.
    Slow,
    /// Four times.
    Medium,
    /// Eight times.
    Fast,
}

impl Curve {
    /// By the number that `NAME_CURVE` takes, 0 to 3; Faderfox and Arturia have as many.
    pub fn numbered(number: i32) -> Option<Self> {
        let all = [Self::Straight, Self::Slow, Self::Medium, Self::Fast];
        all.get(usize::try_from(number).ok()?).copied()
    }

    /// The number of it.
    pub fn number(self) -> i32 {
        self as i32
    }

    /// How many times as far a turn goes at a speed; continuous, and never less at a greater speed.
    pub fn gain(self, turns_per_sec: f64) -> f64 {
        let most = f64::from(1_u32 << self as u32);
        let share = (turns_per_sec.abs() - SLOW_TURNS_PER_SEC) / (FAST_TURNS_PER_SEC - SLOW_TURNS_PER_SEC);
        1.0 + (most - 1.0) * share.clamp(0.0, 1.0)
    }
}

/// Gear and curve of one relative control.
#[derive(Clone, Copy, Debug)]
pub struct Gear {
    /// What every turn is multiplied with.
    pub factor: f64,
    /// And by speed.
    pub curve: Curve,
    pub(super) turned_secs: Option<f64>,
}

impl Default for Gear {
    fn default() -> Self {
        Self {
            factor: 1.0,
            curve: Curve::Straight,
            turned_secs: None,
        }
    }
}

impl Gear {
    /// What becomes of a turn at a time, in fine gear or not.
    pub fn turn(&mut self, turns: f64, secs: f64, fine: bool) -> f64 {
        let before = self.turned_secs.replace(secs);
        let apart = before
            .map(|before| secs - before)
            .filter(|&it| it <= APART_SECS_MAX);
        let gain = match apart {
            _ if fine => super::pickup::FINE,
            Some(apart) => self.curve.gain(turns / apart.max(APART_SECS_MIN)),
            None => 1.0,
        };
        turns * self.factor * gain
    }
}

/// A deflection (−1 to 1) with a quiet middle; the rest reaches the ends still, and begins at nothing.
pub fn with_dead_zone(deflection: f64, zone: f64) -> f64 {
    let zone = zone.clamp(0.0, 0.99);
    let beyond = (deflection.abs() - zone).max(0.0) / (1.0 - zone);
    // `+ 0.0` for a middle that is not −0.
    deflection.signum() * beyond + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn fine_gear_is_a_tenth_whatever_the_speed() {
        let mut gear = Gear {
            curve: Curve::Fast,
            factor: 2.0,
            ..Gear::default()
        };
        assert!((gear.turn(0.1, 0.0, true) - 0.02).abs() < 1e-12);
        assert!((gear.turn(0.1, 0.001, true) - 0.02).abs() < 1e-12);
    }

    #[test]
    fn a_first_turn_is_slow_and_a_quick_one_goes_farther() {
        let mut gear = Gear {
            curve: Curve::Medium,
            ..Gear::default()
        };
        assert_eq!(gear.turn(0.1, 0.0, false), 0.1);
        assert_eq!(gear.turn(0.1, 0.01, false), 0.4);
        assert_eq!(gear.turn(0.1, 5.0, false), 0.1);
        assert_eq!(gear.turn(-0.001, 5.1, false), -0.001);
    }

    proptest! {
        #[test]
        fn curves_rise_and_have_no_step(number in 0..4_i32, speed in 0.0..10.0_f64) {
            let curve = Curve::numbered(number).expect("there are four");
            prop_assert_eq!(curve.number(), number);
            let (here, there) = (curve.gain(speed), curve.gain(speed + 1e-6));
            prop_assert!(there >= here && there - here < 1e-4 && here >= 1.0);
            prop_assert_eq!(curve.gain(-speed), here);
        }

        #[test]
        fn a_dead_zone_is_quiet_and_leaves_the_ends(at in -1.0..=1.0_f64, zone in 0.0..0.9_f64) {
            let out = with_dead_zone(at, zone);
            prop_assert!(out.abs() <= 1.0 && out * at >= 0.0);
            prop_assert_eq!(out == 0.0, at.abs() <= zone);
            prop_assert!((with_dead_zone(1.0, zone) - 1.0).abs() < 1e-12);
            prop_assert!((with_dead_zone(at + 1e-9, zone) - out).abs() < 1e-6);
        }
    }
}
