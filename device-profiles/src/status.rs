//! How far a profile has been tried; a closed list, so that nobody can write "mostly works".

use serde::{Deserialize, Serialize};

/// What is known about a profile beyond its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// Tried on the real thing, nothing odd found.
    Supported,
    /// Tried on the real thing; the file's comments name what is odd.
    Quirks,
    /// Written from documents, or describes something that was never built.
    Untested,
}

impl Status {
    /// The word as the files have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Supported => "supported",
            Self::Quirks => "quirks",
            Self::Untested => "untested",
        }
    }
}
