//! Controls in a whole rig: taking hold, returns, pages, learning, devices that come late, feedback.

use device::codec::Feedback;

use super::bench::Bench;
use super::*;
use crate::command::{Binding, LearnCommand, PuppetPose};

/// The first fader on the azimuth: 0 to 90 degrees.
const FADER: &str = "s := F:MULC; SEND 90 TO <2>s; CONNECT NANO<1>:<1>s; CONNECT s<1>:<5>VIEW;";

#[test]
fn a_fader_takes_hold_of_what_it_drives_and_not_before() {
    let mut bench = Bench::new(FADER);
    bench.turn_view(45.0);
    bench.slowly(0, &[0, 100, 300]);
    assert!((bench.azimuth_deg() - 45.0).abs() < 1e-9);
    let fader = &bench.view().controls[0];
    assert!(!fader.picked_up && fader.awaits.is_some_and(|it| (it - 0.5).abs() < 1e-9));
    assert_eq!(fader.bound, ["VIEW<5>"]);
    assert!((bench.slowly(0, &[490]).view.azimuth_rad.to_degrees() - 44.1).abs() < 1e-9);
    assert!(bench.view().controls[0].picked_up);
    assert!((bench.fader(0, 900).view.azimuth_rad.to_degrees() - 81.0).abs() < 1e-9);
    // Somebody else turns the view: the fader must come and fetch it.
    bench.turn_view(-60.0);
    bench.slowly(0, &[880, 800]);
    assert!((bench.azimuth_deg() - 21.0).abs() < 1e-9);
}

#[test]
fn a_return_steps_nothing_and_is_told() {
    let mut bench = Bench::new(FADER);
    bench.turn_view(45.0);
    bench.slowly(0, &[480, 500, 600]);
    let held = bench.azimuth_deg();
    assert!((held - 54.0).abs() < 1e-9);
    bench
        .rig
        .noticed(&Change::Gone("nano".into(), "the cable is out".into()));
    bench.step(&[]);
    assert!(
        bench
            .notes()
            .contains("nano: the cable is out; what it drives stays where it is")
    );
    bench.rig.noticed(&Change::Came("nano".into()));
    // It tells where it is; somebody moved it meanwhile.
    bench.slowly(0, &[100, 150, 300]);
    assert_eq!(bench.azimuth_deg(), held);
    bench.slowly(0, &[590]);
    assert!((bench.azimuth_deg() - 53.1).abs() < 1e-9, "and takes hold again");
}

#[test]
fn pages_drive_other_things_and_turning_them_moves_nothing() {
    let mut bench = Bench::new(
        "CONNECT NANO<1>:<1>s; s := F:MULC; SEND 90 TO <2>s; CONNECT NANO<1>:<1>s; CONNECT s<1>:<5>VIEW;
         t := F:MULC; SEND 90 TO <2>t; CONNECT NANO_PAGE2<1>:<1>t; CONNECT t<1>:<6>VIEW;",
    );
    bench.turn_view(45.0);
    bench.slowly(0, &[480, 500, 700]);
    let page = |page| {
        Command::Controls(ControlCommand::Page {
            device: "nano".into(),
            page,
        })
    };
    bench.step(&[page(2)]);
    bench.slowly(0, &[710, 800]);
    assert_eq!(bench.seen.view.elevation_rad, 0.0);
    assert_eq!(bench.view().controls[0].bound, ["VIEW<6>"]);
    bench.slowly(0, &[300, 10, 100]);
    assert!((bench.seen.view.elevation_rad.to_degrees() - 9.0).abs() < 1e-9);
    bench.step(&[page(1)]);
    bench.slowly(0, &[110]);
    assert!((bench.azimuth_deg() - 63.0).abs() < 1e-9);
    bench.step(&[page(7)]);
    assert!(bench.notes().contains("nano has pages 1 to 4, not 7"));
}

#[test]
fn a_page_comes_up_with_the_joint_it_is_for() {
    let mut bench = Bench::new("SEND 'elbow_flex' TO <4>NANO_PAGE;");
    let pose = |joint: &str| {
        Command::PuppetPose(PuppetPose::JointBy {
            joint: joint.into(),
            by_rad: 0.01,
        })
    };
    bench.step(&[pose("elbow_flex")]);
    bench.step(&[]);
    assert_eq!(bench.view().page, 2);
    let stay = Command::Controls(ControlCommand::PageFollows {
        device: "nano".into(),
        on: false,
    });
    bench.commands("SEND 'shoulder_pan' TO <5>NANO_PAGE;");
    bench.step(&[stay]);
    bench.step(&[pose("shoulder_pan")]);
    bench.step(&[]);
    assert_eq!(bench.view().page, 2, "it stays");
}

#[test]
fn what_is_touched_is_connected_and_taken_back_in_one_step() {
    let mut bench = Bench::new("");
    let before = bench.rig.network_text();
    bench.slowly(0, &[400]);
    bench.step(&[Command::Learn(LearnCommand::Begin)]);
    bench.slowly(0, &[410]);
    assert_eq!(
        bench.seen.learning.as_ref().and_then(|it| it.control.clone()),
        None,
        "a nudge is none"
    );
    bench.slowly(0, &[500]);
    let learning = bench.seen.learning.clone().expect("it goes on");
    assert_eq!(learning.control, Some(("nano".into(), 1)));
    bench.turn_view(45.0);
    assert_eq!(bench.seen.learning, None);
    assert!(
        bench.notes().contains("nano 1 drives VIEW<5>"),
        "{}",
        bench.notes()
    );
    let text = bench.rig.network_text();
    assert!(text.contains("CONNECT NANO<1>:<1>LEARN_NANO_1;"), "{text}");
    assert!(
        bench.rig.show().patches.contains("LEARN_NANO_1"),
        "it is part of the show"
    );
    // −180 to 180 degrees: 45 is at 0.625.
    bench.slowly(0, &[520, 600]);
    assert!((bench.azimuth_deg() - 45.0).abs() < 1e-9);
    bench.slowly(0, &[620, 750]);
    assert!((bench.azimuth_deg() - 90.0).abs() < 1e-9);
    bench.step(&[Command::Undo]);
    assert_eq!(bench.rig.network_text(), before);
    bench.step(&[Command::Redo]);
    assert_eq!(bench.rig.network_text(), text);
    bench.step(&[Command::UnbindControl {
        device: "nano".into(),
        control: 1,
    }]);
    assert_eq!(bench.rig.network_text(), before);
}

fn bind(control: u8, to: &str, inlet: u8) -> Command {
    Command::BindControl(Binding {
        device: "nano".into(),
        control,
        page: None,
        to: to.into(),
        inlet,
        range: None,
    })
}

fn elbow_deg(bench: &Bench) -> f64 {
    let pose = bench.seen.puppet_pose.as_ref().expect("there is a puppet");
    let place = pose.names.iter().position(|it| it == "elbow_flex");
    pose.angles_rad[place.expect("it has an elbow")].to_degrees()
}

#[test]
fn dials_buttons_and_sticks_are_bound_each_in_its_way() {
    let mut bench = Bench::new("");
    bench.step(&[
        bind(3, "PUPPET.elbow_flex", 1),
        bind(4, "TIME", 5),
        bind(5, "TIME", 2),
    ]);
    let start = elbow_deg(&bench);
    bench.say(
        "nano",
        InputEvent::Dial {
            control: 0,
            delta_counts: 6,
        },
    );
    bench.step(&[]);
    let quarter = elbow_deg(&bench) - start;
    assert!(
        (quarter - 22.5).abs() < 1e-9,
        "a quarter of 90 degrees: {quarter}"
    );
    let looped = bench.seen.transport.looped;
    for down in [true, false] {
        bench.say("nano", InputEvent::Button { control: 0, down });
    }
    bench.step(&[]);
    assert_ne!(bench.seen.transport.looped, looped, "once, not twice");
    let controls = bench.view().controls;
    assert_eq!(
        (controls[3].mode, &controls[4].bound[..]),
        ("press", &["TIME<1>".to_owned()][..])
    );
}

#[test]
fn what_cannot_be_bound_is_said() {
    let mut bench = Bench::new("");
    for (command, words) in [
        (bind(1, "TIME", 3), "use a button"),
        (bind(1, "NOTHING", 3), "the network has nothing called NOTHING"),
        (bind(9, "TIME", 2), "nano has no control 9"),
    ] {
        bench.step(&[command]);
        assert!(bench.notes().contains(words), "{}", bench.notes());
    }
    assert!(!bench.rig.network_text().contains("LEARN"));
}

#[test]
fn each_message_has_a_time_of_its_own() {
    let mut bench = Bench::new("");
    let place = bench.rig.controls.find("nano").expect("it is known");
    let source = Source {
        counts_per_turn: 1.0,
        surface: None,
    };
    let mut seen = Vec::new();
    let now = bench.rig.now;
    for after_ms in [2, 5, 3, 9] {
        let event = Stamped {
            at: now.after(std::time::Duration::from_millis(after_ms)),
            what: InputEvent::Dial {
                control: 0,
                delta_counts: 1,
            },
        };
        // The step is at seven milliseconds.
        bench.rig.now = now.after(std::time::Duration::from_millis(7));
        bench.rig.hear(place, &event, source);
        seen.push((bench.rig.wiring.machine().secs() - now.since(bench.rig.began).as_secs_f64()) * 1e3);
    }
    let expected = [2.0, 5.0, 5.0, 7.0];
    let near = seen
        .iter()
        .zip(expected)
        .all(|(seen, wanted)| (seen - wanted).abs() < 1e-6);
    assert!(near, "neither back nor beyond the step: {seen:?}");
}

#[test]
fn edges_are_never_merged() {
    let mut bench = Bench::new(
        "one := F:CONSTANT; SEND 1 TO <2>one; sum := F:ACCUMULATE; VARIABLE out;
         CONNECT NANO<4>:<1>one; CONNECT one<1>:<1>sum; CONNECT sum<1>:<1>out;",
    );
    for down in [true, false, true, false] {
        bench.say("nano", InputEvent::Button { control: 0, down });
    }
    bench.step(&[]);
    let out = bench.rig.wiring.machine().held("out").and_then(Value::as_number);
    assert_eq!(out, Some(4.0));
}

#[test]
fn a_device_that_comes_late_finds_its_connections() {
    let mut bench = Bench::without_device(
        "s := F:MULC; SEND 90 TO <2>s; CONNECT NANO<1>:<1>s; CONNECT s<1>:<5>VIEW; SEND 'jump' TO <1>NANO_MODE;
         SEND 'turn' TO <1>NANO_LABEL; CONNECT NANO<2>:<6>VIEW; DISCONNECT NANO<2>:ALL;",
    );
    assert!(
        bench.notes().contains("NANO"),
        "a program says what it lacks: {}",
        bench.notes()
    );
    bench.plug("nano");
    bench.step(&[]);
    let view = bench.view();
    assert_eq!(
        (view.controls[0].mode, view.controls[0].label.as_str()),
        ("jump", "turn")
    );
    assert_eq!(view.controls[1].bound, [""; 0]);
    bench.slowly(0, &[0, 500]);
    assert!((bench.azimuth_deg() - 45.0).abs() < 1e-9);
    assert_eq!(view.instance, "NANO");
}

#[test]
fn equal_devices_are_told_apart_and_a_taken_name_is_said() {
    let mut bench = Bench::new("NANO_B := F:NOP;");
    bench.plug("Nano");
    let names: Vec<&str> = bench
        .rig
        .controls
        .instances
        .iter()
        .map(|it| it.name.as_str())
        .collect();
    assert_eq!(names, ["NANO", "NANO2"]);
    bench.plug("nano b");
    assert!(
        bench.notes().contains("NANO_B denotes something already"),
        "{}",
        bench.notes()
    );
}

#[test]
fn settings_and_labels_are_undone_too() {
    let mut bench = Bench::new("");
    let label = |text: &str| Command::SetControlLabel {
        device: "nano".into(),
        control: 1,
        text: text.into(),
    };
    bench.step(&[label("one")]);
    bench.wait(1.5);
    bench.step(&[label("two")]);
    bench.step(&[]);
    assert_eq!(bench.view().controls[0].label, "two");
    bench.step(&[Command::Undo]);
    assert_eq!(bench.view().controls[0].label, "one");
    bench.step(&[Command::Undo]);
    assert_eq!(bench.view().controls[0].label, "");
    bench.step(&[Command::Controls(ControlCommand::Mode {
        device: "nano".into(),
        control: 1,
        mode: "sideways".into(),
    })]);
    bench.step(&[]);
    assert!(
        bench.notes().contains("\"sideways\" is no mode of a fader"),
        "{}",
        bench.notes()
    );
}

#[test]
fn nothing_is_sent_back_to_the_control_in_hand() {
    let mut bench = Bench::new(FADER);
    bench.turn_view(45.0);
    bench.wait(0.3);
    let motor = |bench: &Bench| {
        let all = bench.shown.iter().filter_map(|it| match it {
            Feedback::Motor { control: 0, value } => Some(*value),
            _ => None,
        });
        all.collect::<Vec<_>>()
    };
    assert_eq!(
        motor(&bench).last(),
        Some(&500),
        "the motor goes to where the view is"
    );
    bench.fader(0, 500);
    bench.shown.clear();
    for value in (480..=800).step_by(20) {
        bench.fader(0, value);
    }
    bench.wait(0.3);
    assert_eq!(motor(&bench), [] as [i32; 0], "{:?}", bench.shown);
    // A finger rests on it while somebody else turns the view; the motor waits for the finger.
    bench.say(
        "nano",
        InputEvent::AxisTouched {
            control: 0,
            down: true,
        },
    );
    bench.turn_view(-36.0);
    bench.wait(0.3);
    assert_eq!(motor(&bench), [] as [i32; 0]);
    bench.say(
        "nano",
        InputEvent::AxisTouched {
            control: 0,
            down: false,
        },
    );
    bench.wait(0.3);
    assert_eq!(motor(&bench), [400]);
}

#[test]
fn labels_say_what_is_bound_and_lamps_and_rings_what_the_network_sends() {
    let mut bench = Bench::new(&format!(
        "{FADER} CONNECT NANO<4>:<4>NANO_LAMP; CONNECT NANO<1>:<3>NANO_RING;"
    ));
    bench.wait(0.2);
    let label = |bench: &Bench| {
        let mut all = bench.shown.iter().rev();
        all.find_map(|it| match it {
            Feedback::Label { control: 0, text } => Some(text.clone()),
            _ => None,
        })
    };
    assert_eq!(label(&bench).as_deref(), Some("turn"));
    bench.slowly(0, &[0, 10]);
    assert_eq!(
        label(&bench).as_deref(),
        Some("0.90°"),
        "while it is moved, how far"
    );
    bench.wait(1.5);
    assert_eq!(label(&bench).as_deref(), Some("turn"));
    bench.shown.clear();
    bench.say(
        "nano",
        InputEvent::Button {
            control: 0,
            down: true,
        },
    );
    bench.step(&[]);
    bench.fader(0, 500);
    let lamp = Feedback::Lamp {
        control: 0,
        level: 255,
        colour: None,
    };
    assert!(bench.shown.contains(&lamp), "{:?}", bench.shown);
    let ring = bench
        .shown
        .iter()
        .any(|it| matches!(it, Feedback::Ring { value: Some(_), .. }));
    assert!(ring, "{:?}", bench.shown);
    bench.shown.clear();
    let lamp_output = 5;
    bench.commands("SEND FALSE TO <4>NANO_LAMP;");
    bench.shown.clear();
    bench.step(&[Command::TestOutput {
        device: "nano".into(),
        output: lamp_output,
    }]);
    assert_eq!(bench.shown, [lamp]);
    bench.wait(1.2);
    assert!(
        matches!(bench.shown.last(), Some(Feedback::Lamp { level: 0, .. })),
        "{:?}",
        bench.shown
    );
}

#[test]
fn fine_gear_makes_everything_a_tenth() {
    let mut bench = Bench::new(&format!("{FADER} CONNECT NANO<3>:<2>VIEW;"));
    bench.turn_view(45.0);
    bench.slowly(0, &[480, 500]);
    bench.step(&[Command::Controls(ControlCommand::Fine(true))]);
    bench.slowly(0, &[600]);
    assert!((bench.azimuth_deg() - 45.9).abs() < 1e-9);
    let before = bench.seen.view.elevation_rad;
    bench.say(
        "nano",
        InputEvent::Dial {
            control: 0,
            delta_counts: 24,
        },
    );
    bench.step(&[]);
    assert!(((bench.seen.view.elevation_rad - before).to_degrees() - 0.1).abs() < 1e-9);
}
