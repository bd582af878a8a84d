//! A PS 300 without its hardware: function network, command language and display structure.
//!
//! Knows: values, commands, functions, display nodes, and network time as a number it is given.
//! Must not know: files, clocks, threads, devices, figures, or where a picture is drawn; nothing here
//! reads or waits, and the same calls give the same results in every run.
//! Start reading at [`machine::Machine`], then [`network`] for how messages move and [`intrinsic`] for
//! what functions do with them. The record behind it all is `docs/protocols/ps300.md`.

pub mod display;
pub mod intrinsic;
pub mod language;
pub mod machine;
mod names;
pub mod network;
pub mod pick;
mod structure;
pub mod value;

pub use display::{DisplayList, Stroke};
pub use language::{Command, Diagnostic};
pub use machine::Machine;
pub use network::{Limits, Ran, Report, SinkId};
pub use value::{Kind, Kinds, Value};
