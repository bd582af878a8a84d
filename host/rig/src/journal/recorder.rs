//! Writing the journal: ports that note down what passes through them.

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use device::clock::{Clock, Instant};
use device::transport::{Boundary, Transport, TransportError};
use device_profiles::Line;

use super::record::{Digest, Ending, Failure, Record, VERSION, to_hex};
use crate::command::{Command, Touch};
use crate::controls_calibration::ControlsCalibration;
use crate::ports::{Found, Ports, TouchError};
use crate::snapshot::Snapshot;

/// Writes the lines. Clones write to the same journal.
#[derive(Clone)]
pub struct Recorder(Arc<Mutex<Inner>>);

struct Inner {
    sink: Box<dyn Write + Send>,
    /// The first failure to write; later lines are dropped, the rig goes on.
    failed: Option<std::io::Error>,
    ports: u32,
    steps: u64,
    snapshots: Digest,
    written: BTreeMap<String, Digest>,
}

impl Recorder {
    /// Writes to `sink`, beginning with the show's files.
    pub fn new(sink: Box<dyn Write + Send>, show: BTreeMap<String, String>) -> Self {
        let recorder = Self(Arc::new(Mutex::new(Inner {
            sink,
            failed: None,
            ports: 0,
            steps: 0,
            snapshots: Digest::default(),
            written: BTreeMap::new(),
        })));
        recorder.lock().line(&Record::Start {
            version: VERSION,
            show,
        });
        recorder
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // A panic elsewhere leaves whole lines behind, so the journal may go on.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn calibrations(&self, devices: &BTreeMap<String, ControlsCalibration>) {
        if !devices.is_empty() {
            let devices = devices.clone();
            self.lock().line(&Record::Calibrated { devices });
        }
    }

    pub(crate) fn step(&self, now: Instant, commands: &[Command]) {
        self.lock().line(&Record::Step {
            now: now.as_nanos(),
            // What is written into other files is done once.
            commands: commands.iter().filter(|it| !it.is_capture()).cloned().collect(),
        });
    }

    pub(crate) fn snapshot(&self, snapshot: &Snapshot) {
        let mut inner = self.lock();
        inner.steps += 1;
        snapshot.digest(&mut inner.snapshots);
    }

    /// Writes the last line and flushes. Returns the digests, or the first failure to write.
    pub fn finish(&self) -> std::io::Result<Ending> {
        let mut inner = self.lock();
        let ending = inner.ending();
        inner.line(&Record::End(ending.clone()));
        match inner.failed.take() {
            Some(error) => Err(error),
            None => inner.sink.flush().map(|()| ending),
        }
    }
}

impl Inner {
    fn ending(&self) -> Ending {
        Ending {
            steps: self.steps,
            snapshots: self.snapshots.hex(),
            written: self
                .written
                .iter()
                .map(|(port, digest)| (port.clone(), digest.hex()))
                .collect(),
        }
    }

    fn line(&mut self, record: &Record) {
        if self.failed.is_some() {
            return;
        }
        let written = serde_json::to_vec(record)
            .map_err(std::io::Error::from)
            .and_then(|mut line| {
                line.push(b'\n');
                self.sink.write_all(&line)
            });
        self.failed = written.err();
    }
}

/// Ports that write down what passes through them.
pub struct RecordingPorts {
    inner: Box<dyn Ports>,
    recorder: Recorder,
    lists: u64,
    listed: Vec<Found>,
}

impl RecordingPorts {
    /// Wraps `inner`.
    pub fn new(inner: Box<dyn Ports>, recorder: Recorder) -> Self {
        Self {
            inner,
            recorder,
            lists: 0,
            listed: Vec::new(),
        }
    }
}

impl Ports for RecordingPorts {
    fn list(&mut self) -> Vec<Found> {
        let found = self.inner.list();
        let call = self.lists;
        self.lists += 1;
        if found != self.listed {
            self.listed.clone_from(&found);
            self.recorder.lock().line(&Record::Listed {
                call,
                found: found.clone(),
            });
        }
        found
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        let opened = self.inner.open(address, baud);
        self.record(address, opened)
    }

    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let opened = self.inner.open_input(address, line);
        self.record(address, opened)
    }

    fn pin(&mut self, address: &str, slot: Option<u16>) -> Result<(), String> {
        self.inner.pin(address, slot)
    }

    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        self.inner.touch(address, touch)
    }
}

impl RecordingPorts {
    fn record(
        &mut self,
        address: &str,
        opened: Result<Box<dyn Transport>, TransportError>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let mut log = self.recorder.lock();
        let port = log.ports;
        log.ports += 1;
        let failed = opened.as_ref().err().map(failure);
        log.line(&Record::Open {
            address: address.to_owned(),
            port,
            reports: opened
                .as_ref()
                .is_ok_and(|line| line.boundary() == Boundary::Reports),
            failed,
        });
        let key = format!("{port} {address}");
        log.written.insert(key.clone(), Digest::default());
        drop(log);
        let inner = opened?;
        Ok(Box::new(RecordedTransport {
            inner,
            recorder: self.recorder.clone(),
            port,
            key,
            reads: 0,
            writes: 0,
            questions: 0,
        }))
    }
}

struct RecordedTransport {
    inner: Box<dyn Transport>,
    recorder: Recorder,
    port: u32,
    key: String,
    reads: u64,
    writes: u64,
    questions: u64,
}

impl RecordedTransport {
    /// Writes down what a question brought; `None`: nothing yet.
    fn note(&mut self, answered: Result<Option<&[u8]>, &TransportError>) {
        let (port, call) = (self.port, self.questions);
        self.questions += 1;
        let (hex, failure) = match answered {
            Ok(None) => return,
            Ok(Some(bytes)) => (Some(to_hex(bytes)), None),
            Err(error) => (None, Some(failure(error))),
        };
        self.recorder.lock().line(&Record::Answer {
            port,
            call,
            hex,
            failure,
        });
    }
}

impl Transport for RecordedTransport {
    fn boundary(&self) -> Boundary {
        self.inner.boundary()
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let (port, call) = (self.port, self.reads);
        self.reads += 1;
        let read = self.inner.read(buffer);
        match &read {
            Ok(0) => {}
            Ok(count) => {
                let hex = to_hex(buffer.get(..*count).unwrap_or_default());
                let at = self.inner.arrived().map(Instant::as_nanos);
                self.recorder.lock().line(&Record::Read { port, call, hex, at });
            }
            Err(error) => {
                self.recorder.lock().line(&Record::Fail {
                    port,
                    call,
                    write: false,
                    failure: failure(error),
                });
            }
        }
        read
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let (port, call) = (self.port, self.writes);
        self.writes += 1;
        let written = self.inner.write(bytes);
        let mut log = self.recorder.lock();
        if let Some(digest) = log.written.get_mut(&self.key) {
            digest.bytes(bytes);
        }
        if let Err(error) = &written {
            log.line(&Record::Fail {
                port,
                call,
                write: true,
                failure: failure(error),
            });
        }
        written
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        self.inner.set_baud(baud)
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<Option<()>, TransportError> {
        let written = self.inner.write_feature(bytes);
        if let (Ok(Some(())), Some(digest)) = (&written, self.recorder.lock().written.get_mut(&self.key)) {
            digest.bytes(bytes);
        }
        // Done is an answer without bytes.
        self.note(written.as_ref().map(|done| done.map(|()| [].as_slice())));
        written
    }

    fn read_feature(&mut self, id: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        let answered = self.inner.read_feature(id, buffer);
        self.note(match &answered {
            Ok(count) => Ok(count.and_then(|count| buffer.get(..count))),
            Err(error) => Err(error),
        });
        answered
    }

    fn read_string(&mut self, index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        let answered = self.inner.read_string(index);
        self.note(answered.as_ref().map(Option::as_deref));
        answered
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        let answered = self.inner.report_descriptor();
        self.note(answered.as_deref().map(Some));
        answered
    }

    fn arrived(&self) -> Option<Instant> {
        self.inner.arrived()
    }

    fn dropped(&self) -> u64 {
        self.inner.dropped()
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.inner.wait(clock, until);
    }

    fn ready(&mut self) -> bool {
        self.inner.ready()
    }
}

fn failure(error: &TransportError) -> Failure {
    match error {
        TransportError::Gone { .. } => Failure::Gone,
        other => Failure::Other(other.to_string()),
    }
}
