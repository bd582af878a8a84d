//! What every input device has said since its line was opened, kept in bounded memory.
//!
//! A take that is begun in the middle of a session needs it: what a report means depends on those before it. A
//! dial's count is only known from the one before, a tablet's size only from its answer.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use device::clock::{Clock, Instant};
use device::codec::Answer;
use device::exchange::{Record, What};
use device::tap::{Notes, Passed, Tap};
use device::transport::{Boundary, Transport, TransportError};
use device_profiles::Line;

use crate::command::Touch;
use crate::ports::{Found, Ports, TouchError};
use crate::take::Heard;

/// Records kept from the beginning of a conversation whatever follows: every handshake is far shorter.
const FIRST_MAX: usize = 512;
/// Bytes kept besides: an hour of a dial box that is turned all the time, 20 minutes of a pen that never rests.
const BYTES_MAX: usize = 4 << 20;
/// Bytes that one take may have of one device: four hours of such a pen.
const TAKE_BYTES_MAX: usize = 64 << 20;

/// Where in a tape something is: things said before it, since the line was opened.
pub(crate) type Mark = u64;

/// What one device said.
#[derive(Debug, Default)]
struct Tape {
    /// When its line was opened.
    opened: Duration,
    reports: bool,
    first: Vec<Record>,
    heads: VecDeque<Head>,
    bytes: VecDeque<u8>,
    /// Answers among the later things, by their number.
    answers: BTreeMap<Mark, What>,
    /// Things said in all.
    said: Mark,
    /// A take is running from here: nothing behind it may go.
    held_from: Option<Mark>,
    /// Something between the beginning and what is left is gone.
    cut: bool,
}

#[derive(Clone, Copy, Debug)]
struct Head {
    at: Duration,
    bytes: u32,
}

impl Tape {
    /// The line is open; a conversation begins. While a take runs, it goes on with the new line instead.
    fn open(&mut self, at: Duration, reports: bool) {
        if self.held_from.is_some() {
            self.put(at, What::Back);
        } else {
            *self = Self {
                opened: at,
                reports,
                ..Self::default()
            };
        }
    }

    fn put(&mut self, at: Duration, what: What) {
        if self.first.len() < FIRST_MAX {
            self.first.push(Record::new(at, what));
        } else {
            self.answers.insert(self.said, what);
            self.heads.push_back(Head { at, bytes: 0 });
        }
        self.said += 1;
    }

    fn hear(&mut self, at: Duration, bytes: &[u8]) {
        if self.first.len() < FIRST_MAX {
            self.first.push(Record::new(at, What::Device(bytes.to_vec())));
        } else {
            self.bytes.extend(bytes);
            let bytes = bytes.len() as u32;
            self.heads.push_back(Head { at, bytes });
            self.forget(self.said + 1);
        }
        self.said += 1;
    }

    /// Lets the oldest of the later things go while there are too many; `next` is the number behind the last.
    fn forget(&mut self, next: Mark) {
        while self.bytes.len() > BYTES_MAX {
            let oldest = next - self.heads.len() as Mark;
            if self.held_from.is_some_and(|from| oldest >= from) {
                return;
            }
            let Some(head) = self.heads.pop_front() else {
                return;
            };
            self.bytes.drain(..head.bytes as usize);
            self.answers.remove(&oldest);
            self.cut = true;
        }
    }

    /// Everything that is left, each with its number.
    fn records(&self) -> Vec<(Mark, Record)> {
        let first = (0..).zip(self.first.iter().cloned());
        let mut number = self.said - self.heads.len() as Mark;
        let mut bytes = self.bytes.iter().copied();
        let later = self.heads.iter().map(|head| {
            let said: Vec<u8> = bytes.by_ref().take(head.bytes as usize).collect();
            let what = self.answers.get(&number).cloned();
            number += 1;
            let what = what.unwrap_or(What::Device(said));
            (number - 1, Record::new(head.at, what))
        });
        first.chain(later.collect::<Vec<_>>()).collect()
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

/// Writes what passes on a tape: what the device says, and that it is gone. What the host says is left out: whoever
/// hears the same asks the same.
struct Writer {
    tape: SharedTape,
    began: Instant,
}

impl Notes for Writer {
    fn note(&mut self, at: Instant, passed: Passed<'_>) {
        let at = at.since(self.began);
        let mut tape = self.tape.lock();
        match passed {
            Passed::Heard(bytes) => tape.hear(at, bytes),
            Passed::Answered(answer) => tape.put(at, What::Answer(Answer::clone(answer))),
            Passed::Gone => tape.put(at, What::Gone),
            Passed::Sent(_) => {}
        }
    }
}

/// The tapes of all lines that were opened for input devices, by address.
#[derive(Debug, Default)]
pub(crate) struct Tapes {
    tapes: BTreeMap<String, SharedTape>,
}

impl Tapes {
    /// From now on nothing of this device's tape goes until [`Tapes::let_go`]. `None` where it has none.
    pub(crate) fn hold(&self, address: &str) -> Option<Mark> {
        let mut tape = self.tapes.get(address)?.lock();
        let from = tape.said;
        tape.held_from = Some(from);
        Some(from)
    }

    pub(crate) fn let_go(&self, address: &str) {
        if let Some(tape) = self.tapes.get(address) {
            let mut tape = tape.lock();
            tape.held_from = None;
            let next = tape.said;
            tape.forget(next);
        }
    }

    /// Whether a take has become too long for this device's tape.
    pub(crate) fn is_full(&self, address: &str) -> bool {
        self.tapes
            .get(address)
            .is_some_and(|tape| tape.lock().bytes.len() > TAKE_BYTES_MAX)
    }

    /// What the device said, cut in two at a mark. Times never run backwards in it: what arrived before an answer was
    /// fetched is told with the answer's time.
    pub(crate) fn heard(&self, address: &str, from: Mark) -> Option<Heard> {
        let tape = self.tapes.get(address)?.lock();
        let mut heard = Heard {
            reports: tape.reports,
            opened: tape.opened,
            ..Heard::default()
        };
        let mut latest = Duration::ZERO;
        for (number, mut record) in tape.records() {
            latest = latest.max(record.at.unwrap_or_default());
            record.at = Some(latest);
            if number < from {
                heard.before.push(record);
            } else {
                heard.during.push(record);
            }
        }
        Some(heard)
    }

    /// Ports whose lines write on these tapes.
    pub(crate) fn at<'t>(
        &'t mut self,
        ports: &'t mut dyn Ports,
        clock: &'t Arc<dyn Clock>,
        began: Instant,
    ) -> TapedPorts<'t> {
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
        let line = self.ports.open(address, baud)?;
        Ok(self.taped(address, line))
    }

    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let line = self.ports.open_input(address, line)?;
        Ok(self.taped(address, line))
    }

    fn pin(&mut self, address: &str, slot: Option<u16>) -> Result<(), String> {
        self.ports.pin(address, slot)
    }

    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        self.ports.touch(address, touch)
    }
}

impl TapedPorts<'_> {
    fn taped(&mut self, address: &str, line: Box<dyn Transport>) -> Box<dyn Transport> {
        let tape = self.tapes.tapes.entry(address.to_owned()).or_default().clone();
        let reports = line.boundary() == Boundary::Reports;
        tape.lock().open(self.clock.now().since(self.began), reports);
        let began = self.began;
        Box::new(Tap::new(
            line,
            Arc::clone(self.clock),
            Box::new(Writer { tape, began }),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert!(tape.cut && tape.bytes.len() <= BYTES_MAX);
        let records = tape.records();
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
        let from = tape.said;
        tape.held_from = Some(from);
        let long = vec![1; 1 << 20];
        for n in 600..610 {
            tape.hear(ms(n), &long);
        }
        tape.put(ms(611), What::Gone);
        tape.open(ms(700), false);
        tape.hear(ms(701), &[9]);
        let held: Vec<Record> = tape
            .records()
            .into_iter()
            .filter(|(n, _)| *n >= from)
            .map(|(_, r)| r)
            .collect();
        assert_eq!(held.len(), 13);
        assert_eq!(held[10].what, What::Gone);
        assert_eq!(held[11], Record::new(ms(700), What::Back));
        assert_eq!(held[12].what, What::Device(vec![9]));
        tape.held_from = None;
        let next = tape.said;
        tape.forget(next);
        assert!(tape.bytes.len() <= BYTES_MAX);
        tape.open(ms(900), false);
        assert_eq!((tape.said, tape.opened), (0, ms(900)));
    }
}
