//! Scripts as the command line's page shows them, and what is said about wrong ones.

use super::*;
use crate::dial_box::{Options, SgiDialBox};
use crate::firmware::Firmware;
use crate::hands::{Held, Pen, Puck, Turn};

#[test]
fn reads_every_action() {
    let text = "# warm up\n\nat 0.5 dial 3 +12 over 0.25 # slowly\nat 1 dial 0 -90deg\nat 1 dial 7 +1.5turns\n\
                at 2 button 31 down\nat 2.1 button 31 up\nat 3 power-cycle";
    let script = Script::parse(Device::DIAL_BOX, text).expect("reads");
    let at = |at_us, touch| Action { at_us, touch };
    assert_eq!(
        script.actions,
        [
            at(
                500_000,
                Touch::Dial {
                    control: 3,
                    by: Turn::Counts(12),
                    over_us: 250_000
                }
            ),
            at(
                1_000_000,
                Touch::Dial {
                    control: 0,
                    by: Turn::Degrees(-90.0),
                    over_us: 0
                }
            ),
            at(
                1_000_000,
                Touch::Dial {
                    control: 7,
                    by: Turn::Turns(1.5),
                    over_us: 0
                }
            ),
            at(
                2_000_000,
                Touch::Button {
                    control: 31,
                    down: true
                }
            ),
            at(
                2_100_000,
                Touch::Button {
                    control: 31,
                    down: false
                }
            ),
            at(3_000_000, Touch::PowerCycle),
        ]
    );
}

#[test]
fn reads_every_touch_of_a_tablet() {
    let at = |at_us, touch| Action { at_us, touch };
    let text = "at 0 pen -1 0.5 pressure 0.75 tip button 1 button 2 eraser tilt -10 20 serial 77\n\
                at 1 puck 0 0 button 3 wheel -2\nat 2 pen away";
    let script = Script::parse(Device::Tablet, text).expect("reads");
    let pen = Pen {
        x: -1.0,
        y: 0.5,
        pressure: 0.75,
        tip: true,
        buttons: 3,
        eraser: true,
        tilt_deg: [-10, 20],
        serial: 77,
    };
    let puck = Puck {
        x: 0.0,
        y: 0.0,
        buttons: 4,
        wheel: -2,
        serial: 0,
    };
    assert_eq!(
        script.actions,
        [
            at(0, Touch::Pen(pen)),
            at(1_000_000, Touch::Puck(puck)),
            at(2_000_000, Touch::Lift(Held::Pen))
        ]
    );
}

#[test]
fn names_line_and_column_of_every_error() {
    let table = [
        ("dial 0 +1", 1, "expected `at`"),
        ("at x dial 0 1", 4, "a time in seconds"),
        ("at -1 dial 0 1", 4, "from 0 to 86400"),
        ("at nan dial 0 1", 4, "a time in seconds"),
        ("at 1 dial 8 +1", 11, "a dial, 0 to 7"),
        ("at 1 dial 0 +1rad", 13, "found `+1rad`"),
        ("at 1 dial 0", 12, "the end of the line"),
        ("at 1 button 32 down", 13, "0 to 31"),
        ("at 1 button 2 press", 15, "down or up"),
        ("at 1 pen 0 0", 6, "expected dial, button, power-cycle or noise"),
        ("  at 1 power-cycle now", 20, "the end of the line"),
    ];
    for (text, column, part) in table {
        let errors = Script::parse(Device::DIAL_BOX, text).expect_err(text);
        assert_eq!(
            (errors[0].line, errors[0].column),
            (1, column),
            "{text}: {}",
            errors[0]
        );
        assert!(errors[0].message.contains(part), "{text}: {}", errors[0]);
    }
    let errors =
        Script::parse(Device::Tablet, "at 0 pen 2 0\nat 0 pen 0 0\nat 0 puck 0 0 lift").expect_err("two");
    assert_eq!(
        errors
            .iter()
            .map(|error| (error.line, error.column))
            .collect::<Vec<_>>(),
        [(1, 10), (3, 15)]
    );
}

#[test]
fn plays_from_the_moment_reporting_begins() {
    let script = Script::parse(Device::DIAL_BOX, "at 0.1 dial 2 +90deg").expect("reads");
    let mut dial_box = SgiDialBox::new(Options::default());
    dial_box.play(&script);
    let mut out = Vec::new();
    dial_box.transmit(5_000_000, &mut out);
    assert_eq!(out, []);
    dial_box.receive(5_000_000, &[0x20, 0x50, 0x00, 0xFF]);
    dial_box.transmit(5_100_000, &mut out);
    assert_eq!(out, [0x20]);
    dial_box.transmit(5_200_000, &mut out);
    assert_eq!(out, [0x20, 0x32, 0, 64]);
    assert!(dial_box.script_is_done());
}

#[test]
fn a_box_of_faders_knows_axes_and_no_dials() {
    let faders = Device::Controls {
        dials: 0,
        buttons: 2,
        axes: 5,
    };
    let script = Script::parse(faders, "at 0 axis 4 0.25 over 0.5\nat 1 noise 12").expect("reads");
    let touches: Vec<Touch> = script.actions.into_iter().map(|action| action.touch).collect();
    let axis = Touch::Axis {
        control: 4,
        to: 0.25,
        over_us: 500_000,
    };
    assert_eq!(touches, [axis, Touch::Noise(12)]);
    let table = [
        ("at 0 dial 0 +1", 6, "expected button, axis, power-cycle or noise"),
        ("at 0 axis 5 0", 11, "an axis, 0 to 4"),
        ("at 0 axis 0 1.5", 13, "from -1 to 1"),
        ("at 0 button 2 down", 13, "a button, 0 to 1"),
        ("at 0 noise 0", 12, "1 to 1000"),
    ];
    for (text, column, part) in table {
        let errors = Script::parse(faders, text).expect_err(text);
        assert_eq!(errors[0].column, column, "{text}: {}", errors[0]);
        assert!(errors[0].message.contains(part), "{text}: {}", errors[0]);
    }
}

#[test]
fn a_tablet_with_a_pad_knows_keys_and_rings_and_no_puck() {
    let pad = Device::Pad { keys: 8, rings: 1 };
    let script = Script::parse(pad, "at 0 ring 0 0.25\nat 1 ring 0 off\nat 2 button 7 down").expect("reads");
    let touches: Vec<Touch> = script.actions.into_iter().map(|action| action.touch).collect();
    let ring = |at| Touch::Ring { control: 0, at };
    let key = Touch::Button {
        control: 7,
        down: true,
    };
    assert_eq!(touches, [ring(Some(0.25)), ring(None), key]);
    let table = [
        (
            "at 0 puck 0 0",
            6,
            "expected pen, button, ring, power-cycle or noise",
        ),
        ("at 0 button 8 down", 13, "a button, 0 to 7"),
        ("at 0 ring 0 up", 13, "or `off`"),
    ];
    for (text, column, part) in table {
        let errors = Script::parse(pad, text).expect_err(text);
        assert_eq!(errors[0].column, column, "{text}: {}", errors[0]);
        assert!(errors[0].message.contains(part), "{text}: {}", errors[0]);
    }
    let errors = Script::parse(Device::Pad { keys: 0, rings: 0 }, "at 0 button 0 down").expect_err("no keys");
    assert!(
        errors[0].message.contains("expected pen, power-cycle or noise"),
        "{}",
        errors[0]
    );
}
