//! One line of a script: words with their columns, then one function per kind of action.

use super::{Action, Device};
use crate::hands::{Held, Pen, Puck, Touch, Turn};
use std::fmt::Display;
use std::str::FromStr;

/// Longest time a script may name: a day, in seconds.
const SECONDS_MAX: f64 = 86_400.0;

/// What is wrong with a line, and where.
#[derive(Debug)]
pub(super) struct LineFault {
    pub(super) column: u32,
    pub(super) message: String,
}

/// Reads one line; nothing when it is empty or a comment.
pub(super) fn parse(device: Device, text: &str) -> Result<Option<Action>, LineFault> {
    let mut words = Words::new(text);
    if words.peek().is_none() {
        return Ok(None);
    }
    words.expect("at")?;
    let at_us = micros(words.number("a time in seconds", 0.0, SECONDS_MAX)?);
    let column = words.column();
    let verb = words.any("an action")?;
    let there = device.count(verb);
    let touch = match verb {
        "power-cycle" => Touch::PowerCycle,
        "noise" => Touch::Noise(words.whole("a number of bytes", 1u16, 1000)?),
        "dial" if there > 0 => dial(&mut words, there - 1)?,
        "button" if there > 0 => button(&mut words, there - 1)?,
        "axis" if there > 0 => axis(&mut words, there - 1)?,
        "ring" if there > 0 => ring(&mut words, there - 1)?,
        "pen" if there > 0 => pen(&mut words)?,
        "puck" if there > 0 => puck(&mut words)?,
        _ => {
            let known = ["dial", "pen", "puck", "button", "axis", "ring"];
            let known: Vec<&str> = known
                .into_iter()
                .filter(|verb| device.count(verb) > 0)
                .chain(["power-cycle"])
                .collect();
            return Err(fault(
                column,
                format!("expected {} or noise, found `{verb}`", known.join(", ")),
            ));
        }
    };
    words.end()?;
    Ok(Some(Action { at_us, touch }))
}

fn dial(words: &mut Words<'_>, last: u8) -> Result<Touch, LineFault> {
    let control = words.whole("a dial", 0, last)?;
    let column = words.column();
    let amount = words.any("how far: counts, degrees (`deg`) or turns (`turns`)")?;
    let by = turn(amount).ok_or_else(|| {
        fault(
            column,
            format!(
                "expected counts like +12, degrees like +90deg or turns like -0.5turns, found `{amount}`"
            ),
        )
    })?;
    let over_us = duration(words)?;
    Ok(Touch::Dial { control, by, over_us })
}

fn axis(words: &mut Words<'_>, last: u8) -> Result<Touch, LineFault> {
    let control = words.whole("an axis", 0, last)?;
    let to = words.number("a share of its travel", -1.0, 1.0)?;
    let over_us = duration(words)?;
    Ok(Touch::Axis { control, to, over_us })
}

fn ring(words: &mut Words<'_>, last: u8) -> Result<Touch, LineFault> {
    let control = words.whole("a ring", 0, last)?;
    let at = if words.take("off") {
        None
    } else {
        Some(words.number("a share of the way round, or `off`", 0.0, 1.0)?)
    };
    Ok(Touch::Ring { control, at })
}

fn duration(words: &mut Words<'_>) -> Result<u64, LineFault> {
    if words.take("over") {
        Ok(micros(words.number("a duration in seconds", 0.0, SECONDS_MAX)?))
    } else {
        Ok(0)
    }
}

fn turn(text: &str) -> Option<Turn> {
    let real = |text: &str| text.parse::<f64>().ok().filter(|value| value.abs() <= 1e6);
    if let Some(text) = text.strip_suffix("deg") {
        real(text).map(Turn::Degrees)
    } else if let Some(text) = text.strip_suffix("turns") {
        real(text).map(Turn::Turns)
    } else {
        text.parse()
            .ok()
            .filter(|counts: &i32| counts.unsigned_abs() <= 1_000_000)
            .map(Turn::Counts)
    }
}

fn button(words: &mut Words<'_>, last: u8) -> Result<Touch, LineFault> {
    let control = words.whole("a button", 0, last)?;
    let column = words.column();
    match words.any("down or up")? {
        "down" => Ok(Touch::Button { control, down: true }),
        "up" => Ok(Touch::Button { control, down: false }),
        other => Err(fault(column, format!("expected down or up, found `{other}`"))),
    }
}

fn pen(words: &mut Words<'_>) -> Result<Touch, LineFault> {
    if words.take("away") {
        return Ok(Touch::Lift(Held::Pen));
    }
    let mut pen = Pen {
        x: place(words, "x")?,
        y: place(words, "y")?,
        ..Pen::default()
    };
    while words.peek().is_some() {
        let column = words.column();
        match words.any("more")? {
            "pressure" => pen.pressure = words.number("a pressure", 0.0, 1.0)?,
            "tip" => pen.tip = true,
            // Bit 0 of the packet is the tip and bit 3 an eraser, so a pen has two side buttons.
            "button" => pen.buttons |= 1 << (words.whole("a pen button", 1, 2)? - 1),
            "eraser" => pen.eraser = true,
            "tilt" => pen.tilt_deg = [lean(words)?, lean(words)?],
            "serial" => pen.serial = words.whole("the number of a pen", 1, u32::MAX)?,
            other => {
                return Err(fault(
                    column,
                    format!("expected pressure, tip, button, eraser, tilt or serial, found `{other}`"),
                ));
            }
        }
    }
    Ok(Touch::Pen(pen))
}

fn puck(words: &mut Words<'_>) -> Result<Touch, LineFault> {
    if words.take("away") {
        return Ok(Touch::Lift(Held::Puck));
    }
    let mut puck = Puck {
        x: place(words, "x")?,
        y: place(words, "y")?,
        ..Puck::default()
    };
    while words.peek().is_some() {
        let column = words.column();
        match words.any("more")? {
            "button" => puck.buttons |= 1 << (words.whole("a puck button", 1, 5)? - 1),
            "wheel" => puck.wheel = words.clicks()?,
            "serial" => puck.serial = words.whole("the number of a puck", 1, u32::MAX)?,
            other => {
                return Err(fault(
                    column,
                    format!("expected button, wheel or serial, found `{other}`"),
                ));
            }
        }
    }
    Ok(Touch::Puck(puck))
}

fn place(words: &mut Words<'_>, axis: &str) -> Result<f64, LineFault> {
    words.number(&format!("{axis} of the pointer, or `away`"), -1.0, 1.0)
}

fn lean(words: &mut Words<'_>) -> Result<i8, LineFault> {
    Ok(words.number("a tilt in degrees", -64.0, 63.0)?.round() as i8)
}

fn micros(secs: f64) -> u64 {
    (secs * 1e6).round() as u64
}

fn fault(column: u32, message: String) -> LineFault {
    LineFault { column, message }
}

/// The words of a line before its comment, each with its column in characters.
struct Words<'a> {
    all: Vec<(u32, &'a str)>,
    next: usize,
    end: u32,
}

impl<'a> Words<'a> {
    fn new(line: &'a str) -> Self {
        let text = line.split('#').next().unwrap_or_default();
        let mut all = Vec::new();
        for word in text.split_whitespace() {
            let offset = word.as_ptr() as usize - text.as_ptr() as usize;
            all.push((text[..offset].chars().count() as u32 + 1, word));
        }
        Self {
            all,
            next: 0,
            end: text.trim_end().chars().count() as u32 + 1,
        }
    }

    fn peek(&self) -> Option<&'a str> {
        self.all.get(self.next).map(|&(_, word)| word)
    }

    /// Column of the next word, or just behind the last.
    fn column(&self) -> u32 {
        self.all.get(self.next).map_or(self.end, |&(column, _)| column)
    }

    fn take(&mut self, word: &str) -> bool {
        let found = self.peek() == Some(word);
        self.next += usize::from(found);
        found
    }

    fn any(&mut self, what: &str) -> Result<&'a str, LineFault> {
        let word = self.peek().ok_or_else(|| {
            fault(
                self.column(),
                format!("expected {what}, found the end of the line"),
            )
        })?;
        self.next += 1;
        Ok(word)
    }

    fn expect(&mut self, wanted: &str) -> Result<(), LineFault> {
        let column = self.column();
        let word = self.any(&format!("`{wanted}`"))?;
        if word == wanted {
            Ok(())
        } else {
            Err(fault(column, format!("expected `{wanted}`, found `{word}`")))
        }
    }

    fn number(&mut self, what: &str, min: f64, max: f64) -> Result<f64, LineFault> {
        let column = self.column();
        let word = self.any(what)?;
        let value = word
            .parse::<f64>()
            .ok()
            .filter(|value| (min..=max).contains(value));
        value.ok_or_else(|| {
            fault(
                column,
                format!("expected {what}, a number from {min} to {max}, found `{word}`"),
            )
        })
    }

    fn whole<N>(&mut self, what: &str, min: N, max: N) -> Result<N, LineFault>
    where
        N: FromStr + PartialOrd + Display + Copy,
    {
        let column = self.column();
        let word = self.any(what)?;
        let value = word.parse::<N>().ok().filter(|value| (min..=max).contains(value));
        value.ok_or_else(|| fault(column, format!("expected {what}, {min} to {max}, found `{word}`")))
    }

    fn clicks(&mut self) -> Result<i32, LineFault> {
        let column = self.column();
        let word = self.any("wheel clicks")?;
        let value = word
            .parse::<i32>()
            .ok()
            .filter(|clicks| clicks.unsigned_abs() <= 1000);
        value.ok_or_else(|| {
            fault(
                column,
                format!("expected whole wheel clicks such as -2, found `{word}`"),
            )
        })
    }

    fn end(&self) -> Result<(), LineFault> {
        match self.peek() {
            None => Ok(()),
            Some(word) => Err(fault(
                self.column(),
                format!("expected the end of the line, found `{word}`"),
            )),
        }
    }
}
