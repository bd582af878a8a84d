//! From words to expectations.

use super::{
    Aspect, Bound, COUNTERS, Check, Conduct, EVENTS, HEALTHS, Near, SHAFT_PARTS, STATES, SUBJECTS, VIEW_PARTS,
};
use crate::scenario::calibrating::Calibrated;
use crate::scenario::controls::{self, Said};
use crate::scenario::input;
use crate::scenario::words::{Parsed, Words};

impl Near {
    fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        let wanted = words.angle("a value")?;
        words.expect("within")?;
        let within = words.number("a tolerance", 0.0..=f64::MAX)?;
        let within = words.in_unit(within);
        let hil_within = if words.take("hil") {
            words.expect("within")?;
            let within = words.number("a tolerance", 0.0..=f64::MAX)?;
            Some(words.in_unit(within))
        } else {
            None
        };
        Ok(Self {
            wanted,
            within,
            hil_within,
        })
    }
}

impl Bound {
    pub(in crate::scenario) fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        words.expect("at")?;
        let least = words.one_of(&["least", "most"])? == 0;
        let count = words.whole("a count", 0..=u64::from(u32::MAX))?;
        Ok(if least {
            Self::AtLeast(count)
        } else {
            Self::AtMost(count)
        })
    }
}

/// Of a puppet's joint, or of the control that is being calibrated.
fn calibration(words: &mut Words<'_>) -> Parsed<Check> {
    if words.take("says") {
        return Ok(Check::Said(Said::Words(words.quoted("words of it")?)));
    }
    if words.take("is") {
        let under_way = words.one_of(&["under-way", "over"])? == 0;
        return Ok(Check::Said(Said::UnderWay(under_way)));
    }
    Calibrated::parse(words).map(Check::Calibrated)
}

impl Check {
    /// Reads an expectation up to the end of the line.
    pub(in crate::scenario) fn parse(words: &mut Words<'_>) -> Parsed<Self> {
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
            _ => Self::parse_device(subject, words),
        }
    }

    /// Expectations of devices, servos and the rest.
    fn parse_device(subject: &str, words: &mut Words<'_>) -> Parsed<Self> {
        match subject {
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
            "output" => input::output(words),
            "device" => {
                let device = words.text("a device")?;
                if !words.take("is") {
                    return input::of_device(words).map(|check| Self::Input(device, check));
                }
                let place = words.one_of(&HEALTHS.map(|(name, _)| name))?;
                Ok(Self::Device {
                    device,
                    health: HEALTHS[place].1.clone(),
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
            "calibration" => calibration(words),
            "control" => {
                let (number, device) = controls::control(words)?;
                words.expect("is")?;
                let near = Near::parse(words)?;
                Ok(Self::Control { device, number, near })
            }
            "torque" => torque(words),
            "shaft" | "register" | "life" => truth(subject, words),
            "servos" => conduct(words).map(|conduct| Self::Servos { joint: None, conduct }),
            _ => {
                let joint = Some(words.text("a joint")?);
                conduct(words).map(|conduct| Self::Servos { joint, conduct })
            }
        }
    }
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

/// What no byte on a wire tells: shafts, memories, lives.
fn truth(subject: &str, words: &mut Words<'_>) -> Parsed<Check> {
    if subject == "shaft" {
        let joint = words.text("a joint")?;
        let part = SHAFT_PARTS[words.one_of(&SHAFT_PARTS.map(|(name, _)| name))?].1;
        words.expect("is")?;
        let near = Near::parse(words)?;
        return Ok(Check::Shaft { joint, part, near });
    }
    if subject == "life" {
        words.expect("of")?;
        let joint = words.text("a joint")?;
        let event = words.one_of(&EVENTS)?;
        let bound = Bound::parse(words)?;
        return Ok(Check::Life { joint, event, bound });
    }
    let unknown = words.wrong("a register's role such as homing-offset");
    let role = words.text("a register's role")?.parse().map_err(|_| unknown)?;
    words.expect("of")?;
    let joint = words.text("a joint")?;
    words.expect("is")?;
    let wanted = words.any_number("a value")?;
    let within = if words.take("within") {
        words.number("a tolerance", 0.0..=f64::MAX)?
    } else {
        0.0
    };
    let near = Near {
        wanted,
        within,
        hil_within: None,
    };
    Ok(Check::Register { joint, role, near })
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
