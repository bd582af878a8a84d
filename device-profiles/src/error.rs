//! What can be wrong with a profile, said so that the file's author can mend it.

use std::path::PathBuf;

/// A profile that could not be read, or was asked for and does not exist.
#[derive(Debug, thiserror::Error)]
pub enum ProfileError {
    /// The text is not TOML, or not of the kind's shape (missing, unknown or ill-typed key).
    #[error("{file}:{line}:{column}: error: {message}")]
    Syntax {
        /// Path as it was given.
        file: String,
        /// From 1.
        line: usize,
        /// From 1, in characters.
        column: usize,
        /// What was expected and what came.
        message: String,
    },
    /// The shape is right and the contents contradict themselves or another profile.
    #[error("{file}:{line}:{column}: error: {message}")]
    Contradiction {
        /// Path as it was given.
        file: String,
        /// From 1; of the table or row that is wrong.
        line: usize,
        /// From 1, in characters.
        column: usize,
        /// What was expected and what came.
        message: String,
    },
    /// The file or folder could not be read at all.
    #[error("{path}: error: cannot be read: {why}; check that it exists and that you may read it", path = path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The system's words.
        why: String,
    },
    /// The file has none of the tables by which a kind is recognised.
    #[error(
        "{file}:1:1: error: not a profile: expected `registers` (servo), `[[group]]` (puppet), `kind` (input device) or `[[report]]` (layout)"
    )]
    UnknownKind {
        /// Path as it was given.
        file: String,
    },
    /// Nothing bears this name.
    #[error("there is no {kind} profile named \"{name}\"; there are: {known}")]
    Absent {
        /// servo, puppet, input device or layout.
        kind: &'static str,
        /// What was asked for.
        name: String,
        /// All that exist, separated by commas.
        known: String,
    },
}
