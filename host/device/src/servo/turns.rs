//! When each servo's turn to answer comes on the wire, for the two ways in which groups answer.
//!
//! Source: servo reference, "Wire limit": a plain read costs each servo its return delay and a packet of its own; a
//! fast read costs one delay, and all share one packet.

use super::framing::status_overhead_bytes;
use device_profiles::ServoProtocol;
use std::time::Duration;

/// Bytes before the first servo's in the answer to a fast read, and around each one's data.
const FAST_BYTES: [usize; 2] = [8, 4];

/// How those who are asked answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Turns {
    /// Bytes before the first servo's.
    head: usize,
    /// Bytes around each servo's data.
    overhead: usize,
    /// Whether each servo waits before it answers, or only the first.
    each_waits: bool,
}

impl Turns {
    /// A packet from each.
    pub(super) fn each(protocol: ServoProtocol) -> Self {
        Self {
            head: 0,
            overhead: status_overhead_bytes(protocol),
            each_waits: true,
        }
    }

    /// One packet from all.
    pub(super) fn together() -> Self {
        let [head, overhead] = FAST_BYTES;
        Self {
            head,
            overhead,
            each_waits: false,
        }
    }

    /// Begins to go through the turns; the question takes `request`, each wait before an answer `wait`.
    pub(super) fn begin(self, request: Duration, wait: Duration) -> TurnClock {
        TurnClock {
            turns: self,
            at: request,
            wait,
            first: true,
        }
    }
}

/// Goes from turn to turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct TurnClock {
    turns: Turns,
    at: Duration,
    wait: Duration,
    first: bool,
}

impl TurnClock {
    /// When the next servo measures, with `bytes` of data; `stuffed`: as many bytes as they may become.
    pub(super) fn next(&mut self, bytes: u16, stuffed: bool, wire: impl Fn(usize) -> Duration) -> Duration {
        let turns = self.turns;
        if self.first || turns.each_waits {
            self.at += self.wait;
        }
        if std::mem::take(&mut self.first) {
            self.at += wire(turns.head);
        }
        let measured = self.at;
        let bytes = usize::from(bytes);
        let stuffing = if stuffed && turns.each_waits { bytes / 3 } else { 0 };
        self.at += wire(turns.overhead + bytes + stuffing);
        measured
    }

    /// When the last byte so far is out.
    pub(super) fn end(&self) -> Duration {
        self.at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total_us(turns: Turns, request: usize, servos: usize, bytes: u16, baud: u64) -> u128 {
        let wire = |bytes: usize| Duration::from_nanos(bytes as u64 * 10_000_000_000 / baud);
        let mut clock = turns.begin(wire(request), Duration::ZERO);
        for _ in 0..servos {
            clock.next(bytes, false, wire);
        }
        clock.end().as_micros()
    }

    #[test]
    fn totals_are_the_reference_table_s() {
        let plain = Turns::each(ServoProtocol::Dynamixel2);
        // Source: servo reference 7.1 and 7.3: 20 servos, sync write 4 + sync read 4.
        assert_eq!(total_us(plain, 14 + 100 + 14 + 20, 20, 4, 1_000_000), 4480);
        assert_eq!(
            total_us(Turns::together(), 14 + 100 + 14 + 20, 20, 4, 1_000_000),
            3160
        );
        let sts = Turns::each(ServoProtocol::Sts);
        assert_eq!(total_us(sts, 8 + 60 + 8 + 20, 20, 2, 1_000_000), 2560);
    }

    #[test]
    fn only_the_first_waits_in_a_fast_read() {
        let wire = |bytes: usize| Duration::from_micros(bytes as u64);
        let wait = Duration::from_micros(500);
        let mut plain = Turns::each(ServoProtocol::Dynamixel2).begin(Duration::ZERO, wait);
        let mut fast = Turns::together().begin(Duration::ZERO, wait);
        let [plain, fast] =
            [&mut plain, &mut fast].map(|clock| [(); 2].map(|()| clock.next(4, false, wire).as_micros()));
        assert_eq!(plain, [500, 1015]);
        assert_eq!(fast, [508, 516]);
    }
}
