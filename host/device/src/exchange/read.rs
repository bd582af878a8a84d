//! From text to records.

use super::words::{Word, Words};
use super::{Exchange, Head, Record, What, events, shows};
use crate::codec::{Answer, Step};
use std::time::Duration;

/// Something in an exchange that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {message}")]
pub struct ExchangeError {
    /// From 1.
    pub line: u32,
    /// In characters, from 1.
    pub column: u32,
    /// What was expected and what was found.
    pub message: String,
}

impl ExchangeError {
    pub(super) fn new(line: u32, column: u32, message: impl Into<String>) -> Self {
        Self {
            line,
            column,
            message: message.into(),
        }
    }
}

/// Reads an exchange. On failure gives every error, not only the first.
pub fn read(text: &str) -> Result<Exchange, Vec<ExchangeError>> {
    let (exchange, errors) = read_readable(text);
    if errors.is_empty() {
        Ok(exchange)
    } else {
        Err(errors)
    }
}

/// Reads what can be read, line by line, and says what cannot: a recording is worth something without its last line.
pub fn read_readable(text: &str) -> (Exchange, Vec<ExchangeError>) {
    let mut exchange = Exchange::default();
    let mut errors = Vec::new();
    let mut reached = Duration::ZERO;
    for (line, text) in (1..).zip(text.lines()) {
        match head_line(text, line, &mut exchange) {
            Ok(true) => continue,
            Ok(false) => {}
            Err(error) => {
                errors.push(error);
                continue;
            }
        }
        match record(line, text, &mut reached) {
            Ok(Some(record)) => exchange.records.push(record),
            Ok(None) => {}
            Err(error) => errors.push(error),
        }
    }
    (exchange, errors)
}

/// Takes a `key: value` line; false if it is none.
fn head_line(text: &str, line: u32, exchange: &mut Exchange) -> Result<bool, ExchangeError> {
    let Some((key, value)) = text.split_once(':') else {
        return Ok(false);
    };
    let key = key.trim();
    let is_key = !key.is_empty() && key.bytes().all(|letter| letter.is_ascii_lowercase());
    if !is_key {
        return Ok(false);
    }
    let Head {
        profile,
        source,
        simulator,
        interface,
        reporting,
    } = &mut exchange.head;
    if !exchange.records.is_empty() {
        return Err(ExchangeError::new(
            line,
            1,
            format!("`{key}:` must stand before the first thing said"),
        ));
    }
    // A source may have any sign in it; elsewhere `#` begins a remark.
    let value = match key {
        "source" => value,
        _ => value.split('#').next().unwrap_or_default(),
    };
    let value = value.trim();
    let place = match key {
        "profile" => profile,
        "source" => source,
        "simulator" => simulator,
        "interface" => {
            let number = value.parse().ok();
            *interface = Some(number.ok_or_else(|| {
                ExchangeError::new(
                    line,
                    1,
                    format!("expected an interface's number, found `{value}`"),
                )
            })?);
            return Ok(true);
        }
        "begins" if value == "reporting" => {
            *reporting = true;
            return Ok(true);
        }
        "begins" => {
            let message = format!("expected `begins: reporting`, found `{value}`");
            return Err(ExchangeError::new(line, 1, message));
        }
        other => {
            let message =
                format!("expected profile, source, simulator, interface or begins, found `{other}`");
            return Err(ExchangeError::new(line, 1, message));
        }
    };
    match place {
        // A source may take several lines.
        Some(text) if key == "source" => {
            text.push(' ');
            text.push_str(value);
        }
        Some(_) => return Err(ExchangeError::new(line, 1, format!("`{key}:` stands twice"))),
        None => *place = Some(value.to_owned()),
    }
    Ok(true)
}

fn record(line: u32, text: &str, reached: &mut Duration) -> Result<Option<Record>, ExchangeError> {
    let mut words = Words::cut(line, text)?;
    // Behind the line, or in front of it.
    let time_word = if words.skip("@") {
        Some(words.word("seconds")?)
    } else {
        words.take_time()
    };
    let at = match time_word {
        Some(word) => Some(time(&words, &word, reached)?),
        None => None,
    };
    let Some(first) = words.take() else {
        return match at {
            None => Ok(None),
            Some(_) => Err(words.fault("a time needs something that happens then; `pause @ T` lets it pass")),
        };
    };
    let what = match first.text.as_str() {
        "host" => {
            arrow(&mut words, ">")?;
            What::Host(step(&mut words)?)
        }
        "device" if words.skip("gone") => What::Gone,
        "device" if words.skip("back") => What::Back,
        "device" => {
            arrow(&mut words, "<")?;
            said(&mut words)?
        }
        "event" => What::Event(events::event(&mut words)?),
        "show" => What::Show(shows::show(&mut words)?),
        "surface" => surface(&mut words)?,
        "hand" => What::Hand(words.rest()),
        "pause" if at.is_some() => What::Pause,
        "pause" => return Err(words.fault("expected `pause @ T`")),
        other => {
            let known = "host, device, event, surface, show, hand or pause";
            return Err(words.at(&first, format!("expected {known}, found `{other}`")));
        }
    };
    words.end()?;
    Ok(Some(Record { at, what, line }))
}

fn arrow(words: &mut Words, arrow: &str) -> Result<(), ExchangeError> {
    if words.skip(arrow) {
        return Ok(());
    }
    Err(words.fault(format!("expected ` {arrow} `")))
}

/// `0.25` since the beginning, or `+0.25` after the time before.
fn time(words: &Words, word: &Word, reached: &mut Duration) -> Result<Duration, ExchangeError> {
    let (text, since) = match word.text.strip_prefix('+') {
        Some(text) => (text, *reached),
        None => (word.text.as_str(), Duration::ZERO),
    };
    let wrong = || {
        words.at(
            word,
            format!("expected seconds such as 0.125, found `{}`", word.text),
        )
    };
    let at = since
        .checked_add(seconds(text).ok_or_else(wrong)?)
        .ok_or_else(wrong)?;
    if at < *reached {
        let message = format!(
            "time runs backwards: {} after {}",
            at.as_secs_f64(),
            reached.as_secs_f64()
        );
        return Err(words.at(word, message));
    }
    *reached = at;
    Ok(at)
}

/// A decimal number of seconds, exact to the nanosecond. More than 115 days are refused.
fn seconds(text: &str) -> Option<Duration> {
    let (whole, decimals) = text.split_once('.').unwrap_or((text, ""));
    let digits = |text: &str| text.bytes().all(|digit| digit.is_ascii_digit());
    if whole.is_empty() || !digits(whole) || !digits(decimals) || decimals.len() > 9 {
        return None;
    }
    let whole: u64 = whole.parse().ok().filter(|&whole| whole < 10_000_000)?;
    let nanos: u32 = format!("{decimals:0<9}").parse().ok()?;
    Some(Duration::new(whole, nanos))
}

fn step(words: &mut Words) -> Result<Step, ExchangeError> {
    if words.skip("ask") {
        return question(words);
    }
    if words.skip("baud") {
        return Ok(Step::Baud(words.number("a line speed")?));
    }
    if words.skip("wait") {
        let word = words.word("seconds")?;
        let span = seconds(&word.text);
        let span = span.ok_or_else(|| words.at(&word, format!("expected seconds, found `{}`", word.text)))?;
        return Ok(Step::Wait(span));
    }
    let make = if words.skip("report") {
        Step::Report
    } else if words.skip("feature") {
        Step::Feature
    } else {
        Step::Bytes
    };
    filled(words).map(make)
}

fn question(words: &mut Words) -> Result<Step, ExchangeError> {
    let word = words.word("feature, string or descriptor")?;
    match word.text.as_str() {
        "feature" => Ok(Step::AskFeature {
            id: hex_byte(words, "the report's id")?,
            bytes: words.number("its length with the id")?,
        }),
        "string" => Ok(Step::AskString(words.number("the string's index")?)),
        "descriptor" => Ok(Step::AskDescriptor),
        other => Err(words.at(
            &word,
            format!("expected feature, string or descriptor, found `{other}`"),
        )),
    }
}

fn said(words: &mut Words) -> Result<What, ExchangeError> {
    let answer = if words.skip("feature") {
        let id = hex_byte(words, "the report's id")?;
        let bytes = answered(words)?.map(|rest| [&[id], rest.as_slice()].concat());
        Answer::Feature { id, bytes }
    } else if words.skip("string") {
        let index = words.number("the string's index")?;
        let raw = answered(words)?;
        Answer::Text { index, raw }
    } else if words.skip("descriptor") {
        Answer::Descriptor(answered(words)?)
    } else {
        return filled(words).map(What::Device);
    };
    Ok(What::Answer(answer))
}

/// Bytes, or `refused` and why.
fn answered(words: &mut Words) -> Result<Result<Vec<u8>, String>, ExchangeError> {
    if words.skip("refused") {
        return Ok(Err(words.rest()));
    }
    words.bytes().map(Ok)
}

fn filled(words: &mut Words) -> Result<Vec<u8>, ExchangeError> {
    let bytes = words.bytes()?;
    if bytes.is_empty() {
        return Err(words.fault("expected bytes, found the end of the line"));
    }
    Ok(bytes)
}

fn hex_byte(words: &mut Words, expected: &str) -> Result<u8, ExchangeError> {
    let word = words.word(expected)?;
    u8::from_str_radix(&word.text, 16).map_err(|_| {
        words.at(
            &word,
            format!("expected {expected} in hexadecimal, found `{}`", word.text),
        )
    })
}

fn surface(words: &mut Words) -> Result<What, ExchangeError> {
    let max_counts = [words.number("the largest x")?, words.number("the largest y")?];
    let pressure_max = if words.skip("pressure") {
        words.number("the largest pressure")?
    } else {
        0
    };
    Ok(What::Surface {
        max_counts,
        pressure_max,
    })
}
