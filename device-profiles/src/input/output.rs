//! What a device can show or do to the hand.

use super::control::{is_one, one};
use super::{HexBytes, MidiAddress, is_default};
use serde::{Deserialize, Serialize};

/// A group of equal outputs. Outputs are numbered from 0 in each [`OutputKind`], in the order of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// What it is.
    pub kind: OutputKind,
    /// Name of the group of controls it belongs to, one beside each; absent: to the device as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// How many; 1 unless said.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub count: u16,
    /// Characters of a label.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub characters: Option<u16>,
    /// Steps of brightness, of a ring's position or of a motor, darkness included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub levels: Option<u32>,
    /// Steps of red, green and blue, darkness included; 1 where that colour is not there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colours: Option<[u16; 3]>,
    /// Width and height of a picture in pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[u16; 2]>,
    /// How a picture is sent; labels beside the same controls are then drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pixels: Option<PixelCoding>,
    /// The output report that shows it, its id first (0 where the device has none), with zeros at the places
    /// below; filled up with zeros to the device's length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output: Option<HexBytes>,
    /// The feature report that shows it, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feature: Option<HexBytes>,
    /// Length of the report, where zeros follow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u16>,
    /// Where the level goes in the report. Of several outputs with a `stride`, where the first one's goes; the
    /// report then carries all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<Place>,
    /// Where the output's number goes in the report; of a haptic output, the milliseconds between two clicks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub index: Option<Place>,
    /// The MIDI messages that show it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub midi: Option<MidiAddress>,
    /// Values that the message carries for dark, lit and blinking, where they are not 0 and the largest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<u8>,
    /// How a ring's value is written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub style: Option<RingCoding>,
    /// The system exclusive message that shows it: bytes in hexadecimal, `{n}` for the output's number, `{v}` for
    /// its value, `{text}` for the characters of a label.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sysex: Option<String>,
    /// Added to the output's number for `{n}`.
    #[serde(default, skip_serializing_if = "is_default")]
    pub first: u8,
    /// The pins of a board, one of each lamp; with more than two `levels` they can dim.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<u8>,
    /// The OSC address that shows it; `{n}` stands for its number in the group, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub address: Option<String>,
}

/// Sorts of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OutputKind {
    /// A lamp, in colours or levels.
    Lamp,
    /// Lamps around a dial that show a place.
    Ring,
    /// Characters.
    Label,
    /// Pixels.
    Picture,
    /// Moves a fader.
    Motor,
    /// Clicks or buzzes.
    Haptic,
    /// A brightness of the whole device.
    Level,
}

impl OutputKind {
    /// The word as the files have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Lamp => "lamp",
            Self::Ring => "ring",
            Self::Label => "label",
            Self::Picture => "picture",
            Self::Motor => "motor",
            Self::Haptic => "haptic",
            Self::Level => "level",
        }
    }
}

/// How a picture is sent: JPEG in pieces behind heads of their own.
/// Source: abcminiuser/python-elgato-streamdeck `StreamDeckPlus.py` at 4ec7c733.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PixelCoding {
    /// Part of the strip above the dials, one beside the other.
    StreamDeckStrip,
    /// A key.
    StreamDeckKey,
}

/// How the position of a ring, or the level of a meter, is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RingCoding {
    /// Mackie's V-Pots: bits 0-3 position 1 to 11 (0: dark), bits 4-5 the way of lighting, bit 6 the centre lamp.
    VPot,
    /// 0 dark, 1 to 13 a lamp, 14 to 26 the same blinking; the way of lighting is a message of its own.
    #[serde(rename = "thirteen")]
    Thirteen,
    /// Mackie's meters: channel pressure, bits 4-6 the strip, bits 0-3 the level, 0 to 12; they fall by themselves.
    Meter,
    /// The value itself, 0 to 127.
    Plain,
}

/// Bits in a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// The byte; the report's id is byte 0.
    pub byte: u16,
    /// Its lowest bit; 0 unless said.
    #[serde(default, skip_serializing_if = "is_default")]
    pub bit: u8,
    /// How many bits, going on in the bytes that follow; 8 unless said.
    #[serde(default = "eight", skip_serializing_if = "is_eight")]
    pub width: u8,
    /// From one output of the group to the next, bits.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stride: u16,
    /// Added to what is put there.
    #[serde(default, skip_serializing_if = "is_default")]
    pub add: u8,
}

fn eight() -> u8 {
    8
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_eight(width: &u8) -> bool {
    *width == eight()
}
