//! Input devices as windows see them.

use std::sync::Arc;

use crate::controls_calibration::{ControlsCalibration, Sheet};

/// An input device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeviceView {
    /// The name it goes by in the rig, also where to touch it when simulated.
    pub name: String,
    /// The name of its instance in the network, `NAME` of `NAME<n>`; empty where it has none.
    pub instance: String,
    /// Profile it was matched to.
    pub profile: String,
    /// What people call such a device.
    pub title: String,
    /// Address it was opened at.
    pub address: String,
    /// Which of several equal devices it is, from 1.
    pub slot: u16,
    /// How it is.
    pub health: DeviceHealth,
    /// Events decoded so far.
    pub events: u64,
    /// Reports per second; 0 while it is silent.
    pub rate_hz: f64,
    /// Mean distance of a gap between reports from the mean gap, milliseconds.
    pub jitter_ms: f64,
    /// Reports that were lost because nobody could take them in time.
    pub dropped: u64,
    /// Malformed bytes or reports skipped so far.
    pub rejected: u64,
    /// The page its controls are on, from 1; 0 where it has no controls.
    pub page: u8,
    /// Whether the page follows the selected link or joint.
    pub page_follows: bool,
    /// What was calibrated on it.
    pub calibration: Arc<ControlsCalibration>,
    /// Its tablet, once it has said how large it is.
    pub sheet: Option<Sheet>,
    /// Its controls, in the order of the profile.
    pub controls: Vec<ControlView>,
    /// What it can show, in the order of the profile.
    pub outputs: Vec<OutputView>,
    /// The capture that is being written of it, or the last one.
    pub capture: Option<CaptureView>,
}

/// What a device and the rig say to each other, as it is written into a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaptureView {
    /// The file: while it is written with `.part` behind its name, whole without.
    pub file: String,
    /// Whether it is being written.
    pub running: bool,
    /// For how long it was, seconds.
    pub secs: f64,
    /// Bytes in the file.
    pub bytes: u64,
    /// Events in it.
    pub events: u64,
    /// Why it ended by itself, if it did; the file has what came before.
    pub trouble: Option<String>,
}

/// How an input device is.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum DeviceHealth {
    /// Opened, has not answered yet.
    #[default]
    Starting,
    /// Answers.
    Present,
    /// Gone; looked for again.
    Lost,
    /// It is there and may not be opened.
    Forbidden {
        /// The rule or group to add, and how.
        rule: String,
    },
    /// Another program or a driver of the system holds it.
    Held {
        /// Who.
        driver: String,
    },
}

/// One control of a device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControlView {
    /// `n` of its output `NAME<n>`.
    pub number: u8,
    /// What the profile calls it.
    pub name: String,
    /// The profile's word: `dial`, `fader`, `knob`, `axis`, `button`, `ring`, `strip`; `pen` for what a tablet's
    /// surface tells.
    pub kind: &'static str,
    /// Where it is: turns since the rig began, a share of its range, 1 for down.
    pub value: f64,
    /// What the value is in.
    pub unit: &'static str,
    /// The least and the greatest value, where it has ends.
    pub range: Option<[f64; 2]>,
    /// Whether its next movement goes to what it drives. Always true of what has no place of its own.
    pub picked_up: bool,
    /// Where what it drives stands, in the control's own range, as long as it is not picked up.
    pub awaits: Option<f64>,
    /// Whether it moved within the last half second.
    pub live: bool,
    /// What it drives on the present page, as the network names it: `TIME<2>`.
    pub bound: Vec<String>,
    /// What its label shows, or would.
    pub label: String,
    /// The word of its mode.
    pub mode: &'static str,
    /// What its counts come to, in words; empty where that is not to be calibrated.
    pub comes_to: String,
    /// Whether a hand has measured it; it is as the profile has it otherwise.
    pub calibrated: bool,
}

/// One output of a device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutputView {
    /// What [`crate::Command::TestOutput`] takes, from 0.
    pub number: u16,
    /// `lamp`, `ring`, `label`, `picture`, `motor`, `haptic`, `level`.
    pub kind: &'static str,
    /// Which of its kind, from 1.
    pub of_kind: u16,
    /// The control it stands beside, by its number.
    pub control: Option<u8>,
    /// `n` of its inlet: `NAME_LAMP<n>` and so on.
    pub inlet: u8,
    /// What it was last told to show, in words.
    pub shows: String,
}

/// What is being learnt.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LearningView {
    /// Device and number of the control that was touched.
    pub control: Option<(String, u8)>,
    /// Name and inlet of the parameter that was touched.
    pub parameter: Option<(String, u8)>,
}
