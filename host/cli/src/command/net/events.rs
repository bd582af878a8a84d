//! What happens to a network that runs, and when: lines `at SECS COMMAND;` and dials turned.

use ps300::language::{self, Command, Definition, Name};
use rig::document::source::Source;
use rig::document::{FileError, Findings};

use super::diagnostics;

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
    /// A dial is turned.
    Dial {
        /// From 1.
        number: u8,
        /// Full turns.
        turns: f64,
    },
    /// A command is given, with its place for what is said about it. Boxed: commands can be large.
    Command(Box<(Command, FileError)>),
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
        doing: Doing::Dial {
            number,
            turns: crate::number::finite(turns)?,
        },
    })
}

/// Reads a file of events; their times must not go back. `#` begins a line that is a comment.
pub(super) fn read(source: &Source, found: &mut Findings) -> Vec<Event> {
    let mut events: Vec<Event> = Vec::new();
    let mut latest_secs = 0.0;
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
        let (commands, remarks) = language::parse(rest);
        if commands.is_empty() && remarks.is_empty() {
            found.error(source.error_at(begins, "expected a command after the time"));
        }
        diagnostics::note(source, begins, remarks, found);
        events.extend(commands.into_iter().map(|located| {
            let place = diagnostics::place(begins, (located.at.line, located.at.column));
            Event {
                secs: latest_secs,
                doing: Doing::Command(Box::new((located.what, source.error_at(place, "")))),
            }
        }));
    }
    events
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
        assert!(matches!(event.doing, Doing::Dial { number: 3, turns } if turns == -0.25));
    }
}
