//! Dial boxes whose reports are three bytes, a number and two of turn: Spectragraphics' and Hewlett-Packard's.
//!
//! Sources: `docs/protocols/spectragraphics-dial-box.md`, `docs/protocols/hp-dial-box.md`. The SGI box has buttons,
//! lamps and answers as well and stands alone ([`sgi_dial_box`](super::sgi_dial_box)).

use super::overdue::Overdue;
use super::{Codec, Counters, Feedback, InputEvent, Outgoing};
use crate::clock::Instant;

/// Initialise, and all eight dials: what the one known reader of a Spectragraphics box sends, as to an SGI box.
const SPECTRAGRAPHICS_SET_UP: [u8; 4] = [0x20, 0x50, 0x00, 0xFF];

/// Whose box it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Maker {
    /// `30+n a b`: moved by a − b.
    Spectragraphics,
    /// `80+n hi lo`: sixteen bits with a sign. Speaks without being asked.
    HewlettPackard {
        /// What the sixteen bits are.
        counts: Counts,
    },
}

/// What a number in a report is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counts {
    /// Where the dial stands; wraps. The first report of a dial only says that.
    Absolute,
    /// How far it has moved.
    Moved,
}

/// What a profile says of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Whose box it is.
    pub maker: Maker,
    /// Number of dials, at most 16.
    pub dials: u8,
}

/// The host's side of the box.
#[derive(Debug)]
pub struct DialReports {
    settings: Settings,
    bytes: [u8; 3],
    have: usize,
    overdue: Overdue,
    counts: [Option<u16>; 16],
    begun: bool,
    started: bool,
    known: bool,
    counters: Counters,
}

impl DialReports {
    /// For a box that has yet to be opened, or a recording of one.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings: Settings {
                dials: settings.dials.min(16),
                ..settings
            },
            bytes: [0; 3],
            have: 0,
            overdue: Overdue::default(),
            counts: [None; 16],
            begun: false,
            started: false,
            known: false,
            counters: Counters::default(),
        }
    }

    /// For a recording that begins when the box already reports.
    pub fn listening(settings: Settings) -> Self {
        let mut codec = Self::new(settings);
        codec.started = true;
        codec.known = true;
        codec
    }

    fn first(&self) -> u8 {
        match self.settings.maker {
            Maker::Spectragraphics => 0x30,
            Maker::HewlettPackard { .. } => 0x80,
        }
    }

    fn push(&mut self, byte: u8, emit: &mut dyn FnMut(InputEvent)) {
        let first = self.first();
        let begins = (first..first + self.settings.dials).contains(&byte);
        if self.have == 0 && !begins {
            self.counters.unknown += 1;
            return;
        }
        if let Some(place) = self.bytes.get_mut(self.have) {
            *place = byte;
            self.have += 1;
        }
        if self.have < self.bytes.len() {
            return;
        }
        self.have = 0;
        self.overdue.restart();
        self.counters.reports += 1;
        let [head, a, b] = self.bytes;
        let control = head - first;
        let delta_counts = match self.settings.maker {
            Maker::Spectragraphics => i32::from(a) - i32::from(b),
            Maker::HewlettPackard { counts } => self.moved(control, u16::from_be_bytes([a, b]), counts),
        };
        if delta_counts != 0 {
            emit(InputEvent::Dial {
                control: control.into(),
                delta_counts,
            });
        }
    }

    fn moved(&mut self, control: u8, value: u16, counts: Counts) -> i32 {
        let before = match (counts, self.counts.get_mut(usize::from(control))) {
            (Counts::Absolute, Some(before)) => before.replace(value).unwrap_or(value),
            _ => 0,
        };
        // The difference wraps as the counts do.
        i32::from(value.wrapping_sub(before) as i16)
    }
}

impl Codec for DialReports {
    fn start(&mut self, _now: Instant, out: &mut Outgoing) {
        self.have = 0;
        self.counts = [None; 16];
        self.started = false;
        self.begun = true;
        if self.settings.maker == Maker::Spectragraphics {
            out.bytes(&SPECTRAGRAPHICS_SET_UP);
        }
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            self.push(byte, emit);
        }
    }

    /// Nothing says that a box is there until a dial is turned, so it counts as there once its line is open.
    fn advance(&mut self, now: Instant, _out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if std::mem::take(&mut self.begun) {
            self.started = true;
            emit(if self.known {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
            self.known = true;
        }
        if self.overdue.given_up(self.have > 0, now) {
            self.have = 0;
            self.counters.rejected += 1;
        }
    }

    /// A box of this kind shows nothing.
    fn encode(&mut self, _feedback: &Feedback, _out: &mut Outgoing) {}

    /// Dials hold nothing.
    fn let_go(&mut self, _emit: &mut dyn FnMut(InputEvent)) {}

    fn started(&self) -> bool {
        self.started
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

#[cfg(test)]
mod tests;
