//! The natural cubic through given points: C2, no bending at either end.
//!
//! Solved for slopes, because that system is strictly dominant whatever the spacing; the B-spline
//! coefficients, which is what people drag, follow by blossoming.
//! Source: the thesis, section 2.3, with the dots restored in its end conditions (second derivatives).

use super::{Blend, Curve, Interval, Piecewise, Smooth, SplineError};

/// The natural interpolating cubic over strictly increasing abscissae.
/// One point is a constant, two are a straight line.
#[derive(Clone, Debug, PartialEq)]
pub struct Natural<P> {
    slopes: Vec<P>,
    curve: Piecewise<P>,
}

impl<P: Blend> Natural<P> {
    /// The curve that passes `values[j]` at `abscissae[j]`.
    pub fn new(abscissae: &[f64], values: &[P]) -> Result<Self, SplineError> {
        check_abscissae(abscissae, values)?;
        let slopes = natural_slopes(abscissae, values);
        let curve = Piecewise::hermite(abscissae, values, &slopes);
        Ok(Self { slopes, curve })
    }

    /// The parameters at which the points are met.
    pub fn abscissae(&self) -> &[f64] {
        self.curve.knots()
    }

    /// The first derivative at each point.
    pub fn slopes(&self) -> &[P] {
        &self.slopes
    }

    /// The curve as polynomials.
    pub fn piecewise(&self) -> &Piecewise<P> {
        &self.curve
    }

    /// The knots of the curve as a B-spline: both ends four-fold. Empty for one point.
    pub fn knots(&self) -> Vec<f64> {
        four_fold_knots(self.abscissae())
    }

    /// Its n+3 B-spline coefficients for n+1 points, the first and last being the end points;
    /// the point itself where there is only one. Dragging one changes four spans, dragging a point all.
    pub fn coefficients(&self) -> Vec<P> {
        let a = self.abscissae();
        let n = a.len() - 1;
        let (first, last) = (self.curve.knot_value(0), self.curve.knot_value(n));
        if n == 0 {
            return vec![first];
        }
        let mut coefficients = Vec::with_capacity(n + 3);
        coefficients.push(first);
        for j in 0..=n {
            // The blossom of the polynomial about a[j] at (a[j-1], a[j], a[j+1]).
            let back = if j == 0 { 0.0 } else { a[j] - a[j - 1] };
            let ahead = if j == n { 0.0 } else { a[j + 1] - a[j] };
            let bend = self.curve.segments().get(j).map_or_else(P::default, |c| c[2]);
            coefficients.push(
                self.curve.knot_value(j)
                    + self.slopes[j] * ((ahead - back) / 3.0)
                    + bend * (-back * ahead / 3.0),
            );
        }
        coefficients.push(last);
        coefficients
    }
}

impl<P: Blend> Curve for Natural<P> {
    type Point = P;

    fn domain(&self) -> Interval {
        self.curve.domain()
    }

    fn eval(&self, u: f64) -> P {
        self.curve.eval(u)
    }
}

impl<P: Blend> Smooth for Natural<P> {
    fn derivative(&self, u: f64, order: u8) -> P {
        self.curve.derivative(u, order)
    }
}

/// First and last abscissa four times, the inner ones once; nothing for a single abscissa.
pub(crate) fn four_fold_knots(abscissae: &[f64]) -> Vec<f64> {
    match abscissae {
        [first, inner @ .., last] => {
            let mut knots = vec![*first; 4];
            knots.extend_from_slice(inner);
            knots.extend([*last; 4]);
            knots
        }
        _ => Vec::new(),
    }
}

/// One finite value for each of at least one finite, strictly increasing abscissae.
pub(crate) fn check_abscissae<P: Blend>(abscissae: &[f64], values: &[P]) -> Result<(), SplineError> {
    if abscissae.len() != values.len() {
        return Err(SplineError::Lengths {
            parameters: abscissae.len(),
            points: values.len(),
        });
    }
    if abscissae.is_empty() {
        return Err(SplineError::Empty);
    }
    if let Some(at) = abscissae
        .iter()
        .zip(values)
        .position(|(a, v)| !(a.is_finite() && v.is_finite()))
    {
        return Err(SplineError::NotFinite { at });
    }
    match abscissae.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(before) => Err(SplineError::NotIncreasing { at: before + 1 }),
        None => Ok(()),
    }
}

/// The slopes of the natural cubic, by elimination without pivoting (the rows are strictly dominant):
/// `h[j+1] m[j-1] + 2 (h[j]+h[j+1]) m[j] + h[j] m[j+1] = 3 (h[j+1] d[j] + h[j] d[j+1])`,
/// each row divided by `h[j]+h[j+1]` so that no product of intervals can leave the range of f64.
pub(crate) fn natural_slopes<P: Blend>(a: &[f64], values: &[P]) -> Vec<P> {
    let n = a.len() - 1;
    if n == 0 {
        return vec![P::default()];
    }
    let chord = |j: usize| (values[j + 1] - values[j]) * (1.0 / (a[j + 1] - a[j]));
    // Row 0: 2 m0 + m1 = 3 d1.
    let mut above = vec![0.5; n + 1];
    let mut slopes = vec![P::default(); n + 1];
    slopes[0] = chord(0) * 1.5;
    for j in 1..=n {
        let (left, right, rhs) = if j == n {
            (1.0, 0.0, chord(n - 1) * 3.0)
        } else {
            let before = (a[j] - a[j - 1]) / (a[j + 1] - a[j - 1]);
            let after = 1.0 - before;
            (after, before, (chord(j - 1) * after + chord(j) * before) * 3.0)
        };
        let pivot = 2.0 - left * above[j - 1];
        above[j] = right / pivot;
        slopes[j] = (rhs - slopes[j - 1] * left) * (1.0 / pivot);
    }
    for j in (0..n).rev() {
        slopes[j] = slopes[j] - slopes[j + 1] * above[j];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn three_points_have_the_published_coefficients() {
        // Maths notes, section 2: (0,0),(1,1),(2,0) at 0, sqrt 2, 2 sqrt 2.
        let root = 2.0_f64.sqrt();
        let points = [DVec2::ZERO, DVec2::ONE, DVec2::new(2.0, 0.0)];
        let curve = Natural::new(&[0.0, root, 2.0 * root], &points).expect("valid");
        let want = [[0., 0.], [1. / 3., 0.5], [1., 1.5], [5. / 3., 0.5], [2., 0.]];
        for (got, want) in curve.coefficients().iter().zip(want) {
            assert!(
                got.abs_diff_eq(DVec2::from_array(want), 1e-15),
                "{got} wanted {want:?}"
            );
        }
    }

    #[test]
    fn uneven_rows_keep_the_second_derivative_continuous_and_zero_at_the_ends() {
        let a = [0.0, 1e-3, 1.0, 1.5, 9.0];
        let curve = Natural::new(&a, &[0.0, 2.0, -1.0, 4.0, 4.5]).expect("valid");
        for j in 1..4 {
            let [_, _, c2, c3] = curve.piecewise().segments()[j - 1];
            let from_left = 2.0 * c2 + 6.0 * c3 * (a[j] - a[j - 1]);
            let from_right = curve.derivative(a[j], 2);
            assert!(
                (from_left - from_right).abs() < 1e-9 * (1.0 + from_left.abs()),
                "at {}",
                a[j]
            );
        }
        assert!(curve.derivative(0.0, 2).abs() < 1e-9);
        assert!(curve.derivative(9.0, 2).abs() < 1e-9);
    }
}
