//! Rendering nodes: what messages have told them to show.
//!
//! Source: `docs/protocols/ps300.md`, "Codes sent to <1> of a rendering node".

use crate::network::Refusal;
use crate::value::{Kinds, Value};

/// How polygons below a rendering node are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Drawing {
    /// The lines in which the section plane cuts them.
    CrossSection,
    /// What is left behind the section plane, lit.
    Sectioned,
    /// The edges of faces seen from their front.
    BackFacesRemoved,
    /// Edges that nothing hides.
    HiddenLinesRemoved,
    /// Filled with their own colour.
    Wash,
    /// Lit, each polygon evenly.
    Flat,
    /// Lit, each point.
    Smooth,
}

/// A rendering node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) struct Rendering {
    /// Closed volumes: back faces are not seen, cuts are closed.
    pub(in super::super) solid: bool,
    /// What is shown instead of the original.
    pub(in super::super) shown: Option<Drawing>,
    last: Option<Drawing>,
}

impl Rendering {
    pub(super) fn new(solid: bool) -> Self {
        Self {
            solid,
            shown: None,
            last: None,
        }
    }

    pub(super) fn feed(&mut self, second: bool, value: &Value) -> Result<(), Refusal> {
        match (second, value) {
            (true, Value::Boolean(solid)) => self.solid = *solid,
            (false, Value::Boolean(true)) => self.shown = self.last,
            (false, Value::Boolean(false)) => self.shown = None,
            (false, Value::Integer(code)) => self.render(*code)?,
            _ => return Err(Refusal::Kind(Kinds::BOOLEAN)),
        }
        Ok(())
    }

    /// What a toggle has come to; told again, that has the same effect and the toggle has not.
    pub(super) fn outcome(self, value: &Value) -> Option<Value> {
        (*value == Value::Integer(0)).then_some(Value::Boolean(self.shown.is_some()))
    }

    fn render(&mut self, code: i32) -> Result<(), Refusal> {
        let drawing = match code {
            0 => {
                self.shown = if self.shown.is_some() { None } else { self.last };
                return Ok(());
            }
            1 => Drawing::CrossSection,
            2 => Drawing::Sectioned,
            3 => Drawing::BackFacesRemoved,
            4 => Drawing::HiddenLinesRemoved,
            5 => Drawing::Wash,
            6 => Drawing::Flat,
            7 => Drawing::Smooth,
            _ => return Err(Refusal::Domain("renderings are numbered from 0 to 7")),
        };
        self.shown = Some(drawing);
        self.last = self.shown;
        Ok(())
    }
}
