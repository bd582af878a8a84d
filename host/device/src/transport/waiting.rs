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
    /// Until then the thread stays awake and looks again and again: being woken by bytes takes longer.
    pub alert_until: Instant,
    /// Set when it was looked at from then on and had nothing yet: so what comes next has just come.
    pub looked: &'a mut bool,
}

impl std::fmt::Debug for Awaited<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Awaited")
            .field("from", &self.from)
            .field("alert_until", &self.alert_until)
            .finish_non_exhaustive()
    }
}

/// Returns at `until`, or earlier when bytes are known to be on one of `lines` (or its far end to be gone), but not
/// before they are worth it. Lines beyond [`LINES_MAX`] are not watched.
pub fn wait_any(lines: &mut [Option<Awaited<'_>>], clock: &dyn Clock, until: Instant) {
    let mut now = clock.now();
    while now < until {
        let due = |line: &&mut Awaited<'_>| line.from <= now;
        let mut ready = false;
        for line in lines.iter_mut().flatten().filter(due) {
            let there = line.transport.ready();
            *line.looked |= !there;
            ready |= there;
        }
        if ready {
            return;
        }
        let froms = lines.iter().flatten().map(|line| line.from);
        let end = froms
            .filter(|from| *from > now)
            .min()
            .map_or(until, |next| next.min(until));
        let alert = lines
            .iter()
            .flatten()
            .any(|line| line.from <= now && now < line.alert_until);
        let before = std::mem::replace(&mut now, clock.now());
        // A clock that others move does not go on by being looked at.
        if !(alert && now > before) {
            sleep_or_wake(lines, clock, end);
            now = clock.now();
        }
    }
}

/// Sleeps until `end`, or until bytes come on a line that is due.
fn sleep_or_wake(lines: &mut [Option<Awaited<'_>>], clock: &dyn Clock, end: Instant) {
    let now = clock.now();
    let is_due = |line: &Awaited<'_>| line.from <= now;
    if let [Some(only)] = lines
        && is_due(only)
    {
        // It may know better when its bytes come.
        only.transport.wait(clock, end);
        return;
    }
    let inside = |line: &Awaited<'_>| is_due(line) && line.transport.descriptor().is_none();
    let step = lines.iter().flatten().any(inside);
    poll_due(
        lines,
        clock,
        if step { end.min(now.after(WAIT_STEP)) } else { end },
    );
}

/// One `poll(2)` for the lines that are due and have a descriptor.
fn poll_due(lines: &[Option<Awaited<'_>>], clock: &dyn Clock, end: Instant) {
    let now = clock.now();
    let due = lines.iter().flatten().filter(|line| line.from <= now);
    let mut descriptors = due.filter_map(|line| line.transport.descriptor());
    let Some(first) = descriptors.next() else {
        clock.sleep_until(end);
        return;
    };
    let mut watched: [PollFd<'_>; LINES_MAX] =
        std::array::from_fn(|_| PollFd::from_borrowed_fd(first, PollFlags::IN));
    let mut count = 1;
    for (place, descriptor) in watched.iter_mut().skip(1).zip(descriptors) {
        *place = PollFd::from_borrowed_fd(descriptor, PollFlags::IN);
        count += 1;
    }
    if !descriptor::poll_all(watched.get_mut(..count).unwrap_or_default(), end.since(now)) {
        // For a real clock the time has passed; a virtual one learns it here.
        clock.sleep_until(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::{MonotonicClock, VirtualClock};
    use crate::transport::{memory, pty::Pty, serial};
    use std::time::Duration;

    fn awaited<'a>(transport: &'a mut dyn Transport, from: Instant, looked: &'a mut bool) -> Awaited<'a> {
        Awaited {
            transport,
            from,
            alert_until: from,
            looked,
        }
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
            &mut [
                Some(awaited(first, Instant::ZERO, &mut false)),
                Some(awaited(second, Instant::ZERO, &mut false)),
            ],
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
            &mut [
                Some(awaited(&mut first, later, &mut false)),
                Some(awaited(&mut second, Instant::ZERO, &mut false)),
            ],
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
                Some(awaited(&mut first, Instant::ZERO, &mut false)),
                Some(awaited(&mut second, Instant::ZERO, &mut false)),
            ],
            &clock,
            until,
        );
        assert_eq!(clock.now(), until);
        wait_any(&mut [], &clock, until.after(Duration::from_millis(1)));
        assert_eq!(clock.now(), until.after(Duration::from_millis(1)));
    }
}
