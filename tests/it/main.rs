//! The whole rig under test, in one binary.

mod directions;
mod golden;
mod source;
mod tidy;
