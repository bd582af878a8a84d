//! How transports come in: real ones from the binaries, simulated ones from the bench, recorded ones from a
//! journal. The rig cannot tell which.

use device::transport::{Transport, TransportError};
use device_profiles::Line;
use serde::{Deserialize, Serialize};

use crate::command::Touch;

/// Something that can be opened.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Found {
    /// Where to open it: a device path, `tcp:HOST:PORT`, `sim:NAME`.
    pub address: String,
    /// What is known about it, for people.
    pub description: String,
    /// Names of profiles that match.
    pub matches: Vec<String>,
    /// Why none of the profiles is taken by itself, where none is.
    pub why: Option<String>,
    /// Whether it may be opened; if not, why and what to do.
    pub allowed: Result<(), String>,
    /// Who has it already, and what to do about it.
    pub held: Option<Held>,
    /// What it is taken as without being asked for; none for what must be named.
    pub plug: Option<Plug>,
}

/// Somebody who has a device already.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Held {
    /// The driver or program.
    pub driver: String,
    /// What it does, and what to do about it.
    pub remedy: String,
}

/// A device that is known and told apart from its equals.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Plug {
    /// What it is called unless it is called otherwise: the profile's key, `hid-VENDOR-PRODUCT` without one.
    pub name: String,
    /// Key of its profile; none where only its own description says what it is.
    pub profile: Option<String>,
    /// Which of several equal ones it is, from 1.
    pub slot: u16,
    /// Its line's speed, 0 where it has no line.
    pub baud: u32,
    /// By what it is known again wherever it is plugged in; empty in journals of before there was one.
    #[serde(default)]
    pub identity: String,
}

impl Default for Found {
    fn default() -> Self {
        Self {
            address: String::new(),
            description: String::new(),
            matches: Vec::new(),
            why: None,
            allowed: Ok(()),
            held: None,
            plug: None,
        }
    }
}

/// A hand cannot touch this device.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TouchError {
    /// Only simulated devices have hands on the screen.
    #[error("{address} is not a simulated device: turn the real control instead")]
    NotSimulated {
        /// The device touched.
        address: String,
    },
    /// The device has no such control.
    #[error("{address} has no {control}")]
    NoSuchControl {
        /// The device touched.
        address: String,
        /// The control asked for, in words.
        control: String,
    },
}

/// The place transports come from.
pub trait Ports: Send {
    /// What is there now, in a fixed order.
    fn list(&mut self) -> Vec<Found>;

    /// Opens a port. `baud` is ignored where there is no line.
    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError>;

    /// Opens an input device with the line of its profile, where it has one.
    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        self.open(address, line.map_or(0, |line| line.baud))
    }

    /// The same for a device that the rig calls `device`, wherever that is now: for whoever keeps something of each.
    fn open_device(
        &mut self,
        device: &str,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let _ = device;
        self.open_input(address, line)
    }

    /// Keeps what is at `address` at its place among equal devices, or no longer. An error in words.
    fn pin(&mut self, address: &str, slot: Option<u16>) -> Result<(), String> {
        let _ = slot;
        Err(format!(
            "{address} is not told apart from equal devices: it was named by its address, which is its place"
        ))
    }

    /// Lays a hand on a simulated device, which answers with bytes.
    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        let _ = touch;
        Err(TouchError::NotSimulated {
            address: address.to_owned(),
        })
    }
}
