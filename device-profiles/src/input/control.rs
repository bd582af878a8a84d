//! What a hand finds on a device.

use super::is_default;
use serde::{Deserialize, Serialize};

/// A group of equal controls. Controls are numbered from 0 in each [`ControlClass`], in the order of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// What it is.
    pub kind: ControlKind,
    /// What people call it; of a group the name of each is this with its number from 1 behind it.
    pub name: String,
    /// How many; 1 unless said.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub count: u16,
    /// What people call each of the group, where they have names of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub names: Vec<String>,
    /// Smallest and largest value; of a ring or strip its first and last position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<[i32; 2]>,
    /// Counts in one turn of a dial or ring.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counts_per_turn: Option<f64>,
    /// What its value is in, where it is no bare share of its range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<ControlUnit>,
    /// Values this close to the middle of the range are the middle.
    #[serde(default, skip_serializing_if = "is_default")]
    pub dead_zone: u32,
    /// Changes smaller than this share of the range are noise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_share: Option<f64>,
    /// How a dial's steps are written in MIDI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub encoding: Option<Encoding>,
    /// The MIDI messages by which it is heard.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub midi: Option<MidiAddress>,
    /// The MIDI messages that say that a finger is on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touch: Option<MidiAddress>,
    /// The OSC address by which it is heard; `{n}` stands for its number in the group, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub address: Option<String>,
    /// The pins of a board: one of an analog control or button, two of an encoder, group after group.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<u8>,
    /// The board's own resistor holds the pin high, so that pressed is low.
    #[serde(default, skip_serializing_if = "is_default")]
    pub pull_up: bool,
}

/// Sorts of control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ControlKind {
    /// Turns without end; reports differences.
    Dial,
    /// Slides between two ends.
    Fader,
    /// Turns between two ends.
    Knob,
    /// Springs back to its middle, or is pushed around it.
    Axis,
    /// Is down or up.
    Button,
    /// A ring for a finger: a place on it, or no finger.
    Ring,
    /// A strip for a finger: a place on it, or no finger.
    Strip,
}

/// Which event tells of a control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ControlClass {
    /// Differences.
    Dial,
    /// Absolute values.
    Axis,
    /// Down and up.
    Button,
    /// A place or nothing.
    Ring,
}

impl ControlKind {
    /// Which event tells of it: faders, knobs and axes are numbered together, and so are rings and strips.
    pub fn class(self) -> ControlClass {
        match self {
            Self::Dial => ControlClass::Dial,
            Self::Fader | Self::Knob | Self::Axis => ControlClass::Axis,
            Self::Button => ControlClass::Button,
            Self::Ring | Self::Strip => ControlClass::Ring,
        }
    }

    /// The word as the files have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Dial => "dial",
            Self::Fader => "fader",
            Self::Knob => "knob",
            Self::Axis => "axis",
            Self::Button => "button",
            Self::Ring => "ring",
            Self::Strip => "strip",
        }
    }
}

/// What a control's value is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ControlUnit {
    /// Whole turns.
    Turns,
    /// Degrees.
    Degrees,
    /// A share of the range, 0 to 1 (of an axis -1 to 1).
    Share,
    /// Steps that click.
    Steps,
}

/// How steps of an endless dial, or fine values, are written in control changes.
/// Source: tttapa/Control-Surface `RelativeCCSender` at 05889f70; the manuals of Ardour, Arturia, Faderfox, Behringer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Encoding {
    /// 1..63 up, 127..65 down.
    TwosComplement,
    /// 65..127 up, 63..0 down.
    BinaryOffset,
    /// 1..63 up, 65..127 down.
    SignMagnitude,
    /// 65..127 up, 1..63 down.
    ReversedSignMagnitude,
    /// 17..19 up, 15..13 down.
    #[serde(rename = "centre-16")]
    Centre16,
    /// One value for a step up, one for a step down: 65 and 1, or 1 and 127.
    IncDec,
    /// Controller 96 up, controller 97 down.
    DataIncDec,
    /// Absolute: the controller's seven high bits, and the one 32 above it with the low ones.
    #[serde(rename = "absolute-14")]
    Absolute14,
}

/// MIDI messages of a group. Exactly one of `cc`, `ccs`, `note`, `notes` and `bend` is given.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MidiAddress {
    /// 1 to 16; of `bend` that of the group's first, the others on the channels after it.
    pub channel: u8,
    /// Control change of the group's first; the others follow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cc: Option<u8>,
    /// Control changes of each, where they do not follow one another.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ccs: Vec<u8>,
    /// Note of the group's first; the others follow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<u8>,
    /// Notes of each, where they do not follow one another.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<u8>,
    /// Pitch bend, 14 bits.
    #[serde(default, skip_serializing_if = "is_default")]
    pub bend: bool,
}

impl MidiAddress {
    /// The control change of the `n`-th of the group, from 0.
    pub fn cc_of(&self, n: u16) -> Option<u8> {
        numbered(self.cc, &self.ccs, n)
    }

    /// The note of the `n`-th of the group, from 0.
    pub fn note_of(&self, n: u16) -> Option<u8> {
        numbered(self.note, &self.notes, n)
    }

    /// The channel of the `n`-th of the group, from 0; 1 to 16.
    pub fn channel_of(&self, n: u16) -> u8 {
        let steps = if self.bend { n } else { 0 };
        (u16::from(self.channel) + steps).min(16) as u8
    }
}

fn numbered(first: Option<u8>, each: &[u8], n: u16) -> Option<u8> {
    match first {
        Some(first) => u8::try_from(u16::from(first) + n)
            .ok()
            .filter(|&number| number < 128),
        None => each.get(usize::from(n)).copied(),
    }
}

pub(super) fn one() -> u16 {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(super) fn is_one(count: &u16) -> bool {
    *count == 1
}
