//! The double interpolant: a path over key coordinate, met at the times of its kinetics.
//!
//! value(t) = path(clamp(kinetics(t))). Apart from both, so that either can change without the other.
//! Source: the thesis, section 2.4; the derivatives are the chain rule.

use crate::curve::{Blend, Curve, Smooth};
use crate::kinetics::Kinetics;

/// A path and its timing. Any pair is legal; the path's domain is meant to be 0 to the last key.
#[derive(Clone, Debug, PartialEq)]
pub struct Track<C> {
    /// Where: a curve over key coordinate.
    pub path: C,
    /// When: seconds to key coordinate.
    pub kinetics: Kinetics,
}

impl<C: Curve> Track<C> {
    /// The value at a time; the ends are held.
    pub fn value(&self, secs: f64) -> C::Point {
        self.path.eval(self.kinetics.u(secs))
    }
}

impl<C: Smooth> Track<C>
where
    C::Point: Blend,
{
    /// The first derivative, per second. Zero outside the key times and while the kinetics are beyond the
    /// path's ends; at the first and last key time the one from inside.
    pub fn velocity(&self, secs: f64) -> C::Point {
        let u = self.kinetics.u(secs);
        if !self.path.domain().contains(u) {
            return C::Point::default();
        }
        self.path.derivative(u, 1) * self.kinetics.derivative(secs, 1)
    }

    /// The second derivative, per second squared, under the same conditions.
    pub fn acceleration(&self, secs: f64) -> C::Point {
        let u = self.kinetics.u(secs);
        if !self.path.domain().contains(u) {
            return C::Point::default();
        }
        let rate = self.kinetics.derivative(secs, 1);
        self.path.derivative(u, 2) * (rate * rate)
            + self.path.derivative(u, 1) * self.kinetics.derivative(secs, 2)
    }
}
