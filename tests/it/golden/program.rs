//! The binary `golden` from outside: what other programs see of it.

use serde_json::{Value, json};
use std::io::Write;
use std::process::{Command, Output, Stdio};

fn golden(input: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_golden"))
        .arg("-")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("cargo has built it");
    let mut stdin = child.stdin.take().expect("it is piped");
    // A program that refuses early may close its end first.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    child.wait_with_output().expect("it ends")
}

fn answered(input: &Value) -> Value {
    let output = golden(&input.to_string());
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("it answers in JSON")
}

#[test]
fn a_file_is_answered_the_same_with_and_without_what_it_expects() {
    for topic in ["bspline", "interp", "double", "pose", "robot", "mesh"] {
        let Some(whole) = super::cases(topic) else { return };
        let mut bare = whole.clone();
        for case in bare["cases"].as_array_mut().expect("cases") {
            case.as_object_mut().expect("a case").remove("expect");
        }
        let answers = answered(&whole);
        assert_eq!(answers, answered(&bare), "{topic}");
        let names = |file: &Value| -> Vec<Value> {
            let cases = file["cases"].as_array().expect("cases");
            cases.iter().map(|case| case["name"].clone()).collect()
        };
        assert_eq!(names(&answers), names(&whole), "{topic}");
    }
}

#[test]
fn an_unknown_operation_is_said_to_be_unknown() {
    let file = json!({ "cases": [{ "name": "odd", "op": "levitate", "input": {} }] });
    let want = json!({ "cases": [{ "name": "odd", "got": { "unknown": true } }] });
    assert_eq!(answered(&file), want);
}

#[test]
fn bad_files_are_refused_with_their_place_and_exit_1() {
    for (input, said) in [
        ("{\"cases\": [", "-:1:"),
        ("{\n  \"cases\": [\n    nope\n", "-:3:"),
        ("", "-:1:"),
        ("[]", "cases"),
        ("{\"cases\": 5}", "cases"),
        (
            "{\"cases\": [{\"op\": \"eval\"}]}",
            "case 0 (counted from 0): expected a text \"name\"",
        ),
        ("{\"cases\": [{\"name\": \"a\"}]}", "\"op\""),
    ] {
        let output = golden(input);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{input}: {error}");
        assert!(error.contains(said), "{input}: {error}");
        assert!(output.stdout.is_empty(), "{input}");
        assert!(!error.contains("panicked"), "{input}: {error}");
    }
}

#[test]
fn nonsense_in_a_case_is_answered_without_a_panic() {
    let inputs = [
        json!(null),
        json!({}),
        json!([1, 2]),
        json!({ "points": "x", "k": -3, "us": {} }),
        json!({ "mesh": { "shape": "sphere", "d": "nan", "slices": 1e9, "stacks": -1 } }),
        json!({ "mesh": { "shape": "revolve", "profile": [[1], 2, "x"], "curve_k": 3, "segs": 0 } }),
        json!({ "links": [{}], "keys": [{}], "kappas": [1e300] }),
        json!({ "chain": [{ "link": 1, "parent": 9, "joints": [{}] }], "q0": [], "frames": [{}, 3] }),
    ];
    let ops = [
        "eval",
        "move",
        "insert",
        "delete",
        "order",
        "through",
        "double",
        "direction",
        "orientation",
        "zyz",
        "figure",
        "figure_check",
        "tablet",
        "robot",
        "mesh",
    ];
    for op in ops {
        for input in &inputs {
            let file = json!({ "cases": [{ "name": "odd", "op": op, "input": input }] });
            let output = golden(&file.to_string());
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{op} {input}: {error}");
        }
    }
}
