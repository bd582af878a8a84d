//! The stand: simulated devices under names, on one clock, each behind its own cable.
//!
//! Whoever opens `sim:NAME` gets a transport like any other and cannot tell that the far end is a program.
//! Whoever holds the [`Stand`] can do what only somebody beside the bench can: turn, press, pull cables out,
//! bring in faults, and see where the shafts really are.

mod build;
mod horn;
mod ports;
mod seat;
mod surface;
mod transport;
mod truth;
mod usb;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use device::clock::Clock;
use firmware_sim::Fault;
use firmware_sim::hands::Touch;
use firmware_sim::servo_bus::FaultError;
use firmware_sim::usb_device::Shown as UsbShown;
use firmware_sim::{InputFault, InputFaultError};

pub use build::{Horn, PuppetPlan, StandBuilder, StandError};
pub use ports::SimPorts;
use seat::{Measures, Seat, Simulated};
pub use seat::{Shown, Traffic};
pub use surface::Surface;
pub use transport::SimTransport;
pub use truth::JointTruth;
use truth::Mount;
pub use usb::SimReports;
use usb::UsbSeat;

/// What every simulated device's address begins with.
pub const SCHEME: &str = "sim:";

/// A hand cannot do this.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HandError {
    /// There is no such device.
    #[error("there is no simulated device \"{name}\"; there are: {known}")]
    NoSuchDevice {
        /// The name asked for.
        name: String,
        /// All names.
        known: String,
    },
    /// The device has no such control.
    #[error("{name} has no {control}")]
    NoSuchControl {
        /// The device.
        name: String,
        /// The control, in words.
        control: String,
    },
    /// It is not a bus.
    #[error("{name} is not a servo bus; the buses are: {buses}")]
    NotABus {
        /// The device.
        name: String,
        /// All buses.
        buses: String,
    },
    /// A calibration does not go on.
    #[error("calibration: {why}")]
    Calibration {
        /// Why not.
        why: String,
    },
    /// There is no such joint.
    #[error("there is no joint \"{joint}\"; there are: {known}")]
    NoSuchJoint {
        /// The name asked for.
        joint: String,
        /// All joints.
        known: String,
    },
    /// The fault would strike nothing.
    #[error("fault \"{text}\" on {bus}: {why}")]
    Misfit {
        /// As given.
        text: String,
        /// The bus.
        bus: String,
        /// What is missing.
        why: String,
    },
    /// The text names no fault of input devices.
    #[error("fault: {source}")]
    InputFault {
        /// What is wrong with it.
        source: InputFaultError,
    },
    /// The text names no fault.
    #[error("fault \"{text}\": {source}")]
    Fault {
        /// As given.
        text: String,
        /// What is wrong with it.
        source: FaultError,
    },
}

/// The simulated bench. Clones are the same bench.
#[derive(Clone)]
pub struct Stand {
    clock: Arc<dyn Clock>,
    seats: Arc<BTreeMap<String, Arc<Mutex<Seat>>>>,
    usb: Arc<BTreeMap<String, Arc<Mutex<UsbSeat>>>>,
    mounts: Arc<Vec<Mount>>,
}

/// What a USB device was last made to show, in words; nothing where that is darkness.
fn usb_words(shown: &UsbShown) -> Option<String> {
    match *shown {
        UsbShown::Level(0) | UsbShown::Lamp(false) => None,
        UsbShown::Level(level) => Some(format!("level {level}")),
        UsbShown::Lamp(true) => Some("lamp".to_owned()),
        UsbShown::Pulse { awake, asleep, .. } => {
            (awake || asleep).then(|| format!("pulse{}", if awake { "" } else { " asleep" }))
        }
    }
}

pub(crate) fn lock<S>(seat: &Mutex<S>) -> MutexGuard<'_, S> {
    // A panic elsewhere leaves a device in some state of its own, which is what devices are in anyway.
    seat.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Stand {
    /// An empty bench to put devices on.
    pub fn builder(clock: Arc<dyn Clock>) -> StandBuilder {
        StandBuilder::new(clock)
    }

    /// Names of all devices, in alphabetical order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let all: BTreeSet<&str> = self
            .seats
            .keys()
            .chain(self.usb.keys())
            .map(String::as_str)
            .collect();
        all.into_iter()
    }

    /// The USB device of that name, with or without `sim:`.
    fn usb_seat(&self, name: &str) -> Option<MutexGuard<'_, UsbSeat>> {
        let bare = name.strip_prefix(SCHEME).unwrap_or(name);
        self.usb.get(bare).map(|seat| lock(seat))
    }

    /// The clock that all devices live on.
    pub fn clock(&self) -> &Arc<dyn Clock> {
        &self.clock
    }

    fn now_us(&self) -> u64 {
        self.clock.now().as_micros()
    }

    /// The device of that name, with or without `sim:`, brought up to now.
    fn seat(&self, name: &str) -> Result<MutexGuard<'_, Seat>, HandError> {
        let bare = name.strip_prefix(SCHEME).unwrap_or(name);
        let seat = self.seats.get(bare).ok_or_else(|| HandError::NoSuchDevice {
            name: bare.to_owned(),
            known: self.names().collect::<Vec<_>>().join(", "),
        })?;
        let mut seat = lock(seat);
        seat.advance(self.now_us());
        Ok(seat)
    }

    /// Lays a hand on a dial box or tablet, now.
    pub fn touch(&self, name: &str, touch: &Touch) -> Result<(), HandError> {
        let now_us = self.now_us();
        let done = match self.usb_seat(name) {
            Some(mut usb) => usb.touch(now_us, touch),
            None => self.seat(name)?.touch(now_us, touch),
        };
        if done {
            return Ok(());
        }
        let control = match touch {
            Touch::Dial { control, .. } => format!("dial {control}"),
            Touch::Button { control, .. } => format!("button {control}"),
            Touch::Axis { control, .. } => format!("axis {control}"),
            Touch::Ring { control, .. } => format!("ring {control}"),
            Touch::PowerCycle => "switch".to_owned(),
            Touch::Noise(_) => "plug to rattle at".to_owned(),
            Touch::Pen(_) | Touch::Puck(_) | Touch::Away | Touch::Lift(_) => "surface".to_owned(),
        };
        Err(HandError::NoSuchControl {
            name: name.to_owned(),
            control,
        })
    }

    /// Takes a device's cable out of the host (`false`) or puts it back. The device keeps its power.
    pub fn plug(&self, name: &str, connected: bool) -> Result<(), HandError> {
        let now_us = self.now_us();
        match self.usb_seat(name) {
            Some(mut usb) => usb.plug(now_us, connected),
            None => self.seat(name)?.plug(now_us, connected),
        }
        Ok(())
    }

    /// Whether the device's cable is in.
    pub fn is_plugged(&self, name: &str) -> Result<bool, HandError> {
        let now_us = self.now_us();
        match self.usb_seat(name) {
            Some(mut usb) => Ok(usb.is_connected(now_us)),
            None => Ok(self.seat(name)?.is_connected()),
        }
    }

    /// Takes the cable out when the port has been read or written `calls` more times: a way to fail at every
    /// step of a session in turn.
    pub fn unplug_after_calls(&self, name: &str, calls: u64) -> Result<(), HandError> {
        match self.usb_seat(name) {
            Some(mut usb) => usb.fail_after(calls),
            None => self.seat(name)?.fail_after(calls),
        }
        Ok(())
    }

    /// What a USB device was made to show so far, oldest first; nothing for other devices.
    pub fn shown_by_usb(&self, name: &str) -> Result<Vec<UsbShown>, HandError> {
        match self.usb_seat(name) {
            Some(mut usb) => Ok(usb.shown()),
            None => self.seat(name).map(|_| Vec::new()),
        }
    }

    /// Brings a fault onto an input device, named as in `docs/simulators.md`. A fault that names none is refused.
    pub fn input_fault(&self, name: &str, text: &str) -> Result<(), HandError> {
        let fault = InputFault::parse(text).map_err(|source| HandError::InputFault { source })?;
        let now_us = self.now_us();
        if let Some(mut usb) = self.usb_seat(name) {
            usb.inject(now_us, fault);
            return Ok(());
        }
        if self.seat(name)?.inject(now_us, fault) {
            return Ok(());
        }
        Err(HandError::NoSuchControl {
            name: name.to_owned(),
            control: "input device's cable".to_owned(),
        })
    }

    /// Whether a name is that of a bus.
    pub fn is_bus(&self, name: &str) -> bool {
        self.seat(name)
            .is_ok_and(|seat| matches!(seat.device, Simulated::Bus(_)))
    }

    /// Each thing that an input device shows now, in words: `lamp 3`, `label 2 TIME`, `ring 0 lamps 4 5`, `level 128`.
    pub fn shows(&self, name: &str) -> Result<Vec<String>, HandError> {
        match self.usb_seat(name) {
            Some(mut usb) => Ok(usb.shown().last().into_iter().filter_map(usb_words).collect()),
            None => Ok(self.seat(name)?.shown.words()),
        }
    }

    /// What a dial box shows; nothing for other devices.
    pub fn shown(&self, name: &str) -> Result<Shown, HandError> {
        Ok(self.seat(name)?.shown.clone())
    }

    fn measures(&self, name: &str) -> Result<Measures, HandError> {
        match self.usb_seat(name) {
            Some(usb) => Ok(usb.measures),
            None => Ok(self.seat(name)?.measures()),
        }
    }

    /// Counts in a turn of a device's dials; none for one without dials.
    pub fn counts_per_turn(&self, name: &str) -> Result<Option<u32>, HandError> {
        Ok(self.measures(name)?.counts_per_turn)
    }

    /// A tablet's active area; none for other devices.
    pub fn surface(&self, name: &str) -> Result<Option<Surface>, HandError> {
        Ok(self.measures(name)?.surface)
    }

    fn with_bus<T>(
        &self,
        name: &str,
        act: impl FnOnce(&mut firmware_sim::ServoBus, u64) -> T,
    ) -> Result<T, HandError> {
        let now_us = self.now_us();
        match &mut self.seat(name)?.device {
            Simulated::Bus(bus) => Ok(act(bus, now_us)),
            Simulated::Input(..) => Err(HandError::NotABus {
                name: name.to_owned(),
                buses: self.buses().collect::<Vec<_>>().join(", "),
            }),
        }
    }

    /// Names of the buses that have joints of the puppet, in alphabetical order.
    pub fn buses(&self) -> impl Iterator<Item = &str> {
        self.names()
            .filter(|name| self.mounts.iter().any(|mount| mount.bus == **name))
    }

    /// Brings a fault onto a bus, named as in `docs/simulator.md`; its times count from now.
    pub fn fault(&self, bus: &str, text: &str) -> Result<(), HandError> {
        let fault = Fault::parse(text).map_err(|source| HandError::Fault {
            text: text.to_owned(),
            source,
        })?;
        let misfit = self.with_bus(bus, |bus, now_us| match bus.misfit(&fault) {
            None => {
                bus.inject(now_us, &fault);
                None
            }
            misfit => misfit,
        })?;
        match misfit {
            None => Ok(()),
            Some(why) => Err(HandError::Misfit {
                text: text.to_owned(),
                bus: bus.to_owned(),
                why,
            }),
        }
    }

    /// Ends every fault of a bus.
    pub fn mend(&self, bus: &str) -> Result<(), HandError> {
        self.with_bus(bus, firmware_sim::ServoBus::mend)
    }

    fn mount(&self, joint: &str) -> Result<&Mount, HandError> {
        self.mounts
            .iter()
            .find(|mount| mount.joint == joint)
            .ok_or_else(|| HandError::NoSuchJoint {
                joint: joint.to_owned(),
                known: self
                    .mounts
                    .iter()
                    .map(|m| m.joint.as_str())
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }

    /// A hand turns a joint's horn by `rad`.
    pub fn push(&self, joint: &str, rad: f64) -> Result<(), HandError> {
        let mount = self.mount(joint)?;
        let by_rad = mount.shaft_rad(rad) - mount.shaft_rad(0.0);
        self.with_bus(&mount.bus, |bus, now_us| bus.push(now_us, mount.id, by_rad))?;
        Ok(())
    }

    /// Where every joint of the puppet really is, in the puppet's order.
    pub fn joints(&self) -> Vec<JointTruth> {
        let mut seen = Vec::with_capacity(self.mounts.len());
        let mut bus_name = "";
        let mut seat: Option<MutexGuard<'_, Seat>> = None;
        for mount in self.mounts.iter() {
            if mount.bus != bus_name || seat.is_none() {
                // One lock at a time: the old one goes before the new one is taken.
                drop(seat.take());
                seat = self.seat(&mount.bus).ok();
                bus_name = &mount.bus;
            }
            if let Some(Seat {
                device: Simulated::Bus(bus),
                ..
            }) = seat.as_deref()
                && let Some(servo) = bus.servo(mount.id)
            {
                seen.push(mount.truth(servo));
            }
        }
        seen
    }

    /// Where one joint really is.
    pub fn joint(&self, joint: &str) -> Result<JointTruth, HandError> {
        let mount = self.mount(joint)?;
        let truth = self.with_bus(&mount.bus, |bus, _| {
            bus.servo(mount.id).map(|servo| mount.truth(servo))
        })?;
        truth.ok_or_else(|| HandError::NoSuchJoint {
            joint: joint.to_owned(),
            known: String::new(),
        })
    }

    /// The joints whose bus is not simulated, as the rig sees them; speeds and torque are not known here.
    pub(crate) fn seen_joints(&self, puppet: &rig::PuppetView) -> Vec<JointTruth> {
        let real = self
            .mounts
            .iter()
            .filter(|mount| !self.seats.contains_key(&mount.bus));
        let seen = real.filter_map(|mount| {
            let view = puppet.joints.iter().find(|view| view.name == mount.joint)?;
            Some(mount.seen(view.measured_rad?, puppet.torque, view.present))
        });
        seen.collect()
    }

    /// Begins to note when the host writes to each bus.
    pub fn keep_traffic(&self) {
        for seat in self.seats.values() {
            lock(seat).keep_traffic();
        }
    }

    /// What went over a bus since the last call, up to now.
    pub fn take_traffic(&self, bus: &str) -> Result<Traffic, HandError> {
        let now_us = self.now_us();
        Ok(self.seat(bus)?.take_traffic(now_us))
    }
}

#[cfg(test)]
mod serial_tests;
#[cfg(test)]
mod tests;
