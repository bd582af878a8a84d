//! Why a packet could not be built.

use super::instruction::Instruction;
use device_profiles::ServoProtocol;

/// Why a packet could not be built. Nothing is appended to the caller's buffer then.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FramingError {
    /// The length field has 16 bits in protocol 2.0 and 8 in the others.
    #[error("a packet with {bytes} bytes of parameters does not fit its length field: send less at once")]
    TooLong {
        /// Parameters after stuffing.
        bytes: usize,
    },
    /// Above the highest id, or the broadcast id where it cannot be used.
    #[error("{id} is not the id of a servo: ids run from 0 to {max}")]
    NotAnId {
        /// What was asked for.
        id: u8,
        /// The protocol's highest.
        max: u8,
    },
    /// Addresses and lengths have 8 bits in all protocols but 2.0.
    #[error("{value} as {what} does not fit the 8 bits that {protocol} has for it")]
    TooWide {
        /// Address or length.
        what: &'static str,
        /// Its value.
        value: u16,
        /// The protocol.
        protocol: ServoProtocol,
    },
    /// The maker has no such instruction.
    #[error("{protocol} has no {instruction}")]
    Lacks {
        /// The protocol.
        protocol: ServoProtocol,
        /// What was asked for.
        instruction: Instruction,
    },
    /// Bulk instructions name a servo once.
    #[error("servo {id} is named twice in one bulk instruction: name it once, or send two")]
    Twice {
        /// The id.
        id: u8,
    },
    /// A sync write has one width for all.
    #[error("sync write: {got} bytes for servo {id}, but {want} for the first; all must have the same")]
    Width {
        /// Whose bytes.
        id: u8,
        /// The first servo's.
        want: usize,
        /// Its own.
        got: usize,
    },
}
