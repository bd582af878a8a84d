//! Source text to tokens, one at a time, so that memory does not grow with the text.
//!
//! Decisions where the record is silent: comments do not nest, the first `}` ends one; quoted text ends
//! on its line; a double quote works like a single one; a sign belongs to the number that follows it
//! directly.

use super::reports::Reports;
use super::token::{Mark, Token, TokenKind, cut};
use super::{Diagnostic, Name, Position};

pub(super) struct Lexer<'s> {
    rest: &'s str,
    at: Position,
    /// Whether a token was already given out on the current line.
    line_used: bool,
    /// Text broken off by the end of its line hid a semicolon, which still ends the command.
    owed_semicolon: bool,
}

impl<'s> Lexer<'s> {
    pub(super) fn new(source: &'s str) -> Self {
        let rest = source.strip_prefix('\u{feff}').unwrap_or(source); // Editors put a byte order mark there.
        Self {
            rest,
            at: Position { line: 1, column: 1 },
            line_used: false,
            owed_semicolon: false,
        }
    }

    /// The next token; `End` again and again after the last.
    pub(super) fn next(&mut self, reports: &mut Reports) -> Token<'s> {
        if std::mem::take(&mut self.owed_semicolon) {
            return Token {
                kind: TokenKind::Mark(Mark::Semicolon),
                at: self.at,
                end: self.at,
                first_on_line: false,
            };
        }
        let closed = self.skip_blanks(reports);
        let at = self.at;
        let first_on_line = !self.line_used;
        let kind = if closed {
            self.kind(reports)
        } else {
            TokenKind::Broken
        };
        self.line_used = true;
        Token {
            kind,
            at,
            end: self.at,
            first_on_line,
        }
    }

    fn kind(&mut self, reports: &mut Reports) -> TokenKind<'s> {
        let Some(first) = self.rest.chars().next() else {
            return TokenKind::End;
        };
        if Name::starts(first) {
            return TokenKind::Word(self.word(reports));
        }
        if let Some(length) = number_length(self.rest) {
            return TokenKind::Number(self.take(length));
        }
        if first == '\'' || first == '"' {
            return self.text(first, reports);
        }
        let mark = match first {
            ':' if self.rest.starts_with(":=") => Mark::Assign,
            ':' => Mark::Colon,
            ';' => Mark::Semicolon,
            ',' => Mark::Comma,
            '<' => Mark::Less,
            '>' => Mark::Greater,
            '(' => Mark::Open,
            ')' => Mark::Close,
            '=' => Mark::Equals,
            '*' => Mark::Star,
            '[' => Mark::OpenBracket,
            ']' => Mark::CloseBracket,
            '!' => Mark::Bang,
            _ => {
                self.take(first.len_utf8());
                return TokenKind::Stray(first);
            }
        };
        self.take(mark.as_str().len());
        TokenKind::Mark(mark)
    }

    /// Passes blanks and comments; false where a comment is never closed.
    fn skip_blanks(&mut self, reports: &mut Reports) -> bool {
        loop {
            let blank = self
                .rest
                .find(|c: char| !c.is_whitespace())
                .unwrap_or(self.rest.len());
            self.take(blank);
            if !self.rest.starts_with('{') {
                return true;
            }
            if let Some(end) = self.rest.find('}') {
                self.take(end + 1);
            } else {
                reports.push(
                    Diagnostic::error(self.at, "this comment is never closed")
                        .expecting("`}`")
                        .hinting("everything after it was skipped"),
                );
                self.take(self.rest.len());
                return false;
            }
        }
    }

    fn word(&mut self, reports: &mut Reports) -> &'s str {
        let at = self.at;
        let mut length = 0;
        loop {
            let part = &self.rest[length..];
            length += part.find(|c| !Name::continues(c)).unwrap_or(part.len());
            // A dot joins a structure and a label only if a letter follows directly.
            let joined = self.rest[length..]
                .strip_prefix('.')
                .is_some_and(|after| after.starts_with(Name::starts));
            if !joined {
                break;
            }
            length += 1;
        }
        let word = self.take(length);
        let characters = word.chars().count();
        if characters > Name::LENGTH_MAX {
            let message = format!("the name `{}` has {characters} characters", cut(word));
            let expected = format!("{} characters at most", Name::LENGTH_MAX);
            reports.push(Diagnostic::warning(at, message).expecting(expected));
        }
        word
    }

    fn text(&mut self, quote: char, reports: &mut Reports) -> TokenKind<'s> {
        let at = self.at;
        let mut length = 1;
        loop {
            // Not the whole line first: a long line of many texts would be searched again for each.
            let found = self.rest[length..].find([quote, '\n']);
            let Some(found) = found.filter(|&found| self.rest[length + found..].starts_with(quote)) else {
                let line_length = found.map_or(self.rest.len(), |found| length + found);
                self.owed_semicolon = self.rest[..line_length].contains(';');
                self.take(line_length);
                reports.push(
                    Diagnostic::error(at, "this text is not closed on its line")
                        .expecting(format!("`{quote}`"))
                        .hinting("write CHAR(10) for a line end inside text"),
                );
                return TokenKind::Broken;
            };
            length += found + 1;
            if !self.rest[length..].starts_with(quote) {
                break;
            }
            length += 1; // A doubled quote stands for one.
        }
        let quoted = self.take(length);
        TokenKind::Text(&quoted[1..length - 1], quote)
    }

    /// Passes `length` bytes and counts lines and characters in them.
    fn take(&mut self, length: usize) -> &'s str {
        let (taken, rest) = self.rest.split_at(length);
        self.rest = rest;
        for character in taken.chars() {
            if character == '\n' {
                self.at = Position {
                    line: self.at.line.saturating_add(1),
                    column: 1,
                };
                self.line_used = false;
            } else {
                self.at.column = self.at.column.saturating_add(1);
            }
        }
        taken
    }
}

/// The bytes of the number `text` begins with: sign, digits with at most one point, exponent.
fn number_length(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        bytes[from..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count()
    };
    let is = |index: usize, wanted: &[u8]| bytes.get(index).is_some_and(|byte| wanted.contains(byte));

    let mut length = usize::from(is(0, b"+-"));
    let whole = digits(length);
    length += whole;
    if is(length, b".") {
        let fraction = digits(length + 1);
        if whole + fraction == 0 {
            return None;
        }
        length += 1 + fraction;
    } else if whole == 0 {
        return None;
    }
    if is(length, b"eE") {
        let sign = usize::from(is(length + 1, b"+-"));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    Some(length)
}
