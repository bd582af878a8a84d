//! Potentiometers on a microcontroller that prints their values: deej's bars, and comma lists with names.
//!
//! Source: `docs/protocols/deej.md`.

use super::lines::{Line, Lines, number};
use super::{Codec, Counters, Feedback, InputEvent, Outgoing};
use crate::clock::Instant;

/// The longest line: sixteen fields of some ten bytes.
const LINE_BYTES_MAX: usize = 192;
/// The most potentiometers.
const CONTROLS_MAX: u16 = 32;

/// What a profile says of a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Number of potentiometers, at most 32.
    pub controls: u16,
    /// What stands between the fields of a line.
    pub separator: u8,
    /// How a field names its control; without, all fields are there in order.
    pub key: Option<Key>,
    /// Values are hexadecimal.
    pub hexadecimal: bool,
    /// The largest value; what is above it was cut or garbled.
    pub max: i32,
    /// Values differ from the one last told by at least this share of the range, 0 to 1, or reach an end.
    pub noise: f64,
    /// The wiring is the other way round.
    pub invert: bool,
}

/// `A0:512`: text, the control's number from 0, text, the value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    /// In front of the number; may be empty.
    pub before: String,
    /// Between number and value; not empty.
    pub after: String,
}

/// The host's side of the box.
#[derive(Debug)]
pub struct Deej {
    settings: Settings,
    lines: Lines<LINE_BYTES_MAX>,
    /// A line may have been joined in its middle: it is thrown away.
    joined: bool,
    started: bool,
    known: bool,
    told: Vec<Option<i32>>,
    counters: Counters,
}

impl Deej {
    /// For a box that has just been opened, or a recording of one.
    pub fn new(settings: Settings) -> Self {
        let controls = settings.controls.min(CONTROLS_MAX);
        Self {
            settings,
            lines: Lines::new(),
            joined: false,
            started: false,
            known: false,
            told: vec![None; controls.into()],
            counters: Counters::default(),
        }
    }

    fn push(&mut self, byte: u8, emit: &mut dyn FnMut(InputEvent)) {
        if !self.joined {
            // The first line may lack its head and look whole all the same; its end is a sure beginning.
            self.joined = matches!(byte, b'\r' | b'\n');
            return;
        }
        let mut values = [None; CONTROLS_MAX as usize];
        let well = match self.lines.push(byte) {
            None => return,
            Some(Line::Overlong) => false,
            Some(Line::Whole(line)) => self.settings.read(line, &mut values),
        };
        if !well {
            self.counters.rejected += 1;
            return;
        }
        self.counters.reports += 1;
        if !self.started {
            self.started = true;
            emit(if self.known {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
            self.known = true;
        }
        for ((control, told), value) in (0..).zip(&mut self.told).zip(values) {
            if let Some(value) = value.filter(|&value| self.settings.differs(*told, value)) {
                *told = Some(value);
                emit(InputEvent::Axis { control, value });
            }
        }
    }
}

impl Settings {
    /// Reads a line into `values`. False: something in it is not as it must be, and nothing of it counts.
    fn read(&self, line: &[u8], values: &mut [Option<i32>]) -> bool {
        let mut fields = 0;
        for field in line.split(|&byte| byte == self.separator) {
            let at = match &self.key {
                None => Some((fields, field)),
                Some(key) => key.split(field),
            };
            let Some((control, text)) = at else {
                return false;
            };
            let text = text.trim_ascii();
            let value = if self.hexadecimal {
                hexadecimal(text)
            } else {
                number(text)
            };
            let Some(value) = value.filter(|value| *value <= self.max) else {
                return false;
            };
            match values.get_mut(usize::from(control)) {
                Some(place) if control < self.controls => {
                    *place = Some(if self.invert { self.max - value } else { value });
                }
                _ => return false,
            }
            fields += 1;
        }
        self.key.is_some() || fields == self.controls
    }

    /// deej's rule: a step of the gate's size, or an end reached from elsewhere.
    fn differs(&self, told: Option<i32>, value: i32) -> bool {
        let Some(told) = told else {
            return true;
        };
        let at_end = value == 0 || value == self.max;
        let step = f64::from((value - told).abs());
        value != told && (at_end || step >= self.noise * f64::from(self.max))
    }
}

impl Key {
    /// Control from 0, and the text of the value.
    fn split<'a>(&self, field: &'a [u8]) -> Option<(u16, &'a [u8])> {
        let field = field.trim_ascii().strip_prefix(self.before.as_bytes())?;
        let digits = field.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let (name, rest) = field.split_at_checked(digits)?;
        let value = rest.strip_prefix(self.after.as_bytes())?;
        Some((u16::try_from(number(name)?).ok()?, value))
    }
}

/// A whole number of at most seven hexadecimal digits.
fn hexadecimal(text: &[u8]) -> Option<i32> {
    let text = std::str::from_utf8(text).ok()?;
    let digits = text.len() <= 7 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    digits.then(|| i32::from_str_radix(text, 16).ok()).flatten()
}

impl Codec for Deej {
    /// Nothing is asked: the box speaks by itself, some seconds after its port was opened.
    fn start(&mut self, _now: Instant, _out: &mut Outgoing) {
        self.lines.reset();
        self.joined = false;
        self.started = false;
        // All values are told again.
        self.told.fill(None);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            self.push(byte, emit);
        }
    }

    fn advance(&mut self, _now: Instant, _out: &mut Outgoing, _emit: &mut dyn FnMut(InputEvent)) {}

    /// A box of this kind shows nothing.
    fn encode(&mut self, _feedback: &Feedback, _out: &mut Outgoing) {}

    /// Potentiometers stay where they are.
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
