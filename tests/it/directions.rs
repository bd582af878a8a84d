//! The directions of `docs/ARCHITECTURE.md`: which crate may know which, and what a module must never name.

use std::collections::{BTreeMap, BTreeSet};

use crate::source::{paths_named, root, rust_files};

/// What each of our crates may depend on, of ours.
const MAY_DEPEND_ON: &[(&str, &[&str])] = &[
    ("device-profiles", &[]),
    ("motion", &[]),
    ("solid", &[]),
    ("ps300", &["solid"]),
    ("device", &["device-profiles"]),
    ("player", &["motion", "device", "device-profiles"]),
    (
        "rig",
        &["motion", "solid", "ps300", "device", "player", "device-profiles"],
    ),
    ("firmware-sim", &["device-profiles"]),
    (
        "bench",
        &[
            "rig",
            "device",
            "firmware-sim",
            "device-profiles",
            "motion",
            "ps300",
        ],
    ),
    ("ui", &["rig", "motion", "solid", "ps300"]),
    ("dialrig", &["rig", "bench", "ui", "motion", "solid", "ps300"]),
];

#[test]
fn crates_depend_only_downwards() {
    let metadata = cargo_metadata::MetadataCommand::new()
        .manifest_path(root().join("Cargo.toml"))
        .no_deps()
        .other_options(["--offline".to_owned()])
        .exec()
        .expect("cargo describes the workspace");
    let allowed: BTreeMap<&str, &[&str]> = MAY_DEPEND_ON.iter().copied().collect();
    let ours: BTreeSet<String> = metadata.packages.iter().map(|p| p.name.to_string()).collect();
    let mut wrong = Vec::new();
    for package in metadata.packages.iter().filter(|p| p.name != "dialrig-tests") {
        let name = package.name.to_string();
        let Some(may) = allowed.get(name.as_str()) else {
            wrong.push(format!("{name} has no line in MAY_DEPEND_ON"));
            continue;
        };
        for dependency in package.dependencies.iter().filter(|d| ours.contains(&d.name)) {
            if !may.contains(&dependency.name.as_str()) {
                wrong.push(format!("{name} -> {} ({:?})", dependency.name, dependency.kind));
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "these point the wrong way:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn heavy_and_impure_libraries_stay_where_they_belong() {
    let metadata = cargo_metadata::MetadataCommand::new()
        .manifest_path(root().join("Cargo.toml"))
        .no_deps()
        .other_options(["--offline".to_owned()])
        .exec()
        .expect("cargo describes the workspace");
    let only_in: &[(&str, &[&str])] = &[
        ("egui", &["ui"]),
        ("eframe", &["ui"]),
        ("wgpu", &["ui"]),
        ("serialport", &["device", "dialrig-tests"]),
        ("hidapi", &["device", "dialrig-tests"]),
        ("midir", &["device"]),
        ("rosc", &["device"]),
        ("rusb", &["device", "dialrig-tests"]),
        ("clap", &["dialrig", "dialrig-tests"]),
        ("dynamixel2", &["dialrig-tests"]),
        ("rustypot", &["dialrig-tests"]),
    ];
    for (library, crates) in only_in {
        for package in &metadata.packages {
            let name = package.name.to_string();
            let has = package.dependencies.iter().any(|d| d.name == *library);
            assert!(
                !has || crates.contains(&name.as_str()),
                "{name} depends on {library}; only {crates:?} may"
            );
        }
    }
}

/// Modules and what they must never name. A path is forbidden when it begins with one of the words.
const NEVER: &[(&str, &[&str], &str)] = &[
    ("host/motion/src", PURE, "motion is pure"),
    ("host/solid/src", PURE, "solid is pure"),
    ("host/ps300/src", PURE, "ps300 is pure and deterministic"),
    (
        "host/device/src/codec",
        &["crate::transport", "std::io", "std::net", "std::fs"],
        "codecs run on a file of bytes",
    ),
    (
        "host/device/src/servo/framing",
        &["crate::transport", "std::io", "std::net", "std::fs"],
        "framing runs on a file of bytes",
    ),
    (
        "host/player/src",
        &["ps300", "rig"],
        "a network can neither starve nor reach the servo loop",
    ),
    (
        "host/rig/src",
        &["egui", "eframe", "wgpu"],
        "the rig has no window",
    ),
    (
        "ui/src/render",
        &["egui", "eframe", "egui_wgpu"],
        "pictures are made without a window",
    ),
    (
        "ui/src",
        &["device", "player"],
        "windows see commands and snapshots",
    ),
    (
        "host/cli/src",
        &["device", "player"],
        "commands see commands and snapshots",
    ),
];

const PURE: &[&str] = &[
    "std::fs",
    "std::thread",
    "std::time",
    "std::net",
    "std::env",
    "std::process",
    "std::io",
    "serde",
    "rand",
    "HashMap",
    "HashSet",
    "std::collections::HashMap",
    "std::collections::HashSet",
];

#[test]
fn modules_never_name_what_they_must_not_know() {
    let mut wrong = Vec::new();
    for (folder, words, because) in NEVER {
        for file in rust_files(folder) {
            for (line, path) in paths_named(&file) {
                if words.iter().any(|word| begins_with(&path, word)) {
                    wrong.push(format!("{}:{line}: {path} ({because})", file.path));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Whether `path` is `word` or lies below it.
fn begins_with(path: &str, word: &str) -> bool {
    path.strip_prefix(word)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

#[test]
fn goal_registers_have_one_writer() {
    // The servo bus is the one place that names the goal registers in code; everything else is refused by it.
    let mut writers = BTreeSet::new();
    for folder in ["host", "ui"] {
        for file in rust_files(folder) {
            // Simulated servos have goal registers too, and their tests and examples name them.
            let beside = ["/tests/", "/benches/", "/examples/"];
            let in_program = !beside.iter().any(|folder| file.path.contains(folder));
            if in_program && file.text.contains("Goal Position") {
                writers.insert(file.path);
            }
        }
    }
    let outside: Vec<_> = writers
        .iter()
        .filter(|p| !p.starts_with("host/device/src/servo/"))
        .collect();
    assert!(
        outside.is_empty(),
        "only device::servo may name the goal registers: {outside:?}"
    );
}
