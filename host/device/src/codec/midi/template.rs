//! System exclusive messages with gaps, as profiles write them: `f0 00 20 29 02 11 78 08 {n} {v} f7`.
//!
//! `{n}` is the output's number, `{n*7}` seven times it (where a display's strips stand side by side), `{v}` its value
//! and `{text}` its characters. Source: `docs/protocols/midi.md`.

/// One piece of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Piece {
    Byte(u8),
    Number { times: u8 },
    Value,
    Text,
}

/// A message with gaps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Template {
    pieces: Vec<Piece>,
}

impl Template {
    /// Reads one; `None` where it is none, or would not be a system exclusive message.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let pieces: Vec<Piece> = text.split_whitespace().map(piece).collect::<Option<_>>()?;
        let whole = pieces.first() == Some(&Piece::Byte(0xF0)) && pieces.last() == Some(&Piece::Byte(0xF7));
        let inner = pieces.get(1..pieces.len().saturating_sub(1)).unwrap_or_default();
        let sevens = inner.iter().all(|piece| !matches!(piece, Piece::Byte(0x80..)));
        (whole && sevens).then_some(Self { pieces })
    }

    /// Writes the message; every byte inside keeps to seven bits.
    pub(super) fn fill(&self, number: u8, value: u8, text: &[u8], out: &mut Vec<u8>) {
        for piece in &self.pieces {
            match *piece {
                Piece::Byte(byte) => out.push(byte),
                Piece::Number { times } => out.push(number.wrapping_mul(times) & 0x7F),
                Piece::Value => out.push(value & 0x7F),
                Piece::Text => out.extend(text.iter().map(|byte| byte & 0x7F)),
            }
        }
    }
}

fn piece(word: &str) -> Option<Piece> {
    Some(match word {
        "{n}" => Piece::Number { times: 1 },
        "{v}" => Piece::Value,
        "{text}" => Piece::Text,
        _ => {
            if let Some(times) = word.strip_prefix("{n*").and_then(|rest| rest.strip_suffix('}')) {
                Piece::Number {
                    times: times.parse().ok()?,
                }
            } else {
                let two = word.len() == 2;
                Piece::Byte(two.then(|| u8::from_str_radix(word, 16).ok()).flatten()?)
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_filled_and_nonsense_is_refused() {
        let table: [(&str, Option<&[u8]>); 7] = [
            (
                "f0 00 20 29 {n} {v} f7",
                Some(&[0xF0, 0, 0x20, 0x29, 5, 60, 0xF7]),
            ),
            ("f0 12 {n*7} {text} f7", Some(&[0xF0, 0x12, 35, b'H', b'i', 0xF7])),
            ("f0 {what} f7", None),
            ("f0 1 f7", None),
            ("00 20 f7", None),
            ("f0 90 f7", None),
            ("", None),
        ];
        for (text, wanted) in table {
            let filled = Template::parse(text).map(|template| {
                let mut out = Vec::new();
                template.fill(5, 60, b"Hi", &mut out);
                out
            });
            assert_eq!(filled.as_deref(), wanted, "{text}");
        }
    }
}
