//! Exact turning points of piecewise cubics, and where one first reaches a value.

use crate::curve::{Blend, Curve, Interval, Piecewise};

/// A reversal shallower than this share of the whole range is rounding, not motion (our choice).
const DEPTH_SHARE: f64 = 1e-12;

/// One stretch of one cubic between turning points, in its own coordinate, with the values at its ends.
struct Stretch {
    segment: usize,
    from: f64,
    to: f64,
    at_from: f64,
    at_to: f64,
}

/// Splits the curve where its derivative changes sign; ends of segments take the exact knot values.
fn stretches(curve: &Piecewise<f64>) -> Vec<Stretch> {
    let knots = curve.knots();
    let mut out = Vec::new();
    for (segment, c) in curve.segments().iter().enumerate() {
        let h = knots[segment + 1] - knots[segment];
        let mut cuts = vec![0.0];
        cuts.extend(turning_points(c).into_iter().filter(|&x| x > 0.0 && x < h));
        cuts.push(h);
        for pair in cuts.windows(2) {
            let value = |x: f64| {
                if x == h {
                    curve.knot_value(segment + 1)
                } else {
                    cubic(c, x)
                }
            };
            let (at_from, at_to) = (value(pair[0]), value(pair[1]));
            out.push(Stretch {
                segment,
                from: pair[0],
                to: pair[1],
                at_from,
                at_to,
            });
        }
    }
    out
}

/// The parts of 0 to `width` on which a cubic only rises or only falls, in order.
pub(crate) fn monotone_parts(c: &[f64; 4], width: f64) -> impl Iterator<Item = (f64, f64)> {
    let mut cuts = vec![0.0];
    cuts.extend(turning_points(c).into_iter().filter(|&x| x > 0.0 && x < width));
    cuts.push(width);
    (1..cuts.len()).map(move |i| (cuts[i - 1], cuts[i]))
}

fn cubic(c: &[f64; 4], x: f64) -> f64 {
    c[0] + (c[1] + (c[2] + c[3] * x) * x) * x
}

/// Real roots of the derivative, ascending. Source: the quadratic formula without cancellation.
fn turning_points(c: &[f64; 4]) -> Vec<f64> {
    let (constant, linear, square) = (c[1], 2.0 * c[2], 3.0 * c[3]);
    if square.abs() <= f64::EPSILON * linear.abs() * f64::EPSILON {
        return if linear == 0.0 {
            Vec::new()
        } else {
            vec![-constant / linear]
        };
    }
    let discriminant = linear * linear - 4.0 * square * constant;
    if discriminant <= 0.0 {
        return Vec::new();
    }
    let q = -0.5 * (linear + discriminant.sqrt().copysign(linear));
    let (a, b) = (q / square, if q == 0.0 { 0.0 } else { constant / q });
    if a < b { vec![a, b] } else { vec![b, a] }
}

/// The intervals on which the curve falls, joined where they touch.
pub(super) fn reversals(curve: &Piecewise<f64>) -> Vec<Interval> {
    let knots = curve.knots();
    let mut falls: Vec<(Interval, f64)> = Vec::new();
    for s in stretches(curve) {
        let depth = s.at_from - s.at_to;
        if depth <= 0.0 {
            continue;
        }
        let left = knots[s.segment];
        let whole = s.to == knots[s.segment + 1] - left;
        let end = if whole { knots[s.segment + 1] } else { left + s.to };
        match falls.last_mut() {
            Some((open, so_far)) if open.end == left + s.from => {
                open.end = end;
                *so_far += depth;
            }
            _ => falls.push((Interval::new(left + s.from, end), depth)),
        }
    }
    let shallowest = DEPTH_SHARE * knots.len() as f64;
    falls
        .into_iter()
        .filter(|(_, depth)| *depth > shallowest)
        .map(|(interval, _)| interval)
        .collect()
}

/// The smallest parameter at which the curve takes the value, which lies between those of its ends.
pub(super) fn first_reach(curve: &Piecewise<f64>, value: f64) -> f64 {
    let knots = curve.knots();
    for s in stretches(curve) {
        let left = knots[s.segment];
        if s.at_from == value {
            return left + s.from;
        }
        if (s.at_from < value) == (value <= s.at_to) && s.at_to != s.at_from {
            if s.at_to == value && s.to == knots[s.segment + 1] - left {
                return knots[s.segment + 1];
            }
            return left + bisect(&curve.segments()[s.segment], &s, value);
        }
    }
    curve.domain().end
}

/// Halves a monotone stretch until it can be halved no more.
fn bisect(c: &[f64; 4], s: &Stretch, value: f64) -> f64 {
    let (mut low, mut high) = (s.from, s.to);
    let rising = s.at_to > s.at_from;
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high || !middle.is_finite() {
            return middle;
        }
        let here = cubic(c, middle);
        if Blend::is_finite(here) && (here < value) == rising {
            low = middle;
        } else {
            high = middle;
        }
    }
}
