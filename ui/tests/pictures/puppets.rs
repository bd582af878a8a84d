//! The puppet panel: healthy, hot, faulted at a glance; and hands that pose a puppet on screen.

use egui::{Key, Modifiers, Rect, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use rig::{
    Command, EditCommand, EndHandle, JointHandle, JointView, KeyView, PuppetCommand, PuppetPose,
    PuppetPoseView, PuppetState, PuppetView, Snapshot, TeachCommand, ViewState,
};
use ui::render::picture::Picture;
use ui::render::{stage, theme};

use crate::studio::{Bench, count, drawn, harness, no_card};
use crate::walker;

const SMALL: [f32; 2] = [1280.0, 720.0];
const SIZES: [[f32; 2]; 2] = [SMALL, [1920.0, 1080.0]];

/// Two servos of the walker's puppet are hot: it plays slower and softer.
fn hot() -> Snapshot {
    let mut seen = walker::playing();
    let puppet = seen.puppet.as_mut().expect("the walker has a puppet");
    puppet.backing_off = Some("joint \"r_elbow\" has heat (71 C): playing slower and softer".into());
    puppet.pace = 0.6;
    puppet.compensates_lag = true;
    for (name, celsius, retreat) in [("r_elbow", 71.0, 0.35), ("l_knee", 66.0, 0.1)] {
        let joint = joint_of(puppet, name);
        joint.temperature_c = Some(celsius);
        joint.trouble = Some("heat");
        joint.retreat = retreat;
    }
    joint_of(puppet, "r_wrist").tracking.behind_clip_secs = Some(0.006);
    seen
}

fn joint_of<'a>(puppet: &'a mut PuppetView, name: &str) -> &'a mut JointView {
    let joints = &mut puppet.joints;
    joints
        .iter_mut()
        .find(|joint| joint.name == name)
        .expect("a joint of the walker")
}

/// Where an arm of two links is: its shoulder turns about the vertical, its elbow about the arm's side.
fn arm_bones(shoulder_rad: f64, elbow_rad: f64) -> Vec<[DVec3; 2]> {
    let ahead = DVec3::new(shoulder_rad.sin(), 0.0, shoulder_rad.cos());
    let (neck, elbow) = (DVec3::Y * 0.06, DVec3::Y * 0.16 + ahead * 0.06);
    let reach = elbow + 0.12 * (ahead * elbow_rad.cos() + DVec3::Y * elbow_rad.sin());
    vec![[DVec3::ZERO, neck], [neck, elbow], [elbow, reach]]
}

/// An arm without a figure, posed by its end; the servos are elsewhere.
fn arm() -> Snapshot {
    let names = ["shoulder", "elbow"];
    let (posed, measured) = ([0.6, 0.5], [0.1, -0.2]);
    let bones = arm_bones(posed[0], posed[1]);
    let joint = |index: usize| JointView {
        name: names[index].into(),
        bone: index + 1,
        goal_rad: Some(measured[index]),
        measured_rad: Some(measured[index]),
        age_secs: 0.01,
        range_rad: [-1.9, 1.9],
        present: true,
        temperature_c: Some(31.0),
        voltage_v: Some(7.3),
        ..JointView::default()
    };
    Snapshot {
        at_secs: 20.0,
        show: "pick".into(),
        clip_name: "pick".into(),
        keys: vec![KeyView {
            secs: 0.0,
            selected: false,
        }],
        puppet: Some(PuppetView {
            name: "arm".into(),
            state: PuppetState::Holding,
            torque: true,
            on_its_base: true,
            pace: 1.0,
            joints: vec![joint(0), joint(1)],
            bones: arm_bones(measured[0], measured[1]),
            goal_bones: arm_bones(measured[0], measured[1]),
            ..PuppetView::default()
        }),
        puppet_pose: Some(PuppetPoseView {
            puppet: "arm".into(),
            names: names.map(str::to_owned).into(),
            angles_rad: posed.into(),
            ranges_rad: vec![[-1.9, 1.9]; 2],
            led: vec![false; 2],
            joints: vec![
                JointHandle {
                    at: bones[1][0],
                    axis: DVec3::Y,
                },
                JointHandle {
                    at: bones[2][0],
                    axis: DVec3::X,
                },
            ],
            ends: vec![EndHandle {
                link: "jaw".into(),
                at: bones[2][1],
            }],
            bones,
            by_hand: true,
            drag_error_m: 0.0,
        }),
        view: ViewState {
            azimuth_rad: 0.9,
            elevation_rad: 0.25,
            scale: 3.5,
            centre: DVec3::new(0.05, 0.1, 0.08),
        },
        ..Snapshot::default()
    }
}

fn bench(seen: Snapshot) -> Harness<'static, Bench> {
    let mut harness = harness(seen, SMALL, false);
    harness.run_steps(2);
    harness.state_mut().said.clear();
    harness
}

fn drag(harness: &mut Harness<'static, Bench>, from: egui::Pos2, by: egui::Vec2) -> Vec<Command> {
    harness.hover_at(from);
    harness.run_steps(1);
    harness.drag_at(from);
    harness.run_steps(1);
    for step in 1..=8 {
        harness.hover_at(from + by * (step as f32 / 8.0));
        harness.run_steps(1);
    }
    harness.drop_at(from + by);
    said(harness)
}

fn said(harness: &mut Harness<'static, Bench>) -> Vec<Command> {
    harness.run_steps(2);
    std::mem::take(&mut harness.state_mut().said)
}

#[test]
fn hot_is_neither_healthy_nor_faulted_at_a_glance() {
    if no_card() {
        return;
    }
    for size in SIZES {
        let [healthy, hot, faulted, arm] = [
            ("healthy", walker::playing()),
            ("hot", hot()),
            ("faulted", walker::posing()),
            ("arm", arm()),
        ]
        .map(|(name, seen)| drawn(seen, size, name));
        assert_eq!(count(&healthy, theme::TOO_MUCH), 0, "{size:?}");
        assert_eq!(count(&hot, theme::FAULTED), 0, "{size:?}: nothing has failed yet");
        let violet = count(&hot, theme::TOO_MUCH);
        assert!(violet > 400, "{size:?}: {violet} pixels of what is too hot");
        assert!(count(&faulted, theme::FAULTED) > 5000, "{size:?}");
        assert!(
            count(&arm, theme::LINE) > 800,
            "{size:?}: the arm is the brightest thing"
        );
        assert!(count(&arm, theme::SELECTED) > 60, "{size:?}: it is posed by hand");
    }
}

#[test]
fn the_hottest_and_the_lag_are_told_and_the_lead_is_a_switch() {
    let mut harness = bench(hot());
    harness.get_by_label("hottest: r_elbow at 71 °C");
    harness.get_by_label("lowest voltage: 11.9 V at l_ankle");
    harness.get_by_label("lags most: r_wrist by 84 ms, 6 ms behind the clip with the lead");
    harness.get_by_label("puppet lead").click();
    assert_eq!(
        said(&mut harness),
        [Command::Puppet(PuppetCommand::CompensateLag(false))]
    );
    let mut harness = bench(walker::playing());
    harness.key_press_modifiers(Modifiers::SHIFT, Key::L);
    assert_eq!(
        said(&mut harness),
        [Command::Puppet(PuppetCommand::CompensateLag(true))]
    );
}

#[test]
fn an_end_dragged_in_either_picture_goes_with_the_pointer() {
    let seen = arm();
    let end = seen.puppet_pose.as_ref().expect("an arm").ends[0].at;
    let camera = stage::camera(&seen.view);
    let mut harness = bench(seen.clone());
    let area = harness.get_by_label("front view").rect();
    let seen_at = camera.project(end);
    let at = area.center() + vec2(seen_at.x as f32, -seen_at.y as f32) * (area.height() / 2.0);
    let commands = drag(&mut harness, at, vec2(40.0, -30.0));
    let Some(Command::PuppetPose(PuppetPose::Drag { link, to })) = commands.last() else {
        panic!("expected a drag, got {commands:?}");
    };
    assert_eq!(link, "jaw");
    let moved = camera.project(DVec3::from_array(*to)) - seen_at;
    let half = f64::from(area.height() / 2.0);
    assert!(
        (moved.x * half - 40.0).abs() < 0.1 && (moved.y * half - 30.0).abs() < 0.1,
        "{moved}"
    );
    assert!(moved.z.abs() < 1e-9, "as deep as it was");

    let small = harness.get_by_label("puppet picture").rect();
    let found = (0..40)
        .flat_map(|x| (0..40).map(move |y| [x, y]))
        .find_map(|cell| {
            let at = small.min + vec2(small.width() * cell[0] as f32, small.height() * cell[1] as f32) / 40.0;
            let commands = drag(&mut harness, at, vec2(6.0, 0.0));
            (!commands.is_empty()).then_some(commands)
        });
    let commands = found.expect("the end is somewhere in the picture");
    let all = |command: &Command| matches!(command, Command::PuppetPose(PuppetPose::Drag { link, .. }) if link == "jaw");
    assert!(commands.iter().all(all), "{commands:?}");
}

#[test]
fn a_bar_dragged_turns_its_joint_and_stops_at_its_range() {
    let mut harness = bench(arm());
    let bar = harness.get_by_label("joint shoulder").rect();
    let at = pos2(bar.left() + 30.0, bar.center().y);
    let angle = |commands: &[Command]| match commands.last() {
        Some(Command::PuppetPose(PuppetPose::Joint { joint, angle_rad })) if joint == "shoulder" => {
            *angle_rad
        }
        other => panic!("expected a turned shoulder, got {other:?}"),
    };
    let little = angle(&drag(&mut harness, at, vec2(10.0, 0.0)));
    assert!((0.61..1.2).contains(&little), "from where it was: {little}");
    let far = angle(&drag(&mut harness, at, vec2(400.0, 0.0)));
    assert_eq!(far, 1.9, "its range ends there");
}

#[test]
fn keys_store_the_pose_of_a_puppet_and_take_it_back() {
    let mut harness = bench(arm());
    for (modifiers, key, want) in [
        (
            Modifiers::NONE,
            Key::K,
            Command::Edit(EditCommand::StoreKey { secs: 0.0 }),
        ),
        (Modifiers::NONE, Key::B, Command::PuppetPose(PuppetPose::FromClip)),
        (
            Modifiers::SHIFT,
            Key::B,
            Command::PuppetPose(PuppetPose::FromMeasured),
        ),
    ] {
        harness.key_press_modifiers(modifiers, key);
        assert_eq!(said(&mut harness), [want]);
    }
}

#[test]
fn teaching_says_what_floats_and_k_stores_what_is_measured() {
    let mut harness = bench(arm());
    harness.get_by_label("puppet teach").click();
    assert_eq!(said(&mut harness), [Command::Teach(TeachCommand::Begin)]);
    let mut seen = arm();
    seen.teaching = true;
    let puppet = seen.puppet.as_mut().expect("an arm");
    (puppet.state, puppet.torque) = (PuppetState::Released, false);
    // What is on screen is what was measured.
    puppet.bones = seen.puppet_pose.as_ref().expect("an arm").bones.clone();
    puppet.goal_bones.clear();
    for (joint, rad) in puppet.joints.iter_mut().zip([0.6, 0.5]) {
        (joint.goal_rad, joint.measured_rad) = (None, Some(rad));
    }
    if !no_card() {
        drawn(seen.clone(), SMALL, "teaching");
    }
    let mut harness = bench(seen.clone());
    harness.key_press(Key::K);
    assert_eq!(
        said(&mut harness),
        [Command::Teach(TeachCommand::Store { step_secs: 1.0 })],
        "on to the next"
    );
    harness.key_press_modifiers(Modifiers::SHIFT, Key::T);
    assert_eq!(said(&mut harness), [Command::Teach(TeachCommand::End)]);
    (seen.transport.secs, seen.transport.end_secs) = (0.5, 2.0);
    let mut harness = bench(seen);
    harness.key_press(Key::K);
    assert_eq!(
        said(&mut harness),
        [Command::Teach(TeachCommand::Store { step_secs: 0.0 })],
        "between keys"
    );
}

#[test]
fn a_puppet_that_nobody_drives_is_still_posed() {
    let mut seen = arm();
    seen.puppet = None;
    let harness = bench(seen.clone());
    harness.get_by_label("joint elbow");
    let size: Rect = harness.get_by_label("puppet picture").rect();
    assert!(size.width() > 60.0);
    if !no_card() {
        let live = |picture: &Picture| count(picture, theme::LIVE);
        let driven = live(&drawn(arm(), SMALL, "arm"));
        let alone = live(&drawn(seen, SMALL, "on-screen"));
        assert!(
            alone + 100 < driven,
            "the play head alone: {alone} of {driven} pixels"
        );
    }
}
