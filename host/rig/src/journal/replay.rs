//! Reading a journal and making it happen again.

use std::collections::{BTreeMap, VecDeque};

use device::clock::Instant;
use device::transport::{Boundary, Transport, TransportError};

use super::record::{Ending, Failure, Record, VERSION, from_hex};
use crate::command::{Command, Touch};
use crate::controls_calibration::ControlsCalibration;
use crate::ports::{Found, Ports, TouchError};

/// A journal cannot be replayed.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// A line is not a record.
    #[error("line {line}: expected a journal record, found {found}; the journal may be cut or edited")]
    Line {
        /// Line number from 1.
        line: usize,
        /// What was wrong.
        found: String,
    },
    /// The first line is missing or of another version.
    #[error("expected a journal of version {VERSION} beginning with its start record, found {found}")]
    Start {
        /// What was found.
        found: String,
    },
}

/// A journal taken apart: what to start the rig with, and what to give it step by step.
#[derive(Debug)]
pub struct Script {
    /// Files of the show, name to text.
    pub show: BTreeMap<String, String>,
    /// What was calibrated on input devices when it began.
    pub calibrated: BTreeMap<String, ControlsCalibration>,
    /// Time and commands of every step.
    pub steps: Vec<Replayed>,
    /// What came out when it was recorded; missing when the recording was cut short.
    pub ending: Option<Ending>,
    ports: VecDeque<Opening>,
    lists: VecDeque<(u64, Vec<Found>)>,
}

/// One step to be taken again.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// Machine time.
    pub now: Instant,
    /// Commands given.
    pub commands: Vec<Command>,
}

/// Bytes, or how reading them failed.
type Came = Result<Vec<u8>, Failure>;

#[derive(Debug, Default)]
struct Opening {
    address: String,
    failed: Option<Failure>,
    reports: bool,
    reads: VecDeque<(u64, Came, Option<Instant>)>,
    writes: VecDeque<(u64, Failure)>,
    answers: VecDeque<(u64, Came)>,
}

impl Script {
    /// Reads a journal's text.
    pub fn parse(text: &str) -> Result<Self, JournalError> {
        let mut show = None;
        let mut steps = Vec::new();
        let mut ending = None;
        let mut ports: Vec<Opening> = Vec::new();
        let mut lists = VecDeque::new();
        let mut calibrated = BTreeMap::new();
        for (index, line) in text.lines().enumerate() {
            let bad = |found: String| JournalError::Line {
                line: index + 1,
                found,
            };
            let record: Record = serde_json::from_str(line).map_err(|e| bad(e.to_string()))?;
            match record {
                Record::Start {
                    version: VERSION,
                    show: files,
                } if index == 0 => show = Some(files),
                Record::Start { version, .. } => {
                    return Err(JournalError::Start {
                        found: format!("version {version} on line {}", index + 1),
                    });
                }
                Record::Calibrated { devices } => calibrated = devices,
                Record::Step { now, commands } => {
                    steps.push(Replayed {
                        now: Instant::from_nanos(now),
                        commands,
                    });
                }
                Record::Open {
                    address,
                    failed,
                    reports,
                    ..
                } => {
                    ports.push(Opening {
                        address,
                        failed,
                        reports,
                        ..Opening::default()
                    });
                }
                Record::Listed { call, found } => lists.push_back((call, found)),
                Record::Read { .. } | Record::Answer { .. } | Record::Fail { .. } => {
                    happen(&mut ports, record).map_err(bad)?;
                }
                Record::End(digests) => ending = Some(digests),
            }
        }
        let show = show.ok_or_else(|| JournalError::Start {
            found: "no start record".into(),
        })?;
        Ok(Self {
            show,
            calibrated,
            steps,
            ending,
            ports: ports.into(),
            lists,
        })
    }

    /// Takes the recorded ports out, to start the rig with.
    pub fn take_ports(&mut self) -> ReplayPorts {
        ReplayPorts {
            openings: std::mem::take(&mut self.ports),
            lists: std::mem::take(&mut self.lists),
            calls: 0,
            listed: Vec::new(),
        }
    }
}

/// Notes what happened on a port with that port; the error says what is wrong with the record.
fn happen(ports: &mut [Opening], record: Record) -> Result<(), String> {
    let bytes = |hex: &str| from_hex(hex).ok_or_else(|| "bytes that are not hexadecimal".to_owned());
    match record {
        Record::Read { port, call, hex, at } => {
            let at = at.map(Instant::from_nanos);
            opening(ports, port)?
                .reads
                .push_back((call, Ok(bytes(&hex)?), at));
        }
        Record::Answer {
            port,
            call,
            hex,
            failure,
        } => {
            let answer = match (hex, failure) {
                (Some(hex), None) => Ok(bytes(&hex)?),
                (None, Some(failure)) => Err(failure),
                _ => return Err("an answer that is not either bytes or a failure".to_owned()),
            };
            opening(ports, port)?.answers.push_back((call, answer));
        }
        Record::Fail {
            port,
            call,
            write: true,
            failure,
        } => opening(ports, port)?.writes.push_back((call, failure)),
        Record::Fail {
            port, call, failure, ..
        } => opening(ports, port)?.reads.push_back((call, Err(failure), None)),
        Record::Start { .. }
        | Record::Calibrated { .. }
        | Record::Step { .. }
        | Record::Open { .. }
        | Record::Listed { .. }
        | Record::End(_) => {}
    }
    Ok(())
}

fn opening(ports: &mut [Opening], port: u32) -> Result<&mut Opening, String> {
    ports
        .get_mut(port as usize)
        .ok_or_else(|| format!("unknown port {port}"))
}

/// Ports that give back what was recorded, in the order the ports were opened.
#[derive(Debug)]
pub struct ReplayPorts {
    openings: VecDeque<Opening>,
    lists: VecDeque<(u64, Vec<Found>)>,
    calls: u64,
    listed: Vec<Found>,
}

impl Ports for ReplayPorts {
    fn list(&mut self) -> Vec<Found> {
        let call = self.calls;
        self.calls += 1;
        if self.lists.front().is_some_and(|(due, _)| *due == call) {
            self.listed = self.lists.pop_front().map(|(_, found)| found).unwrap_or_default();
        }
        self.listed.clone()
    }

    fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        let opening = self.openings.pop_front().filter(|o| o.address == address);
        match opening {
            None => Err(TransportError::NotFound {
                address: address.to_owned(),
            }),
            Some(Opening {
                failed: Some(failure),
                ..
            }) => Err(as_error(&failure, address)),
            Some(opening) => Ok(Box::new(ReplayTransport {
                opening,
                reads: 0,
                writes: 0,
                questions: 0,
                arrived: None,
            })),
        }
    }

    fn pin(&mut self, _address: &str, _slot: Option<u16>) -> Result<(), String> {
        // What it changed is in the journal as listings.
        Ok(())
    }

    fn touch(&mut self, _address: &str, _touch: &Touch) -> Result<(), TouchError> {
        // What the touch caused is in the journal as bytes.
        Ok(())
    }
}

struct ReplayTransport {
    opening: Opening,
    reads: u64,
    writes: u64,
    questions: u64,
    arrived: Option<Instant>,
}

impl ReplayTransport {
    /// The answer to the next question; `None`: there was none yet.
    fn answer(&mut self) -> Result<Option<Vec<u8>>, TransportError> {
        let call = self.questions;
        self.questions += 1;
        if self.opening.answers.front().is_none_or(|(due, _)| *due != call) {
            return Ok(None);
        }
        match self.opening.answers.pop_front() {
            Some((_, Err(failure))) => Err(as_error(&failure, &self.opening.address)),
            answered => Ok(answered.and_then(|(_, bytes)| bytes.ok())),
        }
    }
}

impl Transport for ReplayTransport {
    fn boundary(&self) -> Boundary {
        if self.opening.reports {
            Boundary::Reports
        } else {
            Boundary::Stream
        }
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let call = self.reads;
        self.reads += 1;
        if self.opening.reads.front().is_none_or(|(due, ..)| *due != call) {
            return Ok(0);
        }
        match self.opening.reads.pop_front() {
            Some((_, Ok(bytes), at)) => {
                let count = bytes.len().min(buffer.len());
                buffer[..count].copy_from_slice(&bytes[..count]);
                self.arrived = at;
                Ok(count)
            }
            Some((_, Err(failure), _)) => Err(as_error(&failure, &self.opening.address)),
            None => Ok(0),
        }
    }

    fn write_feature(&mut self, _bytes: &[u8]) -> Result<Option<()>, TransportError> {
        Ok(self.answer()?.map(drop))
    }

    fn read_feature(&mut self, _id: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        Ok(self.answer()?.map(|bytes| {
            let count = bytes.len().min(buffer.len());
            buffer[..count].copy_from_slice(&bytes[..count]);
            count
        }))
    }

    fn read_string(&mut self, _index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        self.answer()
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        Ok(self.answer()?.unwrap_or_default())
    }

    fn arrived(&self) -> Option<Instant> {
        self.arrived
    }

    fn write(&mut self, _bytes: &[u8]) -> Result<(), TransportError> {
        let call = self.writes;
        self.writes += 1;
        match self.opening.writes.front() {
            Some((due, failure)) if *due == call => Err(as_error(failure, &self.opening.address)),
            _ => Ok(()),
        }
    }
}

fn as_error(failure: &Failure, address: &str) -> TransportError {
    match failure {
        Failure::Gone => TransportError::Gone {
            address: address.to_owned(),
        },
        Failure::Other(text) => TransportError::Io {
            address: address.to_owned(),
            source: std::io::Error::other(text.clone()),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::journal::{Recorder, RecordingPorts};
    use device::transport::memory::reports::{self, ReportTransport};
    use std::io::Write;
    use std::sync::{Arc, Mutex};

    /// A port that can be opened once.
    struct Once(Option<ReportTransport>);

    impl Ports for Once {
        fn list(&mut self) -> Vec<Found> {
            Vec::new()
        }
        fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
            match self.0.take() {
                Some(line) => Ok(Box::new(line)),
                None => Err(TransportError::NotFound {
                    address: address.to_owned(),
                }),
            }
        }
    }

    #[derive(Clone, Default)]
    struct Sink(Arc<Mutex<Vec<u8>>>);

    impl Write for Sink {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().expect("nobody panics with it").extend(bytes);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    /// Everything a line can be asked, as text.
    fn deal(line: &mut dyn Transport) -> Vec<String> {
        let mut buffer = [0; 8];
        let mut said = vec![format!("{:?}", line.boundary())];
        for _ in 0..3 {
            let read = line.read(&mut buffer).map(|count| buffer[..count].to_vec());
            said.push(format!("{read:?} at {:?}", line.arrived()));
        }
        for _ in 0..2 {
            said.push(format!("{:?}", line.read_string(200)));
        }
        // The words of a refusal are wrapped in an address of their own; that there was one is what counts.
        said.push(format!("{}", line.read_string(1).is_err()));
        said.push(format!("{:?}", line.write_feature(&[2, 2])));
        said.push(format!("{:?} {buffer:?}", line.read_feature(9, &mut buffer)));
        said.push(format!("{:?}", line.report_descriptor()));
        said
    }

    #[test]
    fn answers_times_and_report_boundaries_come_back_as_they_were() {
        let (host, far) = reports::pair("sim:pad");
        far.report_at(&[1, 2], Instant::from_nanos(17));
        far.report(&[3]);
        far.set_string(200, &[4, 3, 65, 0]);
        far.set_feature(9, &[9, 8, 7]);
        far.set_descriptor(&[5, 13]);
        far.answer_late(1);
        let sink = Sink::default();
        let recorder = Recorder::new(Box::new(sink.clone()), BTreeMap::new());
        let mut ports = RecordingPorts::new(Box::new(Once(Some(host))), recorder.clone());
        let recorded = deal(ports.open("sim:pad", 0).expect("it is there").as_mut());
        recorder.finish().expect("memory takes everything");
        let text = String::from_utf8(sink.0.lock().expect("nobody panics with it").clone()).expect("JSON");
        let mut script = Script::parse(&text).expect("just written");
        let mut ports = script.take_ports();
        let replayed = deal(ports.open("sim:pad", 0).expect("it was recorded").as_mut());
        assert_eq!(recorded, replayed);
        assert!(
            recorded.iter().any(|said| said.contains("nanos: 17")),
            "{recorded:?}"
        );
        assert!(
            recorded.contains(&"Ok(None)".to_owned()),
            "one answer was late: {recorded:?}"
        );
    }
}
