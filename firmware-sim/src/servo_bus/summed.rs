//! The older framing, of DYNAMIXEL 1.0 and of Feetech's servos: a one-byte length, and a sum over the packet.
//!
//! Source: the maker's protocol 1.0 page; Feetech's instruction numbers from its published libraries
//! (`INST.h`).

pub(super) mod orders;
pub(super) mod packet;
pub(super) mod receiver;
