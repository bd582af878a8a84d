//! Reading a journal and making it happen again.

use std::collections::{BTreeMap, VecDeque};

use device::clock::Instant;
use device::transport::{Boundary, Transport, TransportError};

use super::record::{Ending, Failure, Record, VERSION, from_hex};
use crate::command::{Command, Touch};
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
    /// Time and commands of every step.
    pub steps: Vec<Replayed>,
    /// What came out when it was recorded; missing when the recording was cut short.
    pub ending: Option<Ending>,
    ports: VecDeque<Opening>,
}

/// One step to be taken again.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// Machine time.
    pub now: Instant,
    /// Commands given.
    pub commands: Vec<Command>,
}

#[derive(Debug, Default)]
struct Opening {
    address: String,
    failed: Option<Failure>,
    reads: VecDeque<(u64, Result<Vec<u8>, Failure>)>,
    writes: VecDeque<(u64, Failure)>,
}

impl Script {
    /// Reads a journal's text.
    pub fn parse(text: &str) -> Result<Self, JournalError> {
        let mut show = None;
        let mut steps = Vec::new();
        let mut ending = None;
        let mut ports: Vec<Opening> = Vec::new();
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
                Record::Step { now, commands } => {
                    steps.push(Replayed {
                        now: Instant::from_nanos(now),
                        commands,
                    });
                }
                Record::Open { address, failed, .. } => {
                    ports.push(Opening {
                        address,
                        failed,
                        ..Opening::default()
                    });
                }
                Record::Read { port, call, hex } => {
                    let bytes = from_hex(&hex).ok_or_else(|| bad("bytes that are not hexadecimal".into()))?;
                    let opening = ports
                        .get_mut(port as usize)
                        .ok_or_else(|| bad(format!("unknown port {port}")))?;
                    opening.reads.push_back((call, Ok(bytes)));
                }
                Record::Fail {
                    port,
                    call,
                    write,
                    failure,
                } => {
                    let opening = ports
                        .get_mut(port as usize)
                        .ok_or_else(|| bad(format!("unknown port {port}")))?;
                    if write {
                        opening.writes.push_back((call, failure));
                    } else {
                        opening.reads.push_back((call, Err(failure)));
                    }
                }
                Record::End(digests) => ending = Some(digests),
            }
        }
        let show = show.ok_or_else(|| JournalError::Start {
            found: "no start record".into(),
        })?;
        Ok(Self {
            show,
            steps,
            ending,
            ports: ports.into(),
        })
    }

    /// Takes the recorded ports out, to start the rig with.
    pub fn take_ports(&mut self) -> ReplayPorts {
        ReplayPorts {
            openings: std::mem::take(&mut self.ports),
        }
    }
}

/// Ports that give back what was recorded, in the order the ports were opened.
#[derive(Debug)]
pub struct ReplayPorts {
    openings: VecDeque<Opening>,
}

impl Ports for ReplayPorts {
    fn list(&mut self) -> Vec<Found> {
        Vec::new()
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
            })),
        }
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
}

impl Transport for ReplayTransport {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let call = self.reads;
        self.reads += 1;
        if self.opening.reads.front().is_none_or(|(due, _)| *due != call) {
            return Ok(0);
        }
        match self.opening.reads.pop_front() {
            Some((_, Ok(bytes))) => {
                let count = bytes.len().min(buffer.len());
                buffer[..count].copy_from_slice(&bytes[..count]);
                Ok(count)
            }
            Some((_, Err(failure))) => Err(as_error(&failure, &self.opening.address)),
            None => Ok(0),
        }
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
