//! A served bus of servos: which servos, on what wire, with which habits and faults.

use std::path::PathBuf;

use device_profiles::{ProfileError, Profiles};
use firmware_sim::servo_bus::{
    Absent, Adapter, AddError, BadCrc, BusOptions, Gaps, InnerHeader, PlantKind, Precedence, Unit, WireTime,
};
use firmware_sim::{Fault, ServoBus};

use super::eeprom::Eeprom;
use super::{ServeError, Served};

/// Line speed where a profile does not say which one servos come with.
const FALLBACK_BAUD: u32 = 57_600;

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
    #[error("\"{text}\": expected MODEL:ID or MODEL:ID-ID with ids from 0 to 253, such as XL430-W250:1-20")]
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
    /// A fault of a servo that is not there.
    #[error("fault `{fault}`: {why}")]
    Fault {
        /// As it was given.
        fault: String,
        /// Who is there.
        why: String,
    },
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
        let id = |text: &str| text.parse().ok().filter(|&id: &u8| id <= 253).ok_or_else(wrong);
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

/// What the makers' documents leave open, as this bus has it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Habits {
    /// What servos do behind one that does not answer its part of a group read.
    pub absent: Absent,
    /// What a servo does with a packet whose checksum is wrong.
    pub bad_crc: BadCrc,
    /// What a servo makes of an unstuffed header inside a packet.
    pub inner_header: InnerHeader,
    /// What a read of bytes that no register covers gives.
    pub gaps: Gaps,
    /// Which error is told when a write deserves several.
    pub precedence: Precedence,
}

/// What a served bus is made of.
#[derive(Clone, Debug)]
pub struct BusPlan {
    /// The servos, in the order of the chain.
    pub servos: Vec<ServoSpec>,
    /// Line speed of servos and host; none: each servo's as it comes, and the host's is that of the first.
    pub baud: Option<u32>,
    /// Whether bytes take time.
    pub wire: WireTime,
    /// Whether the host hears its own bytes.
    pub echo: bool,
    /// An adapter that hands bytes over in pieces.
    pub adapter: Option<Adapter>,
    /// What the documents leave open.
    pub habits: Habits,
    /// What shafts are moved by.
    pub shafts: PlantKind,
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
            baud: Some(1_000_000),
            wire: WireTime::Real,
            echo: false,
            adapter: None,
            habits: Habits::default(),
            shafts: PlantKind::default(),
            seed: 0,
            faults: Vec::new(),
            eeprom: None,
        }
    }

    /// The bus, ready to be served.
    pub fn build(&self, profiles: &Profiles) -> Result<Served, ServoSpecError> {
        let mut bauds = Vec::new();
        for spec in &self.servos {
            let as_it_comes = Unit::factory(profiles.servo(&spec.model)?).baud;
            bauds.push(self.baud.or(as_it_comes).unwrap_or(FALLBACK_BAUD));
        }
        let host_baud = bauds.first().copied().unwrap_or(FALLBACK_BAUD);
        let mut bus = ServoBus::new(BusOptions {
            baud: host_baud,
            wire: self.wire,
            echo: self.echo,
            adapter: self.adapter,
            absent: self.habits.absent,
            bad_crc: self.habits.bad_crc,
            inner_header: self.habits.inner_header,
            seed: self.seed,
        });
        for (spec, baud) in self.servos.iter().zip(bauds) {
            for id in spec.first..=spec.last {
                let unit = Unit {
                    baud: Some(baud),
                    gaps: self.habits.gaps,
                    plant: self.shafts,
                    precedence: self.habits.precedence,
                    ..Unit::new(id)
                };
                bus.add(profiles.servo(&spec.model)?, unit)?;
            }
        }
        let eeprom = match &self.eeprom {
            Some(folder) => Some(Eeprom::restore(folder, &mut bus)?),
            None => None,
        };
        for fault in &self.faults {
            if let Some(why) = bus.misfit(fault) {
                let fault = fault.to_string();
                return Err(ServoSpecError::Fault { fault, why });
            }
            bus.inject(0, fault);
        }
        Ok(Served::Bus(Box::new(bus), host_baud, eeprom))
    }
}
