//! The double interpolant and its kinetics.

use super::number::{number, numbers};
use super::{Answered, Refusal};
use motion::curve::Piecewise;
use motion::{Curve, Kinetics, KineticsError, KineticsMode, Natural, Ordering, Smooth, Track};
use serde_json::{Value, json};

impl From<KineticsError> for Refusal {
    fn from(error: KineticsError) -> Self {
        use KineticsError as E;
        match error {
            E::Times(times) => times.into(),
            // The files have one word for every coefficient that may not move.
            E::EndCoefficient { .. } | E::NoSuchCoefficient { .. } => Self::new("end_coefficient"),
            E::EditNotFinite { index } => Self::at("non_finite", "index", index),
            E::NoCoefficients { .. } => Self::new("no_coefficients"),
        }
    }
}

fn kinetics(input: &Value, times: &[f64]) -> Result<Kinetics, KineticsError> {
    let mode = match input["kinetic"].as_str() {
        Some("monotone") => KineticsMode::Monotone,
        Some("linear") => KineticsMode::Linear,
        _ => KineticsMode::Natural,
    };
    let plain = Kinetics::new(times, mode)?;
    let keep_forward = input["q_order"].as_bool().unwrap_or(false);
    let edits: Vec<(usize, f64)> = input["q_edit"]
        .as_object()
        .into_iter()
        .flatten()
        .map(|(index, change)| (index.parse().unwrap_or(usize::MAX), number(change)))
        .collect();
    if edits.is_empty() && !keep_forward {
        return Ok(plain);
    }
    plain.edited(
        &edits,
        if keep_forward {
            Ordering::KeepForward
        } else {
            Ordering::Free
        },
    )
}

pub(super) fn double(input: &Value) -> Answered {
    let (times, values) = (numbers(&input["times"]), numbers(&input["values"]));
    let kinetics = kinetics(input, &times)?;
    let single = Natural::new(&times, &values)?;
    let keys: Vec<f64> = (0..values.len()).map(|j| j as f64).collect();
    if input["value_mode"].as_str() == Some("linear") {
        Ok(samples(
            input,
            &Track {
                path: Piecewise::straight(&keys, &values)?,
                kinetics,
            },
            &single,
        ))
    } else {
        Ok(samples(
            input,
            &Track {
                path: Natural::new(&keys, &values)?,
                kinetics,
            },
            &single,
        ))
    }
}

fn samples(input: &Value, track: &Track<impl Smooth<Point = f64>>, single: &Natural<f64>) -> Value {
    let kinetics = &track.kinetics;
    let sample = |&t: &f64| {
        json!({
            "t": t, "kappa": kinetics.u(t), "value": track.value(t),
            "d1": track.velocity(t), "d2": track.acceleration(t), "single": single.eval(t),
        })
    };
    let samples: Vec<Value> = numbers(&input["ts"]).iter().map(sample).collect();
    let reversing: Vec<[f64; 2]> = kinetics.reversals().iter().map(|r| [r.start, r.end]).collect();
    let reach: Vec<Option<f64>> = (0..=kinetics.last_key())
        .map(|j| kinetics.first_reach(j))
        .collect();
    json!({
        "samples": samples, "reversing": reversing, "first_reach": reach,
        "kinetic_bcoef": kinetics.coefficients(), "kinetic_knots": kinetics.knots(),
    })
}
