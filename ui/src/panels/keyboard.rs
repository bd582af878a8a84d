//! What the keys of the keyboard mean. One table: what is done, what tooltips say, what the help page lists.

use egui::{Context, Key, Modifiers};
use rig::{
    Command, EditCommand, KineticsMode, PoseCommand, PuppetCommand, Side, Snapshot, Touch, TransportCommand,
    ViewCommand,
};

use super::transport::{between_neighbours, stepped_speed};
use super::{Commands, keys};

/// One frame of the transport's steps, seconds.
const FRAME_SECS: f64 = 1.0 / 24.0;
/// One press turns a dial by this much, turns: three detents of a hundred.
const DIAL_TURNS: f64 = 0.03;
/// One press turns the view by this much, radians: five degrees.
const VIEW_RAD: f64 = 0.087_266_462_599_716_47;
/// One press moves a coefficient by this much, keys.
const COEFFICIENT_KEYS: f64 = 0.05;
/// One press moves the posing cursor by this much, half-heights of the view.
const CURSOR_STEP: f64 = 0.02;

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Act {
    /// Order to the transport.
    Toggle,
    /// Moves time by frames.
    Frames(i32),
    /// To the first (−1) or last (1) key.
    Ends(i32),
    /// To the next or previous key.
    Key(i32),
    /// Moves the selected key by frames.
    MoveKey(i32),
    /// Loop on or off.
    Loop,
    /// Faster or slower.
    Speed(bool),
    /// Stores a key.
    Store,
    /// Copies a key.
    Copy,
    /// Deletes a key.
    Delete,
    /// Chooses the next kind of kinetic curve.
    Mode,
    /// Takes kinetic adjustments back.
    ResetKinetics,
    /// Chooses another coefficient.
    Coefficient(i32),
    /// Moves the chosen coefficient.
    Bend(f64),
    /// Undo.
    Undo,
    /// Redo.
    Redo,
    /// Save.
    Save,
    /// Chooses the next or previous link.
    Link(i32),
    /// Turns the selected link about its axis, sixteenths of a half turn.
    Twist(f64),
    /// Fixes the selected link.
    Place,
    /// The other of the two solutions.
    OtherSide,
    /// Takes the clip's pose.
    FromClip,
    /// Moves the posing cursor.
    Cursor(f64, f64),
    /// Turns the chosen dial, in presses.
    Dial(f64),
    /// Turns the view.
    Turn(f64, f64),
    /// Zooms.
    Zoom(f64),
    /// The whole figure.
    Fit,
    /// Onion skin on or off.
    Onion,
    /// Ticks on or off.
    Ticks,
    /// Floor on or off.
    Floor,
    /// Puppet: turn torque on.
    Arm,
    /// Puppet: play.
    PuppetPlay,
    /// Puppet: follow.
    Follow,
    /// Puppet: hold.
    Hold,
    /// Puppet: release.
    Release,
    /// Puppet: leave the faulted state.
    Reset,
    /// The help page.
    Help,
}

/// One row of the table.
pub struct Shortcut {
    /// Modifiers that must be held, and no others.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
    /// What it does.
    pub act: Act,
    /// Group on the help page.
    pub group: &'static str,
    /// The keys in words; empty: the row above speaks for this one too.
    pub keys: &'static str,
    /// What it does in words.
    pub does: &'static str,
}

const NONE: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL: Modifiers = Modifiers::COMMAND;
const ALT: Modifiers = Modifiers::ALT;
const CTRL_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::COMMAND
};
const ALT_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::ALT
};

const fn row(
    (modifiers, key): (Modifiers, Key),
    act: Act,
    group: &'static str,
    keys: &'static str,
    does: &'static str,
) -> Shortcut {
    Shortcut {
        modifiers,
        key,
        act,
        group,
        keys,
        does,
    }
}

/// Every key but Esc, the digits and F1–F12. Rows with more modifiers come before rows with fewer.
pub const SHORTCUTS: &[Shortcut] = &[
    row((NONE, Key::Space), Act::Toggle, "time", "Space", "play, pause"),
    row(
        (SHIFT, Key::ArrowLeft),
        Act::Frames(-10),
        "time",
        "Shift-Left, -Right",
        "ten frames",
    ),
    row((SHIFT, Key::ArrowRight), Act::Frames(10), "time", "", ""),
    row(
        (CTRL, Key::ArrowLeft),
        Act::MoveKey(-1),
        "keys",
        "Ctrl-Left, -Right",
        "move the key a frame",
    ),
    row((CTRL, Key::ArrowRight), Act::MoveKey(1), "keys", "", ""),
    row(
        (ALT_SHIFT, Key::ArrowLeft),
        Act::Cursor(-CURSOR_STEP, 0.0),
        "pose",
        "Alt-Shift-arrows",
        "move the cursor",
    ),
    row(
        (ALT_SHIFT, Key::ArrowRight),
        Act::Cursor(CURSOR_STEP, 0.0),
        "pose",
        "",
        "",
    ),
    row(
        (ALT_SHIFT, Key::ArrowUp),
        Act::Cursor(0.0, CURSOR_STEP),
        "pose",
        "",
        "",
    ),
    row(
        (ALT_SHIFT, Key::ArrowDown),
        Act::Cursor(0.0, -CURSOR_STEP),
        "pose",
        "",
        "",
    ),
    row(
        (ALT, Key::ArrowLeft),
        Act::Coefficient(-1),
        "kinetics",
        "Alt-Left, -Right",
        "choose a coefficient",
    ),
    row((ALT, Key::ArrowRight), Act::Coefficient(1), "kinetics", "", ""),
    row(
        (ALT, Key::ArrowUp),
        Act::Bend(COEFFICIENT_KEYS),
        "kinetics",
        "Alt-Up, -Down",
        "earlier, later there",
    ),
    row(
        (ALT, Key::ArrowDown),
        Act::Bend(-COEFFICIENT_KEYS),
        "kinetics",
        "",
        "",
    ),
    row(
        (NONE, Key::ArrowLeft),
        Act::Frames(-1),
        "time",
        "Left, Right",
        "one frame",
    ),
    row((NONE, Key::ArrowRight), Act::Frames(1), "time", "", ""),
    row(
        (NONE, Key::Home),
        Act::Ends(-1),
        "time",
        "Home, End",
        "first, last key",
    ),
    row((NONE, Key::End), Act::Ends(1), "time", "", ""),
    row(
        (NONE, Key::ArrowUp),
        Act::Key(-1),
        "time",
        "Up, Down",
        "previous, next key",
    ),
    row((NONE, Key::ArrowDown), Act::Key(1), "time", "", ""),
    row((NONE, Key::L), Act::Loop, "time", "L", "loop"),
    row(
        (NONE, Key::Minus),
        Act::Speed(false),
        "time",
        "- =",
        "slower, faster",
    ),
    row((NONE, Key::Equals), Act::Speed(true), "time", "", ""),
    row((NONE, Key::K), Act::Store, "keys", "K", "store the pose as a key"),
    row((NONE, Key::C), Act::Copy, "keys", "C", "copy the last key here"),
    row(
        (NONE, Key::Delete),
        Act::Delete,
        "keys",
        "Delete",
        "delete the selected key",
    ),
    row(
        (SHIFT, Key::M),
        Act::ResetKinetics,
        "kinetics",
        "Shift-M",
        "take adjustments back",
    ),
    row(
        (NONE, Key::M),
        Act::Mode,
        "kinetics",
        "M",
        "natural, monotone, linear",
    ),
    row((CTRL_SHIFT, Key::Z), Act::Redo, "show", "Ctrl-Shift-Z", "redo"),
    row((CTRL, Key::Z), Act::Undo, "show", "Ctrl-Z", "undo"),
    row((CTRL, Key::S), Act::Save, "show", "Ctrl-S", "save"),
    row(
        (SHIFT, Key::Comma),
        Act::Twist(-1.0),
        "pose",
        "Shift-, Shift-.",
        "twist the link",
    ),
    row((SHIFT, Key::Period), Act::Twist(1.0), "pose", "", ""),
    row(
        (NONE, Key::Comma),
        Act::Link(-1),
        "pose",
        ", .",
        "previous, next link",
    ),
    row((NONE, Key::Period), Act::Link(1), "pose", "", ""),
    row(
        (NONE, Key::Enter),
        Act::Place,
        "pose",
        "Enter",
        "fix the link, go to the next",
    ),
    row((NONE, Key::N), Act::OtherSide, "pose", "N", "near or far"),
    row(
        (NONE, Key::B),
        Act::FromClip,
        "pose",
        "B",
        "back to the clip's pose",
    ),
    row(
        (SHIFT, Key::OpenBracket),
        Act::Dial(-10.0),
        "desk",
        "[ ]  with Shift",
        "turn the chosen dial",
    ),
    row((SHIFT, Key::CloseBracket), Act::Dial(10.0), "desk", "", ""),
    row((NONE, Key::OpenBracket), Act::Dial(-1.0), "desk", "", ""),
    row((NONE, Key::CloseBracket), Act::Dial(1.0), "desk", "", ""),
    row(
        (NONE, Key::Q),
        Act::Turn(-VIEW_RAD, 0.0),
        "view",
        "Q E",
        "turn the view",
    ),
    row((NONE, Key::E), Act::Turn(VIEW_RAD, 0.0), "view", "", ""),
    row(
        (NONE, Key::W),
        Act::Turn(0.0, VIEW_RAD),
        "view",
        "W S",
        "tilt the view",
    ),
    row((NONE, Key::S), Act::Turn(0.0, -VIEW_RAD), "view", "", ""),
    row((NONE, Key::PageUp), Act::Zoom(1.25), "view", "PgUp, PgDn", "zoom"),
    row((NONE, Key::PageDown), Act::Zoom(0.8), "view", "", ""),
    row((NONE, Key::V), Act::Fit, "view", "V", "the whole figure"),
    row(
        (NONE, Key::O),
        Act::Onion,
        "view",
        "O T G",
        "onion skin, ticks, floor",
    ),
    row((NONE, Key::T), Act::Ticks, "view", "", ""),
    row((NONE, Key::G), Act::Floor, "view", "", ""),
    row(
        (CTRL, Key::R),
        Act::Reset,
        "puppet",
        "Ctrl-R",
        "reset after a fault",
    ),
    row((NONE, Key::A), Act::Arm, "puppet", "A", "arm"),
    row((NONE, Key::P), Act::PuppetPlay, "puppet", "P", "play the clip"),
    row((NONE, Key::F), Act::Follow, "puppet", "F", "follow the screen"),
    row((NONE, Key::H), Act::Hold, "puppet", "H", "hold"),
    row((NONE, Key::R), Act::Release, "puppet", "R", "release"),
    row((SHIFT, Key::Questionmark), Act::Help, "show", "?", "this page"),
    row((NONE, Key::Questionmark), Act::Help, "show", "", ""),
    row((SHIFT, Key::Slash), Act::Help, "show", "", ""),
];

/// Takes the keys pressed since the last picture and turns them into commands.
pub fn act(ctx: &Context, seen: &Snapshot, commands: &mut Commands<'_>) {
    // Whatever has the focus, whatever else is held: Esc stops.
    if ctx.input(|input| input.key_pressed(Key::Escape)) {
        commands.choices.help = false;
        commands.push(Command::Puppet(PuppetCommand::Stop));
    }
    // With a control in focus, Enter presses it and arrows look for its neighbours.
    let focused = ctx.memory(|memory| memory.focused().is_some());
    for shortcut in SHORTCUTS {
        let taken = matches!(
            shortcut.key,
            Key::Enter | Key::ArrowLeft | Key::ArrowRight | Key::ArrowUp | Key::ArrowDown
        );
        if focused && taken && shortcut.modifiers == NONE {
            continue;
        }
        let count = ctx.input_mut(|input| input.count_and_consume_key(shortcut.modifiers, shortcut.key));
        for _ in 0..count {
            perform(shortcut.act, seen, commands);
        }
    }
    desk_keys(ctx, seen, commands);
}

/// Digits choose dials; F1–F12 are the keys of the desk, down and up.
fn desk_keys(ctx: &Context, seen: &Snapshot, commands: &mut Commands<'_>) {
    const DIGITS: [Key; 8] = [
        Key::Num1,
        Key::Num2,
        Key::Num3,
        Key::Num4,
        Key::Num5,
        Key::Num6,
        Key::Num7,
        Key::Num8,
    ];
    const FUNCTIONS: [Key; 12] = [
        Key::F1,
        Key::F2,
        Key::F3,
        Key::F4,
        Key::F5,
        Key::F6,
        Key::F7,
        Key::F8,
        Key::F9,
        Key::F10,
        Key::F11,
        Key::F12,
    ];
    for (index, key) in DIGITS.into_iter().enumerate() {
        if ctx.input_mut(|input| input.consume_key(NONE, key)) {
            let again = commands.choices.dial == Some(index);
            commands.choices.dial = (!again).then_some(index);
        }
    }
    let Some(device) = &seen.desk.simulated_device else {
        return;
    };
    for (control, key) in FUNCTIONS.into_iter().enumerate() {
        let (pressed, released) = ctx.input(|i| (i.key_pressed(key), i.key_released(key)));
        for down in [pressed.then_some(true), released.then_some(false)]
            .into_iter()
            .flatten()
        {
            let touch = Touch::Button {
                control: control as u8,
                down,
            };
            commands.push(Command::Touch {
                device: device.clone(),
                touch,
            });
        }
    }
}

/// Does one thing of the table.
pub fn perform(act: Act, seen: &Snapshot, commands: &mut Commands<'_>) {
    let command = match act {
        Act::Onion => return flip(&mut commands.choices.look.onion),
        Act::Ticks => return flip(&mut commands.choices.look.ticks),
        Act::Floor => return flip(&mut commands.choices.look.floor),
        Act::Help => return flip(&mut commands.choices.help),
        Act::Coefficient(by) => return choose_coefficient(by, seen, commands),
        Act::Toggle | Act::Frames(_) | Act::Ends(_) | Act::Key(_) | Act::Loop | Act::Speed(_) => {
            Some(Command::Transport(transport(act, seen)))
        }
        Act::Bend(by) => {
            let chosen = seen.kinetics.selected.or(commands.choices.coefficient);
            chosen.map(|coefficient| Command::Edit(EditCommand::Kinetics { coefficient, by }))
        }
        Act::Dial(presses) => turn_dial(presses, seen, commands),
        _ => edit(act, seen).or_else(|| pose(act, seen)).or_else(|| order(act)),
    };
    commands.queue.extend(command);
}

fn flip(on: &mut bool) {
    *on = !*on;
}

fn transport(act: Act, seen: &Snapshot) -> TransportCommand {
    match act {
        Act::Frames(frames) => TransportCommand::Nudge {
            by_secs: f64::from(frames) * FRAME_SECS,
        },
        Act::Ends(end) if end < 0 => TransportCommand::Seek {
            secs: seen.transport.start_secs,
        },
        Act::Ends(_) => TransportCommand::Seek {
            secs: seen.transport.end_secs,
        },
        Act::Key(by) => TransportCommand::Key(by),
        Act::Loop => TransportCommand::ToggleLoop,
        Act::Speed(up) => TransportCommand::Speed(stepped_speed(seen.transport.speed, up)),
        _ => TransportCommand::Toggle,
    }
}

fn edit(act: Act, seen: &Snapshot) -> Option<Command> {
    match act {
        Act::MoveKey(frames) => {
            let key = seen.keys.iter().position(|key| key.selected)?;
            let secs = seen.keys[key].secs + f64::from(frames) * FRAME_SECS;
            let secs = between_neighbours(seen, key, secs);
            Some(Command::Edit(EditCommand::MoveKey { key, secs }))
        }
        Act::Store => seen.figure.as_ref().map(|_| keys::store_command(seen)),
        Act::Copy => keys::copy_command(seen),
        Act::Delete => keys::delete_command(seen),
        Act::Mode => {
            let next = match seen.kinetics.mode.as_str() {
                "natural" => KineticsMode::Monotone,
                "monotone" => KineticsMode::Linear,
                _ => KineticsMode::Natural,
            };
            Some(Command::Edit(EditCommand::KineticsMode(next)))
        }
        Act::ResetKinetics => Some(Command::Edit(EditCommand::ResetKinetics)),
        Act::Undo => Some(Command::Undo),
        Act::Redo => Some(Command::Redo),
        Act::Save => Some(Command::Save),
        _ => None,
    }
}

fn pose(act: Act, seen: &Snapshot) -> Option<Command> {
    let pose = match act {
        Act::Link(by) => PoseCommand::Step(by),
        Act::Twist(steps) => PoseCommand::Twist {
            by_rad: steps * std::f64::consts::PI / 16.0,
        },
        Act::Place => PoseCommand::Place,
        Act::FromClip => PoseCommand::FromClip,
        Act::OtherSide => PoseCommand::Side(other_side(seen)?),
        Act::Cursor(right, up) => {
            let now = seen.figure.as_ref()?.cursor.unwrap_or_default();
            PoseCommand::Cursor([(now.x + right).clamp(-1.0, 1.0), (now.y + up).clamp(-1.0, 1.0)])
        }
        _ => return None,
    };
    Some(Command::Pose(pose))
}

/// The side the selected link's end is not on.
fn other_side(seen: &Snapshot) -> Option<Side> {
    let figure = seen.figure.as_ref()?;
    let [near, far] = figure.candidates.as_slice() else {
        return Some(Side::Far);
    };
    let end = figure.placed.get(usize::from(figure.selected?))?.end;
    Some(if end.distance(*near) <= end.distance(*far) {
        Side::Far
    } else {
        Side::Near
    })
}

fn order(act: Act) -> Option<Command> {
    Some(match act {
        Act::Turn(azimuth_by_rad, elevation_by_rad) => Command::View(ViewCommand::Turn {
            azimuth_by_rad,
            elevation_by_rad,
        }),
        Act::Zoom(by) => Command::View(ViewCommand::Zoom { by }),
        Act::Fit => Command::View(ViewCommand::Reset),
        Act::Arm => Command::Puppet(PuppetCommand::Arm),
        Act::PuppetPlay => Command::Puppet(PuppetCommand::Play),
        Act::Follow => Command::Puppet(PuppetCommand::Follow),
        Act::Hold => Command::Puppet(PuppetCommand::Hold),
        Act::Release => Command::Puppet(PuppetCommand::Release),
        Act::Reset => Command::Puppet(PuppetCommand::Reset),
        _ => return None,
    })
}

fn choose_coefficient(by: i32, seen: &Snapshot, commands: &mut Commands<'_>) {
    // The first and the last are pinned.
    let last = seen.kinetics.coefficients.len() as i32 - 2;
    if last < 1 {
        return;
    }
    let now = commands
        .choices
        .coefficient
        .map_or(if by > 0 { 0 } else { last + 1 }, |c| c as i32);
    commands.choices.coefficient = Some((now + by).clamp(1, last) as usize);
}

fn turn_dial(presses: f64, seen: &Snapshot, commands: &Commands<'_>) -> Option<Command> {
    let device = seen.desk.simulated_device.clone()?;
    let control = commands.choices.dial? as u8;
    Some(Command::Touch {
        device,
        touch: Touch::Dial {
            control,
            turns: presses * DIAL_TURNS,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_means_two_things() {
        for (index, a) in SHORTCUTS.iter().enumerate() {
            for b in &SHORTCUTS[index + 1..] {
                assert!((a.modifiers, a.key) != (b.modifiers, b.key), "{:?} twice", a.key);
                // `consume_key` lets Shift through where a row does not ask for it.
                let hidden = a.key == b.key && a.modifiers == NONE && b.modifiers.shift;
                assert!(!hidden, "{:?} with Shift is never reached", b.key);
            }
        }
    }

    #[test]
    fn coefficients_are_chosen_between_the_pinned_ones() {
        let mut seen = Snapshot::default();
        seen.kinetics.coefficients = vec![[0.0, 0.0]; 5];
        let (mut queue, mut choices) = (Vec::new(), super::super::Choices::default());
        let mut commands = Commands::new(&mut queue, &mut choices);
        let mut walk = Vec::new();
        for by in [1, 1, 1, 1, -1] {
            choose_coefficient(by, &seen, &mut commands);
            walk.push(commands.choices.coefficient.unwrap());
        }
        assert_eq!(walk, [1, 2, 3, 3, 2]);
    }
}
