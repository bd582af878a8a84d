//! Pictures, looked at once by a person and from then on by these tests.

mod calibrate;
mod controls;
mod hands;
mod patch;
mod puppets;
mod render;
mod structures;
mod studio;
mod walker;
