//! Calibrating controls in the studio: pictures to be looked at, and what hands on them want. Those in `docs/pictures`
//! named `calibrate-…` are from here.

use egui_kittest::kittest::Queryable;
use rig::controls_calibration::{
    Area, AxisCalibration, CalibrateControl, Measured, PressureCurve, Sheet, TabletMapping,
};
use rig::{CalibrationView, Command, ControlsCalibration, DeviceHealth, DeviceView, Snapshot};
use ui::render::theme;

use crate::controls::{board, controls, device, drawn, six};
use crate::studio::{count, no_card};

/// A Graphire: 129.6 by 94.3 mm.
const SHEET: Sheet = Sheet {
    max_counts: [5103, 3711],
    counts_per_inch: [1000.0; 2],
};
const SIZE: [f32; 2] = [1280.0, 720.0];

fn mapping() -> TabletMapping {
    TabletMapping {
        area: Some(Area {
            corner_mm: [14.0, 12.0],
            size_mm: [96.0, 68.0],
        }),
        aspect: Some(1.6),
        pressure: worn(),
        ..TabletMapping::default()
    }
}

/// A pen that presses a little while it hovers.
fn worn() -> PressureCurve {
    PressureCurve {
        nothing: 0.06,
        full: 0.78,
        gamma: 1.25,
        tip_down: 0.12,
        tip_up: 0.09,
    }
}

fn tablet(mapping: Option<TabletMapping>) -> DeviceView {
    let calibration = ControlsCalibration {
        tablet: mapping,
        ..ControlsCalibration::default()
    };
    DeviceView {
        sheet: Some(SHEET),
        calibration: calibration.into(),
        ..device(
            "tablet",
            "Wacom Graphire (serial)",
            DeviceHealth::Present,
            Vec::new(),
        )
    }
}

/// The six devices, one of them another.
fn with(device: DeviceView, calibration: Option<CalibrationView>) -> Snapshot {
    let mut seen = six();
    seen.devices.push(device);
    seen.calibration = calibration;
    seen
}

fn view(what: &str, step: [u8; 2], instruction: &str, measured: Measured) -> CalibrationView {
    CalibrationView {
        device: "tablet".into(),
        what: what.into(),
        step: step[0],
        steps: step[1],
        instruction: instruction.into(),
        measured,
        ..CalibrationView::default()
    }
}

fn corners(proposed: Option<TabletMapping>) -> CalibrationView {
    let done = proposed.is_some();
    let touched_mm = if done {
        vec![[22.0, 16.0], [104.0, 74.0]]
    } else {
        vec![[22.0, 16.0]]
    };
    let measured = Measured::Area {
        size_mm: SHEET.size_mm(),
        at_mm: Some([96.5, 66.0]),
        touched_mm,
        holds: TabletMapping::default(),
        proposed,
    };
    let words = if done {
        "keep this, or cancel"
    } else {
        "touch the opposite corner"
    };
    CalibrationView {
        seen: format!("{} of 2 corners", 1 + u8::from(done)),
        replaces: "all of it, 129.6 \u{d7} 94.3 mm".into(),
        result: done.then(|| "82.0 \u{d7} 58.0 mm, 22.0 mm from the left and 16.0 mm from the top".into()),
        ..view("area", if done { [3, 3] } else { [2, 3] }, words, measured)
    }
}

fn pressure() -> CalibrationView {
    let measured = Measured::Pressure {
        at: Some(0.52),
        most: [Some(0.06), Some(0.18), Some(0.78)],
        holds: PressureCurve::default(),
        proposed: Some(worn()),
    };
    CalibrationView {
        replaces: "nothing up to 0.0 %, the tip from 1.0 %, full at 100 %, the profile's".into(),
        result: Some("nothing up to 6.0 %, the tip from 12.0 %, full at 78 %".into()),
        ..view("pressure", [4, 4], "keep this, or cancel", measured)
    }
}

fn fader(fault: Option<&str>) -> CalibrationView {
    let proposed = AxisCalibration {
        ends: [18, 1004],
        rest: None,
        dead_counts: 0,
    };
    let measured = Measured::Travel {
        range: [0, 1023],
        at: Some(if fault.is_some() { 560 } else { 1004 }),
        seen: Some(if fault.is_some() { [500, 560] } else { [18, 1004] }),
        rests: Vec::new(),
        holds: AxisCalibration {
            ends: [0, 1023],
            ..proposed
        },
        proposed: fault.is_none().then_some(proposed),
    };
    let instruction = if fault.is_some() {
        "take fader 1 to its lower end, then to its upper; then go on"
    } else {
        "keep this, or cancel"
    };
    CalibrationView {
        device: "nanokontrol2".into(),
        control: Some(1),
        seen: "18 to 1004".into(),
        replaces: "from 0 to 1023 counts, the profile's".into(),
        result: fault.is_none().then(|| "from 18 to 1004 counts".into()),
        fault: fault.map(str::to_owned),
        ..view(
            "fader 1",
            if fault.is_some() { [1, 2] } else { [2, 2] },
            instruction,
            measured,
        )
    }
}

fn dial() -> CalibrationView {
    let measured = Measured::Turn {
        counts: 171,
        turns: 1,
        holds: 256.0,
        proposed: None,
    };
    CalibrationView {
        device: "dial-box".into(),
        control: Some(3),
        seen: "171 counts".into(),
        replaces: "256.0 counts in a turn, the profile's".into(),
        ..view(
            "dial 3",
            [1, 2],
            "turn dial 3 once round, clockwise, from mark to mark; then go on",
            measured,
        )
    }
}

fn stick() -> CalibrationView {
    let holds = AxisCalibration {
        ends: [-350, 350],
        rest: None,
        dead_counts: 0,
    };
    let measured = Measured::Travel {
        range: [-350, 350],
        at: Some(21),
        seen: None,
        rests: vec![14, 24],
        holds,
        proposed: Some(AxisCalibration {
            rest: Some(19),
            dead_counts: 21,
            ..holds
        }),
    };
    CalibrationView {
        device: "spacemouse".into(),
        control: Some(1),
        replaces: "from -350 to 350 counts, the profile's".into(),
        result: Some("from -350 to 350 counts, at rest at 19 \u{b1} 21".into()),
        ..view("axis 1", [4, 4], "keep this, or cancel", measured)
    }
}

#[test]
fn every_calibration_has_a_picture() {
    if no_card() {
        return;
    }
    let cut = TabletMapping {
        area: Some(Area {
            corner_mm: [22.0, 16.0],
            size_mm: [82.0, 58.0],
        }),
        ..TabletMapping::default()
    };
    let short = "the control went only from 500 to 560; take it to one end and then to the other";
    for (name, chosen, held, view) in [
        ("corner", "tablet", None, corners(None)),
        ("area", "tablet", None, corners(Some(cut))),
        ("pressure", "tablet", Some(mapping()), pressure()),
        ("fader", "nanokontrol2", None, fader(None)),
        ("fader-short", "nanokontrol2", None, fader(Some(short))),
        ("dial", "dial-box", None, dial()),
        ("stick", "spacemouse", None, stick()),
    ] {
        for size in [SIZE, [1920.0, 1080.0]] {
            let seen = with(tablet(held.clone()), Some(view.clone()));
            let picture = drawn(seen, Some(chosen), size, &format!("calibrate-{name}"));
            assert!(
                count(&picture, theme::SELECTED) > 200,
                "{name} tells nothing of what comes next"
            );
        }
    }
}

#[test]
fn what_can_be_calibrated_has_a_picture() {
    if no_card() {
        return;
    }
    for name in ["tablet", "dial-box", "nanokontrol2", "spacemouse"] {
        let mut harness = board(with(tablet(Some(mapping())), None), Some(name), SIZE, true);
        harness.get_by_label(&format!("calibrate {name}")).click();
        harness.run_steps(3);
        let image = harness.render().expect("the adapter that started also draws");
        let picture = ui::render::picture::Picture {
            width: image.width(),
            height: image.height(),
            rgba: image.into_raw(),
        };
        crate::studio::keep(&picture, &format!("controls-calibrate-choose-{name}.png"));
    }
}

fn said(harness: &egui_kittest::Harness<'static, crate::studio::Bench>) -> Vec<CalibrateControl> {
    let asked = harness.state().said.iter();
    asked
        .filter_map(|command| match command {
            Command::CalibrateControl(asked) => Some(asked.clone()),
            _ => None,
        })
        .collect()
}

#[test]
fn a_device_is_chosen_and_a_control_begins() {
    let mut harness = board(with(tablet(None), None), Some("dial-box"), SIZE, false);
    assert!(harness.query_by_label("one turn of dial 3 of dial-box").is_none());
    harness.get_by_label("calibrate dial-box").click();
    harness.run_steps(2);
    harness.get_by_label("one turn of dial 3 of dial-box").click();
    harness.run_steps(2);
    harness.get_by_label("back of dial 3 of dial-box").click();
    harness.run_steps(2);
    let device = || "dial-box".to_owned();
    let (turns, control) = (1, 3);
    let begun = CalibrateControl::Dial {
        device: device(),
        control,
        turns,
    };
    let forgotten = CalibrateControl::Forget {
        device: device(),
        control: Some(3),
    };
    assert_eq!(said(&harness), [begun, forgotten]);
}

#[test]
fn a_tablet_is_turned_mirrored_cut_and_made_softer() {
    let mut harness = board(with(tablet(None), None), Some("tablet"), SIZE, false);
    harness.get_by_label("calibrate tablet").click();
    harness.run_steps(2);
    for button in [
        "turned 0\u{b0}, area of tablet",
        "mirror y, area of tablet",
        "as it is, area of tablet",
        "softer, pressure of tablet",
        "touch corners, area of tablet",
        "press it, pressure of tablet",
    ] {
        harness.get_by_label(button).click();
        harness.run_steps(2);
    }
    let mapped = |mapping| CalibrateControl::Tablet {
        device: "tablet".into(),
        mapping,
    };
    let whole = TabletMapping::default;
    let softer = PressureCurve {
        gamma: 1.25,
        ..PressureCurve::default()
    };
    let want = [
        mapped(TabletMapping {
            turned_deg: 90.0,
            ..whole()
        }),
        mapped(TabletMapping {
            mirrored: [false, true],
            ..whole()
        }),
        mapped(TabletMapping {
            aspect: Some(1.0),
            ..whole()
        }),
        mapped(TabletMapping {
            pressure: softer,
            ..whole()
        }),
        CalibrateControl::Corners {
            device: "tablet".into(),
        },
        CalibrateControl::Pressure {
            device: "tablet".into(),
        },
    ];
    assert_eq!(said(&harness), want);
}

#[test]
fn the_three_answers_are_given_when_they_can_be() {
    let seen = with(tablet(None), Some(fader(Some("too short"))));
    let mut harness = board(seen, Some("nanokontrol2"), SIZE, false);
    for answer in [
        "keep the calibration",
        "next step of the calibration",
        "cancel the calibration",
    ] {
        harness.get_by_label(answer).click();
        harness.run_steps(2);
    }
    assert_eq!(
        said(&harness),
        [CalibrateControl::Next, CalibrateControl::Cancel],
        "there is nothing to keep"
    );
    let mut harness = board(
        with(tablet(None), Some(fader(None))),
        Some("nanokontrol2"),
        SIZE,
        false,
    );
    for answer in ["next step of the calibration", "keep the calibration"] {
        harness.get_by_label(answer).click();
        harness.run_steps(2);
    }
    assert_eq!(said(&harness), [CalibrateControl::Take]);
}

#[test]
fn keys_alone_calibrate() {
    let mut harness = board(
        with(tablet(None), Some(fader(None))),
        Some("nanokontrol2"),
        SIZE,
        false,
    );
    harness.get_by_label("keep the calibration").focus();
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(2);
    assert_eq!(said(&harness), [CalibrateControl::Take]);
}

#[test]
fn another_device_leads_to_the_one_that_is_calibrated() {
    let mut harness = board(
        with(tablet(None), Some(fader(None))),
        Some("dial-box"),
        SIZE,
        false,
    );
    harness.get_by_label("calibrate dial-box").click();
    harness.run_steps(2);
    harness.get_by_label("Go there").click();
    harness.run_steps(2);
    assert_eq!(
        harness.state_mut().studio.choices().device.as_deref(),
        Some("nanokontrol2")
    );
    let none = with(controls_only(), None);
    let harness = board(none, Some("plain"), SIZE, false);
    assert!(harness.query_by_label("calibrate plain").is_some());
}

fn controls_only() -> DeviceView {
    device(
        "plain",
        "Keys",
        DeviceHealth::Present,
        controls("button", 4, 1).collect(),
    )
}
