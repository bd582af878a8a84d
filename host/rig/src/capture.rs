//! Capturing one input device into an exchange, and playing exchanges back through the codec.
//!
//! A capture is written beside its place as it comes and takes its place when it ends, so that a file of that name
//! is always a whole one.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use device::clock::{Clock, Instant};
use device::codec::{InputEvent, Stand, Step, of_profile};
use device::exchange::{self, Exchange, Head, Record, What};
use device::tap::{Notes, Passed, Tap};
use device::transport::{Transport, TransportError};
use device_profiles::{Line, Profiles};

use crate::document::FileError;
use crate::listen::{Heard, ListenError, Listener};
use crate::ports::{Found, Ports};
use crate::telling::{Buttons, Teller};

/// A device cannot be captured.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// It cannot be listened to, or is gone. What came before is kept.
    #[error(transparent)]
    Listen(#[from] ListenError),
    /// The file cannot be written.
    #[error("{file}: cannot write: {source}")]
    File {
        /// The file being written.
        file: String,
        /// Why.
        source: std::io::Error,
    },
}

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
    out: BufWriter<File>,
    part: PathBuf,
    place: PathBuf,
    latest: Duration,
    records: u64,
    text: String,
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
        let mut part = place.as_os_str().to_owned();
        part.push(".part");
        let part = PathBuf::from(part);
        let out = File::create(&part).map_err(|source| file_error(&part, source))?;
        let head = Head {
            profile: Some(listener.profile().to_owned()).filter(|key| !key.is_empty()),
            source: Some(format!("captured from {address}")),
            ..Head::default()
        };
        let mut capture = Self {
            listener,
            passing,
            clock,
            began,
            out: BufWriter::new(out),
            part,
            place: place.to_owned(),
            latest: Duration::ZERO,
            records: 0,
            text: String::new(),
        };
        capture.text = exchange::write(&Exchange {
            head,
            records: Vec::new(),
        });
        capture.write_out()?;
        Ok(capture)
    }

    /// Waits at most `patience` for something, writes what passed, and hands over the events.
    pub fn next(&mut self, patience: Duration, hear: &mut dyn FnMut(Heard)) -> Result<(), CaptureError> {
        let mut heard = Vec::new();
        let listened = self.listener.next(patience, &mut |one| heard.push(one));
        let passed = std::mem::take(&mut *self.passing.lock().unwrap_or_else(PoisonError::into_inner));
        for (at, what) in passed {
            self.add(at.since(self.began), what);
        }
        for one in heard {
            self.add(
                Duration::from_secs_f64(one.at_secs.max(0.0)),
                What::Event(one.what),
            );
            hear(one);
        }
        self.write_out()?;
        Ok(listened?)
    }

    /// Times never run backwards in an exchange: what is told after something is told with its time at least.
    fn add(&mut self, at: Duration, what: What) {
        self.latest = self.latest.max(at);
        exchange::write_record(&mut self.text, &Record::new(self.latest, what));
        self.records += 1;
    }

    fn write_out(&mut self) -> Result<(), CaptureError> {
        let written = self.out.write_all(self.text.as_bytes());
        self.text.clear();
        written.map_err(|source| file_error(&self.part, source))
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
    pub fn finish(mut self) -> Result<u64, CaptureError> {
        let finished = self
            .out
            .flush()
            .and_then(|()| self.out.get_ref().sync_all())
            .and_then(|()| fs::rename(&self.part, &self.place));
        finished.map_err(|source| file_error(&self.place, source))?;
        Ok(self.records)
    }
}

fn file_error(file: &Path, source: std::io::Error) -> CaptureError {
    CaptureError::File {
        file: file.display().to_string(),
        source,
    }
}

/// What a codec makes of an exchange.
pub struct Played {
    /// Its events, with the exchange's times.
    pub events: Vec<Heard>,
    /// Where it did otherwise than the exchange tells; by line.
    pub differences: Vec<FileError>,
    /// How the events are named.
    pub teller: Teller,
}

/// Plays the text of an exchange through the codec of its profile, or of another. `file` is for what is wrong with it.
pub fn replay(
    file: &Path,
    text: &str,
    profile: Option<&str>,
    profiles: &Profiles,
) -> Result<Played, Vec<FileError>> {
    let at = |line: u32, column: u32, message: String| FileError {
        line,
        column,
        ..FileError::whole(file, message)
    };
    let exchange = exchange::read(text).map_err(|errors| {
        let place = |error: exchange::ExchangeError| at(error.line, error.column, error.message);
        errors.into_iter().map(place).collect::<Vec<_>>()
    })?;
    let Some(name) = profile.or(exchange.head.profile.as_deref()) else {
        let error = FileError::whole(file, "this exchange names no profile");
        return Err(vec![
            error.with_hint("name one with --profile, or in a line `profile: NAME`"),
        ]);
    };
    let whole = |error: String| vec![FileError::whole(file, error)];
    let known = profiles.input(name).map_err(|error| whole(error.to_string()))?;
    let stand = if exchange.head.reporting {
        Stand::Reporting
    } else {
        Stand::Unasked
    };
    let mut codec = of_profile(known, stand).map_err(|error| whole(error.to_string()))?;
    let played = exchange::play(&exchange, codec.as_mut());
    let buttons = if codec.surface().is_some() {
        Buttons::Keys
    } else {
        Buttons::Numbered
    };
    let difference = |difference: exchange::Difference| {
        let message = format!("expected {}, found {}", difference.expected, difference.found);
        at(difference.line, 1, message)
    };
    let heard = |event: device::codec::Stamped<InputEvent>| Heard {
        at_secs: event.at.as_secs_f64(),
        what: event.what,
    };
    Ok(Played {
        events: played.events.into_iter().map(heard).collect(),
        differences: played.differences.into_iter().map(difference).collect(),
        teller: Teller::new(buttons),
    })
}
