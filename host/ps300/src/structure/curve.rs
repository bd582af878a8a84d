//! Curves as chords: B-splines and polynomials, plain and rational.
//!
//! Both are evaluated on coordinates times weight, and divided at the end; without weights the divisor is 1.
//! Knots not written: equally spaced where the curve is periodic, otherwise as many equal ones at either end
//! as the order says, with equal steps between. A closed curve goes on through its first vertices again.
//! Source: C. de Boor, A Practical Guide to Splines, 1978; the standard knots ours.

use glam::{DVec3, DVec4};

use crate::language::{BSpline, Dimension, Node, Polynomial};
use crate::value::Value;

/// More chords than this draw no finer curve on any screen.
const CHORDS_MAX: u32 = 4096;

/// A curve as written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Curve {
    BSpline(BSpline),
    Polynomial(Polynomial),
}

impl Curve {
    /// Its points, one more than it has chords; none where it is not a curve.
    pub(super) fn points(&self) -> Vec<DVec3> {
        match self {
            Self::BSpline(spline) => spline_points(spline),
            Self::Polynomial(polynomial) => polynomial_points(polynomial),
        }
    }

    pub(super) fn dimension(&self) -> Dimension {
        match self {
            Self::BSpline(spline) => spline.dimension,
            Self::Polynomial(polynomial) => polynomial.dimension,
        }
    }

    /// The vertices or coefficients and, in step with them, the weights.
    pub(super) fn controls(&mut self) -> (&mut Vec<DVec3>, Option<&mut Vec<f64>>) {
        match self {
            Self::BSpline(spline) => (&mut spline.vertices, spline.weights.as_mut()),
            Self::Polynomial(polynomial) => (&mut polynomial.coefficients, polynomial.weights.as_mut()),
        }
    }

    /// Its controls, then its weights.
    pub(super) fn remembered(&self) -> Vec<Value> {
        let (controls, weights) = match self {
            Self::BSpline(spline) => (&spline.vertices, &spline.weights),
            Self::Polynomial(polynomial) => (&polynomial.coefficients, &polynomial.weights),
        };
        let weights = weights.iter().flatten().copied().map(Value::Real);
        let mut state = vec![Value::Integer(i32::try_from(controls.len()).unwrap_or(i32::MAX))];
        state.extend(controls.iter().copied().map(Value::Vector3));
        state.extend(weights);
        state
    }

    /// This curve with the controls and weights that `state` holds.
    pub(super) fn recalled(&self, state: &[Value]) -> Option<Self> {
        let (first, rest) = state.split_first()?;
        let Value::Integer(count) = first else { return None };
        let (points, shares) = rest.split_at_checked(usize::try_from(*count).ok()?)?;
        let point = |value: &Value| match value {
            Value::Vector3(at) => Some(*at),
            _ => None,
        };
        let points = points.iter().map(point).collect::<Option<Vec<_>>>()?;
        let shares = shares.iter().map(Value::as_number).collect::<Option<Vec<_>>>()?;
        let mut now = self.clone();
        let (controls, weights) = now.controls();
        let fits = weights.as_ref().map_or(0, |_| points.len()) == shares.len();
        let recounted = controls.len() != points.len();
        *controls = points;
        if let Some(weights) = weights {
            *weights = shares;
        }
        if recounted {
            now.recount();
        }
        fits.then_some(now)
    }

    /// After the number of controls has changed, knots that were written fit no longer.
    pub(super) fn recount(&mut self) {
        match self {
            Self::BSpline(spline) => spline.knots.clear(),
            Self::Polynomial(polynomial) => {
                polynomial.order = polynomial.coefficients.len().saturating_sub(1) as u8;
            }
        }
    }
}

impl From<Curve> for Node {
    fn from(curve: Curve) -> Self {
        match curve {
            Curve::BSpline(spline) => Self::BSpline(spline),
            Curve::Polynomial(polynomial) => Self::Polynomial(polynomial),
        }
    }
}

fn weighted(points: &[DVec3], weights: Option<&[f64]>, index: usize) -> DVec4 {
    let at = points.get(index).copied().unwrap_or(DVec3::ZERO);
    let weight = weights.map_or(1.0, |weights| weights.get(index).copied().unwrap_or(1.0));
    (at * weight).extend(weight)
}

fn divided(sum: DVec4) -> Option<DVec3> {
    let at = sum.truncate() / sum.w;
    at.is_finite().then_some(at)
}

fn shares(chords: u32) -> impl Iterator<Item = f64> {
    let chords = chords.clamp(1, CHORDS_MAX);
    (0..=chords).map(move |step| f64::from(step) / f64::from(chords))
}

fn spline_points(spline: &BSpline) -> Vec<DVec3> {
    let count = spline.vertices.len();
    // Fewer vertices than the order asks for: the highest order they allow.
    let order = usize::from(spline.order).min(count);
    if order == 0 {
        return Vec::new();
    }
    let weights = spline.weights.as_deref();
    let mut controls: Vec<_> = (0..count)
        .map(|index| weighted(&spline.vertices, weights, index))
        .collect();
    if spline.closed && spline.periodic {
        controls.extend_from_within(..order - 1);
    } else if spline.closed {
        controls.extend_from_within(..1);
    }
    let wanted = controls.len() + order;
    let knots = if spline.knots.len() == wanted && spline.knots.is_sorted() {
        spline.knots.clone()
    } else {
        standard_knots(controls.len(), order, spline.periodic)
    };
    let (first, last) = (knots[order - 1], knots[controls.len()]);
    let mut spare = Vec::with_capacity(order);
    shares(spline.chords)
        .filter_map(|share| {
            let u = first + (last - first) * share;
            divided(de_boor(&controls, &knots, order, u, &mut spare))
        })
        .collect()
}

fn standard_knots(count: usize, order: usize, periodic: bool) -> Vec<f64> {
    (0..count + order)
        .map(|index| {
            let index = if periodic {
                index
            } else {
                index.clamp(order - 1, count)
            };
            index as f64
        })
        .collect()
}

/// The point at `u`, which lies between the first and last knots that count.
fn de_boor(controls: &[DVec4], knots: &[f64], order: usize, u: f64, spare: &mut Vec<DVec4>) -> DVec4 {
    // The last span of some length that does not begin behind `u`.
    let span = (order - 1..controls.len())
        .rev()
        .find(|&span| knots[span] <= u && knots[span] < knots[span + 1])
        .unwrap_or(order - 1);
    spare.clear();
    spare.extend_from_slice(&controls[span + 1 - order..=span]);
    for level in 1..order {
        for at in (level..order).rev() {
            let low = knots[span + 1 - order + at];
            let high = knots[span + at + 1 - level];
            let share = if high > low { (u - low) / (high - low) } else { 0.0 };
            spare[at] = spare[at - 1].lerp(spare[at], share);
        }
    }
    spare[order - 1]
}

fn polynomial_points(polynomial: &Polynomial) -> Vec<DVec3> {
    let coefficients = &polynomial.coefficients;
    if coefficients.is_empty() {
        return Vec::new();
    }
    let at = |u: f64| {
        let mut sum = DVec4::ZERO;
        for (index, coefficient) in coefficients.iter().enumerate() {
            let weight = polynomial
                .weights
                .as_ref()
                .and_then(|weights| weights.get(index).copied())
                .unwrap_or(0.0);
            sum = sum * u + coefficient.extend(weight);
        }
        if polynomial.weights.is_none() {
            sum.w = 1.0;
        }
        divided(sum)
    };
    shares(polynomial.chords).filter_map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline(order: u8, vertices: &[[f64; 2]], closed: bool, periodic: bool) -> BSpline {
        BSpline {
            order,
            closed,
            periodic,
            dimension: Dimension::Two,
            vertices: vertices.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect(),
            weights: None,
            knots: Vec::new(),
            chords: 4,
        }
    }

    fn near(a: DVec3, b: [f64; 2]) -> bool {
        (a - DVec3::new(b[0], b[1], 0.0)).length() < 1e-12
    }

    #[test]
    fn a_line_is_a_spline_of_order_two() {
        let points = spline_points(&spline(2, &[[0.0, 0.0], [4.0, 0.0]], false, false));
        assert_eq!(points.len(), 5);
        assert!(near(points[1], [1.0, 0.0]) && near(points[4], [4.0, 0.0]));
    }

    #[test]
    fn four_vertices_of_order_four_are_a_bezier_curve() {
        let vertices = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        let points = spline_points(&spline(4, &vertices, false, false));
        assert!(near(points[0], [0.0, 0.0]) && near(points[4], [1.0, 0.0]));
        assert!(near(points[2], [0.5, 0.75]));
    }

    #[test]
    fn a_periodic_closed_spline_ends_where_it_begins() {
        let square = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        let points = spline_points(&spline(4, &square, true, true));
        assert!((points[0] - points[4]).length() < 1e-12);
        // The uniform cubic at a knot: a sixth, four sixths, a sixth of three neighbours.
        assert!(near(points[0], [-2.0 / 3.0, 2.0 / 3.0]), "{}", points[0]);
        let points = spline_points(&spline(4, &square, true, false));
        assert!(near(points[0], [1.0, 1.0]) && near(points[4], [1.0, 1.0]));
    }

    #[test]
    fn three_weighted_vertices_are_a_quarter_of_a_circle() {
        let mut quarter = spline(3, &[[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], false, false);
        quarter.weights = Some(vec![1.0, 0.5_f64.sqrt(), 1.0]);
        for point in spline_points(&quarter) {
            assert!((point.length() - 1.0).abs() < 1e-12, "{point}");
        }
    }

    #[test]
    fn knots_that_are_written_count_and_those_that_do_not_fit_do_not() {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
        let mut uneven = spline(2, &vertices, false, false);
        uneven.knots = vec![0.0, 0.0, 3.0, 4.0, 4.0];
        assert!(near(spline_points(&uneven)[3], [1.0, 0.0]));
        uneven.knots.pop();
        assert!(near(spline_points(&uneven)[2], [1.0, 0.0]));
        let mut odd = spline(9, &vertices[..1], true, true);
        assert_eq!(spline_points(&odd).len(), 5);
        odd.vertices.clear();
        assert!(spline_points(&odd).is_empty());
    }

    #[test]
    fn polynomials_begin_with_the_highest_power() {
        let mut parabola = Polynomial {
            order: 2,
            dimension: Dimension::Two,
            coefficients: vec![DVec3::Y, DVec3::X, DVec3::Z],
            weights: None,
            chords: 2,
        };
        assert_eq!(
            polynomial_points(&parabola),
            [DVec3::Z, DVec3::new(0.5, 0.25, 1.0), DVec3::ONE]
        );
        // Divided by u: no point at 0.
        parabola.weights = Some(vec![0.0, 1.0, 0.0]);
        assert_eq!(
            polynomial_points(&parabola),
            [DVec3::new(1.0, 0.5, 2.0), DVec3::ONE]
        );
    }
}
