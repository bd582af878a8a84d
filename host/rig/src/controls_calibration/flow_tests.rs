//! The flow of calibration, step by step, on counts as devices say them.

use super::super::view::Measured;
use super::*;
use device::codec::Tool;
use device_profiles::ControlKind;

/// A device with a tablet, two faders, a stick (axis 2) and eight dials; the control meant is the one of that kind.
fn subject(kind: Option<(ControlKind, u16)>) -> Subject {
    let control = kind.map(|(kind, of_class)| Control {
        number: of_class as u8 + 1,
        name: format!("{} {}", kind.word(), of_class + 1),
        kind,
        of_class,
        range: if kind == ControlKind::Axis {
            [-350, 350]
        } else {
            [0, 1023]
        },
        noise_counts: 0,
        counts_per_turn: 256.0,
        at: None,
    });
    Subject {
        device: device(),
        control,
        sheet: Some(Sheet {
            max_counts: [10_000, 5_000],
            counts_per_inch: [2540.0, 2540.0],
        }),
        pressure_max: 2047,
        holds: ControlsCalibration::default(),
    }
}

fn begun(command: &CalibrateControl, kind: Option<(ControlKind, u16)>) -> Calibrating {
    Calibrating::begin(command, subject(kind)).expect("the device has it")
}

fn ends() -> Calibrating {
    let command = CalibrateControl::Ends {
        device: device(),
        control: 1,
    };
    begun(&command, Some((ControlKind::Fader, 0)))
}

fn corners() -> Calibrating {
    begun(&CalibrateControl::Corners { device: device() }, None)
}

fn pressure() -> Calibrating {
    begun(&CalibrateControl::Pressure { device: device() }, None)
}

fn device() -> String {
    "box".to_owned()
}

fn axis(control: u16, value: i32) -> InputEvent {
    InputEvent::Axis { control, value }
}

fn pen(x_counts: u32, y_counts: u32, pressure_counts: u32) -> InputEvent {
    InputEvent::Pen(PenSample {
        pressure_counts,
        tip: pressure_counts > 100,
        ..PenSample::hovering(Tool::Pen, x_counts, y_counts)
    })
}

fn taken(calibrating: &Calibrating) -> ControlsCalibration {
    calibrating.proposed().cloned().expect("there is a result")
}

#[test]
fn a_dial_is_turned_once_and_other_dials_do_not_count() {
    let command = CalibrateControl::Dial {
        device: device(),
        control: 4,
        turns: 1,
    };
    let mut calibrating = begun(&command, Some((ControlKind::Dial, 3)));
    let view = calibrating.view();
    assert!(view.instruction.contains("dial 4 once round"), "{view:?}");
    assert_eq!(view.replaces, "256.0 counts in a turn, the profile's");
    for (control, delta_counts) in [(3, 90), (2, 500), (3, 110)] {
        calibrating.hear(&InputEvent::Dial {
            control,
            delta_counts,
        });
    }
    assert_eq!(calibrating.view().seen, "200 counts");
    calibrating.next();
    let view = calibrating.view();
    assert_eq!(view.result.as_deref(), Some("200.0 counts in a turn"));
    assert_eq!((view.step, view.steps), (2, 2));
    assert_eq!(taken(&calibrating).dials[&3], 200.0);
}

#[test]
fn a_step_that_went_wrong_says_so_and_is_done_again() {
    let mut calibrating = ends();
    calibrating.hear(&axis(0, 500));
    calibrating.hear(&axis(0, 560));
    calibrating.next();
    let view = calibrating.view();
    assert!(view.result.is_none() && view.fault.expect("told").contains("500 to 560"));
    assert!(calibrating.proposed().is_none());
    for value in [1010, 700, 12] {
        calibrating.hear(&axis(0, value));
    }
    let Measured::Travel { seen, at, .. } = calibrating.view().measured else {
        panic!("a fader has travel");
    };
    assert_eq!((seen, at), (Some([12, 1010]), Some(12)));
    calibrating.next();
    assert_eq!(calibrating.view().fault, None);
    assert_eq!(taken(&calibrating).axes[&0].ends, [1006, 16], "a little inside");
}

#[test]
fn a_control_that_was_not_moved_and_a_wrong_one_are_told() {
    let mut calibrating = ends();
    calibrating.next();
    let fault = calibrating.fault().expect("told");
    assert!(fault.contains("did not move"), "{fault}");
    calibrating.hear_other("fader 2 of box", 0.04);
    assert!(
        calibrating.fault().is_some_and(|it| it.contains("did not move")),
        "noise"
    );
    calibrating.hear_other("fader 2 of box", 0.3);
    let fault = calibrating.fault().expect("told");
    assert_eq!(fault, "that was fader 2 of box; calibrated is fader 1 of box");
    calibrating.hear(&axis(0, 10));
    assert!(
        !calibrating.fault().is_some_and(|it| it.contains("fader 2")),
        "the right one moved"
    );
}

#[test]
fn a_device_that_goes_begins_its_step_again_and_keeps_a_result() {
    let mut calibrating = ends();
    calibrating.hear(&axis(0, 0));
    calibrating.away(true);
    assert!(
        calibrating
            .fault()
            .is_some_and(|it| it.contains("plug it in again"))
    );
    calibrating.next();
    assert!(calibrating.proposed().is_none());
    calibrating.away(false);
    assert_eq!(calibrating.fault(), None);
    for value in [900, 100] {
        calibrating.hear(&axis(0, value));
    }
    calibrating.next();
    assert_eq!(
        taken(&calibrating).axes[&0].ends,
        [896, 104],
        "the 0 of before is gone"
    );
    calibrating.away(true);
    assert_eq!(taken(&calibrating).axes[&0].ends, [896, 104]);
    assert!(calibrating.fault().is_some_and(|it| it.contains("all the same")));
}

#[test]
fn what_a_device_does_not_tell_for_noise_does_not_keep_it_from_its_ends() {
    let command = CalibrateControl::Ends {
        device: device(),
        control: 1,
    };
    let mut noisy = subject(Some((ControlKind::Fader, 0)));
    noisy.control.as_mut().expect("a fader").noise_counts = 16;
    let mut calibrating = Calibrating::begin(&command, noisy).expect("the device has it");
    for value in [204, 500, 816] {
        calibrating.hear(&axis(0, value));
    }
    calibrating.next();
    let calibration = taken(&calibrating).axes[&0];
    assert_eq!(calibration.ends, [220, 800]);
    // It stops up to its noise short of where it did before.
    assert_eq!((calibration.share(220), calibration.share(800)), (0.0, 1.0));
}

#[test]
fn three_rests_make_a_dead_zone_around_them() {
    let command = CalibrateControl::Rest {
        device: device(),
        control: 2,
    };
    let mut calibrating = begun(&command, Some((ControlKind::Axis, 1)));
    calibrating.next();
    assert!(calibrating.fault().is_some_and(|it| it.contains("push it aside")));
    for rest in [3, -5, 1] {
        calibrating.hear(&axis(1, 300));
        calibrating.hear(&axis(1, rest));
        calibrating.next();
    }
    let calibration = taken(&calibrating).axes[&1];
    assert_eq!(calibration.ends, [-350, 350]);
    assert!([3, -5, 1].iter().all(|&rest| calibration.share(rest) == 0.0));
    assert_eq!((calibration.share(-350), calibration.share(350)), (-1.0, 1.0));
}

#[test]
fn a_rest_at_an_end_is_no_rest() {
    let command = CalibrateControl::Rest {
        device: device(),
        control: 2,
    };
    let mut calibrating = begun(&command, Some((ControlKind::Axis, 1)));
    for _ in 0..3 {
        calibrating.hear(&axis(1, 0));
        calibrating.hear(&axis(1, 350));
        calibrating.next();
    }
    assert!(calibrating.fault().is_some_and(|it| it.contains("no middle")));
}

#[test]
fn two_corners_make_an_area_in_whatever_order() {
    for places in [[(2000, 1000), (8000, 4000)], [(8000, 1000), (2000, 4000)]] {
        let mut calibrating = corners();
        for (x, y) in places {
            calibrating.hear(&pen(x, y, 0));
            calibrating.hear(&pen(x, y, 800));
            calibrating.hear(&pen(x, y, 900));
            calibrating.hear(&pen(x, y, 0));
        }
        let area = taken(&calibrating)
            .tablet
            .expect("a tablet")
            .area
            .expect("an area");
        assert!((area.corner_mm[0] - 20.0).abs() < 1e-9 && (area.corner_mm[1] - 10.0).abs() < 1e-9);
        assert!((area.size_mm[0] - 60.0).abs() < 1e-9 && (area.size_mm[1] - 30.0).abs() < 1e-9);
        let Measured::Area { touched_mm, .. } = calibrating.view().measured else {
            panic!("an area has a picture of one");
        };
        assert_eq!(touched_mm.len(), 2);
    }
}

#[test]
fn corners_that_are_one_place_are_refused_and_touched_again() {
    let mut calibrating = corners();
    for _ in 0..2 {
        calibrating.hear(&pen(5000, 2500, 800));
        calibrating.hear(&pen(5000, 2500, 0));
    }
    let view = calibrating.view();
    assert!(view.fault.is_some_and(|it| it.contains("5 mm at least")));
    assert_eq!((view.step, view.seen.as_str()), (1, "0 of 2 corners"));
}

#[test]
fn a_worn_pen_gets_a_curve_that_begins_above_its_hovering() {
    let mut calibrating = pressure();
    for counts in [40, 120, 1500] {
        calibrating.hear(&pen(1, 1, counts / 2));
        calibrating.hear(&pen(1, 1, counts));
        calibrating.next();
    }
    let curve = taken(&calibrating).tablet.expect("a tablet").pressure;
    assert_eq!((curve.share(40, 2047), curve.share(1500, 2047)), (0.0, 1.0));
    assert!(!curve.tip(false, 40, 2047) && curve.tip(false, 120, 2047) && !curve.tip(true, 40, 2047));
}

#[test]
fn a_pen_that_presses_no_harder_does_that_step_again_and_no_other() {
    let mut calibrating = pressure();
    calibrating.next();
    assert!(calibrating.fault().is_some_and(|it| it.contains("not seen")));
    calibrating.hear(&pen(1, 1, 40));
    calibrating.next();
    calibrating.hear(&pen(1, 1, 30));
    calibrating.next();
    assert!(calibrating.fault().is_some_and(|it| it.contains("press harder")));
    assert_eq!(calibrating.view().step, 2);
    for counts in [120, 1500] {
        calibrating.hear(&pen(1, 1, counts));
        calibrating.next();
    }
    assert!(calibrating.proposed().is_some());
}

#[test]
fn what_the_device_lacks_is_told_at_once() {
    let of = |command: &CalibrateControl, subject: Subject| {
        Calibrating::begin(command, subject).expect_err("refused")
    };
    let (device, control, turns) = (device(), 1, 1);
    let dial = CalibrateControl::Dial {
        device: device.clone(),
        control,
        turns,
    };
    assert_eq!(
        of(&dial, subject(Some((ControlKind::Fader, 0)))),
        "fader 1 of box is a fader; only dials have turns to count"
    );
    let ends = CalibrateControl::Ends {
        device: device.clone(),
        control,
    };
    assert!(of(&ends, subject(Some((ControlKind::Dial, 0)))).contains("have ends"));
    let rest = CalibrateControl::Rest {
        device: device.clone(),
        control,
    };
    assert!(of(&rest, subject(Some((ControlKind::Fader, 0)))).contains("spring back"));
    let bare = Subject {
        sheet: None,
        ..subject(None)
    };
    let corners = CalibrateControl::Corners {
        device: device.clone(),
    };
    assert!(of(&corners, bare).contains("no tablet"));
    let deaf = Subject {
        pressure_max: 0,
        ..subject(None)
    };
    assert!(of(&CalibrateControl::Pressure { device }, deaf).contains("no pressure"));
    assert!(!of(&CalibrateControl::Take, subject(None)).is_empty());
}
