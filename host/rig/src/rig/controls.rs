//! Physical controls in the rig: what devices say into the network, where parameters stand, what devices show, and
//! what is asked of them.

use device::codec::{InputEvent, Stamped};
use device_profiles::InputProfile;
use ps300::value::Value;

use super::Rig;
use crate::command::{Command, ControlCommand, NetworkEdit};
use crate::controls::control::At;
use crate::controls::inlets::{Inlet, PAGES};
use crate::controls::instance::Instance;
use crate::controls::learn;
use crate::controls::view::DeviceView;
use crate::controls::{Stands, drive, told};
use crate::desk::Source;
use crate::inputs::Change;
use crate::snapshot::NoteLevel;

/// What an angle of view or of a link may go through, degrees: all there is.
const ROUND_DEG: [f64; 2] = [-180.0, 180.0];
/// From right below to right above, degrees.
const TILT_DEG: [f64; 2] = [-90.0, 90.0];
/// Playing speeds worth a fader: from a standstill to twice.
const SPEEDS: [f64; 2] = [0.0, 2.0];

/// Times worth a fader where nothing has been made yet, seconds.
const TIMES_SECS: [f64; 2] = [0.0, 10.0];

impl Rig {
    /// Devices that have come to be known since: into the network with them.
    fn meet_new_devices(&mut self) {
        let new: Vec<_> = self
            .inputs
            .devices()
            .filter(|(name, _)| self.controls.find(name).is_none())
            .map(|(name, profile)| (name.to_owned(), profile.clone()))
            .collect();
        for (name, profile) in new {
            self.meet(&name, &profile);
        }
    }

    fn meet(&mut self, name: &str, profile: &InputProfile) {
        let at = self.controls.add(name, profile);
        let Some(instance) = self.controls.instances.get_mut(at) else {
            return;
        };
        match self.wiring.declare_device(at, instance) {
            Ok(()) => {
                let program = self.history.present().program_text();
                self.wiring.connect_late(&program, instance);
            }
            Err(why) => self.note(NoteLevel::Warning, why),
        }
    }

    /// Where everything stands that controls may drive, and which page is up.
    fn refresh_controls(&mut self) {
        self.meet_new_devices();
        self.recall_calibrations();
        let mut controls = std::mem::take(&mut self.controls);
        controls.selected(self.focus());
        self.controls = controls;
        self.refresh_bindings();
    }

    /// What controls drive, and where that stands.
    pub(super) fn refresh_bindings(&mut self) {
        let mut controls = std::mem::take(&mut self.controls);
        controls.refresh(self.wiring.machine(), self.steps, &|name, inlet| {
            self.stands(name, inlet)
        });
        self.controls = controls;
    }

    pub(super) fn hear_devices(&mut self) {
        self.refresh_controls();
        let mut heard = std::mem::take(&mut self.heard);
        let mut changes = Vec::new();
        let mut ports = self.takes.tapes.at(
            self.ports.as_mut(),
            &self.clock,
            self.began,
            [self.inputs.since(), self.now],
        );
        self.inputs.poll(self.now, &mut ports, &mut heard, &mut |change| {
            changes.push(change);
        });
        // What was plugged in just now may have spoken already.
        self.meet_new_devices();
        self.recall_calibrations();
        if !self.captures.is_idle() {
            self.captures.take_in(&self.takes.tapes);
        }
        for it in heard.drain(..) {
            let Some(name) = self.inputs.name(it.seat) else {
                continue;
            };
            if !self.captures.is_idle() {
                self.captures
                    .event(name, it.event.at.since(self.began), it.event.what);
            }
            if let Some(place) = self.controls.find(name) {
                self.hear(place, &it.event, it.source);
            }
        }
        self.heard = heard;
        for change in changes {
            self.noticed(&change);
        }
        self.pass_time();
    }

    /// What is pushed and goes by its speed goes on.
    fn pass_time(&mut self) {
        let (secs, wiring) = (self.secs(), &mut self.wiring);
        self.controls.pass(secs, &mut |from, output, value| {
            wiring.pass_to(secs);
            wiring.hear_from(from.outlet(output), value);
        });
    }

    /// Takes an event at its own time, not later than now.
    fn hear(&mut self, place: usize, event: &Stamped<InputEvent>, source: Source) {
        let secs = event.at.min(self.now).since(self.began).as_secs_f64();
        self.wiring.pass_to(secs);
        let source = self.measured_source(place, &event.what, source);
        if self.controls.is_desk(place) && !self.controls.mutes(place, &event.what) {
            let wiring = &mut self.wiring;
            self.desk
                .hear(&event.what, source, secs, &mut |instance, output, value| {
                    wiring.hear(instance, output, value);
                });
        }
        let at = At {
            secs,
            step: self.steps,
            fine: false,
        };
        let from = self.controls.instances.get(place).and_then(Instance::source);
        let wiring = &mut self.wiring;
        let touched = self
            .controls
            .hear(place, &event.what, source.surface, at, &mut |output, value| {
                if let Some(from) = from {
                    wiring.hear_from(from.outlet(output), value);
                }
            });
        self.calibration_hears(place, &event.what, touched);
    }

    /// A device came or went: what it drives stays where it is.
    pub(super) fn noticed(&mut self, change: &Change) {
        let (level, words) = match change {
            Change::Came(name) => (NoteLevel::Info, format!("{name} is there")),
            Change::Gone(name, why) => (
                NoteLevel::Warning,
                format!("{name}: {why}; what it drives stays where it is"),
            ),
            Change::Absent(name, why) => (NoteLevel::Warning, format!("{name}: {why}")),
        };
        self.note(level, words);
        self.calibration_notices(change);
        let (Change::Came(name) | Change::Gone(name, _) | Change::Absent(name, _)) = change;
        let place = self.controls.find(name);
        let Some(instance) = place.and_then(|at| self.controls.instances.get_mut(at)) else {
            return;
        };
        match change {
            Change::Came(_) => instance.present = true,
            Change::Gone(..) => {
                if instance.is_desk && instance.tablet.is_some() {
                    self.desk.gone();
                }
                let (from, wiring) = (instance.source(), &mut self.wiring);
                instance.lost(&mut |output, value| {
                    if let Some(from) = from {
                        wiring.hear_from(from.outlet(output), value);
                    }
                });
            }
            Change::Absent(..) => {}
        }
    }

    /// Does what arrived at inlets of devices.
    pub(super) fn take_device_messages(&mut self) {
        let mut messages = std::mem::take(&mut self.device_messages);
        self.wiring.device_messages(&mut messages);
        for message in messages.drain(..) {
            self.tell_device(
                message.device,
                message.inlet,
                message.number,
                Some(&message.value),
            );
        }
        self.device_messages = messages;
    }

    fn tell_device(&mut self, device: usize, inlet: Inlet, number: u8, value: Option<&Value>) {
        let Some(instance) = self.controls.instances.get_mut(device) else {
            return;
        };
        if let Err(why) = instance.take(inlet, number, value) {
            self.note(NoteLevel::Warning, why);
        }
    }

    /// After a program was exchanged for another: what it tells devices is theirs again, what only the first told
    /// them is not.
    pub(super) fn tell_devices_again(&mut self, [before, after]: &[String; 2]) {
        let is_inlet = |name: &ps300::language::Name| self.wiring.device_inlet(name).is_some();
        let [before, after] = [before, after].map(|text| told(text, &is_inlet));
        let gone = before
            .iter()
            .filter(|(name, number, _)| !after.iter().any(|it| (&it.0, it.1) == (name, *number)))
            .map(|(name, number, _)| (name.clone(), *number, None));
        let new = after
            .iter()
            .filter(|it| !before.contains(it))
            .map(|(name, number, value)| (name.clone(), *number, Some(value.clone())));
        for (name, number, value) in gone.chain(new).collect::<Vec<_>>() {
            if let Some((device, inlet)) = self.wiring.device_inlet(&name) {
                self.tell_device(device, inlet, number, value.as_ref());
            }
        }
    }

    pub(super) fn show_on_devices(&mut self) {
        let secs = self.secs();
        let now = self.since_began();
        let (inputs, captures, tapes) = (&mut self.inputs, &mut self.captures, &self.takes.tapes);
        self.controls
            .show(self.wiring.panel(), secs, &mut |device, feedback| {
                let captured = captures.runs(device);
                if captured {
                    captures.show(device, now, feedback);
                }
                inputs.show(device, feedback);
                if captured {
                    captures.take_in(tapes);
                }
            });
    }

    pub(super) fn device_views(&self) -> Vec<DeviceView> {
        let (secs, now) = (self.secs(), self.since_began());
        let mut views = self.inputs.view();
        for view in &mut views {
            self.controls.view(view, secs);
            view.capture = self.captures.view(&view.name, now);
        }
        views
    }

    /// The link in hand, else the joint that was posed last.
    fn focus(&self) -> &str {
        if let Some(joint) = &self.joint_in_hand {
            return joint;
        }
        let stage = self.stage.as_ref();
        let link = stage.and_then(|it| it.figure().links().get(usize::from(it.selected())));
        link.map(|link| link.name.as_str()).unwrap_or_default()
    }

    /// Where a parameter stands, by an inlet that goes to a value; and between what it may go.
    pub(super) fn stands(&self, name: &str, inlet: u8) -> Stands {
        if let Some(link) = drive::link(name) {
            let stage = self.stage.as_ref()?;
            let mut links = stage.figure().links().iter();
            let place = links.position(|it| it.name.eq_ignore_ascii_case(link))?;
            let twist_rad = stage.twist_rad(place as u16)?;
            return Some((twist_rad.to_degrees(), Some(ROUND_DEG)));
        }
        if let Some(joint) = drive::joint(name) {
            let (_, angle_rad, range_rad) = self.rehearsing.as_ref()?.mannequin().joint(joint)?;
            let range = range_rad.iter().all(|it| it.is_finite());
            let range = if range {
                range_rad.map(f64::to_degrees)
            } else {
                ROUND_DEG
            };
            return Some((angle_rad.to_degrees(), Some(range)));
        }
        let transport = self.timeline.view();
        let is = |known: &str| name.eq_ignore_ascii_case(known);
        let (value, range) = match inlet {
            5 if is("VIEW") => (self.view.azimuth_rad.to_degrees(), ROUND_DEG),
            6 if is("VIEW") => (self.view.elevation_rad.to_degrees(), TILT_DEG),
            2 if is("TIME") && transport.end_secs > transport.start_secs => {
                (transport.secs, [transport.start_secs, transport.end_secs])
            }
            2 if is("TIME") => (transport.secs, TIMES_SECS),
            6 if is("TIME") => (transport.speed, SPEEDS),
            _ => return None,
        };
        Some((value, Some(range)))
    }

    pub(super) fn control(&mut self, command: &Command) -> Result<(), String> {
        match command {
            Command::Learn(learn) => self.learn(learn),
            Command::BindControl(binding) => self.bind(binding),
            Command::UnbindControl { device, control } => self.unbind(device, *control),
            Command::SetControlLabel {
                device,
                control,
                text,
            } => {
                let instance = self.instance_of(device)?;
                let page = instance.page_name();
                self.send_to_device(&format!("{page}_LABEL"), *control, Value::from(text.as_str()))
            }
            Command::Controls(command) => self.set_control(command),
            Command::TestOutput { device, output } => {
                let secs = self.secs();
                let at = self.place_of(device)?;
                let instance = &mut self.controls.instances[at];
                let count = instance.outputs.len();
                let output = instance.outputs.get_mut(usize::from(*output)).ok_or_else(|| {
                    format!("{device} has {count} outputs, numbered from 0; there is no {output}")
                })?;
                output.test(secs);
                Ok(())
            }
            Command::PinDevice { device, slot } => {
                self.place_of(device)?;
                self.inputs.pin(device, *slot, self.ports.as_mut())
            }
            _ => Ok(()),
        }
    }

    pub(super) fn place_of(&self, device: &str) -> Result<usize, String> {
        self.controls.find(device).ok_or_else(|| {
            let all: Vec<&str> = self
                .controls
                .instances
                .iter()
                .map(|it| it.device.as_str())
                .collect();
            format!("there is no input device {device}; there are: {}", all.join(", "))
        })
    }

    pub(super) fn instance_of(&self, device: &str) -> Result<&Instance, String> {
        self.place_of(device).map(|at| &self.controls.instances[at])
    }

    /// Sends to an inlet of a device as a command of the network: it stays in the show and can be undone.
    fn send_to_device(&mut self, name: &str, number: u8, value: Value) -> Result<(), String> {
        let send = ps300::Command::Send {
            payload: ps300::language::Payload::Value(value),
            to: learn::input(name, number),
        };
        self.edit_network(&NetworkEdit::Commands(learn::text(&[send])))
    }

    fn set_control(&mut self, command: &ControlCommand) -> Result<(), String> {
        match command {
            ControlCommand::Fine(on) => {
                self.controls.fine = *on;
                Ok(())
            }
            ControlCommand::Mode {
                device,
                control,
                mode,
            } => {
                let name = format!("{}_MODE", self.instance_of(device)?.name);
                self.send_to_device(&name, *control, Value::from(mode.as_str()))
            }
            ControlCommand::Gear {
                device,
                control,
                factor,
            } => {
                let name = format!("{}_GEAR", self.instance_of(device)?.name);
                self.send_to_device(&name, *control, Value::Real(*factor))
            }
            ControlCommand::Curve {
                device,
                control,
                curve,
            } => {
                let name = format!("{}_CURVE", self.instance_of(device)?.name);
                self.send_to_device(&name, *control, Value::Integer((*curve).into()))
            }
            ControlCommand::Page { device, page } => {
                let at = self.place_of(device)?;
                if !(1..=PAGES).contains(page) {
                    return Err(format!("{device} has pages 1 to {PAGES}, not {page}"));
                }
                self.controls.instances[at].go_to_page(*page);
                Ok(())
            }
            ControlCommand::PageFollows { device, on } => {
                let at = self.place_of(device)?;
                self.controls.instances[at].pages.follows = *on;
                Ok(())
            }
            ControlCommand::PageFor { device, page, focus } => {
                let name = format!("{}_PAGE", self.instance_of(device)?.name);
                self.send_to_device(&name, page.saturating_add(2), Value::from(focus.as_str()))
            }
        }
    }
}

#[cfg(test)]
#[path = "controls_bench.rs"]
pub(super) mod bench;
#[cfg(test)]
#[path = "controls_cost.rs"]
mod cost;
#[cfg(test)]
#[path = "controls_echo.rs"]
mod echo;
#[cfg(test)]
#[path = "controls_rate.rs"]
mod rate;
#[cfg(test)]
#[path = "controls_steps.rs"]
mod steps;
#[cfg(test)]
#[path = "controls_tests.rs"]
mod tests;
