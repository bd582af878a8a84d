//! From a golden case's operation and input to the project's answer, in the fields the case expects.
//!
//! Knows the golden files' vocabulary (degrees, reject codes, field names) and nothing of how answers are
//! compared: that is `tests/it/golden`. Source of the vocabulary: the golden files' own README.

mod bspline;
mod double;
mod interp;
mod mesh;
mod number;
mod pose;
mod robot;

use serde_json::{Value, json};

/// What the project says to that operation; `None` for an operation it does not know.
pub fn answer(op: &str, input: &Value) -> Option<Value> {
    let answered = match op {
        "eval" => bspline::eval(input),
        "move" => bspline::move_point(input),
        "insert" => bspline::insert(input),
        "delete" => bspline::delete(input),
        "order" => bspline::order(input),
        "through" => interp::through(input),
        "double" => double::double(input),
        "direction" => pose::direction(input),
        "orientation" => pose::orientation(input),
        "zyz" => Ok(pose::zyz(input)),
        "figure" => pose::figure(input),
        "figure_check" => pose::figure_check(input),
        "tablet" => pose::tablet(input),
        "robot" => robot::robot(input),
        "mesh" => mesh::mesh(input),
        _ => return None,
    };
    Some(answered.unwrap_or_else(|refusal| refusal.0))
}

/// Answers a whole golden file: every case's name with what was got, whether or not it says what to expect.
/// A case of an unknown operation gets `{"unknown": true}`.
pub fn answers(file: &Value) -> Result<Value, GoldenError> {
    let cases = file["cases"].as_array().ok_or(GoldenError::NoCases)?;
    let answered: Result<Vec<Value>, GoldenError> = cases.iter().enumerate().map(answered).collect();
    Ok(json!({ "cases": answered? }))
}

fn answered((index, case): (usize, &Value)) -> Result<Value, GoldenError> {
    let text = |field| {
        case[field]
            .as_str()
            .ok_or(GoldenError::Field { case: index, field })
    };
    let (name, op) = (text("name")?, text("op")?);
    let got = answer(op, &case["input"]).unwrap_or_else(|| json!({ "unknown": true }));
    Ok(json!({ "name": name, "got": got }))
}

/// A file is no golden file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GoldenError {
    /// There is nothing to answer.
    #[error("expected an object with a list \"cases\"; is this a golden file?")]
    NoCases,
    /// A case cannot be answered or named.
    #[error("case {case} (counted from 0): expected a text \"{field}\"")]
    Field {
        /// Which case, counted from 0.
        case: usize,
        /// What it lacks.
        field: &'static str,
    },
}

/// A refusal in the files' words.
struct Refusal(Value);

impl Refusal {
    fn new(code: &str) -> Self {
        Self(json!({ "reject": code }))
    }

    fn at(code: &str, field: &str, at: usize) -> Self {
        Self(json!({ "reject": code, field: at }))
    }
}

impl From<motion::SplineError> for Refusal {
    fn from(error: motion::SplineError) -> Self {
        use motion::SplineError as E;
        match error {
            E::Empty => Self::new("empty"),
            E::NotFinite { at } => Self::at("non_finite", "index", at),
            E::OrderTooSmall { .. } => Self::new("order_too_small"),
            E::NotIncreasing { at } => Self::at("times_not_increasing", "index", at),
            E::Lengths { .. } => Self::new("length_mismatch"),
            E::NoSuchPoint { index, .. } => Self::at("bad_index", "index", index),
        }
    }
}

type Answered = Result<Value, Refusal>;
