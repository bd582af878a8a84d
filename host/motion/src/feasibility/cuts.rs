//! Cutting time where the angle's polynomial changes: at key times, and wherever the kinetics cross a knot.

use crate::joint_track::JointTrack;
use crate::kinetics::monotone_parts;

/// A stretch of time over which every joint is one polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    pub(super) from_secs: f64,
    pub(super) to_secs: f64,
    /// The path's row; none where the kinetics are beyond the ends and all joints are held.
    pub(super) row: Option<usize>,
    /// Distance from the row's left knot over 0 to 1, power coefficients, constant first.
    pub(super) x: [f64; 4],
}

/// The cuts between two key times.
pub(super) fn cuts(track: &JointTrack, span: usize) -> Vec<Cut> {
    let curve = track.kinetics.curve();
    let (Some(c), Some([from_secs, to_secs])) = (
        curve.segments().get(span),
        curve
            .knots()
            .get(span..span + 2)
            .and_then(|pair| <[f64; 2]>::try_from(pair).ok()),
    ) else {
        return Vec::new();
    };
    let (knots, span_secs) = (track.path.knots(), to_secs - from_secs);
    let value = |x: f64| c[0] + (c[1] + (c[2] + c[3] * x) * x) * x;
    let mut at = vec![0.0, span_secs];
    for (start, end) in monotone_parts(c, span_secs) {
        at.push(start);
        let (low, high) = (value(start).min(value(end)), value(start).max(value(end)));
        let first = knots.partition_point(|&knot| knot <= low);
        let beyond = knots.partition_point(|&knot| knot < high);
        at.extend(
            knots
                .get(first..beyond)
                .into_iter()
                .flatten()
                .map(|&knot| crossing(&value, start, end, knot)),
        );
    }
    at.sort_by(f64::total_cmp);
    // Cuts closer than rounding of the span are one.
    let grain = span_secs * 1e-12;
    at.dedup_by(|b, a| *b - *a <= grain);
    let last = at.len() - 1;
    at[last] = span_secs;
    let cut = |pair: &[f64]| {
        let (start, width) = (pair[0], pair[1] - pair[0]);
        let middle = value(f64::midpoint(pair[0], pair[1]));
        let row = row_at(knots, middle);
        let knot = row.map_or(0.0, |row| knots[row]);
        Cut {
            from_secs: from_secs + pair[0],
            to_secs: from_secs + pair[1],
            row,
            // Taylor about the start, in shares of the width.
            x: [
                value(start) - knot,
                (c[1] + (2.0 * c[2] + 3.0 * c[3] * start) * start) * width,
                (c[2] + 3.0 * c[3] * start) * width * width,
                c[3] * width * width * width,
            ],
        }
    };
    at.windows(2).map(cut).collect()
}

fn row_at(knots: &[f64], u: f64) -> Option<usize> {
    let (first, last) = (knots.first()?, knots.last()?);
    let within = u > *first && u < *last;
    within.then(|| knots.partition_point(|&knot| knot <= u) - 1)
}

/// Where a monotone stretch takes a value that lies between those of its ends: halved until it can be no more.
fn crossing(value: &impl Fn(f64) -> f64, start: f64, end: f64, wanted: f64) -> f64 {
    let rising = value(end) > value(start);
    let (mut low, mut high) = (start, end);
    // Each halving gains a bit; a number has 53 and a few leading ones.
    for _ in 0..64 {
        let middle = f64::midpoint(low, high);
        if (value(middle) < wanted) == rising {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}
