//! Putting devices on the bench.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex};

use device::clock::Clock;
use device_profiles::{InputProfile, ProfileError, Profiles, PuppetJoint, PuppetProfile, ServoProfile};
use firmware_sim::servo_bus::{AddError, BusOptions, PlantKind, Sag, Unit};
use firmware_sim::{ServoBus, UsbKind, usb_kind};

use super::Stand;
use super::seat::{Measures, Seat, Simulated};
use super::truth::Mount;
use super::usb::UsbSeat;

/// Why a bench cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum StandError {
    /// A profile is missing; the message lists what there is.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A servo does not fit its bus.
    #[error("bus \"{bus}\": {source}")]
    Servo {
        /// The bus.
        bus: String,
        /// Why not.
        source: AddError,
    },
    /// Two devices of one name.
    #[error("two simulated devices are called \"{name}\"; names must differ")]
    Twice {
        /// The name.
        name: String,
    },
    /// No simulated firmware speaks the device's format.
    #[error("profile \"{profile}\" has format \"{format}\", of which nothing is simulated")]
    NotSimulated {
        /// The profile's key.
        profile: String,
        /// Its format.
        format: String,
    },
    /// A pose names a joint that is not there.
    #[error("the setting names joint \"{joint}\", which {puppet} does not have; it has: {known}")]
    NoSuchJoint {
        /// The joint named.
        joint: String,
        /// The puppet.
        puppet: String,
        /// Its joints.
        known: String,
    },
}

/// How a horn sits on its servo, against what the profile says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Horn {
    /// Turned by so much, radians of the shaft.
    pub off_rad: f64,
    /// The joint turns the other way.
    pub reversed: bool,
}

/// How a simulated puppet begins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PuppetPlan {
    /// Where joints are at first, radians; those not named are at 0.
    pub start_rad: BTreeMap<String, f64>,
    /// How fast joints without torque sink back to where they began; none: they stay where they are let go.
    pub sag_rad_per_s: Option<f64>,
    /// What shafts are moved by.
    pub plant: PlantKind,
    /// Where joints meet their ends, radians; those not named turn freely.
    pub stops_rad: BTreeMap<String, [f64; 2]>,
    /// Horns that do not sit as the profile says.
    pub horns: BTreeMap<String, Horn>,
    /// Decides what random faults hit.
    pub seed: u64,
    /// Buses that are real: their servos are not simulated.
    pub real_buses: BTreeSet<String>,
}

impl PuppetPlan {
    fn mount(&self, joint: &PuppetJoint, servo: &ServoProfile) -> Mount {
        let horn = self.horns.get(&joint.name).copied().unwrap_or_default();
        Mount::new(joint, servo).with_horn(horn)
    }
}

/// A bench being set up.
pub struct StandBuilder {
    clock: Arc<dyn Clock>,
    seats: BTreeMap<String, Arc<Mutex<Seat>>>,
    usb: BTreeMap<String, Arc<Mutex<UsbSeat>>>,
    mounts: Vec<Mount>,
}

impl StandBuilder {
    pub(super) fn new(clock: Arc<dyn Clock>) -> Self {
        Self {
            clock,
            seats: BTreeMap::new(),
            usb: BTreeMap::new(),
            mounts: Vec::new(),
        }
    }

    /// Adds the input device that `profile` describes as `sim:NAME`.
    pub fn input(self, name: &str, profile: &InputProfile) -> Result<Self, StandError> {
        if let Some(kind) = usb_kind(&profile.key) {
            return self.usb(name, profile, kind);
        }
        let device = firmware_sim::serial_device(profile).ok_or_else(|| StandError::NotSimulated {
            profile: profile.key.clone(),
            format: profile.format.clone(),
        })?;
        let device = Simulated::Input(device, Measures::from(profile));
        self.seat(name, &profile.name, vec![profile.key.clone()], device)
    }

    /// Adds an input device of this kind as `sim:NAME`: one of [`firmware_sim::USB_KINDS`], or what a profile describes.
    pub fn kind(self, name: &str, kind: &str, profiles: &Profiles) -> Result<Self, StandError> {
        match usb_kind(kind) {
            Some(kind) => self.usb(name, profiles.input(kind.profile)?, kind),
            None => self.input(name, profiles.input(kind)?),
        }
    }

    fn usb(mut self, name: &str, profile: &InputProfile, kind: &UsbKind) -> Result<Self, StandError> {
        let seat = UsbSeat::new(name, profile, (kind.make)());
        let before = self.usb.insert(name.to_owned(), Arc::new(Mutex::new(seat)));
        if before.is_some() || self.seats.contains_key(name) {
            return Err(StandError::Twice {
                name: name.to_owned(),
            });
        }
        Ok(self)
    }

    /// Adds one bus of servos for each bus of the puppet, as `sim:BUS`.
    pub fn puppet(
        mut self,
        puppet: &PuppetProfile,
        profiles: &Profiles,
        plan: &PuppetPlan,
    ) -> Result<Self, StandError> {
        let named = plan.start_rad.keys().chain(plan.stops_rad.keys());
        let named = named.chain(plan.horns.keys());
        if let Some(joint) = named.into_iter().find(|joint| puppet.joint(joint).is_none()) {
            return Err(StandError::NoSuchJoint {
                joint: joint.clone(),
                puppet: puppet.name.clone(),
                known: puppet
                    .joints()
                    .map(|j| j.name.as_str())
                    .collect::<Vec<_>>()
                    .join(", "),
            });
        }
        for line in puppet
            .buses
            .iter()
            .filter(|line| !plan.real_buses.contains(&line.name))
        {
            let options = BusOptions {
                baud: line.baud,
                seed: plan.seed,
                ..BusOptions::default()
            };
            let mut bus = ServoBus::new(options);
            for joint in puppet.joints_on(&line.name) {
                let servo = profiles.servo(&joint.model)?;
                let mount = plan.mount(joint, servo);
                let start_rad = mount.shaft_rad(plan.start_rad.get(&joint.name).copied().unwrap_or(0.0));
                let stops_rad = plan.stops_rad.get(&joint.name).map(|stops| {
                    let [a, b] = stops.map(|rad| mount.shaft_rad(rad));
                    [a.min(b), a.max(b)]
                });
                let unit = Unit {
                    start_rad,
                    plant: plan.plant,
                    stops_rad,
                    ..Unit::new(joint.id)
                };
                let added = bus.add(servo, unit);
                added.map_err(|source| StandError::Servo {
                    bus: line.name.clone(),
                    source,
                })?;
                let sag = plan.sag_rad_per_s.map(|rad_per_s| Sag {
                    to_rad: start_rad,
                    rad_per_s,
                });
                bus.set_sag(0, joint.id, sag);
            }
            let words = format!("{}, bus {}", puppet.name, line.name);
            self = self.seat(
                &line.name,
                &words,
                vec![puppet.key.clone()],
                Simulated::Bus(Box::new(bus)),
            )?;
        }
        for joint in puppet.joints() {
            self.mounts.push(plan.mount(joint, profiles.servo(&joint.model)?));
        }
        Ok(self)
    }

    /// Adds a bus of servos that belong to no puppet, as `sim:NAME`.
    pub fn servo_bus(self, name: &str, bus: ServoBus) -> Result<Self, StandError> {
        let models = format!("{} servos", bus.servos().len());
        self.seat(name, &models, Vec::new(), Simulated::Bus(Box::new(bus)))
    }

    fn seat(
        mut self,
        name: &str,
        what: &str,
        matches: Vec<String>,
        device: Simulated,
    ) -> Result<Self, StandError> {
        let seat = Seat::new(name, format!("simulated: {what}"), matches, device);
        match self.seats.insert(name.to_owned(), Arc::new(Mutex::new(seat))) {
            None if !self.usb.contains_key(name) => Ok(self),
            _ => Err(StandError::Twice {
                name: name.to_owned(),
            }),
        }
    }

    /// The bench, ready.
    pub fn build(self) -> Stand {
        Stand {
            clock: self.clock,
            seats: Arc::new(self.seats),
            usb: Arc::new(self.usb),
            mounts: Arc::new(self.mounts),
        }
    }
}
