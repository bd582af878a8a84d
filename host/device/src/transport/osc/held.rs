//! Packets that are not due yet, in the order in which they will be.
//!
//! Knows moments and bytes, not what a packet says: when it is due is worked out by whoever knows its format.

use crate::clock::Instant;
use std::collections::BTreeMap;

/// Packets kept at once; a controller with a sequencer writes some dozens ahead. With more there is a mistake, and what
/// comes is handed out at once rather than lost.
const HELD_MAX: usize = 1024;

/// What waits for its time.
#[derive(Debug, Default)]
pub(super) struct Held {
    /// By moment, and within one by the order in which they came.
    packets: BTreeMap<(Instant, u64), Vec<u8>>,
    came: u64,
}

impl Held {
    /// Keeps a packet until `due`. False: there is no room, and it is to be heard at once.
    pub(super) fn keep(&mut self, due: Instant, packet: &[u8]) -> bool {
        let room = self.packets.len() < HELD_MAX;
        if room {
            self.packets.insert((due, self.came), packet.to_vec());
            self.came += 1;
        }
        room
    }

    /// The first packet whose time has come.
    pub(super) fn take(&mut self, now: Instant) -> Option<Vec<u8>> {
        let first = self.packets.first_entry()?;
        (first.key().0 <= now).then(|| first.remove())
    }

    /// When the next one is due.
    pub(super) fn next(&self) -> Option<Instant> {
        self.packets.keys().next().map(|(due, _)| *due)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_come_out_at_their_time_and_in_their_order() {
        let at = Instant::from_nanos;
        let mut held = Held::default();
        for (due, packet) in [(30, b"c"), (10, b"a"), (10, b"b")] {
            assert!(held.keep(at(due), packet));
        }
        assert_eq!((held.next(), held.take(at(9))), (Some(at(10)), None));
        assert_eq!(held.take(at(10)), Some(b"a".to_vec()));
        assert_eq!(held.take(at(40)), Some(b"b".to_vec()));
        assert_eq!(held.take(at(40)), Some(b"c".to_vec()));
        assert_eq!((held.next(), held.take(at(40))), (None, None));
    }

    #[test]
    fn there_is_a_bound() {
        let mut held = Held::default();
        let kept = (0..5000)
            .filter(|&n| held.keep(Instant::from_nanos(n), &[1]))
            .count();
        assert_eq!(kept, HELD_MAX);
    }
}
