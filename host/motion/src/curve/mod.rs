//! Curves over one scalar, and what their points must be able to do.
//!
//! Two traits, because a path of rotations is a curve whose points cannot be added: it may be a
//! [`Curve`] and never a [`Smooth`].

mod blend;
mod bspline;
mod chord;
mod deboor;
mod edit;
mod error;
mod length;
mod natural;
mod piecewise;

pub use blend::Blend;
pub use bspline::{BSpline, Basis};
pub use chord::ChordLength;
pub use edit::Remap;
pub use error::SplineError;
pub use length::arc_length;
pub use natural::Natural;
pub use piecewise::Piecewise;

pub(crate) use deboor::span_polynomial;
pub(crate) use natural::four_fold_knots;

/// A closed interval of one scalar; `start <= end` wherever this crate makes one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// The smaller end.
    pub start: f64,
    /// The larger end.
    pub end: f64,
}

impl Interval {
    /// From `start` to `end`, taken as they come.
    pub const fn new(start: f64, end: f64) -> Self {
        Self { start, end }
    }

    /// `end - start`.
    pub fn length(self) -> f64 {
        self.end - self.start
    }

    /// Whether `u` lies inside, ends included; never for NaN.
    pub fn contains(self, u: f64) -> bool {
        self.start <= u && u <= self.end
    }

    /// The nearest value inside; NaN becomes `start`, so that a curve is total.
    pub fn clamp(self, u: f64) -> f64 {
        if u > self.start {
            u.min(self.end)
        } else {
            self.start
        }
    }
}

/// A path through `Point` space over a closed interval of one scalar.
pub trait Curve {
    /// What the curve is made of.
    type Point;

    /// Where the curve is defined.
    fn domain(&self) -> Interval;

    /// Total: `u` is clamped to the domain (NaN to its start), and construction ruled out the rest.
    fn eval(&self, u: f64) -> Self::Point;
}

/// A curve whose points form a vector space, so its derivatives are points too.
pub trait Smooth: Curve {
    /// The derivative of that order with respect to the curve's own scalar; order 0 is `eval`.
    /// At an inner knot it is the derivative from the right, at the end from the left.
    fn derivative(&self, u: f64, order: u8) -> Self::Point;
}
