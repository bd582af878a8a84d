//! Curves, drawn as as many straight pieces as `CHORDS` says.

use glam::DVec3;

use super::Dimension;

/// `[RATIONAL] BSPLINE ORDER=k [OPEN/CLOSED] [NONPERIODIC/PERIODIC] [N=n] VERTICES=… [KNOTS=…] CHORDS=q`.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline {
    /// One more than the degree, from 1 to [`BSpline::ORDER_MAX`].
    pub order: u8,
    /// Whether the last vertex is followed by the first.
    pub closed: bool,
    /// Whether the knots not written are equally spaced throughout (periodic), instead of piling up at the ends
    /// so that the curve begins at the first vertex. Unless written, closed curves are periodic and open ones not.
    pub periodic: bool,
    /// Two where every vertex was written so, its weight not counted.
    pub dimension: Dimension,
    /// Control points; z is 0 for curves of two dimensions.
    pub vertices: Vec<DVec3>,
    /// `RATIONAL`: one weight for each vertex, written after its coordinates.
    pub weights: Option<Vec<f64>>,
    /// In rising order; none means they follow from the rest.
    pub knots: Vec<f64>,
    /// Straight pieces drawn for the whole curve, at least 1.
    pub chords: u32,
}

impl BSpline {
    /// More is refused; more than cubics are rare. Our choice.
    pub const ORDER_MAX: u8 = 16;
}

/// `[RATIONAL] POLYNOMIAL ORDER=i COEFFICIENTS=… CHORDS=q`: a curve over 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    /// The degree: one less than there are coefficients, at most [`Polynomial::ORDER_MAX`].
    pub order: u8,
    /// Two where every coefficient was written so, its weight not counted.
    pub dimension: Dimension,
    /// That of the highest power first, the constant last.
    pub coefficients: Vec<DVec3>,
    /// `RATIONAL`: coefficients of the polynomial everything is divided by, written after the coordinates.
    pub weights: Option<Vec<f64>>,
    /// Straight pieces drawn for the whole curve, at least 1.
    pub chords: u32,
}

impl Polynomial {
    /// More is refused. Our choice.
    pub const ORDER_MAX: u8 = 16;
}
