//! Reading numbers and small vectors from golden inputs, where "nan" and "inf" are words.

use glam::{DMat3, DVec3};
use serde_json::{Value, json};

/// A number, or one of the words for a value JSON cannot write. Missing reads as 0.
pub(super) fn number(value: &Value) -> f64 {
    match value.as_str() {
        Some("nan") => f64::NAN,
        Some("inf") => f64::INFINITY,
        Some("-inf") => f64::NEG_INFINITY,
        _ => value.as_f64().unwrap_or(0.0),
    }
}

pub(super) fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

pub(super) fn numbers(value: &Value) -> Vec<f64> {
    list(value).iter().map(number).collect()
}

pub(super) fn index(value: &Value) -> usize {
    value.as_u64().unwrap_or(0) as usize
}

/// A point of up to three coordinates.
pub(super) fn point(value: &Value) -> DVec3 {
    let mut coordinates = [0.0; 3];
    for (into, from) in coordinates.iter_mut().zip(list(value)) {
        *into = number(from);
    }
    DVec3::from_array(coordinates)
}

/// Points and how many coordinates they were given with.
pub(super) fn points(value: &Value) -> (Vec<DVec3>, usize) {
    let all = list(value);
    (
        all.iter().map(point).collect(),
        all.first().map_or(3, |first| list(first).len()),
    )
}

/// The first `dimension` coordinates.
pub(super) fn vector(point: DVec3, dimension: usize) -> Value {
    json!(point.to_array()[..dimension.min(3)])
}

/// Rows of a matrix.
pub(super) fn rows(matrix: &DMat3) -> Value {
    json!(matrix.transpose().to_cols_array_2d())
}
