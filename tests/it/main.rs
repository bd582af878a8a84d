//! The whole rig under test, in one binary.

mod directions;
mod source;
mod tidy;
