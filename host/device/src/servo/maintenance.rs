//! Servos one by one, with torque off: scanning, addressing, reading and writing registers by name.
//!
//! It cannot move anything: goal registers, what may stand for them (Indirect Data) and torque are refused by
//! name. Waiting happens here, on the clock that is given.

use super::bus::{Bus, BusError};
use super::event::Armed;
use super::framing::dynamixel2::{self, BROADCAST_ID, ID_MAX, STATUS_OVERHEAD_BYTES};
use super::framing::{FramingError, StatusError};
use super::line::{Line, Progress};
use super::register::{Field, RegisterError, encode_checked};
use crate::clock::{Clock, Instant};
use crate::transport::{Transport, TransportError};
use device_profiles::ServoProfile;
use std::time::Duration;

/// Answer slack of the usual bus settings; nobody is in a hurry here.
const SLACK: Duration = Duration::from_millis(20);
/// Silence after a missing answer before the next question.
const QUIET: Duration = Duration::from_millis(40);
/// Tries of one question.
const TRIES: u8 = 3;
/// What each servo may take for its turn in answering a broadcast ping (the maker's SDK uses 3 ms).
const PING_TURN: Duration = Duration::from_millis(3);
/// Data bytes of a ping's answer: model number and firmware.
const PING_DATA_BYTES: usize = 3;
/// Address of Torque Enable in every X-series and MX(2.0) control table.
const TORQUE_ENABLE: u16 = 64;
/// A servo is back after a reboot within this time.
const REBOOT: Duration = Duration::from_millis(600);

/// Why maintenance could not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum MaintenanceError {
    /// The line failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// No such register, or no such value.
    #[error(transparent)]
    Register(#[from] RegisterError),
    /// Not an id.
    #[error(transparent)]
    Framing(#[from] FramingError),
    /// Writing it could move the servo.
    #[error(
        "register \"{name}\" can move the servo and is not written here: goals and torque go through the player \
         (`dialrig play`), which limits them"
    )]
    Goal {
        /// The row.
        name: String,
    },
    /// Nothing came back.
    #[error(
        "servo {id} does not answer at {baud} baud; check cable and power, or look for it with a scan over bauds"
    )]
    Silent {
        /// The id.
        id: u8,
        /// The line speed in use.
        baud: u32,
    },
    /// The servo says no.
    #[error("servo {id} refused: {error}")]
    Refused {
        /// The id.
        id: u8,
        /// Its error byte.
        error: StatusError,
    },
    /// It was written, but reads otherwise.
    #[error("servo {id}: \"{name}\" reads {found} after {wanted} was written; power the servo off and on")]
    NotTaken {
        /// The id.
        id: u8,
        /// The row.
        name: String,
        /// Written.
        wanted: i64,
        /// Read.
        found: i64,
    },
}

/// A servo that answered a ping.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Found {
    /// Line speed at which it answered.
    pub baud: u32,
    /// Its id.
    pub id: u8,
    /// Model Number.
    pub model_number: u16,
    /// Firmware Version.
    pub firmware: u8,
}

/// What was heard at one line speed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Heard {
    /// The line speed.
    pub baud: u32,
    /// Who answered, by id.
    pub found: Vec<Found>,
    /// Bytes came that made no packet: two servos with one id, or noise.
    pub garbled: bool,
}

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
}

/// A bus taken apart. Asking changes nothing; the first write switches torque off on the whole line.
pub struct Maintenance {
    line: Line,
    bus: Option<Bus>,
    released: bool,
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
        })
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
        Ok(self.line.set_baud(baud)?)
    }

    /// Switches torque off by broadcast: every servo obeys, none answers.
    pub fn release(&mut self, clock: &dyn Clock) -> Result<(), MaintenanceError> {
        dynamixel2::write(self.line.packet(), BROADCAST_ID, TORQUE_ENABLE, &[0])?;
        self.line.send(clock.now(), [], 0)?;
        self.released = true;
        Ok(())
    }

    /// What was heard beside answers so far.
    pub fn heard(&self) -> Overheard {
        let counters = self.line.counters();
        Overheard {
            echoes: counters.echoes,
            damaged: counters.rejected,
            stray_bytes: counters.skipped_bytes,
            timeouts: counters.timeouts,
        }
    }

    /// Asks one servo who it is.
    pub fn ping(&mut self, id: u8, clock: &dyn Clock) -> Result<Found, MaintenanceError> {
        let baud = self.line.baud();
        let data = self.ask(id, PING_DATA_BYTES, clock, &|out| dynamixel2::ping(out, id))?;
        found(baud, id, &data).ok_or(MaintenanceError::Silent { id, baud })
    }

    /// Asks everybody who they are, at each of `bauds` in turn, and says what was heard as it goes on.
    /// Takes about 0.8 s at 1 Mbaud. Afterwards the line is back at its speed.
    pub fn scan(
        &mut self,
        bauds: &[u32],
        clock: &dyn Clock,
        heard: &mut dyn FnMut(&Heard),
    ) -> Result<Vec<Found>, MaintenanceError> {
        let before = self.line.baud();
        let mut all = Vec::new();
        for &baud in bauds {
            self.line.set_baud(baud)?;
            let result = self.scan_here(clock);
            if result.is_err() {
                self.line.set_baud(before)?;
            }
            let here = result?;
            heard(&here);
            all.extend(here.found);
        }
        self.line.set_baud(before)?;
        Ok(all)
    }

    fn scan_here(&mut self, clock: &dyn Clock) -> Result<Heard, MaintenanceError> {
        self.hush(clock)?;
        let baud = self.line.baud();
        let rejected = self.line.counters().rejected;
        dynamixel2::ping(self.line.packet(), BROADCAST_ID)?;
        self.line.send(clock.now(), [], 0)?;
        let servos = u32::from(ID_MAX) + 1;
        let wire = self.line.wire_time(STATUS_OVERHEAD_BYTES + PING_DATA_BYTES);
        let until = clock.now().after((wire + PING_TURN) * servos + SLACK);
        let mut seen: Vec<Found> = Vec::new();
        while clock.now() < until {
            self.line.overhear(clock.now(), &mut |status| {
                let known = seen.iter().any(|seen| seen.id == status.id);
                if let Some(found) = found(baud, status.id, status.data).filter(|_| !known) {
                    seen.push(found);
                }
            })?;
            self.wait(clock, until);
        }
        seen.sort_by_key(|found| found.id);
        let garbled = self.line.counters().rejected > rejected;
        Ok(Heard {
            baud,
            found: seen,
            garbled,
        })
    }

    /// One register by its name in the servo's profile, in counts.
    pub fn read_register(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        name: &str,
        clock: &dyn Clock,
    ) -> Result<i64, MaintenanceError> {
        let field = Field::named(servo, name)?;
        let data = self.read(id, field.address, u16::from(field.size), clock)?;
        field.get(&data, field.address).ok_or(MaintenanceError::Silent {
            id,
            baud: self.line.baud(),
        })
    }

    /// So many bytes from an address.
    pub fn read(
        &mut self,
        id: u8,
        address: u16,
        bytes: u16,
        clock: &dyn Clock,
    ) -> Result<Vec<u8>, MaintenanceError> {
        self.ask(id, usize::from(bytes), clock, &|out| {
            dynamixel2::read(out, id, address, bytes)
        })
    }

    /// Writes one register by name, in counts, and reads it back. An EEPROM register that holds the value
    /// already is not written. "ID" and "Baud Rate" take effect at once and are not read back.
    pub fn write_register(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        name: &str,
        raw: i64,
        clock: &dyn Clock,
    ) -> Result<(), MaintenanceError> {
        let field = Field::named(servo, name)?;
        let moves = name.starts_with("Goal ") || name.starts_with("Indirect ");
        if moves || (name == "Torque Enable" && raw != 0) {
            return Err(MaintenanceError::Goal {
                name: name.to_owned(),
            });
        }
        let Some(row) = servo.register(name) else {
            return Ok(());
        };
        let bytes = encode_checked(servo, row, raw)?;
        if field.eeprom && self.read_register(servo, id, name, clock)? == raw {
            return Ok(());
        }
        if !self.released {
            self.release(clock)?;
        }
        self.ask(id, 0, clock, &|out| {
            dynamixel2::write(out, id, field.address, bytes.as_ref())
        })?;
        if name == "ID" || name == "Baud Rate" {
            return Ok(());
        }
        let found = self.read_register(servo, id, name, clock)?;
        if found == raw {
            Ok(())
        } else {
            Err(MaintenanceError::NotTaken {
                id,
                name: name.to_owned(),
                wanted: raw,
                found,
            })
        }
    }

    /// Restarts one servo, which ends a shutdown after a hardware error, and waits until it is back.
    pub fn reboot(&mut self, id: u8, clock: &dyn Clock) -> Result<(), MaintenanceError> {
        if !self.released {
            self.release(clock)?;
        }
        self.ask(id, 0, clock, &|out| dynamixel2::reboot(out, id))?;
        clock.sleep_until(clock.now().after(REBOOT));
        self.ping(id, clock).map(|_| ())
    }

    /// Asks until an answer of `data_bytes` comes, with silence between the tries.
    fn ask(
        &mut self,
        id: u8,
        data_bytes: usize,
        clock: &dyn Clock,
        build: &dyn Fn(&mut Vec<u8>) -> Result<(), FramingError>,
    ) -> Result<Vec<u8>, MaintenanceError> {
        for _ in 0..TRIES {
            build(self.line.packet())?;
            self.line.send(clock.now(), [id], data_bytes)?;
            let mut answer = None;
            while let Some(deadline) = self.line.deadline() {
                let take = &mut |heard: super::line::Answer<'_>| {
                    answer = Some((heard.status.error, heard.status.data.to_vec()));
                };
                if self.line.poll(clock.now(), take)? == Progress::Waiting {
                    self.wait(clock, deadline);
                }
            }
            match answer {
                Some((error, _)) if error.number() != 0 => {
                    return Err(MaintenanceError::Refused { id, error });
                }
                Some((_, data)) => return Ok(data),
                None => self.hush(clock)?,
            }
        }
        Err(MaintenanceError::Silent {
            id,
            baud: self.line.baud(),
        })
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
}

fn found(baud: u32, id: u8, data: &[u8]) -> Option<Found> {
    let &[low, high, firmware] = data else { return None };
    Some(Found {
        baud,
        id,
        model_number: u16::from_le_bytes([low, high]),
        firmware,
    })
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
