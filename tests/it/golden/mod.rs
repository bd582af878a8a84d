//! Every golden case that the project answers, with the comparer's tolerances; and the binary that answers files.
//!
//! The files lie beside the checkout, in `shared/golden`; without them each test says that it skips.

mod compare;
mod program;

use dialrig_tests::golden;
use serde_json::Value;
use std::path::PathBuf;

/// Where a topic's file is, if it is there.
pub(crate) fn file(topic: &str) -> Option<PathBuf> {
    let path = crate::source::root()
        .join("../shared/golden")
        .join(topic)
        .with_extension("json");
    if !path.exists() {
        eprintln!("SKIPPED: golden cases of {topic}: no {}", path.display());
        return None;
    }
    Some(path)
}

/// A topic's cases and how near is near, if the file is there.
pub(crate) fn cases(topic: &str) -> Option<Value> {
    let path = file(topic)?;
    let text = std::fs::read_to_string(&path).expect("the golden file can be read");
    Some(serde_json::from_str(&text).expect("golden files are JSON"))
}

/// Compares all cases of a topic; those of an operation in `absent` are left out and said to be.
fn check(topic: &str, absent: &[&str]) {
    let Some(file) = cases(topic) else { return };
    let cases = file["cases"].as_array().expect("a golden file has cases");
    let (mut wrong, mut left_out) = (Vec::new(), 0);
    for case in cases {
        let name = case["name"].as_str().unwrap_or("nameless");
        let op = case["op"].as_str().unwrap_or_default();
        match golden::answer(op, &case["input"]) {
            None if absent.contains(&op) => left_out += 1,
            None => wrong.push(format!("{name}: nobody answers {op}")),
            Some(got) => wrong.extend(
                compare::disagreements(topic, &file["tolerance"], &case["expect"], &got)
                    .into_iter()
                    .map(|gap| format!("{name}: {gap}")),
            ),
        }
    }
    if left_out > 0 {
        eprintln!("SKIPPED: {left_out} golden cases of {topic}: the project does not answer {absent:?}");
    }
    assert!(left_out < cases.len(), "nothing of {topic} was compared");
    let all = cases.len() - left_out;
    let count = wrong.len();
    assert!(
        wrong.is_empty(),
        "{count} disagreements in {all} cases:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn uniform_b_splines() {
    check("bspline", &[]);
}

#[test]
fn interpolation_over_chord_length() {
    check("interp", &[]);
}

#[test]
fn double_interpolants() {
    check("double", &[]);
}

#[test]
fn poses() {
    check("pose", &[]);
}

#[test]
fn robots() {
    check("robot", &[]);
}

#[test]
fn meshes() {
    // Sections and hidden lines are not among the project's solids.
    check("mesh", &["section", "hidden"]);
}
