//! A deej box: potentiometers on a small board that says all of them in a line of text, over and over.
//!
//! The sketch reads every pot, prints the line and waits ten milliseconds; printing waits where the board's buffer is
//! full, so that with a few pots at 9600 baud the line, not the pause, sets the pace. Opening the port restarts most
//! boards; one that does not restart is joined in the middle of a line.
//! Source: `docs/protocols/deej.md` (omriharel/deej at 9c0307b9, `arduino/` and `pkg/deej/serial.go`).

use crate::hands::Touch;
use crate::script::Device;
use crate::serial::{Inside, SerialChassis, Wire};
use crate::travel::Travel;
use crate::uart::Parity;
use device_profiles::{ControlClass, InputProfile, Quirk};

/// Speed of a deej box's line.
pub const BAUD: u32 = 9600;
/// The pause of the sketch's loop.
const PAUSE_NS: u64 = 10_000_000;
/// What the board keeps of a line that the wire has not yet taken (Arduino, `SERIAL_TX_BUFFER_SIZE`).
const BUFFER_BYTES: u64 = 64;
/// Boot loader and start of the sketch. Ours; people say about two seconds.
const BOOT_NS: u64 = 1_600_000_000;
/// Ten bits of converter.
const COUNTS_MAX: f64 = 1023.0;

/// How this box differs from the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Speed of the line.
    pub baud: u32,
    /// What stands between two readings.
    pub separator: String,
    /// What stands before each, `{n}` for the number of the pot; none: they are told by their order.
    pub label: Option<String>,
    /// Readings are written in hexadecimal digits.
    pub hexadecimal: bool,
    /// Potentiometers, numbered from 0.
    pub pots: u8,
    /// Opening the port restarts the board, as most do.
    pub restarts_when_opened: bool,
    /// A reading is off by up to so many counts.
    pub jitter_counts: u16,
    /// The pots are wired the other way round.
    pub inverted: bool,
    /// The board's clock is this many millionths fast.
    pub drift_ppm: i32,
    /// Decides the jitter.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            baud: BAUD,
            separator: "|".to_owned(),
            label: None,
            hexadecimal: false,
            pots: 5,
            restarts_when_opened: true,
            jitter_counts: 1,
            inverted: false,
            drift_ppm: 0,
            seed: 0,
        }
    }
}

impl From<&InputProfile> for Options {
    fn from(profile: &InputProfile) -> Self {
        let told = profile.lines.as_ref();
        Self {
            baud: profile.line.as_ref().map_or(BAUD, |line| line.baud),
            separator: told.map_or_else(|| "|".to_owned(), |lines| lines.separator.clone()),
            label: told.and_then(|lines| lines.label.clone()),
            hexadecimal: told.is_some_and(|lines| lines.hexadecimal),
            pots: profile.count(ControlClass::Axis).min(u16::from(u8::MAX)) as u8,
            restarts_when_opened: profile.quirks.contains(&Quirk::RestartsOnOpen),
            inverted: told.is_some_and(|lines| lines.inverted),
            ..Self::default()
        }
    }
}

/// The box, its line, and the hands on it.
pub type Deej = SerialChassis<Board>;

/// The board.
#[derive(Clone, Debug)]
pub struct Board {
    options: Options,
    next_loop_ns: u64,
    pots: Vec<Travel>,
    chance: fastrand::Rng,
}

impl Deej {
    /// A box that has been on for a while, every pot at its beginning; it is talking already.
    pub fn new(options: Options) -> Self {
        let (baud, drift_ppm) = (options.baud, options.drift_ppm);
        let board = Board {
            next_loop_ns: 0,
            pots: vec![Travel::default(); usize::from(options.pots)],
            chance: fastrand::Rng::with_seed(options.seed),
            options,
        };
        Self::around(board, baud, Parity::None, drift_ppm)
    }
}

impl Inside for Board {
    /// The sketch never looks at what the host says.
    fn hear(&mut self, _wire: &mut Wire, _byte: u8) {}

    fn next_ns(&self, _wire: &Wire) -> Option<u64> {
        Some(self.next_loop_ns)
    }

    /// Once round the sketch's loop.
    fn happen(&mut self, wire: &mut Wire) {
        let at_ns = wire.now_ns();
        wire.begin_script();
        let mut text = String::with_capacity(5 * self.pots.len() + 2);
        for pot in 0..self.pots.len() {
            if pot > 0 {
                text.push_str(&self.options.separator);
            }
            if let Some(label) = &self.options.label {
                text.push_str(&label.replace("{n}", &pot.to_string()));
            }
            let reading = self.reading(pot, at_ns);
            let digits = if self.options.hexadecimal {
                format!("{reading:x}")
            } else {
                reading.to_string()
            };
            text.push_str(&digits);
        }
        text.push_str("\r\n");
        wire.say(text.as_bytes());
        // Printing returns when what is left fits into the buffer.
        let kept_ns = BUFFER_BYTES * wire.byte_ns();
        let printed_ns = wire.free_ns().saturating_sub(kept_ns).max(at_ns);
        self.next_loop_ns = printed_ns + wire.span_ns(PAUSE_NS);
    }

    fn touch(&mut self, wire: &mut Wire, touch: &Touch) -> bool {
        let Touch::Axis { control, to, over_us } = *touch else {
            return false;
        };
        let Some(pot) = self.pots.get_mut(usize::from(control)) else {
            return false;
        };
        pot.go(wire.now_ns(), to, over_us * 1000);
        true
    }

    fn lose_power(&mut self, wire: &mut Wire) {
        self.restart(wire);
    }

    fn port_opened(&mut self, wire: &mut Wire) {
        if self.options.restarts_when_opened {
            self.restart(wire);
        }
    }

    fn controls(&self) -> Device {
        Device::Controls {
            dials: 0,
            buttons: 0,
            axes: self.options.pots,
        }
    }
}

impl Board {
    fn reading(&mut self, pot: usize, at_ns: u64) -> u16 {
        let share = self.pots[pot].at(at_ns);
        let share = if self.options.inverted { 1.0 - share } else { share };
        let jitter = i32::from(self.options.jitter_counts);
        let off = f64::from(self.chance.i32(-jitter..=jitter));
        (share * COUNTS_MAX + off).round().clamp(0.0, COUNTS_MAX) as u16
    }

    fn restart(&mut self, wire: &mut Wire) {
        wire.stop();
        self.next_loop_ns = wire.now_ns() + wire.span_ns(BOOT_NS);
    }
}

#[cfg(test)]
mod tests;
