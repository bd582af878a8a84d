//! Which joint sits on which bus. Joints are in the puppet profile's order everywhere in this crate.

use device::Transport;
use device::servo::{Bus, BusError, BusSettings, Member, MemberError};
use device_profiles::{Policy, ProfileError, Profiles, PuppetProfile, Role};
use std::time::Duration;

/// Why a puppet cannot be driven.
#[derive(Debug, thiserror::Error)]
pub enum PuppetError {
    /// A servo profile is missing.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A joint's numbers do not fit its servo.
    #[error(transparent)]
    Member(#[from] MemberError),
    /// A bus could not be set up.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// No such bus.
    #[error("puppet \"{puppet}\" has no bus \"{bus}\"; it has: {known}")]
    UnknownBus {
        /// The puppet.
        puppet: String,
        /// What was asked for.
        bus: String,
        /// What there is.
        known: String,
    },
    /// The buses given are not the puppet's.
    #[error("puppet \"{puppet}\" needs bus \"{bus}\" with its {joints} joints, in its own order")]
    WrongBus {
        /// The puppet.
        puppet: String,
        /// The bus.
        bus: String,
        /// Joints on it.
        joints: usize,
    },
}

/// One bus of a puppet, before it has a line.
#[derive(Debug, Clone)]
pub struct PuppetBus {
    /// What the puppet calls it.
    pub name: String,
    /// Line speed.
    pub baud: u32,
    /// Its servos.
    pub members: Vec<Member>,
}

/// Where a joint sits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seat {
    /// Place in the puppet's buses.
    pub bus: usize,
    /// Place in the bus's members.
    pub member: usize,
}

/// A puppet whose every joint has a seat.
#[derive(Debug, Clone)]
pub struct Puppet {
    name: String,
    joints: Vec<String>,
    seats: Vec<Seat>,
    buses: Vec<PuppetBus>,
    policy: Policy,
}

impl Puppet {
    /// Binds a puppet's joints to servo models. A bus without joints is left out.
    pub fn new(puppet: &PuppetProfile, profiles: &Profiles) -> Result<Self, PuppetError> {
        let mut bound = Self {
            name: puppet.name.clone(),
            joints: Vec::new(),
            seats: Vec::new(),
            buses: Vec::new(),
            policy: puppet.policy,
        };
        for joint in puppet.joints() {
            let member = Member::of_joint(joint, profiles.servo(&joint.model)?)?;
            let Some(line) = puppet.bus(&joint.bus) else {
                return Err(bound.unknown_bus(&joint.bus));
            };
            let bus = bound.bus_place(&line.name, line.baud);
            if let Some(there) = bound.buses.get_mut(bus) {
                bound.seats.push(Seat {
                    bus,
                    member: there.members.len(),
                });
                there.members.push(member);
            }
            bound.joints.push(joint.name.clone());
        }
        Ok(bound)
    }

    fn bus_place(&mut self, name: &str, baud: u32) -> usize {
        if let Some(at) = self.buses.iter().position(|bus| bus.name == name) {
            return at;
        }
        self.buses.push(PuppetBus {
            name: name.to_owned(),
            baud,
            members: Vec::new(),
        });
        self.buses.len().saturating_sub(1)
    }

    /// What it does about trouble.
    pub fn policy(&self) -> &Policy {
        &self.policy
    }

    /// The same puppet with another policy, as a show may choose.
    #[must_use]
    pub fn with_policy(mut self, policy: Policy) -> Self {
        self.policy = policy;
        self
    }

    /// Models that have no watchdog: when the program or the cable is lost they go to their last goal, one step
    /// away, and stand there.
    pub fn without_watchdog(&self) -> Vec<&str> {
        let members = self.buses.iter().flat_map(|bus| &bus.members);
        let servos = members.map(Member::servo);
        let mut models: Vec<&str> = servos
            .filter(|servo| servo.role(Role::BusWatchdog).is_none())
            .map(|servo| servo.name.as_str())
            .collect();
        models.sort_unstable();
        models.dedup();
        models
    }

    /// What people call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its joints, in the order of poses.
    pub fn joints(&self) -> &[String] {
        &self.joints
    }

    /// Where each joint sits.
    pub fn seats(&self) -> &[Seat] {
        &self.seats
    }

    /// Its buses; lines must be given in this order.
    pub fn buses(&self) -> &[PuppetBus] {
        &self.buses
    }

    /// The place of a joint in poses.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint == name)
    }

    /// Puts one of the puppet's buses on a line, with the usual settings and what the policy says of them.
    pub fn connect(&self, bus: &str, transport: Box<dyn Transport>) -> Result<Bus, PuppetError> {
        let Some(line) = self.buses.iter().find(|line| line.name == bus) else {
            return Err(self.unknown_bus(bus));
        };
        let settings = BusSettings {
            watchdog: Duration::from_millis(u64::from(self.policy.heartbeat_ms)),
            hot_c: self.policy.hot_c,
            ..BusSettings::new(&line.name, line.baud)
        };
        Ok(Bus::new(transport, line.members.clone(), settings)?)
    }

    /// Whether these buses are the puppet's, in order.
    pub(crate) fn check(&self, buses: &[Bus]) -> Result<(), PuppetError> {
        for (at, line) in self.buses.iter().enumerate() {
            let same = buses.get(at).is_some_and(|bus| {
                let there = bus.members().map(Member::joint);
                bus.name() == line.name && there.eq(line.members.iter().map(Member::joint))
            });
            if !same || buses.len() != self.buses.len() {
                let (puppet, bus) = (self.name.clone(), line.name.clone());
                return Err(PuppetError::WrongBus {
                    puppet,
                    bus,
                    joints: line.members.len(),
                });
            }
        }
        Ok(())
    }

    fn unknown_bus(&self, bus: &str) -> PuppetError {
        let known = self
            .buses
            .iter()
            .map(|bus| bus.name.as_str())
            .collect::<Vec<_>>()
            .join(", ");
        PuppetError::UnknownBus {
            puppet: self.name.clone(),
            bus: bus.to_owned(),
            known,
        }
    }
}
