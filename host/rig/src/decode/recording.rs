//! Recorded reports: who sent them, when, and what is known of the devices.

use std::time::Duration;

use device::exchange::Exchange;

/// Reports of one or several devices, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The devices, in the order in which they are first named.
    pub devices: Vec<RecordedDevice>,
    /// What they sent.
    pub reports: Vec<RecordedReport>,
    /// Lines that were passed over.
    pub flaws: Vec<Flaw>,
}

/// One device, or one interface of one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedDevice {
    /// What it calls itself, or where it was.
    pub name: String,
    /// Its report descriptor, where the recording has it.
    pub descriptor: Option<Vec<u8>>,
    /// Vendor and product.
    pub ids: Option<[u16; 2]>,
    /// The key of its profile, where the recording names one.
    pub profile: Option<String>,
    /// The conversation with it from its beginning, where the recording has both sides.
    pub conversation: Option<Exchange>,
}

/// One report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedReport {
    /// Index of its device.
    pub device: usize,
    /// When, by the recording's own clock.
    pub at: Duration,
    /// As the device sent it.
    pub bytes: Vec<u8>,
}

/// A line that does not say what it should.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// From 1.
    pub line: u32,
    /// From 1, in characters.
    pub column: u32,
    /// What was expected and what was found.
    pub message: String,
}

/// Most flaws that are told one by one.
const FLAWS_MAX: usize = 100;

impl Recording {
    /// Reads any of the known forms; the text itself says which it is.
    pub fn read(text: &str) -> Self {
        let dump = text.lines().any(|line| super::dump::header(line).is_some());
        if dump {
            super::dump::read(text)
        } else if let Some(recording) = super::exchange::read(text) {
            recording
        } else {
            super::recorder::read(text)
        }
    }

    /// Whether there is nothing in it that could be decoded.
    pub fn is_empty(&self) -> bool {
        self.devices.is_empty() && self.reports.is_empty()
    }

    pub(super) fn flaw(&mut self, line: u32, column: usize, message: String) {
        if self.flaws.len() < FLAWS_MAX {
            self.flaws.push(Flaw {
                line,
                column: u32::try_from(column).unwrap_or(u32::MAX).saturating_add(1),
                message,
            });
        }
    }
}

/// Bytes in hexadecimal with spaces between, up to a comment; or the word that is none.
pub(super) fn hex(text: &str) -> Result<Vec<u8>, &str> {
    text.split_whitespace()
        .map(|word| {
            let digits = (1..=2).contains(&word.len()) && word.bytes().all(|b| b.is_ascii_hexdigit());
            let byte = digits.then(|| u8::from_str_radix(word, 16).ok()).flatten();
            byte.ok_or(word)
        })
        .collect()
}

/// Seconds with a fraction, as `12.345678`.
pub(super) fn seconds(word: &str) -> Option<Duration> {
    let (whole, fraction) = word.split_once('.').unwrap_or((word, ""));
    let all_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    if whole.is_empty() || !all_digits(whole) || !all_digits(fraction) || fraction.len() > 9 {
        return None;
    }
    let nanos = format!("{fraction:0<9}").parse().ok()?;
    Some(Duration::new(whole.parse().ok()?, nanos))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_bytes_are_read_or_refused() {
        assert_eq!(seconds("000001.500000"), Some(Duration::from_millis(1_500)));
        assert_eq!(
            seconds("1300000000.123456"),
            Some(Duration::new(1_300_000_000, 123_456_000))
        );
        for wrong in ["", ".5", "1.x", "-1", "1.1234567890"] {
            assert_eq!(seconds(wrong), None, "{wrong}");
        }
        assert_eq!(hex(" 02 E1 0 "), Ok(vec![2, 0xE1, 0]));
        assert_eq!(hex("02 1ff"), Err("1ff"));
        assert_eq!(hex("0x02"), Err("0x02"));
    }
}
