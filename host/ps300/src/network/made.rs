//! Which command made something, so that trouble can be traced to the text.

use std::cell::Cell;
use std::fmt;
use std::sync::Arc;

use crate::language::Position;

/// A command in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Made {
    /// What the text is called, usually its file; empty if it has no name.
    pub source: Arc<str>,
    /// From 1.
    pub line: u32,
    /// The command as written, as far as its first line goes.
    pub text: Arc<str>,
}

impl fmt::Display for Made {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.source.is_empty() {
            write!(f, "line {} \"{}\"", self.line, self.text)
        } else {
            write!(f, "{}:{} \"{}\"", self.source, self.line, self.text)
        }
    }
}

/// Enough to recognise a command by.
const CHARACTERS_MAX: usize = 60;

/// A text in which commands are found by their position.
pub struct Places<'a> {
    source: Arc<str>,
    lines: Vec<&'a str>,
    /// Where the last command was found, with its byte in the line: a text may be one long line.
    last: Cell<(Position, usize)>,
}

impl<'a> Places<'a> {
    /// Of the text called `source`.
    pub fn new(source: &str, text: &'a str) -> Self {
        Self {
            source: source.into(),
            lines: text.lines().collect(),
            last: Cell::new((Position { line: 0, column: 1 }, 0)),
        }
    }

    /// The command that begins there.
    pub fn at(&self, at: Position) -> Made {
        let whole = self.lines.get((at.line as usize).wrapping_sub(1)).copied();
        let rest = self.rest_of(whole.unwrap_or_default(), at);
        let mut text = String::new();
        for (count, character) in rest.chars().enumerate() {
            if count == CHARACTERS_MAX {
                text.push('…');
                break;
            }
            text.push(character);
            if character == ';' {
                break;
            }
        }
        text.truncate(text.trim_end().len());
        Made {
            source: self.source.clone(),
            line: at.line,
            text: text.into(),
        }
    }

    /// The rest of a line, counted on from the command before if that is on the same.
    fn rest_of(&self, line: &'a str, at: Position) -> &'a str {
        let (last, byte) = self.last.get();
        let on = last.line == at.line && last.column <= at.column;
        let (column, byte) = if on { (last.column, byte) } else { (1, 0) };
        let rest = line.get(byte..).unwrap_or_default();
        let skipped = rest.char_indices().nth(at.column.saturating_sub(column) as usize);
        let further = skipped.map_or(rest.len(), |(further, _)| further);
        self.last.set((at, byte + further));
        rest.get(further..).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_cut_out_of_their_text() {
        let long = format!("n := {};", "x".repeat(100));
        let text = format!("a := F:NOP; b := F:ADD;\n  s := BEGIN_STRUCTURE  \n{long}");
        let places = Places::new("dials.ps300", &text);
        let made = |line, column| places.at(Position { line, column }).to_string();
        assert_eq!(made(1, 1), "dials.ps300:1 \"a := F:NOP;\"");
        assert_eq!(made(1, 13), "dials.ps300:1 \"b := F:ADD;\"");
        assert_eq!(made(1, 13), made(1, 13));
        assert_eq!(made(1, 1), "dials.ps300:1 \"a := F:NOP;\"");
        assert_eq!(made(2, 3), "dials.ps300:2 \"s := BEGIN_STRUCTURE\"");
        assert_eq!(made(3, 1), format!("dials.ps300:3 \"{}…\"", &long[..60]));
        assert_eq!(made(9, 9), "dials.ps300:9 \"\"");
        assert_eq!(
            Places::new("", "x")
                .at(Position { line: 1, column: 1 })
                .to_string(),
            "line 1 \"x\""
        );
    }
}
