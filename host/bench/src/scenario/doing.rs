//! What can be done in a scenario: hands, cables, orders, faults.

use firmware_sim::hands::{Touch, Turn};
use firmware_sim::{Fault, InputFault};
use rig::{Command, NetworkEdit, PuppetCommand, TransportCommand};

use super::calibrating::Calibrate;
use super::horn::HornHand;
use super::input;
use super::words::{Flaw, Parsed, Words};
use crate::hands::{Movement, Tool};
use crate::stand::HandError;
use crate::world::{DIAL_BOX, TABLET, World};

/// How long a key or button is down, if nobody says otherwise: about as long as a finger needs.
const PRESS_SECS: f64 = 0.08;

/// Words that begin a doing.
pub(super) const VERBS: &[&str] = &[
    "turn",
    "press",
    "hold",
    "release",
    "puck",
    "pen",
    "cursor",
    "slide",
    "plug",
    "unplug",
    "power-cycle",
    "touch",
    "perform",
    "transport",
    "fault",
    "mend",
    "network",
    "undo",
    "redo",
    "stall",
    "push",
    "hand",
    "calibrate",
    "mark",
    "do",
];

/// One doing.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Doing {
    /// A hand on a device.
    Hand(&'static str, Movement),
    /// A hand moves the tool to where the cursor is to be.
    Cursor { to: [f64; 2], over_secs: f64 },
    /// A cable goes in or out.
    Plug { device: String, connected: bool },
    /// A device is switched off and on.
    PowerCycle { device: String },
    /// A hand does something to an input device, in the words of its scripts.
    Touch { device: String, touch: Touch },
    /// The rig is asked.
    Ask(Command),
    /// Something goes wrong on a bus or with an input device.
    Fault { bus: String, text: String },
    /// Everything on a bus is well again.
    Mend { bus: String },
    /// The host sleeps.
    Stall { secs: f64 },
    /// A hand turns a joint.
    Push { joint: String, rad: f64 },
    /// A hand stays on a joint.
    Horn(HornHand),
    /// A puppet is calibrated by hand.
    Calibrate(Calibrate),
    /// Where the servos are is remembered.
    Mark,
}

impl Doing {
    /// Reads a doing up to the end of the line.
    pub(super) fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        let column = words.column();
        let verb = VERBS[words.one_of(VERBS)?];
        Ok(match verb {
            "turn" => turn(words)?,
            "press" => press(words)?,
            "hold" => Self::Hand(DIAL_BOX, Movement::Down { control: key(words)? }),
            "release" => Self::Hand(DIAL_BOX, Movement::Up { control: key(words)? }),
            "puck" => tool(words, Tool::Puck)?,
            "pen" => tool(words, Tool::Pen)?,
            "cursor" => {
                words.expect("to")?;
                Self::Cursor {
                    to: place(words)?,
                    over_secs: over(words)?,
                }
            }
            "plug" => Self::Plug {
                device: words.text("a device")?,
                connected: true,
            },
            "unplug" => Self::Plug {
                device: words.text("a device")?,
                connected: false,
            },
            "power-cycle" => Self::PowerCycle {
                device: words.text("a device")?,
            },
            "touch" => input::touch(words)?,
            "perform" => perform(words)?,
            "transport" => transport(words)?,
            "fault" => fault(words)?,
            "mend" => Self::Mend {
                bus: words.text("a bus")?,
            },
            "network" => {
                let text = words.rest("network commands")?.to_owned();
                Self::Ask(Command::Network(NetworkEdit::Commands(text)))
            }
            "undo" => Self::Ask(Command::Undo),
            "redo" => Self::Ask(Command::Redo),
            "stall" => Self::Stall {
                secs: words.secs("how many seconds")?,
            },
            "push" => {
                let joint = words.text("a joint")?;
                words.expect("by")?;
                Self::Push {
                    joint,
                    rad: words.angle("an angle")?,
                }
            }
            "hand" => Self::Horn(HornHand::parse(words)?),
            "calibrate" => Calibrate::parse(words)?,
            "slide" => slide(words)?,
            "mark" => Self::Mark,
            _ => json(column, words)?,
        })
    }

    /// The device that a hand is laid on, if that is what is done.
    pub(super) fn device(&self) -> Option<&str> {
        match self {
            Self::Hand(device, _) => Some(device),
            Self::Cursor { .. } => Some(TABLET),
            Self::Plug { device, .. } | Self::PowerCycle { device } | Self::Touch { device, .. } => {
                Some(device)
            }
            Self::Fault { bus, .. } | Self::Mend { bus } => Some(bus),
            // Joints are found on the stand, or they are not there.
            Self::Push { .. }
            | Self::Horn(_)
            | Self::Calibrate(_)
            | Self::Ask(_)
            | Self::Stall { .. }
            | Self::Mark => None,
        }
    }

    /// Does it; commands for the rig are given with the next step.
    pub(super) fn act(&self, world: &mut World, commands: &mut Vec<Command>) -> Result<(), HandError> {
        match self {
            Self::Hand(device, movement) => world.hands().begin(device, 0.0, movement.clone()),
            Self::Cursor { to, over_secs } => {
                let place = match world.stand().surface(TABLET)? {
                    Some(surface) => surface.script_from_cursor(*to),
                    None => *to,
                };
                world.hands().begin(
                    TABLET,
                    0.0,
                    Movement::Glide {
                        to: place,
                        over_secs: *over_secs,
                    },
                );
            }
            Self::Plug { device, connected } => world.stand().plug(device, *connected)?,
            Self::PowerCycle { device } => world.stand().touch(device, &Touch::PowerCycle)?,
            Self::Touch { device, touch } => world.stand().touch(device, touch)?,
            Self::Ask(command) => commands.push(command.clone()),
            Self::Fault { bus, text } if InputFault::parse(text).is_ok() && !world.stand().is_bus(bus) => {
                world.stand().input_fault(bus, text)?;
            }
            Self::Fault { bus, text } => world.stand().fault(bus, text)?,
            Self::Mend { bus } => world.stand().mend(bus)?,
            Self::Stall { secs } => world.stall(*secs),
            Self::Push { joint, rad } => world.stand().push(joint, *rad)?,
            Self::Horn(hand) => hand.act(world.stand())?,
            Self::Calibrate(step) => step.act(world)?,
            // The runner keeps the mark.
            Self::Mark => {}
        }
        Ok(())
    }
}

/// Dials are numbered as on the desk, from 1.
fn dial(words: &mut Words<'_>) -> Parsed<u8> {
    Ok(words.whole("a dial", 1..=8)? as u8 - 1)
}

/// Keys are numbered as on the desk, from 1; those above 12 carry no label.
fn key(words: &mut Words<'_>) -> Parsed<u8> {
    words.expect("key")?;
    Ok(words.whole("a key", 1..=32)? as u8 - 1)
}

fn over(words: &mut Words<'_>) -> Parsed<f64> {
    if words.take("over") {
        words.secs("a duration in seconds")
    } else {
        Ok(0.0)
    }
}

fn place(words: &mut Words<'_>) -> Parsed<[f64; 2]> {
    Ok([words.number("x", -1.0..=1.0)?, words.number("y", -1.0..=1.0)?])
}

fn turn(words: &mut Words<'_>) -> Parsed<Doing> {
    words.one_of(&["dial", "knob"])?;
    let control = dial(words)?;
    words.expect("by")?;
    let amount = words.number("how far", -1e6..=1e6)?;
    let by = if words.take("turns") {
        Turn::Turns(amount)
    } else if words.take("deg") {
        Turn::Degrees(amount)
    } else {
        words.take("counts");
        Turn::Counts(amount.round() as i32)
    };
    let over_secs = over(words)?;
    Ok(Doing::Hand(
        DIAL_BOX,
        Movement::Turn {
            control,
            by,
            over_secs,
        },
    ))
}

/// `slide N to SHARE`: faders, knobs and axes are numbered among themselves, from 1.
fn slide(words: &mut Words<'_>) -> Parsed<Doing> {
    let control = words.whole("a fader, knob or axis", 1..=127)? as u8 - 1;
    words.expect("to")?;
    let to = words.number("a place", -1.0..=1.0)?;
    let over_secs = over(words)?;
    Ok(Doing::Hand(
        DIAL_BOX,
        Movement::Slide {
            control,
            to,
            over_secs,
        },
    ))
}

fn press(words: &mut Words<'_>) -> Parsed<Doing> {
    let control = key(words)?;
    let for_secs = if words.take("for") {
        words.secs("a duration in seconds")?
    } else {
        PRESS_SECS
    };
    Ok(Doing::Hand(DIAL_BOX, Movement::Press { control, for_secs }))
}

fn tool(words: &mut Words<'_>, tool: Tool) -> Parsed<Doing> {
    let verbs: &[&str] = match tool {
        Tool::Puck => &["to", "click", "away", "taken"],
        Tool::Pen => &["to", "click", "away", "taken", "tip"],
    };
    let movement = match words.one_of(verbs)? {
        0 => Movement::Glide {
            to: place(words)?,
            over_secs: over(words)?,
        },
        1 => {
            let button = words.whole("a button", 1..=4)? as u8;
            if words.take("away") {
                Movement::ClickAway {
                    button,
                    for_secs: PRESS_SECS,
                }
            } else {
                Movement::Click {
                    button,
                    for_secs: PRESS_SECS,
                }
            }
        }
        2 => Movement::Away,
        3 => Movement::Take(tool),
        _ => Movement::Tip {
            pressure: words.number("a pressure", 0.0..=1.0)?,
        },
    };
    Ok(Doing::Hand(TABLET, movement))
}

fn perform(words: &mut Words<'_>) -> Parsed<Doing> {
    let orders = [
        ("arm", PuppetCommand::Arm),
        ("play", PuppetCommand::Play),
        ("follow", PuppetCommand::Follow),
        ("hold", PuppetCommand::Hold),
        ("release", PuppetCommand::Release),
        ("stop", PuppetCommand::Stop),
        ("reset", PuppetCommand::Reset),
        ("heartbeat", PuppetCommand::Heartbeat),
        ("compensate-lag", PuppetCommand::CompensateLag(true)),
    ];
    let names = orders.each_ref().map(|(name, _)| *name);
    let place = words.one_of(&names)?;
    Ok(Doing::Ask(Command::Puppet(orders[place].1.clone())))
}

fn transport(words: &mut Words<'_>) -> Parsed<Doing> {
    let command = match words.one_of(&["play", "pause", "seek", "loop", "speed", "key"])? {
        0 => TransportCommand::Play,
        1 => TransportCommand::Pause,
        2 => TransportCommand::Seek {
            secs: words.secs("a time in seconds")?,
        },
        3 => TransportCommand::Loop(words.one_of(&["on", "off"])? == 0),
        4 => TransportCommand::Speed(words.number("a speed", 0.05..=8.0)?),
        _ => TransportCommand::Key(words.number("steps", -1e6..=1e6)? as i32),
    };
    Ok(Doing::Ask(Command::Transport(command)))
}

/// `fault TEXT on BUS`: the text is checked here, so that a scenario that can be read can be played.
fn fault(words: &mut Words<'_>) -> Parsed<Doing> {
    let column = words.column();
    let text = words.rest("a fault and `on` with a bus")?;
    let Some((text, bus)) = text.rsplit_once(" on ") else {
        let message = format!("expected a fault, `on` and a bus, found `{text}`");
        return Err(Flaw { column, message });
    };
    let (text, bus) = (text.trim_end(), bus.trim());
    // Which of the two it is is known when it is done: both may bear the word.
    match Fault::parse(text)
        .map(|_| ())
        .or_else(|flaw| InputFault::parse(text).map(|_| ()).map_err(|_| flaw))
    {
        Ok(()) => Ok(Doing::Fault {
            bus: bus.to_owned(),
            text: text.to_owned(),
        }),
        Err(error) => Err(Flaw {
            column: column + error.column - 1,
            message: error.message,
        }),
    }
}

/// Any command of the rig, as a journal writes it.
fn json(column: u32, words: &mut Words<'_>) -> Parsed<Doing> {
    let text = words.rest("a command as in journals")?;
    match serde_json::from_str(text) {
        Ok(command) => Ok(Doing::Ask(command)),
        Err(error) => {
            let column = column + "do ".len() as u32 + error.column().saturating_sub(1) as u32;
            Err(Flaw {
                column,
                message: format!("expected a command as in journals: {error}"),
            })
        }
    }
}
