//! One link between two keys, cut down to the numbers that placing it needs, and several evaluated together.
//!
//! The meaning is [`Sweep`]'s, and a test holds the two together; this form is small, because a crowd's
//! clips do not fit any cache, and does its trigonometry for several links at once.

use super::trig::{self, LANES};
use crate::figure::{DirectionLaw, Sweep, TwistLaw, frame_of};
use glam::{DMat3, DVec3};

/// How many links are evaluated together: two angles each.
pub(super) const CHUNK: usize = LANES / 2;

/// A [`Sweep`], packed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Segment {
    from: DVec3,
    towards: DVec3,
    /// What [`Way`] says.
    course: [f64; 2],
    roll_rad: f64,
    roll_change_rad: f64,
    length: f64,
    length_change: f64,
}

/// How the links of one interval go along their circles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// All by the constant law; a segment's course is the whole angle, and nothing.
    Even,
    /// All by the chord law; sine and cosine of the whole angle.
    Chord,
    /// By the chord law, but some link turns right round, which only the constant law can; the whole angle,
    /// and 1 for the constant law. Rare, so it may be slow.
    Mixed,
}

impl Way {
    pub(super) fn of(direction_law: DirectionLaw, sweeps: &[Sweep]) -> Self {
        match direction_law {
            DirectionLaw::Constant => Self::Even,
            DirectionLaw::Chord if sweeps.iter().any(|sweep| sweep.circle().ambiguous()) => Self::Mixed,
            DirectionLaw::Chord => Self::Chord,
        }
    }
}

/// How a whole interval of keys is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Course {
    pub(super) way: Way,
    pub(super) twist_law: TwistLaw,
    /// Whether some angle is too large for the fast functions.
    pub(super) wild: bool,
}

impl Segment {
    pub(super) fn pack(sweep: &Sweep, way: Way) -> Self {
        let (circle, angle_rad) = (sweep.circle(), sweep.circle().whole_rad());
        let (sin, cos) = angle_rad.sin_cos();
        let [roll_rad, roll_change_rad] = sweep.rolling();
        Self {
            from: circle.from(),
            towards: circle.towards(),
            course: match way {
                Way::Even => [angle_rad, 0.0],
                Way::Chord => [sin, cos],
                Way::Mixed => [angle_rad, f64::from(u8::from(circle.ambiguous()))],
            },
            roll_rad,
            roll_change_rad,
            length: sweep.length(0.0),
            length_change: sweep.length(1.0) - sweep.length(0.0),
        }
    }

    pub(super) fn length(&self, s: f64) -> f64 {
        self.length + self.length_change * s
    }

    /// Whether an angle on its way is too large for the fast functions.
    pub(super) fn wild(&self) -> bool {
        self.roll_rad.abs() + self.roll_change_rad.abs() > trig::LARGEST_RAD
    }

    /// The way gone in a mixed interval, radians.
    fn gone_rad(&self, s: f64) -> f64 {
        let [angle_rad, even] = self.course;
        let (sin, cos) = angle_rad.sin_cos();
        if even == 1.0 {
            angle_rad * s
        } else {
            (s * sin).atan2(1.0 - s + s * cos)
        }
    }

    /// Sine and cosine of the way gone, by the chord law.
    fn chord(&self, s: f64) -> (f64, f64) {
        let (sin, cos) = (s * self.course[0], 1.0 - s + s * self.course[1]);
        let share = 1.0 / (sin * sin + cos * cos).sqrt();
        (sin * share, cos * share)
    }
}

/// The frames at s of at most [`CHUNK`] links.
pub(super) fn frames(course: Course, segments: &[Segment], s: f64, into: &mut [DMat3; CHUNK]) {
    let mut angles = [0.0; LANES];
    let (gone, rolled) = angles.split_at_mut(CHUNK);
    for ((segment, gone), rolled) in segments.iter().zip(gone).zip(rolled) {
        *gone = segment.course[0] * s;
        *rolled = segment.roll_rad + segment.roll_change_rad * s;
    }
    if course.way == Way::Mixed {
        for (segment, gone) in segments.iter().zip(&mut angles) {
            *gone = segment.gone_rad(s);
        }
    }
    let (mut sines, mut cosines) = ([0.0; LANES], [0.0; LANES]);
    if course.wild {
        for ((angle, sine), cosine) in angles.iter().zip(&mut sines).zip(&mut cosines) {
            (*sine, *cosine) = angle.sin_cos();
        }
    } else {
        trig::sin_cos(&angles, &mut sines, &mut cosines);
    }
    for (lane, (segment, frame)) in segments.iter().zip(into).enumerate() {
        let (sin, cos) = match course.way {
            Way::Even | Way::Mixed => (sines[lane], cosines[lane]),
            Way::Chord => segment.chord(s),
        };
        let (roll_sin, roll_cos) = (sines[CHUNK + lane], cosines[CHUNK + lane]);
        let z = segment.from * cos + segment.towards * sin;
        let (ahead, aside) = match course.twist_law {
            TwistLaw::Transport => (
                segment.towards * cos - segment.from * sin,
                segment.from.cross(segment.towards),
            ),
            TwistLaw::Zyz => {
                let untwisted = frame_of(z);
                (untwisted.x_axis, untwisted.y_axis)
            }
        };
        *frame = DMat3::from_cols(
            ahead * roll_cos + aside * roll_sin,
            aside * roll_cos - ahead * roll_sin,
            z,
        );
    }
}
