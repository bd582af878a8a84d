//! Where something was written, and what is wrong with it.

use std::fmt;

/// A place in a source text. Lines and columns count from 1; columns count characters, not bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// From 1.
    pub line: u32,
    /// In characters, from 1; a tab is one.
    pub column: u32,
}

/// Something read from a text, with the place of its first character.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// Where it begins.
    pub at: Position,
    /// What it is.
    pub what: T,
}

/// Whether the thing at fault was left out or taken anyway.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The command, or the member of a structure, was left out.
    Error,
    /// The command was taken as described.
    Warning,
}

/// One remark about a source text. Shown as `line:column: error: message; expected …; hint`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// From 1.
    pub line: u32,
    /// In characters, from 1.
    pub column: u32,
    /// Whether the command was left out.
    pub severity: Severity,
    /// What was found.
    pub message: String,
    /// What could have stood there, if something definite could.
    pub expected: Option<String>,
    /// What to do about it, if a person can do something.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// An error at `at` without expectation or hint.
    pub fn error(at: Position, message: impl Into<String>) -> Self {
        Self {
            line: at.line,
            column: at.column,
            severity: Severity::Error,
            message: message.into(),
            expected: None,
            hint: None,
        }
    }

    /// A warning at `at` without expectation or hint.
    pub fn warning(at: Position, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(at, message)
        }
    }

    /// The same, naming what could have stood there.
    #[must_use]
    pub fn expecting(mut self, expected: impl Into<String>) -> Self {
        self.expected = Some(expected.into());
        self
    }

    /// The same, saying what to do.
    #[must_use]
    pub fn hinting(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{}:{}: {severity}: {}", self.line, self.column, self.message)?;
        if let Some(expected) = &self.expected {
            write!(f, "; expected {expected}")?;
        }
        if let Some(hint) = &self.hint {
            write!(f, "; {hint}")?;
        }
        Ok(())
    }
}
