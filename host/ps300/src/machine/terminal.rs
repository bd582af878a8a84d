//! The plane of text that ES_TE writes on, as a terminal would.
//!
//! Apart from the panel because a terminal has a cursor and obeys sequences. Source: D0 clears it with ANSI
//! sequences (ECMA-48, cursor position, erase in page, erase in line); its size is the usual one.

/// Lines of the plane.
pub const TERMINAL_LINES: usize = 24;
/// Characters of a line.
pub const TERMINAL_COLUMNS: usize = 80;

/// Lines of text and the place where the next character goes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Terminal {
    /// From the top, as far as anything was written; without spaces at their ends.
    lines: Vec<String>,
    line: usize,
    column: usize,
    reads: Reads,
}

/// What the next character belongs to. Sequences may be cut between two messages.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
enum Reads {
    #[default]
    Text,
    Escape,
    /// Digits and semicolons so far.
    Sequence(String),
}

/// No sequence that is obeyed is longer.
const SEQUENCE_MAX: usize = 16;

impl Terminal {
    /// From the top; there may be fewer than [`TERMINAL_LINES`].
    pub fn lines(&self) -> &[String] {
        &self.lines
    }

    pub(super) fn write(&mut self, text: &str) {
        for c in text.chars() {
            match (&mut self.reads, c) {
                (_, '\u{1b}') => self.reads = Reads::Escape,
                (Reads::Escape, '[') => self.reads = Reads::Sequence(String::new()),
                (Reads::Escape, _) => self.reads = Reads::Text,
                (Reads::Sequence(so_far), '0'..='9' | ';') if so_far.len() < SEQUENCE_MAX => so_far.push(c),
                (Reads::Sequence(so_far), _) => {
                    let numbers = std::mem::take(so_far);
                    self.reads = Reads::Text;
                    self.obey(c, &numbers);
                }
                (Reads::Text, _) => self.put(c),
            }
        }
    }

    fn put(&mut self, c: char) {
        match c {
            '\r' => self.column = 0,
            '\n' => self.next_line(),
            '\u{8}' => self.column = self.column.saturating_sub(1),
            control if control.is_control() => {}
            c => {
                if self.column == TERMINAL_COLUMNS {
                    self.column = 0;
                    self.next_line();
                }
                let column = self.column;
                self.edit(|line| {
                    line.resize(line.len().max(column + 1), ' ');
                    line[column] = c;
                });
                self.column += 1;
            }
        }
    }

    fn next_line(&mut self) {
        if self.line + 1 < TERMINAL_LINES {
            self.line += 1;
        } else if !self.lines.is_empty() {
            self.lines.remove(0);
        }
    }

    /// Changes the line of the cursor, character by character.
    fn edit(&mut self, change: impl FnOnce(&mut Vec<char>)) {
        if self.lines.len() <= self.line {
            self.lines.resize(self.line + 1, String::new());
        }
        if let Some(line) = self.lines.get_mut(self.line) {
            let mut characters = line.chars().collect();
            change(&mut characters);
            let text: String = characters.into_iter().collect();
            text.trim_end().clone_into(line);
        }
        while self.lines.last().is_some_and(String::is_empty) {
            self.lines.pop();
        }
    }

    fn obey(&mut self, what: char, numbers: &str) {
        let mut numbers = numbers
            .split(';')
            .map(|number| number.parse::<usize>().unwrap_or(0));
        let first = numbers.next().unwrap_or(0);
        let column = self.column;
        match (what, first) {
            ('H' | 'f', line) => {
                let place = |number: usize, count: usize| number.clamp(1, count) - 1;
                self.line = place(line, TERMINAL_LINES);
                self.column = place(numbers.next().unwrap_or(1), TERMINAL_COLUMNS);
            }
            ('J', 0) => {
                self.lines.truncate(self.line + 1);
                self.edit(|line| line.truncate(column));
            }
            ('J', 2) => self.lines.clear(),
            ('K', 0) => self.edit(|line| line.truncate(column)),
            ('K', 2) => self.edit(Vec::clear),
            _ => {}
        }
    }
}
