//! The input devices of the rig: opened by address, polled in the order of their names, looked for again when
//! they are gone; and what is plugged in while it runs.

mod plugging;

use plugging::{TRY_AGAIN_SOON, Taken};

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

use device::clock::Instant;
use device::codec::{Feedback, InputEvent, Stamped, Surface};
use device::transport::{Transport, TransportError};
use device::{Device, Health};
use device_profiles::{ControlClass, InputProfile, Profiles};

use crate::controls::view::{DeviceHealth, DeviceView};
use crate::controls_calibration::Sheet;
use crate::desk::Source;
use crate::ports::Ports;

/// How often a device that is gone is looked for. Without a monitor of the system's own, once a second is what
/// comparable drivers do.
const LOOK_AGAIN: Duration = Duration::from_secs(1);

/// How long a line that was let go of may still be taken: threads that read look up ten times a second.
const FREE_WITHIN: Duration = Duration::from_millis(500);
/// Between two attempts in that time.
const TRY_FREE_AGAIN: Duration = Duration::from_millis(50);

/// An input device to be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputSpec {
    /// What the rig calls it.
    pub name: String,
    /// Key of an input device's profile.
    pub profile: String,
    /// Where to open it.
    pub address: String,
}

/// A device cannot be used as described.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// No such profile.
    #[error("input {name}: there is no profile \"{profile}\" of an input device; there are: {known}")]
    Profile {
        /// The device.
        name: String,
        /// What was asked for.
        profile: String,
        /// What there is.
        known: String,
    },
    /// Two devices of one name.
    #[error("two inputs are called {name}; names must differ")]
    Twice {
        /// The name.
        name: String,
    },
}

/// Keys of all profiles of input devices.
pub(crate) fn known_profiles(profiles: &Profiles) -> String {
    let keys: Vec<_> = profiles.inputs().map(|p| p.key.as_str()).collect();
    keys.join(", ")
}

/// All input devices.
pub(crate) struct Inputs {
    seats: Vec<Seat>,
    heard: Vec<Stamped<InputEvent>>,
    /// The earliest time of what the next poll hears.
    since: Instant,
    profiles: Arc<Profiles>,
    /// When what is plugged in is looked at again.
    list_at: Instant,
    /// After so long.
    list_again: Duration,
    /// Counts changes of what devices are known by.
    pub(crate) identified: u64,
    /// Addresses of devices whose own description says nothing.
    refused: BTreeSet<String>,
}

/// Something a device said.
#[derive(Clone, Debug)]
pub(crate) struct Heard {
    /// Place of the device among the seats.
    pub(crate) seat: usize,
    pub(crate) event: Stamped<InputEvent>,
    pub(crate) source: Source,
}

struct Seat {
    spec: InputSpec,
    /// By what it is told apart from its equals: what was calibrated on it is kept by that.
    identity: String,
    make: Make,
    counts_per_turn: f64,
    dials: u16,
    device: Option<Device>,
    profile: Arc<InputProfile>,
    /// How it came, where nobody named it.
    taken: Option<Taken>,
    /// Whether its line is open.
    open: bool,
    health: DeviceHealth,
    events: u64,
    look_at: Instant,
    /// It is looked for in every step, and nobody is told.
    eager: bool,
    /// Since when somebody else has it.
    busy_since: Option<Instant>,
}

/// A device out of its line; an error in words.
type Make = Box<dyn Fn(Box<dyn Transport>) -> Result<Device, String> + Send>;

/// What became of a device during a poll, for the person at the rig.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// It answers.
    Came(String),
    /// It does not answer any more, and why.
    Gone(String, String),
    /// It could not be opened, and why.
    Absent(String, String),
}

impl Inputs {
    pub(crate) fn new(mut specs: Vec<InputSpec>, profiles: &Arc<Profiles>) -> Result<Self, InputError> {
        specs.sort_by(|a, b| a.name.cmp(&b.name));
        if let Some(pair) = specs.windows(2).find(|pair| pair[0].name == pair[1].name) {
            return Err(InputError::Twice {
                name: pair[0].name.clone(),
            });
        }
        let seats = specs
            .into_iter()
            .map(|spec| Seat::new(spec, profiles))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            seats,
            heard: Vec::new(),
            since: Instant::ZERO,
            profiles: Arc::clone(profiles),
            list_at: Instant::ZERO,
            list_again: plugging::LIST_AGAIN,
            identified: 1,
            refused: BTreeSet::new(),
        })
    }

    /// Polls every device in the order of their names. What they said is appended in the order of its times, equal
    /// ones in the order of the names. What had arrived before the last poll, which did not hear it, counts as come right
    /// after that one: whoever listens to it again by the times of the polls hears it in the same ones.
    pub(crate) fn poll(
        &mut self,
        now: Instant,
        ports: &mut dyn Ports,
        heard: &mut Vec<Heard>,
        noticed: &mut dyn FnMut(Change),
    ) {
        self.plug(now, ports, noticed);
        for (seat, it) in self.seats.iter_mut().enumerate() {
            self.heard.clear();
            it.poll(now, ports, &mut self.heard, noticed);
            it.events += self.heard.len() as u64;
            let source = it.source();
            let since = self.since;
            heard.extend(self.heard.drain(..).map(|mut event| {
                event.at = event.at.max(since).min(now);
                Heard { seat, event, source }
            }));
        }
        self.since = now.after(Duration::from_nanos(1));
        // Stable, so that what one device said stays in its order.
        heard.sort_by_key(|it| it.event.at);
    }

    /// The earliest time of what the next poll hears: just after the last one.
    pub(crate) fn since(&self) -> Instant {
        self.since
    }

    /// Devices that are away are looked for in every step: whoever has the lines knows when each was opened.
    pub(crate) fn look_in_every_step(&mut self) {
        self.list_again = Duration::ZERO;
        for seat in &mut self.seats {
            seat.eager = true;
        }
    }

    /// What the rig calls the device of a seat.
    pub(crate) fn name(&self, seat: usize) -> Option<&str> {
        self.seats.get(seat).map(|seat| seat.spec.name.as_str())
    }

    /// All devices and their profiles, in the order of their names.
    pub(crate) fn devices(&self) -> impl Iterator<Item = (&str, &Arc<InputProfile>)> {
        self.seats
            .iter()
            .map(|seat| (seat.spec.name.as_str(), &seat.profile))
    }

    /// The profile of a device, and whether it is its own description.
    pub(crate) fn profile(&self, name: &str) -> Option<(Arc<InputProfile>, bool)> {
        let seat = self.seats.iter().find(|seat| seat.spec.name == name)?;
        let described = self.profiles.input(&seat.spec.profile).is_err();
        Some((Arc::clone(&seat.profile), described))
    }

    /// Has a device show something. One that is away shows it when it is back.
    pub(crate) fn show(&mut self, name: &str, feedback: &Feedback) {
        let seat = self.seats.iter_mut().find(|seat| seat.spec.name == name);
        if let Some(device) = seat.and_then(|seat| seat.device.as_mut()) {
            // A line that is gone is found out by the next poll.
            let _ = device.show(feedback);
        }
    }

    pub(crate) fn view(&self) -> Vec<DeviceView> {
        self.seats.iter().map(Seat::view).collect()
    }

    /// By what the device of that name is told apart from its equals.
    pub(crate) fn identity(&self, name: &str) -> Option<&str> {
        let seat = self.seats.iter().find(|seat| seat.spec.name == name);
        seat.map(|seat| seat.identity.as_str())
    }

    /// The tablet of that name, once it has said how large it is.
    pub(crate) fn surface(&self, name: &str) -> Option<Surface> {
        let seat = self.seats.iter().find(|seat| seat.spec.name == name)?;
        seat.device.as_ref()?.surface()
    }

    /// Where the device of that name was opened.
    pub(crate) fn address(&self, name: &str) -> Option<&str> {
        self.seats
            .iter()
            .find(|s| s.spec.name == name)
            .map(|s| s.spec.address.as_str())
    }

    /// The first dial box at a simulated address: what a hand on the desk's picture touches.
    pub(crate) fn simulated_desk(&self) -> Option<String> {
        let seat = self
            .seats
            .iter()
            .find(|s| s.dials > 0 && s.spec.address.starts_with("sim:"))?;
        Some(seat.spec.name.clone())
    }
}

impl Seat {
    fn new(spec: InputSpec, profiles: &Profiles) -> Result<Self, InputError> {
        let name = spec.name.clone();
        let profile = profiles.input(&spec.profile).map_err(|_| InputError::Profile {
            name: spec.name.clone(),
            profile: spec.profile.clone(),
            known: known_profiles(profiles),
        })?;
        let profile = Arc::new(profile.clone());
        let own = Arc::clone(&profile);
        let make: Make = Box::new(move |line| {
            Device::of_profile(name.clone(), &own, line).map_err(|error| error.to_string())
        });
        Ok(Self::with(spec, profile, make))
    }

    /// For a device that says itself what it is; an error in words.
    fn described(spec: InputSpec, line: Box<dyn Transport>) -> Result<Self, String> {
        let name = spec.name.clone();
        let (device, mut profile) = Device::generic(name.clone(), line)?;
        profile.key.clone_from(&spec.profile);
        let make: Make = Box::new(move |line| Device::generic(name.clone(), line).map(|(device, _)| device));
        Ok(Self {
            device: Some(device),
            open: true,
            health: DeviceHealth::Starting,
            ..Self::with(spec, Arc::new(profile), make)
        })
    }

    fn with(spec: InputSpec, profile: Arc<InputProfile>, make: Make) -> Self {
        Self {
            identity: by_address(&spec),
            spec,
            make,
            counts_per_turn: profile.counts_per_turn(),
            dials: profile.count(ControlClass::Dial),
            device: None,
            taken: None,
            open: false,
            health: DeviceHealth::Lost,
            events: 0,
            look_at: Instant::ZERO,
            eager: false,
            busy_since: None,
            profile,
        }
    }

    fn poll(
        &mut self,
        now: Instant,
        ports: &mut dyn Ports,
        heard: &mut Vec<Stamped<InputEvent>>,
        noticed: &mut dyn FnMut(Change),
    ) {
        if self.may_be_opened() && now >= self.look_at {
            self.look(now, ports, noticed);
        }
        let Some(device) = &mut self.device else { return };
        device.tell_let_go(now, heard);
        if !self.open {
            return;
        }
        let health = match device.poll(now, heard) {
            Health::Present => DeviceHealth::Present,
            Health::Silent { .. } => DeviceHealth::Starting,
            Health::Lost => DeviceHealth::Lost,
        };
        if health != self.health {
            match &health {
                DeviceHealth::Present => noticed(Change::Came(self.spec.name.clone())),
                DeviceHealth::Lost => {
                    let why = device.lost().map(TransportError::to_string).unwrap_or_default();
                    noticed(Change::Gone(self.spec.name.clone(), why));
                    self.look_at = if self.eager { now } else { now.after(LOOK_AGAIN) };
                    self.open = false;
                }
                _ => {}
            }
            self.health = health;
        }
    }

    /// Not open, and where it was taken by itself it is there and grants the right.
    fn may_be_opened(&self) -> bool {
        let there = |taken: &Taken| taken.there && taken.rule.is_none();
        !self.open && self.taken.as_ref().is_none_or(there)
    }

    /// Tries to open it. What keeps it from being opened is how it is.
    fn look(&mut self, now: Instant, ports: &mut dyn Ports, noticed: &mut dyn FnMut(Change)) {
        let settling = self.taken.as_ref().is_some_and(|taken| taken.settling(now));
        self.look_at = match (self.eager, settling) {
            (true, _) => now,
            (_, true) => now.after(TRY_AGAIN_SOON),
            _ => now.after(LOOK_AGAIN),
        };
        let spec = &self.spec;
        let error = match ports.open_device(&spec.name, &spec.address, self.profile.line.as_ref()) {
            Ok(line) => return self.take(line),
            Err(error) => error,
        };
        if settling || self.eager || self.may_be_our_own(&error, now) {
            return;
        }
        self.health = match &error {
            TransportError::Forbidden { hint, .. } => DeviceHealth::Forbidden {
                rule: (*hint).to_owned(),
            },
            TransportError::Busy { .. } => DeviceHealth::Held {
                driver: "another program".to_owned(),
            },
            _ => DeviceHealth::Lost,
        };
        noticed(Change::Absent(self.spec.name.clone(), error.to_string()));
    }

    /// A line let go of is free only when the thread that reads it has noticed: for so long somebody having it means
    /// nothing, and it is tried again soon.
    fn may_be_our_own(&mut self, error: &TransportError, now: Instant) -> bool {
        if !matches!(error, TransportError::Busy { .. }) {
            self.busy_since = None;
            return false;
        }
        let since = *self.busy_since.get_or_insert(now);
        let soon = now.since(since) < FREE_WITHIN;
        if soon {
            self.look_at = now.after(TRY_FREE_AGAIN);
        }
        soon
    }

    fn take(&mut self, line: Box<dyn Transport>) {
        self.busy_since = None;
        self.health = DeviceHealth::Starting;
        self.open = true;
        match &mut self.device {
            Some(device) => device.reconnect(line),
            // The format was checked when the profile was read, so a device can be made; if a user's profile
            // names an unknown one, the seat stays empty and says so once a second.
            None => match (self.make)(line) {
                Ok(device) => self.device = Some(device),
                Err(error) => {
                    tracing::error!("{error}");
                    self.health = DeviceHealth::Lost;
                    self.open = false;
                }
            },
        }
    }

    fn source(&self) -> Source {
        Source {
            counts_per_turn: self.counts_per_turn,
            surface: self.device.as_ref().and_then(Device::surface),
        }
    }

    fn view(&self) -> DeviceView {
        let counters = self.device.as_ref().map(Device::counters).unwrap_or_default();
        DeviceView {
            name: self.spec.name.clone(),
            profile: self.spec.profile.clone(),
            address: self.spec.address.clone(),
            health: self.health.clone(),
            events: self.events,
            rejected: counters.unknown + counters.rejected,
            dropped: self.device.as_ref().map_or(0, Device::dropped),
            slot: self.taken.as_ref().map_or(1, |taken| taken.slot),
            sheet: self.device.as_ref().and_then(Device::surface).map(Sheet::from),
            ..DeviceView::default()
        }
    }
}

/// Of a device that nothing else tells apart.
pub(crate) fn by_address(spec: &InputSpec) -> String {
    format!("{}@{}", spec.profile, spec.address)
}

#[cfg(test)]
mod tests;
