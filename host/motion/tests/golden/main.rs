//! Every golden case of curves, interpolation, kinetics, poses and robots against this crate.
//!
//! The files lie beside the checkout, in `shared/golden`; without them the test says that it skips.

mod answer;
mod compare;

use serde_json::Value;
use std::path::PathBuf;

fn check(topic: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/golden")
        .join(topic)
        .with_extension("json");
    let Ok(text) = std::fs::read_to_string(&path) else {
        eprintln!("SKIPPED: golden cases of {topic}: no {}", path.display());
        return;
    };
    let file: Value = serde_json::from_str(&text).expect("golden files are JSON");
    let mut wrong = Vec::new();
    let cases = file["cases"].as_array().expect("a golden file has cases");
    for case in cases {
        let name = case["name"].as_str().unwrap_or("nameless");
        let op = case["op"].as_str().unwrap_or_default();
        match answer::answer(op, &case["input"]) {
            None => wrong.push(format!("{name}: nobody answers {op}")),
            Some(got) => wrong.extend(
                compare::disagreements(topic, &file["tolerance"], &case["expect"], &got)
                    .into_iter()
                    .map(|gap| format!("{name}: {gap}")),
            ),
        }
    }
    assert!(
        wrong.is_empty(),
        "{} disagreements in {} cases:\n{}",
        wrong.len(),
        cases.len(),
        wrong.join("\n")
    );
}

#[test]
fn uniform_b_splines() {
    check("bspline");
}

#[test]
fn interpolation_over_chord_length() {
    check("interp");
}

#[test]
fn double_interpolants() {
    check("double");
}

#[test]
fn poses() {
    check("pose");
}

#[test]
fn robots() {
    check("robot");
}
