//! Lines of servos that are looked after: which bus of which puppet is on which port, at which speed.

use device_profiles::{ProfileError, Profiles};

/// Line speed of servos nobody has set, where neither puppet nor person names one (X series, e-manual).
const FACTORY_BAUD: u32 = 57_600;

/// One line to look after.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ward {
    /// The bus as the puppet calls it, or the port.
    pub bus: String,
    /// Where it is.
    pub address: String,
    /// Its speed.
    pub baud: u32,
}

/// Ports and buses do not go together.
#[derive(Debug, thiserror::Error)]
pub enum WardError {
    /// No such puppet; the message lists what there is.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// More or fewer ports than buses.
    #[error("puppet {puppet} has {} buses ({}), but {given} ports were given; give one --port for each, in that order", buses.len(), buses.join(", "))]
    Count {
        /// The puppet.
        puppet: String,
        /// Its buses.
        buses: Vec<String>,
        /// Ports given.
        given: usize,
    },
}

/// One ward for each port: the puppet's buses in the profile's order, or lines on their own. `baud` overrides the
/// profile's.
pub fn wards(
    profiles: &Profiles,
    puppet: Option<&str>,
    ports: &[String],
    baud: Option<u32>,
) -> Result<Vec<Ward>, WardError> {
    let Some(puppet) = puppet else {
        let alone = ports.iter().map(|port| Ward {
            bus: port.clone(),
            address: port.clone(),
            baud: baud.unwrap_or(FACTORY_BAUD),
        });
        return Ok(alone.collect());
    };
    let profile = profiles.puppet(puppet)?;
    if profile.buses.len() != ports.len() {
        return Err(WardError::Count {
            puppet: profile.name.clone(),
            buses: profile.buses.iter().map(|bus| bus.name.clone()).collect(),
            given: ports.len(),
        });
    }
    let paired = profile.buses.iter().zip(ports).map(|(bus, port)| Ward {
        bus: bus.name.clone(),
        address: port.clone(),
        baud: baud.unwrap_or(bus.baud),
    });
    Ok(paired.collect())
}
