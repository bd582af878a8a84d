//! The ports and the time of this machine, and the ports of a bench beside them.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use device::clock::{Clock, MonotonicClock};
use device::discovery::{self, Places, Strings};
use device::transport::merged::Merged;
use device::transport::{self, Address, Transport, TransportError, ports};
use device_profiles::{InputProfile, Line, Profiles};

use crate::command::Touch;
use crate::identities::{Identities, Unit};
use crate::lines::Lines;
use crate::ports::{Found, Plug, Ports, TouchError};
use crate::survey::{self, Lookout, Surveyed};

/// This machine's monotonic time, beginning now.
pub fn real_time() -> Arc<dyn Clock> {
    Arc::new(MonotonicClock::new())
}

/// Input devices, serial ports, pseudo-terminals and sockets of this machine.
pub struct SystemPorts {
    clock: Arc<dyn Clock>,
    places: Places,
    known: Option<Known>,
}

/// What it takes to know what is plugged in.
struct Known {
    profiles: Arc<Profiles>,
    identities: Identities,
    lines: Lines,
    strings: Strings,
    lookout: Option<Lookout>,
    /// The other interfaces of the device at an address.
    beside: BTreeMap<String, Vec<String>>,
    /// What is at an address, as it is told apart from its equals.
    units: BTreeMap<String, Unit>,
}

impl Default for SystemPorts {
    /// Ports that nobody knows anything of: what a program needs that opens what it is told to.
    fn default() -> Self {
        Self {
            clock: real_time(),
            places: Places::default(),
            known: None,
        }
    }
}

impl SystemPorts {
    /// Ports whose arrivals are noted by `clock`, and which know from `profiles` what is plugged in. Which of several
    /// equal devices is which is remembered in `folder`.
    pub fn knowing(clock: Arc<dyn Clock>, profiles: Arc<Profiles>, folder: Option<&Path>) -> Self {
        Self {
            clock,
            places: Places::default(),
            known: Some(Known {
                profiles,
                identities: Identities::load(folder),
                lines: Lines::load(folder),
                strings: Strings::new(),
                lookout: None,
                beside: BTreeMap::new(),
                units: BTreeMap::new(),
            }),
        }
    }

    /// The same, and who is at serial ports that were asked is remembered in `folder`.
    #[must_use]
    pub fn with_lines(mut self, folder: Option<&Path>) -> Self {
        if let Some(known) = &mut self.known {
            known.lines = Lines::load(folder);
        }
        self
    }

    /// The same, looking again and again by a thread of its own, so that listing never waits for a device.
    pub fn watching(mut self) -> std::io::Result<Self> {
        if let Some(known) = &mut self.known {
            let profiles = Arc::clone(&known.profiles);
            known.lookout = Some(Lookout::start(
                self.places.clone(),
                profiles,
                Arc::clone(&self.clock),
            )?);
        }
        Ok(self)
    }
}

impl Ports for SystemPorts {
    fn list(&mut self) -> Vec<Found> {
        match &mut self.known {
            Some(known) => known.list(&self.places),
            None => ports::list().into_iter().map(unknown).collect(),
        }
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        transport::open(&address.parse::<Address>()?, baud)
    }

    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let open = |address: &str| discovery::open(&self.places, &address.parse()?, line, &self.clock);
        let beside = self.known.as_ref().and_then(|known| known.beside.get(address));
        let Some(beside) = beside.filter(|beside| !beside.is_empty()) else {
            return open(address);
        };
        let mut lines = vec![open(address)?];
        for other in beside {
            lines.push(open(other)?);
        }
        match Merged::new(lines) {
            Some(merged) => Ok(Box::new(merged)),
            None => open(address),
        }
    }

    fn pin(&mut self, address: &str, slot: Option<u16>) -> Result<(), String> {
        let known = self.known.as_mut().ok_or("nothing is known of devices here")?;
        let unit = known
            .units
            .get(address)
            .ok_or_else(|| format!("{address} is no device that is known"))?;
        known.identities.pin(unit, slot)
    }
}

/// A serial port of which only the system tells.
fn unknown(port: ports::Found) -> Found {
    let description = port.usb.as_ref().map_or_else(
        || "serial port".to_owned(),
        |usb| {
            let text = format!("{} {}", usb.manufacturer, usb.name);
            let ids = format!("{:04x}:{:04x} {}", usb.vendor, usb.product, usb.serial);
            format!("{} ({})", text.trim(), ids.trim())
        },
    );
    Found {
        address: port.path,
        description,
        allowed: if port.allowed {
            Ok(())
        } else {
            Err(ports::PERMISSION_HINT.to_owned())
        },
        ..Found::default()
    }
}

impl Known {
    fn list(&mut self, places: &Places) -> Vec<Found> {
        let mut seen = match &self.lookout {
            Some(lookout) => lookout.latest(),
            None => survey::survey(places, &self.profiles, &mut self.strings),
        };
        self.lines.apply(&mut seen, &self.profiles);
        self.beside = seen
            .iter()
            .map(|one| (one.found.address.clone(), one.beside.clone()))
            .collect();
        let certain: Vec<&Surveyed> = seen.iter().filter(|one| one.certain).collect();
        let units: Vec<Unit> = certain.iter().map(|one| unit(one)).collect();
        let slots = self.identities.assign(&units);
        let addresses = certain.iter().map(|one| one.found.address.clone());
        self.units = addresses.clone().zip(units).collect();
        let slots: BTreeMap<String, u16> = addresses.zip(slots).collect();
        seen.into_iter().map(|one| self.told(one, &slots)).collect()
    }

    fn told(&self, one: Surveyed, slots: &BTreeMap<String, u16>) -> Found {
        let identity = |address: &str| {
            let unit = self.units.get(address);
            unit.and_then(|unit| self.identities.identity(unit))
                .unwrap_or_default()
        };
        let plug = slots.get(&one.found.address).map(|&slot| {
            let profile = one.matches.first().cloned();
            let baud = profile.as_deref().and_then(|key| self.profiles.input(key).ok());
            let by_itself = || format!("hid-{}", one.found.id().unwrap_or_default().replace(':', "-"));
            Plug {
                name: profile.clone().unwrap_or_else(by_itself),
                slot,
                baud: baud.map_or(0, InputProfile::baud),
                identity: identity(&one.found.address),
                profile,
            }
        });
        Found {
            description: one.found.description(),
            allowed: survey::allowed(&one.found),
            address: one.found.address,
            matches: one.matches,
            why: one.why,
            held: one.held,
            plug,
        }
    }
}

fn unit(one: &Surveyed) -> Unit {
    let by_itself = || format!("generic {}", one.found.id().unwrap_or_default());
    Unit {
        profile: one.matches.first().cloned().unwrap_or_else(by_itself),
        serial: one.found.serial.clone(),
        place: one.found.place.clone(),
    }
}

/// Simulated devices at `sim:` addresses, the machine's own at all others.
pub struct WithBench {
    bench: Box<dyn Ports>,
    system: SystemPorts,
}

impl WithBench {
    /// Puts a bench beside the machine's ports.
    pub fn new(bench: Box<dyn Ports>) -> Self {
        Self::beside(bench, SystemPorts::default())
    }

    /// Puts a bench beside these ports of the machine.
    pub fn beside(bench: Box<dyn Ports>, system: SystemPorts) -> Self {
        Self { bench, system }
    }

    fn for_address(&mut self, address: &str) -> &mut dyn Ports {
        if address.starts_with("sim:") {
            self.bench.as_mut()
        } else {
            &mut self.system
        }
    }
}

impl Ports for WithBench {
    fn list(&mut self) -> Vec<Found> {
        let mut found = self.system.list();
        found.extend(self.bench.list());
        found
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        self.for_address(address).open(address, baud)
    }

    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        self.for_address(address).open_input(address, line)
    }

    fn pin(&mut self, address: &str, slot: Option<u16>) -> Result<(), String> {
        self.for_address(address).pin(address, slot)
    }

    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        self.for_address(address).touch(address, touch)
    }
}
