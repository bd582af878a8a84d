//! How a command ends: exit codes, and the errors that lead to them.
//!
//! The numbers are a promise to scripts; `dialrig --help` lists them.

use std::io;
use std::process::ExitCode;

use rig::document::{FileError, FileErrors};

/// How a command ended; clap itself ends wrong usage with 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// Done.
    Done = 0,
    /// The input was read and refused, or a check failed.
    Refused = 1,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Why a command could not be done.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Places in files.
    Files(FileErrors),
    /// Anything else, with advice where there is some.
    Refused {
        /// What was expected and what came.
        message: String,
        /// What a person can do.
        hint: Option<String>,
    },
    /// Standard output took no more.
    Output(io::Error),
}

impl Failure {
    /// A failure that has no place in a file.
    pub(crate) fn refused(message: impl Into<String>) -> Self {
        Self::Refused {
            message: message.into(),
            hint: None,
        }
    }

    /// The same with advice. Places in files keep their own.
    #[must_use]
    pub(crate) fn with_hint(mut self, advice: impl Into<String>) -> Self {
        if let Self::Refused { hint, .. } = &mut self {
            *hint = Some(advice.into());
        }
        self
    }

    /// Ended by Ctrl-C before all was done.
    pub(crate) fn interrupted() -> Self {
        Self::refused("interrupted; what is written up to here is whole")
    }
}

impl From<FileErrors> for Failure {
    fn from(errors: FileErrors) -> Self {
        Self::Files(errors)
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::Files(error.into())
    }
}
