//! Whether an answer agrees with a golden case, by the rules of the golden files' README and of the comparer
//! that lies beside them.

use serde_json::{Map, Value};

/// Compared modulo a full turn, in degrees.
const TURNING: [&str; 2] = ["hue", "azimuth"];
/// Degrees by which those may differ.
const TURNING_SLACK_DEG: f64 = 1e-6;
/// By which the matrices of z-y-z triples may differ.
const ZYZ_SLACK: f64 = 1e-8;

/// How near is near: `|x - y| <= abs + rel * max(|x|, |y|)`.
#[derive(Clone, Copy)]
struct Tolerance {
    abs: f64,
    rel: f64,
}

impl Tolerance {
    fn allows(self, x: f64, y: f64) -> bool {
        (x - y).abs() <= self.abs + self.rel * x.abs().max(y.abs())
    }
}

fn field(of: &Value, name: &str) -> f64 {
    of[name].as_f64().unwrap_or(0.0)
}

/// Every disagreement of one case, as a path and two values.
pub(super) fn disagreements(topic: &str, tolerance: &Value, expect: &Value, got: &Value) -> Vec<String> {
    let mut out = Vec::new();
    if expect.get("reject").is_some() {
        for name in ["reject", "index", "link"] {
            if expect.get(name).is_some() && got.get(name) != expect.get(name) {
                out.push(format!(
                    "{name}: {:?} wanted {:?}",
                    got.get(name),
                    expect.get(name)
                ));
            }
        }
        return out;
    }
    if let Some(code) = got.get("reject") {
        return vec![format!("refused: {code}")];
    }
    match topic {
        "interp" => interp(expect, got, &mut out),
        "robot" => robot(tolerance, expect, got, &mut out),
        _ => {
            let slack = Tolerance {
                abs: field(tolerance, "abs"),
                rel: field(tolerance, "rel"),
            };
            value("", "", expect, got, slack, &mut out);
        }
    }
    out
}

fn interp(expect: &Value, got: &Value, out: &mut Vec<String>) {
    let tol = &expect["tol"];
    let absolute = |abs| Tolerance { abs, rel: 0.0 };
    value("kept", "", &expect["kept"], &got["kept"], absolute(0.0), out);
    let both = absolute(field(tol, "value") + field(tol, "u"));
    value("params", "", &expect["params"], &got["params"], both, out);
    value("bcoef", "", &expect["bcoef"], &got["bcoef"], both, out);
    let samples = expect["samples"].as_array().into_iter().flatten();
    for (i, sample) in samples.enumerate() {
        for name in ["u", "value", "d1", "d2"] {
            let slack = tol
                .get(name)
                .map_or(Tolerance { abs: 1e-9, rel: 1e-9 }, |_| absolute(field(tol, name)));
            value(
                &format!("samples[{i}].{name}"),
                name,
                &sample[name],
                &got["samples"][i][name],
                slack,
                out,
            );
        }
    }
}

fn robot(tolerance: &Value, expect: &Value, got: &Value, out: &mut Vec<String>) {
    let (cost_slack, angle_slack) = (field(tolerance, "cost_abs"), field(tolerance, "angle_abs_rad"));
    let frames = expect["frames"].as_array().into_iter().flatten();
    for (i, frame) in frames.enumerate() {
        for (link, want) in frame.as_object().into_iter().flatten() {
            let have = &got["frames"][i][link];
            let (cost, best, most) = (field(have, "cost"), field(want, "cost_best"), field(want, "cost"));
            if !(best - cost_slack..=most + cost_slack).contains(&cost) {
                out.push(format!(
                    "frame {i} link {link}: cost {cost} wanted {best} to {most}"
                ));
            }
            if want["unique"] == true && most - best < 1e-9 {
                let slack = Tolerance {
                    abs: angle_slack,
                    rel: 0.0,
                };
                value(
                    &format!("frame {i} link {link}"),
                    "",
                    &want["q_rad"],
                    &have["q_rad"],
                    slack,
                    out,
                );
            }
        }
    }
}

fn value(path: &str, key: &str, want: &Value, have: &Value, slack: Tolerance, out: &mut Vec<String>) {
    let mut wrong = || out.push(format!("{path}: {have} wanted {want}"));
    match (want, have) {
        (Value::Object(want), Value::Object(have)) => object(path, want, have, slack, out),
        (Value::Array(want), Value::Array(have)) if want.len() == have.len() => {
            if key == "zyz" {
                if zyz_gap(want, have) > ZYZ_SLACK {
                    wrong();
                }
                return;
            }
            for (i, (w, h)) in want.iter().zip(have).enumerate() {
                value(&format!("{path}[{i}]"), key, w, h, slack, out);
            }
        }
        (Value::Number(_), Value::Number(_)) => {
            let (w, h) = (
                want.as_f64().unwrap_or(f64::NAN),
                have.as_f64().unwrap_or(f64::NAN),
            );
            let agrees = if TURNING.contains(&key) {
                let gap = (w - h).rem_euclid(360.0);
                gap.min(360.0 - gap) <= TURNING_SLACK_DEG
            } else {
                slack.allows(w, h)
            };
            if !agrees {
                wrong();
            }
        }
        _ if want == have => {}
        _ => wrong(),
    }
}

fn object(
    path: &str,
    want: &Map<String, Value>,
    have: &Map<String, Value>,
    slack: Tolerance,
    out: &mut Vec<String>,
) {
    for (name, want) in want.iter().filter(|(name, _)| *name != "tol") {
        match have.get(name) {
            Some(have) => value(&format!("{path}.{name}"), name, want, have, slack, out),
            None => out.push(format!("{path}.{name}: missing")),
        }
    }
}

/// The largest difference between the matrices of two z-y-z triples in degrees.
fn zyz_gap(want: &[Value], have: &[Value]) -> f64 {
    let matrix = |angles: &[Value]| {
        let angle = |i: usize| {
            angles
                .get(i)
                .and_then(Value::as_f64)
                .unwrap_or(f64::NAN)
                .to_radians()
        };
        glam::DMat3::from_rotation_z(angle(0))
            * glam::DMat3::from_rotation_y(angle(1))
            * glam::DMat3::from_rotation_z(angle(2))
    };
    let gap = (matrix(want) - matrix(have)).to_cols_array();
    gap.iter().fold(0.0, |most, x| {
        if x.abs() > most || x.is_nan() {
            x.abs()
        } else {
            most
        }
    })
}
