//! Looking after servos without playing them: who is there, what their registers say, letting go.
//!
//! Nothing here can move a servo; goals go through the player.

use std::sync::Arc;

use device::clock::Clock;
use device::servo::maintenance::{Maintenance, MaintenanceError};
use device::transport::TransportError;
use device_profiles::{Profiles, ServoProfile};

use crate::ports::Ports;

/// A servo that answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundServo {
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
        "servo {id} has model number {model_number}, for which there is no profile; add one to read it by name"
    )]
    UnknownModel {
        /// The servo.
        id: u8,
        /// What it calls itself.
        model_number: u16,
    },
}

impl ServoLineError {
    /// Whether line or servo are at fault, rather than what was asked for.
    pub fn is_of_device(&self) -> bool {
        use MaintenanceError::{Framing, Goal, Register};
        !matches!(
            self,
            Self::UnknownModel { .. } | Self::Servo(Register(_) | Goal { .. } | Framing(_))
        )
    }
}

/// A line with servos on it.
pub struct ServoLine {
    line: Maintenance,
    clock: Arc<dyn Clock>,
    profiles: Arc<Profiles>,
}

impl ServoLine {
    /// Opens a line. Torque stays as it is.
    pub fn open(
        ports: &mut dyn Ports,
        address: &str,
        baud: u32,
        clock: Arc<dyn Clock>,
        profiles: Arc<Profiles>,
    ) -> Result<Self, ServoLineError> {
        let line = Maintenance::new(ports.open(address, baud)?, baud)?;
        Ok(Self {
            line,
            clock,
            profiles,
        })
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

    /// Asks one servo who it is.
    pub fn ping(&mut self, id: u8) -> Result<FoundServo, ServoLineError> {
        let found = self.line.ping(id, &*self.clock)?;
        Ok(named(&self.profiles, found))
    }

    /// Reads one register by its name, or all of them.
    pub fn read(&mut self, id: u8, register: Option<&str>) -> Result<Vec<RegisterValue>, ServoLineError> {
        let servo = self.profile(id)?;
        let names: Vec<String> = match register {
            Some(name) => vec![name.to_owned()],
            None => servo
                .registers
                .iter()
                .filter(|r| r.count == 1)
                .map(|r| r.name.clone())
                .collect(),
        };
        names.iter().map(|name| self.read_one(&servo, id, name)).collect()
    }

    fn read_one(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        name: &str,
    ) -> Result<RegisterValue, ServoLineError> {
        let raw = self.line.read_register(servo, id, name, &*self.clock)?;
        let row = servo.register(name);
        let per_count = row.and_then(|r| r.unit_per_count);
        Ok(RegisterValue {
            name: row.map_or_else(|| name.to_owned(), |r| r.name.clone()),
            address: row.map_or(0, |r| r.address),
            raw,
            value: per_count.map(|factor| raw as f64 * factor),
            unit: row
                .and_then(|r| r.unit)
                .map(|unit| unit.to_string())
                .unwrap_or_default(),
        })
    }

    fn profile(&mut self, id: u8) -> Result<ServoProfile, ServoLineError> {
        let found = self.line.ping(id, &*self.clock)?;
        self.profiles
            .servo_by_model(found.model_number)
            .cloned()
            .ok_or(ServoLineError::UnknownModel {
                id,
                model_number: found.model_number,
            })
    }

    /// Switches torque off on every servo of the line.
    pub fn release(&mut self) -> Result<(), ServoLineError> {
        Ok(self.line.release(&*self.clock)?)
    }

    /// Whether torque is off on a servo.
    pub fn is_released(&mut self, id: u8) -> Result<bool, ServoLineError> {
        let servo = self.profile(id)?;
        Ok(self
            .line
            .read_register(&servo, id, "Torque Enable", &*self.clock)?
            == 0)
    }

    /// The line speeds a scan tries when none is given: every one a known servo can have.
    pub fn known_bauds(&self) -> Vec<u32> {
        let mut bauds: Vec<u32> = self
            .profiles
            .servos()
            .flat_map(|s| s.bauds.iter().copied())
            .collect();
        bauds.sort_unstable();
        bauds.dedup();
        bauds
    }
}

fn named(profiles: &Profiles, found: device::servo::maintenance::Found) -> FoundServo {
    FoundServo {
        baud: found.baud,
        id: found.id,
        model_number: found.model_number,
        model: profiles
            .servo_by_model(found.model_number)
            .map(|servo| servo.name.clone()),
        firmware: found.firmware,
    }
}
