//! Messages in a few characters, by kind: what fits beside a port. The tooltip shows the literal.

use ps300::{Kind, Value};

/// At most about a dozen characters.
pub fn short(value: &Value) -> String {
    match value {
        Value::Boolean(on) => if *on { "TRUE" } else { "FALSE" }.to_owned(),
        Value::Integer(n) => format!("FIX {n}"),
        Value::Real(x) => number(*x),
        Value::String(text) => quoted(text),
        Value::Vector2(v) => list(&v.to_array()),
        Value::Vector3(v) => list(&v.to_array()),
        Value::Vector4(v) => list(&v.to_array()),
        Value::Matrix2(_) => "2x2".to_owned(),
        Value::Matrix3(m) => matrix3(m),
        Value::Matrix4(_) => "4x4".to_owned(),
        Value::Matrix4x3(_) => "4x3".to_owned(),
        Value::Vectors(list) => format!("{} vectors", list.vectors.len()),
        Value::Picks(picks) => format!("{} picks", picks.len()),
    }
}

/// The whole of it, as it would be written in a command where it can be.
pub fn long(value: &Value) -> String {
    match value {
        Value::Vectors(_) | Value::Picks(_) => short(value),
        _ => ps300::language::literal(value),
    }
}

/// Three or four digits, as many as a hand can follow.
pub fn number(x: f64) -> String {
    let size = x.abs();
    let text = match size {
        _ if x == x.trunc() && size < 1e6 => return format!("{x:.0}"),
        _ if !(1e-3..1e6).contains(&size) => return format!("{x:.1e}"),
        _ if size >= 100.0 => format!("{x:.1}"),
        _ if size >= 1.0 => format!("{x:.2}"),
        _ => format!("{x:.3}"),
    };
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn list(components: &[f64]) -> String {
    let words: Vec<String> = components.iter().map(|&x| number(x)).collect();
    words.join(",")
}

fn quoted(text: &str) -> String {
    const SHOWN: usize = 10;
    if text.chars().count() <= SHOWN {
        return format!("'{text}'");
    }
    let head: String = text.chars().take(SHOWN - 1).collect();
    format!("'{head}…'")
}

/// A rotation by its angle, anything else by its shape.
fn matrix3(m: &glam::DMat3) -> String {
    let product = *m * m.transpose();
    let turns = product.abs_diff_eq(glam::DMat3::IDENTITY, 1e-6) && m.determinant() > 0.0;
    if !turns {
        return "3x3".to_owned();
    }
    let trace = m.x_axis.x + m.y_axis.y + m.z_axis.z;
    let degrees = ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos().to_degrees();
    format!("turn {}°", number((degrees * 10.0).round() / 10.0))
}

/// A number that a sparkline can draw; nothing for kinds without one.
pub fn scalar(value: &Value) -> Option<f64> {
    match value {
        Value::Boolean(on) => Some(f64::from(u8::from(*on))),
        Value::Vector2(v) => Some(v.length()),
        Value::Vector3(v) => Some(v.length()),
        Value::Matrix3(m) => Some(m.x_axis.x + m.y_axis.y + m.z_axis.z),
        other => other.as_number(),
    }
}

/// The kind a port of several kinds is coloured by: the most telling one.
pub fn colour_kind(kinds: ps300::Kinds) -> Option<Kind> {
    let mut kinds_in = kinds.iter();
    let first = kinds_in.next()?;
    let last = kinds_in.last().unwrap_or(first);
    let number = kinds == ps300::Kinds::NUMBER;
    match (number, first == last) {
        (true, _) => Some(Kind::Real),
        (_, true) => Some(first),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DVec3};

    #[test]
    fn tokens_are_short_and_say_their_kind() {
        let rows: [(Value, &str); 9] = [
            (Value::Real(0.25), "0.25"),
            (Value::Real(-180.0), "-180"),
            (Value::Real(1.0e-7), "1.0e-7"),
            (Value::Real(0.003_906_25), "0.004"),
            (Value::Integer(3), "FIX 3"),
            (Value::from("a long label here"), "'a long la…'"),
            (Value::Vector3(DVec3::new(0.0, 0.5, 1.0)), "0,0.5,1"),
            (Value::from(DMat3::from_rotation_y(0.5)), "turn 28.6°"),
            (Value::from(DMat3::from_diagonal(DVec3::splat(2.0))), "3x3"),
        ];
        for (value, want) in rows {
            assert_eq!(short(&value), want);
        }
    }
}
