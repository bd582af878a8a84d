//! Looking after servos without playing them: who is there, what their registers say, settings, letting go.
//!
//! Nothing here can move a servo; goals go through the player. Registers are named as the servo's profile names them,
//! or by their role, which is the same word for every make.

use std::sync::Arc;

use device::clock::Clock;
use device::servo::maintenance::{Found, Maintenance, MaintenanceError};
use device::servo::register::{Field, RegisterError};
use device::transport::TransportError;
use device_profiles::{Profiles, Register, ServoProfile};

pub use device::servo::framing::{Backup, Keep};
pub use device_profiles::{Role, ServoProtocol};

use crate::ports::Ports;

/// A servo that answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundServo {
    /// What it speaks.
    pub protocol: ServoProtocol,
    /// Line speed at which it answered.
    pub baud: u32,
    /// Its id.
    pub id: u8,
    /// Model Number register.
    pub model_number: u16,
    /// Name of its profile, if there is one.
    pub model: Option<String>,
    /// Firmware Version register.
    pub firmware: u8,
    /// It has the id and line speed of its factory: nobody has set it up yet.
    pub fresh: bool,
}

/// What was heard at one line speed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeardServos {
    /// The line speed.
    pub baud: u32,
    /// Who answered, by id.
    pub found: Vec<FoundServo>,
    /// Bytes came that made no packet: two servos with one id, or noise.
    pub garbled: bool,
}

/// One register's value.
#[derive(Clone, Debug, PartialEq)]
pub struct RegisterValue {
    /// Name in the servo's manual.
    pub name: String,
    /// What it is for, where that has a name.
    pub role: Option<Role>,
    /// Address in the control table.
    pub address: u16,
    /// As stored.
    pub raw: i64,
    /// In `unit`, where the register has one.
    pub value: Option<f64>,
    /// The unit.
    pub unit: String,
}

/// Something went wrong with a servo line.
#[derive(Debug, thiserror::Error)]
pub enum ServoLineError {
    /// The line failed.
    #[error(transparent)]
    Line(#[from] TransportError),
    /// The servo or its register did.
    #[error(transparent)]
    Servo(#[from] MaintenanceError),
    /// A model without a profile.
    #[error(
        "servo {id} ({protocol}) has model number {model_number}, for which there is no profile; add one to use its \
         registers by name"
    )]
    UnknownModel {
        /// The servo.
        id: u8,
        /// What it speaks.
        protocol: ServoProtocol,
        /// What it calls itself.
        model_number: u16,
    },
    /// The servo would go to a speed at which nothing can reach it.
    #[error(
        "{address} cannot change its speed from here, so servo {id} would be out of reach at another one; connect the \
         adapter to this computer for that"
    )]
    FixedSpeed {
        /// The line.
        address: String,
        /// The servo.
        id: u8,
    },
}

impl ServoLineError {
    /// Whether line or servo are at fault, rather than what was asked for.
    pub fn is_of_device(&self) -> bool {
        use MaintenanceError::{Framing, Goal, IdTaken, NoSuchBaud, OtherProtocol, Register};
        !matches!(
            self,
            Self::UnknownModel { .. }
                | Self::FixedSpeed { .. }
                | Self::Servo(
                    Register(_)
                        | Goal { .. }
                        | Framing(_)
                        | IdTaken { .. }
                        | NoSuchBaud { .. }
                        | OtherProtocol { .. }
                )
        )
    }
}

/// A line with servos on it.
pub struct ServoLine {
    line: Maintenance,
    clock: Arc<dyn Clock>,
    profiles: Arc<Profiles>,
    protocol: Option<ServoProtocol>,
    address: String,
}

impl ServoLine {
    /// Opens a line. Torque stays as it is. Without a protocol all are tried.
    pub fn open(
        ports: &mut dyn Ports,
        address: &str,
        baud: u32,
        protocol: Option<ServoProtocol>,
        clock: Arc<dyn Clock>,
        profiles: Arc<Profiles>,
    ) -> Result<Self, ServoLineError> {
        let line = Maintenance::new(ports.open(address, baud)?, baud)?.knowing(&profiles);
        let line = match protocol {
            Some(protocol) => line.speaking(protocol),
            None => line,
        };
        Ok(Self {
            line,
            clock,
            profiles,
            protocol,
            address: address.to_owned(),
        })
    }

    /// The line speed in use.
    pub fn baud(&self) -> u32 {
        self.line.baud()
    }

    /// Asks everybody who they are, at each of `bauds` in turn.
    pub fn scan(
        &mut self,
        bauds: &[u32],
        heard: &mut dyn FnMut(&HeardServos),
    ) -> Result<Vec<FoundServo>, ServoLineError> {
        let profiles = Arc::clone(&self.profiles);
        let mut all = Vec::new();
        self.line.scan(bauds, &*self.clock, &mut |here| {
            let found: Vec<_> = here.found.iter().map(|found| named(&profiles, *found)).collect();
            all.extend(found.iter().cloned());
            heard(&HeardServos {
                baud: here.baud,
                found,
                garbled: here.garbled,
            });
        })?;
        Ok(all)
    }

    /// The ids that two servos have: at this line speed their answers are nothing but garbage. Those in `found` answer
    /// well and are not asked. Takes some seconds.
    pub fn twice_used_ids(&mut self, baud: u32, found: &[FoundServo]) -> Result<Vec<u8>, ServoLineError> {
        let before = self.line.baud();
        self.line.set_baud(baud)?;
        let found: Vec<u8> = found
            .iter()
            .filter(|found| found.baud == baud)
            .map(|found| found.id)
            .collect();
        let ids = self.line.garbled_ids(&found, &*self.clock);
        self.line.set_baud(before)?;
        Ok(ids?)
    }

    /// Asks one servo who it is.
    pub fn ping(&mut self, id: u8) -> Result<FoundServo, ServoLineError> {
        let found = self.line.ping(id, &*self.clock)?;
        Ok(named(&self.profiles, found))
    }

    /// Reads one register by its name or role, or all of them.
    pub fn read(&mut self, id: u8, register: Option<&str>) -> Result<Vec<RegisterValue>, ServoLineError> {
        let servo = self.profile(id)?;
        if let Some(text) = register {
            let row = row(&servo, text)?;
            return Ok(vec![self.read_one(&servo, id, row)?]);
        }
        let rows = servo.registers.iter().filter(|row| row.count == 1);
        rows.map(|row| self.read_one(&servo, id, row)).collect()
    }

    /// Reads those of `roles` that the servo has.
    pub fn read_roles(&mut self, id: u8, roles: &[Role]) -> Result<Vec<RegisterValue>, ServoLineError> {
        let servo = self.profile(id)?;
        let rows = roles.iter().filter_map(|&role| servo.role(role));
        rows.map(|row| self.read_one(&servo, id, row)).collect()
    }

    fn read_one(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        row: &Register,
    ) -> Result<RegisterValue, ServoLineError> {
        let raw = self.line.read_register(servo, id, &row.name, &*self.clock)?;
        Ok(RegisterValue {
            name: row.name.clone(),
            role: row.role,
            address: row.address,
            raw,
            value: row.unit_per_count.map(|factor| raw as f64 * factor),
            unit: row.unit.map(|unit| unit.to_string()).unwrap_or_default(),
        })
    }

    /// Writes one register by its name or role, in counts, with torque off, and gives what it reads then. Registers
    /// that can move a servo are refused; an EEPROM register that holds the value already is not written.
    pub fn write(&mut self, id: u8, register: &str, raw: i64) -> Result<RegisterValue, ServoLineError> {
        let servo = self.profile(id)?;
        let row = row(&servo, register)?;
        if row.role == Some(Role::BaudRate) {
            self.can_follow(id)?;
        }
        self.line
            .write_register(&servo, id, &row.name, raw, &*self.clock)?;
        let id = match row.role {
            Some(Role::Id) => u8::try_from(raw).unwrap_or(id),
            _ => id,
        };
        self.read_one(&servo, id, row)
    }

    /// The same in the register's unit, to the nearest count.
    pub fn write_si(&mut self, id: u8, register: &str, value: f64) -> Result<RegisterValue, ServoLineError> {
        let servo = self.profile(id)?;
        let field = Field::of(&servo, row(&servo, register)?);
        self.write(id, register, field.raw(value))
    }

    /// Gives a servo another id; refused if it is in use.
    pub fn set_id(&mut self, id: u8, new: u8) -> Result<FoundServo, ServoLineError> {
        let servo = self.profile(id)?;
        self.line.set_id(&servo, id, new, &*self.clock)?;
        self.ping(new)
    }

    /// Makes a servo speak at another line speed, and follows it there.
    pub fn set_baud(&mut self, id: u8, baud: u32) -> Result<FoundServo, ServoLineError> {
        let servo = self.profile(id)?;
        self.can_follow(id)?;
        self.line.set_servo_baud(&servo, id, baud, &*self.clock)?;
        self.ping(id)
    }

    /// Restarts a servo and waits until it is back.
    pub fn reboot(&mut self, id: u8) -> Result<FoundServo, ServoLineError> {
        self.line.reboot(id, &*self.clock)?;
        self.ping(id)
    }

    /// Back to factory settings; says where the servo is then.
    pub fn factory_reset(&mut self, id: u8, keep: Keep) -> Result<FoundServo, ServoLineError> {
        let servo = self.profile(id)?;
        if keep != Keep::IdAndBaud {
            self.can_follow(id)?;
        }
        let found = self.line.factory_reset(&servo, id, keep, &*self.clock)?;
        Ok(named(&self.profiles, found))
    }

    /// Forgets the turns a servo has counted.
    pub fn clear(&mut self, id: u8) -> Result<(), ServoLineError> {
        Ok(self.line.clear(id, &*self.clock)?)
    }

    /// Keeps a copy of a servo's settings in the servo, or brings it back.
    pub fn backup(&mut self, id: u8, way: Backup) -> Result<(), ServoLineError> {
        Ok(self.line.backup(id, way, &*self.clock)?)
    }

    /// Whether the line can go to another speed with a servo. What is behind TCP has its speed set there.
    fn can_follow(&self, id: u8) -> Result<(), ServoLineError> {
        if self.address.starts_with("tcp:") {
            return Err(ServoLineError::FixedSpeed {
                address: self.address.clone(),
                id,
            });
        }
        Ok(())
    }

    fn profile(&mut self, id: u8) -> Result<ServoProfile, ServoLineError> {
        let found = self.line.ping(id, &*self.clock)?;
        match model(&self.profiles, &found) {
            Some(servo) => Ok(servo.at_firmware(found.firmware).into_owned()),
            None => Err(ServoLineError::UnknownModel {
                id,
                protocol: found.protocol,
                model_number: found.model_number,
            }),
        }
    }

    /// Switches torque off on every servo of the line: by broadcast, and one by one on those found where a broadcast
    /// would say something else to others.
    pub fn release(&mut self) -> Result<(), ServoLineError> {
        Ok(self.line.release(&*self.clock)?)
    }

    /// Whether torque is off on a servo.
    pub fn is_released(&mut self, id: u8) -> Result<bool, ServoLineError> {
        let torque = self.read_roles(id, &[Role::TorqueEnable])?;
        Ok(torque.iter().all(|torque| torque.raw == 0))
    }

    /// The line speeds a scan tries when none is given: every one that a servo of the protocols spoken can have.
    pub fn known_bauds(&self) -> Vec<u32> {
        let spoken = |servo: &&ServoProfile| self.protocol.is_none_or(|protocol| servo.protocol == protocol);
        let mut bauds: Vec<u32> = self
            .profiles
            .servos()
            .filter(spoken)
            .flat_map(|s| s.bauds.iter().copied())
            .collect();
        bauds.sort_unstable();
        bauds.dedup();
        bauds
    }
}

/// The row that a person means: by the maker's name, whatever its case, or by role.
fn row<'a>(servo: &'a ServoProfile, text: &str) -> Result<&'a Register, MaintenanceError> {
    let exact = servo.register(text);
    let alike = || {
        servo
            .registers
            .iter()
            .find(|row| row.name.eq_ignore_ascii_case(text))
    };
    let by_role = || {
        let is_it = |row: &&Register| row.role.is_some_and(|role| role.to_string() == text);
        servo.registers.iter().find(is_it)
    };
    exact.or_else(alike).or_else(by_role).ok_or_else(|| {
        MaintenanceError::Register(RegisterError::Unknown {
            model: servo.name.clone(),
            name: text.to_owned(),
            known: servo
                .registers
                .iter()
                .map(|row| row.name.as_str())
                .collect::<Vec<_>>()
                .join(", "),
        })
    })
}

/// Model numbers are each protocol's own.
fn model<'a>(profiles: &'a Profiles, found: &Found) -> Option<&'a ServoProfile> {
    let is_it =
        |servo: &&ServoProfile| servo.protocol == found.protocol && servo.model_number == found.model_number;
    profiles.servos().find(is_it)
}

fn named(profiles: &Profiles, found: Found) -> FoundServo {
    let model = model(profiles, &found);
    let factory = |role| model.and_then(|servo| servo.role(role)).and_then(|row| row.init);
    let baud = |code: i64| model.and_then(|servo| servo.baud_of_code(u8::try_from(code).ok()?));
    let fresh = factory(Role::Id) == Some(found.id.into())
        && factory(Role::BaudRate).and_then(baud) == Some(found.baud);
    FoundServo {
        protocol: found.protocol,
        baud: found.baud,
        id: found.id,
        model_number: found.model_number,
        model: model.map(|servo| servo.name.clone()),
        firmware: found.firmware,
        fresh,
    }
}
