//! The doctor's round: every line of a puppet, or a line alone, is looked at, judged, and where asked for mended.
//!
//! What can be wrong and how that is seen is `device::servo::doctor`; here are ports, puppets and the order of
//! things. Looking changes nothing. Mending switches torque off on the line first, as all writing of settings does.

use std::sync::Arc;

use device::clock::Clock;
use device::servo::doctor::{About, Expected, examine, judge};
use device::servo::maintenance::{Maintenance, MaintenanceError};
use device::transport::adapter::{Adapter, permission_rule};
use device::transport::{Address, TransportError};
use device_profiles::{ProfileError, Profiles, PuppetProfile, Role, ServoProfile};

pub use device::servo::doctor::{Finding, Fix, Kind};
pub use device::transport::adapter::{AdapterError, Adapters, ControlRequests, UsbRequests, Way};

use crate::ports::Ports;
pub use crate::ward::{Ward, WardError, wards};

/// The doctor cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum DoctorError {
    /// The line failed while it was looked at.
    #[error(transparent)]
    Line(#[from] TransportError),
    /// A servo did, or refused a change.
    #[error(transparent)]
    Servo(#[from] MaintenanceError),
    /// The adapter did.
    #[error(transparent)]
    Adapter(#[from] AdapterError),
    /// A profile is missing.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// Nothing to set there.
    #[error("{bus}: there is no {what} to set; look again with `dialrig servo doctor`")]
    Nothing {
        /// The bus.
        bus: String,
        /// What was to be set.
        what: String,
    },
    /// No such joint.
    #[error("there is no joint {joint}; the puppet has: {known}")]
    NoSuchJoint {
        /// As asked for.
        joint: String,
        /// All joints.
        known: String,
    },
    /// There is no such servo to adopt.
    #[error(
        "no servo as from the factory was found for joint {joint} ({model}); connect one, alone of its kind, and try again"
    )]
    NobodyToAdopt {
        /// The joint.
        joint: String,
        /// Its model.
        model: String,
    },
}

impl DoctorError {
    /// Whether line or servo are at fault, rather than what was asked for.
    pub fn is_of_device(&self) -> bool {
        matches!(self, Self::Line(_) | Self::Servo(_))
    }
}

/// Looks at lines of servos.
pub struct Doctor {
    ports: Box<dyn Ports>,
    clock: Arc<dyn Clock>,
    profiles: Arc<Profiles>,
    adapters: Adapters,
    puppet: Option<PuppetProfile>,
}

impl Doctor {
    /// A doctor for these ports; `adapters` is where USB adapters are found.
    pub fn new(
        ports: Box<dyn Ports>,
        clock: Arc<dyn Clock>,
        profiles: Arc<Profiles>,
        adapters: Adapters,
    ) -> Self {
        Self {
            ports,
            clock,
            profiles,
            adapters,
            puppet: None,
        }
    }

    /// The same, who knows which servos to expect: those of that puppet.
    pub fn of_puppet(mut self, name: &str) -> Result<Self, DoctorError> {
        self.puppet = Some(self.profiles.puppet(name)?.clone());
        Ok(self)
    }

    /// Looks at one line and says what is wrong. `tell` hears what is being done. A port that cannot be opened is a
    /// finding.
    pub fn examine(&mut self, ward: &Ward, tell: &mut dyn FnMut(&str)) -> Result<Vec<Finding>, DoctorError> {
        let expected = match &self.puppet {
            Some(puppet) => Expected::of(puppet, &ward.bus, &self.profiles)?,
            None => Expected::nobody(&self.profiles),
        };
        let adapter = self.adapter(ward);
        let timer_ms = adapter
            .as_ref()
            .and_then(|adapter| self.adapters.latency_ms(adapter))
            .map(|(ms, _)| ms);
        let mut line = match self.open(ward, ward.baud) {
            Ok(line) => line,
            Err(error) => return port_finding(ward, error, adapter.as_ref()).map(|found| vec![found]),
        };
        let about = About {
            bus: ward.bus.clone(),
            port: ward.address.clone(),
            baud: ward.baud,
            timer_ms,
        };
        let seen = examine(&mut line, &about, &expected, &*self.clock, tell)?;
        Ok(judge(&seen, &expected))
    }

    /// Mends one finding of that line. Gives what was done, in words.
    pub fn mend(&mut self, ward: &Ward, fix: Fix) -> Result<String, DoctorError> {
        match fix {
            Fix::LatencyTimer { ms } => {
                let adapter = self.adapter(ward).ok_or_else(|| DoctorError::Nothing {
                    bus: ward.bus.clone(),
                    what: fix.to_string(),
                })?;
                let way = match self.adapters.set_latency_ms(&adapter, ms)? {
                    Way::Sysfs => "the kernel's file",
                    Way::Request => "a request to the chip",
                };
                Ok(format!("{fix}, by {way}; until it is plugged in again"))
            }
            Fix::Register { id, role, value } => {
                let mut line = self.open(ward, ward.baud)?;
                let found = line.ping(id, &*self.clock)?;
                let (model, name) = self.row(found.model_number, found.firmware, role, ward)?;
                line.write_register(&model, id, &name, value, &*self.clock)?;
                Ok(fix.to_string())
            }
        }
    }

    /// Gives the servo that is as from the factory the id of the puppet's joint, and its bus's speed. `lines` are
    /// the puppet's.
    pub fn adopt(&mut self, lines: &[Ward], joint: &str) -> Result<String, DoctorError> {
        let wanted = self
            .puppet
            .as_ref()
            .and_then(|puppet| puppet.joint(joint))
            .cloned();
        let ward = lines
            .iter()
            .find(|ward| wanted.as_ref().is_some_and(|joint| joint.bus == ward.bus));
        let (Some(wanted), Some(ward)) = (wanted, ward) else {
            return Err(DoctorError::NoSuchJoint {
                joint: joint.to_owned(),
                known: self.joints(),
            });
        };
        let model = self.profiles.servo(&wanted.model)?.clone();
        let nobody = || DoctorError::NobodyToAdopt {
            joint: joint.to_owned(),
            model: model.name.clone(),
        };
        let factory = |role| model.role(role).and_then(|row| row.init);
        let fresh_id = factory(Role::Id)
            .and_then(|id| u8::try_from(id).ok())
            .unwrap_or(1);
        let fresh_baud = factory(Role::BaudRate)
            .and_then(|code| u8::try_from(code).ok())
            .and_then(|code| model.baud_of_code(code))
            .ok_or_else(nobody)?;
        let mut line = self.open(ward, fresh_baud)?;
        let clock = &*self.clock;
        let found = line.ping(fresh_id, clock).map_err(|_| nobody())?;
        if found.model_number != model.model_number {
            return Err(nobody());
        }
        let model = model.at_firmware(found.firmware).into_owned();
        line.set_id(&model, fresh_id, wanted.id, clock)?;
        line.set_servo_baud(&model, wanted.id, ward.baud, clock)?;
        Ok(format!(
            "{joint}: a {} has now id {} and {} baud",
            model.name, wanted.id, ward.baud
        ))
    }

    fn joints(&self) -> String {
        let names = self.puppet.iter().flat_map(PuppetProfile::joints);
        names
            .map(|joint| joint.name.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    }

    fn open(&mut self, ward: &Ward, baud: u32) -> Result<Maintenance, DoctorError> {
        let transport = self.ports.open(&ward.address, baud)?;
        Ok(Maintenance::new(transport, baud)?.knowing(&self.profiles))
    }

    fn row(
        &self,
        number: u16,
        firmware: u8,
        role: Role,
        ward: &Ward,
    ) -> Result<(ServoProfile, String), DoctorError> {
        let model = self
            .profiles
            .servo_by_model(number)
            .ok_or_else(|| DoctorError::Nothing {
                bus: ward.bus.clone(),
                what: format!("{role} of model number {number}"),
            })?
            .at_firmware(firmware)
            .into_owned();
        let name = name_of(&model, role, ward)?;
        Ok((model, name))
    }

    /// The USB adapter of a line, if it has one.
    fn adapter(&self, ward: &Ward) -> Option<Adapter> {
        match ward.address.parse().ok()? {
            Address::Path(path) => self.adapters.of_port(&path),
            Address::Usb(serial) => {
                let ports = device::transport::ports::list();
                let found = ports
                    .into_iter()
                    .find(|port| port.usb.as_ref().is_some_and(|usb| usb.serial == serial))?;
                self.adapters.of_port(&found.path)
            }
            Address::Tcp { .. } | Address::Osc(_) | Address::Midi(_) | Address::Sim(_) => None,
        }
    }
}

fn name_of(model: &ServoProfile, role: Role, ward: &Ward) -> Result<String, DoctorError> {
    let row = model.role(role).ok_or_else(|| DoctorError::Nothing {
        bus: ward.bus.clone(),
        what: format!("{role} of a {}", model.name),
    })?;
    Ok(row.name.clone())
}

/// What a port that cannot be opened is, if it is a finding.
fn port_finding(ward: &Ward, error: DoctorError, adapter: Option<&Adapter>) -> Result<Finding, DoctorError> {
    let of = |kind, error: &TransportError| Finding::of_bus(kind, &ward.bus, error.to_string());
    match &error {
        DoctorError::Line(why) => Ok(match why {
            TransportError::Forbidden { address, .. } => {
                let rule = adapter.map_or_else(|| permission_rule(None), Adapter::permission_rule);
                let what = format!("{address}: this user may not open it");
                Finding::of_bus(Kind::PortForbidden, &ward.bus, what).mended_by(format!(
                    "put this line into /etc/udev/rules.d/60-servo-adapter.rules and plug the adapter in again: {rule}; \
                     or `sudo usermod -aG dialout $USER` and log in again"
                ))
            }
            TransportError::Busy { address } => of(Kind::PortBusy, why)
                .mended_by(format!("close the other program: `fuser {address}` names it")),
            TransportError::NotFound { .. } | TransportError::Gone { .. } => of(Kind::PortMissing, why),
            TransportError::Address { .. }
            | TransportError::Unsupported { .. }
            | TransportError::Io { .. } => return Err(error),
        }),
        _ => Err(error),
    }
}
