//! Names of everything a command can make, connect or show.
//!
//! Source: names begin with a letter and go on with letters, digits, `_` and `$`; a label inside a
//! structure is reached as `structure.label`. That case does not matter, and that a name is shown as it
//! was first written, are this project's rules.

use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// A name as written. Two names are equal if they differ in the case of ASCII letters only, so a map
/// keyed by `Name` keeps the spelling it was first given.
#[derive(Clone, Debug)]
pub struct Name(Arc<str>);

impl Name {
    /// More characters than this are legal but warned of, as the host library of the PS 300 did.
    pub const LENGTH_MAX: usize = 240;

    /// Takes `text` as a name without judging it; see [`Name::is_valid`] for text from outside.
    pub fn new(text: &str) -> Self {
        Self(text.into())
    }

    /// The spelling given.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Whether `text` reads back as one name: parts joined by dots, each a letter followed by letters,
    /// digits, `_` or `$`.
    pub fn is_valid(text: &str) -> bool {
        text.split('.').all(|part| {
            let mut characters = part.chars();
            characters.next().is_some_and(Self::starts) && characters.all(Self::continues)
        })
    }

    /// The part before the first dot and the rest, for `structure.label`.
    pub fn split_structure(&self) -> Option<(&str, &str)> {
        self.0.split_once('.')
    }

    pub(crate) fn starts(character: char) -> bool {
        character.is_alphabetic()
    }

    pub(crate) fn continues(character: char) -> bool {
        character.is_alphanumeric() || character == '_' || character == '$'
    }

    fn folded(&self) -> impl Iterator<Item = u8> {
        self.0.bytes().map(|byte| byte.to_ascii_lowercase())
    }
}

impl From<&str> for Name {
    fn from(text: &str) -> Self {
        Self::new(text)
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl PartialEq for Name {
    fn eq(&self, other: &Self) -> bool {
        self.0.eq_ignore_ascii_case(&other.0)
    }
}
impl Eq for Name {}

impl PartialOrd for Name {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Name {
    fn cmp(&self, other: &Self) -> Ordering {
        self.folded().cmp(other.folded())
    }
}

impl Hash for Name {
    fn hash<H: Hasher>(&self, state: &mut H) {
        for byte in self.folded() {
            state.write_u8(byte);
        }
        state.write_u8(0xff); // Not in UTF-8, so names of different lengths stay apart.
    }
}
