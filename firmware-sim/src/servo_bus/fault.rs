//! Faults by name: the text a person writes, and what it means.
//!
//! Form: what goes wrong, then in any order `at TIME`, `for TIME`, `once`. Times carry `s`, `ms` or `us`.
//! Source: `docs/cli.md`, "sim servo-bus --fault".

use std::fmt;

/// Share of bytes that plain `noise` spoils, in parts per million.
const NOISE_PPM: u32 = 10_000;
/// Volts of a plain `brownout`.
const BROWN_OUT_VOLTS: f64 = 4.0;
/// Degrees of a plain `hot`.
const HOT_C: f64 = 95.0;

/// What goes wrong. Numbers of servos are their ids on the bus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FaultKind {
    /// `servo N stuck`: the horn is jammed; the motor pulls in vain.
    Stuck(u8),
    /// `servo N silent`, `silent N`: it hears and obeys, but does not answer.
    Silent(u8),
    /// `servo N hot [C]`: the motor is at this temperature.
    Hot(u8, f64),
    /// `servo N error BITS`: these bits of Hardware Error Status are raised.
    HardwareError(u8, u8),
    /// `servo N load SHARE`: a steady pull of −1 to 1 of what the motor has.
    Load(u8, f64),
    /// `servo N reboot`: it starts over by itself.
    Reboot(u8),
    /// `cable cut [after K]`: only the first K servos of the chain keep power and data; none without `after`.
    CableCut(usize),
    /// `drop P%`: this share of answers is lost, in parts per million.
    Drop(u32),
    /// `late D`: answers begin this much later, in microseconds.
    Late(u64),
    /// `noise [P%]`: this share of bytes has a bit turned, in parts per million.
    Noise(u32),
    /// `brownout [V]`, `supply V`: the supply has this many volts.
    Supply(f64),
    /// `stall`: the adapter hands over nothing.
    Stall,
    /// `echo`: the adapter hears itself.
    Echo,
}

/// A fault with its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// What goes wrong.
    pub kind: FaultKind,
    /// Microseconds after it is brought in; none: at once.
    pub at_us: Option<u64>,
    /// Microseconds until it is over; none: it stays.
    pub for_us: Option<u64>,
    /// It is over after it has happened once.
    pub once: bool,
}

/// A text that names no fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {message}")]
pub struct FaultError {
    /// Column in characters, from 1.
    pub column: u32,
    /// What was expected and what was found.
    pub message: String,
}

impl From<FaultKind> for Fault {
    /// At once and to stay.
    fn from(kind: FaultKind) -> Self {
        Self {
            kind,
            at_us: None,
            for_us: None,
            once: false,
        }
    }
}

impl Fault {
    /// Reads a fault such as `servo 3 stuck at 2s`, `cable cut after 4 at 5s`, `drop 1%`, `late 30ms once`.
    pub fn parse(text: &str) -> Result<Self, FaultError> {
        let mut words = Words::new(text);
        let mut fault = Self::from(words.kind()?);
        while let Some(word) = words.next() {
            match word {
                "at" => fault.at_us = Some(words.micros()?),
                "for" => fault.for_us = Some(words.micros()?),
                "once" => fault.once = true,
                _ => return Err(words.wrong("`at TIME`, `for TIME` or `once`")),
            }
        }
        Ok(fault)
    }
}

/// The words of a fault, with the column of the one last taken.
struct Words<'a> {
    text: &'a str,
    rest: std::iter::Peekable<std::str::SplitWhitespace<'a>>,
    last: Option<&'a str>,
}

impl<'a> Words<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            text,
            rest: text.split_whitespace().peekable(),
            last: None,
        }
    }

    fn next(&mut self) -> Option<&'a str> {
        self.last = self.rest.next();
        self.last
    }

    fn kind(&mut self) -> Result<FaultKind, FaultError> {
        Ok(match self.next() {
            Some("servo") => return self.kind_of_servo(),
            Some("silent") => FaultKind::Silent(self.id()?),
            Some("stuck") => FaultKind::Stuck(self.id()?),
            Some("cable") => {
                if self.next() != Some("cut") {
                    return Err(self.wrong("`cut`"));
                }
                let after = self.rest.next_if_eq(&"after").is_some();
                FaultKind::CableCut(if after { usize::from(self.id()?) } else { 0 })
            }
            Some("drop") => FaultKind::Drop(self.share()?),
            Some("late") => FaultKind::Late(self.micros()?),
            Some("noise") => FaultKind::Noise(if self.a_number_follows() {
                self.share()?
            } else {
                NOISE_PPM
            }),
            Some("brownout") => FaultKind::Supply(if self.a_number_follows() {
                self.number(0.0, 60.0)?
            } else {
                BROWN_OUT_VOLTS
            }),
            Some("supply") => FaultKind::Supply(self.number(0.0, 60.0)?),
            Some("stall") => FaultKind::Stall,
            Some("echo") => FaultKind::Echo,
            _ => {
                return Err(self.wrong(
                    "servo, silent, stuck, cable cut, drop, late, noise, brownout, supply, stall or echo",
                ));
            }
        })
    }

    fn kind_of_servo(&mut self) -> Result<FaultKind, FaultError> {
        let id = self.id()?;
        Ok(match self.next() {
            Some("stuck") => FaultKind::Stuck(id),
            Some("silent") => FaultKind::Silent(id),
            Some("hot") => FaultKind::Hot(
                id,
                if self.a_number_follows() {
                    self.number(-40.0, 200.0)?
                } else {
                    HOT_C
                },
            ),
            Some("error") => FaultKind::HardwareError(id, self.number(0.0, 255.0)? as u8),
            Some("load") => FaultKind::Load(id, self.number(-1.0, 1.0)?),
            Some("reboot") => FaultKind::Reboot(id),
            _ => return Err(self.wrong("stuck, silent, hot, error, load or reboot")),
        })
    }

    fn a_number_follows(&mut self) -> bool {
        self.rest
            .peek()
            .is_some_and(|word| word.starts_with(|first: char| first.is_ascii_digit() || first == '-'))
    }

    fn id(&mut self) -> Result<u8, FaultError> {
        let word = self
            .next()
            .and_then(|word| word.parse().ok())
            .filter(|&id| id <= super::packet::ID_MAX);
        word.ok_or_else(|| self.wrong("a number from 0 to 252"))
    }

    fn number(&mut self, min: f64, max: f64) -> Result<f64, FaultError> {
        let value = self
            .next()
            .and_then(|word| word.trim_end_matches(['V', 'C']).parse::<f64>().ok());
        value
            .filter(|value| (min..=max).contains(value))
            .ok_or_else(|| self.wrong(&format!("a number from {min} to {max}")))
    }

    /// A percentage, as parts per million.
    fn share(&mut self) -> Result<u32, FaultError> {
        let value = self
            .next()
            .and_then(|word| word.strip_suffix('%'))
            .and_then(|word| word.parse::<f64>().ok());
        value
            .filter(|value| (0.0..=100.0).contains(value))
            .map(|percent| (percent * 1e4).round() as u32)
            .ok_or_else(|| self.wrong("a percentage such as 1%"))
    }

    fn micros(&mut self) -> Result<u64, FaultError> {
        let word = self.next();
        let units = [("us", 1.0), ("ms", 1e3), ("s", 1e6)];
        let read = |word: &str| {
            let (number, unit) = units
                .iter()
                .find_map(|&(suffix, us)| Some((word.strip_suffix(suffix)?, us)))?;
            number.parse::<f64>().ok().map(|value| value * unit)
        };
        word.and_then(read)
            .filter(|us| (0.0..=1e12).contains(us))
            .map(|us| us.round() as u64)
            .ok_or_else(|| self.wrong("a time such as 2s, 30ms or 500us"))
    }

    /// The word last taken is not `expected`.
    fn wrong(&self, expected: &str) -> FaultError {
        let (column, found) = match self.last {
            Some(word) => {
                let offset = word.as_ptr() as usize - self.text.as_ptr() as usize;
                (
                    self.text[..offset].chars().count() as u32 + 1,
                    format!("`{word}`"),
                )
            }
            None => (self.text.trim_end().chars().count() as u32 + 1, "the end".into()),
        };
        FaultError {
            column,
            message: format!("expected {expected}, found {found}"),
        }
    }
}

impl fmt::Display for Fault {
    /// The text that `parse` reads back.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            FaultKind::Stuck(id) => write!(f, "servo {id} stuck"),
            FaultKind::Silent(id) => write!(f, "servo {id} silent"),
            FaultKind::Hot(id, celsius) => write!(f, "servo {id} hot {celsius}"),
            FaultKind::HardwareError(id, bits) => write!(f, "servo {id} error {bits}"),
            FaultKind::Load(id, share) => write!(f, "servo {id} load {share}"),
            FaultKind::Reboot(id) => write!(f, "servo {id} reboot"),
            FaultKind::CableCut(after) => write!(f, "cable cut after {after}"),
            FaultKind::Drop(ppm) => write!(f, "drop {}%", f64::from(ppm) / 1e4),
            FaultKind::Late(us) => write!(f, "late {us}us"),
            FaultKind::Noise(ppm) => write!(f, "noise {}%", f64::from(ppm) / 1e4),
            FaultKind::Supply(volts) => write!(f, "supply {volts}"),
            FaultKind::Stall => write!(f, "stall"),
            FaultKind::Echo => write!(f, "echo"),
        }?;
        if let Some(at) = self.at_us {
            write!(f, " at {at}us")?;
        }
        if let Some(span) = self.for_us {
            write!(f, " for {span}us")?;
        }
        if self.once { write!(f, " once") } else { Ok(()) }
    }
}
