//! MIDI's bytes: messages out of a stream, and into one. Source: MIDI 1.0 detailed specification 4.2.

/// The longest sysex that is kept; Korg's scene of 388 bytes and its frame fit well.
const SYSEX_BYTES_MAX: usize = 1024;

/// What a box hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cable {
    /// USB: as good as at once.
    Usb,
    /// Five pins, 31250 bits a second: 320 µs for each byte.
    Din,
}

impl Cable {
    /// Bits a second. USB's own frames of a millisecond are the host controller's business.
    pub fn baud(self) -> u32 {
        match self {
            Self::Usb => 10_000_000,
            Self::Din => 31_250,
        }
    }
}

/// A whole message from the host. Channels count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heard<'a> {
    /// Note on; a note off is one of velocity 0.
    Note {
        /// 1 to 16.
        channel: u8,
        /// 0 to 127.
        key: u8,
        /// 0 to 127.
        velocity: u8,
    },
    /// Control change.
    Control {
        /// 1 to 16.
        channel: u8,
        /// 0 to 127.
        number: u8,
        /// 0 to 127.
        value: u8,
    },
    /// Program change.
    Program {
        /// 1 to 16.
        channel: u8,
        /// 0 to 127.
        program: u8,
    },
    /// What stands between F0 and F7.
    Sysex(&'a [u8]),
}

/// Puts messages together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parser {
    status: Option<u8>,
    first: Option<u8>,
    sysex: Option<Vec<u8>>,
    ended: Vec<u8>,
}

impl Parser {
    pub(crate) fn push(&mut self, byte: u8) -> Option<Heard<'_>> {
        match byte {
            // Real time may come anywhere and changes nothing.
            0xF8.. => None,
            0xF7 => {
                self.status = None;
                self.ended = self.sysex.take()?;
                (self.ended.len() <= SYSEX_BYTES_MAX).then_some(Heard::Sysex(&self.ended))
            }
            0xF0 => {
                self.status = None;
                self.sysex = Some(Vec::new());
                None
            }
            0x80.. => {
                self.sysex = None;
                self.first = None;
                // System common messages end the running status.
                self.status = (byte < 0xF0).then_some(byte);
                None
            }
            _ => self.push_data(byte),
        }
    }

    fn push_data(&mut self, byte: u8) -> Option<Heard<'_>> {
        if let Some(sysex) = &mut self.sysex {
            if sysex.len() <= SYSEX_BYTES_MAX {
                sysex.push(byte);
            }
            return None;
        }
        let status = self.status?;
        let channel = (status & 0x0F) + 1;
        if matches!(status & 0xF0, 0xC0 | 0xD0) {
            let program = byte;
            return (status & 0xF0 == 0xC0).then_some(Heard::Program { channel, program });
        }
        let Some(number) = self.first.take() else {
            self.first = Some(byte);
            return None;
        };
        match status & 0xF0 {
            0x80 => Some(Heard::Note {
                channel,
                key: number,
                velocity: 0,
            }),
            0x90 => Some(Heard::Note {
                channel,
                key: number,
                velocity: byte,
            }),
            0xB0 => Some(Heard::Control {
                channel,
                number,
                value: byte,
            }),
            _ => None,
        }
    }
}

/// Leaves out status bytes that repeat, if the box does so.
#[derive(Clone, Debug)]
pub(crate) struct Speaker {
    running: bool,
    last: Option<u8>,
}

impl Speaker {
    pub(crate) fn new(running: bool) -> Self {
        Self { running, last: None }
    }

    /// The bytes of a whole message as they go onto the wire.
    pub(crate) fn speak<'a>(&mut self, message: &'a [u8]) -> &'a [u8] {
        let Some((&status, rest)) = message.split_first() else {
            return message;
        };
        let repeats = self.last == Some(status);
        self.last = (self.running && status < 0xF0).then_some(status);
        if repeats { rest } else { message }
    }
}
