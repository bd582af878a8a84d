//! A rig for tests of controls, and a device with something of everything.

use std::sync::Arc;
use std::time::Duration;

use device::clock::VirtualClock;
use device::codec::Feedback;
use device::transport::{Transport, TransportError};
use device_profiles::{InputProfile, Profiles};

use super::*;
use crate::command::{NetworkEdit, ViewCommand};
use crate::controls_calibration::Store;
use crate::document::{NetworkFile, Show};
use crate::ports::{Found, Ports};
use crate::rig::RigOptions;
use crate::snapshot::Snapshot;

/// Two motor faders with lamps and labels, a dial with a ring, a button, a stick.
const NANO: &str = r#"
name = "Nano"
status = "untested"
kind = "midi"
format = "midi"
source = "this test"

[[control]]
kind = "fader"
name = "fader"
count = 2
range = [0, 1000]

[[control]]
kind = "dial"
name = "dial"
counts_per_turn = 24.0

[[control]]
kind = "button"
name = "button"

[[control]]
kind = "axis"
name = "stick"
range = [-100, 100]

[[output]]
kind = "motor"
of = "fader"
count = 2
levels = 1001

[[output]]
kind = "label"
of = "fader"
count = 2
characters = 8

[[output]]
kind = "ring"
of = "dial"
levels = 12

[[output]]
kind = "lamp"
of = "button"
"#;

struct NoPorts;

impl Ports for NoPorts {
    fn list(&mut self) -> Vec<Found> {
        Vec::new()
    }

    fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        Err(TransportError::NotFound {
            address: address.to_owned(),
        })
    }
}

/// A rig with one device that is put in by hand: no transport, no codec.
pub(in crate::rig) struct Bench {
    pub(in crate::rig) rig: Rig,
    clock: VirtualClock,
    pub(in crate::rig) seen: Arc<Snapshot>,
    pub(in crate::rig) shown: Vec<Feedback>,
}

impl Bench {
    /// A rig with a program and a Nano that is there.
    pub(in crate::rig) fn new(program: &str) -> Self {
        let mut bench = Self::without_device(program);
        bench.plug("nano");
        bench
    }

    pub(in crate::rig) fn without_device(program: &str) -> Self {
        let show = Show {
            name: "hands".into(),
            puppet: Some("so-101".into()),
            networks: vec![Arc::new(NetworkFile {
                name: "hands".into(),
                text: program.into(),
            })],
            ..Show::default()
        };
        let clock = VirtualClock::new();
        let options = RigOptions {
            show,
            folder: None,
            profiles: Arc::new(Profiles::builtin()),
            inputs: Vec::new(),
            calibrations: Store::in_memory(),
            puppet: None,
            recorder: None,
        };
        let rig = Rig::new(Arc::new(clock.clone()), Box::new(NoPorts), options).expect("it begins");
        let mut bench = Self {
            rig,
            clock,
            seen: Arc::default(),
            shown: Vec::new(),
        };
        bench.step(&[]);
        // A puppet is looked at from aside.
        let view = bench.seen.view.clone();
        bench.step(&[Command::View(ViewCommand::Turn {
            azimuth_by_rad: -view.azimuth_rad,
            elevation_by_rad: -view.elevation_rad,
        })]);
        bench
    }

    pub(in crate::rig) fn plug(&mut self, name: &str) {
        let profile: InputProfile = toml::from_str(NANO).expect("a profile");
        self.rig.meet(name, &profile);
        self.rig.noticed(&Change::Came(name.into()));
        self.step(&[]);
    }

    pub(in crate::rig) fn step(&mut self, commands: &[Command]) -> &Snapshot {
        self.clock.advance(Duration::from_millis(10));
        self.seen = self.rig.step(&mut commands.iter().cloned());
        self.shown.append(&mut self.rig.controls.told);
        &self.seen
    }

    pub(in crate::rig) fn wait(&mut self, secs: f64) {
        for _ in 0..(secs * 100.0) as u32 {
            self.step(&[]);
        }
    }

    pub(in crate::rig) fn say(&mut self, device: &str, event: InputEvent) {
        // As a step does before it listens.
        self.rig.refresh_controls();
        let place = self.rig.controls.find(device).expect("it is known");
        let stamped = Stamped {
            at: self.rig.now,
            what: event,
        };
        let source = Source {
            counts_per_turn: 1.0,
            surface: None,
        };
        self.rig.hear(place, &stamped, source);
    }

    pub(in crate::rig) fn fader(&mut self, control: u16, value: i32) -> &Snapshot {
        self.say("nano", InputEvent::Axis { control, value });
        self.step(&[]);
        self.step(&[])
    }

    /// The same slowly: no two of one movement.
    pub(in crate::rig) fn slowly(&mut self, control: u16, values: &[i32]) -> &Snapshot {
        for &value in values {
            self.wait(0.2);
            self.fader(control, value);
        }
        &self.seen
    }

    pub(in crate::rig) fn azimuth_deg(&self) -> f64 {
        self.seen.view.azimuth_rad.to_degrees()
    }

    pub(in crate::rig) fn commands(&mut self, text: &str) {
        self.step(&[Command::Network(NetworkEdit::Commands(text.to_owned()))]);
    }

    pub(in crate::rig) fn turn_view(&mut self, by_deg: f64) {
        self.step(&[Command::View(ViewCommand::Turn {
            azimuth_by_rad: by_deg.to_radians(),
            elevation_by_rad: 0.0,
        })]);
    }

    pub(in crate::rig) fn notes(&self) -> String {
        self.seen
            .notes
            .iter()
            .map(|note| note.text.as_str())
            .collect::<Vec<_>>()
            .join("\n")
    }

    pub(in crate::rig) fn view(&self) -> DeviceView {
        let mut view = DeviceView {
            name: "nano".into(),
            ..DeviceView::default()
        };
        self.rig.controls.view(&mut view, self.rig.secs());
        view
    }
}
