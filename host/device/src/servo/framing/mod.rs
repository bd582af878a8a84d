//! Servo packet formats: bytes and state only, no transport, no clock.
//!
//! Apart from the bus so that a file of bytes can be decoded without opening anything.

pub mod decoder;
pub mod dynamixel2;
