//! Finds packets with a sum in the bytes on the wire: two `FF`, number, length, checksum.
//!
//! Source: the maker's protocol 1.0 page. A servo drops a packet whose bytes lie more than 100 ms apart; of
//! Feetech's servos that time is not known, and taken to be the same.

use super::packet::{HEADER, sum};
use crate::servo_bus::heard::{Framing, Heard};

/// Longest idle time between two bytes of one packet.
const GAP_MAX_NS: u64 = 100_000_000;
/// Bytes before the counted ones: header, number, length.
const PREFIX: usize = 4;
/// What a header of protocol 2.0 looks like from here: a number, and a length no packet has.
const FOREIGN: [u8; 2] = [0xFD, 0x00];

/// The bytes of the packet in hand.
#[derive(Clone, Debug, Default)]
pub(in crate::servo_bus) struct Receiver {
    packet: Vec<u8>,
    began_ns: u64,
    /// Packets dropped: by a gap, a length no packet has, or a wrong checksum.
    pub(in crate::servo_bus) dropped: u64,
}

impl Receiver {
    /// Takes the byte that was complete at `end_ns`, `idle_ns` after the one before.
    pub(in crate::servo_bus) fn push(&mut self, idle_ns: u64, end_ns: u64, byte: u8) -> Option<Heard> {
        if idle_ns > GAP_MAX_NS {
            self.give_up();
        }
        if self.packet.is_empty() {
            self.began_ns = end_ns;
        }
        match self.packet.len() {
            0 | 1 if byte != HEADER => {
                self.packet.clear();
                return None;
            }
            // A third FF: the header may end here as well.
            2 if byte == HEADER => return None,
            _ => self.packet.push(byte),
        }
        if self.packet.len() < PREFIX {
            return None;
        }
        let counted = usize::from(self.packet[3]);
        if counted < 2 {
            self.dropped += u64::from(self.packet[2..] != FOREIGN);
            self.packet.clear();
            return None;
        }
        (self.packet.len() == PREFIX + counted).then(|| self.complete())
    }

    /// Parameters of the instruction last heard, valid until the next byte.
    pub(in crate::servo_bus) fn params(&self) -> &[u8] {
        let end = self.packet.len().saturating_sub(1);
        self.packet.get(PREFIX + 1..end).unwrap_or_default()
    }

    /// Makes room for the next packet; to be called when the parameters have been used.
    pub(in crate::servo_bus) fn clear(&mut self) {
        self.packet.clear();
    }

    /// Drops a packet that will not be completed.
    pub(in crate::servo_bus) fn give_up(&mut self) {
        self.dropped += u64::from(self.packet.len() > 2);
        self.packet.clear();
    }

    fn complete(&mut self) -> Heard {
        let (last, checked) = (self.packet[self.packet.len() - 1], self.packet.len() - 1);
        let is_whole = sum(&self.packet[2..checked]) == last;
        self.dropped += u64::from(!is_whole);
        Heard {
            framing: Framing::Summed,
            began_ns: self.began_ns,
            id: self.packet[2],
            instruction: is_whole.then(|| self.packet[PREFIX]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn hear(receiver: &mut Receiver, bytes: &[u8]) -> Vec<(u8, Option<u8>, Vec<u8>)> {
        let mut packets = Vec::new();
        for &byte in bytes {
            if let Some(heard) = receiver.push(0, 0, byte) {
                packets.push((heard.id, heard.instruction, receiver.params().to_vec()));
                receiver.clear();
            }
        }
        packets
    }

    #[test]
    fn a_packet_is_found_behind_anything() {
        let table: [(&[u8], u64, &str); 6] = [
            (&[], 0, "nothing"),
            (&[0xFF], 0, "a third FF"),
            (&[0x00, 0x12, 0xFF, 0x34], 0, "bytes that begin nothing"),
            (&[0xFF, 0xFF, 0x01, 0x01], 1, "a length no packet has"),
            (
                &[0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x01, 0x19, 0x4E],
                0,
                "protocol 2.0",
            ),
            (&[0xFF, 0xFF, 0x01, 0x02, 0x01, 0x00], 1, "a wrong sum"),
        ];
        for (before, dropped, what) in table {
            let mut receiver = Receiver::default();
            let ping = [0xFF, 0xFF, 0x01, 0x02, 0x01, 0xFB];
            let heard = hear(&mut receiver, &[before, &ping].concat());
            assert_eq!(heard.last(), Some(&(1, Some(1), vec![])), "{what}");
            assert_eq!(receiver.dropped, dropped, "{what}");
        }
    }

    #[test]
    fn a_gap_ends_a_packet() {
        let mut receiver = Receiver::default();
        hear(&mut receiver, &[0xFF, 0xFF, 0x01]);
        assert_eq!(receiver.push(GAP_MAX_NS + 1, 0, 0x02), None);
        assert_eq!(receiver.dropped, 1);
        assert_eq!(
            hear(&mut receiver, &[0xFF, 0xFF, 0x01, 0x02, 0x01, 0xFB]).len(),
            1
        );
    }

    proptest! {
        #[test]
        fn any_bytes_are_survived(bytes in proptest::collection::vec(
            prop_oneof![Just(0xFFu8), Just(0xFD), Just(0x00), Just(0x01), Just(0xFE), any::<u8>()], 0..300)) {
            hear(&mut Receiver::default(), &bytes);
        }
    }
}
