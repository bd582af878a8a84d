//! The front panel: labels, lamps and message line as the network has left them.
//!
//! Source: `docs/protocols/ps300.md`, "Initial structure: device function instances".

use super::devices::{READOUTS, Shows};
use super::terminal::Terminal;
use crate::language::Name;
use crate::names::{Names, Thing};
use crate::network::{Network, SinkId};
use crate::value::Value;

/// Characters of one label; longer texts are cut.
pub const LABEL_CHARACTERS: usize = 8;

/// What the user reads besides the picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Panel {
    /// Above dials 1 to 8, [`LABEL_CHARACTERS`] at most each.
    pub dial_labels: [String; 8],
    /// Above function keys 1 to 12, [`LABEL_CHARACTERS`] at most each.
    pub key_labels: [String; 12],
    /// Lighted buttons; bit 0 is button 1.
    pub lamps: u32,
    /// The message line.
    pub message: String,
    /// What the terminal shows.
    pub terminal: Terminal,
    /// Counts changes, so that a host can tell whether to look.
    pub revision: u64,
}

/// The built-in sinks in the order they were made, which is their `SinkId`.
pub(super) struct Readouts {
    shows: Vec<(Shows, u8, &'static str)>,
}

impl Readouts {
    pub(super) fn install(network: &mut Network, names: &mut Names) -> Self {
        let mut shows = Vec::new();
        for readout in &READOUTS {
            let first = readout.numbers.map_or(0, |(first, _)| first);
            for (number, name) in (first..).zip(readout.names()) {
                let name = Name::new(&name);
                let id = network.add_sink(name.clone(), readout.inputs);
                names.fix(&name, Thing::Sink(id));
                shows.push((readout.shows, number, readout.name));
            }
        }
        Self { shows }
    }

    /// Whether a sink is one of these rather than the host's.
    pub(super) fn has(&self, sink: SinkId) -> bool {
        (sink.0 as usize) < self.shows.len()
    }

    /// Lets the panel show a message that reached one of the built-in sinks.
    pub(super) fn show(&self, panel: &mut Panel, sink: SinkId, value: &Value) {
        let Some(&(shows, number, name)) = self.shows.get(sink.0 as usize) else {
            return;
        };
        if shows == Shows::Nothing {
            return;
        }
        panel.revision += 1;
        match (shows, value) {
            (Shows::DialLabel, Value::String(text)) => label(&mut panel.dial_labels, number, text),
            (Shows::KeyLabel, Value::String(text)) if number == 0 => {
                let mut characters = text.chars();
                for label in &mut panel.key_labels {
                    *label = characters.by_ref().take(LABEL_CHARACTERS).collect();
                }
            }
            (Shows::KeyLabel, Value::String(text)) => label(&mut panel.key_labels, number, text),
            (Shows::ClearLabels, Value::Boolean(true)) => {
                panel
                    .dial_labels
                    .iter_mut()
                    .chain(&mut panel.key_labels)
                    .for_each(String::clear);
            }
            (Shows::LampsOn, Value::Integer(button)) => panel.lamps |= lamps(*button),
            (Shows::LampsOff, Value::Integer(button)) => panel.lamps &= !lamps(*button),
            (Shows::Message, Value::String(text)) => text.as_ref().clone_into(&mut panel.message),
            (Shows::Terminal, Value::String(text)) => panel.terminal.write(text),
            (Shows::Notice, Value::String(text)) => {
                for part in [name, ": ", text, "\r\n"] {
                    panel.terminal.write(part);
                }
            }
            _ => {}
        }
    }
}

fn label(labels: &mut [String], number: u8, text: &str) {
    if let Some(label) = labels.get_mut(usize::from(number).wrapping_sub(1)) {
        label.clear();
        label.extend(text.chars().take(LABEL_CHARACTERS));
    }
}

/// The lamps a number means: 0 all, 1 to 32 one, others none.
fn lamps(button: i32) -> u32 {
    match button {
        0 => u32::MAX,
        1..=32 => 1 << (button - 1),
        _ => 0,
    }
}
