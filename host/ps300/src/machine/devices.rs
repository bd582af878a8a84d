//! The devices every machine has: what the hands send, and the labels, lamps and lines they read.
//!
//! Ordinary names to connect to; commands cannot redefine or delete them, so that the host can rely on
//! them. Source: `docs/protocols/ps300.md`, "Initial structure: device function instances".

use crate::intrinsic::{Confidence, OutputSpec, Spec};
use crate::value::{Kind, Kinds};

const VECTOR2: OutputSpec = OutputSpec::of(Kinds::of(&[Kind::Vector2]));
const REAL: OutputSpec = OutputSpec::of(Kinds::REAL);
const INTEGER: OutputSpec = OutputSpec::of(Kinds::INTEGER);
const BOOLEAN: OutputSpec = OutputSpec::of(Kinds::BOOLEAN);

macro_rules! device {
    ($name:literal, $outputs:expr, $behaviour:literal, $source:literal, $confidence:ident) => {
        Spec::pure($name, &[], $outputs, |_, _| Ok(()))
            .says($behaviour)
            .known(Confidence::$confidence, $source)
    };
}

/// What sends: nothing goes in, the host emits.
pub static SOURCES: [Spec; 5] = [
    device!(
        "DIALS",
        &[REAL, REAL, REAL, REAL, REAL, REAL, REAL, REAL],
        "The movement of each of eight dials since its last message, 1 for a full turn.",
        "D0 dial networks; the unit ours",
        Used
    ),
    device!(
        "FKEYS",
        &[INTEGER],
        "The number of a function key pressed: 1 to 12, with shift 13 to 24, with control 25 to 36.",
        "recollected",
        Medium
    ),
    device!(
        "BUTTONSIN",
        &[INTEGER],
        "The number of a lighted button pressed, 1 to 32.",
        "recollected",
        High
    ),
    device!(
        "TABLETIN",
        &[VECTOR2, BOOLEAN, INTEGER, BOOLEAN, BOOLEAN, VECTOR2],
        "<1> position, -1 to 1 each way; <2> switch closed; <3> the buttons as bits, 0 on release; <4> not known, \
         silent; <5> in proximity; <6> position at a press.",
        "D0 tablet networks",
        Used
    ),
    device!(
        "KEYBOARD",
        &[OutputSpec::of(Kinds::STRING)],
        "What was typed.",
        "recollected",
        High
    ),
];

/// What a display reads: name, input, meaning.
pub struct Readout {
    /// Without number.
    pub name: &'static str,
    /// Numbers that follow the name, if there are several.
    pub numbers: Option<(u8, u8)>,
    /// What its input <1> takes.
    pub kinds: Kinds,
    /// What it shows.
    pub behaviour: &'static str,
    pub(super) shows: Shows,
}

/// What a readout changes on the front panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shows {
    DialLabel,
    KeyLabel,
    ClearLabels,
    LampsOn,
    LampsOff,
    Message,
}

/// What receives: the host shows it.
pub static READOUTS: [Readout; 6] = [
    Readout {
        name: "DLABEL",
        numbers: Some((1, 8)),
        kinds: Kinds::STRING,
        behaviour: "The label of a dial, eight characters.",
        shows: Shows::DialLabel,
    },
    Readout {
        name: "FLABEL",
        numbers: Some((0, 12)),
        kinds: Kinds::STRING,
        behaviour: "The label of a function key, eight characters; FLABEL0 the whole row, ninety-six.",
        shows: Shows::KeyLabel,
    },
    Readout {
        name: "CLEAR_LABELS",
        numbers: None,
        kinds: Kinds::BOOLEAN,
        behaviour: "TRUE blanks all labels.",
        shows: Shows::ClearLabels,
    },
    Readout {
        name: "ONBUTTONLIGHTS",
        numbers: None,
        kinds: Kinds::INTEGER,
        behaviour: "Lights a button, 1 to 32; 0 lights all.",
        shows: Shows::LampsOn,
    },
    Readout {
        name: "OFFBUTTONLIGHTS",
        numbers: None,
        kinds: Kinds::INTEGER,
        behaviour: "Extinguishes a button, 1 to 32; 0 extinguishes all.",
        shows: Shows::LampsOff,
    },
    Readout {
        name: "MESSAGE_DISPLAY",
        numbers: None,
        kinds: Kinds::STRING,
        behaviour: "The message line of the screen.",
        shows: Shows::Message,
    },
];
