//! Lines of text out of a stream of bytes, without allocating.

/// Puts together lines of at most `MAX` bytes, ended by a return, a line feed or both.
#[derive(Clone, Debug)]
pub(super) struct Lines<const MAX: usize> {
    text: [u8; MAX],
    have: usize,
    overlong: bool,
    ended: bool,
}

/// What the end of a line brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Line<'a> {
    /// All of it, without its end.
    Whole(&'a [u8]),
    /// It had more bytes than any line has.
    Overlong,
}

impl<const MAX: usize> Lines<MAX> {
    pub(super) fn new() -> Self {
        Self {
            text: [0; MAX],
            have: 0,
            overlong: false,
            ended: false,
        }
    }

    /// Forgets the line that has begun.
    pub(super) fn reset(&mut self) {
        self.have = 0;
        self.overlong = false;
        self.ended = false;
    }

    /// Whether a line has begun and not ended.
    pub(super) fn unfinished(&self) -> bool {
        !self.ended && (self.have > 0 || self.overlong)
    }

    /// What there is of the line that has begun.
    pub(super) fn so_far(&self) -> &[u8] {
        let have = if self.ended { 0 } else { self.have };
        self.text.get(..have).unwrap_or_default()
    }

    /// Takes a byte; gives the line it ends. Empty lines are none.
    pub(super) fn push(&mut self, byte: u8) -> Option<Line<'_>> {
        if self.ended {
            self.reset();
        }
        if byte != b'\r' && byte != b'\n' {
            match self.text.get_mut(self.have) {
                Some(place) => {
                    *place = byte;
                    self.have += 1;
                }
                None => self.overlong = true,
            }
            return None;
        }
        if self.have == 0 {
            return None;
        }
        self.ended = true;
        if self.overlong {
            return Some(Line::Overlong);
        }
        self.text.get(..self.have).map(Line::Whole)
    }
}

/// A whole number of at most nine decimal digits, nothing else around it.
pub(super) fn number(text: &[u8]) -> Option<i32> {
    std::str::from_utf8(text)
        .ok()
        .filter(|text| text.bytes().all(|byte| byte.is_ascii_digit()) && text.len() <= 9)
        .and_then(|text| text.parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<Option<Vec<u8>>> {
        let mut lines = Lines::<4>::new();
        let mut found = Vec::new();
        for &byte in bytes {
            match lines.push(byte) {
                Some(Line::Whole(text)) => found.push(Some(text.to_vec())),
                Some(Line::Overlong) => found.push(None),
                None => {}
            }
        }
        found
    }

    #[test]
    fn lines_end_in_either_way_and_have_a_limit() {
        let some = |text: &str| Some(text.as_bytes().to_vec());
        assert_eq!(lines(b"ab\r\ncd\ne\r\r\n\n"), [some("ab"), some("cd"), some("e")]);
        assert_eq!(lines(b"abcd\nabcde\nxy\n"), [some("abcd"), None, some("xy")]);
        assert_eq!(lines(b"\xFF\n"), [Some(vec![0xFF])]);
    }

    #[test]
    fn what_has_begun_can_be_seen() {
        let mut lines = Lines::<8>::new();
        assert!(!lines.unfinished());
        lines.push(b'a');
        assert_eq!((lines.unfinished(), lines.so_far()), (true, &b"a"[..]));
        lines.push(b'\r');
        assert_eq!((lines.unfinished(), lines.so_far()), (false, &b""[..]));
    }

    #[test]
    fn numbers_are_digits_only() {
        for (text, value) in [
            (&b"0"[..], Some(0)),
            (b"0042", Some(42)),
            (b"999999999", Some(999_999_999)),
            (b"", None),
            (b"-1", None),
            (b"+1", None),
            (b" 1", None),
            (b"1234567890", None),
            (b"1\xFF", None),
        ] {
            assert_eq!(number(text), value, "{text:?}");
        }
    }
}
