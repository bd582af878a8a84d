//! Names of everything a command can make, connect or show.
//!
//! Source: names begin with a letter and go on with letters, digits, `_` and `$`; a label inside a
//! structure is reached as `structure.label`. That case does not matter, and that a name is shown as it
//! was first written, are this project's rules.

use std::borrow::Borrow;
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
}

/// Text that can be looked up among names as it is.
pub(crate) trait Spelled {
    fn spelling(&self) -> &str;
}

impl Spelled for Name {
    fn spelling(&self) -> &str {
        &self.0
    }
}

impl Spelled for &str {
    fn spelling(&self) -> &str {
        self
    }
}

/// The spelling of a name, whatever it is kept in.
pub(crate) type Spelling<'a> = dyn Spelled + 'a;

impl<'a> Borrow<Spelling<'a>> for Name {
    fn borrow(&self) -> &Spelling<'a> {
        self
    }
}

impl PartialEq for Spelling<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.spelling().eq_ignore_ascii_case(other.spelling())
    }
}
impl Eq for Spelling<'_> {}

impl PartialOrd for Spelling<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Spelling<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        compare(self.spelling(), other.spelling())
    }
}

/// In the order of the bytes, capitals as small letters.
fn compare(a: &str, b: &str) -> Ordering {
    let different = |(x, y): (u8, u8)| {
        let order = x.to_ascii_lowercase().cmp(&y.to_ascii_lowercase());
        (order != Ordering::Equal).then_some(order)
    };
    a.bytes()
        .zip(b.bytes())
        .find_map(different)
        .unwrap_or(a.len().cmp(&b.len()))
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
        compare(&self.0, &other.0)
    }
}

impl Hash for Name {
    fn hash<H: Hasher>(&self, state: &mut H) {
        for byte in self.0.bytes().map(|byte| byte.to_ascii_lowercase()) {
            state.write_u8(byte);
        }
        state.write_u8(0xff); // Not in UTF-8, so names of different lengths stay apart.
    }
}
