//! Values as they are written after SEND.

use std::fmt::Write as _;

use glam::{DAffine3, DVec3};

use super::data::Listed;
use crate::value::Value;

/// The literal of `value`. A real that is not finite and a list of picks have none and give text that does not
/// read back.
pub fn literal(value: &Value) -> String {
    match value {
        Value::Boolean(true) => "TRUE".to_owned(),
        Value::Boolean(false) => "FALSE".to_owned(),
        Value::Integer(number) => format!("FIX({number})"),
        Value::Real(number) => real(*number),
        Value::String(text) => quoted(text),
        Value::Vector2(v) => format!("V2D({})", numbers(&v.to_array())),
        Value::Vector3(v) => format!("V3D({})", numbers(&v.to_array())),
        Value::Vector4(v) => format!("V4D({})", numbers(&v.to_array())),
        Value::Matrix2(m) => format!("M2D({})", rows(&m.transpose().to_cols_array(), 2)),
        Value::Matrix3(m) => format!("M3D({})", rows(&m.transpose().to_cols_array(), 3)),
        Value::Matrix4(m) => format!("M4D({})", rows(&m.transpose().to_cols_array(), 4)),
        Value::Matrix4x3(m) => format!("M4X3({})", rows(&affine_rows(m), 4)),
        Value::Vectors(list) => format!("VL({})", Listed(list, None)),
        Value::Picks(picks) => format!("{} picks", picks.len()),
    }
}

/// The shortest text that reads back as the same bits; whole numbers without point.
pub(super) fn real(number: f64) -> String {
    let text = format!("{number:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_owned(),
        None => text,
    }
}

/// Numbers with commas between them.
pub(super) fn numbers(numbers: &[f64]) -> String {
    numbers
        .iter()
        .map(|&number| real(number))
        .collect::<Vec<_>>()
        .join(",")
}

/// `x,y,z`.
pub(super) fn point(point: DVec3) -> String {
    numbers(&point.to_array())
}

/// Rows of `width` numbers with blanks between the rows.
pub(super) fn rows(values: &[f64], width: usize) -> String {
    values.chunks(width).map(numbers).collect::<Vec<_>>().join(" ")
}

/// Three rows of four, the translation as last column.
pub(super) fn affine_rows(matrix: &DAffine3) -> [f64; 12] {
    let (linear, translation) = (matrix.matrix3.transpose(), matrix.translation);
    let mut rows = [0.0; 12];
    for index in 0..3 {
        rows[index * 4..index * 4 + 3].copy_from_slice(&linear.col(index).to_array());
        rows[index * 4 + 3] = translation[index];
    }
    rows
}

/// Text in single quotes, control characters outside them as `CHAR(n)`.
pub(super) fn quoted(text: &str) -> String {
    let mut written = String::new();
    let mut open = false;
    for character in text.chars() {
        if character.is_control() {
            if std::mem::take(&mut open) {
                written.push('\'');
            }
            if !written.is_empty() {
                written.push(' ');
            }
            write!(written, "CHAR({})", u32::from(character)).expect("writing to a String does not fail");
            continue;
        }
        if !open {
            if !written.is_empty() {
                written.push(' ');
            }
            written.push('\'');
            open = true;
        }
        if character == '\'' {
            written.push('\'');
        }
        written.push(character);
    }
    if open {
        written.push('\'');
    }
    if written.is_empty() {
        "''".to_owned()
    } else {
        written
    }
}
