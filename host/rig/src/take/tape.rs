//! What every input device has said since its line was opened, kept in bounded memory.
//!
//! A take that is begun in the middle of a session needs it: what a report means depends on those before it. A
//! dial's count is only known from the one before, a tablet's size only from its answer.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use device::clock::{Clock, Instant};
use device::codec::{Answer, Step};
use device::exchange::{Record, What};
use device::tap::{Notes, Passed, Tap};
use device::transport::{Boundary, Transport, TransportError};
use device_profiles::Line;

use super::reel::{Mark, Reel};
use crate::command::Touch;
use crate::ports::{Found, Ports, TouchError};
use crate::take::Heard;

/// Things kept from the beginning of a conversation whatever follows: every handshake is far shorter.
const FIRST_MAX: usize = 512;
/// Things kept besides: a quarter of an hour of a dial box that is turned all the time, half an hour of a pen that
/// never rests. 4 MiB.
const THINGS_MAX: usize = 1 << 18;
/// And bytes: 256 of them for each report of the longest kind at 100 a second, as long.
const BYTES_MAX: usize = 4 << 20;
/// What one take may have of one device: an hour of such a dial box.
const TAKE_THINGS_MAX: usize = 1 << 20;
const TAKE_BYTES_MAX: usize = 16 << 20;
/// What a capture has of the conversation before it, besides its beginning.
const CAPTURE_BEFORE_MAX: usize = 512;

/// What one device said.
#[derive(Debug)]
struct Tape {
    /// When its line was opened.
    opened: Duration,
    reports: bool,
    first: Reel,
    later: Reel,
    /// A take is running from here: nothing behind it may go.
    held_from: Option<Mark>,
    /// What it described itself with when its line was first opened.
    descriptor: Option<Answer>,
    /// What passed since a capture looked last, while there is one.
    watched: Option<Vec<(Duration, What)>>,
}

impl Default for Tape {
    fn default() -> Self {
        Self {
            opened: Duration::ZERO,
            reports: false,
            // Asked for once, so that listening does not: memory that is not written on costs nothing.
            first: Reel::with_room(FIRST_MAX, 64 * FIRST_MAX),
            later: Reel::with_room(THINGS_MAX, BYTES_MAX),
            held_from: None,
            descriptor: None,
            watched: None,
        }
    }
}

impl Tape {
    /// The line is open; a conversation begins. While a take runs, it goes on with the new line instead.
    fn open(&mut self, at: Duration, reports: bool) {
        self.watch(at, || What::Back);
        if self.held_from.is_some() {
            self.put(at, What::Back);
            return;
        }
        self.opened = at;
        self.reports = reports;
        self.first.clear();
        self.later.clear();
    }

    /// The number of the next thing.
    fn next(&self) -> Mark {
        self.first.next() + self.later.next()
    }

    fn put(&mut self, at: Duration, what: What) {
        if self.first.len() < FIRST_MAX {
            self.first.put(at, what);
        } else {
            self.make_room(0);
            self.later.put(at, what);
        }
    }

    fn hear(&mut self, at: Duration, bytes: &[u8]) {
        if self.first.len() < FIRST_MAX {
            self.first.hear(at, bytes);
        } else {
            self.make_room(bytes.len());
            self.later.hear(at, bytes);
        }
    }

    /// Lets the oldest of the later things go until there is room for one more.
    fn make_room(&mut self, bytes: usize) {
        while self.later.len() + 1 > THINGS_MAX || self.later.bytes() + bytes > BYTES_MAX {
            let oldest = self.next() - self.later.len() as Mark;
            if self.later.is_empty() || self.held_from.is_some_and(|from| oldest >= from) {
                return;
            }
            self.later.forget();
        }
    }

    fn watch(&mut self, at: Duration, what: impl FnOnce() -> What) {
        if let Some(watched) = &mut self.watched {
            watched.push((at, what()));
        }
    }
}

/// A tape that a line writes on while the rig reads it.
#[derive(Clone, Debug, Default)]
struct SharedTape(Arc<Mutex<Tape>>);

impl SharedTape {
    fn lock(&self) -> MutexGuard<'_, Tape> {
        // A panic elsewhere leaves whole records.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Writes what passes on a tape: what the device says, and that it is gone. What the host says is left out, but for a
/// capture: whoever hears the same asks the same.
struct Writer {
    tape: SharedTape,
    began: Instant,
    heard: Arc<Hearing>,
}

/// Between which times what the rig's present step hears came, nanoseconds since it began. What arrives while a step
/// listens is of that step, and so is what came before and was not heard by the step before: a re-run, which listens at
/// the steps' times, must hear it in the same one.
#[derive(Debug, Default)]
struct Hearing {
    since: AtomicU64,
    now: AtomicU64,
}

impl Hearing {
    fn set(&self, [since, now]: [Duration; 2]) {
        let nanos = |at: Duration| u64::try_from(at.as_nanos()).unwrap_or(u64::MAX);
        self.since.store(nanos(since), Ordering::Relaxed);
        self.now.store(nanos(now), Ordering::Relaxed);
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.now.load(Ordering::Relaxed))
    }

    /// The time at which something that came at `at` counts as heard.
    fn heard(&self, at: Duration) -> Duration {
        let since = Duration::from_nanos(self.since.load(Ordering::Relaxed));
        at.max(since).min(self.now())
    }
}

impl Notes for Writer {
    fn note(&mut self, at: Instant, passed: Passed<'_>) {
        let at = self.heard.heard(at.since(self.began));
        let mut tape = self.tape.lock();
        match passed {
            Passed::Heard(bytes) => {
                tape.watch(at, || What::Device(bytes.to_vec()));
                tape.hear(at, bytes);
            }
            Passed::Answered(answer) => {
                if matches!(answer, Answer::Descriptor(Ok(_))) {
                    tape.descriptor = Some(Answer::clone(answer));
                }
                tape.watch(at, || What::Answer(Answer::clone(answer)));
                tape.put(at, What::Answer(Answer::clone(answer)));
            }
            Passed::Gone => {
                tape.watch(at, || What::Gone);
                tape.put(at, What::Gone);
            }
            Passed::Sent(step) => tape.watch(at, || What::Host(Step::clone(step))),
        }
    }
}

/// The tapes of all lines that were opened for input devices, by the names of the devices.
#[derive(Debug, Default)]
pub(crate) struct Tapes {
    tapes: BTreeMap<String, SharedTape>,
    heard: Arc<Hearing>,
}

/// The conversation with a device up to now, as far as a capture has it.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Conversation {
    /// When its line was opened; the times of the records too are since the rig began.
    pub(crate) opened: Duration,
    pub(crate) records: Vec<Record>,
    /// How many records between its beginning and the latest are left out.
    pub(crate) left_out: u64,
    /// What it described itself with, where that was asked for.
    pub(crate) descriptor: Option<Answer>,
}

impl Tapes {
    /// From now on nothing of this device's tape goes until [`Tapes::let_go`]. `None` where it has none.
    pub(crate) fn hold(&self, device: &str) -> Option<Mark> {
        let mut tape = self.tapes.get(device)?.lock();
        let from = tape.next();
        tape.held_from = Some(from);
        Some(from)
    }

    pub(crate) fn let_go(&self, device: &str) {
        if let Some(tape) = self.tapes.get(device) {
            let mut tape = tape.lock();
            tape.held_from = None;
            tape.make_room(0);
        }
    }

    /// Whether a take has become too long for this device's tape.
    pub(crate) fn is_full(&self, device: &str) -> bool {
        self.tapes.get(device).is_some_and(|tape| {
            let tape = tape.lock();
            tape.later.bytes() > TAKE_BYTES_MAX || tape.later.len() > TAKE_THINGS_MAX
        })
    }

    /// What the device said, cut in two at a mark. Times never run backwards in it: what arrived before an answer was
    /// fetched is told with the answer's time.
    pub(crate) fn heard(&self, device: &str, from: Mark) -> Option<Heard> {
        let tape = self.tapes.get(device)?.lock();
        let mut heard = Heard {
            reports: tape.reports,
            opened: tape.opened,
            ..Heard::default()
        };
        if let Some(descriptor) = &tape.descriptor {
            // It was asked for when the device was first there, perhaps on an earlier line.
            heard.before.put(tape.opened, What::Answer(descriptor.clone()));
        }
        let (mut latest, first) = (Duration::ZERO, tape.first.next());
        for (reel, from) in [(&tape.first, from), (&tape.later, from.saturating_sub(first))] {
            reel.split_onto(from, &mut latest, [&mut heard.before, &mut heard.during]);
        }
        Some(heard)
    }

    /// Keeps everything that passes from now on for [`Tapes::watched`], and tells what was said before. Of a device that
    /// was never there nothing was, and its conversation begins now.
    pub(crate) fn watch(&mut self, device: &str, now: Duration) -> Conversation {
        let tape = self.tapes.entry(device.to_owned()).or_insert_with(|| {
            let tape = SharedTape::default();
            tape.lock().opened = now;
            tape
        });
        let mut tape = tape.lock();
        tape.watched.get_or_insert_default();
        let first = tape.first.records();
        let latest = tape.later.latest(CAPTURE_BEFORE_MAX);
        Conversation {
            opened: tape.opened,
            records: first.chain(latest).collect(),
            left_out: tape.later.next().saturating_sub(CAPTURE_BEFORE_MAX as Mark),
            descriptor: tape.descriptor.clone(),
        }
    }

    /// Nothing is kept for a capture any more.
    pub(crate) fn look_away(&self, device: &str) {
        if let Some(tape) = self.tapes.get(device) {
            tape.lock().watched = None;
        }
    }

    /// What passed since the last time; times as in tapes.
    pub(crate) fn watched(&self, device: &str) -> Vec<(Duration, What)> {
        let watched = |tape: &SharedTape| tape.lock().watched.as_mut().map(std::mem::take);
        self.tapes.get(device).and_then(watched).unwrap_or_default()
    }

    /// Ports whose lines write on these tapes what the rig's present step hears: what came between these two times.
    pub(crate) fn at<'t>(
        &'t mut self,
        ports: &'t mut dyn Ports,
        clock: &'t Arc<dyn Clock>,
        began: Instant,
        heard: [Instant; 2],
    ) -> TapedPorts<'t> {
        self.heard.set(heard.map(|at| at.since(began)));
        TapedPorts {
            tapes: self,
            ports,
            clock,
            began,
        }
    }
}

/// Ports whose lines are written on tape.
pub(crate) struct TapedPorts<'t> {
    tapes: &'t mut Tapes,
    ports: &'t mut dyn Ports,
    clock: &'t Arc<dyn Clock>,
    began: Instant,
}

impl Ports for TapedPorts<'_> {
    fn list(&mut self) -> Vec<Found> {
        self.ports.list()
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        self.ports.open(address, baud)
    }

    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        self.ports.open_input(address, line)
    }

    fn open_device(
        &mut self,
        device: &str,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let line = self.ports.open_device(device, address, line)?;
        Ok(self.taped(device, line))
    }

    fn pin(&mut self, address: &str, slot: Option<u16>) -> Result<(), String> {
        self.ports.pin(address, slot)
    }

    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        self.ports.touch(address, touch)
    }
}

impl TapedPorts<'_> {
    fn taped(&mut self, device: &str, line: Box<dyn Transport>) -> Box<dyn Transport> {
        let tape = self.tapes.tapes.entry(device.to_owned()).or_default().clone();
        let reports = line.boundary() == Boundary::Reports;
        let heard = Arc::clone(&self.tapes.heard);
        tape.lock().open(heard.now(), reports);
        let began = self.began;
        let writer = Writer { tape, began, heard };
        Box::new(Tap::new(line, Arc::clone(self.clock), Box::new(writer)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(tape: &Tape) -> Vec<(Mark, Record)> {
        let first = (0..).zip(tape.first.records());
        let later = tape.next() - tape.later.len() as Mark;
        first.chain((later..).zip(tape.later.records())).collect()
    }

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn the_beginning_and_the_latest_stay_and_what_is_between_goes() {
        let mut tape = Tape::default();
        tape.open(ms(5), false);
        let long = vec![7; 4096];
        let count = (FIRST_MAX + 2 * BYTES_MAX / long.len()) as u64;
        for n in 0..count {
            tape.hear(ms(n), &long);
        }
        assert!(tape.later.bytes() <= BYTES_MAX);
        let records: Vec<(Mark, Record)> = numbered(&tape);
        assert!((records.len() as u64) < count);
        let numbers: Vec<Mark> = records.iter().map(|(number, _)| *number).collect();
        assert_eq!((numbers[0], numbers[FIRST_MAX - 1]), (0, FIRST_MAX as u64 - 1));
        assert_eq!(numbers.last(), Some(&(count - 1)));
        assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]));
        for (number, record) in records {
            assert_eq!(record.at, Some(ms(number)));
            assert_eq!(record.what, What::Device(long.clone()));
        }
    }

    #[test]
    fn what_a_take_holds_stays_and_a_line_that_comes_back_belongs_to_it() {
        let mut tape = Tape::default();
        tape.open(ms(0), false);
        for n in 0..600 {
            tape.hear(ms(n), &[n as u8]);
        }
        let from = tape.next();
        tape.held_from = Some(from);
        let long = vec![1; 1 << 20];
        for n in 600..610 {
            tape.hear(ms(n), &long);
        }
        tape.put(ms(611), What::Gone);
        tape.open(ms(700), false);
        tape.hear(ms(701), &[9]);
        let held: Vec<Record> = numbered(&tape)
            .into_iter()
            .filter(|(n, _)| *n >= from)
            .map(|(_, r)| r)
            .collect();
        assert_eq!(held.len(), 13);
        assert_eq!(held[10].what, What::Gone);
        assert_eq!(held[11], Record::new(ms(700), What::Back));
        assert_eq!(held[12].what, What::Device(vec![9]));
        tape.held_from = None;
        tape.make_room(0);
        assert!(tape.later.bytes() <= BYTES_MAX);
        tape.open(ms(900), false);
        assert_eq!((tape.next(), tape.opened), (0, ms(900)));
    }

    /// However many short reports there are, their heads too are bounded, and nothing is asked of the allocator.
    #[test]
    fn short_reports_are_bounded_too_and_listening_does_not_allocate() {
        let mut tape = Tape::default();
        tape.open(ms(0), false);
        let allocated = allocation_counter::measure(|| {
            for n in 0..2 * THINGS_MAX as u64 {
                tape.hear(Duration::from_micros(n), &[0x34, 0, n as u8]);
            }
        });
        assert_eq!(allocated.count_total, 0);
        assert_eq!(tape.later.len(), THINGS_MAX);
    }
}
