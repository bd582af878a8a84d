//! The devices every machine has: what the hands send, and the labels, lamps and lines they read.
//!
//! Ordinary names to connect to; commands cannot redefine or delete them, so that the host can rely on
//! them. Source: `docs/protocols/ps300.md`, "Initial structure: device function instances".

use crate::intrinsic::{Confidence, InputSpec, OutputSpec, PICK, Preset, Spec};
use crate::value::{Kind, Kinds};

const VECTOR2: OutputSpec = OutputSpec::of(Kinds::of(&[Kind::Vector2]));
const REAL: OutputSpec = OutputSpec::of(Kinds::REAL);
const INTEGER: OutputSpec = OutputSpec::of(Kinds::INTEGER);
const BOOLEAN: OutputSpec = OutputSpec::of(Kinds::BOOLEAN);
const STRING: OutputSpec = OutputSpec::of(Kinds::STRING);

macro_rules! device {
    ($name:literal, $outputs:expr, $behaviour:literal, $source:literal, $confidence:ident) => {
        Spec::pure($name, &[], $outputs, |_, _| Ok(()))
            .says($behaviour)
            .known(Confidence::$confidence, $source)
    };
}

/// What sends: nothing goes in, the host emits.
pub static SOURCES: [Spec; 10] = [
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
    PICK,
    Spec::pure(
        "PICK_LOCATION",
        &[
            InputSpec::constant(VECTOR2.kinds, Preset::Rule("where the tablet is")),
            InputSpec::constant(VECTOR2.kinds, Preset::Rule("V2D(0.01,0.01)")),
        ],
        &[],
        |_, _| Ok(()),
    )
    .says("Where PICK looks: <1> the middle of the pick window on the screen of -1 to 1, <2> half its width and height.")
    .known(Confidence::Used, "D0 for <2>; <1> recollected"),
    device!("KEYBOARD", &[STRING], "What was typed.", "recollected", High),
    device!(
        "KBHANDLER",
        &[STRING, STRING, STRING, STRING],
        "<4> what was typed, as D0 takes it; <1> to <3> not known, silent.",
        "D0 for output 4; that the others are strings ours",
        Used
    ),
    device!(
        "SPECKEYS",
        &[OutputSpec::of(Kinds::INTEGER.or(Kinds::STRING))],
        "The special keys of the keyboard. Which sent what is not on record.",
        "recollected",
        Low
    ),
    Spec::pure(
        "MEMORY_MONITOR",
        &[InputSpec::constant(Kinds::ANY, Preset::Required); 3],
        &[INTEGER],
        |_, _| Ok(()),
    )
    .says("Reported the use of memory. Takes anything and stays silent: memory is the host's affair.")
    .known(
        Confidence::Used,
        "D0 sends an integer to <3>; its meaning, and the report's, not known",
    ),
];

/// What a display reads: name, input, meaning.
pub struct Readout {
    /// Without number.
    pub name: &'static str,
    /// Numbers that follow the name, if there are several.
    pub numbers: Option<(u8, u8)>,
    /// What its inputs take, from <1>.
    pub inputs: &'static [Kinds],
    /// What it shows.
    pub behaviour: &'static str,
    pub(super) shows: Shows,
}

impl Readout {
    /// The names of all it stands for: `DLABEL1` to `DLABEL8`.
    pub fn names(&self) -> impl Iterator<Item = String> {
        let name = self.name;
        let numbered = self.numbers.map(|(first, last)| first..=last);
        let alone = numbered.is_none().then(|| name.to_owned());
        numbered
            .into_iter()
            .flatten()
            .map(move |number| format!("{name}{number}"))
            .chain(alone)
    }
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
    Terminal,
    /// A line of the terminal, with the name of the readout before it.
    Notice,
    /// Nothing; the message is taken all the same, so that programs of the time run.
    Nothing,
}

/// What receives: the host shows it.
pub static READOUTS: [Readout; 16] = [
    Readout {
        name: "DLABEL",
        numbers: Some((1, 8)),
        inputs: &[Kinds::STRING],
        behaviour: "The label of a dial, eight characters.",
        shows: Shows::DialLabel,
    },
    Readout {
        name: "FLABEL",
        numbers: Some((0, 12)),
        inputs: &[Kinds::STRING],
        behaviour: "The label of a function key, eight characters; FLABEL0 the whole row, ninety-six.",
        shows: Shows::KeyLabel,
    },
    Readout {
        name: "CLEAR_LABELS",
        numbers: None,
        inputs: &[Kinds::BOOLEAN],
        behaviour: "TRUE blanks all labels.",
        shows: Shows::ClearLabels,
    },
    Readout {
        name: "ONBUTTONLIGHTS",
        numbers: None,
        inputs: &[Kinds::INTEGER],
        behaviour: "Lights a button, 1 to 32; 0 lights all.",
        shows: Shows::LampsOn,
    },
    Readout {
        name: "OFFBUTTONLIGHTS",
        numbers: None,
        inputs: &[Kinds::INTEGER],
        behaviour: "Extinguishes a button, 1 to 32; 0 extinguishes all.",
        shows: Shows::LampsOff,
    },
    Readout {
        name: "MESSAGE_DISPLAY",
        numbers: None,
        inputs: &[Kinds::STRING],
        behaviour: "The message line of the screen.",
        shows: Shows::Message,
    },
    Readout {
        name: "ES_TE",
        numbers: None,
        inputs: &[Kinds::STRING],
        behaviour: "The terminal: 24 lines of 80 characters. Carriage return, line feed, backspace, and ANSI's ESC[H, \
                    ESC[J and ESC[K are obeyed, other sequences left out.",
        shows: Shows::Terminal,
    },
    notice("INFORMATION"),
    notice("WARNING"),
    notice("ERROR"),
    notice("MEMORY_ALERT"),
    Readout {
        name: "HOST_MESSAGE",
        numbers: None,
        inputs: &[Kinds::STRING],
        behaviour: "A line for the program of the host, which takes it with the messages of its own inputs; \
                    `dialrig net run --watch 'HOST_MESSAGE<1>'` prints it.",
        shows: Shows::Nothing,
    },
    Readout {
        name: "DSET",
        numbers: Some((1, 8)),
        inputs: &[Kinds::ANY; 4],
        behaviour: "How a dial was sampled. Taken and without effect: which input set what is not on record.",
        shows: Shows::Nothing,
    },
    Readout {
        name: "TABLETOUT",
        numbers: None,
        inputs: &[Kinds::ANY; 4],
        behaviour: "How the tablet worked. Taken and without effect: which input set what is not on record.",
        shows: Shows::Nothing,
    },
    Readout {
        name: "TURNONDISPLAY",
        numbers: None,
        inputs: &[Kinds::ANY],
        behaviour: "Went back from a still, shaded picture to the live one. Taken and without effect: here every \
                    picture is live.",
        shows: Shows::Nothing,
    },
    Readout {
        name: "SHADINGENVIRONMENT",
        numbers: None,
        inputs: &[Kinds::ANY; 15],
        behaviour: "What held for all shaded pictures: light, background, smoothing. Taken and without effect: of \
                    most inputs the meaning is not on record.",
        shows: Shows::Nothing,
    },
];

const fn notice(name: &'static str) -> Readout {
    Readout {
        name,
        numbers: None,
        inputs: &[Kinds::STRING],
        behaviour: "A line on the terminal, with this name before it.",
        shows: Shows::Notice,
    }
}
