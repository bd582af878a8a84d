//! Hands and keys on the studio, without any graphics adapter: which commands they mean.

use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use rig::{Command, EditCommand, PoseCommand, PuppetCommand, Snapshot, Touch, TransportCommand, ViewCommand};

use crate::studio::{Bench, harness};
use crate::walker;

const SMALL: [f32; 2] = [1280.0, 720.0];

fn bench(seen: Snapshot) -> Harness<'static, Bench> {
    let mut harness = harness(seen, SMALL, false);
    harness.run_steps(2);
    harness.state_mut().said.clear();
    harness
}

fn said(harness: &mut Harness<'static, Bench>) -> Vec<Command> {
    harness.run_steps(2);
    std::mem::take(&mut harness.state_mut().said)
}

fn drag(harness: &mut Harness<'static, Bench>, from: Pos2, to: Pos2) -> Vec<Command> {
    harness.hover_at(from);
    harness.run_steps(1);
    harness.drag_at(from);
    harness.run_steps(1);
    for step in 1..=8 {
        harness.hover_at(from + (to - from) * (step as f32 / 8.0));
        harness.run_steps(1);
    }
    harness.drop_at(to);
    said(harness)
}

fn touch(touch: Touch) -> Command {
    Command::Touch {
        device: "dial-box".into(),
        touch,
    }
}

#[test]
fn keys_mean_what_the_help_page_says() {
    let command = Modifiers::COMMAND;
    let both = Modifiers {
        shift: true,
        ..command
    };
    let seek = |secs| Command::Transport(TransportCommand::Seek { secs });
    let rows: Vec<(Modifiers, Key, Vec<Command>)> = vec![
        (
            Modifiers::NONE,
            Key::Space,
            vec![Command::Transport(TransportCommand::Toggle)],
        ),
        (
            Modifiers::NONE,
            Key::Escape,
            vec![Command::Puppet(PuppetCommand::Stop)],
        ),
        (command, Key::Z, vec![Command::Undo]),
        (both, Key::Z, vec![Command::Redo]),
        (command, Key::S, vec![Command::Save]),
        (Modifiers::NONE, Key::Home, vec![seek(0.0)]),
        (Modifiers::NONE, Key::End, vec![seek(2.4)]),
        (
            Modifiers::NONE,
            Key::ArrowDown,
            vec![Command::Transport(TransportCommand::Key(1))],
        ),
        (
            Modifiers::NONE,
            Key::K,
            vec![Command::Edit(EditCommand::StoreKey { secs: 0.6 })],
        ),
        (
            Modifiers::NONE,
            Key::Delete,
            vec![Command::Edit(EditCommand::DeleteKey { key: 2 })],
        ),
        (
            Modifiers::NONE,
            Key::Enter,
            vec![Command::Pose(PoseCommand::Place)],
        ),
        (Modifiers::NONE, Key::V, vec![Command::View(ViewCommand::Reset)]),
        (Modifiers::NONE, Key::A, vec![Command::Puppet(PuppetCommand::Arm)]),
        (command, Key::R, vec![Command::Puppet(PuppetCommand::Reset)]),
        (
            Modifiers::NONE,
            Key::F7,
            vec![
                touch(Touch::Button {
                    control: 6,
                    down: true,
                }),
                touch(Touch::Button {
                    control: 6,
                    down: false,
                }),
            ],
        ),
        (Modifiers::NONE, Key::O, vec![]),
    ];
    let mut harness = bench(walker::posing());
    for (modifiers, key, want) in rows {
        harness.key_press_modifiers(modifiers, key);
        assert_eq!(said(&mut harness), want, "{modifiers:?} {key:?}");
    }
    assert!(
        !harness.state_mut().studio.choices().look.onion,
        "O has switched the onion skin off"
    );
}

#[test]
fn space_plays_even_where_a_button_has_the_focus() {
    let mut harness = bench(walker::posing());
    harness.get_by_label("Delete").focus();
    harness.run_steps(1);
    harness.key_press(Key::Space);
    assert_eq!(said(&mut harness), [Command::Transport(TransportCommand::Toggle)]);
    harness.key_press(Key::Enter);
    assert_eq!(
        said(&mut harness),
        [Command::Edit(EditCommand::DeleteKey { key: 2 })]
    );
}

#[test]
fn stop_is_there_in_every_state() {
    for seen in [Snapshot::default(), walker::playing(), walker::posing()] {
        let mut harness = bench(seen);
        harness.get_by_label("STOP").click();
        assert_eq!(said(&mut harness), [Command::Puppet(PuppetCommand::Stop)]);
    }
}

#[test]
fn a_dial_sends_what_the_hand_turned() {
    let mut harness = bench(walker::playing());
    let dial = harness.get_by_label("dial 3 Zoom").rect();
    let commands = drag(&mut harness, dial.center(), dial.center() - vec2(0.0, 60.0));
    let turned: f64 = commands
        .iter()
        .map(|command| match command {
            Command::Touch {
                device,
                touch: Touch::Dial { control: 2, turns },
            } if device == "dial-box" => *turns,
            other => panic!("a turned dial sent {other:?}"),
        })
        .sum();
    assert!((0.15..0.3).contains(&turned), "{turned}");
    // Chosen by the drag, so the brackets go on turning it.
    harness.key_press(Key::CloseBracket);
    assert_eq!(
        said(&mut harness),
        [touch(Touch::Dial {
            control: 2,
            turns: 0.03
        })]
    );
}

#[test]
fn without_a_simulated_box_the_desk_only_shows() {
    let mut seen = walker::playing();
    seen.desk.simulated_device = None;
    let mut harness = bench(seen);
    let dial = harness.get_by_label("dial 1 X-Rot").rect();
    assert_eq!(
        drag(&mut harness, dial.center(), dial.center() - vec2(0.0, 40.0)),
        []
    );
    harness.key_press(Key::F1);
    assert_eq!(said(&mut harness), []);
}

#[test]
fn a_key_of_the_desk_goes_down_and_up() {
    let mut harness = bench(walker::playing());
    harness.get_by_label("F7 PLAY").click();
    let want = [true, false].map(|down| touch(Touch::Button { control: 6, down }));
    assert_eq!(said(&mut harness), want);
}

#[test]
fn a_dragged_diamond_changes_a_time_once_and_not_past_its_neighbour() {
    let mut harness = bench(walker::playing());
    let at = harness.get_by_label("diamond 3").rect().center();
    let next = harness.get_by_label("diamond 4").rect().center();
    let commands = drag(&mut harness, at, next + vec2(200.0, 0.0));
    let [Command::Edit(EditCommand::MoveKey { key: 2, secs })] = commands[..] else {
        panic!("expected one move of key 3, got {commands:?}");
    };
    assert!(secs < 1.1 && secs > 1.0, "{secs}");
}

#[test]
fn scrubbing_seeks_where_the_pointer_is() {
    let mut harness = bench(walker::playing());
    let strip = harness.get_by_label("scrub").rect();
    let y = strip.top() + 4.0;
    let commands = drag(
        &mut harness,
        Pos2::new(strip.left() + 300.0, y),
        Pos2::new(strip.right() + 500.0, y),
    );
    let Some(Command::Transport(TransportCommand::Seek { secs })) = commands.last() else {
        panic!("expected a seek, got {commands:?}");
    };
    assert!((secs - 2.65).abs() < 1e-6, "a little after the last key: {secs}");
}

#[test]
fn a_press_on_a_joint_takes_its_link_and_anywhere_else_turns_the_view() {
    let seen = walker::posing();
    let mut harness = bench(seen.clone());
    let area = harness.get_by_label("front view").rect();
    let camera = ui::render::stage::camera(&seen.view);
    let end = camera.project(seen.figure.as_ref().expect("the walker").placed[4].end);
    let at = area.center() + vec2(end.x as f32, -end.y as f32) * (area.height() / 2.0);
    let commands = drag(&mut harness, at, at + vec2(30.0, -20.0));
    assert_eq!(commands.first(), Some(&Command::Pose(PoseCommand::Select(4))));
    assert!(
        matches!(commands.last(), Some(Command::Pose(PoseCommand::Cursor(_)))),
        "{commands:?}"
    );
    let corner = area.left_bottom() + vec2(60.0, -120.0);
    let commands = drag(&mut harness, corner, corner + vec2(80.0, 0.0));
    assert!(!commands.is_empty());
    assert!(
        commands
            .iter()
            .all(|c| matches!(c, Command::View(ViewCommand::Turn { .. }))),
        "{commands:?}"
    );
}

/// Names and places of everything that can be pressed or turned.
fn controls(harness: &Harness<'static, Bench>) -> Vec<(String, Rect)> {
    let mut found: Vec<(String, Rect)> = [Role::Button, Role::Slider]
        .into_iter()
        .flat_map(|role| {
            harness
                .query_all_by_role(role)
                .map(|node| (node, role))
                .collect::<Vec<_>>()
        })
        .map(|(node, _)| (node.accesskit_node().label().unwrap_or_default(), node.rect()))
        .filter(|(name, _)| !name.starts_with("diamond") && !name.starts_with("coefficient"))
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

#[test]
fn no_control_lies_over_another_or_outside_the_window() {
    for size in [[1280.0, 720.0], [1440.0, 900.0], [1920.0, 1080.0]] {
        for seen in [Snapshot::default(), walker::playing(), walker::posing()] {
            let mut harness = harness(seen, size, false);
            harness.run_steps(2);
            let window = Rect::from_min_size(Pos2::ZERO, size.into());
            let controls = controls(&harness);
            assert!(controls.len() > 40, "{}", controls.len());
            for (index, (name, rect)) in controls.iter().enumerate() {
                assert!(window.contains_rect(*rect), "{name} at {rect:?} leaves {size:?}");
                for (other, theirs) in &controls[index + 1..] {
                    assert!(
                        !rect.shrink(0.5).intersects(theirs.shrink(0.5)),
                        "{name} lies over {other} at {size:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn nothing_jumps_when_the_state_changes() {
    let places = |seen: Snapshot| {
        let mut harness = harness(seen, SMALL, false);
        harness.run_steps(2);
        controls(&harness)
    };
    let (playing, posing) = (places(walker::playing()), places(walker::posing()));
    for (name, rect) in playing.iter().filter(|(name, _)| !name.contains("plug")) {
        let other = posing.iter().find(|(other, _)| other == name);
        assert_eq!(other.map(|o| o.1), Some(*rect), "{name} has moved");
    }
}
