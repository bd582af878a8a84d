//! How transports come in: real ones from the binaries, simulated ones from the bench, recorded ones from a
//! journal. The rig cannot tell which.

use device::transport::{Transport, TransportError};

use crate::command::Touch;

/// Something that can be opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// Where to open it: a device path, `tcp:HOST:PORT`, `sim:NAME`.
    pub address: String,
    /// What is known about it, for people.
    pub description: String,
    /// Names of profiles that match.
    pub matches: Vec<String>,
    /// Whether it may be opened; if not, why and what to do.
    pub allowed: Result<(), String>,
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

    /// Lays a hand on a simulated device, which answers with bytes.
    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        let _ = touch;
        Err(TouchError::NotSimulated {
            address: address.to_owned(),
        })
    }
}
