//! Input devices in a scenario: hands on any of them, what they sent into the network, what they show and count.

use ps300::Value;
use rig::{Command, Snapshot};

use super::check::{Bound, Check, Evidence};
use super::doing::Doing;
use super::words::{Flaw, Parsed, Words};
use super::{Line, What};
use firmware_sim::script;

/// How far a number may be off where nobody says: what is left of an exact value in the arithmetic of a double.
const EXACT: f64 = 1e-9;
/// What a device counts.
const COUNTS: [&str; 3] = ["events", "rejected", "dropped"];

/// `touch NAME WORDS`: what a hand does, in the words of scripts.
pub(super) fn touch(words: &mut Words<'_>) -> Parsed<Doing> {
    let device = words.text("a device")?;
    let column = words.column();
    let text = words.rest("what a hand does, as in scripts")?;
    let touch = script::touch(text).map_err(|error| Flaw {
        column: column + error.column - 1,
        message: error.message,
    })?;
    Ok(Doing::Touch { device, touch })
}

/// An output of the network, `NAME<n>`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Outlet {
    name: String,
    number: usize,
}

/// What an output is to have sent.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Sent {
    /// Last, these numbers: one, or those of a vector.
    Numbers(Vec<f64>, f64),
    /// Last, this truth.
    Truth(bool),
    /// Last, this text.
    Text(String),
    /// So many messages.
    Count(Bound),
}

/// What is expected of an input device beside its health.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum InputCheck {
    /// Something it shows, or does not.
    Shows(String, bool),
    /// One of [`COUNTS`].
    Counts(usize, Bound),
}

impl Outlet {
    fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        let wrong = words.wrong("an output such as KNOB<1>");
        let word = words.text("an output such as KNOB<1>")?;
        let parts = word.strip_suffix('>').and_then(|word| word.split_once('<'));
        let number = parts
            .and_then(|(_, number)| number.parse().ok())
            .filter(|&number| number > 0);
        match (parts, number) {
            (Some((name, _)), Some(number)) if !name.is_empty() => Ok(Self {
                name: name.to_owned(),
                number,
            }),
            _ => Err(wrong),
        }
    }

    /// What it sent last, and how much it has sent.
    fn look<'a>(&self, seen: &'a Snapshot) -> Result<(Option<&'a Value>, u64), String> {
        let look = seen
            .network
            .as_ref()
            .ok_or("nobody has looked at the network yet")?;
        let mut boxes = look.picture.boxes.iter();
        let there = boxes.find(|there| there.name.to_string() == self.name);
        let there = there.ok_or_else(|| format!("nothing in the network is called {}", self.name))?;
        let place = there.first_output + self.number - 1;
        let output = look
            .activity
            .outputs
            .get(place)
            .filter(|_| self.number <= there.outputs.len());
        let output = output.ok_or_else(|| format!("{} has no output <{}>", self.name, self.number))?;
        Ok((output.last.as_ref(), output.sent))
    }
}

/// `output NAME<n> is 0.5 [y [z]] [within d]`, `is TRUE`, `is "TEXT"`, `sent at least N`.
pub(super) fn output(words: &mut Words<'_>) -> Parsed<Check> {
    let outlet = Outlet::parse(words)?;
    if words.one_of(&["is", "sent"])? == 1 {
        return Ok(Check::Output(outlet, Sent::Count(Bound::parse(words)?)));
    }
    if let Some(text) = words.maybe_quoted() {
        return Ok(Check::Output(outlet, Sent::Text(text)));
    }
    for truth in [true, false] {
        if words.take(if truth { "TRUE" } else { "FALSE" }) {
            return Ok(Check::Output(outlet, Sent::Truth(truth)));
        }
    }
    let mut numbers = Vec::new();
    while numbers.is_empty() || !(words.is_at_end() || words.next_is("within")) {
        numbers.push(words.any_number("a number, TRUE, FALSE or a text")?);
    }
    let within = if words.take("within") {
        words.number("a tolerance", 0.0..=f64::MAX)?
    } else {
        EXACT
    };
    Ok(Check::Output(outlet, Sent::Numbers(numbers, within)))
}

/// What follows `device NAME` when it is not `is`.
pub(super) fn of_device(words: &mut Words<'_>) -> Parsed<InputCheck> {
    let kinds = ["shows", COUNTS[0], COUNTS[1], COUNTS[2]];
    match words.one_of(&kinds)? {
        0 => {
            let shown = !words.take("no");
            Ok(InputCheck::Shows(words.quoted("something it shows")?, shown))
        }
        count => Ok(InputCheck::Counts(count - 1, Bound::parse(words)?)),
    }
}

pub(super) fn judge_output(seen: &Snapshot, outlet: &Outlet, wanted: &Sent) -> Result<(), String> {
    let (last, sent) = outlet.look(seen)?;
    let name = format!("{}<{}>", outlet.name, outlet.number);
    if let Sent::Count(bound) = wanted {
        return bound.judge(&format!("the number of messages from {name}"), sent);
    }
    let last = last.ok_or_else(|| format!("{name} has sent nothing"))?;
    let holds = match (wanted, last) {
        (Sent::Truth(wanted), Value::Boolean(found)) => wanted == found,
        (Sent::Text(wanted), Value::String(found)) => **wanted == **found,
        (Sent::Numbers(wanted, within), found) => numbers(found).is_some_and(|found| {
            let near = |(wanted, found): (&f64, &f64)| (wanted - found).abs() <= *within;
            found.len() == wanted.len() && wanted.iter().zip(&found).all(near)
        }),
        _ => false,
    };
    if holds {
        Ok(())
    } else {
        Err(format!("{name} sent {last:?}"))
    }
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Vector2(vector) => Some(vector.to_array().to_vec()),
        Value::Vector3(vector) => Some(vector.to_array().to_vec()),
        number => number.as_number().map(|number| vec![number]),
    }
}

pub(super) fn judge_device(evidence: &Evidence<'_>, name: &str, check: &InputCheck) -> Result<(), String> {
    match check {
        InputCheck::Shows(what, wanted) => {
            let shown = evidence.stand.shows(name).map_err(|error| error.to_string())?;
            if shown.contains(what) == *wanted {
                return Ok(());
            }
            let all = if shown.is_empty() {
                "nothing".to_owned()
            } else {
                shown.join(", ")
            };
            Err(format!("{name} shows {all}"))
        }
        InputCheck::Counts(which, bound) => {
            let device = evidence.seen.devices.iter().find(|device| device.name == name);
            let device = device.ok_or_else(|| format!("the rig has no input device {name}"))?;
            let count = [device.events, device.rejected, device.dropped][*which];
            bound.judge(&format!("{} of {name}", COUNTS[*which]), count)
        }
    }
}

/// A network in which every output that the scenario speaks of leads somewhere, so that it is in the picture, and the
/// command that has the picture made; nothing where it speaks of none.
pub(super) fn lookout(lines: &[Line]) -> Option<(String, Command)> {
    let outlets = lines.iter().filter_map(|line| match &line.what {
        What::Check(Check::Output(outlet, _)) => Some(outlet),
        _ => None,
    });
    let mut wires: Vec<String> = outlets
        .map(|Outlet { name, number }| {
            let seen = format!("SEEN_{name}_{number}");
            format!("{seen} := F:NOP; CONNECT {name}<{number}>:<1>{seen};\n")
        })
        .collect();
    wires.sort();
    wires.dedup();
    (!wires.is_empty()).then(|| (wires.concat(), Command::LookAtNetwork(true)))
}
