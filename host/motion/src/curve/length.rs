//! How long a curve is: the integral of its speed, by Gauss-Legendre quadrature between its knots.
//!
//! Between knots a spline's speed is smooth except where the curve stops, so eight points each are
//! nearly always enough; where halves disagree with the whole, a stretch is halved (our choice).

use super::{Blend, Interval, Smooth};

/// Nodes (of −1…1, one of each pair ±) and weights of the eight-point rule.
/// Source: Abramowitz and Stegun, table 25.4, n = 8.
const NODES: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// Halves that agree with the whole to this share are good enough.
const AGREES: f64 = 1e-12;

/// A stretch is halved at most this often: a speed that touches zero gains two digits at each halving.
const HALVINGS_MAX: u32 = 24;

/// The length of the curve over `over`, clamped to its domain; 0 where that is empty or turned round.
///
/// `knots` are the parameters between which the curve is smooth, in ascending order; those outside are ignored.
/// Good to about eleven digits.
pub fn arc_length<C>(curve: &C, knots: &[f64], over: Interval) -> f64
where
    C: Smooth,
    C::Point: Blend,
{
    let domain = curve.domain();
    let (start, end) = (domain.clamp(over.start), domain.clamp(over.end));
    let inner = knots.iter().copied().filter(|&knot| start < knot && knot < end);
    let mut from = start;
    let mut length = 0.0;
    for to in inner.chain([end]) {
        if to > from {
            let stretch = Interval::new(from, to);
            length += halved(curve, stretch, eight_points(curve, stretch), HALVINGS_MAX);
            from = to;
        }
    }
    length
}

/// The length of one stretch, given the first estimate of it.
fn halved<C>(curve: &C, over: Interval, whole: f64, left: u32) -> f64
where
    C: Smooth,
    C::Point: Blend,
{
    let middle = over.start + 0.5 * over.length();
    let halves = [Interval::new(over.start, middle), Interval::new(middle, over.end)];
    let [first, second] = halves.map(|half| eight_points(curve, half));
    let sum = first + second;
    if left == 0 || (sum - whole).abs() <= AGREES * sum || !sum.is_finite() {
        return sum;
    }
    halved(curve, halves[0], first, left - 1) + halved(curve, halves[1], second, left - 1)
}

fn eight_points<C>(curve: &C, over: Interval) -> f64
where
    C: Smooth,
    C::Point: Blend,
{
    let (half, middle) = (0.5 * over.length(), over.start + 0.5 * over.length());
    let speed = |u: f64| curve.derivative(u, 1).length();
    let pair =
        |(node, weight): (f64, f64)| weight * (speed(middle - half * node) + speed(middle + half * node));
    NODES.into_iter().map(pair).sum::<f64>() * half
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{BSpline, Curve, Natural};
    use glam::{DVec2, DVec3};

    fn close(found: f64, expected: f64) {
        assert!(
            (found - expected).abs() <= 1e-10 * expected,
            "{found} is not {expected}"
        );
    }

    #[test]
    fn a_straight_line_is_as_long_as_its_chord() {
        let points = [DVec3::ZERO, DVec3::new(3.0, 4.0, 0.0), DVec3::new(6.0, 8.0, 0.0)];
        let curve = Natural::chord_length(&points).expect("valid");
        close(arc_length(&curve, &curve.knots(), curve.domain()), 10.0);
        close(arc_length(&curve, &curve.knots(), Interval::new(-5.0, 2.5)), 2.5);
        assert_eq!(arc_length(&curve, &curve.knots(), Interval::new(4.0, 1.0)), 0.0);
    }

    #[test]
    fn a_parabola_is_as_long_as_its_closed_form_says() {
        // Control points of y = x^2 over 0…1; the length is (2√5 + asinh 2) / 4.
        let points = vec![DVec2::ZERO, DVec2::new(0.5, 0.0), DVec2::ONE];
        let curve = BSpline::new(points, 3).expect("valid");
        let expected = (2.0 * 5f64.sqrt() + 2f64.asinh()) / 4.0;
        close(arc_length(&curve, curve.knots(), curve.domain()), expected);
    }

    #[test]
    fn a_curve_that_turns_back_is_long_both_ways() {
        // x = 4u(1-u) runs to 1 and back: its speed has a corner at zero.
        let curve = BSpline::new(vec![0.0, 2.0, 0.0], 3).expect("valid");
        close(arc_length(&curve, curve.knots(), curve.domain()), 2.0);
    }

    #[test]
    fn a_point_has_no_length() {
        let curve = Natural::chord_length(&[DVec2::ONE]).expect("valid");
        assert_eq!(arc_length(&curve, &curve.knots(), curve.domain()), 0.0);
    }
}
