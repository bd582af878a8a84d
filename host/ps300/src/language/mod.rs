//! The command language: text to commands and diagnostics, and back.
//!
//! Start at [`Command`].

mod command;
mod diagnostic;
mod name;
mod node;

pub use command::{
    Command, Definition, Disconnection, Initialization, Input, InputOf, OutputOf, Payload, Text,
};
pub use diagnostic::{Diagnostic, Located, Position, Severity};
pub use name::Name;
pub use node::{
    Axis, Boundaries, Characters, Member, Node, Operation, Range, Vector, VectorClass, VectorList,
};
