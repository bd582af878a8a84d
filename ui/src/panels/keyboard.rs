//! What the keys of the keyboard mean, by the table in [`super::shortcuts`].

use egui::{Context, Key, Modifiers};
use rig::{
    Command, EditCommand, KineticsMode, PoseCommand, PuppetCommand, PuppetPose, Side, Snapshot, Touch,
    TransportCommand, ViewCommand,
};

use super::shortcuts::{Act, Place, SHORTCUTS};
use super::transport::between_neighbours;
use super::transport_buttons::stepped_speed;
use super::{Board, Commands, keys, puppet_state};

const NONE: Modifiers = Modifiers::NONE;

/// One frame of the transport's steps, seconds.
const FRAME_SECS: f64 = 1.0 / 24.0;
/// One press turns a dial by this much, turns: three detents of a hundred.
const DIAL_TURNS: f64 = 0.03;

/// Takes the keys pressed since the last picture and turns them into commands.
pub fn act(ctx: &Context, seen: &Snapshot, commands: &mut Commands<'_>) {
    // Whatever has the focus, whatever else is held: Esc stops.
    if ctx.input(|input| input.key_pressed(Key::Escape)) {
        commands.choices.help = false;
        commands.push(Command::Puppet(PuppetCommand::Stop));
    }
    desk_keys(ctx, seen, commands);
    // What is being typed is no order.
    if ctx.text_edit_focused() {
        return;
    }
    choose_dial(ctx, commands);
    let elsewhere = if commands.choices.board == Board::Patch {
        Place::Stage
    } else {
        Place::Patch
    };
    // With a control in focus, Enter presses it and arrows look for its neighbours.
    let focused = ctx.memory(|memory| memory.focused().is_some());
    for shortcut in SHORTCUTS
        .iter()
        .filter(|row| row.place != Place::Patch && row.place != elsewhere)
    {
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
}

/// Digits choose dials.
fn choose_dial(ctx: &Context, commands: &mut Commands<'_>) {
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
    for (index, key) in DIGITS.into_iter().enumerate() {
        if ctx.input_mut(|input| input.consume_key(NONE, key)) {
            let again = commands.choices.dial == Some(index);
            commands.choices.dial = (!again).then_some(index);
        }
    }
}

/// F1–F12 are the keys of the desk, down and up.
fn desk_keys(ctx: &Context, seen: &Snapshot, commands: &mut Commands<'_>) {
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
        Act::Patch => return commands.choices.board.toggle(Board::Patch),
        Act::Controls => return commands.choices.board.toggle(Board::Controls),
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
        Act::Store => keys::can_store(seen).then(|| keys::store_command(seen)),
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
        Act::Teach => seen.puppet.as_ref().map(|_| puppet_state::teach_command(seen)),
        Act::Lead => {
            let leads = seen.puppet.as_ref()?.compensates_lag;
            Some(Command::Puppet(PuppetCommand::CompensateLag(!leads)))
        }
        _ => None,
    }
}

fn pose(act: Act, seen: &Snapshot) -> Option<Command> {
    let puppet = seen.puppet_pose.as_ref();
    let figure = seen
        .figure
        .as_ref()
        .filter(|figure| figure.posing || !puppet.is_some_and(|p| p.by_hand));
    let pose = match act {
        Act::FromClip if figure.is_none() => {
            return puppet.map(|_| Command::PuppetPose(PuppetPose::FromClip));
        }
        Act::FromMeasured => return puppet.map(|_| Command::PuppetPose(PuppetPose::FromMeasured)),
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
        Act::SlowToFit => Command::SlowToFit,
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
