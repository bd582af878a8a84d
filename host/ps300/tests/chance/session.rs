//! What a host does to a machine, one thing after another, and all that comes out.

use super::commands::{LITERALS, LIVELY, NAMES, REMEMBERING, anything, example, link};
use super::edits::Edits;
use super::{Dice, pick};
use ps300::language::Input;
use ps300::network::Watched;
use ps300::{Kinds, Limits, Machine, Report, Value};

/// Things done in one session: more of them find nothing that fewer do not.
const ACTS_MAX: usize = 96;
const BYTES_AN_ACT: usize = 1 + size_of::<Dice>();
const SECS_A_TICK: f64 = 1.0 / 32.0;

/// Every device, with more outputs than it has.
const DEVICES: [(&str, u8); 7] = [
    ("DIALS", 9),
    ("FKEYS", 2),
    ("BUTTONSIN", 2),
    ("TABLETIN", 7),
    ("KEYBOARD", 2),
    ("box", 3),
    (LATE, 3),
];

/// A device that comes in the middle of a session, if at all.
pub(crate) const LATE: &str = "box2";

/// What joins the names to the host, as far as they are functions.
const TO_THE_HOST: &str = "CONNECT a<1>:<1>host; CONNECT b<1>:<2>host; CONNECT e_1<1>:<1>host;
    CONNECT s<1>:<1>host; CONNECT D<1>:<1>DLABEL1; CONNECT c<1>:<1>ONBUTTONLIGHTS;";

/// One thing that a host does.
#[derive(Clone, Debug)]
pub(crate) enum Act {
    /// Commands.
    Load(String),
    /// A device sends.
    Emit {
        device: &'static str,
        output: u8,
        value: Value,
    },
    /// The host sends.
    Send {
        name: &'static str,
        input: u16,
        value: Value,
    },
    /// Time passes, and the network may fire so often.
    Tick { firings_max: u32 },
    /// It may fire so often again.
    GoOn { firings_max: u32 },
    /// Commands that may be taken back.
    Edit(String),
    /// A device comes and is connected.
    Declare(String),
    /// Takes the last edit back.
    Undo,
    /// Makes it again.
    Redo,
}

impl Act {
    /// Whether it is told to a network as it stands, and changes nothing in what there is.
    pub(crate) fn is_a_message(&self) -> bool {
        matches!(
            self,
            Self::Emit { .. } | Self::Send { .. } | Self::Tick { .. } | Self::GoOn { .. }
        )
    }
}

/// Bounds so narrow that sessions meet them.
pub(crate) fn limits() -> Limits {
    Limits {
        queue_max: 8,
        behind_max: 64,
        firings_per_batch: 60,
        firings_per_command: 200,
        ..Limits::default()
    }
}

/// A machine before a session.
pub(crate) fn machine() -> Machine {
    let mut machine = Machine::with_limits(limits());
    let declared = machine.declare_sink("host", &[Kinds::ANY, Kinds::NUMBER]);
    assert!(declared.is_ok(), "{declared:?}");
    declare(&mut machine, "box");
    machine
}

/// The same, with what has come in the course of a session.
pub(crate) fn machine_like(of: &Machine) -> Machine {
    let mut machine = machine();
    if of.is_defined(LATE) {
        declare(&mut machine, LATE);
    }
    machine
}

fn declare(machine: &mut Machine, name: &str) {
    let declared = machine.declare_source(name, &[Kinds::REAL, Kinds::ANY]);
    assert!(declared.is_ok(), "{declared:?}");
}

/// The session that some bytes say.
pub(crate) fn acts(bytes: &[u8]) -> Vec<Act> {
    bytes.chunks(BYTES_AN_ACT).take(ACTS_MAX).map(act).collect()
}

fn act(bytes: &[u8]) -> Act {
    let mut padded = [0; BYTES_AN_ACT];
    padded[..bytes.len()].copy_from_slice(bytes);
    let [kind, dice @ ..] = padded;
    match kind % 32 {
        0..4 => Act::Load(anything(dice)),
        4..6 => Act::Load(format!(
            "{} := F:{};",
            pick(&NAMES, dice[0]),
            pick(&LIVELY, dice[1])
        )),
        6 => Act::Load(format!(
            "{} := F:{};",
            pick(&NAMES, dice[0]),
            pick(&REMEMBERING, dice[1])
        )),
        7..10 => Act::Load(link(dice)),
        10 => Act::Load(TO_THE_HOST.to_owned()),
        11 => Act::Load(format!(
            "SEND {} TO <{}>{};",
            pick(&LITERALS, dice[0]),
            1 + dice[1] % 4,
            pick(&NAMES, dice[2])
        )),
        12..15 => {
            let (device, outputs) = DEVICES[usize::from(dice[0]) % DEVICES.len()];
            Act::Emit {
                device,
                output: 1 + dice[1] % outputs,
                value: value(dice),
            }
        }
        15 => Act::Send {
            name: pick(&NAMES, dice[0]),
            input: u16::from(dice[1] % 4),
            value: value(dice),
        },
        16..20 => Act::Load(example(dice)),
        24 | 25 => Act::Edit(link(dice)),
        26 => Act::Edit(anything(dice)),
        27 => Act::Edit(example(dice)),
        28 | 29 => Act::Undo,
        30 => Act::Redo,
        21 => Act::Declare(link(dice).replace("DIALS", LATE)),
        20 => Act::GoOn {
            firings_max: u32::from(dice[0]),
        },
        _ => Act::Tick {
            firings_max: u32::from(dice[0] % 64),
        },
    }
}

fn value(dice: Dice) -> Value {
    let number = 0.125 * f64::from(i16::from_le_bytes([dice[3], dice[4]]));
    match dice[5] % 8 {
        0 => Value::Boolean(dice[3] > 127),
        1 => Value::Integer(i32::from(dice[3]) - 9),
        2 => Value::from("text"),
        3 => Value::Vector2(glam::DVec2::new(number, 1.0)),
        4 => Value::Vector3(glam::DVec3::new(number, 1.0, -1.0)),
        _ => Value::Real(number),
    }
}

/// All that left a network.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Heard {
    watched: Vec<Watched>,
    arrived: Vec<(String, u8, Value)>,
    reports: Vec<String>,
}

/// A machine in a session.
pub(crate) struct Play {
    pub(crate) machine: Machine,
    pub(crate) heard: Heard,
    ticks: u64,
    pub(crate) edits: Edits,
}

impl Play {
    /// A session with a new machine that has seen so many ticks.
    pub(crate) fn at(ticks: u64) -> Self {
        let mut play = Self {
            machine: machine(),
            heard: Heard::default(),
            ticks: 0,
            edits: Edits::default(),
        };
        (0..ticks).for_each(|_| play.tick(0));
        play
    }

    /// The same, with the devices that have come.
    pub(crate) fn like(of: &Self) -> Self {
        let mut play = Self::at(of.ticks());
        if of.machine.is_defined(LATE) {
            declare(&mut play.machine, LATE);
        }
        play
    }

    /// How many ticks its machine has seen.
    pub(crate) fn ticks(&self) -> u64 {
        self.ticks
    }

    fn tick(&mut self, firings_max: u32) {
        self.ticks += 1;
        let secs = self.ticks as f64 * SECS_A_TICK;
        let ran = self.machine.tick(secs, self.ticks, firings_max);
        assert!(ran.firings() <= firings_max, "{ran:?}");
    }

    /// Does one thing. Firings are those the act says, or any number.
    pub(crate) fn act(&mut self, act: &Act, as_said: bool) {
        let firings = |said: u32| if as_said { said } else { u32::MAX };
        match act {
            Act::Load(text) => {
                self.edits.hear(text);
                self.machine.load(text);
                self.watch();
            }
            Act::Emit {
                device,
                output,
                value,
            } => {
                self.machine.emit(device, *output, value.clone());
            }
            Act::Send { name, input, value } => {
                // What is refused is refused in every play.
                let _ = self.machine.send(name, Input::Number(*input), value.clone());
            }
            Act::Tick { firings_max } => self.tick(firings(*firings_max)),
            Act::GoOn { firings_max } => {
                let ran = self.machine.go_on(firings(*firings_max));
                assert!(ran.firings() <= firings(*firings_max), "{ran:?}");
            }
            Act::Declare(text) => {
                declare(&mut self.machine, LATE);
                self.edits.hear(text);
                self.machine.load(text);
                self.watch();
            }
            Act::Edit(text) => {
                self.edits.edit(&mut self.machine, text);
                self.watch();
            }
            Act::Undo => {
                self.edits.undo(&mut self.machine);
                self.watch();
            }
            Act::Redo => {
                self.edits.redo(&mut self.machine);
                self.watch();
            }
        }
    }

    /// Lets what is on its way be over, and takes what came out.
    pub(crate) fn end(&mut self) -> &Heard {
        self.machine.settle();
        let Heard {
            watched,
            arrived,
            reports,
        } = &mut self.heard;
        self.machine
            .drain_sinks(|_, name, input, value| arrived.push((name.to_owned(), input, value)));
        watched.extend(self.machine.drain_watched());
        // Where something was made is another place once its program has been printed.
        let placeless = |mut report: Report| {
            report.made = None;
            report.to_string()
        };
        reports.extend(self.machine.reports().into_iter().map(placeless));
        &self.heard
    }

    /// Drops what came out so far: the text of a panel is sent to it.
    pub(crate) fn forget(&mut self) {
        self.end();
        self.heard = Heard::default();
    }

    /// Watches every output there is.
    pub(crate) fn watch(&mut self) {
        let outputs: Vec<_> = self
            .machine
            .instances()
            .iter()
            .map(|it| (it.name.to_string(), it.outputs.len() as u8))
            .collect();
        for (name, count) in outputs {
            for output in 1..=count {
                self.machine.watch(&name, output);
            }
        }
    }
}

impl Heard {
    /// What each reported trouble says, and that messages are numbers one can go on with.
    pub(crate) fn check(&self) {
        for (name, input, value) in &self.arrived {
            assert!(value.is_finite(), "{name}<{input}> {value:?}");
        }
        for watched in &self.watched {
            assert!(watched.value.is_finite(), "{watched:?}");
        }
        assert!(self.reports.iter().all(|report| !report.is_empty()));
    }
}
