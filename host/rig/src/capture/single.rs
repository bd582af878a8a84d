//! One device, captured without a show.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use device::clock::{Clock, Instant};
use device::codec::Step;
use device::exchange::{Head, What};
use device::tap::{Notes, Passed, Tap};
use device::transport::{Transport, TransportError};
use device_profiles::{Line, Profiles};

use super::CaptureError;
use super::file::CaptureFile;
use crate::listen::{Heard, Listener};
use crate::ports::{Found, Ports};

/// What passed, until it is written.
type Passing = Arc<Mutex<Vec<(Instant, What)>>>;

struct Noting(Passing);

impl Notes for Noting {
    fn note(&mut self, at: Instant, passed: Passed<'_>) {
        let what = match passed {
            Passed::Heard(bytes) => What::Device(bytes.to_vec()),
            Passed::Sent(step) => What::Host(Step::clone(step)),
            Passed::Answered(answer) => What::Answer(answer.clone()),
            Passed::Gone => What::Gone,
        };
        // A panic elsewhere leaves whole records.
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push((at, what));
    }
}

/// Ports whose one line is tapped.
struct TappedPorts<'p> {
    ports: &'p mut dyn Ports,
    clock: Arc<dyn Clock>,
    passing: Passing,
}

impl Ports for TappedPorts<'_> {
    fn list(&mut self) -> Vec<Found> {
        self.ports.list()
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        let line = self.ports.open(address, baud)?;
        Ok(self.tapped(line))
    }

    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let line = self.ports.open_input(address, line)?;
        Ok(self.tapped(line))
    }
}

impl TappedPorts<'_> {
    fn tapped(&self, line: Box<dyn Transport>) -> Box<dyn Transport> {
        let notes = Box::new(Noting(Arc::clone(&self.passing)));
        Box::new(Tap::new(line, Arc::clone(&self.clock), notes))
    }
}

/// A device that is being captured.
pub struct Capture {
    listener: Listener,
    passing: Passing,
    clock: Arc<dyn Clock>,
    began: Instant,
    file: CaptureFile,
}

impl Capture {
    /// Opens the device as its profile says, or as [`Listener::open`] recognises it, and the file beside `place`.
    pub fn open(
        ports: &mut dyn Ports,
        address: &str,
        profile: Option<&str>,
        profiles: &Profiles,
        clock: Arc<dyn Clock>,
        place: &Path,
    ) -> Result<Self, CaptureError> {
        let passing = Passing::default();
        let mut tapped = TappedPorts {
            ports,
            clock: Arc::clone(&clock),
            passing: Arc::clone(&passing),
        };
        let began = clock.now();
        let listener = Listener::open(&mut tapped, address, profile, profiles, Arc::clone(&clock))?;
        let head = Head {
            profile: Some(listener.profile().to_owned()).filter(|key| !key.is_empty()),
            source: Some(format!("captured from {address}")),
            ..Head::default()
        };
        Ok(Self {
            listener,
            passing,
            clock,
            began,
            file: CaptureFile::create(place, head)?,
        })
    }

    /// Waits at most `patience` for something, writes what passed, and hands over the events.
    pub fn next(&mut self, patience: Duration, hear: &mut dyn FnMut(Heard)) -> Result<(), CaptureError> {
        let mut heard = Vec::new();
        let listened = self.listener.next(patience, &mut |one| heard.push(one));
        let passed = std::mem::take(&mut *self.passing.lock().unwrap_or_else(PoisonError::into_inner));
        let described = self.listener.profile().is_empty();
        for (at, what) in passed {
            // Whoever has no profile asks for it before there is a codec, which does not.
            if described && what == What::Host(Step::AskDescriptor) {
                continue;
            }
            self.file.add(at.since(self.began), what);
        }
        for one in heard {
            let at = Duration::from_secs_f64(one.at_secs.max(0.0));
            self.file.add(at, What::Event(one.what));
            hear(one);
        }
        self.file.write_out()?;
        Ok(listened?)
    }

    /// Since it began, seconds.
    pub fn secs(&self) -> f64 {
        self.clock.now().since(self.began).as_secs_f64()
    }

    /// What the device calls itself, once it has said so.
    pub fn identity(&self) -> Option<&str> {
        self.listener.identity()
    }

    /// Ends it: the file takes its place. Gives how many lines it has.
    pub fn finish(self) -> Result<u64, CaptureError> {
        self.file.finish().map(|(_, lines)| lines)
    }
}
