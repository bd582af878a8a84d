//! Operation nodes: transforms, attributes, conditions.
//! Source: `docs/protocols/ps300.md`, sections "Modelling transforms and viewing" and "Attributes,
//! conditionals".

use glam::DVec3;

use super::{Parsed, Parser};
use crate::language::token::{Mark, TokenKind};
use crate::language::words::{self, Word};
use crate::language::{Axis, Diagnostic, Operation};

use super::literal::{matrix2, matrix3, matrix4, matrix4x3};

const ON_OFF: [(Word, bool); 2] = [(words::ON, true), (words::OFF, false)];

type Form<'s> = fn(&mut Parser<'s>) -> Parsed<Operation>;

impl<'s> Parser<'s> {
    /// An operation without what it is applied to, after FOLLOW and PREFIX.
    pub(super) fn lone_operation(&mut self) -> Parsed<Operation> {
        match self.operation()? {
            Some(operation) => Ok(operation),
            None => Err(self.unknown_word("an operation, such as ROTATE or SET COLOR", &words::NODES)),
        }
    }

    /// An operation, if the word here begins one.
    pub(super) fn operation(&mut self) -> Parsed<Option<Operation>> {
        let forms: [(Word, Form<'s>); 14] = [
            (words::ROTATE, Self::rotate),
            (words::TRANSLATE, Self::translate),
            (words::SCALE, Self::scale),
            (words::MATRIX2, |parser| {
                Ok(Operation::Matrix2(matrix2(&parser.numbers::<4>()?)))
            }),
            (words::MATRIX3, |parser| {
                Ok(Operation::Matrix3(matrix3(&parser.numbers::<9>()?)))
            }),
            (words::MATRIX4X3, |parser| {
                Ok(Operation::Matrix4x3(matrix4x3(&parser.numbers::<12>()?)))
            }),
            (words::MATRIX4, |parser| {
                Ok(Operation::Matrix4(matrix4(&parser.numbers::<16>()?)))
            }),
            (words::LOOK, Self::look),
            (words::FIELD_OF_VIEW, Self::field_of_view),
            (words::FOV, Self::field_of_view),
            (words::WINDOW, Self::window),
            (words::VIEWPORT, Self::viewport),
            (words::SET, Self::set),
            (words::IF, Self::condition),
        ];
        let Some(&(_, form)) = forms.iter().find(|(word, _)| self.is_word(*word)) else {
            return Ok(None);
        };
        self.advance();
        form(self).map(Some)
    }

    fn numbers<const COUNT: usize>(&mut self) -> Parsed<[f64; COUNT]> {
        let mut numbers = [0.0; COUNT];
        self.matrix_numbers(&mut numbers)?;
        Ok(numbers)
    }

    fn rotate(&mut self) -> Parsed<Operation> {
        self.accept_word(words::IN);
        let axis = self.one_of(&[(words::X, Axis::X), (words::Y, Axis::Y), (words::Z, Axis::Z)])?;
        Ok(Operation::Rotate {
            axis,
            degrees: self.number("an angle in degrees")?,
        })
    }

    fn translate(&mut self) -> Parsed<Operation> {
        self.accept_word(words::BY);
        Ok(Operation::Translate(self.point("the translation")?))
    }

    fn scale(&mut self) -> Parsed<Operation> {
        self.accept_word(words::BY);
        let (factors, count) = self.components(1, DVec3::ONE, "a factor")?;
        Ok(Operation::Scale(if count == 1 {
            DVec3::splat(factors.x)
        } else {
            factors
        }))
    }

    /// AT, FROM and UP in any order, UP optional.
    fn look(&mut self) -> Parsed<Operation> {
        let parts = [words::AT, words::FROM, words::UP];
        let mut points = [None; 3];
        while let Some(index) = parts.iter().position(|&word| self.is_word(word)) {
            if points[index].is_some() {
                let message = format!("{} is said twice", parts[index].full);
                return Err(Diagnostic::error(self.current.at, message).into());
            }
            self.advance();
            points[index] = Some(self.point(parts[index].full)?);
        }
        match points {
            [Some(at), Some(from), up] => Ok(Operation::Look { at, from, up }),
            [None, ..] => Err(self.unknown_word("AT x,y,z", &parts)),
            _ => Err(self.unknown_word("FROM x,y,z", &parts)),
        }
    }

    fn field_of_view(&mut self) -> Parsed<Operation> {
        let degrees = self.number("an angle in degrees")?;
        Ok(Operation::FieldOfView {
            degrees,
            boundaries: self.boundaries()?,
        })
    }

    fn window(&mut self) -> Parsed<Operation> {
        let x = self.range_after(words::X, "the left and right edge, as -1:1")?;
        let y = self.range_after(words::Y, "the lower and upper edge, as -1:1")?;
        Ok(Operation::Window {
            x,
            y,
            boundaries: self.boundaries()?,
        })
    }

    fn viewport(&mut self) -> Parsed<Operation> {
        let horizontal = self.range_after(words::HORIZONTAL, "the left and right edge, as -1:1")?;
        let vertical = self.range_after(words::VERTICAL, "the lower and upper edge, as -1:1")?;
        let intensity = if self.is_word(words::INTENSITY) {
            Some(self.range_after(words::INTENSITY, "the lowest and highest intensity, as 0:1")?)
        } else {
            None
        };
        Ok(Operation::Viewport {
            horizontal,
            vertical,
            intensity,
        })
    }

    fn set(&mut self) -> Parsed<Operation> {
        if self.accept_word(words::COLOR) {
            let hue = self.pair("hue and saturation, as 120,1")?;
            return Ok(Operation::SetColor {
                hue_deg: hue.x,
                saturation: hue.y,
            });
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
        Err(self.unknown_word(words::listed(&words::ATTRIBUTES), &words::ATTRIBUTES))
    }

    fn set_picking(&mut self) -> Parsed<Operation> {
        if self.is_word_before(words::IDENTIFIER, Mark::Equals) {
            self.advance();
            self.advance();
            return Ok(Operation::SetPickingIdentifier(self.name("a pick identifier")?));
        }
        if !matches!(self.current.kind, TokenKind::Word(_)) {
            return Err(self.unexpected("ON, OFF or IDENTIFIER=name"));
        }
        Ok(Operation::SetPicking(self.one_of(&ON_OFF)?))
    }

    fn condition(&mut self) -> Parsed<Operation> {
        if !self.accept_word(words::CONDITIONAL_BIT) && !self.accept_word(words::COND_BIT) {
            return Err(self.unknown_word(words::CONDITIONAL_BIT.full, &[words::CONDITIONAL_BIT]));
        }
        let bit = self.bit()?;
        self.accept_word(words::IS);
        Ok(Operation::IfConditionalBit {
            bit,
            on: self.one_of(&ON_OFF)?,
        })
    }

    fn bit(&mut self) -> Parsed<u8> {
        let last = i64::from(Operation::CONDITIONAL_BITS) - 1;
        Ok(self.integer(0..=last, "the number of a conditional bit")? as u8)
    }
}
