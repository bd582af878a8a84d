//! The text of one file with the way back from a byte to its line and column.
//!
//! All of a show is text, so one opening routine holds the bounds on size and the check for UTF-8.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::fault::FileError;

/// Largest file read at all. A minute of dense motion capture is about 2 MiB; this is two hours of it.
pub const FILE_BYTES_MAX: u64 = 256 * 1024 * 1024;

/// A file's text and where its lines begin.
#[derive(Clone, Debug)]
pub struct Source {
    path: PathBuf,
    text: String,
    line_starts: Vec<usize>,
}

impl Source {
    /// Text that is already in memory; `path` is used in errors only.
    pub fn from_text(path: &Path, text: impl Into<String>) -> Self {
        let text = text.into();
        let mut line_starts = vec![0];
        line_starts.extend(
            text.bytes()
                .enumerate()
                .filter(|&(_, byte)| byte == b'\n')
                .map(|(at, _)| at + 1),
        );
        Self {
            path: path.to_path_buf(),
            text,
            line_starts,
        }
    }

    /// Reads a file whole. Refuses what is too large or is not UTF-8, naming the first bad byte's place.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let file = File::open(path).map_err(|error| cannot(path, "open", &error))?;
        let claimed = file.metadata().map_or(0, |facts| facts.len());
        let mut bytes = Vec::new();
        if claimed <= FILE_BYTES_MAX {
            // What is no plain file claims nothing; the bound holds all the same.
            let mut bounded = file.take(FILE_BYTES_MAX + 1);
            bounded
                .read_to_end(&mut bytes)
                .map_err(|error| cannot(path, "read", &error))?;
        }
        if claimed.max(bytes.len() as u64) > FILE_BYTES_MAX {
            let message = format!("larger than the {FILE_BYTES_MAX} bytes allowed");
            return Err(FileError::whole(path, message).with_hint("check that this is the file meant"));
        }
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Self::from_text(path, text)),
            Err(error) => Err(not_utf8(path, &error)),
        }
    }

    /// The file's name as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Line and column, from 1, of the byte at `offset`; offsets past the end mean the end.
    pub fn line_column(&self, offset: usize) -> (u32, u32) {
        let offset = offset.min(self.text.len());
        let line = self.line_starts.partition_point(|&start| start <= offset) - 1;
        let from = self.line_starts[line];
        let column = self.text.as_bytes()[from..offset]
            .iter()
            .filter(|&&byte| byte & 0xc0 != 0x80)
            .count();
        (line as u32 + 1, column as u32 + 1)
    }

    /// The byte at which a line, counted from 1, begins; the last line's for lines beyond.
    pub fn offset_of_line(&self, line: u32) -> usize {
        let index = (line.max(1) as usize - 1).min(self.line_starts.len() - 1);
        self.line_starts[index]
    }

    /// An error at the byte at `offset`.
    pub fn error(&self, offset: usize, message: impl Into<String>) -> FileError {
        let (line, column) = self.line_column(offset);
        FileError {
            file: self.path.clone(),
            line,
            column,
            message: message.into(),
            hint: None,
        }
    }

    /// An error at a line and column counted from 1.
    pub fn error_at(&self, (line, column): (u32, u32), message: impl Into<String>) -> FileError {
        FileError {
            file: self.path.clone(),
            line,
            column,
            message: message.into(),
            hint: None,
        }
    }
}

/// An operating-system error in words.
pub(super) fn cannot(path: &Path, what: &str, error: &std::io::Error) -> FileError {
    FileError::whole(path, format!("cannot {what} it: {error}"))
}

fn not_utf8(path: &Path, error: &std::string::FromUtf8Error) -> FileError {
    let at = error.utf8_error().valid_up_to();
    let good = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
    let byte = error.as_bytes()[at];
    Source::from_text(path, good)
        .error(at, format!("byte 0x{byte:02x} is not UTF-8 text"))
        .with_hint("save the file as UTF-8; binary files are not read here")
}

/// The words of one line with their columns.
pub(super) fn words(line: &str) -> impl Iterator<Item = (u32, &str)> {
    let mut rest = line;
    let mut column = 1_u32;
    std::iter::from_fn(move || {
        let trimmed = rest.trim_start();
        column += rest[..rest.len() - trimmed.len()].chars().count() as u32;
        let end = trimmed.find(char::is_whitespace).unwrap_or(trimmed.len());
        if end == 0 {
            return None;
        }
        let (word, after) = trimmed.split_at(end);
        let at = column;
        column += word.chars().count() as u32;
        rest = after;
        Some((at, word))
    })
}

/// A finite number, or what is wrong with the word.
pub(super) fn finite(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{word}` is not a finite number")),
        Err(_) => Err(format!("expected a number, found `{word}`")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_has_a_line_and_a_column() {
        let source = Source::from_text(Path::new("a"), "é1\n\n  x");
        for (offset, expected) in [
            (0, (1, 1)),
            (2, (1, 2)),
            (3, (1, 3)),
            (4, (2, 1)),
            (7, (3, 3)),
            (99, (3, 4)),
        ] {
            assert_eq!(source.line_column(offset), expected, "offset {offset}");
        }
    }

    #[test]
    fn words_know_their_columns() {
        let found: Vec<_> = words("  1 αβ\t3").collect();
        assert_eq!(found, [(3, "1"), (5, "αβ"), (8, "3")]);
        assert_eq!(words("   ").count(), 0);
    }

    #[test]
    fn a_file_that_is_not_text_is_refused_where_it_stops_being_text() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("noise.toml");
        std::fs::write(&path, b"name = 1\nx\xff").expect("writes");
        let error = Source::open(&path).expect_err("not UTF-8");
        assert_eq!((error.line, error.column), (2, 2));
    }

    #[test]
    fn a_file_that_is_too_large_is_not_even_read() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("huge.bvh");
        File::create(&path)
            .and_then(|file| file.set_len(FILE_BYTES_MAX + 1))
            .expect("a file of holes");
        let error = Source::open(&path).expect_err("too large");
        assert!(error.message.contains("larger than"), "{error}");
    }
}
