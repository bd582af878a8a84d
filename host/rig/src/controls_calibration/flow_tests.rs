//! The flow of calibration, step by step, on counts as devices say them.

use super::*;
use device::codec::Tool;

fn subject() -> Subject {
    Subject {
        sheet: Some(Sheet {
            max_counts: [10_000, 5_000],
            counts_per_inch: [2540.0, 2540.0],
        }),
        pressure_max: 2047,
        ranges: vec![[0, 1023], [-350, 350]],
        dials: 8,
    }
}

fn begun(command: &CalibrateControl) -> Calibrating {
    Calibrating::begin(command, subject()).expect("the device has it")
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
    let mut calibration = ControlsCalibration::default();
    calibrating.take(&mut calibration).expect("there is a result");
    calibration
}

#[test]
fn a_dial_is_turned_once_and_other_dials_do_not_count() {
    let mut calibrating = begun(&CalibrateControl::Dial {
        device: device(),
        control: 3,
        turns: 1,
    });
    assert!(calibrating.view().instruction.contains("once round"));
    for (control, delta_counts) in [(3, 90), (2, 500), (3, 110)] {
        calibrating.hear(&InputEvent::Dial {
            control,
            delta_counts,
        });
    }
    assert_eq!(calibrating.view().seen, "200 counts");
    calibrating.next();
    assert_eq!(
        calibrating.view().result.as_deref(),
        Some("dial 3: 200.0 counts in a turn")
    );
    assert_eq!(taken(&calibrating).dials[&3], 200.0);
}

#[test]
fn a_step_that_went_wrong_says_so_and_is_done_again() {
    let mut calibrating = begun(&CalibrateControl::Ends {
        device: device(),
        control: 0,
    });
    calibrating.hear(&axis(0, 500));
    calibrating.hear(&axis(0, 560));
    calibrating.next();
    let view = calibrating.view();
    assert!(view.result.is_none() && view.fault.expect("told").contains("500 to 560"));
    assert!(calibrating.take(&mut ControlsCalibration::default()).is_err());
    for value in [1010, 700, 12] {
        calibrating.hear(&axis(0, value));
    }
    calibrating.next();
    assert_eq!(calibrating.view().fault, None);
    assert_eq!(taken(&calibrating).axes[&0].ends, [1010, 12]);
}

#[test]
fn three_rests_make_a_dead_zone_around_them() {
    let mut calibrating = begun(&CalibrateControl::Rest {
        device: device(),
        control: 1,
    });
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
fn two_corners_make_an_area_in_whatever_order() {
    for corners in [[(2000, 1000), (8000, 4000)], [(8000, 1000), (2000, 4000)]] {
        let mut calibrating = begun(&CalibrateControl::Corners { device: device() });
        for (x, y) in corners {
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
    }
}

#[test]
fn corners_that_are_one_place_are_refused_and_touched_again() {
    let mut calibrating = begun(&CalibrateControl::Corners { device: device() });
    for _ in 0..2 {
        calibrating.hear(&pen(5000, 2500, 800));
        calibrating.hear(&pen(5000, 2500, 0));
    }
    assert!(calibrating.view().fault.is_some());
    assert!(calibrating.view().instruction.contains("upper left"));
}

#[test]
fn a_worn_pen_gets_a_curve_that_begins_above_its_hovering() {
    let mut calibrating = begun(&CalibrateControl::Pressure { device: device() });
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
fn what_the_device_lacks_is_told_at_once() {
    let of = |command: &CalibrateControl, subject| Calibrating::begin(command, subject).err();
    let dial = CalibrateControl::Dial {
        device: device(),
        control: 8,
        turns: 1,
    };
    assert!(
        of(&dial, subject())
            .expect("refused")
            .contains("the device has 8")
    );
    let ends = CalibrateControl::Ends {
        device: device(),
        control: 2,
    };
    assert!(
        of(&ends, subject())
            .expect("refused")
            .contains("the device has 2")
    );
    let corners = CalibrateControl::Corners { device: device() };
    assert!(
        of(&corners, Subject::default())
            .expect("refused")
            .contains("no tablet")
    );
    assert!(of(&CalibrateControl::Take, subject()).is_some());
}
