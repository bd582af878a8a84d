//! Messages out of a stream: MIDI's shape with another meaning, and sysex.

use std::fmt::Write as _;

/// Begins a long message.
pub(super) const SYSEX: u8 = 0xF0;
/// Ends it.
pub(super) const SYSEX_END: u8 = 0xF7;
/// Asks for, and tells, the version of the protocol.
pub(super) const VERSION: u8 = 0xF9;
/// Name and version of the firmware, both ways.
pub(super) const FIRMWARE: u8 = 0x79;
pub(super) const CAPABILITIES_QUERY: u8 = 0x6B;
pub(super) const CAPABILITIES: u8 = 0x6C;
pub(super) const ANALOG_MAPPING_QUERY: u8 = 0x69;
pub(super) const ANALOG_MAPPING: u8 = 0x6A;
pub(super) const EXTENDED_ANALOG: u8 = 0x6F;
pub(super) const ENCODERS: u8 = 0x61;
/// The longest sysex kept: capabilities of 128 pins with seven modes each.
const SYSEX_BYTES_MAX: usize = 2048;

/// A message without its sysex bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Message {
    Version {
        major: u8,
    },
    Analog {
        channel: u8,
        value: u32,
    },
    /// Eight pins.
    Digital {
        port: u8,
        levels: u8,
    },
    /// Its bytes are in [`Messages::sysex`] until the next byte comes.
    Sysex,
}

/// What one byte brought about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pushed {
    pub(super) message: Option<Message>,
    pub(super) unknown: bool,
    pub(super) rejected: bool,
}

/// Puts messages together.
#[derive(Clone, Debug, Default)]
pub(super) struct Messages {
    status: Option<u8>,
    data: [u8; 2],
    have: usize,
    sysex: Vec<u8>,
    overlong: bool,
}

impl Messages {
    pub(super) fn reset(&mut self) {
        *self = Self {
            sysex: std::mem::take(&mut self.sysex),
            ..Self::default()
        };
        self.sysex.clear();
    }

    /// Command and payload of the last sysex.
    pub(super) fn sysex(&self) -> &[u8] {
        &self.sysex
    }

    pub(super) fn push(&mut self, byte: u8) -> Pushed {
        if byte & 0x80 != 0 {
            return self.push_status(byte);
        }
        let mut pushed = Pushed::default();
        match self.status {
            None => pushed.unknown = true,
            Some(SYSEX) if self.sysex.len() < SYSEX_BYTES_MAX => self.sysex.push(byte),
            Some(SYSEX) => self.overlong = true,
            Some(status) => {
                if let Some(place) = self.data.get_mut(self.have) {
                    *place = byte;
                    self.have += 1;
                }
                if self.have == self.data.len() {
                    self.status = None;
                    pushed.message = Some(short(status, self.data));
                }
            }
        }
        pushed
    }

    fn push_status(&mut self, byte: u8) -> Pushed {
        let mut pushed = Pushed::default();
        if byte == SYSEX_END {
            match self.status {
                Some(SYSEX) if !self.overlong => pushed.message = Some(Message::Sysex),
                _ => pushed.rejected = true,
            }
            self.status = None;
            self.overlong = false;
            return pushed;
        }
        pushed.rejected = self.status.is_some();
        self.have = 0;
        self.overlong = false;
        self.status = match byte {
            0x90..=0x9F | 0xE0..=0xEF | VERSION => Some(byte),
            SYSEX => {
                self.sysex.clear();
                Some(byte)
            }
            _ => {
                pushed.unknown = true;
                None
            }
        };
        pushed
    }
}

fn short(status: u8, [low, high]: [u8; 2]) -> Message {
    match status {
        VERSION => Message::Version { major: low },
        0x90..=0x9F => Message::Digital {
            port: status & 0x0F,
            levels: low | high << 7,
        },
        _ => Message::Analog {
            channel: status & 0x0F,
            value: u32::from(high) << 7 | u32::from(low),
        },
    }
}

/// Major, minor, and a name in halves of seven bits; written over what `name` was.
pub(super) fn firmware_name(rest: &[u8], mut name: String) -> Option<String> {
    let (version, halves) = rest.split_at_checked(2)?;
    let [major, minor] = version else {
        return None;
    };
    name.clear();
    name.extend(halves.chunks_exact(2).filter_map(|pair| match pair {
        [low, high] => char::from_u32(u32::from(*high) << 7 | u32::from(*low)),
        _ => None,
    }));
    // Writing to a string cannot fail.
    let _ = write!(name, " {major}.{minor}");
    let blank = name.len() - name.trim_start().len();
    name.drain(..blank);
    Some(name)
}

/// A pin and its value, in as many groups of seven bits as it needs.
pub(super) fn extended_analog(rest: &[u8]) -> Option<(u8, u32)> {
    let (&pin, groups) = rest.split_first()?;
    if groups.is_empty() || groups.len() > 4 {
        return None;
    }
    let value = groups
        .iter()
        .rev()
        .fold(0, |value, &group| value << 7 | u32::from(group));
    Some((pin, value))
}

/// An encoder and its position: number and sign in the first byte, then 28 bits from the lowest.
pub(super) fn encoder(group: &[u8]) -> Option<(u8, i32)> {
    let &[head, p0, p1, p2, p3] = group else {
        return None;
    };
    let [p0, p1, p2, p3] = [p0, p1, p2, p3].map(i32::from);
    let size = p3 << 21 | p2 << 14 | p1 << 7 | p0;
    Some((head & 0x3F, if head & 0x40 == 0 { size } else { -size }))
}
