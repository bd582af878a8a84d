//! Listening to one input device without a show: decoded events as they come.

use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use device::clock::{Clock, Instant};
pub use device::codec::InputEvent;
use device::codec::Stamped;
use device::transport::TransportError;
use device::{Device, Health, UnknownFormat};
use device_profiles::Profiles;

use crate::inputs::known_profiles;
use crate::ports::{Found, Ports};
use crate::telling::{Buttons, Teller};

/// Something a device said, in its own counts and numbering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heard {
    /// Seconds since listening began.
    pub at_secs: f64,
    /// What.
    pub what: InputEvent,
}

/// A device cannot be listened to.
#[derive(Debug, thiserror::Error)]
pub enum ListenError {
    /// No such profile.
    #[error("there is no profile \"{profile}\" of a dial box or tablet; there are: {known}")]
    Profile {
        /// What was asked for.
        profile: String,
        /// What there is.
        known: String,
    },
    /// Nothing says what it is.
    #[error("{address}: {why}; name its profile with --profile; there are: {known}")]
    Unknown {
        /// Where it is.
        address: String,
        /// Why it is not known.
        why: String,
        /// What there is.
        known: String,
    },
    /// It has no profile, and its own description is of no use.
    #[error("{address}: {why}")]
    Undescribed {
        /// Where it is.
        address: String,
        /// What is wrong with its description.
        why: String,
    },
    /// The profile's format is not known here.
    #[error(transparent)]
    Format(#[from] UnknownFormat),
    /// The line failed.
    #[error(transparent)]
    Line(#[from] TransportError),
    /// The line was there and is gone.
    #[error("{0}")]
    Gone(String),
}

/// What a line is taken for that says nothing of what hangs on it: what most such lines had.
pub const ON_A_LINE: &str = "sgi-dialbox";

/// The profile of what is at `address`; none for what describes itself.
fn recognise(
    ports: &mut dyn Ports,
    address: &str,
    profiles: &Profiles,
) -> Result<Option<String>, ListenError> {
    // A link of the user's own names what it leads to.
    let real = std::fs::canonicalize(address).ok();
    let is_it =
        |found: &Found| found.address == address || real.as_deref() == Some(Path::new(&found.address));
    let Some(found) = ports.list().into_iter().find(is_it) else {
        let name = real.as_deref().and_then(Path::file_name).and_then(OsStr::to_str);
        // Every HID device describes itself, on whichever bus it is.
        let describes_itself = name.is_some_and(|name| name.starts_with("hidraw"));
        return Ok((!describes_itself).then(|| ON_A_LINE.to_owned()));
    };
    match found.plug {
        Some(plug) => Ok(plug.profile),
        None if found.matches.iter().any(|key| key == ON_A_LINE) => Ok(Some(ON_A_LINE.to_owned())),
        // What is simulated is what it was made as.
        None if address.starts_with("sim:") && found.matches.len() == 1 => Ok(found.matches.first().cloned()),
        None => Err(ListenError::Unknown {
            address: address.to_owned(),
            why: found.why.unwrap_or_else(|| "nothing says what it is".to_owned()),
            known: if found.matches.is_empty() {
                known_profiles(profiles)
            } else {
                found.matches.join(", ")
            },
        }),
    }
}

/// One input device and a clock.
pub struct Listener {
    device: Device,
    clock: Arc<dyn Clock>,
    began: Instant,
    events: Vec<Stamped<InputEvent>>,
}

impl Listener {
    /// Opens the device as its profile says. Without a profile it is what it is recognised as; a line that says nothing
    /// of what hangs on it is taken for [`ON_A_LINE`].
    pub fn open(
        ports: &mut dyn Ports,
        address: &str,
        profile: Option<&str>,
        profiles: &Profiles,
        clock: Arc<dyn Clock>,
    ) -> Result<Self, ListenError> {
        let recognised = match profile {
            Some(key) => Some(key.to_owned()),
            None => recognise(ports, address, profiles)?,
        };
        let device = if let Some(key) = recognised {
            let known = profiles.input(&key).map_err(|_| ListenError::Profile {
                profile: key.clone(),
                known: known_profiles(profiles),
            })?;
            Device::of_profile(address, known, ports.open_input(address, known.line.as_ref())?)?
        } else {
            let line = ports.open_input(address, None)?;
            let (device, _) = Device::generic(address, line).map_err(|why| ListenError::Undescribed {
                address: address.to_owned(),
                why,
            })?;
            device
        };
        let began = clock.now();
        Ok(Self {
            device,
            clock,
            began,
            events: Vec::new(),
        })
    }

    /// Waits at most `patience` for something, and hands over what came.
    pub fn next(&mut self, patience: Duration, hear: &mut dyn FnMut(Heard)) -> Result<(), ListenError> {
        let now = self.clock.now();
        self.device.wait(&*self.clock, now.after(patience));
        let now = self.clock.now();
        self.events.clear();
        let health = self.device.poll(now, &mut self.events);
        for event in &self.events {
            let at_secs = event.at.since(self.began).as_secs_f64();
            hear(Heard {
                at_secs,
                what: event.what,
            });
        }
        if health == Health::Lost {
            let why = self
                .device
                .lost()
                .map(TransportError::to_string)
                .unwrap_or_default();
            return Err(ListenError::Gone(why));
        }
        Ok(())
    }

    /// Reports, unknown bytes and rejected reports so far.
    pub fn counted(&self) -> [u64; 3] {
        let counters = self.device.counters();
        [counters.reports, counters.unknown, counters.rejected]
    }

    /// Key of the profile it is heard by; empty where it is heard by its own description.
    pub fn profile(&self) -> &str {
        self.device.profile()
    }

    /// What the device calls itself, once it has said so.
    pub fn identity(&self) -> Option<&str> {
        self.device.identity()
    }

    /// How its events are named.
    pub fn teller(&self) -> Teller {
        Teller::new(if self.device.surface().is_some() {
            Buttons::Keys
        } else {
            Buttons::Numbered
        })
    }
}
