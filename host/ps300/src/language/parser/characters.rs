//! Texts and fonts.
//! Source: `docs/protocols/ps300.md`, section "Data nodes". How a font is written is ours, the record having no
//! more than its first and last word: `BEGIN_FONT C[65]: N=3 P 0,0 L 0.5,1 L 1,0; … END_FONT`, a character by
//! its code, then vectors as in an itemized list, in a cell of 0 to 1 each way.

use glam::{DVec2, DVec3};

use super::{Parsed, Parser};
use crate::language::token::{Mark, TokenKind};
use crate::language::words;
use crate::language::{Characters, Diagnostic, Font, Glyph, GlyphVector, Label, Labels};

impl Parser<'_> {
    /// Everything after CHARACTERS.
    pub(super) fn characters(&mut self) -> Parsed<Characters> {
        let mut at = DVec3::ZERO;
        let mut step = DVec2::X;
        if matches!(self.current.kind, TokenKind::Number(_)) {
            at = self.point("where the text stands")?;
        }
        if self.accept_word(words::STEP) {
            step = self.pair("the step from character to character, as 1,0")?;
        }
        Ok(Characters {
            at,
            step,
            text: self.text()?,
        })
    }

    /// Everything after LABELS.
    pub(super) fn labels(&mut self) -> Parsed<Labels> {
        let mut labels = Vec::new();
        while matches!(self.current.kind, TokenKind::Number(_)) {
            let at = self.point("where the text stands")?;
            let text = self.text()?;
            labels.push(Label { at, text });
        }
        if labels.is_empty() && !self.is(Mark::Semicolon) {
            return Err(self.unexpected("x,y,z 'text', or `;` for no text yet"));
        }
        Ok(Labels { labels })
    }

    /// BEGIN_FONT … END_FONT.
    pub(super) fn font(&mut self) -> Parsed<Font> {
        let begin = self.current.at;
        self.advance();
        let mut glyphs = Vec::new();
        while !self.accept_word(words::END_FONT) {
            let begins_definition = self.current.first_on_line
                && self.following.kind == TokenKind::Mark(Mark::Assign)
                && matches!(self.current.kind, TokenKind::Word(_));
            if self.current.kind == TokenKind::End || begins_definition {
                return Err(Diagnostic::error(begin, "this font is never ended")
                    .expecting("END_FONT;")
                    .into());
            }
            if self.accept(Mark::Semicolon) {
                continue;
            }
            let taken = self.taken;
            match self.glyph().and_then(|glyph| self.finish().map(|()| glyph)) {
                Ok(glyph) => glyphs.push(glyph),
                Err(fault) => self.recover(fault, taken),
            }
        }
        Ok(Font { glyphs })
    }

    /// `C[65]: N=3 P 0,0 L 0.5,1 L 1,0`.
    fn glyph(&mut self) -> Parsed<Glyph> {
        if !self.is_word_before(words::C, Mark::OpenBracket) {
            return Err(self.unexpected("a character such as C[65]: P 0,0 L 1,1; or END_FONT"));
        }
        self.advance();
        self.advance();
        let at = self.current.at;
        let code = self.integer(0..=i64::from(u32::from(char::MAX)), "the code of a character")?;
        let Some(character) = char::from_u32(code as u32) else {
            return Err(Diagnostic::error(at, format!("{code} is not the code of a character")).into());
        };
        self.expect(Mark::CloseBracket)?;
        self.expect(Mark::Colon)?;
        let count = self.count()?;
        let mut vectors: Vec<GlyphVector> = Vec::new();
        loop {
            let draw = if self.accept_word_before_number(words::P) {
                false
            } else if self.accept_word_before_number(words::L) {
                true
            } else if matches!(self.current.kind, TokenKind::Number(_)) {
                !vectors.is_empty()
            } else {
                break;
            };
            let at = self.pair("a vector x,y")?;
            vectors.push(GlyphVector { at, draw });
        }
        self.check_count(count, vectors.len(), "vectors");
        Ok(Glyph { character, vectors })
    }
}
