//! Which address means which control, and where what is shown goes.
//!
//! Addresses are taken literally: what a controller sends has no patterns in it. Of a group, `{n}` stands for the number
//! from 1; without it the group's controls are the message's arguments, one after the other, as of an xy pad.

use device_profiles::{ControlClass, InputProfile, OutputKind};
use std::collections::BTreeMap;

/// TouchOSC says at this address whether a finger is on a control.
const TOUCH: &str = "/z";

/// What one argument is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    Axis(u16),
    Button(u16),
    Dial(u16),
    Ring(u16),
    Touch(u16),
}

/// Both directions of one profile.
#[derive(Debug, Default)]
pub(super) struct Addresses {
    heard: BTreeMap<String, Vec<Meaning>>,
    outputs: BTreeMap<(OutputKind, u16), String>,
    counts: BTreeMap<OutputKind, u16>,
}

impl Addresses {
    pub(super) fn new(profile: &InputProfile) -> Self {
        let mut addresses = Self::default();
        let mut next = [0u16; 4];
        for control in &profile.controls {
            let class = control.kind.class();
            let first = &mut next[class as usize];
            if let Some(pattern) = &control.address {
                for n in 0..control.count {
                    let number = first.saturating_add(n);
                    addresses.listen(class, number, &numbered(pattern, n));
                }
            }
            *first = first.saturating_add(control.count);
        }
        addresses.find_outputs(profile);
        addresses
    }

    fn listen(&mut self, class: ControlClass, number: u16, address: &str) {
        let meaning = match class {
            ControlClass::Axis => Meaning::Axis(number),
            ControlClass::Button => Meaning::Button(number),
            ControlClass::Dial => Meaning::Dial(number),
            ControlClass::Ring => Meaning::Ring(number),
        };
        self.heard.entry(address.to_owned()).or_default().push(meaning);
        if class == ControlClass::Axis {
            let touch = self.heard.entry(format!("{address}{TOUCH}")).or_default();
            // A pad's two axes have one finger.
            touch.push(Meaning::Touch(number));
            touch.truncate(1);
        }
    }

    /// Motors are numbered as the axes they move, everything else in the order of the file.
    fn find_outputs(&mut self, profile: &InputProfile) {
        for output in &profile.outputs {
            let next = self.counts.entry(output.kind).or_default();
            let mut first = *next;
            *next = next.saturating_add(output.count);
            if output.kind == OutputKind::Motor
                && let Some(of) = &output.of
            {
                let mut axes = profile.numbered(ControlClass::Axis);
                first = axes
                    .find(|(_, axis)| &axis.name == of)
                    .map_or(first, |(axis, _)| axis);
            }
            if let Some(pattern) = &output.address {
                for n in 0..output.count {
                    let number = first.saturating_add(n);
                    self.outputs.insert((output.kind, number), numbered(pattern, n));
                }
            }
        }
        // An axis is set at the address at which it is heard, unless the profile says otherwise; a pad of two axes
        // would want both numbers at once.
        for (axis, control) in profile.numbered(ControlClass::Axis) {
            if let Some(pattern) = &control.address
                && (pattern.contains("{n}") || control.count == 1)
            {
                let first = first_of_group(profile, axis);
                let address = numbered(pattern, axis.saturating_sub(first));
                self.outputs.entry((OutputKind::Motor, axis)).or_insert(address);
            }
        }
    }

    /// What the arguments of a message to `address` mean, in order.
    pub(super) fn of(&self, address: &str) -> Option<&[Meaning]> {
        self.heard.get(address).map(Vec::as_slice)
    }

    /// Where output `number` of a kind is shown.
    pub(super) fn output(&self, kind: OutputKind, number: u16) -> Option<&str> {
        self.outputs.get(&(kind, number)).map(String::as_str)
    }

    /// How many outputs of a kind the profile has.
    pub(super) fn count(&self, kind: OutputKind) -> u16 {
        self.counts.get(&kind).copied().unwrap_or(0)
    }
}

/// The first axis of the group that `axis` belongs to.
fn first_of_group(profile: &InputProfile, axis: u16) -> u16 {
    let mut first = 0u16;
    for control in profile
        .controls
        .iter()
        .filter(|c| c.kind.class() == ControlClass::Axis)
    {
        let end = first.saturating_add(control.count);
        if axis < end {
            break;
        }
        first = end;
    }
    first
}

fn numbered(pattern: &str, n: u16) -> String {
    pattern.replace("{n}", &(u32::from(n) + 1).to_string())
}
