//! Reading a file or, for `-`, standard input.

use std::io::{IsTerminal, Read};
use std::path::Path;

use rig::document::source::{FILE_BYTES_MAX, Source};
use rig::document::{FileError, FileErrors};

use crate::console::Console;

/// The text of a file; `-` is standard input.
pub(crate) fn read(path: &Path, console: &Console) -> Result<Source, FileErrors> {
    if path.as_os_str() != "-" {
        if path.is_dir() {
            let error = FileError::whole(path, "this is a folder; a file is needed");
            return Err(error.into());
        }
        return Ok(Source::open(path)?);
    }
    let stdin = std::io::stdin();
    if stdin.is_terminal() {
        console.remark("reading standard input; end it with Ctrl-D");
    }
    let mut bytes = Vec::new();
    stdin
        .lock()
        .take(FILE_BYTES_MAX + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| FileError::whole(path, format!("cannot read standard input: {error}")))?;
    if bytes.len() as u64 > FILE_BYTES_MAX {
        return Err(FileError::whole(path, format!("more than the {FILE_BYTES_MAX} bytes allowed")).into());
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Source::from_text(path, text)),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let good = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
            let byte = error.as_bytes()[at];
            let error =
                Source::from_text(path, good).error(at, format!("byte 0x{byte:02x} is not UTF-8 text"));
            Err(error.into())
        }
    }
}
