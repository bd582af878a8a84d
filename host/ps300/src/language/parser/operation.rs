//! Operation nodes by their first word, and the transforms among them.
//! Source: `docs/protocols/ps300.md`, section "Modelling transforms and viewing".

use glam::{DVec2, DVec3};

use super::{Parsed, Parser};
use crate::language::token::Mark;
use crate::language::words::{self, Word};
use crate::language::{Axis, Operation};

use super::literal::{matrix2, matrix3, matrix4, matrix4x3};

/// What makes CHARACTERS an operation on the texts below instead of a text.
const CHARACTER_WORDS: [Word; 3] = [words::SCALE, words::ROTATE, words::FONT];

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
        if self.is_word_before_one_of(words::CHARACTERS, &CHARACTER_WORDS) {
            self.advance();
            return self.character_operation().map(Some);
        }
        let forms: [(Word, Form<'s>); 23] = [
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
            (words::EYE, Self::eye),
            (words::VIEWPORT, Self::viewport),
            (words::SET, Self::set),
            (words::IF, Self::condition),
            (words::INCREMENT, |parser| {
                parser.expect_word(words::LEVEL_OF_DETAIL)?;
                Ok(Operation::IncrementLevelOfDetail)
            }),
            (words::DECREMENT, |parser| {
                parser.expect_word(words::LEVEL_OF_DETAIL)?;
                Ok(Operation::DecrementLevelOfDetail)
            }),
            (words::STANDARD, |parser| {
                parser.expect_word(words::FONT)?;
                Ok(Operation::StandardFont)
            }),
            (words::TEXT, |parser| {
                parser.expect_word(words::SIZE)?;
                Ok(Operation::TextSize(parser.number("the size of characters")?))
            }),
            (words::XFORM, |parser| {
                let matrix = parser.one_of(&[(words::MATRIX, true), (words::VECTOR_LIST, false)])?;
                Ok(if matrix {
                    Operation::XformMatrix
                } else {
                    Operation::XformVectorList
                })
            }),
            (words::SURFACE_RENDERING, |_| Ok(Operation::SurfaceRendering)),
            (words::SOLID_RENDERING, |_| Ok(Operation::SolidRendering)),
            (words::SECTIONING_PLANE, |_| Ok(Operation::SectioningPlane)),
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

    /// Everything after CHARACTER, where SCALE, ROTATE or FONT stands.
    fn character_operation(&mut self) -> Parsed<Operation> {
        if self.accept_word(words::FONT) {
            return Ok(Operation::CharacterFont(self.name("the name of a font")?));
        }
        if self.accept_word(words::ROTATE) {
            return Ok(Operation::CharacterRotate {
                degrees: self.number("an angle in degrees")?,
            });
        }
        self.expect_word(words::SCALE)?;
        let x = self.number("a factor")?;
        let y = if self.accept(Mark::Comma) {
            self.number("the factor of heights")?
        } else {
            x
        };
        Ok(Operation::CharacterScale(DVec2::new(x, y)))
    }
}
