//! The words of a line, each with its column: what all parsing of scenarios is made of.

/// What is wrong with a line, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Flaw {
    pub(super) column: u32,
    pub(super) message: String,
}

pub(super) type Parsed<T> = Result<T, Flaw>;

/// One word; quotes are taken off.
#[derive(Clone, Copy, Debug)]
struct Word<'a> {
    column: u32,
    text: &'a str,
    quoted: bool,
    /// Byte offset in the line.
    at: usize,
}

/// The words of one line, taken from the left. A comment begins with `#` at the start of a word.
#[derive(Clone, Debug)]
pub(super) struct Words<'a> {
    line: &'a str,
    all: Vec<Word<'a>>,
    next: usize,
    end: u32,
}

impl<'a> Words<'a> {
    pub(super) fn new(line: &'a str) -> Parsed<Self> {
        let mut all = Vec::new();
        let mut rest = line;
        let mut at = 0;
        let mut used = 0;
        loop {
            let skipped = rest.len() - rest.trim_start().len();
            at += skipped;
            rest = &rest[skipped..];
            if rest.is_empty() || rest.starts_with('#') {
                break;
            }
            let column = line[..at].chars().count() as u32 + 1;
            let (text, quoted, length) = if let Some(inner) = rest.strip_prefix('"') {
                let Some(length) = inner.find('"') else {
                    return Err(Flaw {
                        column,
                        message: "this quotation has no end".into(),
                    });
                };
                (&inner[..length], true, length + 2)
            } else {
                let length = rest
                    .find(|c: char| c.is_whitespace() || c == ',')
                    .unwrap_or(rest.len())
                    .max(1);
                (&rest[..length], false, length)
            };
            all.push(Word {
                column,
                text,
                quoted,
                at,
            });
            at += length;
            used = at;
            rest = &rest[length..];
        }
        Ok(Self {
            line,
            all,
            next: 0,
            end: line[..used].chars().count() as u32 + 1,
        })
    }

    pub(super) fn is_at_end(&self) -> bool {
        self.next >= self.all.len()
    }

    /// Column of the next word, or just behind the last.
    pub(super) fn column(&self) -> u32 {
        self.all.get(self.next).map_or(self.end, |word| word.column)
    }

    fn peek(&self) -> Option<&'a str> {
        self.all
            .get(self.next)
            .filter(|word| !word.quoted)
            .map(|word| word.text)
    }

    /// Whether the next word is this one.
    pub(super) fn next_is(&self, word: &str) -> bool {
        self.peek() == Some(word)
    }

    /// Takes the next word if it is this one.
    pub(super) fn take(&mut self, word: &str) -> bool {
        let found = self.peek() == Some(word);
        self.next += usize::from(found);
        found
    }

    /// The flaw of the next word, where `expected` was expected.
    pub(super) fn wrong(&self, expected: &str) -> Flaw {
        let found = match self.all.get(self.next) {
            Some(word) if word.quoted => format!("\"{}\"", word.text),
            Some(word) => format!("`{}`", word.text),
            None => "the end of the line".to_owned(),
        };
        Flaw {
            column: self.column(),
            message: format!("expected {expected}, found {found}"),
        }
    }

    pub(super) fn expect(&mut self, word: &str) -> Parsed<()> {
        if self.take(word) {
            Ok(())
        } else {
            Err(self.wrong(&format!("`{word}`")))
        }
    }

    /// The next word, quoted or not.
    pub(super) fn text(&mut self, what: &str) -> Parsed<String> {
        let word = self.all.get(self.next).ok_or_else(|| self.wrong(what))?;
        self.next += 1;
        Ok(word.text.to_owned())
    }

    /// The next word, which must be quoted.
    pub(super) fn quoted(&mut self, what: &str) -> Parsed<String> {
        match self.all.get(self.next) {
            Some(word) if word.quoted => {
                self.next += 1;
                Ok(word.text.to_owned())
            }
            _ => Err(self.wrong(&format!("{what} in quotes"))),
        }
    }

    /// The next word, if it is quoted.
    pub(super) fn maybe_quoted(&mut self) -> Option<String> {
        let word = self.all.get(self.next).filter(|word| word.quoted)?;
        self.next += 1;
        Some(word.text.to_owned())
    }

    /// One of these words, by its place in the list.
    pub(super) fn one_of(&mut self, words: &[&str]) -> Parsed<usize> {
        let found = self
            .peek()
            .and_then(|word| words.iter().position(|known| *known == word));
        match found {
            Some(place) => {
                self.next += 1;
                Ok(place)
            }
            None => Err(self.wrong(&list(words))),
        }
    }

    /// A finite number in a range.
    pub(super) fn number(&mut self, what: &str, range: std::ops::RangeInclusive<f64>) -> Parsed<f64> {
        let value = self.peek().and_then(|word| word.parse::<f64>().ok());
        match value.filter(|value| range.contains(value)) {
            Some(value) => {
                self.next += 1;
                Ok(value)
            }
            None if *range.end() == f64::MAX => Err(self.wrong(&format!("{what}, a number"))),
            None => Err(self.wrong(&format!(
                "{what}, a number from {} to {}",
                range.start(),
                range.end()
            ))),
        }
    }

    /// Any finite number.
    pub(super) fn any_number(&mut self, what: &str) -> Parsed<f64> {
        self.number(what, f64::MIN..=f64::MAX)
    }

    /// A time or duration up to a day: seconds, or with its unit behind it as in `1.5s` and `300ms`.
    pub(super) fn secs(&mut self, what: &str) -> Parsed<f64> {
        let with_unit = self.peek().and_then(|word| {
            let millis = word.strip_suffix("ms").map(|number| (number, 1e-3));
            let (number, unit) = millis.or_else(|| word.strip_suffix('s').map(|number| (number, 1.0)))?;
            number.parse::<f64>().ok().map(|value| value * unit)
        });
        match with_unit.filter(|secs| (0.0..=86_400.0).contains(secs)) {
            Some(secs) => {
                self.next += 1;
                Ok(secs)
            }
            None => self.number(what, 0.0..=86_400.0),
        }
    }

    /// An angle in radians, also written `30 deg`.
    pub(super) fn angle(&mut self, what: &str) -> Parsed<f64> {
        let value = self.any_number(what)?;
        Ok(self.in_unit(value))
    }

    /// `value` in radians, if `deg` follows.
    pub(super) fn in_unit(&mut self, value: f64) -> f64 {
        if self.take("deg") {
            return value.to_radians();
        }
        self.take("rad");
        value
    }

    /// A whole number in a range.
    pub(super) fn whole(&mut self, what: &str, range: std::ops::RangeInclusive<u64>) -> Parsed<u64> {
        let value = self.peek().and_then(|word| word.parse::<u64>().ok());
        match value.filter(|value| range.contains(value)) {
            Some(value) => {
                self.next += 1;
                Ok(value)
            }
            None => Err(self.wrong(&format!("{what}, {} to {}", range.start(), range.end()))),
        }
    }

    /// Everything up to the comment, as written.
    pub(super) fn rest(&mut self, what: &str) -> Parsed<&'a str> {
        let (Some(first), Some(last)) = (self.all.get(self.next), self.all.last()) else {
            return Err(self.wrong(what));
        };
        let end = last.at + last.text.len() + if last.quoted { 2 } else { 0 };
        self.next = self.all.len();
        Ok(&self.line[first.at..end])
    }

    pub(super) fn end(&self) -> Parsed<()> {
        if self.is_at_end() {
            Ok(())
        } else {
            Err(self.wrong("the end of the line"))
        }
    }
}

/// `a, b or c`.
pub(super) fn list(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_keep_their_columns() {
        let mut words = Words::new("  é \"two words\" 3,4  # a comment").expect("reads");
        assert_eq!(words.column(), 3);
        assert_eq!(words.text("one").expect("é"), "é");
        assert_eq!(words.column(), 5);
        assert_eq!(words.quoted("a text").expect("quoted"), "two words");
        assert_eq!(words.number("three", 0.0..=9.0).expect("3"), 3.0);
        assert!(words.take(",") && words.whole("four", 0..=9) == Ok(4));
        assert!(words.is_at_end() && words.end().is_ok());
        assert_eq!(words.column(), 20);
    }

    #[test]
    fn the_rest_is_taken_as_written() {
        let mut words = Words::new("network SEND  'a b' TO <1>x;  # comment").expect("reads");
        words.expect("network").expect("there");
        assert_eq!(words.rest("commands"), Ok("SEND  'a b' TO <1>x;"));
    }

    #[test]
    fn flaws_say_what_was_expected_and_found() {
        let mut words = Words::new("turn nine").expect("reads");
        words.expect("turn").expect("there");
        let flaw = words.number("a dial", 1.0..=8.0).expect_err("no number");
        assert_eq!(
            flaw.message,
            "expected a dial, a number from 1 to 8, found `nine`"
        );
        assert_eq!(flaw.column, 6);
        assert_eq!(Words::new("say \"open").expect_err("no end").column, 5);
        assert_eq!(list(&["a", "b", "c"]), "a, b or c");
    }
}
