//! Piecewise cubic curves in power form: what every interpolating curve of this crate is evaluated as.
//!
//! Each interval keeps its polynomial about its left knot, so a change of one interval leaves the others
//! identical, and a value at a knot is the given value exactly.

use super::natural::check_abscissae;
use super::{Blend, Curve, Interval, Smooth, SplineError};

/// A cubic on each interval of strictly increasing knots; a constant where there is one knot.
/// Beyond its ends it holds the end value.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise<P> {
    knots: Vec<f64>,
    /// One less than knots; power coefficients about the left knot, constant first.
    segments: Vec<[P; 4]>,
    last: P,
}

impl<P: Blend> Piecewise<P> {
    /// Straight lines through `values[j]` at `abscissae[j]`, which must be finite and increase strictly.
    pub fn straight(abscissae: &[f64], values: &[P]) -> Result<Self, SplineError> {
        check_abscissae(abscissae, values)?;
        Ok(Self::polyline(abscissae, values))
    }

    /// Cubic Hermite interpolation. The caller has made sure that all three have one length of at least 1
    /// and that the knots increase.
    pub(crate) fn hermite(knots: &[f64], values: &[P], slopes: &[P]) -> Self {
        let segments = (1..knots.len())
            .map(|j| {
                let h = knots[j] - knots[j - 1];
                let chord = (values[j] - values[j - 1]) * (1.0 / h);
                let (from, to) = (slopes[j - 1], slopes[j]);
                let bend = (chord * 3.0 - from * 2.0 - to) * (1.0 / h);
                let twist = (from + to - chord * 2.0) * (1.0 / h) * (1.0 / h);
                [values[j - 1], from, bend, twist]
            })
            .collect();
        Self::assemble(knots, values, segments)
    }

    /// Straight lines between the values; same conditions as the other constructors'.
    pub(crate) fn polyline(knots: &[f64], values: &[P]) -> Self {
        let segments = (1..knots.len())
            .map(|j| {
                let slope = (values[j] - values[j - 1]) * (1.0 / (knots[j] - knots[j - 1]));
                [values[j - 1], slope, P::default(), P::default()]
            })
            .collect();
        Self::assemble(knots, values, segments)
    }

    fn assemble(knots: &[f64], values: &[P], segments: Vec<[P; 4]>) -> Self {
        Self {
            knots: knots.to_vec(),
            segments,
            last: values.last().copied().unwrap_or_default(),
        }
    }

    /// Adds a polynomial (about the left knot) to one interval.
    pub(crate) fn add_to_segment(&mut self, segment: usize, polynomial: [P; 4]) {
        for (into, add) in self.segments[segment].iter_mut().zip(polynomial) {
            *into = *into + add;
        }
    }

    /// The knots, strictly increasing.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The power coefficients of each interval about its left knot, constant first.
    pub fn segments(&self) -> &[[P; 4]] {
        &self.segments
    }

    /// The value at knot `index`.
    pub(crate) fn knot_value(&self, index: usize) -> P {
        self.segments.get(index).map_or(self.last, |c| c[0])
    }

    /// The interval that contains `u` and the distance from its left knot; `u` is clamped first.
    fn locate(&self, u: f64) -> Option<(&[P; 4], f64)> {
        let u = self.domain().clamp(u);
        let after = self.knots.partition_point(|&knot| knot <= u);
        let index = after.saturating_sub(1).min(self.segments.len().checked_sub(1)?);
        Some((&self.segments[index], u - self.knots[index]))
    }
}

impl<P: Blend> Curve for Piecewise<P> {
    type Point = P;

    fn domain(&self) -> Interval {
        let end = |knot: Option<&f64>| knot.copied().unwrap_or(0.0);
        Interval::new(end(self.knots.first()), end(self.knots.last()))
    }

    fn eval(&self, u: f64) -> P {
        // The last value is kept apart so that the end is met exactly.
        if u >= self.domain().end {
            return self.last;
        }
        self.locate(u)
            .map_or(self.last, |(c, x)| c[0] + (c[1] + (c[2] + c[3] * x) * x) * x)
    }
}

impl<P: Blend> Smooth for Piecewise<P> {
    fn derivative(&self, u: f64, order: u8) -> P {
        let Some((c, x)) = self.locate(u) else {
            return if order == 0 { self.last } else { P::default() };
        };
        match order {
            0 => self.eval(u),
            1 => c[1] + (c[2] * 2.0 + c[3] * (3.0 * x)) * x,
            2 => c[2] * 2.0 + c[3] * (6.0 * x),
            3 => c[3] * 6.0,
            _ => P::default(),
        }
    }
}
