//! What a device is to show, in words: what stands behind `show` in an exchange.

use super::read::ExchangeError;
use super::words::Words;
use crate::codec::{Feedback, RingStyle};
use std::fmt::Write;

const STYLES: [(&str, RingStyle); 4] = [
    ("dot", RingStyle::Dot),
    ("fan", RingStyle::Fan),
    ("pan", RingStyle::Pan),
    ("spread", RingStyle::Spread),
];

/// Feedback in the words that an exchange has behind `show`; `None` for pictures, which no text holds.
pub fn show_words(feedback: &Feedback) -> Option<String> {
    Some(match feedback {
        Feedback::Lamps(lit) => {
            let on: Vec<String> = (0..64)
                .filter(|lamp| lit >> lamp & 1 == 1)
                .map(|lamp| format!(" {lamp}"))
                .collect();
            format!("lamps{}", on.concat())
        }
        Feedback::Lamp {
            control,
            level,
            colour,
        } => {
            let colour = colour
                .map(|[r, g, b]| format!(" {r} {g} {b}"))
                .unwrap_or_default();
            format!("lamp {control} {level}{colour}")
        }
        Feedback::Level { control, level } => format!("level {control} {level}"),
        Feedback::Ring {
            control, value: None, ..
        } => format!("ring {control} off"),
        Feedback::Ring {
            control,
            value: Some(value),
            style,
        } => {
            let style = STYLES
                .iter()
                .find(|(_, s)| s == style)
                .map_or("dot", |(word, _)| word);
            format!("ring {control} {value:?} {style}")
        }
        Feedback::Label { control, text } => format!("label {control} {}", in_marks(text)),
        Feedback::Picture { .. } => return None,
        Feedback::Motor { control, value } => format!("motor {control} {value}"),
        Feedback::Haptic {
            control,
            clicks,
            apart_ms,
        } => format!("haptic {control} {clicks} {apart_ms}"),
    })
}

/// A text in quotation marks. Letters beyond Latin-1, which no exchange holds, become `?`.
fn in_marks(text: &str) -> String {
    let mut out = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => out.extend(['\\', letter]),
            letter if (letter as u32) < 32 => {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\x{:02x}", letter as u32);
            }
            letter if (letter as u32) < 256 => out.push(letter),
            _ => out.push('?'),
        }
    }
    out.push('"');
    out
}

pub(super) fn show(words: &mut Words) -> Result<Feedback, ExchangeError> {
    let first = words.word("something to show")?;
    Ok(match first.text.as_str() {
        "lamps" => {
            let mut lit = 0_u64;
            while !words.is_empty() {
                let lamp: u32 = words.number("a lamp's number")?;
                lit |= 1_u64
                    .checked_shl(lamp)
                    .ok_or_else(|| words.fault("lamps are 0 to 63"))?;
            }
            Feedback::Lamps(lit)
        }
        "lamp" => Feedback::Lamp {
            control: words.number("a lamp's number")?,
            level: words.number("a level, 0 to 255")?,
            colour: if words.is_empty() {
                None
            } else {
                Some([
                    words.number("red")?,
                    words.number("green")?,
                    words.number("blue")?,
                ])
            },
        },
        "level" => Feedback::Level {
            control: words.number("a level's number")?,
            level: words.number("a level, 0 to 255")?,
        },
        "ring" => ring(words)?,
        "label" => Feedback::Label {
            control: words.number("a control's number")?,
            text: words.rest(),
        },
        "motor" => Feedback::Motor {
            control: words.number("an axis's number")?,
            value: words.number("a value in counts")?,
        },
        "haptic" => Feedback::Haptic {
            control: words.number("a control's number")?,
            clicks: words.number("a number of clicks")?,
            apart_ms: words.number("milliseconds from click to click")?,
        },
        other => {
            let known = "lamps, lamp, level, ring, label, motor, haptic";
            return Err(words.at(&first, format!("expected one of {known}, found `{other}`")));
        }
    })
}

fn ring(words: &mut Words) -> Result<Feedback, ExchangeError> {
    let control = words.number("a ring's number")?;
    if words.skip("off") {
        return Ok(Feedback::Ring {
            control,
            value: None,
            style: RingStyle::default(),
        });
    }
    let value = Some(words.real("a share of the ring, 0 to 1, or `off`")?);
    let style = match words.take() {
        None => RingStyle::default(),
        Some(word) => STYLES
            .iter()
            .find(|(name, _)| *name == word.text)
            .map(|(_, style)| *style)
            .ok_or_else(|| {
                words.at(
                    &word,
                    format!("expected dot, fan, pan or spread, found `{}`", word.text),
                )
            })?,
    };
    Ok(Feedback::Ring {
        control,
        value,
        style,
    })
}
