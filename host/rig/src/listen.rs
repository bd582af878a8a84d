//! Listening to one input device without a show: decoded events as they come.

use std::sync::Arc;
use std::time::Duration;

use device::clock::{Clock, Instant};
pub use device::codec::InputEvent;
use device::codec::Stamped;
use device::transport::TransportError;
use device::{Device, Health, UnknownFormat};
use device_profiles::Profiles;

use crate::inputs::known_profiles;
use crate::ports::Ports;
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

/// One input device and a clock.
pub struct Listener {
    device: Device,
    clock: Arc<dyn Clock>,
    began: Instant,
    events: Vec<Stamped<InputEvent>>,
}

impl Listener {
    /// Opens the device as its profile says.
    pub fn open(
        ports: &mut dyn Ports,
        address: &str,
        profile: &str,
        profiles: &Profiles,
        clock: Arc<dyn Clock>,
    ) -> Result<Self, ListenError> {
        let known = profiles.input(profile).map_err(|_| ListenError::Profile {
            profile: profile.to_owned(),
            known: known_profiles(profiles),
        })?;
        let device = Device::of_profile(address, known, ports.open_input(address, known.line.as_ref())?)?;
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
