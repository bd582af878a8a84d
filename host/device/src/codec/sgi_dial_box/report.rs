//! Bytes from the box, one at a time, to reports.

/// What one report says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Report {
    Initialised,
    Absolute { control: u8, count: u16 },
    Delta { control: u8, delta_counts: i16 },
    Button { control: u8, down: bool },
    Unknown,
}

/// Puts dial reports of three bytes together.
#[derive(Debug)]
pub(super) struct Reports {
    dials: u8,
    head: Option<u8>,
    high: Option<u8>,
}

impl Reports {
    pub(super) fn new(dials: u8) -> Self {
        Self {
            dials,
            head: None,
            high: None,
        }
    }

    pub(super) fn reset(&mut self) {
        self.head = None;
        self.high = None;
    }

    pub(super) fn unfinished(&self) -> bool {
        self.head.is_some()
    }

    /// Takes one byte; gives the report it completes.
    pub(super) fn push(&mut self, byte: u8) -> Option<Report> {
        match (self.head, self.high) {
            (None, _) => self.begin(byte),
            (Some(_), None) => {
                self.high = Some(byte);
                None
            }
            (Some(head), Some(high)) => {
                self.reset();
                let count = u16::from_be_bytes([high, byte]);
                let control = head & 0x0F;
                Some(if head & 0xF0 == 0x30 {
                    Report::Absolute { control, count }
                } else {
                    Report::Delta {
                        control,
                        delta_counts: count as i16,
                    }
                })
            }
        }
    }

    fn begin(&mut self, byte: u8) -> Option<Report> {
        match byte {
            0x20 => Some(Report::Initialised),
            0x30..=0x4F if byte & 0x0F < self.dials => {
                self.head = Some(byte);
                None
            }
            0xC0..=0xFF => Some(button(byte)),
            _ => Some(Report::Unknown),
        }
    }
}

/// Bit 5 says released. The groups of eight run downwards from the top: D8 is 0–7, D0 8–15, C8 16–23, C0 24–31.
fn button(byte: u8) -> Report {
    let group = 3 - (byte >> 3 & 3);
    Report::Button {
        control: group * 8 + (byte & 7),
        down: byte & 0x20 == 0,
    }
}
