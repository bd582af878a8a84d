//! A line with a tap: what passes through it is noted, with its time.
//!
//! Captures and takes are made of this. It changes nothing on the line; what becomes of the notes, and how many are
//! kept, is the taker's business.

use crate::clock::{Clock, Instant};
use crate::codec::{Answer, Step};
use crate::transport::{Boundary, Transport, TransportError};
use rustix::fd::BorrowedFd;
use std::sync::Arc;

/// Something that passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Passed<'p> {
    /// The device said this: a piece of a stream, or one report.
    Heard(&'p [u8]),
    /// The host sent, asked or set.
    Sent(&'p Step),
    /// What came back for a question, or for a setting that was refused.
    Answered(&'p Answer),
    /// The line is gone. Noted once.
    Gone,
}

/// Whoever notes what passes. It is called in the middle of reading and writing, so it must be quick.
pub trait Notes: Send {
    /// Notes one thing and when it passed.
    fn note(&mut self, at: Instant, passed: Passed<'_>);
}

/// A transport whose traffic is noted.
pub struct Tap {
    line: Box<dyn Transport>,
    clock: Arc<dyn Clock>,
    notes: Box<dyn Notes>,
    /// A question that was asked and not answered yet: asking again is no news.
    open: Option<Step>,
    gone: bool,
}

impl Tap {
    /// Taps `line`.
    pub fn new(line: Box<dyn Transport>, clock: Arc<dyn Clock>, notes: Box<dyn Notes>) -> Self {
        Self {
            line,
            clock,
            notes,
            open: None,
            gone: false,
        }
    }

    fn note(&mut self, passed: Passed<'_>) {
        self.notes.note(self.clock.now(), passed);
    }

    fn ask(&mut self, question: Step) {
        if self.open.as_ref() != Some(&question) {
            self.note(Passed::Sent(&question));
            self.open = Some(question);
        }
    }

    fn answered(&mut self, answer: &Answer) {
        self.open = None;
        self.note(Passed::Answered(answer));
    }

    fn watch<T>(&mut self, done: Result<T, TransportError>) -> Result<T, TransportError> {
        if let Err(error) = &done
            && error.is_gone()
            && !self.gone
        {
            self.gone = true;
            self.note(Passed::Gone);
        }
        done
    }
}

impl Transport for Tap {
    fn boundary(&self) -> Boundary {
        self.line.boundary()
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let read = self.line.read(buffer);
        if let Ok(count @ 1..) = read {
            let at = self.line.arrived().unwrap_or_else(|| self.clock.now());
            let bytes = buffer.get(..count).unwrap_or_default();
            self.notes.note(at, Passed::Heard(bytes));
        }
        self.watch(read)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let written = self.line.write(bytes);
        if written.is_ok() {
            let bytes = bytes.to_vec();
            let step = match self.line.boundary() {
                Boundary::Stream => Step::Bytes(bytes),
                Boundary::Reports => Step::Report(bytes),
            };
            self.note(Passed::Sent(&step));
        }
        self.watch(written)
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        let set = self.line.set_baud(baud);
        if set.is_ok() {
            self.note(Passed::Sent(&Step::Baud(baud)));
        }
        self.watch(set)
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<Option<()>, TransportError> {
        self.ask(Step::Feature(bytes.to_vec()));
        let written = self.line.write_feature(bytes);
        match &written {
            Ok(None) => {}
            Ok(Some(())) => self.open = None,
            Err(error) => {
                let id = bytes.first().copied().unwrap_or(0);
                let bytes = Err(error.to_string());
                self.answered(&Answer::Feature { id, bytes });
            }
        }
        self.watch(written)
    }

    fn read_feature(&mut self, id: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        let bytes = u16::try_from(buffer.len()).unwrap_or(u16::MAX);
        self.ask(Step::AskFeature { id, bytes });
        let read = self.line.read_feature(id, buffer);
        match &read {
            Ok(None) => {}
            Ok(Some(count)) => {
                let bytes = Ok(buffer.get(..*count).unwrap_or_default().to_vec());
                self.answered(&Answer::Feature { id, bytes });
            }
            Err(error) => {
                let bytes = Err(error.to_string());
                self.answered(&Answer::Feature { id, bytes });
            }
        }
        self.watch(read)
    }

    fn read_string(&mut self, index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        self.ask(Step::AskString(index));
        let read = self.line.read_string(index);
        let raw = match &read {
            Ok(None) => None,
            Ok(Some(raw)) => Some(Ok(raw.clone())),
            Err(error) => Some(Err(error.to_string())),
        };
        if let Some(raw) = raw {
            self.answered(&Answer::Text { index, raw });
        }
        self.watch(read)
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        self.ask(Step::AskDescriptor);
        let read = self.line.report_descriptor();
        let bytes = read.as_ref().map(Vec::clone).map_err(ToString::to_string);
        self.answered(&Answer::Descriptor(bytes));
        self.watch(read)
    }

    fn arrived(&self) -> Option<Instant> {
        self.line.arrived()
    }

    fn dropped(&self) -> u64 {
        self.line.dropped()
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.line.wait(clock, until);
    }

    fn ready(&mut self) -> bool {
        self.line.ready()
    }

    fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        self.line.descriptor()
    }
}
