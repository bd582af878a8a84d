//! What pulls at a horn from outside: loads and hands.

use super::STEP_SECS;

/// Standard gravity.
const GRAVITY_M_PER_S2: f64 = 9.806_65;
/// Most a hand can do on a horn: 20 N on a lever of 100 mm. Ours.
const HAND_MAX_NM: f64 = 2.0;
/// How firmly a hand holds: this much for a radian that the horn is away from it. Ours.
const HAND_NM_PER_RAD: f64 = 20.0;
/// How much a hand's flesh damps, newton metres for a radian a second. Ours.
const HAND_NM_S_PER_RAD: f64 = 0.3;

/// What hangs on the horn. Signs are those of the effort it takes to hold it.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::servo_bus) struct Load {
    /// Of what the motor has.
    pub(in crate::servo_bus) share: f64,
    pub(in crate::servo_bus) pull_nm: f64,
    kg: f64,
    metres: f64,
}

impl Load {
    pub(in crate::servo_bus) fn carry(&mut self, kg: f64, metres: f64) {
        (self.kg, self.metres) = (kg, metres);
    }

    /// What it takes to hold it with the shaft at `rad` from the middle of its range, where a link is level.
    pub(super) fn needed_nm(&self, rad: f64, stall_nm: f64) -> f64 {
        self.share * stall_nm + self.pull_nm + self.kg * GRAVITY_M_PER_S2 * self.metres * rad.cos()
    }

    pub(super) fn inertia_kg_m2(&self) -> f64 {
        self.kg * self.metres * self.metres
    }
}

/// What a hand does with a horn until it is told otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hand {
    /// Pulls with this torque, newton metres in the sense of rising shaft angles.
    Pull {
        /// How hard.
        nm: f64,
    },
    /// Takes it along and holds it there, as far as a hand is strong enough.
    Guide {
        /// Shaft angle from the middle of the position range, radians.
        to_rad: f64,
        /// How long it takes, seconds.
        over_secs: f64,
    },
}

/// A hand on the horn, in counts.
#[derive(Clone, Copy, Debug)]
pub(super) enum Grip {
    Pull {
        nm: f64,
    },
    Guide {
        from: f64,
        to: f64,
        secs: f64,
        gone_secs: f64,
    },
}

impl Grip {
    pub(super) fn new(hand: Hand, position: f64, centre: f64, rad_per_count: f64) -> Self {
        match hand {
            Hand::Pull { nm } => Self::Pull {
                nm: nm.clamp(-HAND_MAX_NM, HAND_MAX_NM),
            },
            Hand::Guide { to_rad, over_secs } => Self::Guide {
                from: position,
                to: centre + to_rad / rad_per_count,
                secs: over_secs.max(STEP_SECS),
                gone_secs: 0.0,
            },
        }
    }

    /// Where the hand is; nowhere in particular if it only pulls.
    pub(super) fn place(&self) -> Option<f64> {
        match *self {
            Self::Pull { .. } => None,
            Self::Guide {
                from,
                to,
                secs,
                gone_secs,
            } => {
                // A reach of least jerk, as human ones are (Flash and Hogan 1985).
                let t = (gone_secs / secs).min(1.0);
                let share = t * t * t * (10.0 + t * (6.0 * t - 15.0));
                Some(from + (to - from) * share)
            }
        }
    }

    /// What it does to a horn at `position`; the hand moves on by one step.
    pub(super) fn pull_nm(&mut self, position: f64, velocity: f64, rad_per_count: f64) -> f64 {
        let before = self.place();
        match self {
            Self::Pull { nm } => *nm,
            Self::Guide { gone_secs, .. } => {
                *gone_secs += STEP_SECS;
                let (before, now) = (before.unwrap_or(position), self.place().unwrap_or(position));
                let away_rad = (now - position) * rad_per_count;
                let slower = ((now - before) / STEP_SECS - velocity) * rad_per_count;
                (HAND_NM_PER_RAD * away_rad + HAND_NM_S_PER_RAD * slower).clamp(-HAND_MAX_NM, HAND_MAX_NM)
            }
        }
    }

    /// The counts of the shaft are counted anew.
    pub(super) fn shift(&mut self, counts: f64) {
        if let Self::Guide { from, to, .. } = self {
            *from += counts;
            *to += counts;
        }
    }
}
