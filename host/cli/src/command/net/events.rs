//! What happens to a network that runs, and when: lines `at SECS COMMAND;`, and what devices send.
//!
//! A device has no input, so no command of the language can press a key. `EMIT value FROM name<n>;` does, in files of
//! events only; `--dial` and `--key` are short for the most frequent.

use ps300::Value;
use ps300::language::{self, Command, Definition, Name, Payload, Position};
use ps300::network::{Made, Places};
use rig::document::source::Source;
use rig::document::{FileError, Findings};

use super::run::Watch;
use super::{diagnostics, program};

/// One thing that happens.
#[derive(Clone, Debug)]
pub(super) struct Event {
    /// Network time.
    pub(super) secs: f64,
    /// What.
    pub(super) doing: Doing,
}

/// What happens.
#[derive(Clone, Debug)]
pub(super) enum Doing {
    /// A device sends.
    Emit {
        /// Of the device; it need not be one of those every machine has.
        name: Name,
        /// From 1.
        output: u8,
        /// What leaves it.
        value: Value,
        /// For what is said about it.
        place: Option<FileError>,
    },
    /// A command is given, with its place for what is said about it and about what it makes. Boxed: commands can
    /// be large.
    Command(Box<(Command, FileError, Made)>),
}

impl Event {
    /// Whether it makes something of that name that can send.
    pub(super) fn makes(&self, name: &Name) -> bool {
        let Doing::Command(given) = &self.doing else {
            return false;
        };
        match &given.0 {
            Command::Define {
                name: made,
                definition: Definition::Function { .. },
            } => made == name,
            Command::Variable(made) => made.contains(name),
            _ => false,
        }
    }
}

/// `N:TURNS@SECS`, one message on a dial.
pub(super) fn dial(text: &str) -> Result<Event, String> {
    let form = || "expected N:TURNS@SECS, as in 3:0.25@1.5".to_owned();
    let (number, rest) = text.split_once(':').ok_or_else(form)?;
    let (turns, secs) = rest.split_once('@').ok_or_else(form)?;
    let number: u8 = number.trim().parse().map_err(|_| form())?;
    if !(1..=8).contains(&number) {
        return Err(format!("there are dials 1 to 8, not {number}"));
    }
    Ok(Event {
        secs: crate::number::secs(secs)?,
        doing: Doing::Emit {
            name: Name::new("DIALS"),
            output: number,
            value: crate::number::finite(turns)?.into(),
            place: None,
        },
    })
}

/// `N@SECS`, one key pressed: 1 to 12, with shift 13 to 24, with control 25 to 36.
pub(super) fn key(text: &str) -> Result<Event, String> {
    let form = || "expected N@SECS, as in 3@1.5".to_owned();
    let (number, secs) = text.split_once('@').ok_or_else(form)?;
    let number: i32 = number.trim().parse().map_err(|_| form())?;
    if !(1..=36).contains(&number) {
        return Err(format!("there are keys 1 to 36, not {number}"));
    }
    Ok(Event {
        secs: crate::number::secs(secs)?,
        doing: Doing::Emit {
            name: Name::new("FKEYS"),
            output: 1,
            value: number.into(),
            place: None,
        },
    })
}

/// Reads a file of events; their times must not go back. `#` begins a line that is a comment.
pub(super) fn read(source: &Source, found: &mut Findings) -> Vec<Event> {
    let mut events: Vec<Event> = Vec::new();
    let mut latest_secs = 0.0;
    let places = Places::new(&program::called(source), source.text());
    for (index, line) in source.text().lines().enumerate() {
        let number = index as u32 + 1;
        let trimmed = line.trim();
        if trimmed.is_empty() || trimmed.starts_with('#') {
            continue;
        }
        let Some((secs, secs_column, rest)) = head(line) else {
            let error = source.error_at((number, 1), "expected `at SECS COMMAND;`");
            found.error(error.with_hint("for example: at 0.5 SEND 0.25 TO <1>turn;"));
            continue;
        };
        match crate::number::secs(secs) {
            Ok(secs) if secs >= latest_secs => latest_secs = secs,
            Ok(secs) => {
                let message = format!("{secs} s comes after {latest_secs} s; times do not go back");
                found.error(source.error_at((number, secs_column), message));
            }
            Err(message) => {
                let message = format!("{message}, found `{secs}`");
                found.error(source.error_at((number, secs_column), message));
            }
        }
        let begins = (number, column_of(line, rest));
        if is_emission(rest) {
            events.extend(emission(source, begins, rest, found).map(|doing| Event {
                secs: latest_secs,
                doing,
            }));
            continue;
        }
        let (commands, remarks) = language::parse(rest);
        if commands.is_empty() && remarks.is_empty() {
            found.error(source.error_at(begins, "expected a command after the time"));
        }
        diagnostics::note(source, begins, remarks, found);
        events.extend(commands.into_iter().map(|located| {
            let (line, column) = diagnostics::place(begins, (located.at.line, located.at.column));
            let error = source.error_at((line, column), "");
            let made = places.at(Position { line, column });
            Event {
                secs: latest_secs,
                doing: Doing::Command(Box::new((located.what, error, made))),
            }
        }));
    }
    events
}

/// Whether it is no command but `EMIT …`.
fn is_emission(text: &str) -> bool {
    let word = text.split_whitespace().next().unwrap_or_default();
    word.eq_ignore_ascii_case("EMIT")
}

/// `EMIT value FROM name<n>;`. The value is read as that of a SEND, a word as long, so that columns stay right.
fn emission(source: &Source, begins: (u32, u32), text: &str, found: &mut Findings) -> Option<Doing> {
    let form = source
        .error_at(begins, "expected `EMIT value FROM name<n>;`")
        .with_hint("for example: at 0.5 EMIT FIX(3) FROM FKEYS<1>;");
    let from = text.to_ascii_uppercase().rfind(" FROM ");
    let Some((value, from)) = from.map(|at| (&text[4..at], text[at + 6..].trim())) else {
        found.error(form);
        return None;
    };
    let Ok(Watch { name, output }) = Watch::parse(from.trim_end_matches(';').trim_end()) else {
        found.error(form);
        return None;
    };
    let (commands, remarks) = language::parse(&format!("SEND{value} TO <1>{name};"));
    let sent = commands.into_iter().next().map(|located| located.what);
    diagnostics::note(source, begins, remarks, found);
    let Some(Command::Send {
        payload: Payload::Value(value),
        ..
    }) = sent
    else {
        return None;
    };
    Some(Doing::Emit {
        name,
        output,
        value,
        place: Some(source.error_at(begins, "")),
    })
}

/// The time of a line, its column, and what follows it.
fn head(line: &str) -> Option<(&str, u32, &str)> {
    let start = line.trim_start();
    let rest = start.get(..2).filter(|word| word.eq_ignore_ascii_case("at"));
    let rest = start.get(rest?.len()..)?;
    let after = rest.trim_start();
    if after.len() == rest.len() {
        return None;
    }
    let end = after.find(char::is_whitespace).unwrap_or(after.len());
    let (secs, rest) = after.split_at(end);
    Some((secs, column_of(line, after), rest.trim_start()))
}

/// The column, from 1, at which `part` (a tail of `line`) begins.
fn column_of(line: &str, part: &str) -> u32 {
    let before = line.len() - part.len();
    line[..before].chars().count() as u32 + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn places(text: &str) -> (usize, Vec<(u32, u32)>) {
        let mut found = Findings::default();
        let events = read(&Source::from_text(Path::new("e"), text), &mut found);
        let places = found.errors.iter().map(|error| (error.line, error.column));
        (events.len(), places.collect())
    }

    #[test]
    fn events_are_lines() {
        let text = "# warm up\n\nat 0 SEND 1 TO <1>a;\n  AT 0.5  a := F:NOP;\nat 0.5 SEND 2 TO <1>a;";
        assert_eq!(places(text), (3, vec![]));
    }

    #[test]
    fn faults_have_places() {
        for (text, place) in [
            ("SEND 1 TO <1>a;", (1, 1)),
            ("at x SEND 1 TO <1>a;", (1, 4)),
            ("at -1 SEND 1 TO <1>a;", (1, 4)),
            ("at 1 SEND 1 TO <1>a;\nat 0.5 SEND 1 TO <1>a;", (2, 4)),
            ("at 1", (1, 5)),
        ] {
            assert_eq!(places(text).1, vec![place], "{text}");
        }
        let (_, places) = places("\nat 1 SEND 1 TA <1>a;");
        assert!(
            places
                .first()
                .is_some_and(|&(line, column)| line == 2 && column > 6),
            "{places:?}"
        );
    }

    #[test]
    fn dials_are_numbers() {
        for bad in [
            "", "1", "1:2", "1@2", "0:1@0", "9:1@0", "1:x@0", "1:1@-1", "1:nan@0", "1:1@inf",
        ] {
            assert!(dial(bad).is_err(), "{bad}");
        }
        let event = dial("3:-0.25@1.5").expect("well formed");
        assert_eq!(event.secs, 1.5);
        let turned = Value::from(-0.25);
        assert!(matches!(event.doing, Doing::Emit { output: 3, value, .. } if value == turned));
    }

    #[test]
    fn keys_are_numbers() {
        for bad in ["", "1", "0@1", "37@1", "1.5@1", "1@-1"] {
            assert!(key(bad).is_err(), "{bad}");
        }
        let event = key("36@0.5").expect("well formed");
        let pressed = Value::from(36);
        assert!(matches!(event.doing, Doing::Emit { output: 1, value, .. } if value == pressed));
    }

    #[test]
    fn devices_send_in_events() {
        for (text, place) in [
            ("at 1 EMIT FIX(3)", (1, 6)),
            ("at 1 EMIT FIX(3) FROM FKEYS;", (1, 6)),
            ("at 1 EMIT FIX( FROM FKEYS<1>;", (1, 16)),
        ] {
            assert_eq!(places(text), (0, vec![place]), "{text}");
        }
        let text = "at 1 EMIT FIX(3) FROM FKEYS<1>;\nat 1 emit ' from ' from KEYBOARD<1>;";
        assert_eq!(places(text), (2, vec![]));
    }
}
