//! The binary `measure` from outside: what scripts and issues rely on. The numbers themselves are for a quiet
//! machine and a release build.

use serde_json::Value;
use std::process::{Command, Output};

fn measure(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_measure"))
        .args(arguments)
        .output();
    output.expect("cargo has built it")
}

#[test]
fn rows_have_what_the_page_says() {
    let output = measure(&["network", "rig-step"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    let text = String::from_utf8(output.stdout).expect("rows are UTF-8");
    let rows: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).expect("a row is JSON"))
        .collect();
    for row in &rows {
        let value = row["value"].as_f64().expect("a value");
        assert!(value.is_finite() && value > 0.0, "{row}");
        for key in ["measure", "row", "subject", "unit"] {
            assert!(
                row[key].as_str().is_some_and(|text| !text.is_empty()),
                "{key}: {row}"
            );
        }
        match (row["limit"].as_f64(), row["ratio"].as_f64()) {
            (Some(limit), Some(ratio)) => assert!(limit > 0.0 && ratio > 0.0, "{row}"),
            (None, None) => assert!(row["limit"].is_null() && row["ratio"].is_null(), "{row}"),
            _ => panic!("a limit goes with a ratio: {row}"),
        }
    }
    let of = |name: &str| -> Vec<&str> {
        let rows = rows.iter().filter(|row| row["measure"] == name);
        rows.filter_map(|row| row["row"].as_str()).collect()
    };
    let peers = rows.iter().filter(|row| row["subject"] == "pd").count();
    assert!(peers == 0 || peers == 3, "{peers} rows of Pure Data");
    let mut network = of("network");
    network.dedup();
    let linear = ["linear-100", "linear-1000", "linear-10000", "linear-100000"];
    assert_eq!(network, [&["dials", "chain", "fan-out"], &linear[..]].concat());
    assert_eq!(of("rig-step").len(), 3);
}

#[test]
fn the_list_says_which_way_is_better() {
    let text = String::from_utf8(measure(&["--list"]).stdout).expect("the list is UTF-8");
    for name in ["rig-step", "interpolant", "servo-cycle", "network"] {
        let mut lines = text.lines().skip_while(|line| *line != name);
        let about = lines.nth(1).unwrap_or_default();
        assert!(about.contains(" is better"), "{name}: {about}");
    }
}

#[test]
fn an_unknown_measure_is_refused_with_those_there_are() {
    let output = measure(&["levitation"]);
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(
        error.contains("levitation") && error.contains("servo-cycle"),
        "{error}"
    );
    assert!(output.stdout.is_empty());
}
