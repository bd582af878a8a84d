//! Judging expectations against what the rig shows.

use rig::{DeviceHealth, PuppetState, Snapshot};

use super::servos::{servos, torque_is};
use super::truth::{life, register, shaft};
use super::{Aspect, Bound, COUNTERS, Check, Evidence, HEALTHS, Near, STATES, VIEW_PARTS};
use crate::scenario::controls;
use crate::scenario::input::{judge_device, judge_output};
use crate::world::DIAL_BOX;

impl Near {
    pub(super) fn judge(self, what: &str, value: Option<f64>, hil: bool) -> Result<(), String> {
        let within = self.hil_within.filter(|_| hil).unwrap_or(self.within);
        match value {
            None => Err(format!("{what} is not known")),
            Some(value) if (value - self.wanted).abs() <= within => Ok(()),
            Some(value) => Err(format!("{what} is {value:.6}")),
        }
    }
}

impl Bound {
    pub(in crate::scenario) fn judge(self, what: &str, count: u64) -> Result<(), String> {
        let fits = match self {
            Self::AtLeast(least) => count >= least,
            Self::AtMost(most) => count <= most,
        };
        if fits {
            Ok(())
        } else {
            Err(format!("{what} is {count}"))
        }
    }
}

impl Check {
    /// Judges it; the words say what was found instead.
    pub(in crate::scenario) fn judge(&self, evidence: &Evidence<'_>) -> Result<(), String> {
        let Evidence { seen, hil, .. } = *evidence;
        match self {
            Self::Player { state, because } => player(seen, *state, because.as_deref()),
            Self::Joint { joint, aspect, near } => near.judge(
                &format!("joint {joint}"),
                joint_value(evidence, joint, *aspect)?,
                hil,
            ),
            Self::LinkAt {
                link,
                end,
                at,
                within,
            } => link_at(seen, link, *end, *at, *within),
            Self::LinkSelected { link } => link_selected(seen, link),
            Self::View { part, near } => {
                let view = &seen.view;
                let value = [view.azimuth_rad, view.elevation_rad, view.scale][*part];
                near.judge(&format!("view {}", VIEW_PARTS[*part]), Some(value), hil)
            }
            Self::Time(near) => near.judge("time", Some(seen.transport.secs), hil),
            Self::Playing(wanted) => fits(seen.transport.playing == *wanted, || {
                format!("time is {:.3}", seen.transport.secs)
            }),
            Self::Keys(wanted) => fits(seen.keys.len() == *wanted, || {
                format!("there are {} keys", seen.keys.len())
            }),
            Self::KeyAt { key, near } => near.judge(
                &format!("key {}", key + 1),
                seen.keys.get(*key).map(|key| key.secs),
                hil,
            ),
            Self::Label { control, text } => label(seen, *control, text),
            Self::Display { control, text } => display(evidence, *control, text),
            Self::Lamp { lamp, on } => lamp_is(evidence, *lamp, *on),
            Self::Note(text) => fits(seen.notes.iter().any(|note| note.text.contains(text)), || {
                let last = seen.notes.last().map_or("none", |note| note.text.as_str());
                format!("no note has it; the last is \"{last}\"")
            }),
            Self::Device { device, health } => device_is(seen, device, health),
            Self::Input(device, check) => judge_device(evidence, device, check),
            Self::Output(outlet, wanted) => judge_output(seen, outlet, wanted),
            Self::Servos { joint, conduct } => servos(evidence, joint.as_deref(), *conduct),
            Self::Torque { joint, on } => torque_is(evidence, joint.as_deref(), *on),
            Self::Counter { which, bound } => {
                let puppet = seen.puppet.as_ref().ok_or("there is no puppet")?;
                let count = [puppet.stale_discarded, puppet.interventions, puppet.late_cycles][*which];
                bound.judge(COUNTERS[*which], count)
            }
            Self::Undo(text) => {
                let there = seen.undo.as_deref().unwrap_or("");
                fits(there == text, || format!("undo is \"{there}\""))
            }
            Self::Said(said) => said.judge(seen),
            Self::Control { device, number, near } => near.judge(
                &format!("control {number} of {device}"),
                controls::place(seen, device, *number)?,
                hil,
            ),
            Self::Calibrated(expected) => expected.judge(evidence.calibrated),
            Self::Watchdogs { bus, bound } => watchdogs(evidence, bus, *bound),
            Self::Shaft { joint, part, near } => shaft(evidence, joint, *part, *near),
            Self::Register { joint, role, near } => register(evidence, joint, *role, *near),
            Self::Life { joint, event, bound } => life(evidence, joint, *event, *bound),
        }
    }
}

pub(super) fn fits(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}

fn state_name(state: PuppetState) -> &'static str {
    STATES
        .iter()
        .find(|(_, known)| *known == state)
        .map_or("", |(name, _)| name)
}

fn watchdogs(evidence: &Evidence<'_>, bus: &str, bound: Bound) -> Result<(), String> {
    let on_bus = evidence.truths.iter().filter(|truth| truth.bus == bus);
    let tripped = on_bus.filter(|truth| truth.life.watchdog_trips > 0).count();
    bound.judge(
        &format!("servos of {bus} stopped by their watchdogs"),
        tripped as u64,
    )
}

fn player(seen: &Snapshot, state: PuppetState, because: Option<&str>) -> Result<(), String> {
    let puppet = seen.puppet.as_ref().ok_or("there is no puppet")?;
    let fault = puppet.fault.as_deref().unwrap_or("");
    let holds = puppet.state == state && because.is_none_or(|because| fault.contains(because));
    fits(holds, || match fault {
        "" => format!("player is {}", state_name(puppet.state)),
        _ => format!("player is {} because {fault}", state_name(puppet.state)),
    })
}

fn joint_value(evidence: &Evidence<'_>, joint: &str, aspect: Aspect) -> Result<Option<f64>, String> {
    if aspect == Aspect::Really {
        let truth = evidence.truths.iter().find(|truth| truth.joint == joint);
        return truth
            .map(|truth| Some(truth.position_rad))
            .ok_or_else(|| format!("there is no joint {joint}"));
    }
    let puppet = evidence.seen.puppet.as_ref().ok_or("there is no puppet")?;
    let view = puppet.joints.iter().find(|view| view.name == joint);
    let view = view.ok_or_else(|| format!("there is no joint {joint}"))?;
    Ok(if aspect == Aspect::Goal {
        view.goal_rad
    } else {
        view.measured_rad
    })
}

fn link_place(seen: &Snapshot, link: &str) -> Result<usize, String> {
    let figure = seen.figure.as_ref().ok_or("there is no figure")?;
    let links = figure.figure.links();
    links.iter().position(|there| there.name == link).ok_or_else(|| {
        let known: Vec<&str> = links.iter().map(|there| there.name.as_str()).collect();
        format!("there is no link {link}; there are: {}", known.join(", "))
    })
}

fn link_at(seen: &Snapshot, link: &str, end: bool, at: [f64; 3], within: f64) -> Result<(), String> {
    let place = link_place(seen, link)?;
    let placed = seen
        .figure
        .as_ref()
        .and_then(|figure| figure.placed.get(place))
        .ok_or("nothing is posed")?;
    let point = if end { placed.end } else { placed.start };
    let off = (point - glam::DVec3::from_array(at)).length();
    fits(off <= within, || {
        let [x, y, z] = point.to_array();
        format!("it is at {x:.4} {y:.4} {z:.4}, {off:.4} m away")
    })
}

fn link_selected(seen: &Snapshot, link: &str) -> Result<(), String> {
    let place = link_place(seen, link)?;
    let selected = seen
        .figure
        .as_ref()
        .and_then(|figure| figure.selected)
        .map(usize::from);
    let name = selected
        .and_then(|at| seen.figure.as_ref()?.figure.links().get(at))
        .map(|l| l.name.as_str());
    fits(selected == Some(place), || {
        format!("selected is {}", name.unwrap_or("none"))
    })
}

/// What the box shows, or what the rig means it to where the box is real.
fn lamp_is(evidence: &Evidence<'_>, lamp: u8, on: bool) -> Result<(), String> {
    let keys = evidence.seen.desk.keys.iter().enumerate();
    let meant = keys.fold(0, |lamps: u64, (key, view)| lamps | u64::from(view.lit) << key);
    let shown = evidence.stand.shown(DIAL_BOX);
    let lit = shown.map_or(meant, |shown| shown.lamps);
    fits((lit >> lamp & 1 == 1) == on, || format!("lit are {lit:#010x}"))
}

fn label(seen: &Snapshot, control: u8, text: &str) -> Result<(), String> {
    let dials = seen.desk.dials.iter().map(|dial| &dial.label);
    let mut labels = dials.chain(seen.desk.keys.iter().map(|key| &key.label));
    let there = labels.nth(usize::from(control)).map_or("", String::as_str);
    fits(there == text, || format!("the label is \"{there}\""))
}

fn display(evidence: &Evidence<'_>, control: u8, text: &str) -> Result<(), String> {
    match evidence.stand.shown(DIAL_BOX) {
        Ok(shown) => {
            let there = shown.labels.get(&control).map_or("", String::as_str);
            fits(there == text, || format!("the display shows \"{there}\""))
        }
        // Nobody can read a real display but with eyes: what the rig means it to show has to do.
        Err(_) => label(evidence.seen, control, text),
    }
}

fn device_is(seen: &Snapshot, name: &str, health: &DeviceHealth) -> Result<(), String> {
    let device = seen.devices.iter().find(|device| device.name == name);
    let device = device.ok_or_else(|| format!("the rig has no input device {name}"))?;
    let found = HEALTHS
        .iter()
        .find(|(_, known)| *known == device.health)
        .map_or("", |(name, _)| name);
    fits(device.health == *health, || format!("{name} is {found}"))
}
