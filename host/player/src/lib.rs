//! The only loop that can move a motor.
