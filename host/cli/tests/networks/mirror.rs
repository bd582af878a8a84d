//! `networks/mirror`: one hand, three instruments. The hand's side is the same text for all, so that the same turns
//! give the same numbers at the lamp, at the figure's joints and at the camera.

use std::fmt::Write;
use std::fs;

use glam::{DMat3, DMat4, DVec3};
use ps300::Machine;

use crate::record::{Record, is_near, records};
use crate::session::{Desk, root};

const INSTRUMENTS: [&str; 3] = ["lamp", "figure", "camera"];
const JOINTS: [&str; 3] = ["turn", "tilt", "bend"];

fn text(name: &str) -> String {
    fs::read_to_string(root().join(format!("networks/mirror/{name}.ps300"))).expect("readable")
}

/// Turns of dials 1 to 3, some beyond the limits.
fn turns() -> Vec<(usize, f64)> {
    (0..60_u32)
        .map(|step| {
            (
                (step * 7 % 3) as usize,
                f64::from(step * 29 % 17) * 0.0625 - 0.4375,
            )
        })
        .collect()
}

/// Where the three sums are after each turn: degrees, with the stops of the three joints.
fn expected() -> Vec<(usize, f64)> {
    let mut sums = [0.0_f64; 3];
    let gains = [180.0, 90.0, 90.0];
    let stops = [(f64::MIN, f64::MAX), (-90.0, 90.0), (0.0, 150.0)];
    let after = |(dial, turned): (usize, f64)| {
        let (low, high) = stops[dial];
        sums[dial] = (sums[dial] + gains[dial] * turned).clamp(low, high);
        (dial, sums[dial])
    };
    turns().into_iter().map(after).collect()
}

fn dials(from_secs: f64) -> String {
    let mut options = String::new();
    for (step, (dial, turned)) in turns().into_iter().enumerate() {
        let secs = from_secs + step as f64 / 64.0;
        let _ = write!(options, " --dial {}:{turned}@{secs}", dial + 1);
    }
    options
}

#[test]
fn the_hand_s_side_is_one_text_and_the_patch_differs_by_a_name() {
    let sides = INSTRUMENTS.map(|name| {
        let text = text(&format!("dials-to-{name}"));
        let (_, rest) = text.split_once("{ --- the hand").expect("a hand");
        let (hand, patch) = rest.split_once("{ --- the patch").expect("a patch");
        (hand.to_owned(), patch.replace(name, "instrument"))
    });
    for side in &sides {
        assert_eq!(side.1.matches("instrument_").count(), 3);
        assert_eq!(side, &sides[0]);
    }
}

/// What reaches the joint of a matrix node, as a function of its angle.
fn matrix(instrument: &str, joint: usize, degrees: f64) -> DMat3 {
    let angle = degrees.to_radians();
    match (joint, instrument) {
        (0, _) => DMat3::from_rotation_y(angle),
        (2, "camera") => DMat3::from_rotation_z(angle),
        _ => DMat3::from_rotation_x(angle),
    }
}

#[test]
fn the_same_turns_give_the_same_numbers_at_lamp_figure_and_camera() {
    let desk = Desk::new();
    for name in INSTRUMENTS {
        let folder = "networks/mirror";
        let mut command = format!("dialrig net run {folder}/{name}.ps300 {folder}/dials-to-{name}.ps300");
        for joint in JOINTS {
            // What the camera turns has its matrices behind its inlets.
            let makes = match name {
                "camera" => format!("{joint}_matrix"),
                _ => format!("{name}_{joint}"),
            };
            let _ = write!(command, " --watch '{joint}<1>' --watch '{makes}<1>'");
        }
        let seen = records(&desk, &(command + &dials(0.1)));
        let (numbers, matrices): (Vec<Record>, Vec<Record>) = seen
            .into_iter()
            .filter(|record| record.secs > 0.0)
            .partition(|record| JOINTS.iter().any(|joint| record.from == format!("{joint}<1>")));
        assert_eq!((numbers.len(), matrices.len()), (turns().len(), turns().len()));
        for (at, (dial, degrees)) in expected().into_iter().enumerate() {
            assert_eq!(numbers[at].from, format!("{}<1>", JOINTS[dial]), "{name}");
            assert!(is_near(&numbers[at].numbers(), &[degrees]), "{name}, turn {at}");
            let rows = matrix(name, dial, degrees).transpose().to_cols_array();
            assert!(is_near(&matrices[at].numbers(), &rows), "{name}, turn {at}");
        }
    }
}

#[test]
fn the_switch_gives_the_dials_to_one_and_leaves_the_others_where_they_are() {
    let mut command = "dialrig net run networks/mirror/lamp.ps300 networks/mirror/figure.ps300 \
                       networks/mirror/camera.ps300 networks/mirror/switch.ps300"
        .to_owned();
    for (at, name) in INSTRUMENTS.iter().enumerate() {
        let _ = write!(
            command,
            " --key {}@{}{}",
            at + 1,
            2 * at,
            dials(2.0 * at as f64 + 0.1)
        );
        for joint in JOINTS {
            let _ = write!(command, " --watch '{name}_{joint}_sum<1>'");
        }
    }
    let seen = records(&Desk::new(), &command);
    assert_eq!(seen.len(), 3 * turns().len());
    for (at, record) in seen.iter().enumerate() {
        let name = INSTRUMENTS[at / turns().len()];
        let (dial, degrees) = expected()[at % turns().len()];
        assert_eq!(
            record.from,
            format!("{name}_{}_sum<1>", JOINTS[dial]),
            "message {at}"
        );
        assert!(is_near(&record.numbers(), &[degrees]), "message {at}: {record:?}");
    }
}

#[test]
fn the_figure_s_links_point_where_its_arm_does_and_the_camera_sees_the_world_turned_back() {
    let desk = Desk::new();
    let run = "dialrig net run networks/mirror/figure.ps300 networks/mirror/dials-to-figure.ps300 --dial 1:0.2@1 \
               --dial 2:0.5@2 --dial 3:0.75@3 --watch 'FIGURE.rua<1>' --watch 'FIGURE.rfa<1>'";
    let seen = records(&desk, run);
    let [turn, tilt, bend] = [36.0, 45.0, 67.5];
    let upper = matrix("", 0, turn) * matrix("", 1, tilt);
    let lower = upper * matrix("", 2, bend);
    for (link, frame) in [("FIGURE.rua<1>", upper), ("FIGURE.rfa<1>", lower)] {
        let last = crate::record::last(&seen, link).expect("a direction");
        assert!(
            is_near(&last.numbers(), &(frame * -DVec3::Y).to_array()),
            "{link}"
        );
    }

    let mut machine = Machine::new();
    assert_eq!(machine.load(&text("camera")), []);
    assert_eq!(machine.load(&text("dials-to-camera")), []);
    for (dial, turned) in [(1, 0.2), (2, 0.5), (3, 0.75)] {
        machine.emit("DIALS", dial, turned);
    }
    machine.tick(0.1, 1, 1000);
    let posts = machine.display_of("posts", DMat4::IDENTITY).strokes;
    let there = matrix("camera", 0, turn) * matrix("camera", 1, tilt) * matrix("camera", 2, bend);
    for (seen, post) in machine
        .display_of("seen", DMat4::IDENTITY)
        .strokes
        .iter()
        .zip(&posts)
    {
        let in_front = there.transpose() * (post.to + DVec3::new(0.0, -1.0, 4.0));
        assert!((seen.to - in_front).length() < 1e-9);
    }
}
