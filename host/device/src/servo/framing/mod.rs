//! Servo packet formats: bytes and state only, no transport, no clock.
//!
//! Apart from the bus so that a file of bytes can be decoded without opening anything. [`dynamixel2`],
//! [`dynamixel1`] and [`feetech`] build packets as their makers describe them; the functions here build the same
//! for whichever protocol a servo speaks, and say so where it has no such instruction. [`Decoder`] is the way back
//! for all of them. What registers mean is not known here: data are bytes.

pub mod decoder;
pub mod dynamixel1;
pub mod dynamixel2;
pub mod feetech;

mod asked;
mod build;
mod error;
mod fast;
mod front;
mod instruction;
mod status;
mod summed;

pub use build::{
    action, backup, bulk_read, bulk_write, calibrate, clear, factory_reset, fast_bulk_read, fast_sync_read,
    ping, read, reboot, reg_write, sync_read, sync_write, write,
};
pub use decoder::{Decoder, DecoderCounters, Heard, Packet};
pub use error::FramingError;
pub use instruction::{Backup, Instruction, Keep, has, id_max};
pub use status::{Status, StatusError};

/// The id all servos listen to, in every protocol. None answers it, but for pings and group reads.
pub const BROADCAST_ID: u8 = 0xfe;

use device_profiles::ServoProtocol;

/// Bytes of a status packet around its data, for reckoning how long an answer takes on the wire.
pub fn status_overhead_bytes(protocol: ServoProtocol) -> usize {
    match protocol {
        ServoProtocol::Dynamixel2 => dynamixel2::STATUS_OVERHEAD_BYTES,
        ServoProtocol::Dynamixel1 | ServoProtocol::Sts | ServoProtocol::Scs => {
            dynamixel1::STATUS_OVERHEAD_BYTES
        }
    }
}

#[cfg(test)]
#[path = "documented_tests.rs"]
mod documented_tests;

#[cfg(test)]
#[path = "framing_tests.rs"]
mod framing_tests;
