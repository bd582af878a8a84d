//! Reading a TOML table field by field, noting every fault instead of stopping at the first.
//!
//! Apart from the file formats because all of them want the same: known keys only, finite numbers,
//! a place for every error.

use std::fmt::Write as _;

use glam::DVec3;
use toml::de::{DeArray, DeTable, DeValue};

use super::fault::{FileError, Findings};
use super::source::Source;

/// A table being taken apart. [`Fields::finish`] reports the keys nobody asked for.
pub(super) struct Fields<'t> {
    source: &'t Source,
    table: &'t DeTable<'t>,
    at: usize,
    asked: Vec<&'static str>,
}

/// A value with the place it stands at.
#[derive(Clone, Copy)]
pub(super) struct Placed<'t> {
    pub(super) source: &'t Source,
    pub(super) value: &'t DeValue<'t>,
    pub(super) at: usize,
}

/// Parses TOML; syntax errors go to `found`, and what could be read is returned all the same.
pub(super) fn parse<'t>(source: &'t Source, found: &mut Findings) -> DeTable<'t> {
    let (table, errors) = DeTable::parse_recoverable(source.text());
    for error in errors {
        let at = error.span().map_or(0, |span| span.start);
        found.error(source.error(at, error.message().to_owned()));
    }
    table.into_inner()
}

impl<'t> Fields<'t> {
    /// The whole of a parsed file.
    pub(super) fn of_file(source: &'t Source, table: &'t DeTable<'t>) -> Self {
        Self {
            source,
            table,
            at: 0,
            asked: Vec::new(),
        }
    }

    /// The value at `key`, if it is there.
    pub(super) fn optional(&mut self, key: &'static str) -> Option<Placed<'t>> {
        self.asked.push(key);
        let value = self.table.get(key)?;
        Some(Placed {
            source: self.source,
            value: value.get_ref(),
            at: value.span().start,
        })
    }

    /// The value at `key`; its absence is an error.
    pub(super) fn required(&mut self, key: &'static str, found: &mut Findings) -> Option<Placed<'t>> {
        let value = self.optional(key);
        if value.is_none() {
            found.error(self.source.error(self.at, format!("`{key}` is missing")));
        }
        value
    }

    /// Reports every key that was not asked for.
    pub(super) fn finish(self, found: &mut Findings) {
        for key in self.table.keys() {
            if !self.asked.contains(&key.get_ref().as_ref()) {
                let message = format!("unknown key `{}`", key.get_ref());
                let known = format!("known here: {}", self.asked.join(", "));
                found.error(self.source.error(key.span().start, message).with_hint(known));
            }
        }
    }
}

impl<'t> Placed<'t> {
    /// An error at this value.
    pub(super) fn fault(&self, message: impl Into<String>) -> FileError {
        self.source.error(self.at, message)
    }

    fn expected(&self, what: &str) -> FileError {
        self.fault(format!(
            "expected {what}, found {} {}",
            article(self.value.type_str()),
            self.value.type_str()
        ))
    }

    /// A string.
    pub(super) fn text(self, found: &mut Findings) -> Option<&'t str> {
        let text = self.value.as_str();
        if text.is_none() {
            found.error(self.expected("a string"));
        }
        text
    }

    /// `true` or `false`.
    pub(super) fn boolean(self, found: &mut Findings) -> Option<bool> {
        let value = self.value.as_bool();
        if value.is_none() {
            found.error(self.expected("true or false"));
        }
        value
    }

    /// A finite number, written with or without a point.
    pub(super) fn number(self, found: &mut Findings) -> Option<f64> {
        let value = match self.value {
            DeValue::Float(float) => float.as_str().parse::<f64>().ok(),
            DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
                .ok()
                .map(|value| value as f64),
            _ => {
                found.error(self.expected("a number"));
                return None;
            }
        };
        let finite = value.filter(|value| value.is_finite());
        if finite.is_none() {
            found.error(self.fault("this number is not finite"));
        }
        finite
    }

    /// A number above zero.
    pub(super) fn above_zero(self, found: &mut Findings) -> Option<f64> {
        let number = self.number(found)?;
        if number > 0.0 {
            return Some(number);
        }
        found.error(self.fault(format!("must be above 0, not {number}")));
        None
    }

    /// A whole number not below zero.
    pub(super) fn count(self, found: &mut Findings) -> Option<u64> {
        let DeValue::Integer(integer) = self.value else {
            found.error(self.expected("a whole number"));
            return None;
        };
        let value = u64::from_str_radix(integer.as_str(), integer.radix()).ok();
        if value.is_none() {
            found.error(self.fault(format!("`{}` is not a whole number from 0 up", integer.as_str())));
        }
        value
    }

    /// The members of an array.
    pub(super) fn array(self, found: &mut Findings) -> Option<Vec<Placed<'t>>> {
        let Some(array) = self.value.as_array() else {
            found.error(self.expected("an array"));
            return None;
        };
        Some(self.members(array))
    }

    fn members(self, array: &'t DeArray<'t>) -> Vec<Placed<'t>> {
        let place = |member: &'t toml::Spanned<DeValue<'t>>| Placed {
            source: self.source,
            value: member.get_ref(),
            at: member.span().start,
        };
        array.iter().map(place).collect()
    }

    /// Exactly `N` finite numbers.
    pub(super) fn numbers<const N: usize>(self, found: &mut Findings) -> Option<[f64; N]> {
        let members = self.array(found)?;
        if members.len() != N {
            found.error(self.fault(format!("expected {N} numbers, found {}", members.len())));
            return None;
        }
        let mut numbers = [0.0; N];
        let mut whole = true;
        for (number, member) in numbers.iter_mut().zip(members) {
            match member.number(found) {
                Some(value) => *number = value,
                None => whole = false,
            }
        }
        whole.then_some(numbers)
    }

    /// Three finite numbers.
    pub(super) fn vector(self, found: &mut Findings) -> Option<DVec3> {
        self.numbers::<3>(found).map(DVec3::from_array)
    }

    /// A list of strings, with their places.
    pub(super) fn texts(self, found: &mut Findings) -> Option<Vec<(&'t str, Placed<'t>)>> {
        let members = self.array(found)?;
        let texts = members
            .into_iter()
            .filter_map(|member| Some((member.text(found)?, member)));
        Some(texts.collect())
    }

    /// A table, to be taken apart in turn.
    pub(super) fn fields(self, found: &mut Findings) -> Option<Fields<'t>> {
        let table = self.table(found)?;
        Some(Fields {
            source: self.source,
            table,
            at: self.at,
            asked: Vec::new(),
        })
    }

    /// A table whose keys are names from elsewhere: key, place of the key, value.
    pub(super) fn entries(self, found: &mut Findings) -> Option<Vec<(&'t str, usize, Placed<'t>)>> {
        let table = self.table(found)?;
        let entry = |(key, value): (&'t toml::Spanned<_>, &'t toml::Spanned<DeValue<'t>>)| {
            let key: &'t toml::Spanned<std::borrow::Cow<'t, str>> = key;
            let value = Placed {
                source: self.source,
                value: value.get_ref(),
                at: value.span().start,
            };
            (key.get_ref().as_ref(), key.span().start, value)
        };
        Some(table.iter().map(entry).collect())
    }

    fn table(self, found: &mut Findings) -> Option<&'t DeTable<'t>> {
        let table = self.value.as_table();
        if table.is_none() {
            found.error(self.expected("a table"));
        }
        table
    }

    /// One of a closed list of words.
    pub(super) fn choice<T: Copy>(self, words: &[(&str, T)], found: &mut Findings) -> Option<T> {
        let text = self.text(found)?;
        let chosen = words
            .iter()
            .find(|(word, _)| *word == text)
            .map(|&(_, value)| value);
        if chosen.is_none() {
            let known: Vec<&str> = words.iter().map(|&(word, _)| word).collect();
            found.error(self.fault(format!("expected one of {}, found `{text}`", known.join(", "))));
        }
        chosen
    }
}

fn article(noun: &str) -> &'static str {
    if noun.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    }
}

/// A string as TOML writes it.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for letter in text.chars() {
        match letter {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            control if control.is_control() => {
                // Writing to a string cannot fail.
                let _ = write!(out, "\\u{:04X}", control as u32);
            }
            plain => out.push(plain),
        }
    }
    out.push('"');
    out
}

/// A key as TOML writes it: bare where it may be.
pub(super) fn key(name: &str) -> String {
    let bare = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
    if !name.is_empty() && name.chars().all(bare) {
        name.to_owned()
    } else {
        quoted(name)
    }
}

/// A vector as TOML writes it, exact.
pub(super) fn vector(v: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}
