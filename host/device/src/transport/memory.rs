//! Two ends of a line inside the program: what a simulated device hangs on.

pub mod reports;

use super::{Boundary, Transport, TransportError};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Bytes that one direction holds before a writer is told that nobody reads: a quarter of a second at 4 Mbaud.
/// The bound exists so that a stopped reader cannot eat the machine's memory.
const HELD_MAX: usize = 128 * 1024;

/// One end of the line. Dropping either end makes the other answer [`TransportError::Gone`].
#[derive(Debug)]
pub struct MemoryTransport {
    name: String,
    side: usize,
    line: Arc<Mutex<Line>>,
}

#[derive(Debug)]
struct Line {
    /// Bytes on their way to side 0 and to side 1.
    to: [VecDeque<u8>; 2],
    /// Whether each side still exists.
    there: [bool; 2],
    baud: [Option<u32>; 2],
}

/// A line with two ends, both called `memory`.
pub fn pair() -> (MemoryTransport, MemoryTransport) {
    pair_named("memory")
}

/// A line with two ends; `name` is the address in errors, as in `sim:dial-box`.
pub fn pair_named(name: &str) -> (MemoryTransport, MemoryTransport) {
    let line = Line {
        to: [VecDeque::new(), VecDeque::new()],
        there: [true; 2],
        baud: [None; 2],
    };
    let line = Arc::new(Mutex::new(line));
    let end = |side| MemoryTransport {
        name: name.to_owned(),
        side,
        line: Arc::clone(&line),
    };
    (end(0), end(1))
}

impl MemoryTransport {
    /// The line speed that the far end asked for last; `None` if it never did.
    pub fn far_baud(&self) -> Option<u32> {
        self.line().baud[1 - self.side]
    }

    /// Whether the far end still exists.
    pub fn far_end_there(&self) -> bool {
        self.line().there[1 - self.side]
    }

    fn line(&self) -> MutexGuard<'_, Line> {
        // A panic elsewhere leaves queues of bytes, which have no broken state.
        self.line.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn gone(&self) -> TransportError {
        TransportError::Gone {
            address: self.name.clone(),
        }
    }
}

impl Transport for MemoryTransport {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let mut line = self.line();
        let waiting = &mut line.to[self.side];
        let count = waiting.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(waiting.drain(..count)) {
            *place = byte;
        }
        // What was sent before the far end went is still delivered.
        if count == 0 && !buffer.is_empty() && !line.there[1 - self.side] {
            drop(line);
            return Err(self.gone());
        }
        Ok(count)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let mut line = self.line();
        if !line.there[1 - self.side] {
            drop(line);
            return Err(self.gone());
        }
        let queue = &mut line.to[1 - self.side];
        if queue.len() + bytes.len() > HELD_MAX {
            return Err(TransportError::Io {
                address: self.name.clone(),
                source: std::io::Error::new(
                    std::io::ErrorKind::WouldBlock,
                    format!(
                        "the far end has left {} bytes unread and can hold {HELD_MAX}",
                        queue.len()
                    ),
                ),
            });
        }
        queue.extend(bytes);
        Ok(())
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        let side = self.side;
        self.line().baud[side] = Some(baud);
        Ok(())
    }

    fn ready(&mut self) -> bool {
        let line = self.line();
        !line.to[self.side].is_empty() || !line.there[1 - self.side]
    }
}

impl Drop for MemoryTransport {
    fn drop(&mut self) {
        let side = self.side;
        self.line().there[side] = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::{Clock, Instant, VirtualClock};

    #[test]
    fn bytes_cross_in_order_and_in_pieces() {
        let (mut host, mut far) = pair();
        host.write(&[1, 2, 3]).unwrap();
        let mut buffer = [0; 2];
        assert_eq!(far.read(&mut buffer).unwrap(), 2);
        assert_eq!(buffer, [1, 2]);
        assert_eq!(far.read(&mut buffer).unwrap(), 1);
        assert_eq!(far.read(&mut buffer).unwrap(), 0);
        assert_eq!(host.read(&mut buffer).unwrap(), 0);
    }

    #[test]
    fn a_dropped_end_is_gone_after_its_last_bytes() {
        let (mut host, mut far) = pair_named("sim:box");
        far.write(&[9]).unwrap();
        drop(far);
        let mut buffer = [0; 4];
        assert_eq!(host.read(&mut buffer).unwrap(), 1);
        assert!(host.read(&mut buffer).unwrap_err().is_gone());
        assert!(
            host.write(&[1])
                .unwrap_err()
                .to_string()
                .starts_with("sim:box: the device is gone")
        );
    }

    #[test]
    fn waiting_ends_at_the_deadline_or_with_the_first_byte() {
        let (mut host, mut far) = pair();
        let clock = VirtualClock::new();
        host.wait(&clock, Instant::from_nanos(1_000_000));
        assert_eq!(clock.now(), Instant::from_nanos(1_000_000));
        far.write(&[1]).unwrap();
        host.wait(&clock, Instant::from_nanos(2_000_000));
        assert_eq!(clock.now(), Instant::from_nanos(1_000_000));
    }

    #[test]
    fn nobody_reading_is_an_error_and_not_a_full_memory() {
        let (mut host, far) = pair();
        host.write(&vec![0; HELD_MAX]).unwrap();
        assert!(host.write(&[0]).unwrap_err().to_string().contains("unread"));
        assert_eq!(far.far_baud(), None);
        host.set_baud(57_600).unwrap();
        assert_eq!(far.far_baud(), Some(57_600));
    }
}
