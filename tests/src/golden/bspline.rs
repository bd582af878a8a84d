//! The uniform B-spline and its edits.

use super::number::{index, number, numbers, point, points, vector};
use super::{Answered, Refusal};
use glam::DVec3;
use motion::curve::Remap;
use motion::{BSpline, Curve, Smooth};
use serde_json::{Value, json};

fn curve(input: &Value) -> Result<(BSpline<DVec3>, usize), Refusal> {
    let (points, dimension) = points(&input["points"]);
    Ok((BSpline::new(points, index(&input["k"]))?, dimension))
}

fn range(curve: &BSpline<DVec3>) -> [f64; 2] {
    [curve.domain().start, curve.domain().end]
}

pub(super) fn eval(input: &Value) -> Answered {
    let (curve, dimension) = curve(input)?;
    let sample = |&u: &f64| {
        let basis = curve.basis(u);
        json!({
            "u": u, "first": basis.first, "basis": basis.values,
            "value": vector(curve.eval(u), dimension),
            "d1": vector(curve.derivative(u, 1), dimension),
            "d2": vector(curve.derivative(u, 2), dimension),
        })
    };
    let samples: Vec<Value> = numbers(&input["us"]).iter().map(sample).collect();
    Ok(json!({
        "order": curve.order(), "knots": curve.knots(), "range": range(&curve),
        "greville": curve.greville(), "samples": samples,
    }))
}

pub(super) fn move_point(input: &Value) -> Answered {
    let (curve, dimension) = curve(input)?;
    let (moved, changed) = curve.move_point(index(&input["index"]), point(&input["to"]))?;
    let sample = |&u: &f64| {
        let value = moved.eval(u);
        json!({ "u": u, "value": vector(value, dimension), "unchanged": value == curve.eval(u) })
    };
    let samples: Vec<Value> = numbers(&input["us"]).iter().map(sample).collect();
    Ok(json!({ "interval": [changed.start, changed.end], "samples": samples }))
}

pub(super) fn insert(input: &Value) -> Answered {
    let (curve, dimension) = curve(input)?;
    // "after": -1 puts the point before the first.
    let at = usize::try_from(input["after"].as_i64().unwrap_or(-1) + 1).unwrap_or(0);
    let edit = curve.insert_at(at, point(&input["point"]))?;
    Ok(edited(input, &edit, dimension))
}

pub(super) fn delete(input: &Value) -> Answered {
    let (curve, dimension) = curve(input)?;
    let edit = curve.delete(index(&input["index"]))?;
    Ok(edited(input, &edit, dimension))
}

pub(super) fn order(input: &Value) -> Answered {
    let (curve, dimension) = curve(input)?;
    let edit = curve.set_order(number(&input["new_k"]) as usize)?;
    Ok(edited(input, &edit, dimension))
}

fn edited(input: &Value, (new, remap): &(BSpline<DVec3>, Remap), dimension: usize) -> Value {
    let remapped: Vec<f64> = numbers(&input["us"]).into_iter().map(|u| remap.map(u)).collect();
    let values: Vec<Value> = remapped.iter().map(|&u| vector(new.eval(u), dimension)).collect();
    json!({
        "order": new.order(), "knots": new.knots(), "range": range(new),
        "remapped": remapped, "values": values,
    })
}
