//! Remarks of the command language as places in files.

use ps300::language::{Diagnostic, Severity};
use rig::document::source::Source;
use rig::document::{FileError, FileErrors, Findings};

use crate::console::Console;
use crate::failure::Failure;

/// Notes remarks about a text that begins at line and column `begins` of the file.
pub(in crate::command) fn note(
    source: &Source,
    begins: (u32, u32),
    remarks: impl IntoIterator<Item = Diagnostic>,
    found: &mut Findings,
) {
    for remark in remarks {
        let mut message = remark.message;
        if let Some(expected) = remark.expected {
            message.push_str("; expected ");
            message.push_str(&expected);
        }
        let place = place(begins, (remark.line, remark.column));
        let mut error = source.error_at(place, message);
        error.hint = remark.hint;
        match remark.severity {
            Severity::Error => found.error(error),
            Severity::Warning => found.warn(error),
        }
    }
}

/// Shows the warnings; any error ends the command. All in the order of their places.
pub(super) fn settle(mut found: Findings, console: &Console) -> Result<(), Failure> {
    sort(&mut found);
    console.warn(&found.warnings);
    if found.errors.is_empty() {
        Ok(())
    } else {
        Err(FileErrors(found.errors).into())
    }
}

/// Puts remarks in the order of their places, files in the order of their names.
pub(super) fn sort(found: &mut Findings) {
    let place = |error: &FileError| (error.file.clone(), error.line, error.column);
    found.errors.sort_by_key(place);
    found.warnings.sort_by_key(place);
}

/// Line and column in the file of a place in a text that begins at `begins`.
pub(super) fn place(begins: (u32, u32), (line, column): (u32, u32)) -> (u32, u32) {
    let indent = if line == 1 { begins.1 - 1 } else { 0 };
    (begins.0 + line - 1, column + indent)
}
