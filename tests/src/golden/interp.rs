//! The interpolating curve over chord length.

use super::Answered;
use super::number::{numbers, points, vector};
use motion::{Curve, Natural, Smooth};
use serde_json::{Value, json};

pub(super) fn through(input: &Value) -> Answered {
    let (points, dimension) = points(&input["points"]);
    let curve = Natural::chord_length(&points)?;
    let whole = curve.domain().end;
    let sample = |&f: &f64| {
        let u = f * whole;
        json!({
            "f": f, "u": u,
            "value": vector(curve.eval(u), dimension),
            "d1": vector(curve.derivative(u, 1), dimension),
            "d2": vector(curve.derivative(u, 2), dimension),
        })
    };
    let samples: Vec<Value> = numbers(&input["fractions"]).iter().map(sample).collect();
    let knots = curve.knots();
    Ok(json!({
        "kept": curve.kept(), "params": curve.params(), "length_sum": whole,
        "bcoef": curve.coefficients().iter().map(|&q| vector(q, dimension)).collect::<Vec<_>>(),
        "knots": if knots.is_empty() { Value::Null } else { json!(knots) },
        "samples": samples,
    }))
}
