//! The command language: text to commands and diagnostics, and back.
//!
//! Start at [`Command`]. [`parse`] reads a text, [`print()`] writes the canonical form of a command.
//!
//! What is known of the language, and from where, is in `docs/protocols/ps300.md`. Decisions of this
//! project, where that record is silent, stand at the top of the file that makes them: comments and quotes
//! in `lexer`, values in `parser/literal`, vector lists in `parser/vectors`, curves in `parser/curve`, texts and
//! fonts in `parser/characters`, faces in `parser/face`, structures in `parser/definition`, recovery in `parser`.
//! [`FORMS`] lists the whole language with examples.

mod command;
mod diagnostic;
mod forms;
mod lexer;
mod name;
mod node;
mod parser;
mod print;
mod reports;
mod token;
mod words;

pub use command::{
    Command, Definition, Disconnection, Initialization, Input, InputOf, OutputOf, Payload, Text,
};
pub use diagnostic::{Diagnostic, Located, Position, Severity};
pub use forms::{FORMS, Form, Section};
pub use name::Name;
pub(crate) use name::Spelling;
pub use node::{
    Attributes, Axis, BSpline, Boundaries, Characters, Comparison, Dimension, Font, Glyph, GlyphVector,
    Illumination, Label, Labels, Member, Node, Operation, Pattern, Polygon, PolygonVertex, Polynomial, Range,
    Surface, SurfaceColor, Vector, VectorClass, VectorList,
};
pub use parser::parse;
pub use print::{literal, print};
pub use words::KEYWORDS;
