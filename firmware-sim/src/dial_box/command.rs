//! The host's half of the dial box language: bytes to commands, one byte at a time.
//!
//! Source: `docs/protocols/sgi-dial-box.md`. Masks of four bytes go low byte first (first byte of `75` =
//! lamps 0–7, bit 0 = lamp 0); the two bytes of a dial mask go high byte first (`50 00 FF` = all eight).

use super::dials::Mode;

/// Longest argument: `61` with its control and eight characters.
const ARGUMENTS_MAX: usize = 9;

/// A complete command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Command {
    Initialise,
    Dials { mask: u16, mode: Mode },
    EnableButtons(u32),
    ReportButtons(u32),
    Lamps(u32),
    Label { control: u8, text: String },
    Filter(u16),
    Unknown,
}

/// Collects the arguments of the command in hand.
#[derive(Clone, Debug)]
pub(super) struct Parser {
    labels: bool,
    opcode: u8,
    wanted: usize,
    arguments: [u8; ARGUMENTS_MAX],
    have: usize,
}

impl Parser {
    pub(super) fn new(labels: bool) -> Self {
        Self {
            labels,
            opcode: 0,
            wanted: 0,
            arguments: [0; ARGUMENTS_MAX],
            have: 0,
        }
    }

    /// Takes one byte; gives the command it completes.
    pub(super) fn push(&mut self, byte: u8) -> Option<Command> {
        if self.have < self.wanted {
            self.arguments[self.have] = byte;
            self.have += 1;
        } else {
            self.opcode = byte;
            self.have = 0;
            self.wanted = match byte {
                // The argument of `53` is written like a dial mask; its length is our reading.
                0x50 | 0x51 | 0x53 => 2,
                0x71 | 0x73 | 0x75 => 4,
                0x61 if self.labels => ARGUMENTS_MAX,
                _ => 0,
            };
        }
        if self.have < self.wanted {
            return None;
        }
        self.wanted = 0;
        Some(self.complete())
    }

    fn complete(&self) -> Command {
        let [a, b, c, d, ..] = self.arguments;
        let (pair, mask) = (u16::from_be_bytes([a, b]), u32::from_le_bytes([a, b, c, d]));
        match self.opcode {
            0x20 => Command::Initialise,
            0x50 => Command::Dials {
                mask: pair,
                mode: Mode::Absolute,
            },
            0x51 => Command::Dials {
                mask: pair,
                mode: Mode::Delta,
            },
            0x53 => Command::Filter(pair),
            0x71 => Command::EnableButtons(mask),
            0x73 => Command::ReportButtons(mask),
            0x75 => Command::Lamps(mask),
            0x4B => Command::Lamps(u32::MAX),
            0x4C => Command::Lamps(0),
            0x61 if self.labels => Command::Label {
                control: a,
                text: self.arguments[1..].iter().map(|&byte| printable(byte)).collect(),
            },
            _ => Command::Unknown,
        }
    }
}

/// The display's character for `byte`: ASCII as it is, anything else a question mark.
fn printable(byte: u8) -> char {
    if (0x20..0x7F).contains(&byte) {
        char::from(byte)
    } else {
        '?'
    }
}
