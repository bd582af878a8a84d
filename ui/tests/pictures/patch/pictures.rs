//! Pictures of the patch panel, to be looked at.

use egui::{Key, Modifiers, vec2};
use ps300::Kinds;
use ui::render::picture::Picture;
use ui::render::theme;

use super::Room;
use super::machine::Link;
use super::networks::{DIALS, OBJECT, SINKS, pages};
use crate::studio::{count, keep, no_card};

const LARGE: [f32; 2] = [1440.0, 900.0];

fn drawn(room: &mut Room, name: &str) -> Picture {
    let image = room
        .harness
        .render()
        .expect("the adapter that started also draws");
    let picture = Picture {
        width: image.width(),
        height: image.height(),
        rgba: image.into_raw(),
    };
    keep(&picture, &format!("patch-{name}.png"));
    picture
}

fn dials() -> Room {
    let mut room = Room::new(Link::new(DIALS, SINKS), LARGE, true);
    for step in 0..30 {
        let turn = f64::from(step) * 0.2;
        room.turn(&[(1, 0.02 * turn.sin()), (4, 0.01), (6, 0.03 * turn.cos())]);
    }
    room
}

#[test]
fn the_dial_network() {
    if no_card() {
        return;
    }
    let mut room = dials();
    let picture = drawn(&mut room, "dials");
    assert_eq!(count(&picture, theme::FAULTED), 0, "red where nothing is faulted");
    room.harness.state_mut().studio.patch().show_text(true);
    room.step();
    let output = room.output("tr", 0);
    room.harness.hover_at(output);
    room.step();
    room.press(Modifiers::NONE, Key::P);
    for step in 0..60 {
        let turn = f64::from(step) * 0.2;
        room.turn(&[(6, 0.03 * turn.cos()), (5, 0.02 * (turn * 0.7).sin())]);
    }
    let at = room.place("tr").center_top() + vec2(0.0, 8.0);
    room.click(at);
    room.press(Modifiers::NONE, Key::Home);
    let output = room.output("tr", 0);
    room.harness.hover_at(output);
    room.turn(&[(6, 0.01), (1, 0.1)]);
    room.step();
    drawn(&mut room, "text");
}

/// The network every show begins with, and the parameters of the rig it drives.
#[test]
fn the_shipped_network() {
    if no_card() {
        return;
    }
    let kinds = |parameter: &rig::parameters::Parameter| -> Vec<Kinds> {
        parameter.inlets.iter().map(|inlet| inlet.kinds).collect()
    };
    let parameters: Vec<(&str, Vec<Kinds>)> = rig::parameters::PARAMETERS
        .iter()
        .map(|parameter| (parameter.name, kinds(parameter)))
        .collect();
    let sinks: Vec<(&str, &[Kinds])> = parameters
        .iter()
        .map(|(name, kinds)| (*name, kinds.as_slice()))
        .collect();
    let program = include_str!("../../../../networks/figure.ps300");
    let mut room = Room::new(Link::new(program, &sinks), LARGE, true);
    for dial in [1, 2, 4] {
        room.turn(&[(dial, 0.02)]);
    }
    drawn(&mut room, "figure");
    let at = room.place("turn").center();
    zoom(&mut room, at, 5);
    room.turn(&[(1, 0.02), (4, 0.01)]);
    drawn(&mut room, "figure-near");
}

/// Turns the wheel over a place until its glide is over.
fn zoom(room: &mut Room, at: egui::Pos2, notches: usize) {
    for _ in 0..notches {
        room.harness.hover_at(at);
        room.harness.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: vec2(0.0, 120.0),
            modifiers: Modifiers::NONE,
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
        });
        room.step();
    }
    for _ in 0..20 {
        room.step();
    }
}

#[test]
fn two_hundred_instances() {
    if no_card() {
        return;
    }
    let mut room = Room::new(Link::new(&pages(200), SINKS), LARGE, true);
    for step in 0..6 {
        room.turn(&[(step % 8 + 1, 0.01)]);
    }
    drawn(&mut room, "200");
    let at = room.place("gain1_3").center();
    zoom(&mut room, at, 6);
    room.turn(&[(3, 0.02)]);
    drawn(&mut room, "200-near");
}

#[test]
fn what_goes_wrong_is_seen() {
    if no_card() {
        return;
    }
    let wrong = "adder := F:ADD; texts := F:CONSTANT; SEND 'far' TO <2>texts; CONNECT DIALS<1>:<1>texts;
        CONNECT texts<1>:<2>gain; gain := F:MULC; SEND 2 TO <2>gain; CONNECT DIALS<1>:<1>gain; CONNECT gain<1>:<1>adder;
        CONNECT gain<1>:<1>VIEW; late := F:NOP; CONNECT adder<1>:<1>late;";
    let program: Vec<&str> = wrong.split(';').collect();
    let (made, wired): (Vec<&str>, Vec<&str>) = program.iter().partition(|line| line.contains(":="));
    let program = format!("{};{};", made.join(";"), wired.join(";"));
    let mut room = Room::new(Link::new(&program, SINKS), LARGE, true);
    for _ in 0..5 {
        room.turn(&[(1, 0.1)]);
    }
    let at = room.place("gain").right_top();
    room.harness.hover_at(at);
    room.step();
    room.step();
    let picture = drawn(&mut room, "error");
    assert!(count(&picture, theme::FAULTED) > 60, "an error must be found");
}

#[test]
fn a_wire_that_is_refused_says_why() {
    if no_card() {
        return;
    }
    let mut room = dials();
    let (from, to) = (room.output("rx", 0), room.input("sc", 0));
    room.hold(from, to);
    room.step();
    drawn(&mut room, "refused");
}

#[test]
fn the_search() {
    if no_card() {
        return;
    }
    let mut room = Room::new(Link::new(OBJECT, SINKS), LARGE, true);
    room.harness.hover_at(room.area().center() - vec2(200.0, 160.0));
    room.step();
    room.press(Modifiers::NONE, Key::Tab);
    room.write("rout");
    room.step();
    drawn(&mut room, "search");
}
