//! The smallest parts of a command.

use super::Position;

/// What a token is. Text and numbers stay as written until somebody wants their value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind<'s> {
    /// A keyword, a name, or names joined by dots: which of them, the place decides.
    Word(&'s str),
    /// With its sign; not yet checked to be in range.
    Number(&'s str),
    /// What is between the quotes, a doubled quote still doubled, and the quote used.
    Text(&'s str, char),
    /// Punctuation of the language.
    Mark(Mark),
    /// A character the language has no use for.
    Stray(char),
    /// Something that was never closed; already reported.
    Broken,
    /// The end of the source.
    End,
}

/// Punctuation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    Assign,
    Colon,
    Semicolon,
    Comma,
    Less,
    Greater,
    Open,
    Close,
    Equals,
    Star,
    OpenBracket,
    CloseBracket,
    Bang,
}

impl Mark {
    pub(super) fn as_str(self) -> &'static str {
        match self {
            Self::Assign => ":=",
            Self::Colon => ":",
            Self::Semicolon => ";",
            Self::Comma => ",",
            Self::Less => "<",
            Self::Greater => ">",
            Self::Open => "(",
            Self::Close => ")",
            Self::Equals => "=",
            Self::Star => "*",
            Self::OpenBracket => "[",
            Self::CloseBracket => "]",
            Self::Bang => "!",
        }
    }
}

/// A token and where it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'s> {
    pub(super) kind: TokenKind<'s>,
    pub(super) at: Position,
    /// Directly after the last character.
    pub(super) end: Position,
    /// Nothing but blanks and comments stands before it on its line.
    pub(super) first_on_line: bool,
}

/// Longer words and texts are cut in messages.
const SHOWN_CHARACTERS_MAX: usize = 40;

impl TokenKind<'_> {
    /// How a message names it.
    pub(super) fn describe(self) -> String {
        match self {
            Self::Word(word) => format!("`{}`", cut(word)),
            Self::Number(digits) => format!("the number {}", cut(digits)),
            Self::Text(text, quote) => format!("the text {quote}{}{quote}", cut(text)),
            Self::Mark(mark) => format!("`{}`", mark.as_str()),
            Self::Stray(character) => format!("the character {character:?}"),
            Self::Broken => "something unclosed".to_owned(),
            Self::End => "the end of the text".to_owned(),
        }
    }
}

/// The beginning of `text`, with an ellipsis where something was left out.
pub(super) fn cut(text: &str) -> String {
    match text.char_indices().nth(SHOWN_CHARACTERS_MAX) {
        Some((index, _)) => format!("{}…", &text[..index]),
        None => text.to_owned(),
    }
}
