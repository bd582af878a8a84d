//! Finds instruction packets in the bytes on the wire, as a servo does: header, number, length, checksum.
//!
//! Source: the maker's protocol 2.0 page, "Processing Order of Reception". The page says that a servo drops
//! a packet whose bytes lie more than 1.5 ms apart. What happens after a wrong checksum it does not say:
//! the maker's own device-side library stays silent, so that is the default here.

use super::crc;
use super::packet::{HEADER, unstuff};
use crate::servo_bus::heard::{Framing, Heard};

/// Longest idle time between two bytes of one packet.
const GAP_MAX_NS: u64 = 1_500_000;
/// Longest packet a servo has room for. Ours: the whole table fits several times.
const LENGTH_MAX: usize = 2048;
/// Bytes before the counted ones: header, number, length.
const PREFIX: usize = 7;

/// What a servo does with a packet whose checksum is wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BadCrc {
    /// Drops it.
    #[default]
    Silent,
    /// Answers error 3, if the packet was for it alone.
    Answer,
}

/// What a servo makes of an unstuffed header inside a packet; hosts that do not stuff send them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InnerHeader {
    /// Data like any other: the length rules.
    #[default]
    Data,
    /// The start of a new packet.
    Restart,
}

/// The bytes of the packet in hand.
#[derive(Clone, Debug, Default)]
pub(in crate::servo_bus) struct Receiver {
    packet: Vec<u8>,
    params_end: usize,
    began_ns: u64,
    inner_header: InnerHeader,
    /// Packets dropped: by a gap, a length no servo can take, or a wrong checksum.
    pub(in crate::servo_bus) dropped: u64,
}

impl Receiver {
    pub(in crate::servo_bus) fn new(inner_header: InnerHeader) -> Self {
        Self {
            inner_header,
            ..Self::default()
        }
    }

    /// Takes the byte that was complete at `end_ns`, `idle_ns` after the one before.
    pub(in crate::servo_bus) fn push(&mut self, idle_ns: u64, end_ns: u64, byte: u8) -> Option<Heard> {
        if idle_ns > GAP_MAX_NS {
            self.give_up();
        }
        if self.packet.is_empty() {
            self.began_ns = end_ns;
        }
        if self.packet.len() < HEADER.len() {
            self.seek(byte);
            return None;
        }
        self.packet.push(byte);
        if self.packet.len() < PREFIX {
            return None;
        }
        let restarts = self.inner_header == InnerHeader::Restart;
        if restarts && self.packet.len() > PREFIX + HEADER.len() && self.packet.ends_with(&HEADER) {
            self.dropped += 1;
            self.packet.truncate(HEADER.len());
            return None;
        }
        let counted = usize::from(u16::from_le_bytes([self.packet[5], self.packet[6]]));
        if !(3..=LENGTH_MAX).contains(&counted) {
            self.dropped += 1;
            self.packet.clear();
            return None;
        }
        (self.packet.len() == PREFIX + counted).then(|| self.complete())
    }

    /// Parameters of the instruction last heard, valid until the next byte.
    pub(in crate::servo_bus) fn params(&self) -> &[u8] {
        self.packet.get(PREFIX + 1..self.params_end).unwrap_or_default()
    }

    /// Makes room for the next packet; to be called when the parameters have been used.
    pub(in crate::servo_bus) fn clear(&mut self) {
        self.packet.clear();
    }

    /// Drops a packet that will not be completed.
    pub(in crate::servo_bus) fn give_up(&mut self) {
        self.dropped += u64::from(self.packet.len() > HEADER.len());
        self.packet.clear();
    }

    /// Grows the longest part of a header that the bytes so far end with.
    fn seek(&mut self, byte: u8) {
        self.packet.push(byte);
        while !self.packet.is_empty() && !HEADER.starts_with(&self.packet) {
            self.packet.remove(0);
        }
    }

    fn complete(&mut self) -> Heard {
        let end = self.packet.len() - 2;
        let sent = u16::from_le_bytes([self.packet[end], self.packet[end + 1]]);
        let is_whole = crc::extend(0, &self.packet[..end]) == sent;
        if is_whole {
            self.params_end = unstuff(&mut self.packet, PREFIX, end);
        } else {
            self.dropped += 1;
            self.params_end = 0;
        }
        Heard {
            framing: Framing::Dynamixel2,
            began_ns: self.began_ns,
            id: self.packet[4],
            instruction: is_whole.then(|| self.packet[PREFIX]),
        }
    }
}
