//! A thread that reads one device and notes when each piece arrived.
//!
//! Nothing else in the program blocks on a device. The thread ends when the device is gone or its owner dropped it.

use super::TransportError;
use super::stamped::StampedQueue;
use crate::clock::{Clock, Instant};
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Longest wait in one read: how long the thread outlives its owner at most.
const READ_LIMIT: Duration = Duration::from_millis(100);
/// The longest piece in one read; no report is longer than HID's 4096 bytes.
const PIECE_BYTES_MAX: usize = 4096;

/// Where bytes come from.
pub(super) trait Reading: Send {
    /// Waits at most `limit` for a piece: its length, 0 if none came. An error: the device is gone.
    fn read(&mut self, buffer: &mut [u8], limit: Duration) -> io::Result<usize>;
}

/// The near end of the thread.
#[derive(Debug)]
pub(super) struct Intake {
    shared: Arc<Shared>,
    arrived: Option<Instant>,
}

#[derive(Debug, Default)]
struct Shared {
    state: Mutex<State>,
    came: Condvar,
    stop: AtomicBool,
}

#[derive(Debug, Default)]
struct State {
    queue: StampedQueue,
    gone: bool,
}

impl Intake {
    /// Begins to read; `name` is the thread's.
    pub(super) fn spawn(
        name: &str,
        clock: Arc<dyn Clock>,
        mut reading: Box<dyn Reading>,
    ) -> io::Result<Self> {
        let shared = Arc::new(Shared::default());
        let theirs = Arc::clone(&shared);
        std::thread::Builder::new()
            .name(format!("in {name}"))
            .spawn(move || take_in(&theirs, clock.as_ref(), reading.as_mut()))?;
        Ok(Self {
            shared,
            arrived: None,
        })
    }

    /// The next piece's length, 0 if there is none; `None`: there will be none any more.
    pub(super) fn read(&mut self, buffer: &mut [u8]) -> Option<usize> {
        let mut state = lock(&self.shared.state);
        match state.queue.pop(buffer) {
            Some((count, at)) => {
                self.arrived = at;
                Some(count)
            }
            None if state.gone => None,
            None => Some(0),
        }
    }

    /// When the piece read last arrived.
    pub(super) fn arrived(&self) -> Option<Instant> {
        self.arrived
    }

    /// Pieces thrown away so far.
    pub(super) fn dropped(&self) -> u64 {
        lock(&self.shared.state).queue.dropped()
    }

    /// Whether the next read has something to say.
    pub(super) fn ready(&self) -> bool {
        let state = lock(&self.shared.state);
        state.gone || !state.queue.is_empty()
    }

    /// Returns when the next read has something to say, or at `until`.
    pub(super) fn wait(&self, clock: &dyn Clock, until: Instant) {
        let state = lock(&self.shared.state);
        let limit = until.since(clock.now());
        let waited = self
            .shared
            .came
            .wait_timeout_while(state, limit, |state| !state.gone && state.queue.is_empty());
        let idle = waited.map_or_else(|e| e.into_inner().1.timed_out(), |(_, end)| end.timed_out());
        if idle {
            // For a real clock the time has passed; a virtual one learns it here.
            clock.sleep_until(until);
        }
    }
}

impl Drop for Intake {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
    }
}

fn lock(state: &Mutex<State>) -> MutexGuard<'_, State> {
    // A panic elsewhere leaves a queue, which has no broken state.
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

fn take_in(shared: &Shared, clock: &dyn Clock, reading: &mut dyn Reading) {
    let mut buffer = vec![0; PIECE_BYTES_MAX];
    while !shared.stop.load(Ordering::Relaxed) {
        let read = reading.read(&mut buffer, READ_LIMIT);
        let at = clock.now();
        match read {
            Ok(0) => continue,
            Ok(count) => {
                let piece = buffer.get(..count).unwrap_or_default();
                lock(&shared.state).queue.push(piece, Some(at));
            }
            Err(error) => {
                tracing::debug!("reading ended: {error}");
                lock(&shared.state).gone = true;
            }
        }
        shared.came.notify_all();
        if lock(&shared.state).gone {
            return;
        }
    }
}

/// What a read that found the thread's end is to its caller.
pub(super) fn gone(address: &str) -> TransportError {
    TransportError::Gone {
        address: address.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::MonotonicClock;
    use crate::transport::stamped::REPORTS_MAX;

    /// As many reports as fast as they are taken, then unplugged.
    struct Flood(u32);

    impl Reading for Flood {
        fn read(&mut self, buffer: &mut [u8], _limit: Duration) -> io::Result<usize> {
            let left = self.0.checked_sub(1).ok_or(io::ErrorKind::BrokenPipe)?;
            self.0 = left;
            buffer[..4].copy_from_slice(&left.to_le_bytes());
            Ok(4)
        }
    }

    #[test]
    fn a_flood_is_bounded_counted_and_every_report_has_its_time() {
        let clock = MonotonicClock::new();
        let sent = 3 * REPORTS_MAX as u32;
        let mut intake =
            Intake::spawn("flood", Arc::new(clock), Box::new(Flood(sent))).expect("there are threads");
        // Nobody reads until it is over.
        while !lock(&intake.shared.state).gone {
            std::thread::yield_now();
        }
        let mut buffer = [0; 64];
        let (mut got, mut before) = (0_u64, Instant::ZERO);
        while let Some(count) = intake.read(&mut buffer) {
            assert_eq!(count, 4);
            let at = intake.arrived().expect("it was noted");
            assert!(at >= before);
            before = at;
            got += 1;
        }
        assert_eq!(got, REPORTS_MAX as u64);
        assert_eq!(got + intake.dropped(), u64::from(sent), "none is lost uncounted");
    }

    #[test]
    fn waiting_ends_with_the_news_that_the_device_is_gone() {
        let clock = MonotonicClock::new();
        let mut intake =
            Intake::spawn("gone", Arc::new(clock), Box::new(Flood(0))).expect("there are threads");
        let until = clock.now().after(Duration::from_secs(5));
        intake.wait(&clock, until);
        assert!(clock.now() < until);
        assert_eq!(intake.read(&mut [0; 4]), None);
    }
}
