//! The host's half of Firmata: bytes to messages.
//!
//! Source: `docs/protocols/firmata.md` (firmata/protocol at 7908873e, protocol.md and encoder.md). A message of a
//! MIDI-like format, but commands above F0 that MIDI leaves undefined have arguments here.

/// What the firmware keeps of one message (firmata/arduino, `MAX_DATA_BYTES`).
const DATA_MAX: usize = 64;

/// A complete message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Message {
    Analog {
        channel: u8,
        value: u16,
    },
    Digital {
        port: u8,
        pins: u8,
    },
    ReportAnalog {
        channel: u8,
        on: bool,
    },
    ReportDigital {
        port: u8,
        on: bool,
    },
    PinMode {
        pin: u8,
        mode: u8,
    },
    SetPin {
        pin: u8,
        on: bool,
    },
    Version,
    Reset,
    Sysex {
        command: u8,
        data: Vec<u8>,
    },
    /// A sysex longer than the firmware's memory.
    TooLong,
    Unknown,
}

/// The message in hand.
#[derive(Clone, Debug, Default)]
pub(super) struct Parser {
    status: u8,
    data: Vec<u8>,
    wanted: usize,
    overrun: bool,
}

const SYSEX: u8 = 0xF0;
const SYSEX_END: u8 = 0xF7;

impl Parser {
    /// Takes one byte; gives the message it completes.
    pub(super) fn push(&mut self, byte: u8) -> Option<Message> {
        if self.status == SYSEX {
            return self.in_sysex(byte);
        }
        if byte < 0x80 {
            if self.wanted == 0 {
                return Some(Message::Unknown);
            }
            self.data.push(byte);
            if self.data.len() < self.wanted {
                return None;
            }
            self.wanted = 0;
            return Some(self.complete());
        }
        self.begin(byte)
    }

    fn begin(&mut self, byte: u8) -> Option<Message> {
        self.data.clear();
        self.overrun = false;
        // The low half is a channel below F0 and part of the command from there on.
        self.status = byte;
        self.wanted = match if byte < 0xF0 { byte & 0xF0 } else { byte } {
            0xE0 | 0x90 | 0xF4 | 0xF5 => 2,
            0xC0 | 0xD0 => 1,
            _ => 0,
        };
        match byte {
            SYSEX => None,
            0xF9 => Some(Message::Version),
            0xFF => Some(Message::Reset),
            _ if self.wanted > 0 => None,
            _ => Some(Message::Unknown),
        }
    }

    fn in_sysex(&mut self, byte: u8) -> Option<Message> {
        match byte {
            SYSEX_END => {
                self.status = 0;
                if self.overrun {
                    return Some(Message::TooLong);
                }
                let (&command, data) = self.data.split_first()?;
                Some(Message::Sysex {
                    command,
                    data: data.to_vec(),
                })
            }
            0..0x80 if self.data.len() < DATA_MAX => {
                self.data.push(byte);
                None
            }
            0..0x80 => {
                self.overrun = true;
                None
            }
            // A command inside cuts it off.
            _ => {
                self.status = 0;
                self.begin(byte)
            }
        }
    }

    fn complete(&self) -> Message {
        let low = self.data.first().copied().unwrap_or(0);
        let high = self.data.get(1).copied().unwrap_or(0);
        let channel = self.status & 0x0F;
        match if self.status < 0xF0 {
            self.status & 0xF0
        } else {
            self.status
        } {
            0xE0 => Message::Analog {
                channel,
                value: u16::from(low) | u16::from(high) << 7,
            },
            0x90 => Message::Digital {
                port: channel,
                pins: low | high << 7,
            },
            0xC0 => Message::ReportAnalog {
                channel,
                on: low != 0,
            },
            0xD0 => Message::ReportDigital {
                port: channel,
                on: low != 0,
            },
            0xF4 => Message::PinMode { pin: low, mode: high },
            0xF5 => Message::SetPin {
                pin: low,
                on: high != 0,
            },
            _ => Message::Unknown,
        }
    }
}
