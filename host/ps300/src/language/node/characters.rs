//! Texts in the model's space.

use glam::{DVec2, DVec3};

use crate::language::Text;

/// `CHARACTERS [x,y[,z]] [STEP dx,dy] 'text'`.
#[derive(Clone, Debug, PartialEq)]
pub struct Characters {
    /// Lower left corner of the first character; the origin unless written.
    pub at: DVec3,
    /// From one character to the next, in character widths and heights; (1, 0) unless written.
    pub step: DVec2,
    /// What is written.
    pub text: Text,
}

/// `LABELS x,y[,z] 'text' …`: many texts as one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Labels {
    /// In drawing order.
    pub labels: Vec<Label>,
}

/// One text of a [`Labels`] node.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Lower left corner of its first character.
    pub at: DVec3,
    /// What is written.
    pub text: Text,
}
