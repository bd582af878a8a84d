//! Descriptors of real devices, with reports that they sent or that their descriptors demand, and what these mean.
//!
//! Each names where it was recorded. The bytes are the devices' own; what they mean is worked out by hand.

use crate::codec::hid::{HidCodec, describe};
use crate::codec::{Codec, InputEvent, PenSample, Tool};
use device_profiles::ControlKind;
use std::f64::consts::PI;

/// Bytes as text.
fn bytes(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).expect("two digits"))
        .collect()
}

fn codec(descriptor: &str) -> HidCodec {
    HidCodec::generic(&bytes(descriptor)).expect("a real one")
}

/// What a report of that beginning says, filled up with zeros to `length` as the device does.
fn heard(codec: &mut HidCodec, report: &str, length: usize) -> Vec<InputEvent> {
    let mut report = bytes(report);
    report.resize(length, 0);
    let mut events = Vec::new();
    codec.decode(&report, &mut |event| events.push(event));
    events
}

fn names(descriptor: &str) -> Vec<(ControlKind, String, u16)> {
    let profile = describe(&bytes(descriptor)).expect("a real one");
    let row = |c: &device_profiles::Control| (c.kind, c.name.clone(), c.count);
    profile.controls.iter().map(row).collect()
}

fn button(control: u16, down: bool) -> InputEvent {
    InputEvent::Button { control, down }
}

/// ION iCade: keys of a keyboard as an array, consumer keys, vendors' pages, a battery, and a zero behind the last item.
/// Source: bentiss/hid-devices at 7f386346, `events/gamecontroller/ion_15e4_0132.hid`, descriptor and reports.
const ICADE: &str = "05 01 09 06 a1 01 85 01 75 01 95 08 05 07 19 e0 29 e7 15 00 25 01 81 02 95 01 75 08 81 03 95 05 75 01
    05 08 19 01 29 05 91 02 95 01 75 03 91 03 95 06 75 08 15 00 26 ff 00 05 07 19 00 29 ff 81 00 c0 05 0c 09 01 a1 01
    85 02 15 00 25 01 75 01 95 12 09 cd 09 ea 09 e9 0a 23 02 09 b5 09 b6 0a 25 02 0a 24 02 0a 8a 01 0a 2a 02 0a 26 02
    0a 94 01 09 b7 0a 27 02 0a 92 01 09 e2 0a 83 01 0a 21 02 81 02 95 01 75 06 81 03 c0 05 0c 09 01 a1 01 85 03 05 01
    09 06 a1 02 05 06 09 20 15 00 26 ff 00 75 08 95 01 81 02 c0 c0 05 01 09 80 a1 01 85 04 15 00 25 01 75 01 95 02 09
    82 09 83 81 02 95 01 75 06 81 03 c0 05 0c 09 01 a1 01 85 05 05 01 09 06 a1 02 06 00 ff 25 01 75 01 95 02 0a 03 fe
    0a 04 fe 81 02 95 06 81 03 c0 c0 05 0c 09 01 a1 01 85 ff 05 06 95 01 75 02 19 24 29 26 81 02 75 06 81 01 c0 00";

#[test]
fn keys_of_an_array_come_and_go_and_zero_is_none() {
    let mut icade = codec(ICADE);
    // Eight modifiers first, then the array's choices.
    let key = |code: u16, down| button(8 + code, down);
    assert_eq!(heard(&mut icade, "01 00 00 1a", 9), [key(0x1A, true)]);
    assert_eq!(heard(&mut icade, "01 00 00", 9), [key(0x1A, false)]);
    assert_eq!(
        heard(&mut icade, "01 02 00 08 04", 9),
        [button(1, true), key(0x08, true), key(0x04, true)]
    );
    // Too many keys: it does not know which, and nothing is let go.
    assert_eq!(heard(&mut icade, "01 02 00 01 01 01 01 01 01", 9), []);
    assert_eq!(
        heard(&mut icade, "01", 9),
        [button(1, false), key(0x04, false), key(0x08, false)]
    );
    // Volume up, the third of eighteen consumer keys, behind 8 + 256.
    assert_eq!(heard(&mut icade, "02 04", 4), [button(8 + 256 + 2, true)]);
    // The battery is no control.
    assert_eq!(heard(&mut icade, "03 40", 2), []);
    assert_eq!(
        names(ICADE),
        [(ControlKind::Button, "button".to_owned(), 8 + 256 + 18 + 2)]
    );
}

/// Sony's third controller: constant bytes, nineteen buttons, four axes, and bytes of a vendor's among standard ones.
/// Source: bentiss/hid-devices at 43c196d1, `events/gamecontroller/sony_054c_0268.hid`, descriptor and first report.
const SONY: &str = "05 01 09 04 a1 01 a1 02 85 01 75 08 95 01 15 00 26 ff 00 81 03 75 01 95 13 15 00 25 01 35 00 45 01 05
    09 19 01 29 13 81 02 75 01 95 0d 06 00 ff 81 03 15 00 26 ff 00 05 01 09 01 a1 00 75 08 95 04 35 00 46 ff 00 09 30
    09 31 09 32 09 35 81 02 c0 05 01 75 08 95 27 09 01 81 02 75 08 95 30 09 01 91 02 75 08 95 30 09 01 b1 02 c0 a1 02
    85 02 75 08 95 30 09 01 b1 02 c0 a1 02 85 ee 75 08 95 30 09 01 b1 02 c0 a1 02 85 ef 75 08 95 30 09 01 b1 02 c0 c0";

#[test]
fn a_gamepad_has_its_axes_and_buttons() {
    let mut sony = codec(SONY);
    let axis = |control, value| InputEvent::Axis { control, value };
    let report =
        "01 00 00 00 00 00 8d 6f 81 88 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 02 ee 10";
    assert_eq!(
        heard(&mut sony, report, 49),
        [axis(0, 0x8D), axis(1, 0x6F), axis(2, 0x81), axis(3, 0x88)]
    );
    assert_eq!(
        heard(&mut sony, "01 00 01 00 04 00 8d 6f 81 88", 49),
        [button(0, true), button(18, true)]
    );
    let kinds: Vec<_> = names(SONY)
        .into_iter()
        .map(|(_, name, count)| (name, count))
        .collect();
    let want = [("x", 1), ("y", 1), ("z", 1), ("rz", 1), ("button", 19)];
    assert_eq!(kinds, want.map(|(name, count)| (name.to_owned(), count)));
}

/// A hat whose directions count from 1, 0 being rest, with the flag for that missing, beside a throttle and a twist.
/// Source: of the hat jfedor2/hid-remapper issue 209 (Saitek X52); around it the least there must be.
const HAT: &str =
    "05 01 09 04 a1 01 09 39 15 01 25 08 35 00 46 3b 01 65 14 75 04 95 01 81 02 65 00 75 04 81 03 05 02 09
    bb 15 00 26 ff 00 75 08 81 02 05 01 09 35 26 ff 03 75 0a 81 02 75 06 81 03 c0";

#[test]
fn a_hat_at_rest_points_nowhere() {
    let mut hat = codec(HAT);
    let axis = |control, value| InputEvent::Axis { control, value };
    let ring = |value| InputEvent::Ring { control: 0, value };
    assert_eq!(heard(&mut hat, "00 80 00 02", 4), [axis(0, 0x80), axis(1, 0x200)]);
    assert_eq!(heard(&mut hat, "01 80 00 02", 4), [ring(Some(1))]);
    assert_eq!(heard(&mut hat, "08 80 00 02", 4), [ring(Some(8))]);
    assert_eq!(heard(&mut hat, "0f 80 00 02", 4), [ring(None)]);
}

/// Microsoft's Surface Dial: a dial of 3600 steps, a button, a place that it has not got, and haptics of its own.
/// Source: WOA-Project/documentation_surface_dial at 3b746de3, `DefaultHIDDescriptor.md`.
const DIAL: &str = "05 01 09 0E A1 01 85 01 05 0D 09 21 A1 02 15 00 25 01 75 01 95 01 A1 00 05 09 09 01 81 02 05 0D 09 33
    81 02 95 06 81 03 A1 02 05 01 09 37 16 01 80 26 FF 7F 75 10 95 01 81 06 35 00 46 10 0E 15 00 26 10 0E 09 48 B1 02
    45 00 C0 55 0E 65 11 46 00 00 26 00 00 09 30 81 42 09 31 46 00 00 26 00 00 81 42 05 0D 09 48 15 3A 25 3A 75 08 55
    0F 35 3A 45 3A 81 03 55 00 65 00 35 00 45 00 05 0E 09 01 A1 02 15 00 26 FF 00 09 24 B1 42 09 24 91 42 15 01 25 07
    09 20 B1 42 09 21 91 42 25 0A 09 28 B1 42 75 10 26 D0 07 09 25 B1 42 09 25 91 42 85 02 75 20 17 37 00 01 00 27 37
    00 01 00 09 22 B1 02 09 11 A1 02 05 0A 95 03 09 03 09 04 09 05 75 08 15 00 25 FF B1 02 C0 05 0E 09 10 A1 02 05 0A
    95 01 15 03 25 03 36 03 10 46 03 10 09 03 B1 02 15 04 25 04 36 04 10 46 04 10 09 04 B1 02 15 05 25 05 36 04 10 46
    04 10 09 05 B1 02 35 00 45 00 C0 C0 C0 C0 C0";

#[test]
fn a_radial_controller_turns_and_presses() {
    let mut dial = codec(DIAL);
    let turned = |delta_counts| InputEvent::Dial {
        control: 0,
        delta_counts,
    };
    assert_eq!(heard(&mut dial, "01 01 f6 ff", 9), [button(0, true), turned(-10)]);
    assert_eq!(heard(&mut dial, "01 00 0a 00", 9), [button(0, false), turned(10)]);
    let want = [
        (ControlKind::Dial, "dial".to_owned(), 1),
        (ControlKind::Button, "button".to_owned(), 1),
    ];
    assert_eq!(names(DIAL), want);
}

/// Huion H1161 in its mode for systems: the unit is three times an inch and its range nobody's, and both are left
/// standing for pressure and tilt. Source: DIGImend/tablets at 3572d6f8, `Huion_H1161/rd/original1.txt`.
const HUION: &str = "05 0D 09 02 A1 01 85 0A 09 20 A1 00 09 42 09 44 09 45 09 3C 15 00 25 01 75 01 95 06 81 02 09 32 75 01
    95 01 81 02 81 03 05 01 09 30 09 31 55 0D 65 33 26 FF 7F 35 00 46 00 08 75 10 95 02 81 02 05 0D 09 30 26 FF 1F 75
    10 95 01 81 02 09 3D 09 3E 15 81 25 7F 75 08 95 02 81 02 C0 C0";

#[test]
fn a_pens_tilt_is_in_degrees_where_units_were_left_standing() {
    let mut huion = codec(HUION);
    let touching = PenSample {
        pressure_counts: 0x1000,
        tip: true,
        buttons: 1,
        tilt: Some([-60, 25]),
        ..PenSample::hovering(Tool::Pen, 0x1234, 0x5678)
    };
    let frame = "0a 43 34 12 78 56 00 10 c4 19";
    assert_eq!(heard(&mut huion, frame, 10), [InputEvent::Pen(touching)]);
    let surface = huion.surface().expect("a pen has one");
    assert_eq!((surface.max_counts, surface.pressure_max), ([0x7FFF; 2], 0x1FFF));
    let per_rad = surface.tilt_steps_per_rad.expect("it tilts");
    assert!((per_rad - 180.0 / PI).abs() < 1e-9, "{per_rad}");
}

/// Goodix 27c6:0113: fingers and a pen; tilt in hundredths of a degree, places in hundredths of a centimetre; the pen's
/// bit for being in range goes while it touches. Source: hid-tools at 1258a88f, `tests_kernel/test_tablet.py`.
const GOODIX: &str = "05 0d 09 04 a1 01 85 01 09 22 a1 02 55 0e 65 11 35 00 15 00 09 42 25 01 75 01 95 01 81 02 95 07 81 01
    95 01 75 08 09 51 81 02 75 10 05 01 26 00 14 46 1f 07 09 30 81 02 26 80 0c 46 77 04 09 31 81 02 05 0d c0 09 22 a1
    02 09 42 25 01 75 01 95 01 81 02 95 07 81 01 95 01 75 08 09 51 81 02 75 10 05 01 26 00 14 46 1f 07 09 30 81 02 26
    80 0c 46 77 04 09 31 81 02 05 0d c0 09 54 15 00 25 7f 75 08 95 01 81 02 85 02 09 55 95 01 25 0a b1 02 85 03 06 00
    ff 09 c5 15 00 26 ff 00 75 08 96 00 01 b1 02 c0 05 0d 09 02 a1 01 85 08 09 20 a1 00 09 42 09 44 09 3c 09 45 15 00
    25 01 75 01 95 04 81 02 95 01 81 03 09 32 81 02 95 02 81 03 95 01 75 08 09 51 81 02 05 01 09 30 75 10 95 01 a4 55
    0e 65 11 35 00 26 00 14 46 1f 07 81 42 09 31 26 80 0c 46 77 04 81 42 b4 05 0d 09 30 26 ff 0f 81 02 09 3d 65 14 55
    0e 36 d8 dc 46 28 23 16 d8 dc 26 28 23 81 02 09 3e 81 02 c0 c0 06 f0 ff 09 01 a1 01 85 0e 09 01 15 00 25 ff 75 08
    95 40 91 02 09 01 15 00 25 ff 75 08 95 40 81 02 c0 05 01 09 06 a1 01 85 04 05 07 09 e3 15 00 25 01 75 01 95 01 81
    02 95 07 81 03 c0";

#[test]
fn a_pen_beside_fingers_keeps_to_its_units_and_stays_while_it_touches() {
    let mut goodix = codec(GOODIX);
    let pen = |x, y| PenSample {
        tilt: Some([-4500, 3000]),
        ..PenSample::hovering(Tool::Pen, x, y)
    };
    let tilt = "6c ee b8 0b";
    let frame = |flags: u8, x: u16, y: u16, pressure: u16| {
        let [[x, x2], [y, y2], [p, p2]] = [x, y, pressure].map(u16::to_le_bytes);
        format!("08 {flags:02x} 00 {x:02x} {x2:02x} {y:02x} {y2:02x} {p:02x} {p2:02x} {tilt}")
    };
    let sample = |sample| [InputEvent::Pen(sample)];
    assert_eq!(
        heard(&mut goodix, &frame(0x20, 100, 200, 0), 13),
        sample(pen(100, 200))
    );
    let touching = PenSample {
        pressure_counts: 700,
        tip: true,
        ..pen(101, 201)
    };
    assert_eq!(
        heard(&mut goodix, &frame(0x21, 101, 201, 700), 13),
        sample(touching)
    );
    assert_eq!(
        heard(&mut goodix, &frame(0x01, 101, 201, 700), 13),
        sample(touching)
    );
    assert_eq!(
        heard(&mut goodix, &frame(0x00, 0, 0, 0), 13),
        sample(touching.leaving())
    );
    // The other end touches with nothing but its own bit.
    let rubbing = PenSample {
        tool: Tool::Eraser,
        ..touching
    };
    assert_eq!(
        heard(&mut goodix, &frame(0x08, 101, 201, 700), 13),
        sample(rubbing)
    );
    heard(&mut goodix, &frame(0x00, 0, 0, 0), 13);
    // A place outside its range is none, and makes no sample.
    assert_eq!(heard(&mut goodix, &frame(0x20, 0x1401, 200, 0), 13), []);
    let surface = goodix.surface().expect("a pen has one");
    let per_inch = 5120.0 / 18.23 * 2.54;
    assert!(
        (surface.counts_per_inch[0] - per_inch).abs() < 1e-6,
        "{surface:?}"
    );
    let per_rad = surface.tilt_steps_per_rad.expect("it tilts");
    assert!((per_rad - 18_000.0 / PI).abs() < 1e-6, "{per_rad}");
    let touch = |id, at| InputEvent::Touch { id, at };
    assert_eq!(
        heard(&mut goodix, "01 01 05 10 00 20 00 00 00 00 00 00 00 01", 14),
        [touch(5, Some([16, 32]))]
    );
    assert_eq!(
        heard(&mut goodix, "01 00 05 10 00 20 00 00 00 00 00 00 00 01", 14),
        [touch(5, None)]
    );
}

/// A pen of the universal stylus initiative: a second side button, twist in hundredths of a degree, a number of 64 bits
/// that calls itself a byte, a battery, its colour and style, an array of inks.
/// Source: hid-tools at 1258a88f, `tests_kernel/test_tablet.py`, 27c6:0e00, from the pen's collection to the array,
/// but for its sensors of motion.
const USI: &str = "05 0d 09 02 a1 01 09 20 a1 00 85 08 05 01 a4 09 30 35 00 46 e6 09 15 00 26 04 20 55 0d 65 13 75 10 95 01
    81 02 09 31 46 9a 06 26 60 15 81 02 b4 05 0d 09 38 95 01 75 08 15 00 25 01 81 02 09 30 75 10 26 ff 0f 81 02 09 31
    81 02 09 42 09 44 09 5a 09 3c 09 45 09 32 75 01 95 06 25 01 81 02 95 02 81 03 09 3d 55 0e 65 14 36 d8 dc 46 28 23
    16 d8 dc 26 28 23 95 01 75 10 81 02 09 3e 81 02 09 41 15 00 27 a0 8c 00 00 35 00 47 a0 8c 00 00 81 02 05 0d 09 3b
    15 00 25 64 75 08 81 02 09 5b 25 ff 75 40 81 02 05 0d 09 5c 26 ff 00 75 08 81 02 09 5e 81 02 09 70 a1 02 15 01 25
    06 09 72 09 73 09 74 09 75 09 76 09 77 81 20 c0 c0 c0";

#[test]
fn a_pens_number_is_no_quantity_and_its_twist_is_one_turn() {
    let mut usi = codec(USI);
    let frame = "08 00 10 00 08 01 00 02 ff 0f 26 00 00 00 00 28 23 63 ef cd ab 89 67 45 23 01 11 22 03";
    let want = PenSample {
        pressure_counts: 0x200,
        buttons: 0b11,
        tilt: Some([0, 0]),
        twist: Some(9000),
        tool_serial: Some(0x0123_4567_89AB_CDEF),
        ..PenSample::hovering(Tool::Pen, 0x1000, 0x0800)
    };
    assert_eq!(heard(&mut usi, frame, 29), [InputEvent::Pen(want)]);
    let surface = usi.surface().expect("a pen has one");
    let turn = surface.twist_steps_per_turn.expect("it twists");
    assert!((turn - 36_000.0).abs() < 1e-6, "{turn}");
    assert!(
        (surface.counts_per_inch[0] - 8196.0 / 2.534).abs() < 1e-6,
        "{surface:?}"
    );
}

/// The digitizer of the HID descriptor tool: a puck, and a stylus with an array of buttons or with pressure in newtons,
/// by Push and Pop. Its report ids stand behind Pop here, which takes back those before it. Source: USB implementers' forum, dt2_4, as Chromium's `test_report_descriptors.cc` has it.
const PUCK_AND_STYLUS: &str = "05 0d 09 01 a1 01 85 01 09 21 a1 00 05 01 09 30 09 31 75 10 95 02 15 00 26 e0 2e 35 00 45
    0c 65 13 55 00 a4 81 02 05 0d 09 32 09 44 09 42 15 00 25 01 35 00 45 01 75 01 95 03 65 00 81 02 95 01 75 05 81 03
    c0 09 20 a1 00 b4 a4 85 02 09 30 09 31 81 02 05 0d 09 32 15 00 25 01 35 00 45 01 65 00 75 01 81 02 05 09 19 00 29
    10 25 10 75 05 81 40 75 02 81 01 c0 05 0d 09 20 a1 00 b4 85 03 09 30 09 31 81 02 05 0d 09 32 09 44 75 01 15 00 25
    01 35 00 45 01 65 00 81 02 95 06 81 03 09 30 15 00 25 7f 35 00 45 2d 67 11 e1 00 00 55 04 75 08 95 01 81 12 c0 c0";

#[test]
fn a_puck_has_buttons_and_a_stylus_of_the_same_tablet_a_tip() {
    let mut digitizer = codec(PUCK_AND_STYLUS);
    let puck = |x, y, buttons| PenSample {
        buttons,
        ..PenSample::hovering(Tool::Puck, x, y)
    };
    assert_eq!(
        heard(&mut digitizer, "01 e8 03 d0 07 05", 6),
        [InputEvent::Pen(puck(1000, 2000, 1))]
    );
    assert_eq!(
        heard(&mut digitizer, "01 e8 03 d0 07 03", 6),
        [InputEvent::Pen(puck(1000, 2000, 2))]
    );
    // The stylus takes the puck's place.
    let stylus = PenSample {
        pressure_counts: 64,
        tip: true,
        ..PenSample::hovering(Tool::Pen, 10, 20)
    };
    assert_eq!(
        heard(&mut digitizer, "03 0a 00 14 00 01 40", 7)[..],
        [
            InputEvent::Pen(puck(1000, 2000, 2).leaving()),
            InputEvent::Pen(stylus)
        ][..]
    );
    // Button 16 of an array whose choice 0 is none; of five bits each, two elements.
    let pen = PenSample::hovering(Tool::Pen, 10, 20);
    assert_eq!(
        heard(&mut digitizer, "02 0a 00 14 00 43 00", 7)[..],
        [
            InputEvent::Pen(PenSample {
                pressure_counts: 64,
                tip: true,
                ..pen
            }),
            button(16, true)
        ][..]
    );
    let surface = digitizer.surface().expect("a puck has one");
    assert_eq!(surface.pressure_max, 127);
    assert!((surface.counts_per_inch[0] - 1000.0).abs() < 1e-9, "{surface:?}");
}

/// Where the whole of the interface is a vendor's, nothing is made up; a mouse beside it is one.
/// Source: DIGImend/tablets at 4cefae4a, `10moons_10x6/rd/original1.txt`.
#[test]
fn vendors_pages_tell_nothing() {
    let vendor = "06 A0 FF 09 01 A1 01 85 06 09 01 15 00 26 FF 00 75 3F 95 08 91 02 95 08 75 3F 15 00 26 FF 00 09 01 19 00
        2A FF 00 81 00 C0";
    assert!(!codec(vendor).tells_anything());
    let mouse = "05 01 09 02 A1 01 85 03 09 01 A1 00 05 09 19 01 29 08 15 00 25 01 95 08 75 01 81 02 05 01 15 81 25 7F 75
        08 95 03 09 30 09 31 09 38 81 06 C0 C0";
    let mut both = codec(&format!("{vendor} {mouse}"));
    assert!(both.is_pointer());
    let moved = InputEvent::Moved {
        dx: 5,
        dy: -1,
        wheel: 1,
    };
    assert_eq!(heard(&mut both, "03 80 05 ff 01", 5), [button(7, true), moved]);
}
