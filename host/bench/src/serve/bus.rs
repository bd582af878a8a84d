//! A served bus of servos: which servos, on what wire, with which faults, and memories that outlive it.

use std::path::PathBuf;

use device_profiles::{ProfileError, Profiles};
use firmware_sim::servo_bus::{Adapter, AddError, BusOptions, Unit, WireTime};
use firmware_sim::{Fault, ServoBus};

use super::{ServeError, Served};

/// One model under several ids, as `MODEL:ID[-ID]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServoSpec {
    /// Name of a servo profile.
    pub model: String,
    /// First id.
    pub first: u8,
    /// Last id.
    pub last: u8,
}

/// Servos cannot be put on a bus as described.
#[derive(Debug, thiserror::Error)]
pub enum ServoSpecError {
    /// The text names no servos.
    #[error("\"{text}\": expected MODEL:ID or MODEL:ID-ID with ids from 0 to 252, such as XL430-W250:1-20")]
    Text {
        /// As given.
        text: String,
    },
    /// No such model; the message lists what there is.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// It does not fit the bus.
    #[error(transparent)]
    Add(#[from] AddError),
    /// Its memory cannot be brought back.
    #[error(transparent)]
    Eeprom(#[from] ServeError),
}

impl ServoSpec {
    /// Reads `MODEL:ID[-ID][,MODEL:ID[-ID]]…`.
    pub fn parse(text: &str) -> Result<Vec<Self>, ServoSpecError> {
        text.split(',').map(|one| Self::one(one.trim())).collect()
    }

    fn one(text: &str) -> Result<Self, ServoSpecError> {
        let wrong = || ServoSpecError::Text {
            text: text.to_owned(),
        };
        let (model, ids) = text
            .rsplit_once(':')
            .filter(|(model, _)| !model.is_empty())
            .ok_or_else(wrong)?;
        let (first, last) = ids.split_once('-').unwrap_or((ids, ids));
        let id = |text: &str| text.parse().ok().filter(|&id: &u8| id <= 252).ok_or_else(wrong);
        let (first, last) = (id(first)?, id(last)?);
        if first > last {
            return Err(wrong());
        }
        Ok(Self {
            model: model.to_owned(),
            first,
            last,
        })
    }
}

/// What a served bus is made of.
#[derive(Clone, Debug)]
pub struct BusPlan {
    /// The servos, in the order of the chain.
    pub servos: Vec<ServoSpec>,
    /// Line speed of servos and host.
    pub baud: u32,
    /// Whether bytes take time.
    pub wire: WireTime,
    /// Whether the host hears its own bytes.
    pub echo: bool,
    /// An adapter that hands bytes over in pieces.
    pub adapter: Option<Adapter>,
    /// Decides what random faults hit.
    pub seed: u64,
    /// What goes wrong; times count from the start.
    pub faults: Vec<Fault>,
    /// Folder in which servos' memories are kept.
    pub eeprom: Option<PathBuf>,
}

impl BusPlan {
    /// Flawless servos on a real wire at 1 Mbaud.
    pub fn new(servos: Vec<ServoSpec>) -> Self {
        Self {
            servos,
            baud: 1_000_000,
            wire: WireTime::Real,
            echo: false,
            adapter: None,
            seed: 0,
            faults: Vec::new(),
            eeprom: None,
        }
    }

    /// The bus, ready to be served.
    pub fn build(&self, profiles: &Profiles) -> Result<Served, ServoSpecError> {
        let mut bus = ServoBus::new(BusOptions {
            baud: self.baud,
            wire: self.wire,
            echo: self.echo,
            adapter: self.adapter,
            seed: self.seed,
            ..BusOptions::default()
        });
        for spec in &self.servos {
            for id in spec.first..=spec.last {
                bus.add(profiles.servo(&spec.model)?, Unit::new(id))?;
            }
        }
        let eeprom = match &self.eeprom {
            Some(folder) => Some(Eeprom::restore(folder.clone(), &mut bus)?),
            None => None,
        };
        for fault in &self.faults {
            bus.inject(0, fault);
        }
        Ok(Served::Bus(Box::new(bus), self.baud, eeprom))
    }
}

/// Servos' memories in a folder: one file a servo, the EEPROM's bytes from address 0.
#[derive(Debug)]
pub struct Eeprom {
    folder: PathBuf,
    /// Number of each servo when it was made, in the order of the chain; its file is named after it.
    ids: Vec<u8>,
    kept: Vec<Vec<u8>>,
}

impl Eeprom {
    /// Brings back what the folder holds. Servos without a file are as they come out of the box.
    fn restore(folder: PathBuf, bus: &mut ServoBus) -> Result<Self, ServeError> {
        std::fs::create_dir_all(&folder).map_err(|error| ServeError::io(folder.clone(), &error))?;
        let ids: Vec<u8> = bus
            .servos()
            .iter()
            .map(firmware_sim::servo_bus::Servo::id)
            .collect();
        let mut eeprom = Self {
            folder,
            ids,
            kept: Vec::new(),
        };
        let mut found = Vec::new();
        for &id in &eeprom.ids {
            let path = eeprom.path(id);
            match std::fs::read(&path) {
                Ok(bytes) => found.push((id, path, bytes)),
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
                Err(error) => return Err(ServeError::io(path, &error)),
            }
        }
        for (id, path, bytes) in found {
            if !bus
                .servo_mut(id)
                .is_some_and(|servo| servo.restore_eeprom(&bytes))
            {
                let why = format!(
                    "{} bytes are not the memory of servo {id}'s model; delete the file, or name the model it is of",
                    bytes.len()
                );
                return Err(ServeError::Eeprom { path, why });
            }
        }
        eeprom.kept = bus.servos().iter().map(|servo| servo.eeprom().to_vec()).collect();
        Ok(eeprom)
    }

    fn path(&self, id: u8) -> PathBuf {
        self.folder.join(format!("servo-{id}.eeprom"))
    }

    /// Writes the memories that have changed.
    pub(super) fn keep(&mut self, bus: &ServoBus) -> Result<(), ServeError> {
        for (place, servo) in bus.servos().iter().enumerate() {
            if self.kept[place] == servo.eeprom() {
                continue;
            }
            let path = self.path(self.ids[place]);
            std::fs::write(&path, servo.eeprom()).map_err(|error| ServeError::io(path, &error))?;
            self.kept[place] = servo.eeprom().to_vec();
        }
        Ok(())
    }
}
