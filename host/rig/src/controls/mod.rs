//! Physical controls as part of the network: devices as instances, how their movements become messages, and what
//! they show.
//!
//! *Knows* profiles' controls and outputs, and which inlets of the network a control drives. *Must not know* wires,
//! transports or formats: events come in decoded, feedback goes out as values. *Start reading* at `pickup`, which is
//! pure, then at `control` (one control), `instance` (one device) and `bound` (how it learns what it drives).

pub mod assumed;
pub(crate) mod bound;
pub mod button;
pub mod command;
pub(crate) mod control;
pub(crate) mod drive;
pub mod gears;
pub(crate) mod inlets;
pub(crate) mod instance;
pub(crate) mod learn;
pub(crate) mod pages;
pub mod pickup;
pub mod rhythm;
pub(crate) mod shown;
pub mod standing;
pub(crate) mod tablet;
pub mod view;

use std::collections::BTreeMap;
use std::sync::Arc;

use device::codec::{Feedback, InputEvent, Surface};
use device_profiles::{ControlClass, InputProfile};
use ps300::language::Name;
use ps300::machine::{Machine, Panel, SourceId};
use ps300::value::Value;

use bound::{Bound, Wires};
use control::{At, MEANT, Reading, Standing};
use drive::Sort;
use instance::{Instance, Touched};
use learn::Learning;
use shown::Light;
use view::{ControlView, DeviceView, OutputView};

/// Where a parameter of the rig stands: value and ends, in the unit of its inlet.
pub(crate) type Stands = Option<(f64, Option<[f64; 2]>)>;

/// All devices in the network.
#[derive(Default)]
pub(crate) struct Controls {
    pub(crate) instances: Vec<Instance>,
    wires: Wires,
    pub(crate) learning: Option<Learning>,
    /// How far each control has moved since learning began, by place of the instance and number.
    moved: BTreeMap<(usize, u8), f64>,
    /// Fine gear for all.
    pub(crate) fine: bool,
    /// Whose dials and keys are the desk's, and whose surface its tablet.
    desk: [Option<usize>; 2],
    /// The link or joint that was selected last.
    focus: String,
    /// All that devices were told, for tests.
    #[cfg(test)]
    pub(crate) told: Vec<Feedback>,
}

impl Controls {
    /// The network is another one: what controls drive in it is looked up anew.
    pub(crate) fn forget_wires(&mut self) {
        self.wires = Wires::default();
    }

    /// Adds a device that was not known before; returns its place. The first with dials is the desk, the first with
    /// a surface its tablet, for good.
    pub(crate) fn add(&mut self, device: &str, profile: &InputProfile) -> usize {
        let stem = inlets::spelled(device);
        let taken = |name: &str| self.instances.iter().any(|it| it.name == name);
        let mut name = stem.clone();
        let mut number = 2;
        // Apart from a digit before: the second NANO2 is no NANO22.
        let apart = if stem.ends_with(|c: char| c.is_ascii_digit()) {
            "_"
        } else {
            ""
        };
        while taken(&name) {
            name = format!("{stem}{apart}{number}");
            number += 1;
        }
        let mut instance = Instance::new(device, &name, profile);
        let place = self.instances.len();
        let [dials, tablet] = &mut self.desk;
        if instance.tablet.is_some() {
            instance.is_desk = *tablet.get_or_insert(place) == place;
        } else if profile.count(ControlClass::Dial) > 0 {
            instance.is_desk = *dials.get_or_insert(place) == place;
        }
        self.instances.push(instance);
        place
    }

    /// Whether a device's dials and keys, or its surface, are those of the desk.
    pub(crate) fn is_desk(&self, place: usize) -> bool {
        self.instances.get(place).is_some_and(|it| it.is_desk)
    }

    /// Whether an event is of a dial that is being calibrated, so that the desk has none of it.
    pub(crate) fn mutes(&mut self, place: usize, event: &InputEvent) -> bool {
        let InputEvent::Dial { control, .. } = *event else {
            return false;
        };
        self.instances
            .get_mut(place)
            .is_some_and(|it| it.mutes_dial(control))
    }

    pub(crate) fn find(&self, device: &str) -> Option<usize> {
        self.instances.iter().position(|it| it.device == device)
    }

    /// Looks, once a step, what controls drive and where that stands.
    pub(crate) fn refresh(&mut self, machine: &Machine, step: u64, stands: &dyn Fn(&str, u8) -> Stands) {
        let rewired = self.wires.follow(machine);
        for instance in &mut self.instances {
            if rewired || instance.page_turned {
                instance.page_turned = false;
                let page = Name::new(&instance.page_name());
                for control in &mut instance.controls {
                    let bound = self.wires.bound(&page, control.number);
                    if bound != control.bound {
                        let first = bound.first().map(|it| drive::short(it.to.as_str(), it.inlet));
                        control.reading = first.map(Reading::of);
                        control.bound = bound;
                        control.release();
                    }
                }
            }
            for control in &mut instance.controls {
                let (mut sent, mut first) = (None, None);
                for bound in &control.bound {
                    let (standing, back) = standing(machine, bound, stands);
                    first = first.or(Some(standing));
                    sent = sent.or(back);
                }
                if let (Some(reading), Some(first)) = (&mut control.reading, first) {
                    reading.standing = first;
                }
                control.target = sent.map(|sent| control.share_of(sent));
                control.pickup.look(step, control.target);
            }
        }
    }

    /// Takes an event of the device at a place; what it sends goes to `emit`. Returns what a hand did.
    pub(crate) fn hear(
        &mut self,
        place: usize,
        event: &InputEvent,
        surface: Option<Surface>,
        mut at: At,
        emit: &mut tablet::Emit<'_>,
    ) -> Option<Touched> {
        at.fine |= self.fine;
        let instance = self.instances.get_mut(place)?;
        instance.rhythm.hear(at.secs);
        let touched = instance.hear(event, at, surface, emit)?;
        self.touched(place, touched);
        Some(touched)
    }

    /// Time passes: what is pushed and goes by its speed goes on. What it sends goes to `emit`, with its sender.
    pub(crate) fn pass(&mut self, secs: f64, emit: &mut dyn FnMut(SourceId, u8, Value)) {
        for instance in self.instances.iter_mut().filter(|it| it.present) {
            let fine = self.fine || instance.fine;
            let Some(from) = instance.source() else { continue };
            for control in &mut instance.controls {
                if let Some(value) = control.pass(secs, fine) {
                    emit(from, control.number, value);
                }
            }
        }
    }

    /// While something is learnt, the first control that is moved far enough is meant.
    fn touched(&mut self, place: usize, touched: Touched) {
        let Some(learning) = self.learning.as_mut().filter(|it| it.control.is_none()) else {
            return;
        };
        let key = (place, touched.number);
        let moved = self.moved.entry(key).or_default();
        *moved += touched.by;
        let moved = *moved;
        if moved >= MEANT
            && let Some(instance) = self.instances.get(place)
        {
            learning.control = Some((instance.device.clone(), touched.number));
        }
    }

    /// Begins to learn anew, or stops.
    pub(crate) fn learn(&mut self, on: bool) {
        self.learning = on.then(Learning::default);
        self.moved.clear();
    }

    /// A link or joint was selected, or none; pages that follow come up.
    pub(crate) fn selected(&mut self, focus: &str) {
        if self.focus == focus {
            return;
        }
        focus.clone_into(&mut self.focus);
        for instance in &mut self.instances {
            instance.selected(focus);
        }
    }

    /// The link or joint that pages went by.
    pub(crate) fn focus(&self) -> &str {
        &self.focus
    }

    /// Pages went by this; none comes up for it.
    pub(crate) fn resume_focus(&mut self, focus: &str) {
        focus.clone_into(&mut self.focus);
    }

    /// What devices have to be told so that they show what they are to show: device, feedback.
    pub(crate) fn show(&mut self, panel: &Panel, now_secs: f64, tell: &mut dyn FnMut(&str, &Feedback)) {
        for instance in self.instances.iter_mut().filter(|it| it.present) {
            let is_desk = instance.is_desk && instance.tablet.is_none();
            let light = Light {
                controls: &instance.controls,
                page: instance.pages.now,
                now_secs,
                panel: is_desk.then_some(panel),
            };
            for output in &mut instance.outputs {
                if let Some(feedback) = output.change(&light) {
                    tell(&instance.device, &feedback);
                    #[cfg(test)]
                    self.told.push(feedback);
                }
            }
        }
    }

    /// Adds to a device's view what is known here.
    pub(crate) fn view(&self, view: &mut DeviceView, now_secs: f64) {
        let Some(instance) = self.find(&view.name).and_then(|at| self.instances.get(at)) else {
            return;
        };
        view.instance.clone_from(&instance.name);
        view.title.clone_from(&instance.title);
        view.rate_hz = instance.rhythm.rate_hz(now_secs);
        view.jitter_ms = instance.rhythm.jitter_ms(now_secs);
        view.page = instance.pages.now;
        view.page_follows = instance.pages.follows;
        view.calibration = Arc::clone(&instance.calibration);
        view.controls = control_views(instance, now_secs);
        view.outputs = (0..)
            .zip(&instance.outputs)
            .map(|(number, output)| OutputView {
                number,
                kind: output.kind.word(),
                of_kind: output.of_kind + 1,
                control: output
                    .control
                    .and_then(|at| instance.controls.get(at))
                    .map(|it| it.number),
                inlet: output.inlet,
                shows: output.words(),
            })
            .collect();
    }
}

fn control_views(instance: &Instance, now_secs: f64) -> Vec<ControlView> {
    let page = instance.pages.now;
    let surface = instance.tablet.iter().flat_map(|tablet| {
        let view = |number, name: &str, value, range| ControlView {
            number,
            name: name.to_owned(),
            kind: "pen",
            value,
            unit: "share",
            range: Some(range),
            picked_up: true,
            calibrated: instance.calibration.tablet.is_some(),
            ..ControlView::default()
        };
        [
            view(1, "x", tablet.position.x, [-1.0, 1.0]),
            view(1, "y", tablet.position.y, [-1.0, 1.0]),
            view(7, "pressure", tablet.pressure, [0.0, 1.0]),
        ]
    });
    let controls = instance.controls.iter().map(|control| ControlView {
        number: control.number,
        name: control.name.clone(),
        kind: control.kind.word(),
        value: control.value,
        unit: control.unit,
        range: control.ends(),
        picked_up: control.picked_up(),
        awaits: control.awaits(),
        live: control.is_live(now_secs),
        bound: control.bound.iter().map(Bound::words).collect(),
        label: control.label(page, now_secs),
        mode: control.mode(),
        comes_to: control.comes_to(),
        calibrated: control.is_calibrated(),
    });
    surface.chain(controls).collect()
}

/// Where something that is driven stands: for people, and as what the control would send.
fn standing(
    machine: &Machine,
    bound: &Bound,
    stands: &dyn Fn(&str, u8) -> Stands,
) -> (Standing, Option<f64>) {
    let name = bound.to.as_str();
    let drive = drive::drive(name, bound.inlet);
    let (value, range) = match drive::read_at(name, bound.inlet) {
        Some(at) => stands(name, at).map_or((None, None), |(value, range)| (Some(value), range)),
        None => (bound.stands(machine), None),
    };
    let goes_there = drive.is_none_or(|it| matches!(it.sort, Sort::Absolute { .. }));
    let sent = value
        .filter(|_| goes_there)
        .and_then(|value| bound.back(machine, value));
    let standing = Standing {
        value,
        unit: drive.map_or("", |it| it.unit),
        range,
    };
    (standing, sent)
}

/// The last literal messages that a program sends to inlets of devices: what undo has to send again.
pub(crate) fn told(program: &str, is_inlet: &dyn Fn(&Name) -> bool) -> Vec<(Name, u8, Value)> {
    use ps300::language::{Command, Input, Payload, parse};
    let mut told: Vec<(Name, u8, Value)> = Vec::new();
    for located in parse(program).0 {
        let Command::Send {
            payload: Payload::Value(value),
            to,
        } = located.what
        else {
            continue;
        };
        let Input::Number(number) = to.input else { continue };
        let Some(number) = u8::try_from(number).ok().filter(|_| is_inlet(&to.name)) else {
            continue;
        };
        told.retain(|(name, input, _)| (name, *input) != (&to.name, number));
        told.push((to.name, number, value));
    }
    told
}

#[cfg(test)]
mod outputs_tests;
