//! A line of an exchange as words with their places.

use super::read::ExchangeError;

/// One word of a line, or a text in quotation marks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Word {
    pub(super) text: String,
    /// From 1, in characters.
    pub(super) column: u32,
    pub(super) quoted: bool,
}

/// The words of one line, taken from the front.
#[derive(Clone, Debug)]
pub(super) struct Words {
    line: u32,
    left: std::collections::VecDeque<Word>,
    /// Just behind the last word taken.
    column: u32,
}

impl Words {
    /// Cuts a line; `#` outside quotation marks begins a remark.
    pub(super) fn cut(line: u32, text: &str) -> Result<Self, ExchangeError> {
        let mut words = std::collections::VecDeque::new();
        let mut letters = (1..).zip(text.chars()).peekable();
        while let Some((column, letter)) = letters.next() {
            match letter {
                '#' => break,
                '"' => {
                    let text = quoted(&mut letters)
                        .ok_or_else(|| ExchangeError::new(line, column, "this text has no closing \""))?;
                    let quoted = true;
                    words.push_back(Word { text, column, quoted });
                }
                space if space.is_whitespace() => {}
                first => {
                    let mut text = String::from(first);
                    while let Some((_, more)) = letters.next_if(|(_, l)| !l.is_whitespace() && *l != '#') {
                        text.push(more);
                    }
                    let quoted = false;
                    words.push_back(Word { text, column, quoted });
                }
            }
        }
        Ok(Self {
            line,
            left: words,
            column: 1,
        })
    }

    pub(super) fn take(&mut self) -> Option<Word> {
        let word = self.left.pop_front()?;
        self.column = word.column + word.text.chars().count() as u32;
        Some(word)
    }

    /// The next word, which must be there.
    pub(super) fn word(&mut self, expected: &str) -> Result<Word, ExchangeError> {
        self.take()
            .ok_or_else(|| self.fault(format!("expected {expected}, found the end of the line")))
    }

    /// Takes the next word if it is this one.
    pub(super) fn skip(&mut self, text: &str) -> bool {
        let is = self
            .left
            .front()
            .is_some_and(|word| !word.quoted && word.text == text);
        if is {
            self.take();
        }
        is
    }

    /// Takes the last word off if the one before it is `@`.
    pub(super) fn take_time(&mut self) -> Option<Word> {
        let before = self.left.len().checked_sub(2)?;
        let at = self.left.get(before)?;
        if at.quoted || at.text != "@" {
            return None;
        }
        let time = self.left.pop_back();
        self.left.pop_back();
        time
    }

    pub(super) fn is_empty(&self) -> bool {
        self.left.is_empty()
    }

    /// A number, decimal with a sign or without, or hexadecimal after `0x`.
    pub(super) fn number<T: TryFrom<i128>>(&mut self, expected: &str) -> Result<T, ExchangeError> {
        let word = self.word(expected)?;
        let text = word.text.as_str();
        let read = match text.strip_prefix("0x") {
            Some(digits) => i128::from_str_radix(digits, 16).ok(),
            None => text.parse().ok(),
        };
        read.and_then(|number| T::try_from(number).ok())
            .ok_or_else(|| self.at(&word, format!("expected {expected}, found `{text}`")))
    }

    /// A share or another real number.
    pub(super) fn real(&mut self, expected: &str) -> Result<f64, ExchangeError> {
        let word = self.word(expected)?;
        let read: Option<f64> = word.text.parse().ok().filter(|real: &f64| real.is_finite());
        read.ok_or_else(|| self.at(&word, format!("expected {expected}, found `{}`", word.text)))
    }

    /// All words left as bytes: pairs of hexadecimal digits, and texts in quotation marks.
    pub(super) fn bytes(&mut self) -> Result<Vec<u8>, ExchangeError> {
        let mut bytes = Vec::new();
        while let Some(word) = self.take() {
            if word.quoted {
                bytes.extend(word.text.chars().map(|letter| letter as u8));
                continue;
            }
            let two = word.text.len() == 2 && word.text.bytes().all(|digit| digit.is_ascii_hexdigit());
            let byte = u8::from_str_radix(&word.text, 16).ok().filter(|_| two);
            bytes.push(byte.ok_or_else(|| {
                let message = format!(
                    "expected two hexadecimal digits for a byte, found `{}`",
                    word.text
                );
                self.at(&word, message)
            })?);
        }
        Ok(bytes)
    }

    /// All words left, as they are read aloud.
    pub(super) fn rest(&mut self) -> String {
        let mut all = Vec::new();
        while let Some(word) = self.take() {
            all.push(word.text);
        }
        all.join(" ")
    }

    /// Nothing may be left.
    pub(super) fn end(mut self) -> Result<(), ExchangeError> {
        match self.take() {
            None => Ok(()),
            Some(word) => Err(self.at(
                &word,
                format!("expected the end of the line, found `{}`", word.text),
            )),
        }
    }

    pub(super) fn at(&self, word: &Word, message: impl Into<String>) -> ExchangeError {
        ExchangeError::new(self.line, word.column, message)
    }

    /// Something is wrong here, behind the last word.
    pub(super) fn fault(&self, message: impl Into<String>) -> ExchangeError {
        ExchangeError::new(self.line, self.column, message)
    }
}

/// What stands up to the closing mark, `\r`, `\n`, `\t`, `\"`, `\\` and `\xNN` undone. Letters are bytes.
fn quoted(letters: &mut impl Iterator<Item = (u32, char)>) -> Option<String> {
    let mut text = String::new();
    while let Some((_, letter)) = letters.next() {
        text.push(match letter {
            '"' => return Some(text),
            '\\' => match letters.next()?.1 {
                'r' => '\r',
                'n' => '\n',
                't' => '\t',
                'x' => {
                    let mut digit = || letters.next()?.1.to_digit(16);
                    char::from_u32(digit()? * 16 + digit()?)?
                }
                same => same,
            },
            letter if (letter as u32) < 256 => letter,
            _ => return None,
        });
    }
    None
}
