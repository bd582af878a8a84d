//! Scenarios: what one would say at the bench, as a text that is played on a whole rig in virtual time.
//!
//! *Knows* the language (`docs/scenarios.md`), the world it is played in, and how to judge what is seen there.
//! *Must not know* anything of the rig that is not in its snapshots, nor of a device but what one beside the
//! bench could see.
//! *Start reading* at [`Scenario::parse`], then [`run`].

mod calibrating;
mod check;
mod controls;
mod doing;
mod horn;
mod input;
mod junit;
mod parse;
mod run;
mod words;

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::stand::Horn;
use check::Check;
use doing::Doing;
use firmware_sim::servo_bus::PlantKind;

pub use junit::junit;
pub use run::{Failure, Outcome, RunOptions, run, run_on};

/// A scenario that has been read.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// For reports: the file's name without `.scn`.
    pub name: String,
    folder: PathBuf,
    setting: Setting,
    lines: Vec<Line>,
}

/// Something a scenario says that cannot be understood.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {message}")]
pub struct ScenarioError {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// What was expected and what was found.
    pub message: String,
}

/// What stands on the bench.
#[derive(Clone, Debug, Default, PartialEq)]
struct Setting {
    show: Option<PathBuf>,
    puppet: Option<String>,
    knobs: Option<String>,
    tablet: Option<String>,
    /// Further input devices by name and kind.
    devices: Vec<(String, String)>,
    /// Network files loaded after the show's.
    scripts: Vec<PathBuf>,
    start_rad: BTreeMap<String, f64>,
    sag_rad_per_s: Option<f64>,
    /// What shafts are moved by.
    plant: PlantKind,
    /// Where joints meet their ends.
    stops_rad: BTreeMap<String, [f64; 2]>,
    horns: BTreeMap<String, Horn>,
    seed: u64,
}

/// One line that is played.
#[derive(Clone, Debug, PartialEq)]
struct Line {
    /// What is done or expected, as written: what a person at real controls is asked to do.
    text: String,
    number: u32,
    column: u32,
    when: When,
    what: What,
}

/// When something is done or expected.
#[derive(Clone, Copy, Debug, PartialEq)]
enum When {
    /// At this moment.
    At(f64),
    /// At some moment until then.
    By(f64),
    /// At some moment within so many seconds of the last `at`.
    Within(f64),
    /// At every moment of a span.
    Always { from_secs: f64, to_secs: f64 },
    /// At no moment of a span.
    Never { from_secs: f64, to_secs: f64 },
}

#[derive(Clone, Debug, PartialEq)]
enum What {
    Do(Doing),
    Check(Check),
}

#[cfg(test)]
mod tests;
