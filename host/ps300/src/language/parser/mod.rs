//! Tokens to commands. Reading never fails: what cannot be understood is reported and passed over.
//!
//! This file has the reading of single tokens, and recovery; the grammar is in the files beside it,
//! one function a form. Recovery is at the next `;`, or before a line that begins with `name :=`, so
//! that one forgotten semicolon costs one command.

mod attribute;
mod characters;
mod curve;
mod definition;
mod face;
mod literal;
mod operation;
mod statement;
mod vectors;
mod viewing;

use super::lexer::Lexer;
use super::reports::Reports;
use super::token::{Mark, Token, TokenKind};
use super::words::{self, Word};
use super::{Command, Diagnostic, Located, Name, Position};

/// Reads a whole text: the commands understood, in order, and what there is to say about the text.
/// Never fails, and neither time nor memory grows faster than the text.
///
/// ```
/// let (commands, diagnostics) = ps300::language::parse("line := set color 60,1 then linel;");
/// assert_eq!(commands.len(), 1);
/// assert!(diagnostics.is_empty());
/// ```
pub fn parse(source: &str) -> (Vec<Located<Command>>, Vec<Diagnostic>) {
    let mut parser = Parser::new(source);
    let mut commands = Vec::new();
    while parser.current.kind != TokenKind::End {
        if parser.accept(Mark::Semicolon) {
            continue;
        }
        let at = parser.current.at;
        let taken = parser.taken;
        match parser.command().and_then(|command| parser.ended(command)) {
            Ok(what) => commands.push(Located { at, what }),
            Err(fault) => parser.recover(fault, taken),
        }
    }
    (commands, parser.reports.finish())
}

/// Why a form was given up.
enum Fault {
    /// To be reported.
    Found(Box<Diagnostic>),
    /// Already reported by the lexer or deeper in the grammar.
    Reported,
    /// As `Found`, but the text goes on well at the current token.
    Unfinished(Box<Diagnostic>),
}

impl From<Diagnostic> for Fault {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Found(Box::new(diagnostic))
    }
}

type Parsed<T> = Result<T, Fault>;

struct Parser<'s> {
    lexer: Lexer<'s>,
    current: Token<'s>,
    following: Token<'s>,
    /// The end of the token before `current`.
    end: Position,
    /// Tokens passed, to see progress.
    taken: usize,
    /// Structures open around the current token.
    depth: usize,
    reports: Reports,
}

impl<'s> Parser<'s> {
    fn new(source: &'s str) -> Self {
        let mut lexer = Lexer::new(source);
        let mut reports = Reports::default();
        let current = lexer.next(&mut reports);
        let following = lexer.next(&mut reports);
        Self {
            lexer,
            current,
            following,
            end: current.at,
            taken: 0,
            depth: 0,
            reports,
        }
    }

    fn advance(&mut self) {
        self.end = self.current.end;
        self.current = self.following;
        self.following = self.lexer.next(&mut self.reports);
        self.taken += 1;
    }

    /// The fault of finding something else than `expected` here.
    fn unexpected(&self, expected: impl Into<String>) -> Fault {
        if self.current.kind == TokenKind::Broken {
            return Fault::Reported;
        }
        let message = format!("found {}", self.current.kind.describe());
        Diagnostic::error(self.current.at, message)
            .expecting(expected)
            .into()
    }

    /// As `unexpected`, for a place where one of some keywords belongs.
    fn unknown_word(&self, expected: impl Into<String>, known: &[Word]) -> Fault {
        match (self.unexpected(expected), self.current.kind) {
            (Fault::Found(mut diagnostic), TokenKind::Word(word)) if !self.reports.is_full() => {
                diagnostic.hint = words::hint(word, known);
                Fault::Found(diagnostic)
            }
            (fault, _) => fault,
        }
    }

    fn is(&self, mark: Mark) -> bool {
        self.current.kind == TokenKind::Mark(mark)
    }

    fn accept(&mut self, mark: Mark) -> bool {
        let found = self.is(mark);
        if found {
            self.advance();
        }
        found
    }

    fn expect(&mut self, mark: Mark) -> Parsed<()> {
        if self.accept(mark) {
            Ok(())
        } else {
            Err(self.unexpected(format!("`{}`", mark.as_str())))
        }
    }

    fn is_word(&self, word: Word) -> bool {
        matches!(self.current.kind, TokenKind::Word(written) if word.matches(written))
    }

    /// Whether `word` stands here and `mark` directly after it.
    fn is_word_before(&self, word: Word, mark: Mark) -> bool {
        self.is_word(word) && self.following.kind == TokenKind::Mark(mark)
    }

    /// Whether `word` stands here and one of `next` directly after it.
    fn is_word_before_one_of(&self, word: Word, next: &[Word]) -> bool {
        let TokenKind::Word(following) = self.following.kind else {
            return false;
        };
        self.is_word(word) && next.iter().any(|next| next.matches(following))
    }

    /// Passes `word=`, if that stands here.
    fn accept_word_equals(&mut self, word: Word) -> bool {
        let found = self.is_word_before(word, Mark::Equals);
        if found {
            self.advance();
            self.advance();
        }
        found
    }

    /// Passes a mark such as P, which a number must follow: on a line by itself it may be a name.
    fn accept_word_before_number(&mut self, word: Word) -> bool {
        let found = self.is_word(word) && matches!(self.following.kind, TokenKind::Number(_));
        if found {
            self.advance();
        }
        found
    }

    fn accept_word(&mut self, word: Word) -> bool {
        let found = self.is_word(word);
        if found {
            self.advance();
        }
        found
    }

    /// Passes a filler word, unless what follows shows that it is itself the name wanted.
    fn skip_word_before_name(&mut self, word: Word) {
        if self.is_word(word) && matches!(self.following.kind, TokenKind::Word(_)) {
            self.advance();
        }
    }

    fn expect_word(&mut self, word: Word) -> Parsed<()> {
        if self.accept_word(word) {
            Ok(())
        } else {
            Err(self.unknown_word(word.full, &[word]))
        }
    }

    /// One of several words, as the value beside it.
    fn one_of<T: Copy>(&mut self, choices: &[(Word, T)]) -> Parsed<T> {
        if let Some(&(_, value)) = choices.iter().find(|(word, _)| self.is_word(*word)) {
            self.advance();
            return Ok(value);
        }
        let known: Vec<Word> = choices.iter().map(|&(word, _)| word).collect();
        Err(self.unknown_word(words::listed(&known), &known))
    }

    fn name(&mut self, what: &str) -> Parsed<Name> {
        let TokenKind::Word(word) = self.current.kind else {
            return Err(self.unexpected(what));
        };
        self.advance();
        Ok(Name::new(word))
    }

    /// One or more names with commas between them.
    fn names(&mut self, what: &str) -> Parsed<Vec<Name>> {
        let mut names = vec![self.name(what)?];
        while self.accept(Mark::Comma) {
            names.push(self.name(what)?);
        }
        Ok(names)
    }

    /// The command, once its semicolon is passed; BEGIN need have none.
    fn ended(&mut self, command: Command) -> Parsed<Command> {
        if command == Command::BeginGroup {
            self.accept(Mark::Semicolon);
        } else {
            self.finish()?;
        }
        Ok(command)
    }

    /// The semicolon after a command or a member.
    fn finish(&mut self) -> Parsed<()> {
        if self.accept(Mark::Semicolon) {
            return Ok(());
        }
        if self.current.first_on_line && self.current.kind != TokenKind::Broken
            || self.current.kind == TokenKind::End
        {
            let diagnostic = Diagnostic::error(self.end, "this command is not ended")
                .expecting("`;`")
                .hinting("every command ends with a semicolon");
            return Err(Fault::Unfinished(Box::new(diagnostic)));
        }
        Err(self.unexpected("`;`"))
    }

    /// Reports `fault` and passes what is left of the command that began when `taken` tokens had been read.
    fn recover(&mut self, fault: Fault, taken: usize) {
        match fault {
            Fault::Found(diagnostic) => self.reports.push(*diagnostic),
            Fault::Reported => {}
            Fault::Unfinished(diagnostic) => {
                self.reports.push(*diagnostic);
                return; // Something was read before the semicolon was missed: there is progress.
            }
        }
        while self.current.kind != TokenKind::End {
            if self.taken > taken && self.begins_afresh() {
                return;
            }
            if self.accept(Mark::Semicolon) {
                return;
            }
            self.advance();
        }
    }

    /// Whether a line begins here that can only be a new definition or the end of a structure.
    fn begins_afresh(&self) -> bool {
        let TokenKind::Word(word) = self.current.kind else {
            return false;
        };
        self.current.first_on_line
            && (self.following.kind == TokenKind::Mark(Mark::Assign) || words::END_STRUCTURE.matches(word))
    }
}
