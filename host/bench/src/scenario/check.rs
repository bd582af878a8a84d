//! What can be expected in a scenario, and how it is judged: against what the rig shows, and where the word
//! says so against what the simulated devices really do.

use rig::{DeviceHealth, PuppetState, Snapshot};

use super::words::{Parsed, Words};
use crate::stand::{JointTruth, Stand};
use crate::world::{DIAL_BOX, PERIOD};

/// Words that begin an expectation.
pub(super) const SUBJECTS: &[&str] = &[
    "player",
    "joint",
    "dof",
    "link",
    "view",
    "time",
    "transport",
    "keys",
    "key",
    "label",
    "display",
    "lamp",
    "note",
    "device",
    "servos",
    "servo",
    "torque",
    "counter",
    "undo",
    "watchdogs",
];

/// Speed below which a servo stands, radians a second: one count of an X-series servo in 0.15 s.
const STILL_RAD_PER_S: f64 = 0.01;
/// Goals are rounded to counts, so a shaft may be this much faster than its goals.
const SPEED_SLACK: f64 = 1.02;
/// A count in a cycle of 10 ms is a step of 0.15 rad/s, which motor and gear smooth to a few rad/s²: so much more
/// than a joint's limit is still at it.
const ACCEL_SLACK: f64 = 1.20;
/// How far outside its range a joint may be by rounding to counts, radians.
const RANGE_SLACK_RAD: f64 = 0.002;

/// A number and how near to it is near enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Near {
    wanted: f64,
    within: f64,
    /// The tolerance on real hardware.
    hil_within: Option<f64>,
}

/// Whether a count is to be large or small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bound {
    AtLeast(u64),
    AtMost(u64),
}

/// Which value of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Aspect {
    /// What the rig last read.
    Measured,
    /// What the rig last asked for.
    Goal,
    /// Where the simulated shaft is.
    Really,
}

/// Which limits of a servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Conduct {
    /// Range, speed and acceleration.
    Limits,
    /// Range alone.
    Range,
    /// Speed alone.
    Speed,
    Still,
    SlowerThan(f64),
    /// No farther than this from where it was marked.
    NearMark(f64),
}

/// One expectation.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Check {
    Player {
        state: PuppetState,
        because: Option<String>,
    },
    Joint {
        joint: String,
        aspect: Aspect,
        near: Near,
    },
    LinkAt {
        link: String,
        end: bool,
        at: [f64; 3],
        within: f64,
    },
    LinkSelected {
        link: String,
    },
    View {
        part: usize,
        near: Near,
    },
    Time(Near),
    Playing(bool),
    Keys(usize),
    KeyAt {
        key: usize,
        near: Near,
    },
    Label {
        control: u8,
        text: String,
    },
    Display {
        control: u8,
        text: String,
    },
    Lamp {
        lamp: u8,
        on: bool,
    },
    Note(String),
    Device {
        device: String,
        health: DeviceHealth,
    },
    Servos {
        joint: Option<String>,
        conduct: Conduct,
    },
    Torque {
        joint: Option<String>,
        on: bool,
    },
    Counter {
        which: usize,
        bound: Bound,
    },
    Undo(String),
    Watchdogs {
        bus: String,
        bound: Bound,
    },
}

/// What a judgement may look at.
pub(super) struct Evidence<'a> {
    pub(super) seen: &'a Snapshot,
    pub(super) stand: &'a Stand,
    /// The joints as they really are.
    pub(super) truths: &'a [JointTruth],
    /// The same, one and two steps before; empty after a pause of the host.
    pub(super) past: [&'a [JointTruth]; 2],
    /// The same, when they were marked.
    pub(super) mark: &'a [JointTruth],
}

const STATES: [(&str, PuppetState); 5] = [
    ("released", PuppetState::Released),
    ("arming", PuppetState::Arming),
    ("holding", PuppetState::Holding),
    ("playing", PuppetState::Playing),
    ("faulted", PuppetState::Faulted),
];
const HEALTHS: [(&str, DeviceHealth); 3] = [
    ("present", DeviceHealth::Present),
    ("starting", DeviceHealth::Starting),
    ("lost", DeviceHealth::Lost),
];
const VIEW_PARTS: [&str; 3] = ["azimuth", "elevation", "scale"];
const COUNTERS: [&str; 3] = ["stale", "interventions", "late"];

fn state_name(state: PuppetState) -> &'static str {
    STATES
        .iter()
        .find(|(_, known)| *known == state)
        .map_or("", |(name, _)| name)
}

impl Near {
    fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        let wanted = words.any_number("a value")?;
        words.expect("within")?;
        let within = words.number("a tolerance", 0.0..=f64::MAX)?;
        let hil_within = if words.take("hil") {
            words.expect("within")?;
            Some(words.number("a tolerance", 0.0..=f64::MAX)?)
        } else {
            None
        };
        Ok(Self {
            wanted,
            within,
            hil_within,
        })
    }

    fn judge(self, what: &str, value: Option<f64>) -> Result<(), String> {
        match value {
            None => Err(format!("{what} is not known")),
            Some(value) if (value - self.wanted).abs() <= self.within => Ok(()),
            Some(value) => Err(format!("{what} is {value:.6}")),
        }
    }
}

impl Bound {
    fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        words.expect("at")?;
        let least = words.one_of(&["least", "most"])? == 0;
        let count = words.whole("a count", 0..=u64::from(u32::MAX))?;
        Ok(if least {
            Self::AtLeast(count)
        } else {
            Self::AtMost(count)
        })
    }

    fn judge(self, what: &str, count: u64) -> Result<(), String> {
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
    /// Reads an expectation up to the end of the line.
    pub(super) fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        let subject = SUBJECTS[words.one_of(SUBJECTS)?];
        match subject {
            "player" => {
                words.expect("is")?;
                let place = words.one_of(&STATES.map(|(name, _)| name))?;
                Ok(Self::Player {
                    state: STATES[place].1,
                    because: words.maybe_quoted(),
                })
            }
            "joint" | "dof" => joint(words),
            "link" => link(words),
            "view" => {
                let part = words.one_of(&VIEW_PARTS)?;
                words.expect("is")?;
                Ok(Self::View {
                    part,
                    near: Near::parse(words)?,
                })
            }
            "time" => {
                words.expect("is")?;
                Near::parse(words).map(Self::Time)
            }
            "transport" => {
                words.expect("is")?;
                Ok(Self::Playing(words.one_of(&["playing", "paused"])? == 0))
            }
            "keys" => {
                words.expect("are")?;
                Ok(Self::Keys(words.whole("a number of keys", 0..=100_000)? as usize))
            }
            "key" => {
                let key = words.whole("a key of the clip", 1..=100_000)? as usize - 1;
                words.expect("at")?;
                Ok(Self::KeyAt {
                    key,
                    near: Near::parse(words)?,
                })
            }
            "label" => control(words, "is").map(|(control, text)| Self::Label { control, text }),
            "display" => control(words, "shows").map(|(control, text)| Self::Display { control, text }),
            "lamp" => {
                let lamp = words.whole("a lamp", 1..=32)? as u8 - 1;
                words.expect("is")?;
                Ok(Self::Lamp {
                    lamp,
                    on: words.one_of(&["on", "off"])? == 0,
                })
            }
            "note" => {
                words.expect("contains")?;
                words.quoted("a text").map(Self::Note)
            }
            "device" => {
                let device = words.text("a device")?;
                words.expect("is")?;
                let place = words.one_of(&HEALTHS.map(|(name, _)| name))?;
                Ok(Self::Device {
                    device,
                    health: HEALTHS[place].1,
                })
            }
            "undo" => {
                words.expect("is")?;
                words.quoted("what would be taken back").map(Self::Undo)
            }
            "counter" => {
                let which = words.one_of(&COUNTERS)?;
                Ok(Self::Counter {
                    which,
                    bound: Bound::parse(words)?,
                })
            }
            "watchdogs" => {
                words.expect("of")?;
                Ok(Self::Watchdogs {
                    bus: words.text("a bus")?,
                    bound: Bound::parse(words)?,
                })
            }
            "torque" => torque(words),
            "servos" => conduct(words).map(|conduct| Self::Servos { joint: None, conduct }),
            _ => {
                let joint = Some(words.text("a joint")?);
                conduct(words).map(|conduct| Self::Servos { joint, conduct })
            }
        }
    }

    /// Judges it; the words say what was found instead.
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Result<(), String> {
        let Evidence { seen, stand, .. } = evidence;
        match self {
            Self::Player { state, because } => player(seen, *state, because.as_deref()),
            Self::Joint { joint, aspect, near } => {
                near.judge(&format!("joint {joint}"), joint_value(evidence, joint, *aspect)?)
            }
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
                near.judge(&format!("view {}", VIEW_PARTS[*part]), Some(value))
            }
            Self::Time(near) => near.judge("time", Some(seen.transport.secs)),
            Self::Playing(wanted) => fits(seen.transport.playing == *wanted, || {
                format!("time is {:.3}", seen.transport.secs)
            }),
            Self::Keys(wanted) => fits(seen.keys.len() == *wanted, || {
                format!("there are {} keys", seen.keys.len())
            }),
            Self::KeyAt { key, near } => near.judge(
                &format!("key {}", key + 1),
                seen.keys.get(*key).map(|key| key.secs),
            ),
            Self::Label { control, text } => label(seen, *control, text),
            Self::Display { control, text } => {
                let shown = stand.shown(DIAL_BOX).map_err(|error| error.to_string())?;
                let there = shown.labels.get(control).map_or("", String::as_str);
                fits(there == text, || format!("the display shows \"{there}\""))
            }
            Self::Lamp { lamp, on } => {
                let shown = stand.shown(DIAL_BOX).map_err(|error| error.to_string())?;
                fits((shown.lamps >> lamp & 1 == 1) == *on, || {
                    format!("lit are {:#010x}", shown.lamps)
                })
            }
            Self::Note(text) => fits(seen.notes.iter().any(|note| note.text.contains(text)), || {
                let last = seen.notes.last().map_or("none", |note| note.text.as_str());
                format!("no note has it; the last is \"{last}\"")
            }),
            Self::Device { device, health } => device_is(seen, device, *health),
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
            Self::Watchdogs { bus, bound } => {
                let trips = evidence
                    .truths
                    .iter()
                    .filter(|truth| truth.bus == *bus && truth.watchdog_trips > 0);
                bound.judge(
                    &format!("servos of {bus} stopped by their watchdogs"),
                    trips.count() as u64,
                )
            }
        }
    }
}

fn fits(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}

fn joint(words: &mut Words<'_>) -> Parsed<Check> {
    let name = words.text("a joint")?;
    // `walker.elbow_l`: the puppet may be named for the reader.
    let joint = name
        .rsplit_once('.')
        .map_or(name.as_str(), |(_, joint)| joint)
        .to_owned();
    let aspect = match words.one_of(&["is", "measured", "goal", "really"])? {
        0 => Aspect::Measured,
        place => {
            words.expect("is")?;
            [Aspect::Measured, Aspect::Goal, Aspect::Really][place - 1]
        }
    };
    Ok(Check::Joint {
        joint,
        aspect,
        near: Near::parse(words)?,
    })
}

fn link(words: &mut Words<'_>) -> Parsed<Check> {
    let link = words.text("a link")?;
    let which = words.one_of(&["end", "start", "is"])?;
    if which == 2 {
        words.expect("selected")?;
        return Ok(Check::LinkSelected { link });
    }
    words.expect("near")?;
    let mut at = [0.0; 3];
    for (axis, name) in at.iter_mut().zip(["x", "y", "z"]) {
        *axis = words.any_number(name)?;
    }
    words.expect("within")?;
    let within = words.number("a distance in metres", 0.0..=f64::MAX)?;
    Ok(Check::LinkAt {
        link,
        end: which == 0,
        at,
        within,
    })
}

/// Displays and labels are counted dials first, then keys.
fn control(words: &mut Words<'_>, verb: &str) -> Parsed<(u8, String)> {
    let control = match words.one_of(&["dial", "key"])? {
        0 => words.whole("a dial", 1..=8)? - 1,
        _ => words.whole("a key", 1..=12)? + 7,
    };
    words.expect(verb)?;
    Ok((control as u8, words.quoted("a text")?))
}

fn torque(words: &mut Words<'_>) -> Parsed<Check> {
    let joint = if words.take("is") {
        None
    } else {
        words.expect("of")?;
        let joint = words.text("a joint")?;
        words.expect("is")?;
        Some(joint)
    };
    Ok(Check::Torque {
        joint,
        on: words.one_of(&["on", "off"])? == 0,
    })
}

fn conduct(words: &mut Words<'_>) -> Parsed<Conduct> {
    Ok(match words.one_of(&["within", "are", "is", "slower", "stay"])? {
        0 => {
            [Conduct::Limits, Conduct::Range, Conduct::Speed][words.one_of(&["limits", "range", "speed"])?]
        }
        1 | 2 => {
            words.expect("still")?;
            Conduct::Still
        }
        3 => {
            words.expect("than")?;
            Conduct::SlowerThan(words.number("radians a second", 0.0..=f64::MAX)?)
        }
        _ => {
            words.expect("within")?;
            let rad = words.number("radians", 0.0..=f64::MAX)?;
            for word in ["of", "the", "mark"] {
                words.expect(word)?;
            }
            Conduct::NearMark(rad)
        }
    })
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

fn label(seen: &Snapshot, control: u8, text: &str) -> Result<(), String> {
    let dials = seen.desk.dials.iter().map(|dial| &dial.label);
    let mut labels = dials.chain(seen.desk.keys.iter().map(|key| &key.label));
    let there = labels.nth(usize::from(control)).map_or("", String::as_str);
    fits(there == text, || format!("the label is \"{there}\""))
}

fn device_is(seen: &Snapshot, name: &str, health: DeviceHealth) -> Result<(), String> {
    let device = seen.devices.iter().find(|device| device.name == name);
    let device = device.ok_or_else(|| format!("the rig has no input device {name}"))?;
    let found = HEALTHS
        .iter()
        .find(|(_, known)| *known == device.health)
        .map_or("", |(name, _)| name);
    fits(device.health == health, || format!("{name} is {found}"))
}

fn torque_is(evidence: &Evidence<'_>, joint: Option<&str>, on: bool) -> Result<(), String> {
    for truth in chosen(evidence.truths, joint)? {
        fits(truth.torque == on, || {
            format!(
                "torque of {} is {}",
                truth.joint,
                if truth.torque { "on" } else { "off" }
            )
        })?;
    }
    Ok(())
}

fn chosen<'a>(
    truths: &'a [JointTruth],
    joint: Option<&'a str>,
) -> Result<impl Iterator<Item = &'a JointTruth>, String> {
    let mut all = truths
        .iter()
        .filter(move |truth| joint.is_none_or(|joint| truth.joint == joint))
        .peekable();
    match (all.peek(), joint) {
        (None, Some(joint)) => Err(format!("there is no joint {joint}")),
        (None, None) => Err("there is no puppet".to_owned()),
        _ => Ok(all),
    }
}

fn servos(evidence: &Evidence<'_>, joint: Option<&str>, conduct: Conduct) -> Result<(), String> {
    for truth in chosen(evidence.truths, joint)? {
        let name = &truth.joint;
        let speed = truth.velocity_rad_per_s.abs();
        match conduct {
            Conduct::Still => fits(speed <= STILL_RAD_PER_S, || {
                format!("{name} moves at {speed:.3} rad/s")
            })?,
            Conduct::SlowerThan(most) => fits(speed <= most, || format!("{name} moves at {speed:.3} rad/s"))?,
            Conduct::NearMark(most) => {
                let mark = evidence.mark.iter().find(|mark| mark.joint == *name);
                let mark = mark.ok_or("nothing is marked yet")?;
                let off = (truth.position_rad - mark.position_rad).abs();
                fits(off <= most, || format!("{name} is {off:.5} rad from the mark"))?;
            }
            Conduct::Range => range(truth)?,
            Conduct::Speed => speed_limit(truth)?,
            Conduct::Limits => {
                range(truth)?;
                speed_limit(truth)?;
                accel_limit(truth, evidence.past)?;
            }
        }
    }
    Ok(())
}

fn range(truth: &JointTruth) -> Result<(), String> {
    let [min, max] = truth.range_rad;
    let inside = (min - RANGE_SLACK_RAD..=max + RANGE_SLACK_RAD).contains(&truth.position_rad);
    // What a hand or gravity does to a joint without torque is not the rig's doing.
    fits(inside || !truth.torque, || {
        format!(
            "{} is at {:.4} rad, outside {min} to {max}",
            truth.joint, truth.position_rad
        )
    })
}

fn speed_limit(truth: &JointTruth) -> Result<(), String> {
    let speed = truth.velocity_rad_per_s.abs();
    fits(
        speed <= truth.speed_max_rad_per_s * SPEED_SLACK || !truth.torque,
        || {
            format!(
                "{} moves at {speed:.3} rad/s, its limit is {}",
                truth.joint, truth.speed_max_rad_per_s
            )
        },
    )
}

/// From three places in a row, so that the ripple within a cycle does not count.
fn accel_limit(truth: &JointTruth, past: [&[JointTruth]; 2]) -> Result<(), String> {
    let at = |truths: &'_ [JointTruth]| truths.iter().find(|there| there.joint == truth.joint).cloned();
    let (Some(before), Some(first)) = (at(past[0]), at(past[1])) else {
        return Ok(());
    };
    let bend_rad = truth.position_rad - 2.0 * before.position_rad + first.position_rad;
    let change = bend_rad.abs() / PERIOD.as_secs_f64().powi(2);
    let judged = truth.torque && before.torque && first.torque;
    fits(
        change <= truth.accel_max_rad_per_s2 * ACCEL_SLACK || !judged,
        || {
            format!(
                "{} gains {change:.1} rad/s2, its limit is {}",
                truth.joint, truth.accel_max_rad_per_s2
            )
        },
    )
}
