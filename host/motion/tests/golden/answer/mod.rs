//! From a golden case's operation and input to this crate's answer, in the fields the case expects.
//!
//! Knows the golden files' vocabulary (degrees, reject codes, field names) and nothing of how answers are
//! compared. Needs `motion`, `glam` and `serde_json` only, so it can be used from another crate by path.

mod bspline;
mod double;
mod interp;
mod number;
mod pose;
mod robot;

use serde_json::{Value, json};

/// What this crate says to that operation; `None` for an operation it does not know.
pub(crate) fn answer(op: &str, input: &Value) -> Option<Value> {
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
        _ => return None,
    };
    Some(answered.unwrap_or_else(|refusal| refusal.0))
}

/// A refusal in the files' words.
pub(crate) struct Refusal(Value);

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
