//! Viewing nodes.
//! Source: `docs/protocols/ps300.md`, section "Modelling transforms and viewing".

use super::{Parsed, Parser};
use crate::language::words;
use crate::language::{Diagnostic, Operation};

impl Parser<'_> {
    /// AT, FROM and UP in any order, UP optional.
    pub(super) fn look(&mut self) -> Parsed<Operation> {
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

    pub(super) fn field_of_view(&mut self) -> Parsed<Operation> {
        let degrees = self.number("an angle in degrees")?;
        Ok(Operation::FieldOfView {
            degrees,
            boundaries: self.boundaries()?,
        })
    }

    pub(super) fn window(&mut self) -> Parsed<Operation> {
        let x = self.range_after(words::X, "the left and right edge, as -1:1")?;
        let y = self.range_after(words::Y, "the lower and upper edge, as -1:1")?;
        Ok(Operation::Window {
            x,
            y,
            boundaries: self.boundaries()?,
        })
    }

    pub(super) fn viewport(&mut self) -> Parsed<Operation> {
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

    /// `BACK z [LEFT/RIGHT x] [UP/DOWN y] FROM SCREEN [AREA] w WIDE [FRONT … BACK …]`.
    pub(super) fn eye(&mut self) -> Parsed<Operation> {
        self.expect_word(words::BACK)?;
        let back = self.number("how far the eye is behind the screen")?;
        let (mut right, mut up) = (0.0, 0.0);
        loop {
            if self.accept_word(words::RIGHT) {
                right = self.number("how far right of the middle")?;
            } else if self.accept_word(words::LEFT) {
                right = -self.number("how far left of the middle")?;
            } else if self.accept_word(words::UP) {
                up = self.number("how far above the middle")?;
            } else if self.accept_word(words::DOWN) {
                up = -self.number("how far below the middle")?;
            } else {
                break;
            }
        }
        self.expect_word(words::FROM)?;
        self.expect_word(words::SCREEN)?;
        self.accept_word(words::AREA);
        let width = self.number("the width of the screen")?;
        self.expect_word(words::WIDE)?;
        Ok(Operation::Eye {
            back,
            right,
            up,
            width,
            boundaries: self.boundaries()?,
        })
    }
}
