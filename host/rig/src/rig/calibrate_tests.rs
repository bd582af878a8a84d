//! Calibration in a whole rig: what it drives meanwhile and after, what is kept, and that nothing ever steps.

use proptest::prelude::*;

use super::super::controls::bench::Bench;
use super::*;
use crate::command::{Command, LearnCommand, NetworkEdit};
use crate::controls_calibration::{Area, Measured};

/// The first fader on the azimuth, 0 to 90 degrees; the dial turns the elevation.
const FADER: &str = "s := F:MULC; SEND 90 TO <2>s; CONNECT NANO<1>:<1>s; CONNECT s<1>:<5>VIEW;
    d := F:MULC; SEND 36 TO <2>d; CONNECT NANO<3>:<1>d; CONNECT d<1>:<2>VIEW;";

fn ask(command: CalibrateControl) -> Command {
    Command::CalibrateControl(command)
}

fn nano() -> String {
    "nano".to_owned()
}

fn ends(control: u8) -> CalibrateControl {
    CalibrateControl::Ends {
        device: nano(),
        control,
    }
}

fn dial(control: u8) -> CalibrateControl {
    CalibrateControl::Dial {
        device: nano(),
        control,
        turns: 1,
    }
}

fn rest(control: u8) -> CalibrateControl {
    CalibrateControl::Rest {
        device: nano(),
        control,
    }
}

fn turned(bench: &mut Bench, delta_counts: i32) {
    bench.say(
        "nano",
        InputEvent::Dial {
            control: 0,
            delta_counts,
        },
    );
    bench.step(&[]);
    bench.step(&[]);
}

fn calibration(bench: &Bench) -> CalibrationView {
    bench.seen.calibration.clone().expect("one is under way")
}

fn fault(bench: &Bench) -> String {
    calibration(bench).fault.unwrap_or_default()
}

#[test]
fn a_fader_is_measured_drives_nothing_meanwhile_and_has_to_be_picked_up_after() {
    let mut bench = Bench::new(FADER);
    bench.slowly(0, &[0, 10, 500]);
    assert!((bench.azimuth_deg() - 45.0).abs() < 1e-9);
    bench.step(&[ask(ends(1))]);
    bench.slowly(0, &[200, 500, 800]);
    assert!((bench.azimuth_deg() - 45.0).abs() < 1e-9, "it drives nothing");
    let view = calibration(&bench);
    assert_eq!(
        (view.what.as_str(), view.seen.as_str()),
        ("fader 1", "200 to 800")
    );
    assert_eq!(view.replaces, "from 0 to 1000 counts, the profile's");
    bench.step(&[ask(CalibrateControl::Next)]);
    bench.step(&[]);
    let view = calibration(&bench);
    assert_eq!(view.result.as_deref(), Some("from 203 to 797 counts"));
    let Measured::Travel { proposed, .. } = view.measured else {
        panic!("a fader has travel");
    };
    assert_eq!(proposed.map(|it| it.ends), Some([203, 797]));
    bench.step(&[ask(CalibrateControl::Take)]);
    bench.step(&[]);
    assert!(bench.seen.calibration.is_none() && bench.view().controls[0].calibrated);
    assert!(
        bench
            .notes()
            .contains("fader 1 of nano: from 203 to 797 counts (before: from 0 to 1000")
    );
    // It stands at its upper end; the view at the middle.
    bench.slowly(0, &[800, 790]);
    assert!((bench.azimuth_deg() - 45.0).abs() < 1e-9);
    bench.slowly(0, &[500]);
    assert!((bench.azimuth_deg() - 45.0).abs() < 1e-9, "there it takes hold");
    bench.slowly(0, &[650]);
    let want_deg = 90.0 * f64::from(650 - 203) / f64::from(797 - 203);
    assert!((bench.azimuth_deg() - want_deg).abs() < 1e-9);
    bench.slowly(0, &[800]);
    assert!((bench.azimuth_deg() - 90.0).abs() < 1e-9);
}

#[test]
fn a_dial_turned_once_counts_so_from_then_on() {
    let mut bench = Bench::new(FADER);
    bench.step(&[ask(dial(3))]);
    turned(&mut bench, 30);
    assert_eq!(bench.seen.view.elevation_rad, 0.0);
    bench.step(&[ask(CalibrateControl::Next), ask(CalibrateControl::Take)]);
    turned(&mut bench, 15);
    let elevation_deg = bench.seen.view.elevation_rad.to_degrees();
    assert!(
        (elevation_deg.abs() - 18.0).abs() < 1e-9,
        "half a turn is {elevation_deg}"
    );
    bench.step(&[ask(CalibrateControl::Forget {
        device: nano(),
        control: Some(3),
    })]);
    turned(&mut bench, 12);
    let after_deg = bench.seen.view.elevation_rad.to_degrees();
    assert!(
        ((after_deg - elevation_deg).abs() - 18.0).abs() < 1e-9,
        "24 counts a turn again"
    );
}

#[test]
fn a_stick_that_rests_beside_the_middle_is_quiet_there() {
    let mut bench = Bench::new("CONNECT NANO<5>:<1>VIEW;");
    let push = |bench: &mut Bench, value| {
        bench.say("nano", InputEvent::Axis { control: 2, value });
        bench.step(&[]);
    };
    bench.step(&[ask(rest(5))]);
    for value in [9, 11, 10] {
        push(&mut bench, 60);
        push(&mut bench, value);
        bench.step(&[ask(CalibrateControl::Next)]);
    }
    bench.step(&[ask(CalibrateControl::Take)]);
    for value in [9, 11, 10] {
        push(&mut bench, value);
        assert_eq!(bench.view().controls[4].value, 0.0, "{value}");
    }
    push(&mut bench, 100);
    assert_eq!(bench.view().controls[4].value, 1.0);
    push(&mut bench, -100);
    assert_eq!(bench.view().controls[4].value, -1.0);
}

#[test]
fn what_goes_wrong_is_told_and_nothing_is_lost() {
    let mut bench = Bench::new(FADER);
    let refused = |bench: &mut Bench, command: CalibrateControl, words: &str| {
        bench.step(&[ask(command)]);
        let last = bench
            .seen
            .notes
            .last()
            .map(|note| note.text.clone())
            .unwrap_or_default();
        assert!(last.contains(words), "{last} is not about {words}");
    };
    refused(&mut bench, CalibrateControl::Next, "begin with a device");
    refused(&mut bench, CalibrateControl::Take, "begin with a device");
    refused(&mut bench, ends(9), "numbered 1 to 5");
    refused(&mut bench, ends(4), "button of nano is a button");
    refused(&mut bench, dial(1), "only dials");
    refused(
        &mut bench,
        CalibrateControl::Corners { device: nano() },
        "no tablet",
    );
    let away = CalibrateControl::Corners { device: "pad".into() };
    refused(&mut bench, away, "there is no input device pad; there are: nano");
    bench.step(&[ask(ends(1))]);
    refused(&mut bench, ends(2), "being calibrated already");
    refused(&mut bench, CalibrateControl::Take, "no result to keep yet");
    let forget = CalibrateControl::Forget {
        device: nano(),
        control: None,
    };
    refused(&mut bench, forget, "keep what came of it, or cancel it first");
    bench.step(&[ask(CalibrateControl::Next)]);
    assert!(fault(&bench).contains("did not move"));
    // The wrong fader.
    bench.slowly(1, &[0, 300]);
    assert_eq!(
        fault(&bench),
        "that was fader 2 of nano; calibrated is fader 1 of nano"
    );
    bench.slowly(0, &[500, 520]);
    bench.step(&[ask(CalibrateControl::Next)]);
    assert!(fault(&bench).contains("only from 500 to 520"));
    bench.slowly(0, &[0, 400]);
    bench
        .rig
        .noticed(&Change::Gone(nano(), "the cable is out".into()));
    bench.step(&[ask(CalibrateControl::Next)]);
    assert!(fault(&bench).contains("plug it in again"));
    bench.rig.noticed(&Change::Came(nano()));
    bench.slowly(0, &[900, 100]);
    bench.step(&[ask(CalibrateControl::Next)]);
    bench
        .rig
        .noticed(&Change::Gone(nano(), "the cable is out".into()));
    bench.step(&[ask(CalibrateControl::Take)]);
    let kept = bench.rig.calibrated().get("nano").cloned().unwrap_or_default();
    assert_eq!(kept.axes.get(&0).map(|it| it.ends), Some([896, 104]));
    refused(&mut bench, ends(1), "does not answer");
}

#[test]
fn cancelling_leaves_everything_as_it_was() {
    let mut bench = Bench::new(FADER);
    bench.slowly(0, &[0, 10, 500]);
    bench.step(&[ask(ends(1))]);
    bench.slowly(0, &[200, 800]);
    bench.step(&[ask(CalibrateControl::Next), ask(CalibrateControl::Cancel)]);
    bench.step(&[]);
    assert!(bench.seen.calibration.is_none() && bench.rig.calibrated().is_empty());
    bench.slowly(0, &[510, 500, 600]);
    assert!((bench.azimuth_deg() - 54.0).abs() < 1e-9, "the profile's ends");
}

#[test]
fn what_was_taken_is_kept_and_holds_after_a_restart_and_a_return() {
    let folder = tempfile::tempdir().expect("a folder");
    let begun = || {
        let mut bench = Bench::without_device(FADER);
        let store = Store::open(folder.path()).expect("sound");
        bench.rig.calibrations = Calibrations::new(store);
        bench.plug("nano");
        bench
    };
    let mut bench = begun();
    bench.step(&[ask(ends(1))]);
    bench.slowly(0, &[100, 900]);
    bench.step(&[ask(CalibrateControl::Next), ask(CalibrateControl::Take)]);
    let mut bench = begun();
    assert!(bench.view().controls[0].calibrated, "after a restart");
    bench.slowly(0, &[100, 115, 500]);
    assert!((bench.azimuth_deg() - 45.0).abs() < 1e-9);
    bench
        .rig
        .noticed(&Change::Gone(nano(), "the cable is out".into()));
    bench.rig.noticed(&Change::Came(nano()));
    bench.slowly(0, &[480, 500, 700]);
    let want_deg = 90.0 * f64::from(700 - 104) / f64::from(896 - 104);
    assert!((bench.azimuth_deg() - want_deg).abs() < 1e-9, "after a return");
}

#[test]
fn a_file_that_cannot_be_read_is_told_and_not_written_over() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(crate::controls_calibration::store::FILE);
    let text = "version = 1\n[device.nano.axes.0]\nends = [5, 5]\n";
    std::fs::write(&file, text).expect("room");
    let mut bench = Bench::new(FADER);
    bench.rig.calibrations = Calibrations::new(Store::of_user(Some(folder.path())));
    let told = bench.rig.calibrations.fault().expect("told");
    assert!(
        told.contains("controls.toml:2:") && told.contains("its ends must differ"),
        "{told}"
    );
    bench.step(&[ask(ends(1))]);
    bench.slowly(0, &[100, 900]);
    bench.step(&[ask(CalibrateControl::Next), ask(CalibrateControl::Take)]);
    assert!(bench.notes().contains("until the end of the session"));
    assert!(bench.view().controls[0].calibrated, "it holds all the same");
    assert_eq!(std::fs::read_to_string(&file).expect("it is there"), text);
}

/// What may happen around a calibration.
#[derive(Clone, Debug)]
enum Happening {
    Move(i32, bool),
    Ask(CalibrateControl),
    Replug,
    Recall(Option<[i32; 2]>),
    Reload,
    Elsewhere(f64),
}

fn happening() -> impl Strategy<Value = Happening> {
    let forget = CalibrateControl::Forget {
        device: nano(),
        control: None,
    };
    prop_oneof![
        8 => (0..=1000, any::<bool>()).prop_map(|(to, quick)| Happening::Move(to, quick)),
        2 => Just(Happening::Ask(ends(1))),
        3 => Just(Happening::Ask(CalibrateControl::Next)),
        2 => Just(Happening::Ask(CalibrateControl::Take)),
        1 => Just(Happening::Ask(CalibrateControl::Cancel)),
        1 => Just(Happening::Ask(forget)),
        1 => Just(Happening::Replug),
        1 => prop::option::of((0..400, 600..1000).prop_map(|(from, to)| [from, to])).prop_map(Happening::Recall),
        1 => Just(Happening::Reload),
        1 => (-30.0..30.0_f64).prop_map(Happening::Elsewhere),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Whether a calibration begins, ends, is cancelled, forgotten or read back: what the fader drives moves only when
    /// the fader does, and no farther than the hand, the pickup distance apart.
    #[test]
    fn no_calibration_ever_steps_a_parameter(happenings in prop::collection::vec(happening(), 1..60)) {
        let mut bench = Bench::new(FADER);
        let mut place: Option<i32> = None;
        for it in happenings {
            let before = bench.azimuth_deg();
            let mut allowed_deg = 0.0;
            match it {
                Happening::Move(to, quick) => {
                    if !quick {
                        bench.wait(0.2);
                    }
                    let instance = &bench.rig.controls.instances[0];
                    let ends = instance.calibration.axes.get(&0).map_or([0, 1000], |axis| axis.ends);
                    let span = f64::from((ends[1] - ends[0]).abs());
                    let muted = bench.seen.calibration.is_some();
                    bench.fader(0, to);
                    if !muted {
                        allowed_deg = place.map_or(0.0, |from| {
                            90.0 * (f64::from((to - from).abs()) / span + crate::controls::pickup::NEAR)
                        });
                    }
                    place = Some(to);
                }
                Happening::Ask(command) => {
                    bench.step(&[ask(command)]);
                }
                Happening::Replug => {
                    bench.rig.noticed(&Change::Gone(nano(), "out".into()));
                    bench.step(&[]);
                    bench.rig.noticed(&Change::Came(nano()));
                }
                Happening::Recall(ends) => {
                    let axes = ends.map(|ends| (0, crate::controls_calibration::AxisCalibration {
                        ends,
                        rest: None,
                        dead_counts: 0,
                    }));
                    let known = ControlsCalibration { axes: axes.into_iter().collect(), ..ControlsCalibration::default() };
                    bench.rig.calibrations.store = Store::knowing([(nano(), known)].into());
                    bench.rig.controls.instances[0].identity.clear();
                }
                Happening::Reload => {
                    let text = format!("{} {{ again }}", bench.rig.show().program_text());
                    bench.step(&[Command::Network(NetworkEdit::Program(text))]);
                }
                Happening::Elsewhere(by_deg) => {
                    bench.turn_view(by_deg);
                    continue;
                }
            }
            bench.step(&[]);
            bench.step(&[]);
            let by = (bench.azimuth_deg() - before + 540.0).rem_euclid(360.0) - 180.0;
            prop_assert!(by.abs() <= allowed_deg + 1e-6, "{by} where {allowed_deg} are allowed");
        }
    }
}

#[test]
fn learning_and_takes_keep_out_of_a_calibration() {
    let mut bench = Bench::new(FADER);
    bench.step(&[Command::Learn(LearnCommand::Begin)]);
    bench.step(&[ask(ends(1))]);
    bench.step(&[]);
    assert!(bench.seen.learning.is_none());
    let start = crate::command::TakeCommand::Start {
        name: "t".into(),
        devices: Vec::new(),
        tolerance: None,
    };
    bench.step(&[Command::Take(start)]);
    assert!(bench.notes().contains("which no take keeps"));
}

#[test]
fn a_mapping_that_is_none_is_refused_in_words() {
    let mapping = TabletMapping {
        area: Some(Area {
            corner_mm: [0.0; 2],
            size_mm: [500.0, 20.0],
        }),
        ..TabletMapping::default()
    };
    let mut bench = Bench::new(FADER);
    bench.step(&[ask(CalibrateControl::Tablet {
        device: nano(),
        mapping,
    })]);
    assert!(bench.notes().contains("is no tablet"));
}
