//! Protocol 2.0 as bytes: numbers of instructions and errors, stuffing, status packets.
//!
//! Source: the maker's protocol 2.0 page.

use super::crc;
use crate::servo_bus::heard::Refusal;

/// What every packet begins with, the reserved byte included.
pub(in crate::servo_bus) const HEADER: [u8; 4] = [0xFF, 0xFF, 0xFD, 0x00];
/// Largest number a servo may have.
pub(in crate::servo_bus) const ID_MAX: u8 = 252;
/// Stands where a status packet would have its instruction.
pub(in crate::servo_bus) const STATUS: u8 = 0x55;
/// Bit 7 of the error byte: Hardware Error Status is not zero.
pub(in crate::servo_bus) const ALERT: u8 = 0x80;

/// Instruction numbers.
pub(in crate::servo_bus) mod instruction {
    pub(crate) const PING: u8 = 0x01;
    pub(crate) const READ: u8 = 0x02;
    pub(crate) const WRITE: u8 = 0x03;
    pub(crate) const REG_WRITE: u8 = 0x04;
    pub(crate) const ACTION: u8 = 0x05;
    pub(crate) const FACTORY_RESET: u8 = 0x06;
    pub(crate) const REBOOT: u8 = 0x08;
    pub(crate) const CLEAR: u8 = 0x10;
    pub(crate) const BACKUP: u8 = 0x20;
    pub(crate) const SYNC_READ: u8 = 0x82;
    pub(crate) const SYNC_WRITE: u8 = 0x83;
    pub(crate) const FAST_SYNC_READ: u8 = 0x8A;
    pub(crate) const BULK_READ: u8 = 0x92;
    pub(crate) const BULK_WRITE: u8 = 0x93;
    pub(crate) const FAST_BULK_READ: u8 = 0x9A;
}

/// Bits 6..0 of the error byte; zero is success.
pub(in crate::servo_bus) fn error_number(refusal: Option<Refusal>) -> u8 {
    match refusal {
        None => 0,
        Some(Refusal::Fail) => 1,
        Some(Refusal::Instruction) => 2,
        Some(Refusal::Checksum) => 3,
        Some(Refusal::Range) => 4,
        Some(Refusal::Length) => 5,
        Some(Refusal::Limit) => 6,
        Some(Refusal::Access) => 7,
    }
}

/// Appends the status packet of `id` with `params`, stuffed and checked.
pub(in crate::servo_bus) fn status(id: u8, error: u8, params: &[u8], out: &mut Vec<u8>) {
    let start = out.len();
    out.extend_from_slice(&HEADER);
    out.extend_from_slice(&[id, 0, 0]);
    let body = out.len();
    stuff(&[STATUS, error], body, out);
    stuff(params, body, out);
    let length = (out.len() - body + 2) as u16;
    out[start + 5..start + 7].copy_from_slice(&length.to_le_bytes());
    let checksum = crc::extend(0, &out[start..]);
    out.extend_from_slice(&checksum.to_le_bytes());
}

/// Appends `bytes`, with an `FD` after every `FF FF FD` among the unstuffed bytes since `body`.
fn stuff(bytes: &[u8], body: usize, out: &mut Vec<u8>) {
    for &byte in bytes {
        out.push(byte);
        if out.len() - body >= 3 && out.ends_with(&[0xFF, 0xFF, 0xFD]) {
            out.push(0xFD);
        }
    }
}

/// Removes the stuffing from `packet[from..to]` in place; gives the new end.
pub(in crate::servo_bus) fn unstuff(packet: &mut [u8], from: usize, to: usize) -> usize {
    let mut end = from;
    let mut matched = 0;
    let mut skip = false;
    for at in from..to {
        let byte = packet[at];
        if skip {
            skip = false;
            matched = 0;
            // An FD here is stuffing; anything else is a sender that does not stuff, and stays.
            if byte == 0xFD {
                continue;
            }
        }
        packet[end] = byte;
        end += 1;
        matched = match (matched, byte) {
            (0, 0xFF) => 1,
            (1 | 2, 0xFF) => 2,
            (2, 0xFD) => 3,
            _ => 0,
        };
        skip = matched == 3;
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn status_packets_match_the_worked_vectors() {
        // Worked out twice by hand for `docs/protocols/dynamixel2.md`.
        let table: [(&[u8], &[u8]); 3] = [
            (
                &[0xFF, 0xFF, 0xFD, 0xFD],
                &[9, 0, 0x55, 0, 0xFF, 0xFF, 0xFD, 0xFD, 0xFD, 0xD5, 0x1E],
            ),
            (
                &[0xFF, 0xFF, 0xFD, 0xFF, 0xFF, 0xFF],
                &[
                    11, 0, 0x55, 0, 0xFF, 0xFF, 0xFD, 0xFD, 0xFF, 0xFF, 0xFF, 0x58, 0x6C,
                ],
            ),
            (
                &[0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD, 0xFF, 0xFF, 0xFF],
                &[
                    15, 0, 0x55, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD, 0xFD, 0xFF, 0xFF, 0xFF, 0xFC,
                    0x74,
                ],
            ),
        ];
        for (params, tail) in table {
            let mut out = Vec::new();
            status(1, 0, params, &mut out);
            assert_eq!(out[..5], [0xFF, 0xFF, 0xFD, 0, 1]);
            assert_eq!(out[5..], *tail);
        }
    }

    proptest! {
        #[test]
        fn unstuffing_undoes_stuffing(bytes in proptest::collection::vec(
            prop_oneof![Just(0xFFu8), Just(0xFD), Just(0x00), Just(0x01)], 0..64)) {
            let mut out = Vec::new();
            stuff(&bytes, 0, &mut out);
            // No header can appear in what was stuffed.
            prop_assert!(!out.windows(4).any(|window| window == HEADER));
            let len = out.len();
            let end = unstuff(&mut out, 0, len);
            prop_assert_eq!(&out[..end], &bytes[..]);
        }
    }
}
