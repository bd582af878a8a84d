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
    /// A device or bus fault ended it; the safe state was reached.
    FaultSafe = 3,
    /// A device or bus fault ended it; the safe state could not be confirmed.
    FaultUnconfirmed = 4,
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
    /// A device or bus fault.
    Device {
        /// What happened, where, and what to do.
        message: String,
        /// Whether torque is known to be off, or nothing had any.
        safe: bool,
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

    /// A device or bus fault that left everything safe.
    pub(crate) fn device(message: impl Into<String>) -> Self {
        Self::Device {
            message: message.into(),
            safe: true,
        }
    }

    /// Servos may still have torque.
    pub(crate) fn torque_unknown() -> Self {
        let message = "torque could not be confirmed to be off; switch the puppet's power off";
        Self::Device {
            message: message.to_owned(),
            safe: false,
        }
    }

    /// The same failure once it is known whether torque is off.
    #[must_use]
    pub(crate) fn after_release(self, released: bool) -> Self {
        match self {
            Self::Device { message, .. } => Self::Device {
                message,
                safe: released,
            },
            _ if !released => Self::torque_unknown(),
            other => other,
        }
    }

    /// Ended by Ctrl-C while a puppet may have been moving.
    pub(crate) fn stopped(torque_off: bool) -> Self {
        Self::refused("stopped; torque is off").after_release(torque_off)
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
