//! Numbers, points, texts and values.
//! Source: `docs/protocols/ps300.md`, section "Message types". Ours, where the record is silent: commas
//! inside a matrix may be left out; text may be several quoted pieces and `CHAR(n)` written after one
//! another, which are joined; `M4X3(…)` is the literal of the kind LOOKAT makes; `VL(…)` holds either the
//! name of a vector list or what could follow VECTOR_LIST, so that `VL(dots)` is a name and `VL(dots N=0)` is not.

use std::ops::RangeInclusive;
use std::sync::Arc;

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};

use super::{Fault, Parsed, Parser};
use crate::language::token::{Mark, TokenKind, cut};
use crate::language::words::{self, Word};
use crate::language::{Boundaries, Diagnostic, Payload, Range, SurfaceColor, Text};
use crate::value::Value;

type Literal = fn(&[f64]) -> Value;

/// Literals of numbers in parentheses: the word, how many numbers, what they make.
const LITERALS: [(Word, usize, Literal); 7] = [
    (words::V2D, 2, |n| DVec2::from_slice(n).into()),
    (words::V3D, 3, |n| DVec3::from_slice(n).into()),
    (words::V4D, 4, |n| DVec4::from_slice(n).into()),
    (words::M2D, 4, |n| matrix2(n).into()),
    (words::M3D, 9, |n| matrix3(n).into()),
    (words::M4D, 16, |n| matrix4(n).into()),
    (words::M4X3, 12, |n| matrix4x3(n).into()),
];

/// Rows as they are written to the column-major matrix.
pub(super) fn matrix2(rows: &[f64]) -> DMat2 {
    DMat2::from_cols_slice(rows).transpose()
}

pub(super) fn matrix3(rows: &[f64]) -> DMat3 {
    DMat3::from_cols_slice(rows).transpose()
}

pub(super) fn matrix4(rows: &[f64]) -> DMat4 {
    DMat4::from_cols_slice(rows).transpose()
}

/// Three rows of four; the last column is the translation.
pub(super) fn matrix4x3(rows: &[f64]) -> DAffine3 {
    let column = |index: usize| DVec3::new(rows[index], rows[4 + index], rows[8 + index]);
    DAffine3::from_cols(column(0), column(1), column(2), column(3))
}

impl Parser<'_> {
    /// What SEND and STORE carry.
    pub(super) fn payload(&mut self) -> Parsed<Payload> {
        if self.is_word_before(words::VALUE, Mark::Open) {
            self.advance();
            self.advance();
            let name = self.name("the name of a variable")?;
            self.expect(Mark::Close)?;
            return Ok(Payload::Variable(name));
        }
        if self.is_word_before(words::VL, Mark::Open) {
            self.advance();
            self.advance();
            if self.following.kind == TokenKind::Mark(Mark::Close)
                && matches!(self.current.kind, TokenKind::Word(_))
            {
                let name = self.name("the name of a vector list")?;
                self.advance();
                return Ok(Payload::VectorsOf(name));
            }
            return Ok(Payload::Value(self.vectors_in_parentheses()?));
        }
        Ok(Payload::Value(self.value()?))
    }

    /// A vector list written out, after `VL(`.
    fn vectors_in_parentheses(&mut self) -> Parsed<Value> {
        let list = self.vector_list(Mark::Close)?;
        self.expect(Mark::Close)?;
        Ok(list.into())
    }

    /// A literal.
    pub(super) fn value(&mut self) -> Parsed<Value> {
        if self.at_text() {
            return Ok(Value::String(self.text()?));
        }
        if matches!(self.current.kind, TokenKind::Number(_)) {
            return Ok(Value::Real(self.number("a number")?));
        }
        if self.is_word_before(words::FIX, Mark::Open) {
            let range = i64::from(i32::MIN)..=i64::from(i32::MAX);
            return Ok(Value::Integer(
                self.in_parentheses(range, "a whole number")? as i32
            ));
        }
        if self.is_word_before(words::VL, Mark::Open) {
            self.advance();
            self.advance();
            return self.vectors_in_parentheses();
        }
        if let Some(&(_, count, make)) = LITERALS.iter().find(|(word, ..)| self.is_word(*word)) {
            self.advance();
            self.expect(Mark::Open)?;
            let mut numbers = [0.0; 16];
            self.matrix_numbers(&mut numbers[..count])?;
            self.expect(Mark::Close)?;
            return Ok(make(&numbers[..count]));
        }
        for (word, value) in [(words::TRUE, true), (words::FALSE, false)] {
            if self.accept_word(word) {
                return Ok(Value::Boolean(value));
            }
        }
        let known = [
            words::TRUE,
            words::FALSE,
            words::FIX,
            words::CHAR,
            words::VALUE,
            words::VL,
        ];
        Err(self.unknown_word(
            "a value: a number, TRUE, FALSE, FIX(n), 'text', V3D(x,y,z), … or VALUE(v)",
            &known,
        ))
    }

    fn at_text(&self) -> bool {
        matches!(self.current.kind, TokenKind::Text(..)) || self.is_word_before(words::CHAR, Mark::Open)
    }

    /// Quoted pieces and `CHAR(n)`, at least one of them.
    pub(super) fn text(&mut self) -> Parsed<Text> {
        if !self.at_text() {
            return Err(self.unexpected("text in quotes"));
        }
        let mut joined = String::new();
        while self.at_text() {
            if let TokenKind::Text(written, quote) = self.current.kind {
                let doubled: String = [quote, quote].iter().collect();
                joined.push_str(&written.replace(&doubled, quote.encode_utf8(&mut [0; 4])));
                self.advance();
            } else {
                let at = self.current.at;
                let code =
                    self.in_parentheses(0..=i64::from(u32::from(char::MAX)), "the code of a character")?;
                let Some(character) = char::from_u32(code as u32) else {
                    return Err(
                        Diagnostic::error(at, format!("{code} is not the code of a character")).into(),
                    );
                };
                joined.push(character);
            }
        }
        Ok(Arc::from(joined))
    }

    /// A word, then a whole number in parentheses.
    fn in_parentheses(&mut self, range: RangeInclusive<i64>, what: &str) -> Parsed<i64> {
        self.advance();
        self.expect(Mark::Open)?;
        let number = self.integer(range, what)?;
        self.expect(Mark::Close)?;
        Ok(number)
    }

    /// A finite real.
    pub(super) fn number(&mut self, what: &str) -> Parsed<f64> {
        let TokenKind::Number(digits) = self.current.kind else {
            return Err(self.unexpected(what));
        };
        let number = digits.parse::<f64>().ok().filter(|number| number.is_finite());
        let Some(number) = number else {
            let message = format!("the number {} is too large", cut(digits));
            return Err(Diagnostic::error(self.current.at, message)
                .expecting("less than 1.8e308")
                .into());
        };
        self.advance();
        Ok(number)
    }

    /// A whole number in `range`.
    pub(super) fn integer(&mut self, range: RangeInclusive<i64>, what: &str) -> Parsed<i64> {
        let expected = || format!("{what} from {} to {}", range.start(), range.end());
        let TokenKind::Number(digits) = self.current.kind else {
            return Err(self.unexpected(expected()));
        };
        let Some(number) = digits.parse::<i64>().ok().filter(|number| range.contains(number)) else {
            return Err(self.unexpected(expected()));
        };
        self.advance();
        Ok(number)
    }

    /// Between `least` and three numbers with commas between them; those not written keep their `default`.
    pub(super) fn components(&mut self, least: usize, default: DVec3, what: &str) -> Parsed<(DVec3, usize)> {
        let mut point = default;
        point[0] = self.number(what)?;
        let mut count = 1;
        while count < 3 && self.is(Mark::Comma) {
            self.advance();
            point[count] = self.number("the next coordinate")?;
            count += 1;
        }
        if count < least {
            return Err(self.unexpected(format!("`,` and coordinate {} of {what}", count + 1)));
        }
        Ok((point, count))
    }

    /// `x,y[,z]`.
    pub(super) fn point(&mut self, what: &str) -> Parsed<DVec3> {
        Ok(self.components(2, DVec3::ZERO, what)?.0)
    }

    /// `x,y`.
    pub(super) fn pair(&mut self, what: &str) -> Parsed<DVec2> {
        let x = self.number(what)?;
        self.expect(Mark::Comma)?;
        Ok(DVec2::new(x, self.number(what)?))
    }

    /// `h[,s[,i]]`; s and i are 1 unless written.
    pub(super) fn surface_color(&mut self) -> Parsed<SurfaceColor> {
        let (color, _) = self.components(1, DVec3::ONE, "a hue in degrees")?;
        Ok(SurfaceColor {
            hue_deg: color.x,
            saturation: color.y,
            intensity: color.z,
        })
    }

    /// As many numbers as `into` holds, commas between them allowed.
    pub(super) fn matrix_numbers(&mut self, into: &mut [f64]) -> Parsed<()> {
        let count = into.len();
        for (index, slot) in into.iter_mut().enumerate() {
            if index > 0 {
                self.accept(Mark::Comma);
            }
            *slot = self.number(&format!("number {} of {count}", index + 1))?;
        }
        Ok(())
    }

    /// `a:b`.
    pub(super) fn range(&mut self, what: &str) -> Parsed<Range> {
        let from = self.number(what)?;
        self.expect(Mark::Colon)?;
        Ok(Range {
            from,
            to: self.number(what)?,
        })
    }

    /// `word=a:b`.
    pub(super) fn range_after(&mut self, word: Word, what: &str) -> Parsed<Range> {
        self.expect_word(word)?;
        self.expect(Mark::Equals)?;
        self.range(what)
    }

    /// `[FRONT [BOUNDARY]=f BACK [BOUNDARY]=b]`; both or none.
    pub(super) fn boundaries(&mut self) -> Parsed<Option<Boundaries>> {
        if !self.is_word(words::FRONT) {
            return Ok(None);
        }
        let front = self.boundary(words::FRONT)?;
        Ok(Some(Boundaries {
            front,
            back: self.boundary(words::BACK)?,
        }))
    }

    fn boundary(&mut self, word: Word) -> Result<f64, Fault> {
        self.expect_word(word)?;
        self.accept_word(words::BOUNDARY);
        self.expect(Mark::Equals)?;
        self.number("a distance from the eye")
    }
}
