//! Messages as JSON: vectors are arrays, matrices arrays of rows.

use ps300::Value;
use serde::Serialize;
use serde_json::json;

/// One watched message.
#[derive(Serialize)]
pub(super) struct MessageRecord {
    t: f64,
    from: String,
    kind: &'static str,
    value: serde_json::Value,
}

impl MessageRecord {
    /// A message that left `name<output>`.
    pub(super) fn new(secs: f64, name: &str, output: u8, value: &Value) -> Self {
        Self {
            t: nanos(secs),
            from: format!("{name}<{output}>"),
            kind: value.kind().name(),
            value: json_of(value),
        }
    }
}

/// To nine decimals, so that a sixtieth of a second is not seventeen digits long.
pub(super) fn nanos(secs: f64) -> f64 {
    (secs * 1e9).round() / 1e9
}

fn json_of(value: &Value) -> serde_json::Value {
    match value {
        Value::Boolean(b) => json!(b),
        Value::Integer(n) => json!(n),
        Value::Real(x) => json!(x),
        Value::String(text) => json!(&**text),
        Value::Vector2(v) => json!(v.to_array()),
        Value::Vector3(v) => json!(v.to_array()),
        Value::Vector4(v) => json!(v.to_array()),
        Value::Matrix2(m) => json!([0, 1].map(|i| m.row(i).to_array())),
        Value::Matrix3(m) => json!([0, 1, 2].map(|i| m.row(i).to_array())),
        Value::Matrix4(m) => json!([0, 1, 2, 3].map(|i| m.row(i).to_array())),
        Value::Matrix4x3(m) => {
            let row = |i: usize| m.matrix3.row(i).extend(m.translation[i]).to_array();
            json!([0, 1, 2].map(row))
        }
        Value::Vectors(list) => {
            let vector = |v: &ps300::language::Vector| json!({"at": v.at.to_array(), "draw": v.draw});
            list.vectors.iter().map(vector).collect()
        }
        Value::Picks(picks) => picks.iter().map(json_of_pick).collect(),
    }
}

fn json_of_pick(pick: &ps300::pick::Pick) -> serde_json::Value {
    let identifiers: Vec<_> = pick
        .identifiers
        .iter()
        .map(ps300::language::Name::as_str)
        .collect();
    json!({"index": pick.index, "identifiers": identifiers, "node": pick.node.as_str(), "at": pick.spot.map(|spot| spot.at.to_array())})
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat2, DMat3, DVec2, DVec3};

    #[test]
    fn matrices_are_rows() {
        let turn = DMat2::from_cols(DVec2::new(1.0, 3.0), DVec2::new(2.0, 4.0));
        let affine = DAffine3::from_mat3_translation(DMat3::IDENTITY, DVec3::new(7.0, 8.0, 9.0));
        for (value, expected) in [
            (Value::from(turn), "[[1.0,2.0],[3.0,4.0]]"),
            (
                Value::from(affine),
                "[[1.0,0.0,0.0,7.0],[0.0,1.0,0.0,8.0],[0.0,0.0,1.0,9.0]]",
            ),
            (Value::from("a\"b"), "\"a\\\"b\""),
            (Value::from(3), "3"),
            (Value::from(3.0), "3.0"),
            (Value::from(true), "true"),
        ] {
            assert_eq!(json_of(&value).to_string(), expected);
        }
    }

    #[test]
    fn times_are_short() {
        assert_eq!(nanos(1.0 / 60.0), 0.016_666_667);
        assert_eq!(nanos(0.1 + 0.2), 0.3);
    }
}
