//! Input devices: tablets, knob boxes, six-axis controllers, shuttles, MIDI and OSC controllers, pads.
//!
//! One shape for all of them. What a device is told apart by stands in [`Match`], how it is woken in
//! [`InitStep`], what its reports mean in [`Report`] (often by way of a shared [`Layout`]), what a hand finds on
//! it in [`Control`] and [`Surface`], what it can show in [`Output`].

mod bare;
mod bytes;
mod check;
mod control;
mod formats;
mod init;
mod layout;
mod line;
mod matching;
mod output;
mod quirk;
mod report;
mod special;
mod surface;

pub use bytes::HexBytes;
pub use control::{Control, ControlClass, ControlKind, ControlUnit, Encoding, MidiAddress};
pub use formats::FORMATS;
pub use init::{InitAction, InitStep, RangeFrom};
pub use layout::{Layout, Reports};
pub use line::{Line, Parity};
pub use matching::{Bus, Identify, Match};
pub use output::{Output, OutputKind, PixelCoding, Place, RingCoding};
pub use quirk::Quirk;
pub use report::{ByteMatch, ByteOrder, Emits, Field, FieldName, Piece, Repeat, Report, Slots, Used};
pub use special::{CalComp, Firmata, HpDials, Lines, Mm, MmFraming, Osc, Sgi, WacomSerial};
pub use surface::{Surface, Tool, ToolProfile};

use crate::Status;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// One input device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputProfile {
    /// The file's name without its ending; what programs ask for.
    #[serde(skip)]
    pub key: String,
    /// What people call it.
    pub name: String,
    /// How far it was tried.
    pub status: Status,
    /// What sort of thing it is.
    pub kind: InputKind,
    /// Wire format: one of [`FORMATS`], and the name of a page in `docs/protocols/`.
    pub format: String,
    /// Where the numbers are from.
    pub source: String,
    /// What is odd about it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quirks: Vec<Quirk>,
    /// Key of the layout that says what its reports mean; otherwise they stand here as `[[report]]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<String>,
    /// That layout, once the profile is among others ([`Profiles::add`](crate::Profiles::add) puts it here).
    #[serde(skip)]
    pub of_layout: Option<Arc<Layout>>,
    /// Bytes that this device sends before those of the layout.
    #[serde(default, skip_serializing_if = "is_default")]
    pub skip_bytes: u16,
    /// A tool not heard of for so long has left, milliseconds; for devices that do not say so themselves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leave_after_ms: Option<u32>,
    /// What tells it from all others; any one of these is enough.
    #[serde(default, rename = "match", skip_serializing_if = "Vec::is_empty")]
    pub matches: Vec<Match>,
    /// The serial line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<Line>,
    /// What is done after opening, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub init: Vec<InitStep>,
    /// The active area of a tablet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<Surface>,
    /// What may be used on a tablet.
    #[serde(default, rename = "tool", skip_serializing_if = "Vec::is_empty")]
    pub tools: Vec<ToolProfile>,
    /// What its reports mean, where no layout says so.
    #[serde(default, rename = "report", skip_serializing_if = "Vec::is_empty")]
    pub own_reports: Vec<Report>,
    /// What a hand finds on it, in the order in which it is numbered.
    #[serde(default, rename = "control", skip_serializing_if = "Vec::is_empty")]
    pub controls: Vec<Control>,
    /// What it can show, in the order in which it is numbered.
    #[serde(default, rename = "output", skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<Output>,
    /// Of formats `wacom-iv` and `wacom-v`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wacom: Option<WacomSerial>,
    /// Of format `mm`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mm: Option<Mm>,
    /// Of formats `calcomp` and `gtco`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calcomp: Option<CalComp>,
    /// Of format `sgi-dial-box`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sgi: Option<Sgi>,
    /// Of format `hp-dial-box`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hp: Option<HpDials>,
    /// Of format `firmata`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub firmata: Option<Firmata>,
    /// Of format `deej`: lines of numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines: Option<Lines>,
    /// Of format `osc`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub osc: Option<Osc>,
}

/// The sorts of input device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum InputKind {
    /// A surface with a pen or a puck.
    Tablet,
    /// Dials, faders and buttons.
    Knobs,
    /// A cap that is pushed and turned in all directions.
    SixAxis,
    /// A jog dial with a spring-loaded ring around it.
    Shuttle,
    /// A controller that speaks MIDI.
    Midi,
    /// A controller that speaks OSC.
    Osc,
    /// Keys, with or without dials.
    Pad,
}

impl InputKind {
    /// The word as the files have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Tablet => "tablet",
            Self::Knobs => "knobs",
            Self::SixAxis => "six-axis",
            Self::Shuttle => "shuttle",
            Self::Midi => "midi",
            Self::Osc => "osc",
            Self::Pad => "pad",
        }
    }
}

impl InputProfile {
    /// Line speed in bits per second; 0 for what is on no serial line.
    pub fn baud(&self) -> u32 {
        self.line.map_or(0, |line| line.baud)
    }

    /// How many controls of a class there are; they are numbered from 0.
    pub fn count(&self, class: ControlClass) -> u16 {
        let of_class = self.controls.iter().filter(|c| c.kind.class() == class);
        of_class.fold(0, |sum, c| sum.saturating_add(c.count))
    }

    /// The controls of a class one by one: its number, and the group it belongs to.
    pub fn numbered(&self, class: ControlClass) -> impl Iterator<Item = (u16, &Control)> {
        let groups = self.controls.iter().filter(move |c| c.kind.class() == class);
        groups
            .flat_map(|c| std::iter::repeat_n(c, c.count.into()))
            .zip(0..)
            .map(|(c, n)| (n, c))
    }

    /// How many outputs of a kind there are; they are numbered from 0.
    pub fn output_count(&self, kind: OutputKind) -> u16 {
        let of_kind = self.outputs.iter().filter(|o| o.kind == kind);
        of_kind.fold(0, |sum, o| sum.saturating_add(o.count))
    }

    /// Characters on each text display; 0 without any.
    pub fn label_characters(&self) -> u16 {
        let mut labels = self.outputs.iter().filter(|o| o.kind == OutputKind::Label);
        labels.find_map(|o| o.characters).unwrap_or(0)
    }

    /// Counts in one turn of a dial; 1 where no dial says.
    pub fn counts_per_turn(&self) -> f64 {
        self.controls
            .iter()
            .find_map(|c| c.counts_per_turn)
            .unwrap_or(1.0)
    }

    /// How many buttons a tool has; 0 for one that is not used here.
    pub fn tool_buttons(&self, tool: Tool) -> u8 {
        self.tools
            .iter()
            .find(|t| t.tool == tool)
            .map_or(0, |t| t.buttons)
    }

    /// The active area; empty on what has none.
    pub fn area(&self) -> Surface {
        self.surface.unwrap_or_default()
    }

    /// What a serial device's answer to the question who it is begins with, if it is asked at all.
    pub fn answer_prefix(&self) -> &str {
        let asked = self.matches.iter().filter_map(|m| m.identify.as_ref());
        asked.map(|i| i.prefix.as_str()).next().unwrap_or("")
    }

    /// The USB and Bluetooth ids, as `vendor:product` in hexadecimal, each once.
    pub fn ids(&self) -> Vec<String> {
        let mut ids: Vec<_> = self.matches.iter().filter_map(Match::id).collect();
        ids.sort();
        ids.dedup();
        ids
    }
}

/// For what a file leaves out.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
