//! Servos one by one, with torque off: finding, addressing, reading and writing registers, in any protocol.
//!
//! It cannot move anything: goal registers, what may stand for them (Indirect Data) and torque are refused. Asking
//! changes nothing; the first write switches torque off on the whole line. Waiting happens here, on the clock that
//! is given.
//!
//! `find` says who is there, `identify` who somebody is, `registers` reads and writes, `settings` changes ids and
//! line speeds, `service` has the instructions that no register stands for.

mod error;
mod find;
mod identify;
mod registers;
mod service;
mod settings;

pub use error::MaintenanceError;
pub use find::{Found, Heard};

use super::bus::{Bus, BusError};
use super::event::Armed;
use super::framing::{self, BROADCAST_ID, FramingError};
use super::line::{Line, Progress};
use crate::clock::{Clock, Instant};
use crate::transport::{Transport, TransportError};
use device_profiles::{Profiles, Role, ServoProtocol, WordOrder};
use std::time::Duration;

/// Answer slack of the usual bus settings; nobody is in a hurry here.
const SLACK: Duration = Duration::from_millis(20);
/// Silence after a missing answer before the next question.
const QUIET: Duration = Duration::from_millis(40);
/// Tries of one question.
const TRIES: u8 = 3;
/// Address of Torque Enable in every X-series and MX(2.0) control table; XL-320 has nothing there.
const TORQUE_OF_DYNAMIXEL2: u16 = 64;
/// Address of Torque Enable in AX and MX(1.0) control tables.
const TORQUE_OF_DYNAMIXEL1: u16 = 24;
/// Address of Torque Enable in Feetech's tables. AX and MX(1.0) have a byte there that cannot be written.
const TORQUE_OF_FEETECH: u16 = 40;

/// All protocols, in the order in which they are tried.
const ALL: [ServoProtocol; 4] = [
    ServoProtocol::Dynamixel2,
    ServoProtocol::Dynamixel1,
    ServoProtocol::Sts,
    ServoProtocol::Scs,
];

/// What was heard beside answers since the line was opened.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Overheard {
    /// Own packets that came back.
    pub echoes: u64,
    /// Packets that were damaged.
    pub damaged: u64,
    /// Bytes that belonged to no packet.
    pub stray_bytes: u64,
    /// Answers that did not come in time.
    pub timeouts: u64,
    /// Answers that came when nobody waited for them any more.
    pub late: u64,
}

/// What is known of a model before it is met.
#[derive(Debug, Clone, Copy)]
struct Model {
    protocol: ServoProtocol,
    order: WordOrder,
    number: u16,
    torque: Option<u16>,
}

/// Somebody on the line who was identified at the speed in use.
#[derive(Debug, Clone, Copy)]
struct Known {
    id: u8,
    protocol: ServoProtocol,
    torque: u16,
}

/// A bus taken apart. See the module's opening.
pub struct Maintenance {
    line: Line,
    bus: Option<Bus>,
    released: bool,
    protocols: Vec<ServoProtocol>,
    models: Vec<Model>,
    known: Vec<Known>,
}

impl Bus {
    /// Switches torque off, waits until that is confirmed, and gives the line to maintenance.
    pub fn into_maintenance(mut self, clock: &dyn Clock) -> Result<Maintenance, BusError> {
        if self.release_blocking(clock, &mut |_| {})? != Armed::No {
            return Err(BusError::NotArmed {
                bus: self.name().to_owned(),
            });
        }
        let idle = Line::new(Box::new(Nowhere), self.settings.baud, SLACK);
        let mut line = std::mem::replace(&mut self.line, idle);
        line.set_return_delay(super::line::RETURN_DELAY_MAX);
        Ok(Maintenance {
            line,
            bus: Some(self),
            released: true,
            protocols: ALL.to_vec(),
            models: Vec::new(),
            known: Vec::new(),
        })
    }
}

impl Maintenance {
    /// For a line whose servos are not known yet. Torque stays as it is until something is written.
    pub fn new(transport: Box<dyn Transport>, baud: u32) -> Result<Self, MaintenanceError> {
        let mut line = Line::new(transport, baud, SLACK);
        line.set_baud(baud)?;
        Ok(Self {
            line,
            bus: None,
            released: false,
            protocols: ALL.to_vec(),
            models: Vec::new(),
            known: Vec::new(),
        })
    }

    /// The same, who can tell these models apart. Feetech's two families answer in the same frame, and only their
    /// model numbers tell which one it is.
    #[must_use]
    pub fn knowing(mut self, profiles: &Profiles) -> Self {
        let models = profiles.servos().map(|servo| Model {
            protocol: servo.protocol,
            order: servo.word_order(),
            number: servo.model_number,
            torque: servo.role(Role::TorqueEnable).map(|row| row.address),
        });
        self.models = models.collect();
        self
    }

    /// The same, who speaks nothing but `protocol`.
    #[must_use]
    pub fn speaking(mut self, protocol: ServoProtocol) -> Self {
        self.protocols = vec![protocol];
        self
    }

    /// The bus again, if it came from one; it must be armed anew.
    pub fn into_bus(self) -> Option<Bus> {
        let mut bus = self.bus?;
        bus.line = self.line;
        Some(bus)
    }

    /// The line speed in use.
    pub fn baud(&self) -> u32 {
        self.line.baud()
    }

    /// Speaks at another line speed from now on; servos keep theirs.
    pub fn set_baud(&mut self, baud: u32) -> Result<(), MaintenanceError> {
        if baud != self.line.baud() {
            self.known.clear();
        }
        Ok(self.line.set_baud(baud)?)
    }

    /// What was heard beside answers so far.
    pub fn heard(&self) -> Overheard {
        let counters = self.line.counters();
        Overheard {
            echoes: counters.echoes,
            damaged: counters.rejected,
            stray_bytes: counters.skipped_bytes,
            timeouts: counters.timeouts,
            late: counters.stray_answers,
        }
    }

    /// Switches torque off, by broadcast where one byte means the same to everybody who may hear it, and one by one
    /// on servos that were found and have it elsewhere. Ask afterwards who has obeyed.
    pub fn release(&mut self, clock: &dyn Clock) -> Result<(), MaintenanceError> {
        let broadcasts = self.torque_for_all();
        for &(protocol, address) in &broadcasts {
            self.line.speak(protocol);
            framing::write(protocol, self.line.packet(), BROADCAST_ID, address, &[0])?;
            self.line.send(clock.now(), [], 0)?;
        }
        let reached = |known: &Known| {
            broadcasts.iter().any(|&(protocol, address)| {
                address == known.torque && is_stuffed(protocol) == is_stuffed(known.protocol)
            })
        };
        let others: Vec<Known> = self
            .known
            .iter()
            .filter(|known| !reached(known))
            .copied()
            .collect();
        for Known { id, protocol, torque } in others {
            let written = self.ask(protocol, id, 0, clock, &|out| {
                framing::write(protocol, out, id, torque, &[0])
            });
            // Who does not answer writes may have obeyed all the same.
            if !matches!(written, Err(MaintenanceError::Silent { .. })) {
                written?;
            }
        }
        self.released = true;
        Ok(())
    }

    /// Where 0 may be written by broadcast: it must be Torque Enable, or nothing, in every table that may be there.
    fn torque_for_all(&self) -> Vec<(ServoProtocol, u16)> {
        let mut all = Vec::new();
        if self.protocols.contains(&ServoProtocol::Dynamixel2) {
            all.push((ServoProtocol::Dynamixel2, TORQUE_OF_DYNAMIXEL2));
        }
        if self.protocols.iter().any(|&protocol| is_feetech(protocol)) {
            all.push((ServoProtocol::Sts, TORQUE_OF_FEETECH));
        } else if self.protocols.contains(&ServoProtocol::Dynamixel1) {
            all.push((ServoProtocol::Dynamixel1, TORQUE_OF_DYNAMIXEL1));
        }
        all
    }

    /// So many bytes from an address.
    pub fn read(
        &mut self,
        id: u8,
        address: u16,
        bytes: u16,
        clock: &dyn Clock,
    ) -> Result<Vec<u8>, MaintenanceError> {
        let protocol = self.protocol_of(id, clock)?;
        self.read_from(protocol, id, address, bytes, clock)
    }

    fn read_from(
        &mut self,
        protocol: ServoProtocol,
        id: u8,
        address: u16,
        bytes: u16,
        clock: &dyn Clock,
    ) -> Result<Vec<u8>, MaintenanceError> {
        self.ask(protocol, id, usize::from(bytes), clock, &|out| {
            framing::read(protocol, out, id, address, bytes)
        })
    }

    /// Asks until an answer of `data_bytes` comes, with silence between the tries.
    fn ask(
        &mut self,
        protocol: ServoProtocol,
        id: u8,
        data_bytes: usize,
        clock: &dyn Clock,
        build: &dyn Fn(&mut Vec<u8>) -> Result<(), FramingError>,
    ) -> Result<Vec<u8>, MaintenanceError> {
        for _ in 0..TRIES {
            if let Some(answer) = self.ask_once(protocol, id, data_bytes, clock, build)? {
                return answer;
            }
            self.hush(clock)?;
        }
        Err(self.silent(id))
    }

    /// None when nothing came.
    fn ask_once(
        &mut self,
        protocol: ServoProtocol,
        id: u8,
        data_bytes: usize,
        clock: &dyn Clock,
        build: &dyn Fn(&mut Vec<u8>) -> Result<(), FramingError>,
    ) -> Result<Option<Result<Vec<u8>, MaintenanceError>>, MaintenanceError> {
        self.line.speak(protocol);
        build(self.line.packet())?;
        self.line.send(clock.now(), [id], data_bytes)?;
        let mut answer = None;
        while let Some(deadline) = self.line.deadline() {
            let take = &mut |heard: super::line::Answer<'_>| {
                let refused =
                    !heard.whole || (heard.status.data.is_empty() && heard.status.error.is_refusal());
                answer = Some(if refused {
                    Err(MaintenanceError::Refused {
                        id,
                        error: heard.status.error,
                    })
                } else {
                    Ok(heard.status.data.to_vec())
                });
            };
            if self.line.poll(clock.now(), take)? == Progress::Waiting {
                self.wait(clock, deadline);
            }
        }
        Ok(answer)
    }

    /// Waits until the line has been silent for a while, so that no late answer meets the next question.
    fn hush(&mut self, clock: &dyn Clock) -> Result<(), MaintenanceError> {
        let begun = clock.now();
        loop {
            self.line.poll(clock.now(), &mut |_| {})?;
            let now = clock.now();
            let left = QUIET.saturating_sub(self.line.quiet_for(now).min(now.since(begun)));
            if left.is_zero() {
                return Ok(());
            }
            self.wait(clock, now.after(left));
        }
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.line.transport_mut().wait(clock, until);
    }

    fn silent(&self, id: u8) -> MaintenanceError {
        MaintenanceError::Silent {
            id,
            baud: self.line.baud(),
        }
    }
}

fn is_feetech(protocol: ServoProtocol) -> bool {
    matches!(protocol, ServoProtocol::Sts | ServoProtocol::Scs)
}

/// Whether a protocol has the frame of Dynamixel 2.0; the other three share one.
fn is_stuffed(protocol: ServoProtocol) -> bool {
    protocol == ServoProtocol::Dynamixel2
}

/// Stands in for the line while maintenance has it.
struct Nowhere;

impl Transport for Nowhere {
    fn boundary(&self) -> crate::transport::Boundary {
        crate::transport::Boundary::Stream
    }

    fn read(&mut self, _buffer: &mut [u8]) -> Result<usize, TransportError> {
        Err(Self::gone())
    }

    fn write(&mut self, _bytes: &[u8]) -> Result<(), TransportError> {
        Err(Self::gone())
    }
}

impl Nowhere {
    fn gone() -> TransportError {
        TransportError::Gone {
            address: "line in maintenance".to_owned(),
        }
    }
}
