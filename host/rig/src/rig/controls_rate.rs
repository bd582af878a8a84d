//! What springs back and goes by its speed: it stands still in its middle, when its device is gone, and wherever it is
//! joined to something while it is pushed.

use proptest::prelude::*;

use super::bench::Bench;
use super::*;
use crate::command::{Binding, LearnCommand, NetworkEdit};

/// The stick's axis, as its events number it.
const STICK: u16 = 2;
/// Degrees a second of the view for a stick pushed all the way.
const DEG_PER_SEC: f64 = 90.0;
/// A step of the bench, seconds.
const STEP_SECS: f64 = 0.01;

fn push(bench: &mut Bench, counts: i32) {
    bench.say(
        "nano",
        InputEvent::Axis {
            control: STICK,
            value: counts,
        },
    );
    bench.step(&[]);
}

/// A stick learnt onto the view's turn, by touching both.
fn learnt() -> Bench {
    let mut bench = Bench::new("");
    bench.step(&[Command::Learn(LearnCommand::Begin)]);
    for counts in [0, 40, 80, 0] {
        push(&mut bench, counts);
    }
    bench.turn_view(10.0);
    bench.step(&[]);
    assert!(
        bench.notes().contains("nano 5 drives VIEW<5>"),
        "{}",
        bench.notes()
    );
    bench
}

fn turned(bench: &Bench, from_deg: f64) -> f64 {
    (bench.azimuth_deg() - from_deg + 540.0).rem_euclid(360.0) - 180.0
}

#[test]
fn a_stick_is_learnt_as_a_rate_and_stands_still_in_its_middle() {
    let mut bench = learnt();
    let stick = bench.view().controls[4].clone();
    assert_eq!((stick.mode, stick.picked_up), ("rate", true));
    assert_eq!(stick.bound, ["VIEW<1>"]);
    let before = bench.azimuth_deg();
    push(&mut bench, 50);
    bench.wait(0.4);
    push(&mut bench, 0);
    let went = turned(&bench, before);
    assert!((went - 0.5 * DEG_PER_SEC * 0.41).abs() < 0.5, "{went}");
    let stood = bench.azimuth_deg().to_bits();
    bench.wait(2.0);
    assert_eq!(bench.azimuth_deg().to_bits(), stood, "to the last bit");
    push(&mut bench, -100);
    bench.wait(0.1);
    assert!(turned(&bench, f64::from_bits(stood)) < -8.0);
    // One step takes it back, mode and all.
    push(&mut bench, 0);
    bench.step(&[Command::Undo]);
    bench.step(&[]);
    assert_eq!(bench.view().controls[4].mode, "pickup");
}

#[test]
fn its_middle_is_as_wide_as_its_dead_zone() {
    let mut bench = learnt();
    bench.commands("SEND 0.2 TO <5>NANO_ZONE;");
    bench.step(&[]);
    let before = bench.azimuth_deg().to_bits();
    for counts in [5, 20, -20, 11] {
        push(&mut bench, counts);
        bench.wait(0.5);
    }
    assert_eq!(bench.azimuth_deg().to_bits(), before);
    push(&mut bench, 60);
    bench.wait(0.2);
    let went = turned(&bench, f64::from_bits(before));
    assert!(
        (went - 0.5 * DEG_PER_SEC * 0.2).abs() < 1.0,
        "half of what is left: {went}"
    );
}

#[test]
fn unplugged_while_it_is_pushed_it_freezes_and_a_return_moves_nothing() {
    let mut bench = learnt();
    push(&mut bench, 100);
    bench.wait(0.2);
    bench.rig.noticed(&Change::Gone("nano".into(), "out".into()));
    bench.step(&[]);
    let stood = bench.azimuth_deg().to_bits();
    bench.wait(1.0);
    assert_eq!(bench.azimuth_deg().to_bits(), stood);
    bench.rig.noticed(&Change::Came("nano".into()));
    bench.wait(1.0);
    assert_eq!(bench.azimuth_deg().to_bits(), stood);
    push(&mut bench, 100);
    bench.wait(0.2);
    let went = turned(&bench, f64::from_bits(stood));
    assert!((went - DEG_PER_SEC * 0.2).abs() < 1.5, "{went}");
}

#[test]
fn joined_to_something_while_it_is_pushed_it_waits_for_its_middle() {
    let mut bench = Bench::new("");
    push(&mut bench, 0);
    push(&mut bench, 100);
    bench.step(&[
        Command::Learn(LearnCommand::Control {
            device: "nano".into(),
            control: 5,
        }),
        Command::Learn(LearnCommand::Parameter {
            name: "VIEW".into(),
            inlet: 5,
        }),
    ]);
    let before = bench.azimuth_deg().to_bits();
    bench.wait(0.5);
    push(&mut bench, 80);
    bench.wait(0.5);
    assert_eq!(bench.azimuth_deg().to_bits(), before);
    assert!(!bench.view().controls[4].picked_up);
    push(&mut bench, 0);
    push(&mut bench, 80);
    bench.wait(0.1);
    assert!(turned(&bench, f64::from_bits(before)) > 5.0);
    // Another page drives nothing, and coming back to this one while it is pushed does not go on.
    let page = |page| {
        Command::Controls(ControlCommand::Page {
            device: "nano".into(),
            page,
        })
    };
    bench.step(&[page(2)]);
    let stood = bench.azimuth_deg().to_bits();
    bench.wait(0.2);
    bench.step(&[page(1)]);
    bench.wait(0.2);
    assert_eq!(bench.azimuth_deg().to_bits(), stood);
}

#[test]
fn a_stick_that_was_told_to_be_placed_is_and_a_range_places_it_too() {
    let bind = |range| {
        Command::BindControl(Binding {
            device: "nano".into(),
            control: 5,
            page: None,
            to: "TIME".into(),
            inlet: 2,
            range,
        })
    };
    let mut bench = Bench::new("SEND 'jump' TO <5>NANO_MODE;");
    bench.step(&[]);
    bench.step(&[bind(None)]);
    bench.step(&[]);
    assert_eq!(bench.view().controls[4].mode, "jump");
    assert_eq!(bench.view().controls[4].bound, ["TIME<2>"]);
    let mut bench = learnt();
    bench.step(&[bind(Some([0.0, 2.0]))]);
    bench.step(&[]);
    let stick = bench.view().controls[4].clone();
    assert_eq!((stick.mode, stick.bound[0].as_str()), ("pickup", "TIME<2>"));
}

/// What may happen to a stick that is learnt.
#[derive(Clone, Debug)]
enum Happening {
    Push(i32),
    Wait(u8),
    Replug,
    Page,
    Reload,
}

fn happening() -> impl Strategy<Value = Happening> {
    prop_oneof![
        6 => (-100..=100).prop_map(Happening::Push),
        2 => Just(Happening::Push(0)),
        4 => (1..40_u8).prop_map(Happening::Wait),
        1 => Just(Happening::Replug),
        1 => Just(Happening::Page),
        1 => Just(Happening::Reload),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// In no step does the view go farther than a stick pushed all the way would take it; where the stick is in its
    /// middle, or its device away, it does not go at all.
    #[test]
    fn a_rate_never_steps_and_stands_where_nothing_pushes(happenings in prop::collection::vec(happening(), 1..40)) {
        let mut bench = learnt();
        let mut pushed = 0;
        for it in happenings {
            match it {
                Happening::Push(counts) => {
                    pushed = counts;
                    bench.say("nano", InputEvent::Axis { control: STICK, value: counts });
                }
                Happening::Wait(_) => {}
                Happening::Replug => {
                    bench.rig.noticed(&Change::Gone("nano".into(), "out".into()));
                    pushed = 0;
                }
                Happening::Page => {
                    let page = 3 - bench.view().page;
                    let command = ControlCommand::Page { device: "nano".into(), page };
                    bench.step(&[Command::Controls(command)]);
                }
                Happening::Reload => {
                    let text = format!("{} {{ again }}", bench.rig.show().program_text());
                    bench.step(&[Command::Network(NetworkEdit::Program(text))]);
                }
            }
            let steps = if let Happening::Wait(steps) = it { steps } else { 1 };
            for _ in 0..steps {
                let before = bench.azimuth_deg();
                // What was said since the last step is of the time before it.
                let greatest = if pushed == 0 && !matches!(it, Happening::Push(_)) { 0.0 } else { DEG_PER_SEC * STEP_SECS };
                bench.step(&[]);
                let by = turned(&bench, before);
                prop_assert!(by.abs() <= greatest + 1e-9, "{by} where {greatest} are allowed after {it:?}");
                if greatest == 0.0 {
                    prop_assert_eq!(bench.azimuth_deg().to_bits(), before.to_bits());
                }
            }
            if matches!(it, Happening::Replug) {
                bench.rig.noticed(&Change::Came("nano".into()));
            }
        }
    }
}
