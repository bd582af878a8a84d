//! The curve editor's curve: a uniform non-periodic B-spline.
//!
//! n+1 control points and order k (degree k-1) give knots 0 (k times), 1, 2, ..., n-k+2 (k times).
//! Source: the thesis, section 2.3, with the range of u read as 0 to n-k+2.

use super::deboor::{self, STACK_ORDER};
use super::{Blend, Curve, Interval, Smooth, SplineError};

/// The basis functions that are not zero at one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    /// Which control point the first value belongs to.
    pub first: usize,
    /// One weight for each of `order` control points in a row; they add up to 1.
    pub values: Vec<f64>,
}

/// A uniform non-periodic B-spline that remembers the order asked for.
///
/// While there are fewer points than the order, the curve uses a lower order, so that it exists from the
/// first click on. Moving one control point changes the curve on one interval only, and nothing outside
/// it by so much as a bit.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline<P> {
    points: Vec<P>,
    requested: usize,
    order: usize,
    knots: Vec<f64>,
}

impl<P: Blend> BSpline<P> {
    /// A curve of these control points. The order in use is `min(order, points)`.
    ///
    /// Refuses no points, points that are not finite, and an order below 2 for more than one point.
    pub fn new(points: Vec<P>, order: usize) -> Result<Self, SplineError> {
        if points.is_empty() {
            return Err(SplineError::Empty);
        }
        if let Some(at) = points.iter().position(|p| !p.is_finite()) {
            return Err(SplineError::NotFinite { at });
        }
        if order < 2 && points.len() > 1 {
            return Err(SplineError::OrderTooSmall {
                order,
                points: points.len(),
            });
        }
        let in_use = order.clamp(1, points.len());
        let knots = uniform_knots(points.len(), in_use);
        Ok(Self {
            points,
            requested: order,
            order: in_use,
            knots,
        })
    }

    /// The control points.
    pub fn points(&self) -> &[P] {
        &self.points
    }

    /// The order in use: degree plus one, at most the number of points.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The order asked for, which comes into use once there are points enough.
    pub fn requested_order(&self) -> usize {
        self.requested
    }

    /// All knots, `points + order` of them.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Where each control point pulls most: the mean of its inner knots. Strictly increasing, from 0 to
    /// the end of the domain; `[0]` for a single point.
    pub fn greville(&self) -> Vec<f64> {
        if self.order == 1 {
            return vec![0.0];
        }
        let degree = self.order - 1;
        (0..self.points.len())
            .map(|i| self.knots[i + 1..=i + degree].iter().sum::<f64>() / degree as f64)
            .collect()
    }

    /// The weights of the control points at `u`, clamped to the domain.
    pub fn basis(&self, u: f64) -> Basis {
        let (span, u) = self.span(u);
        let mut values = vec![0.0; self.order];
        deboor::basis(&self.knots, span, u, &mut values);
        Basis {
            first: span + 1 - self.order,
            values,
        }
    }

    /// Where the curve changes when control point `index` moves.
    pub fn influence(&self, index: usize) -> Result<Interval, SplineError> {
        self.check_index(index)?;
        Ok(Interval::new(self.knots[index], self.knots[index + self.order]))
    }

    pub(super) fn check_index(&self, index: usize) -> Result<(), SplineError> {
        if index < self.points.len() {
            Ok(())
        } else {
            Err(SplineError::NoSuchPoint {
                index,
                count: self.points.len(),
            })
        }
    }

    /// The span that contains `u`, closed on the left and, for the last one, on the right; and `u` clamped.
    fn span(&self, u: f64) -> (usize, f64) {
        let u = self.domain().clamp(u);
        // Inner knots are the integers, so the span is found by rounding down.
        let span = (u as usize + self.order - 1).min(self.points.len() - 1);
        (span, u)
    }
}

/// 0 for i < k, i-k+1 up to n, n-k+2 beyond.
fn uniform_knots(points: usize, order: usize) -> Vec<f64> {
    (0..points + order)
        .map(|i| (i + 1).clamp(order, points + 1) - order)
        .map(|knot| knot as f64)
        .collect()
}

impl<P: Blend> Curve for BSpline<P> {
    type Point = P;

    fn domain(&self) -> Interval {
        Interval::new(0.0, (self.points.len() + 1 - self.order) as f64)
    }

    fn eval(&self, u: f64) -> P {
        let (span, u) = self.span(u);
        deboor::eval(&self.knots, &self.points, self.order, span, u)
    }
}

impl<P: Blend> Smooth for BSpline<P> {
    fn derivative(&self, u: f64, order: u8) -> P {
        if order == 0 {
            return self.eval(u);
        }
        let (span, u) = self.span(u);
        deboor::derivative(&self.knots, &self.points, self.order, span, u, usize::from(order))
    }
}

/// Cubic curves, the common case, never allocate.
const _: () = assert!(STACK_ORDER >= 4);

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn a_bezier_curve_at_its_middle() {
        // Worked example of the maths notes: k = n+1 = 4.
        let points = [[0., 0., 0.], [1., 2., 0.], [3., 2., 1.], [4., 0., 1.]].map(DVec3::from_array);
        let curve = BSpline::new(points.to_vec(), 4).expect("valid");
        assert_eq!(curve.eval(0.5), DVec3::new(2.0, 1.5, 0.5));
    }

    #[test]
    fn refusals_say_what_is_wrong() {
        assert_eq!(BSpline::<f64>::new(vec![], 4), Err(SplineError::Empty));
        assert_eq!(
            BSpline::new(vec![0.0, f64::NAN], 2),
            Err(SplineError::NotFinite { at: 1 })
        );
        assert_eq!(
            BSpline::new(vec![0.0, 1.0], 1),
            Err(SplineError::OrderTooSmall { order: 1, points: 2 })
        );
    }

    #[test]
    fn nan_parameter_reads_as_the_start() {
        let curve = BSpline::new(vec![3.0, 1.0, 2.0], 3).expect("valid");
        assert_eq!(curve.eval(f64::NAN), 3.0);
        assert_eq!(curve.eval(f64::INFINITY), 2.0);
    }
}
