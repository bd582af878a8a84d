//! Knob boxes: how many of what, and what a count of a dial is worth.

use crate::Status;
use crate::read::{Check, Flaw};
use serde::{Deserialize, Serialize};

/// One dial and button box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnobsProfile {
    /// The file's name without its ending; what programs ask for.
    #[serde(skip)]
    pub key: String,
    /// What people call it.
    pub name: String,
    /// How far it was tried.
    pub status: Status,
    /// Wire format: the name of a page in `docs/protocols/`.
    pub format: String,
    /// Where the numbers are from.
    pub source: String,
    /// Line speed.
    pub baud: u32,
    /// Number of dials, numbered from 0.
    pub dials: u8,
    /// Number of buttons, numbered from 0.
    pub buttons: u8,
    /// Number of lamps, numbered from 0, in the buttons.
    pub lamps: u8,
    /// Counts in one turn of a dial.
    pub counts_per_turn: u32,
    /// Whether initialising sets the counts to 0, so that the first report is itself a turn.
    /// Otherwise the first report only says where the dial stands.
    pub counts_start_at_zero: bool,
    /// Text displays; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub labels: Option<Labels>,
}

/// The displays beside dials and keys: controls `0..dials` are dials, those after them keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Labels {
    /// Displays of dials, controls `0..dials`.
    pub dials: u8,
    /// Displays of keys, controls `dials..dials + keys`.
    pub keys: u8,
    /// Characters on each.
    pub characters: u8,
}

impl KnobsProfile {
    /// Radians of the dial for one count.
    pub fn rad_per_count(&self) -> f64 {
        std::f64::consts::TAU / f64::from(self.counts_per_turn)
    }
}

impl Check for KnobsProfile {
    fn flaws(&self, flaws: &mut Vec<Flaw>) {
        if self.counts_per_turn == 0 {
            flaws.push(Flaw::at_key(
                "counts_per_turn",
                "counts_per_turn must be at least 1, found 0",
            ));
        }
        // The format has four bits for a dial and 32 for buttons and lamps.
        for (key, found, most) in [
            ("dials", self.dials, 16),
            ("buttons", self.buttons, 32),
            ("lamps", self.lamps, 32),
        ] {
            if found > most {
                flaws.push(Flaw::at_key(
                    key,
                    format!("{key} must be at most {most}, found {found}"),
                ));
            }
        }
    }
}
