//! Errors in files: where, what, and what to do about it.
//!
//! Readers collect every error they can see instead of stopping at the first, because a person mends a
//! file in one sitting. The printed form is the one the command line promises (`FILE:LINE:COLUMN: text`).

use std::fmt;
use std::path::{Path, PathBuf};

/// One error, or one warning, in one place of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    /// The file, as it was named when it was opened.
    pub file: PathBuf,
    /// Line, counted from 1; 1 too when the whole file is meant.
    pub line: u32,
    /// Column in characters, counted from 1.
    pub column: u32,
    /// What was expected and what was found.
    pub message: String,
    /// What a person can do, where there is something.
    pub hint: Option<String>,
}

impl FileError {
    /// An error about a file as a whole.
    pub fn whole(file: &Path, message: impl Into<String>) -> Self {
        Self {
            file: file.to_path_buf(),
            line: 1,
            column: 1,
            message: message.into(),
            hint: None,
        }
    }

    /// The same error with advice.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}:{}:{}: {}",
            self.file.display(),
            self.line,
            self.column,
            self.message
        )?;
        match &self.hint {
            Some(hint) => write!(f, " ({hint})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for FileError {}

/// Everything that is wrong with what was to be read; never empty when returned as an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileErrors(pub Vec<FileError>);

impl fmt::Display for FileErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.0.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{error}")?;
        }
        Ok(())
    }
}

impl std::error::Error for FileErrors {}

impl From<FileError> for FileErrors {
    fn from(error: FileError) -> Self {
        Self(vec![error])
    }
}

/// What reading found: errors make the result unusable, warnings do not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// What must be mended.
    pub errors: Vec<FileError>,
    /// What was read differently from how it is written, or may not be meant.
    pub warnings: Vec<FileError>,
}

/// Errors beyond this many say nothing new; a file with more is not what its name claims.
const ERRORS_MAX: usize = 200;

impl Findings {
    /// Notes an error.
    pub fn error(&mut self, error: FileError) {
        if self.errors.len() < ERRORS_MAX {
            self.errors.push(error);
        }
    }

    /// Notes a warning.
    pub fn warn(&mut self, warning: FileError) {
        if self.warnings.len() < ERRORS_MAX {
            self.warnings.push(warning);
        }
    }

    /// `value` if there is no error, else all errors in the order of their places.
    pub fn accept<T>(self, value: Option<T>, file: &Path) -> Result<(T, Vec<FileError>), FileErrors> {
        match value {
            Some(value) if self.errors.is_empty() => Ok((value, self.warnings)),
            _ => Err(self.into_errors(file)),
        }
    }

    /// All errors, sorted by place; names the file when nothing more precise was noted.
    pub fn into_errors(mut self, file: &Path) -> FileErrors {
        if self.errors.is_empty() {
            self.errors
                .push(FileError::whole(file, "this file cannot be used"));
        }
        self.errors
            .sort_by(|a, b| (&a.file, a.line, a.column).cmp(&(&b.file, b.line, b.column)));
        FileErrors(self.errors)
    }
}
