//! What the bytes at the front of the line's buffer are: the start of a packet, a whole one, or garbage.
//!
//! Pure functions of bytes. Sources: the order of reception in the ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0"
//! (header, but not `FF FF FD FD`; id; length; that many bytes; CRC) and the frame of "DYNAMIXEL Protocol 1.0".

use super::dynamixel2::{self, STATUS, crc};
use super::summed;

/// Longest packet of protocol 2.0 accepted, in bytes of the length field, while nothing is known of what was asked.
/// A whole control table of an X-series servo (662 bytes) fits, stuffed at its worst.
pub(super) const LENGTH_MAX: usize = 1024;
/// Shortest value of protocol 2.0's length field: instruction and CRC.
const STUFFED_LENGTH_MIN: usize = 3;
/// Shortest value of protocol 1.0's length field: instruction and sum.
const SUMMED_LENGTH_MIN: usize = 2;
/// Bytes of the CRC.
pub(super) const CRC_BYTES: usize = 2;

/// What the bytes at the front are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Front {
    /// Not the start of a packet: drop so many bytes.
    Skip(usize),
    /// A header whose packet cannot be right: drop its first byte and look again.
    Reject,
    /// More bytes are needed to tell.
    Short,
    /// A packet of so many bytes in all, whose checksum is right.
    Whole(usize),
    /// The head of an answer to a fast read.
    Fast,
}

/// Protocol 2.0. `answer_max` bounds the length field of answers, `fast` is what it must be in the answer to a fast
/// read, if there was one.
pub(super) fn stuffed(bytes: &[u8], answer_max: usize, fast: Option<usize>) -> Front {
    if let Some(front) = until_header(bytes, &dynamixel2::HEADER) {
        return front;
    }
    let &[_, _, _, _, id, low, high, instruction, ..] = bytes else {
        return Front::Short;
    };
    let length = usize::from(u16::from_le_bytes([low, high]));
    if instruction == STATUS && id == super::BROADCAST_ID {
        return if fast == Some(length) {
            Front::Fast
        } else {
            Front::Reject
        };
    }
    let length_max = if instruction == STATUS {
        answer_max
    } else {
        LENGTH_MAX
    };
    if id == 0xff || length < STUFFED_LENGTH_MIN || length > length_max {
        return Front::Reject;
    }
    let whole = dynamixel2::BODY_AT + length;
    let Some(packet) = bytes.get(..whole) else {
        return Front::Short;
    };
    let (covered, sum) = packet.split_at(whole - CRC_BYTES);
    if sum == crc(covered).to_le_bytes() {
        Front::Whole(whole)
    } else {
        Front::Reject
    }
}

/// Protocol 1.0 and Feetech. `length_max` bounds the length field.
pub(super) fn summed(bytes: &[u8], length_max: usize) -> Front {
    if let Some(front) = until_header(bytes, &summed::HEADER) {
        return front;
    }
    let &[_, _, id, length, ..] = bytes else {
        return Front::Short;
    };
    if id == 0xff {
        // A run of FF: the header may begin one later.
        return Front::Skip(1);
    }
    let length = usize::from(length);
    if length < SUMMED_LENGTH_MIN || length > length_max {
        return Front::Reject;
    }
    let whole = summed::PREFIX_BYTES + length;
    let Some(packet) = bytes.get(..whole) else {
        return Front::Short;
    };
    match packet.get(summed::HEADER.len()..).and_then(<[u8]>::split_last) {
        Some((&sum, covered)) if sum == summed::checksum(covered) => Front::Whole(whole),
        _ => Front::Reject,
    }
}

/// None when the bytes begin with the whole header.
fn until_header(bytes: &[u8], header: &[u8]) -> Option<Front> {
    let matching = bytes
        .iter()
        .zip(header)
        .take_while(|(have, want)| have == want)
        .count();
    if matching == header.len() {
        return None;
    }
    if matching == bytes.len() {
        return Some(Front::Short);
    }
    let next = bytes.iter().skip(1).position(|byte| header.first() == Some(byte));
    Some(Front::Skip(next.map_or(bytes.len(), |at| at + 1)))
}
