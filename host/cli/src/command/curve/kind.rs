//! One curve of either kind over points of any dimension.

use glam::{DVec2, DVec3};
use motion::curve::{ChordLength, arc_length};
use motion::{BSpline, Blend, Curve, Interval, Natural, Smooth};
use rig::document::FileError;
use rig::document::source::Source;

use super::CurveArgs;
use super::points::{self, Points};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::input;

/// A point that can be read from and written as coordinates.
pub(super) trait Point: Blend {
    /// Missing coordinates are 0.
    fn from_coordinates(coordinates: &[f64]) -> Self;
    /// As many as the dimension.
    fn coordinates(self) -> Vec<f64>;
}

impl Point for f64 {
    fn from_coordinates(coordinates: &[f64]) -> Self {
        coordinates.first().copied().unwrap_or_default()
    }
    fn coordinates(self) -> Vec<f64> {
        vec![self]
    }
}

impl Point for DVec2 {
    fn from_coordinates(coordinates: &[f64]) -> Self {
        let mut coordinates = coordinates.iter().copied();
        let mut next = || coordinates.next().unwrap_or_default();
        Self::new(next(), next())
    }
    fn coordinates(self) -> Vec<f64> {
        self.to_array().to_vec()
    }
}

impl Point for DVec3 {
    fn from_coordinates(coordinates: &[f64]) -> Self {
        let mut coordinates = coordinates.iter().copied();
        let mut next = || coordinates.next().unwrap_or_default();
        Self::new(next(), next(), next())
    }
    fn coordinates(self) -> Vec<f64> {
        self.to_array().to_vec()
    }
}

/// Either curve.
pub(super) enum AnyCurve<P> {
    /// Through the points.
    Natural(ChordLength<P>),
    /// Drawn to the points.
    BSpline(BSpline<P>),
}

impl<P: Point> AnyCurve<P> {
    pub(super) fn domain(&self) -> Interval {
        match self {
            Self::Natural(curve) => curve.domain(),
            Self::BSpline(curve) => curve.domain(),
        }
    }

    /// How long the curve is over a range of its parameter.
    pub(super) fn length(&self, over: Interval) -> f64 {
        match self {
            Self::Natural(curve) => arc_length(curve, &curve.knots(), over),
            Self::BSpline(curve) => arc_length(curve, curve.knots(), over),
        }
    }

    /// Order 0 is the point itself.
    pub(super) fn derivative(&self, u: f64, order: u8) -> Vec<f64> {
        match self {
            Self::Natural(curve) => curve.derivative(u, order),
            Self::BSpline(curve) => curve.derivative(u, order),
        }
        .coordinates()
    }
}

/// What a command does with its curve, whatever the dimension.
pub(super) trait Use {
    fn curve<P: Point>(&self, curve: &AnyCurve<P>, points: &Points) -> Result<Exit, Failure>;
}

/// Reads the points and hands over the curve that was asked for.
pub(super) fn with_curve(args: &CurveArgs, console: &Console, work: &impl Use) -> Result<Exit, Failure> {
    let source = input::read(&args.points, console)?;
    let points = points::read(&source)?;
    let order = args.order.or(points.order);
    match points.rows.first().map_or(0, Vec::len) {
        1 => built::<f64>(&points, order, &source, work),
        2 => built::<DVec2>(&points, order, &source, work),
        _ => built::<DVec3>(&points, order, &source, work),
    }
}

fn built<P: Point>(
    points: &Points,
    order: Option<u32>,
    source: &Source,
    work: &impl Use,
) -> Result<Exit, Failure> {
    let through: Vec<P> = points.rows.iter().map(|row| P::from_coordinates(row)).collect();
    let curve = match order {
        Some(order) => BSpline::new(through, order as usize).map(AnyCurve::BSpline),
        None => Natural::chord_length(&through).map(AnyCurve::Natural),
    };
    let curve = curve.map_err(|error| FileError::whole(source.path(), error.to_string()))?;
    work.curve(&curve, points)
}
