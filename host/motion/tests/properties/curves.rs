//! Splines: weights that sum to one, local control to the last bit, derivatives that are derivatives.

use glam::DVec3;
use motion::{BSpline, Curve, Natural, Smooth};
use proptest::prelude::*;

fn points(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<DVec3>> {
    let point = (-5.0..5.0_f64, -5.0..5.0_f64, -5.0..5.0_f64).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    prop::collection::vec(point, count)
}

/// Central difference of a curve's derivative of the order below.
fn difference(curve: &impl Smooth<Point = DVec3>, u: f64, order: u8) -> DVec3 {
    let h = 1e-6;
    (curve.derivative(u + h, order - 1) - curve.derivative(u - h, order - 1)) / (2.0 * h)
}

proptest! {
    #![proptest_config(super::cases(128))]

    #[test]
    fn weights_are_a_partition_of_unity(points in points(2..12), order in 2_usize..13, share in 0.0..=1.0_f64) {
        let curve = BSpline::new(points, order).expect("valid");
        let basis = curve.basis(share * curve.domain().end);
        prop_assert_eq!(basis.values.len(), curve.order());
        prop_assert!(basis.values.iter().all(|&weight| weight >= 0.0));
        prop_assert!((basis.values.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_moved_point_changes_nothing_outside_its_interval(
        points in points(2..12), order in 2_usize..7, which in any::<prop::sample::Index>(), to in points(1..2),
    ) {
        let curve = BSpline::new(points, order).expect("valid");
        let (moved, changed) = curve.move_point(which.index(curve.points().len()), to[0]).expect("valid");
        for step in 0..=200 {
            let u = curve.domain().end * f64::from(step) / 200.0;
            if !changed.contains(u) {
                prop_assert_eq!(curve.eval(u), moved.eval(u), "at {}", u);
            }
        }
    }

    #[test]
    fn b_spline_derivatives_are_limits_of_differences(points in points(4..10), order in 4_usize..7, share in 0.01..0.99_f64) {
        let curve = BSpline::new(points, order).expect("valid");
        let u = share * curve.domain().end;
        prop_assume!((u - u.round()).abs() > 1e-4);
        for order in 1..=2 {
            let (got, want) = (curve.derivative(u, order), difference(&curve, u, order));
            prop_assert!(got.abs_diff_eq(want, 1e-4), "order {}: {} wanted {}", order, got, want);
        }
    }

    #[test]
    fn chord_length_curves_meet_their_points_smoothly(points in points(2..12)) {
        let curve = Natural::chord_length(&points).expect("valid");
        let smallest = curve.params().windows(2).map(|p| p[1] - p[0]).fold(f64::INFINITY, f64::min);
        prop_assume!(smallest > 1e-2);
        for (&u, &point) in curve.params().iter().zip(&points) {
            prop_assert!(curve.eval(u).abs_diff_eq(point, 1e-12));
        }
        for &u in &curve.params()[1..points.len() - 1] {
            let (left, right) = (curve.derivative(u - 1e-9, 2), curve.derivative(u + 1e-9, 2));
            prop_assert!(left.abs_diff_eq(right, 1e-4), "second derivative at {}: {} and {}", u, left, right);
        }
    }

    #[test]
    fn coefficients_are_the_curve_as_a_b_spline(points in points(2..9)) {
        // Greville: the coefficients of the identity are the knot means, so a straight map is reproduced.
        let curve = Natural::chord_length(&points).expect("valid");
        let (knots, coefficients) = (curve.knots(), curve.coefficients());
        prop_assert_eq!(knots.len(), coefficients.len() + 4);
        prop_assert!(coefficients[0].abs_diff_eq(points[0], 1e-12));
        for step in 0..=20 {
            let u = curve.domain().end * f64::from(step) / 20.0;
            let by_blossom = de_boor(&knots, &coefficients, u);
            prop_assert!(by_blossom.abs_diff_eq(curve.eval(u), 1e-8), "at {}", u);
        }
    }
}

/// De Boor's triangle for a cubic, written apart from the crate's.
fn de_boor(knots: &[f64], points: &[DVec3], u: f64) -> DVec3 {
    let span = (3..points.len()).rfind(|&j| knots[j] <= u).unwrap_or(3);
    let mut d: Vec<DVec3> = points[span - 3..=span].to_vec();
    for round in 1..=3 {
        for i in (round..=3).rev() {
            let (low, high) = (knots[span - 3 + i], knots[span + 1 + i - round]);
            d[i] = d[i - 1].lerp(d[i], (u - low) / (high - low));
        }
    }
    d[3]
}
