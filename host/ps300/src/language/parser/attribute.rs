//! SET and IF: attributes and conditions.
//! Source: `docs/protocols/ps300.md`, section "Attributes, conditionals".

use super::{Parsed, Parser};
use crate::language::token::{Mark, TokenKind};
use crate::language::words::{self, Word};
use crate::language::{Comparison, Operation};

const ON_OFF: [(Word, bool); 2] = [(words::ON, true), (words::OFF, false)];

impl Parser<'_> {
    /// Everything after SET.
    pub(super) fn set(&mut self) -> Parsed<Operation> {
        if self.accept_word(words::COLOR) {
            return self.set_color();
        }
        if self.accept_word(words::INTENSITY) {
            let on = self.one_of(&ON_OFF)?;
            let range = self.range("the lowest and highest intensity, as 0:1")?;
            return Ok(Operation::SetIntensity { on, range });
        }
        if self.accept_word(words::DEPTH_CLIPPING) {
            return Ok(Operation::SetDepthClipping(self.one_of(&ON_OFF)?));
        }
        if self.accept_word(words::PICKING) {
            return self.set_picking();
        }
        if self.accept_word(words::CONDITIONAL_BIT) || self.accept_word(words::COND_BIT) {
            let bit = self.bit()?;
            return Ok(Operation::SetConditionalBit {
                bit,
                on: self.one_of(&ON_OFF)?,
            });
        }
        if self.accept_word(words::LEVEL_OF_DETAIL) {
            self.accept_word(words::TO);
            return Ok(Operation::SetLevelOfDetail(self.level()?));
        }
        if self.accept_word(words::RATE) {
            return self.set_rate();
        }
        self.set_device()
    }

    /// What concerns how the picture is put out.
    fn set_device(&mut self) -> Parsed<Operation> {
        if self.accept_word(words::CONTRAST) {
            self.accept_word(words::TO);
            return Ok(Operation::SetContrast(self.number("a contrast")?));
        }
        if self.accept_word(words::DISPLAY) {
            let number = self.integer(0..=i64::from(u8::MAX), "the number of a screen")? as u8;
            return Ok(Operation::SetDisplay {
                number,
                on: self.one_of(&ON_OFF)?,
            });
        }
        if self.accept_word(words::PLOTTER) {
            return Ok(Operation::SetPlotter(self.one_of(&ON_OFF)?));
        }
        if self.accept_word(words::LINE_TEXTURE) {
            let around_corners = self.accept_word(words::AROUND_CORNERS);
            let last = i64::from(Operation::LINE_TEXTURE_MAX);
            return Ok(Operation::SetLineTexture {
                around_corners,
                mask: self.integer(1..=last, "a line texture, seven bits as a number")? as u8,
            });
        }
        let known = &words::ATTRIBUTE_WORDS;
        Err(self.unknown_word(words::listed(known), known))
    }

    fn set_color(&mut self) -> Parsed<Operation> {
        if self.accept_word(words::BLENDING) {
            let saturation = self.number("a saturation from 0 to 1")?;
            return Ok(Operation::SetColorBlending { saturation });
        }
        let color = self.pair("hue and saturation, as 120,1")?;
        Ok(Operation::SetColor {
            hue_deg: color.x,
            saturation: color.y,
        })
    }

    fn set_picking(&mut self) -> Parsed<Operation> {
        if self.accept_word_equals(words::IDENTIFIER) {
            return Ok(Operation::SetPickingIdentifier(self.name("a pick identifier")?));
        }
        if self.accept_word_equals(words::LOCATION) {
            return Ok(Operation::SetPickingLocation {
                center: self.pair("the middle of the pick window, as 0,0")?,
                size: self.pair("half its width and height, as 0.01,0.01")?,
            });
        }
        if !matches!(self.current.kind, TokenKind::Word(_)) {
            return Err(self.unexpected("ON, OFF, IDENTIFIER=name or LOCATION=x,y sx,sy"));
        }
        Ok(Operation::SetPicking(self.one_of(&ON_OFF)?))
    }

    /// `on off [ON/OFF] [delay]` or EXTERNAL.
    fn set_rate(&mut self) -> Parsed<Operation> {
        if self.accept_word(words::EXTERNAL) {
            return Ok(Operation::SetRateExternal);
        }
        let on_frames = self.frames("EXTERNAL, or how many frames on,")?;
        let off_frames = self.frames("how many frames off,")?;
        let mut initially = None;
        if self.is_word(words::ON) || self.is_word(words::OFF) {
            initially = Some(self.one_of(&ON_OFF)?);
        }
        let mut delay_frames = None;
        if matches!(self.current.kind, TokenKind::Number(_)) {
            delay_frames = Some(self.frames("how many frames the first phase lasts,")?);
        }
        Ok(Operation::SetRate {
            on_frames,
            off_frames,
            initially,
            delay_frames,
        })
    }

    fn frames(&mut self, what: &str) -> Parsed<u32> {
        Ok(self.integer(0..=i64::from(u32::MAX), what)? as u32)
    }

    /// Everything after IF.
    pub(super) fn condition(&mut self) -> Parsed<Operation> {
        if self.accept_word(words::CONDITIONAL_BIT) || self.accept_word(words::COND_BIT) {
            let bit = self.bit()?;
            self.accept_word(words::IS);
            return Ok(Operation::IfConditionalBit {
                bit,
                on: self.one_of(&ON_OFF)?,
            });
        }
        if self.accept_word(words::PHASE) {
            self.accept_word(words::IS);
            return Ok(Operation::IfPhase(self.one_of(&ON_OFF)?));
        }
        if self.accept_word(words::LEVEL_OF_DETAIL) {
            let comparison = self.comparison()?;
            let level = self.level()?;
            return Ok(Operation::IfLevelOfDetail { comparison, level });
        }
        let known = &words::CONDITIONS;
        Err(self.unknown_word(words::listed(known), known))
    }

    fn comparison(&mut self) -> Parsed<Comparison> {
        if self.accept(Mark::Equals) {
            return Ok(Comparison::Equal);
        }
        if self.accept(Mark::Greater) {
            return Ok(if self.accept(Mark::Equals) {
                Comparison::GreaterEqual
            } else {
                Comparison::Greater
            });
        }
        if !self.accept(Mark::Less) {
            return Err(self.unexpected("one of <, =, <=, >, <> and >="));
        }
        Ok(if self.accept(Mark::Equals) {
            Comparison::LessEqual
        } else if self.accept(Mark::Greater) {
            Comparison::NotEqual
        } else {
            Comparison::Less
        })
    }

    fn level(&mut self) -> Parsed<i32> {
        let range = i64::from(i32::MIN)..=i64::from(i32::MAX);
        Ok(self.integer(range, "a level of detail")? as i32)
    }

    fn bit(&mut self) -> Parsed<u8> {
        let last = i64::from(Operation::CONDITIONAL_BITS) - 1;
        Ok(self.integer(0..=last, "the number of a conditional bit")? as u8)
    }
}
