//! Text to profile, with the place of every complaint.

use crate::profiles::Kind;
use crate::{InputProfile, Layout, ProfileError, Profiles, PuppetProfile, ServoProfile};
use serde::de::DeserializeOwned;
use std::path::Path;

/// A contradiction inside one profile, and what to look for in the text to point at it.
pub(crate) struct Flaw {
    needle: Needle,
    message: String,
}

enum Needle {
    /// First line that begins with this key.
    Key(&'static str),
    /// The n-th line that is this table header.
    Header(&'static str, usize),
    /// First occurrence of this text.
    Text(String),
    /// The n-th occurrence of this text.
    Nth(String, usize),
}

impl Flaw {
    pub(crate) fn at_key(key: &'static str, message: impl Into<String>) -> Self {
        Self {
            needle: Needle::Key(key),
            message: message.into(),
        }
    }

    pub(crate) fn at_header(header: &'static str, nth: usize, message: impl Into<String>) -> Self {
        Self {
            needle: Needle::Header(header, nth),
            message: message.into(),
        }
    }

    pub(crate) fn at_text(text: String, message: impl Into<String>) -> Self {
        Self {
            needle: Needle::Text(text),
            message: message.into(),
        }
    }

    pub(crate) fn at_nth(text: String, nth: usize, message: impl Into<String>) -> Self {
        Self {
            needle: Needle::Nth(text, nth),
            message: message.into(),
        }
    }

    pub(crate) fn message(&self) -> &str {
        &self.message
    }

    fn offset(&self, text: &str) -> usize {
        let mut lines = text.split_inclusive('\n').scan(0, |at, line| {
            let start = *at;
            *at += line.len();
            Some((start, line.trim()))
        });
        let found = match &self.needle {
            Needle::Key(key) => lines.find(|(_, line)| line.starts_with(key)).map(|(at, _)| at),
            Needle::Header(header, nth) => lines
                .filter(|(_, line)| line == header)
                .nth(*nth)
                .map(|(at, _)| at),
            Needle::Text(needle) => text.find(needle.as_str()),
            Needle::Nth(needle, nth) => text.match_indices(needle.as_str()).nth(*nth).map(|(at, _)| at),
        };
        found.unwrap_or(0)
    }
}

/// What a profile says about itself beyond its shape.
pub(crate) trait Check {
    /// Appends every contradiction, not only the first.
    fn flaws(&self, flaws: &mut Vec<Flaw>);
}

/// Reads one file, of whatever kind it is, and says everything that is wrong with it in itself.
/// Its name without the ending becomes the key.
pub fn read_file(path: &Path) -> Result<Kind, Vec<ProfileError>> {
    let text = text_of(path)?;
    parse(&path.display().to_string(), &key_of(path), &text)
}

/// Reads one file and says also what keeps it from working with the profiles there are: a puppet with servos
/// that nobody knows, that cannot reach what it asks, or that cannot speak as fast as its bus; an input device
/// whose layout is not there. The layout of one that has one is in it.
pub fn read_file_among(path: &Path, others: &Profiles) -> Result<Kind, Vec<ProfileError>> {
    let text = text_of(path)?;
    let file = path.display().to_string();
    let profile = parse(&file, &key_of(path), &text)?;
    fitting(&file, &text, &profile, others)?;
    Ok(others.resolved(profile))
}

/// Whether a puppet and its servos, or an input device and its layout, fit; `text` is the profile's, for the
/// places of what does not.
pub(crate) fn fitting(
    file: &str,
    text: &str,
    profile: &Kind,
    others: &Profiles,
) -> Result<(), Vec<ProfileError>> {
    let misfits = match profile {
        Kind::Puppet(puppet) => crate::puppet::misfits(puppet, others),
        Kind::Input(input) => match input.reports(others) {
            Ok(_) => Vec::new(),
            Err(absent) => vec![Flaw::at_key("layout", absent.to_string())],
        },
        Kind::Servo(_) | Kind::Layout(_) => Vec::new(),
    };
    contradictions(file, text, &misfits)
}

pub(crate) fn text_of(path: &Path) -> Result<String, Vec<ProfileError>> {
    std::fs::read_to_string(path).map_err(|e| {
        vec![ProfileError::Unreadable {
            path: path.to_owned(),
            why: e.to_string(),
        }]
    })
}

/// A file's name without its ending, in lower case.
pub(crate) fn key_of(path: &Path) -> String {
    path.file_stem()
        .map(|s| s.to_string_lossy().to_lowercase())
        .unwrap_or_default()
}

pub(crate) fn parse(file: &str, key: &str, text: &str) -> Result<Kind, Vec<ProfileError>> {
    let table: toml::Table = text.parse().map_err(|e| vec![syntax(file, text, &e)])?;
    let has = |key: &str| table.contains_key(key);
    if has("registers") {
        let profile: ServoProfile = typed(file, text)?;
        Ok(Kind::Servo(Box::new(ServoProfile {
            key: key.to_owned(),
            ..profile
        })))
    } else if has("group") {
        let profile: PuppetProfile = typed(file, text)?;
        Ok(Kind::Puppet(Box::new(PuppetProfile {
            key: key.to_owned(),
            ..profile
        })))
    } else if has("kind") {
        let profile: InputProfile = typed(file, text)?;
        Ok(Kind::Input(Box::new(InputProfile {
            key: key.to_owned(),
            ..profile
        })))
    } else if has("report") {
        let layout: Layout = typed(file, text)?;
        Ok(Kind::Layout(Box::new(Layout {
            key: key.to_owned(),
            ..layout
        })))
    } else {
        Err(vec![ProfileError::UnknownKind {
            file: file.to_owned(),
        }])
    }
}

fn typed<P: DeserializeOwned + Check>(file: &str, text: &str) -> Result<P, Vec<ProfileError>> {
    let profile: P = toml::from_str(text).map_err(|e| vec![syntax(file, text, &e)])?;
    let mut flaws = Vec::new();
    profile.flaws(&mut flaws);
    contradictions(file, text, &flaws).map(|()| profile)
}

/// Every flaw as an error with its place; none is well.
fn contradictions(file: &str, text: &str, flaws: &[Flaw]) -> Result<(), Vec<ProfileError>> {
    if flaws.is_empty() {
        return Ok(());
    }
    let errors = flaws.iter().map(|flaw| {
        let (line, column) = line_and_column(text, flaw.offset(text));
        ProfileError::Contradiction {
            file: file.to_owned(),
            line,
            column,
            message: flaw.message.clone(),
        }
    });
    Err(errors.collect())
}

fn syntax(file: &str, text: &str, error: &toml::de::Error) -> ProfileError {
    let (line, column) = line_and_column(text, error.span().map_or(0, |s| s.start));
    ProfileError::Syntax {
        file: file.to_owned(),
        line,
        column,
        message: error.message().to_owned(),
    }
}

/// Both from 1, the column in characters.
fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    (line, column)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_from_one_in_characters() {
        for (text, offset, want) in [
            ("", 0, (1, 1)),
            ("ab", 1, (1, 2)),
            ("a\nb", 2, (2, 1)),
            ("é\né!", 5, (2, 2)),
            ("a", 99, (1, 2)),
        ] {
            assert_eq!(line_and_column(text, offset), want, "{text:?} at {offset}");
        }
    }
}
