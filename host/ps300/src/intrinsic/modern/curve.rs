//! A curve through points, to bend a control's answer.

use glam::DVec2;

use super::super::function::{Fault, Inputs, Outputs, domain};
use super::super::spec::{Confidence, InputSpec, Spec, Times};
use super::{NUMBER, REAL_OUT, truth};
use crate::value::{Kind, Kinds, Value};

const POINT: Kinds = Kinds::of(&[Kind::Vector2]);

pub(super) const TABLE: &[Spec] = &[Spec::pure(
    "DR_CURVE",
    &[NUMBER, truth(true), InputSpec::required(POINT).times(Times::Size)],
    &[REAL_OUT],
    curve,
)
.sized(2, 125)
.says(
    "The height at <1> of the curve through n points, the inputs from <3> on, whose x grows \
             from each to the next. With <2> TRUE smooth and without a rise or dip between points \
             that rise or fall; with FALSE straight from point to point. Before the first point and \
             after the last it is level. Points out of order are reported.",
)
.known(
    Confidence::Project,
    "slopes: F. N. Fritsch, J. Butland, A Method for Constructing Local Monotone Piecewise \
             Cubic Interpolants, 1984; at the ends those of the chords",
)
.example(
    "(3) | <2> FALSE | <3> V2D(0,0) | <4> V2D(0.5,0.1) | <5> V2D(1,1) | <1> 0.25 | <1> 0.75 \
             -> <1> 0.05 | <1> 0.55",
)];

/// The input of the first point.
const FIRST: u8 = 3;

fn curve(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (x, smooth) = (inputs.number(1)?, inputs.boolean(2)?);
    let last = inputs.count();
    for input in FIRST..last {
        if point(inputs, input)?.x >= point(inputs, input + 1)?.x {
            return domain("the x of a curve's points grows from each to the next");
        }
    }
    let behind = (FIRST..=last).find(|&input| point(inputs, input).is_ok_and(|point| point.x > x));
    let y = match behind {
        Some(FIRST) => point(inputs, FIRST)?.y,
        None => point(inputs, last)?.y,
        Some(behind) => {
            let (a, b) = (point(inputs, behind - 1)?, point(inputs, behind)?);
            if smooth {
                hermite(a, slope(inputs, behind - 1)?, b, slope(inputs, behind)?, x)
            } else {
                a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x)
            }
        }
    };
    outputs.send(1, y);
    Ok(())
}

fn point(inputs: &Inputs<'_>, input: u8) -> Result<DVec2, Fault> {
    match inputs.get(input) {
        Value::Vector2(point) => Ok(*point),
        _ => Err(Fault::Kind {
            input,
            expected: POINT,
        }),
    }
}

fn chord(a: DVec2, b: DVec2) -> f64 {
    (b.y - a.y) / (b.x - a.x)
}

/// The slope at a point: between chords that rise or fall together a harmonic mean, weighted by the widths
/// so that the nearer counts more; level at a summit or in a hollow.
fn slope(inputs: &Inputs<'_>, input: u8) -> Result<f64, Fault> {
    let here = point(inputs, input)?;
    let before = (input > FIRST).then(|| point(inputs, input - 1)).transpose()?;
    let after = (input < inputs.count())
        .then(|| point(inputs, input + 1))
        .transpose()?;
    Ok(match (before, after) {
        (Some(before), Some(after)) => {
            let (left, right) = (chord(before, here), chord(here, after));
            if left * right <= 0.0 {
                0.0
            } else {
                let (wide_left, wide_right) = (here.x - before.x, after.x - here.x);
                let share = (wide_left + 2.0 * wide_right) / (3.0 * (wide_left + wide_right));
                left * right / (share * right + (1.0 - share) * left)
            }
        }
        (Some(before), None) => chord(before, here),
        (None, Some(after)) => chord(here, after),
        (None, None) => 0.0,
    })
}

/// The cubic from `a` to `b` with these slopes at its ends.
fn hermite(a: DVec2, slope_a: f64, b: DVec2, slope_b: f64, x: f64) -> f64 {
    let width = b.x - a.x;
    let t = (x - a.x) / width;
    let (s, t2) = (1.0 - t, t * t);
    a.y * (1.0 + 2.0 * t) * s * s + slope_a * width * t * s * s + b.y * t2 * (3.0 - 2.0 * t)
        - slope_b * width * t2 * s
}
