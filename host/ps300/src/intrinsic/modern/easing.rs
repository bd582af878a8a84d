//! Named courses from 0 to 1: how animators let a motion begin and end.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::super::function::{Fault, Inputs, Outputs, domain};
use super::super::spec::{Confidence, Spec};
use super::{NUMBER, REAL_OUT, text};

pub(super) const TABLE: &[Spec] =
    &[
        Spec::pure("DR_EASE", &[NUMBER, text("in_out_cubic")], &[REAL_OUT], ease)
            .says(
                "The course named <2> at <1>, which is taken to lie between 0 and 1: 'linear', \
             'smoothstep', 'smootherstep', or 'in_', 'out_' or 'in_out_' before 'sine', 'quad', \
             'cubic', 'quart', 'quint', 'expo', 'circ', 'back', 'elastic', 'bounce'. 'in' begins \
             softly, 'out' ends softly. Other names are reported.",
            )
            .known(
                Confidence::Project,
                "R. Penner, Programming Macromedia Flash MX, 2002, chapter 7, his constants; each 'out' \
             and 'in_out' is its 'in' turned round; smootherstep K. Perlin 2002",
            )
            .example("<1> 0.25 | <2> 'out_quad' | <1> 0.25 -> <1> 0.0625 | <1> 0.4375"),
    ];

fn ease(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let easing = Easing::named(inputs.text(2)?)?;
    outputs.send(1, easing.at(inputs.number(1)?));
    Ok(())
}

/// A course from 0 to 1.
#[derive(Clone, Copy)]
pub(super) struct Easing {
    softly_in: Course,
    end: End,
}

/// Which end is soft.
#[derive(Clone, Copy)]
enum End {
    In,
    Out,
    Both,
}

type Course = fn(f64) -> f64;

/// The courses that begin softly.
const COURSES: [(&str, Course); 10] = [
    ("sine", |t| 1.0 - (t * FRAC_PI_2).cos()),
    ("quad", |t| t * t),
    ("cubic", |t| t.powi(3)),
    ("quart", |t| t.powi(4)),
    ("quint", |t| t.powi(5)),
    ("expo", |t| if t > 0.0 { (10.0 * (t - 1.0)).exp2() } else { 0.0 }),
    ("circ", |t| 1.0 - (1.0 - t * t).max(0.0).sqrt()),
    ("back", |t| t * t * ((OVERSHOOT + 1.0) * t - OVERSHOOT)),
    ("elastic", elastic),
    ("bounce", |t| 1.0 - bounce(1.0 - t)),
];

/// Ten hundredths beyond the end (Penner).
const OVERSHOOT: f64 = 1.70158;

fn elastic(t: f64) -> f64 {
    if t <= 0.0 || t >= 1.0 {
        return t;
    }
    let decay = (10.0 * (t - 1.0)).exp2();
    -decay * ((t - 1.075) * TAU / 0.3).sin()
}

/// Four parabolas, each lower than the one before (Penner).
fn bounce(t: f64) -> f64 {
    let (from, rest) = match t * 2.75 {
        x if x < 1.0 => (0.0, 0.0),
        x if x < 2.0 => (1.5, 0.75),
        x if x < 2.5 => (2.25, 0.9375),
        _ => (2.625, 0.984_375),
    };
    let t = t - from / 2.75;
    7.5625 * t * t + rest
}

impl Easing {
    pub(super) fn named(name: &str) -> Result<Self, Fault> {
        let is = |known: &str| name.eq_ignore_ascii_case(known);
        let both = |softly_in| Self {
            softly_in,
            end: End::In,
        };
        if is("linear") {
            return Ok(both(|t| t));
        }
        if is("smoothstep") {
            return Ok(both(|t| t * t * (3.0 - 2.0 * t)));
        }
        if is("smootherstep") {
            return Ok(both(|t| t.powi(3) * (10.0 + t * (6.0 * t - 15.0))));
        }
        for (prefix, end) in [("in_out_", End::Both), ("in_", End::In), ("out_", End::Out)] {
            let Some((before, course)) = name.split_at_checked(prefix.len()) else {
                continue;
            };
            if before.eq_ignore_ascii_case(prefix)
                && let Some((_, softly_in)) = COURSES
                    .iter()
                    .find(|(known, _)| course.eq_ignore_ascii_case(known))
            {
                return Ok(Self {
                    softly_in: *softly_in,
                    end,
                });
            }
        }
        domain("there is no easing of that name")
    }

    /// Where it is at `share` of the time; before 0 and after 1 it rests.
    pub(super) fn at(self, share: f64) -> f64 {
        let t = share.clamp(0.0, 1.0);
        let course = self.softly_in;
        match self.end {
            End::In => course(t),
            End::Out => 1.0 - course(1.0 - t),
            End::Both if t < 0.5 => course(2.0 * t) / 2.0,
            End::Both => 1.0 - course(2.0 - 2.0 * t) / 2.0,
        }
    }
}
