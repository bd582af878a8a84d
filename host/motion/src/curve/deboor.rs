//! B-spline arithmetic on one span of any knot sequence.
//!
//! Apart from the curve types because the uniform curve and the edited kinetics share it.
//! Source: the recursion of Cox and de Boor; C. de Boor, A Practical Guide to Splines, chapter X.
//! Only the `order` points that matter to a span are read, so whatever happens to the others leaves
//! the result identical to the last bit.

use super::Blend;

/// Orders up to this one are evaluated without allocation; cubic curves need 4.
pub(super) const STACK_ORDER: usize = 8;

/// The `order` basis values that are not zero on span `knots[span] <= u <= knots[span + 1]`,
/// the first belonging to point `span + 1 - order`. `values.len()` is the order.
pub(super) fn basis(knots: &[f64], span: usize, u: f64, values: &mut [f64]) {
    values[0] = 1.0;
    for degree in 1..values.len() {
        let mut carried = 0.0;
        for r in 0..degree {
            let right = knots[span + 1 + r] - u;
            let left = u - knots[span + 1 + r - degree];
            // The sum is at least the span's own length, which is positive.
            let share = values[r] / (right + left);
            values[r] = carried + right * share;
            carried = left * share;
        }
        values[degree] = carried;
    }
}

/// The weighted sum of the span's points. Zero weights are skipped: they must not even change the sign
/// of a zero.
pub(super) fn combine<P: Blend>(values: &[f64], points: &[P]) -> P {
    let mut sum: Option<P> = None;
    for (&weight, &point) in values.iter().zip(points) {
        if weight != 0.0 {
            let part = point * weight;
            sum = Some(sum.map_or(part, |so_far| so_far + part));
        }
    }
    sum.unwrap_or_default()
}

/// The value of a spline of that order on its span; `points` are all of its points.
pub(super) fn eval<P: Blend>(knots: &[f64], points: &[P], order: usize, span: usize, u: f64) -> P {
    let local = &points[span + 1 - order..=span];
    if order <= STACK_ORDER {
        let mut values = [0.0; STACK_ORDER];
        basis(knots, span, u, &mut values[..order]);
        combine(&values[..order], local)
    } else {
        let mut values = vec![0.0; order];
        basis(knots, span, u, &mut values);
        combine(&values, local)
    }
}

/// The `times`-th derivative on that span: the curve of divided differences, evaluated.
pub(super) fn derivative<P: Blend>(
    knots: &[f64],
    points: &[P],
    order: usize,
    span: usize,
    u: f64,
    times: usize,
) -> P {
    if times >= order {
        return P::default();
    }
    let first = span + 1 - order;
    let mut local = points[first..=span].to_vec();
    for done in 0..times {
        let degree = order - 1 - done;
        for r in 0..degree {
            // Point first+done+r of the curve before, and the next; both ends enclose the span.
            let low = knots[first + done + r + 1];
            let high = knots[first + done + r + 1 + degree];
            local[r] = (local[r + 1] - local[r]) * (degree as f64 / (high - low));
        }
        local.pop();
    }
    let mut values = vec![0.0; order - times];
    basis(knots, span, u, &mut values);
    combine(&values, &local)
}

/// Power coefficients (constant first) of a cubic spline on one span, about the span's left knot.
pub(crate) fn span_polynomial<P: Blend>(knots: &[f64], points: &[P], span: usize) -> [P; 4] {
    let u = knots[span];
    let at = |times| derivative(knots, points, 4, span, u, times);
    [at(0), at(1), at(2) * 0.5, at(3) * (1.0 / 6.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_polynomial_is_the_spline() {
        let knots = [0.0, 0.0, 0.0, 0.0, 0.5, 1.2, 2.0, 2.0, 2.0, 2.0];
        let points = [1.0, -2.0, 0.5, 3.0, 2.0, -1.0];
        for span in 3..6 {
            let c: [f64; 4] = span_polynomial(&knots, &points, span);
            for step in 0..=4 {
                let x = (knots[span + 1] - knots[span]) * f64::from(step) / 4.0;
                let want: f64 = eval(&knots, &points, 4, span, knots[span] + x);
                let got = c[0] + x * (c[1] + x * (c[2] + x * c[3]));
                assert!(
                    (want - got).abs() < 1e-12,
                    "span {span} at {x}: {got} wanted {want}"
                );
            }
        }
    }
}
