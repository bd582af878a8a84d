//! What can be expected in a scenario: read in `parse`, judged in `judge` against what the rig shows, and in
//! `servos` against what the simulated servos really do.

mod judge;
mod parse;
mod servos;
mod truth;

use device_profiles::Role;
use rig::calibration::Proposal;
use rig::{DeviceHealth, PuppetState, Snapshot};

use super::calibrating::Calibrated;
use super::controls::Said;
use super::input::{InputCheck, Outlet, Sent};
use crate::stand::{JointTruth, Stand};

/// Words that begin an expectation.
pub(in crate::scenario) const SUBJECTS: &[&str] = &[
    "player",
    "joint",
    "dof",
    "link",
    "view",
    "time",
    "transport",
    "keys",
    "key",
    "label",
    "display",
    "lamp",
    "note",
    "device",
    "output",
    "servos",
    "servo",
    "torque",
    "counter",
    "undo",
    "watchdogs",
    "shaft",
    "register",
    "life",
    "calibration",
    "control",
];

/// A number and how near to it is near enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scenario) struct Near {
    wanted: f64,
    within: f64,
    /// The tolerance on real hardware.
    hil_within: Option<f64>,
}

/// Whether a count is to be large or small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scenario) enum Bound {
    AtLeast(u64),
    AtMost(u64),
}

/// Which value of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scenario) enum Aspect {
    /// What the rig last read.
    Measured,
    /// What the rig last asked for.
    Goal,
    /// Where the simulated shaft is.
    Really,
}

/// What the simulated shaft really does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scenario) enum ShaftPart {
    Position,
    Speed,
    Effort,
    Temperature,
}

/// Which limits of a servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scenario) enum Conduct {
    /// Range, speed and acceleration.
    Limits,
    /// Range alone.
    Range,
    /// Speed alone.
    Speed,
    Still,
    SlowerThan(f64),
    /// No farther than this from where it was marked.
    NearMark(f64),
}

/// One expectation.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::scenario) enum Check {
    Player {
        state: PuppetState,
        because: Option<String>,
    },
    Joint {
        joint: String,
        aspect: Aspect,
        near: Near,
    },
    LinkAt {
        link: String,
        end: bool,
        at: [f64; 3],
        within: f64,
    },
    LinkSelected {
        link: String,
    },
    View {
        part: usize,
        near: Near,
    },
    Time(Near),
    Playing(bool),
    Keys(usize),
    KeyAt {
        key: usize,
        near: Near,
    },
    Label {
        control: u8,
        text: String,
    },
    Display {
        control: u8,
        text: String,
    },
    Lamp {
        lamp: u8,
        on: bool,
    },
    Note(String),
    Device {
        device: String,
        health: DeviceHealth,
    },
    /// An input device: what it shows or counts.
    Input(String, InputCheck),
    /// An output of the network.
    Output(Outlet, Sent),
    Servos {
        joint: Option<String>,
        conduct: Conduct,
    },
    Torque {
        joint: Option<String>,
        on: bool,
    },
    Counter {
        which: usize,
        bound: Bound,
    },
    Undo(String),
    Calibrated(Calibrated),
    Said(Said),
    Control {
        device: String,
        number: u8,
        near: Near,
    },
    Watchdogs {
        bus: String,
        bound: Bound,
    },
    Shaft {
        joint: String,
        part: ShaftPart,
        near: Near,
    },
    Register {
        joint: String,
        role: Role,
        near: Near,
    },
    Life {
        joint: String,
        event: usize,
        bound: Bound,
    },
}

/// What a judgement may look at.
pub(in crate::scenario) struct Evidence<'a> {
    pub(in crate::scenario) seen: &'a Snapshot,
    pub(in crate::scenario) stand: &'a Stand,
    /// Whether servos are real, so that tolerances for hardware count.
    pub(in crate::scenario) hil: bool,
    /// The joints as they really are.
    pub(in crate::scenario) truths: &'a [JointTruth],
    /// The same, one and two steps before; empty after a pause of the host.
    pub(in crate::scenario) past: [&'a [JointTruth]; 2],
    /// The same, when they were marked.
    pub(in crate::scenario) mark: &'a [JointTruth],
    /// What the last calibration came to.
    pub(in crate::scenario) calibrated: &'a [Proposal],
}

const STATES: [(&str, PuppetState); 5] = [
    ("released", PuppetState::Released),
    ("arming", PuppetState::Arming),
    ("holding", PuppetState::Holding),
    ("playing", PuppetState::Playing),
    ("faulted", PuppetState::Faulted),
];
const HEALTHS: [(&str, DeviceHealth); 3] = [
    ("present", DeviceHealth::Present),
    ("starting", DeviceHealth::Starting),
    ("lost", DeviceHealth::Lost),
];
const VIEW_PARTS: [&str; 3] = ["azimuth", "elevation", "scale"];
const SHAFT_PARTS: [(&str, ShaftPart); 4] = [
    ("position", ShaftPart::Position),
    ("speed", ShaftPart::Speed),
    ("effort", ShaftPart::Effort),
    ("temperature", ShaftPart::Temperature),
];
/// What happens in a servo's life.
const EVENTS: [&str; 7] = [
    "reboots",
    "shutdowns",
    "torque-ons",
    "watchdog-trips",
    "eeprom-changes",
    "refused-writes",
    "goal-writes",
];
const COUNTERS: [&str; 3] = ["stale", "interventions", "late"];
