//! Waiting for several lines at once, so that no line waits for another's turn.
//!
//! Lines with a descriptor are waited for by one `poll(2)`; lines inside the program are asked in short steps.

use super::{Transport, WAIT_STEP, descriptor};
use crate::clock::{Clock, Instant};
use rustix::event::{PollFd, PollFlags};

/// So many lines can be waited for at once without asking for memory; more than a program has ever had buses.
pub const LINES_MAX: usize = 16;

/// A line somebody waits for.
pub struct Awaited<'a> {
    /// The line.
    pub transport: &'a mut dyn Transport,
    /// Before this there is nothing on it that would be worth waking up for.
    pub from: Instant,
}

impl std::fmt::Debug for Awaited<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Awaited")
            .field("from", &self.from)
            .finish_non_exhaustive()
    }
}

/// Returns at `until`, or earlier when bytes are known to be on one of `lines` (or its far end to be gone).
/// Lines beyond [`LINES_MAX`] are not watched; they are looked at whenever this returns.
pub fn wait_any(lines: &mut [Awaited<'_>], clock: &dyn Clock, until: Instant) {
    if let [only] = lines {
        clock.sleep_until(only.from.min(until));
        only.transport.wait(clock, until);
        return;
    }
    loop {
        let now = clock.now();
        let due = |line: &Awaited<'_>| line.from <= now;
        let inside = |line: &mut Awaited<'_>| due(line) && line.transport.descriptor().is_none();
        if now >= until
            || lines
                .iter_mut()
                .any(|line| inside(line) && line.transport.ready())
        {
            return;
        }
        let next = lines
            .iter()
            .map(|line| line.from)
            .filter(|from| *from > now)
            .min();
        let mut end = next.map_or(until, |next| next.min(until));
        if lines.iter_mut().any(inside) {
            end = end.min(now.after(WAIT_STEP));
        }
        if poll_due(lines, clock, end) {
            return;
        }
    }
}

/// One `poll(2)` for the lines that are due and have a descriptor.
fn poll_due(lines: &[Awaited<'_>], clock: &dyn Clock, end: Instant) -> bool {
    let now = clock.now();
    let due = lines.iter().filter(|line| line.from <= now);
    let mut descriptors = due.filter_map(|line| line.transport.descriptor());
    let Some(first) = descriptors.next() else {
        clock.sleep_until(end);
        return false;
    };
    let mut watched: [PollFd<'_>; LINES_MAX] =
        std::array::from_fn(|_| PollFd::from_borrowed_fd(first, PollFlags::IN));
    let mut count = 1;
    for (place, descriptor) in watched.iter_mut().skip(1).zip(descriptors) {
        *place = PollFd::from_borrowed_fd(descriptor, PollFlags::IN);
        count += 1;
    }
    let ready = descriptor::poll_all(watched.get_mut(..count).unwrap_or_default(), end.since(now));
    if !ready {
        // For a real clock the time has passed; a virtual one learns it here.
        clock.sleep_until(end);
    }
    ready
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::{MonotonicClock, VirtualClock};
    use crate::transport::{memory, pty::Pty, serial};
    use std::time::Duration;

    fn awaited(transport: &mut dyn Transport, from: Instant) -> Awaited<'_> {
        Awaited { transport, from }
    }

    #[test]
    fn the_first_of_several_wakes() {
        let clock = MonotonicClock::new();
        let mut far = [Pty::open().expect("a terminal"), Pty::open().expect("a terminal")];
        let mut near = far
            .each_ref()
            .map(|far| serial::open(&far.path().to_string_lossy(), 1_000_000).expect("it is there"));
        far[1].write(&[7]).expect("room");
        let until = clock.now().after(Duration::from_secs(5));
        let [first, second] = &mut near;
        wait_any(
            &mut [awaited(first, Instant::ZERO), awaited(second, Instant::ZERO)],
            &clock,
            until,
        );
        assert!(clock.now() < until);
        let mut byte = [0];
        assert_eq!(near[0].read(&mut byte).expect("open"), 0);
        assert_eq!(near[1].read(&mut byte).expect("open"), 1);
    }

    #[test]
    fn nobody_is_woken_for_what_is_not_due() {
        let clock = VirtualClock::new();
        let [(mut first, mut far), (mut second, _other)] = [memory::pair(), memory::pair()];
        far.write(&[1]).expect("room");
        let later = Instant::from_nanos(3_000_000);
        wait_any(
            &mut [awaited(&mut first, later), awaited(&mut second, Instant::ZERO)],
            &clock,
            Instant::from_nanos(9_000_000),
        );
        assert_eq!(
            clock.now(),
            later,
            "the byte was there before it was worth waking up for"
        );
    }

    #[test]
    fn without_bytes_the_wait_is_as_long_as_wanted() {
        let clock = VirtualClock::new();
        let [(mut first, _far), (mut second, _other)] = [memory::pair(), memory::pair()];
        let until = Instant::from_nanos(1_234_567);
        wait_any(
            &mut [
                awaited(&mut first, Instant::ZERO),
                awaited(&mut second, Instant::ZERO),
            ],
            &clock,
            until,
        );
        assert_eq!(clock.now(), until);
        wait_any(&mut [], &clock, until.after(Duration::from_millis(1)));
        assert_eq!(clock.now(), until.after(Duration::from_millis(1)));
    }
}
