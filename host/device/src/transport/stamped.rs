//! Reports with the time each arrived, in bounded memory: where a thread that reads a device hands them over.
//!
//! A tablet's sample is worth as much as its time. Whoever polls comes late by anything up to a poll's interval, so
//! the time is noted where the report comes in, and goes with it. Nobody reading is no reason to fill the memory: the
//! oldest reports are thrown away and counted.

use crate::clock::Instant;
use std::collections::VecDeque;

/// Reports held for a reader that is late: half a second of the fastest device there is, 8 000 a second.
pub const REPORTS_MAX: usize = 4096;
/// Bytes they may have together: [`REPORTS_MAX`] of 64 bytes, which is the longest report of a full-speed device.
pub const BYTES_MAX: usize = REPORTS_MAX * 64;

/// A queue of reports.
#[derive(Debug)]
pub struct StampedQueue {
    heads: VecDeque<Head>,
    bytes: VecDeque<u8>,
    dropped: u64,
}

#[derive(Clone, Copy, Debug)]
struct Head {
    length: usize,
    at: Option<Instant>,
}

impl Default for StampedQueue {
    fn default() -> Self {
        Self::new()
    }
}

impl StampedQueue {
    /// An empty queue. All the memory it will ever want is taken at once.
    pub fn new() -> Self {
        Self {
            heads: VecDeque::with_capacity(REPORTS_MAX),
            bytes: VecDeque::with_capacity(BYTES_MAX),
            dropped: 0,
        }
    }

    /// Appends a report that arrived at `at`; an empty one says nothing and vanishes. Where there is no room the
    /// oldest ones go; one longer than the whole queue goes itself.
    pub fn push(&mut self, report: &[u8], at: Option<Instant>) {
        if report.is_empty() {
            return;
        }
        if report.len() > BYTES_MAX {
            self.dropped += 1;
            return;
        }
        while self.heads.len() >= REPORTS_MAX || self.bytes.len() + report.len() > BYTES_MAX {
            self.drop_oldest();
        }
        self.heads.push_back(Head {
            length: report.len(),
            at,
        });
        self.bytes.extend(report);
    }

    fn drop_oldest(&mut self) {
        if let Some(head) = self.heads.pop_front() {
            self.bytes.drain(..head.length);
            self.dropped += 1;
        }
    }

    /// Takes the oldest report: its length and time. What does not fit into `buffer` is cut off.
    pub fn pop(&mut self, buffer: &mut [u8]) -> Option<(usize, Option<Instant>)> {
        let head = self.heads.pop_front()?;
        let bytes = self.bytes.drain(..head.length);
        for (place, byte) in buffer.iter_mut().zip(bytes) {
            *place = byte;
        }
        Some((head.length.min(buffer.len()), head.at))
    }

    /// Whether nothing waits.
    pub fn is_empty(&self) -> bool {
        self.heads.is_empty()
    }

    /// Reports waiting.
    pub fn len(&self) -> usize {
        self.heads.len()
    }

    /// Reports thrown away so far.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_keep_their_order_their_length_and_their_time() {
        let mut queue = StampedQueue::new();
        let at = |us: u64| Some(Instant::from_nanos(us * 1000));
        queue.push(&[1, 2, 3], at(5));
        queue.push(&[], at(6));
        queue.push(&[4; 8], at(7));
        let mut buffer = [0; 4];
        assert_eq!(queue.pop(&mut buffer), Some((3, at(5))));
        assert_eq!(buffer[..3], [1, 2, 3]);
        assert_eq!(
            queue.pop(&mut buffer),
            Some((4, at(7))),
            "cut, not mixed with the next"
        );
        assert_eq!(queue.pop(&mut buffer), None);
        assert!(queue.is_empty());
    }

    #[test]
    fn a_flood_that_nobody_reads_stays_within_its_memory_and_is_counted() {
        let mut queue = StampedQueue::new();
        let (heads, bytes) = (queue.heads.capacity(), queue.bytes.capacity());
        let sent = 80_000_u32;
        for n in 0..sent {
            queue.push(
                &n.to_le_bytes(),
                Some(Instant::from_nanos(u64::from(n) * 125_000)),
            );
        }
        assert_eq!(queue.len(), REPORTS_MAX);
        assert_eq!(queue.dropped(), u64::from(sent) - REPORTS_MAX as u64);
        let mut buffer = [0; 8];
        let first = queue.pop(&mut buffer).expect("the queue is full");
        let kept_from = sent - REPORTS_MAX as u32;
        assert_eq!(buffer[..4], kept_from.to_le_bytes(), "the newest are kept");
        assert_eq!(first.1, Some(Instant::from_nanos(u64::from(kept_from) * 125_000)));
        for _ in 0..1000 {
            queue.push(&[0; 1024], None);
        }
        assert_eq!(
            (queue.heads.capacity(), queue.bytes.capacity()),
            (heads, bytes),
            "no more memory was taken"
        );
        assert_eq!(queue.len(), BYTES_MAX / 1024, "long reports count by their bytes");
        queue.push(&vec![0; BYTES_MAX + 1], None);
        assert_eq!(queue.len(), BYTES_MAX / 1024);
    }
}
