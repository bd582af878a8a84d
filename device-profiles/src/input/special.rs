//! What only one wire format needs to know.

use super::is_default;
use serde::{Deserialize, Serialize};

/// Wacom's serial protocols IV and V.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WacomSerial {
    /// Model text as a simulated tablet answers it, without the version; begins with the match's prefix.
    pub model: String,
    /// ROM version as a simulated tablet answers it.
    pub version: String,
    /// Whether it answers the question for its size.
    #[serde(default, skip_serializing_if = "is_default")]
    pub answers_size: bool,
    /// Which of the four button bits a pen's eraser end sets: 3, or 2, which it shares with button 2.
    /// Protocol IV only.
    #[serde(default, skip_serializing_if = "is_default")]
    pub eraser_bit: u8,
}

/// Summagraphics MM and its kin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mm {
    /// How reports come.
    pub framing: MmFraming,
    /// A puck's button code has a bit for each, instead of the number of the one pressed.
    #[serde(default, skip_serializing_if = "is_default")]
    pub buttons_are_bits: bool,
    /// Counts of movement from one report to the next, 0 to 95; 0 reports all the time.
    #[serde(default, skip_serializing_if = "is_default")]
    pub increment: u8,
    /// The tablet counts y from the lower edge.
    #[serde(default, skip_serializing_if = "is_default")]
    pub y_up: bool,
}

/// How reports of the MM family come.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MmFraming {
    /// Five bytes: places.
    Absolute,
    /// Three bytes: moves.
    Relative,
    /// Seven bytes: places and a third axis (AceCad Flair).
    Flair,
    /// Lines of text.
    Ascii,
}

/// CalComp's high-resolution binary packets; formats `calcomp` and `gtco`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalComp {
    /// The bit of the fourth byte that is 1 when the tool is out of proximity: readers disagree (6 or 5). Absent:
    /// no bit tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub proximity_bit: Option<u8>,
    /// The five bits of the buttons carry a pen's pressure.
    #[serde(default, skip_serializing_if = "is_default")]
    pub pressure_for_buttons: bool,
    /// The tablet counts y from the lower edge.
    #[serde(default, skip_serializing_if = "is_default")]
    pub y_up: bool,
}

/// Hewlett-Packard's dial boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HpDials {
    /// Whether a report says where the dial stands; otherwise how far it has moved.
    pub absolute: bool,
}

/// Boards that run Firmata.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Firmata {
    /// Milliseconds from one report to the next; the protocol's own is 19.
    pub interval_ms: u16,
}

/// The SGI dial and button box and its kin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sgi {
    /// Whether initialising sets the counts to 0, so that the first report is itself a turn.
    /// Otherwise the first report only says where the dial stands.
    pub counts_start_at_zero: bool,
}

/// Lines of text with numbers in them, one for each control.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lines {
    /// What stands between two numbers.
    pub separator: String,
    /// What stands before each number: `A{n}:` for `A0:512`. Numbers may then come in any order, and not all of
    /// them in each line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Whether the numbers are hexadecimal.
    #[serde(default, skip_serializing_if = "is_default")]
    pub hexadecimal: bool,
    /// Whether a number grows when the control is turned down.
    #[serde(default, skip_serializing_if = "is_default")]
    pub inverted: bool,
}

/// OSC over UDP.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Osc {
    /// Port on which the host listens.
    pub listen_port: u16,
    /// Port of the device to which feedback goes.
    pub send_port: u16,
}
