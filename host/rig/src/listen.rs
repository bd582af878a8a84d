//! Listening to one input device without a show: decoded events as they come.

use std::sync::Arc;
use std::time::Duration;

use device::clock::{Clock, Instant};
use device::codec::{InputEvent, Stamped, Tool};
use device::transport::TransportError;
use device::{Device, Health, UnknownFormat};
use device_profiles::Profiles;

use crate::inputs::known_profiles;
use crate::ports::Ports;

/// Something a device said, in its own counts and numbering.
#[derive(Clone, Debug, PartialEq)]
pub struct Heard {
    /// Seconds since listening began.
    pub at_secs: f64,
    /// What.
    pub what: HeardEvent,
}

/// One event.
#[derive(Clone, Debug, PartialEq)]
pub enum HeardEvent {
    /// A tool on or over a tablet.
    Sample {
        /// `pen`, `eraser` or `puck`.
        tool: &'static str,
        /// Counts from the left edge.
        x: u16,
        /// Counts from the upper edge, downwards.
        y: u16,
        /// Counts; `None` for a puck.
        pressure: Option<u16>,
        /// Steps, x and y, where the tablet says.
        tilt: Option<[i8; 2]>,
        /// Clicks of a puck's wheel.
        wheel: i8,
        /// Whether the tool is in reach.
        in_range: bool,
        /// Whether the tip is down.
        tip: bool,
        /// Buttons, lowest bit first.
        buttons: u8,
    },
    /// A dial turned by so many counts.
    Dial {
        /// From 0.
        control: u8,
        /// Clockwise positive.
        delta: i32,
    },
    /// A button changed.
    Button {
        /// From 0.
        control: u8,
        /// Pressed.
        down: bool,
    },
    /// The device answered for the first time, with what it calls itself.
    Started(Option<String>),
    /// The device was switched off and on.
    Restarted,
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
        let device = Device::of_profile(address, known, ports.open(address, known.baud())?)?;
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
                what: self.heard(&event.what),
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

    fn heard(&self, event: &InputEvent) -> HeardEvent {
        match *event {
            InputEvent::Pen(sample) => HeardEvent::Sample {
                tool: match sample.tool {
                    Tool::Pen => "pen",
                    Tool::Eraser => "eraser",
                    Tool::Puck => "puck",
                },
                x: sample.x_counts,
                y: sample.y_counts,
                pressure: (sample.tool != Tool::Puck).then_some(sample.pressure_counts),
                tilt: sample.tilt,
                wheel: sample.wheel,
                in_range: sample.in_range,
                tip: sample.tip,
                buttons: sample.buttons,
            },
            InputEvent::Dial {
                control,
                delta_counts,
            } => HeardEvent::Dial {
                control,
                delta: delta_counts,
            },
            InputEvent::Button { control, down } => HeardEvent::Button { control, down },
            InputEvent::Started => HeardEvent::Started(self.device.identity().map(str::to_owned)),
            InputEvent::Restarted => HeardEvent::Restarted,
        }
    }
}
