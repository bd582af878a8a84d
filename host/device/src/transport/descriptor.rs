//! What serial ports, pseudo-terminals and sockets have in common: a file descriptor that does not block.

use crate::clock::{Clock, Instant};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fd::BorrowedFd;
use rustix::io::Errno;
use std::io;
use std::time::Duration;

/// How long a write may wait for room: 4 KiB, a kernel's terminal buffer, takes 4.3 s at 9600 baud, and
/// nothing here writes more than a sixteenth of that at once.
const WRITE_LIMIT: Duration = Duration::from_millis(500);

/// What has arrived; 0 if nothing. A stream that has ended is an error of kind `UnexpectedEof`.
pub(super) fn read(fd: BorrowedFd<'_>, buffer: &mut [u8]) -> io::Result<usize> {
    if buffer.is_empty() {
        return Ok(0);
    }
    loop {
        match rustix::io::read(fd, &mut *buffer) {
            Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(count) => return Ok(count),
            Err(Errno::INTR) => {}
            Err(Errno::AGAIN) => return Ok(0),
            Err(e) => return Err(e.into()),
        }
    }
}

/// Writes everything, waiting a little for room where the line is slower than we are.
pub(super) fn write(fd: BorrowedFd<'_>, mut bytes: &[u8]) -> io::Result<()> {
    while !bytes.is_empty() {
        match rustix::io::write(fd, bytes) {
            Ok(count) => bytes = bytes.get(count..).unwrap_or_default(),
            Err(Errno::INTR) => {}
            Err(Errno::AGAIN) => {
                if !poll_for(fd, PollFlags::OUT, WRITE_LIMIT) {
                    let message = format!(
                        "the line takes no more bytes: {} left after {} ms; is the far end stopped or its flow control on?",
                        bytes.len(),
                        WRITE_LIMIT.as_millis()
                    );
                    return Err(io::Error::new(io::ErrorKind::TimedOut, message));
                }
            }
            Err(e) => return Err(e.into()),
        }
    }
    Ok(())
}

/// Writes what there is room for and returns how much that was.
pub(super) fn write_some(fd: BorrowedFd<'_>, bytes: &[u8]) -> io::Result<usize> {
    loop {
        match rustix::io::write(fd, bytes) {
            Ok(count) => return Ok(count),
            Err(Errno::INTR) => {}
            Err(Errno::AGAIN) => return Ok(0),
            Err(e) => return Err(e.into()),
        }
    }
}

/// What has arrived within `limit`; 0 if nothing has.
pub(super) fn read_within(fd: BorrowedFd<'_>, buffer: &mut [u8], limit: Duration) -> io::Result<usize> {
    if poll_for(fd, PollFlags::IN, limit) {
        read(fd, buffer)
    } else {
        Ok(0)
    }
}

/// Whether bytes (or the news that the far end is gone) are waiting.
pub(super) fn ready(fd: BorrowedFd<'_>) -> bool {
    poll_for(fd, PollFlags::IN, Duration::ZERO)
}

/// Returns when bytes are there, or at `until` by `clock`.
pub(super) fn wait(fd: BorrowedFd<'_>, clock: &dyn Clock, until: Instant) {
    let left = until.since(clock.now());
    if !poll_for(fd, PollFlags::IN, left) {
        // Nothing came. For a real clock the deadline has passed; a virtual one learns it here.
        clock.sleep_until(until);
    }
}

fn poll_for(fd: BorrowedFd<'_>, what: PollFlags, limit: Duration) -> bool {
    poll_all(&mut [PollFd::from_borrowed_fd(fd, what)], limit)
}

/// Whether one of several became ready within `limit`, or a signal came: whoever waits looks again then, instead of
/// sleeping through what arrives meanwhile.
pub(super) fn poll_all(watched: &mut [PollFd<'_>], limit: Duration) -> bool {
    let limit = Timespec {
        tv_sec: limit.as_secs().try_into().unwrap_or(i64::MAX),
        tv_nsec: limit.subsec_nanos().into(),
    };
    match poll(watched, Some(&limit)) {
        Ok(ready) => ready > 0,
        Err(error) => error == Errno::INTR,
    }
}
