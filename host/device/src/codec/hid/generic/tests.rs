use super::written::{Bits, Made, Writer, number, switch};
use crate::codec::hid::descriptor::{Descriptor, Direction};
use crate::codec::hid::{HidCodec, describe};
use crate::codec::{Codec, Counters, InputEvent, PenSample, Tool};
use device_profiles::ControlKind;
use proptest::prelude::*;

fn heard(codec: &mut HidCodec, report: &[u8]) -> Vec<InputEvent> {
    let mut events = Vec::new();
    codec.decode(report, &mut |event| events.push(event));
    events
}

/// The numbers of a pen that are looked for, and its switches.
const PEN_NUMBERS: [(u16, u16); 6] = [
    (1, 0x30),
    (1, 0x31),
    (0xD, 0x30),
    (0xD, 0x3D),
    (0xD, 0x3E),
    (0xD, 0x41),
];
const PEN_SWITCHES: [(u16, u16); 4] = [(0xD, 0x42), (0xD, 0x32), (0xD, 0x44), (0xD, 0x5A)];

fn pen() -> impl Strategy<Value = Vec<Made>> {
    let numbers: Vec<_> = PEN_NUMBERS.iter().map(|&usage| number(usage, false)).collect();
    let switches: Vec<_> = PEN_SWITCHES.iter().map(|&usage| switch(usage)).collect();
    (numbers, switches)
        .prop_map(|(numbers, switches)| [numbers, switches].concat())
        .prop_shuffle()
}

/// Sliders, dials, wheels, axes of a joystick, and buttons.
fn box_of_controls() -> impl Strategy<Value = Vec<Made>> {
    let control = prop_oneof![
        number((1, 0x36), false),
        number((1, 0x37), true),
        number((1, 0x38), true),
        number((1, 0x33), false),
        number((2, 0xBB), false),
    ];
    let button = (1_u16..60).prop_flat_map(|id| switch((9, id)));
    let controls = prop::collection::vec(control, 1..9);
    (controls, prop::collection::vec(button, 0..20))
        .prop_map(|(controls, buttons)| [controls, buttons].concat())
        .prop_shuffle()
}

fn written(application: (u16, u16), inner: Option<(u16, u16)>, id: Option<u8>, fields: &[Made]) -> Vec<u8> {
    let mut writer = Writer::default();
    writer.begin(application, 1);
    writer.report(id);
    if let Some(inner) = inner {
        writer.begin(inner, 0);
    }
    for field in fields {
        writer.field(field);
    }
    if inner.is_some() {
        writer.end();
    }
    writer.end();
    writer.bytes
}

fn value_of(fields: &[Made], values: &[i64], usage: (u16, u16)) -> i64 {
    let at = fields
        .iter()
        .position(|f| f.usage == usage)
        .expect("it is in every pen");
    values[at]
}

proptest! {
    /// What was written is what is read.
    #[test]
    fn fields_come_back(fields in box_of_controls(), id in prop::option::of(1_u8..)) {
        let bytes = written((1, 4), None, id, &fields);
        let descriptor = Descriptor::parse(&bytes).expect("legal");
        prop_assert_eq!(descriptor.fields.len(), fields.len());
        let mut bit = 0;
        for (got, made) in descriptor.fields.iter().zip(&fields) {
            bit += made.padding;
            prop_assert_eq!((got.usage().page, got.usage().id), made.usage);
            prop_assert_eq!((got.bit, got.width), (bit, made.width));
            prop_assert_eq!(got.logical, [made.low, made.high]);
            prop_assert_eq!(got.flags.relative(), made.relative);
            prop_assert_eq!(got.flags.null_state(), made.null);
            bit += made.width;
        }
        let length = bit.div_ceil(8) as usize + usize::from(id.is_some());
        prop_assert_eq!(descriptor.report_bytes(Direction::Input, id.unwrap_or(0)), Some(length));
    }

    #[test]
    fn a_pen_says_what_was_put_into_its_reports(
        fields in pen(),
        id in prop::option::of(1_u8..),
        chances in prop::collection::vec(any::<[u32; 10]>(), 1..6),
        noise in any::<bool>(),
    ) {
        let mut codec = HidCodec::generic(&written((0xD, 2), Some((0xD, 0x20)), id, &fields)).expect("legal");
        let mut there = false;
        for chance in &chances {
            let values: Vec<i64> = fields.iter().zip(chance).map(|(f, &c)| f.value(c)).collect();
            let report = Bits::fields(&fields, &values, noise).bytes(id);
            let events = heard(&mut codec, &report);
            let get = |usage| value_of(&fields, &values, usage);
            let low = |usage| fields.iter().find(|f| f.usage == usage).expect("there").low;
            // What touches is there.
            if get((0xD, 0x32)) == 0 && get((0xD, 0x42)) == 0 {
                prop_assert_eq!(events.len(), usize::from(there));
                there = false;
                continue;
            }
            there = true;
            let count = |usage| (get(usage) - low(usage)) as u32;
            let narrow = |usage| get(usage).clamp(-32_768, 32_767) as i16;
            let want = PenSample {
                pressure_counts: count((0xD, 0x30)),
                tip: get((0xD, 0x42)) == 1,
                buttons: (get((0xD, 0x44)) | get((0xD, 0x5A)) << 1) as u32,
                tilt: Some([narrow((0xD, 0x3D)), narrow((0xD, 0x3E))]),
                twist: Some(narrow((0xD, 0x41))),
                ..PenSample::hovering(Tool::Pen, count((1, 0x30)), count((1, 0x31)))
            };
            prop_assert_eq!(events, vec![InputEvent::Pen(want)]);
        }
        prop_assert_eq!(codec.counters().reports, chances.len() as u64);
        let area = codec.surface().expect("a pen has an area");
        let x = fields.iter().find(|f| f.usage == (1, 0x30)).expect("there");
        prop_assert_eq!(i64::from(area.max_counts[0]), x.high - x.low);
    }

    #[test]
    fn controls_say_what_was_put_into_their_reports(
        fields in box_of_controls(),
        id in prop::option::of(1_u8..),
        chances in prop::collection::vec(prop::collection::vec(any::<u32>(), 30), 1..6),
        noise in any::<bool>(),
    ) {
        let mut codec = HidCodec::generic(&written((1, 4), None, id, &fields)).expect("legal");
        let mut before: Vec<Option<i64>> = vec![None; fields.len()];
        for chance in &chances {
            let values: Vec<i64> = fields.iter().zip(chance).map(|(f, &c)| f.value(c)).collect();
            let events = heard(&mut codec, &Bits::fields(&fields, &values, noise).bytes(id));
            let (mut want, mut turns) = (Vec::new(), Vec::new());
            let (mut axes, mut dials, mut buttons) = (0, 0, 0);
            for ((field, &value), before) in fields.iter().zip(&values).zip(&mut before) {
                let cut = value.clamp(i32::MIN.into(), i32::MAX.into()) as i32;
                if field.width == 1 {
                    let (is, was) = (value == 1, *before == Some(1));
                    if is != was {
                        want.push(InputEvent::Button { control: buttons, down: is });
                    }
                    buttons += 1;
                } else if field.relative {
                    if cut != 0 {
                        turns.push(InputEvent::Dial { control: dials, delta_counts: cut });
                    }
                    dials += 1;
                } else {
                    let was = before.map(|was| was.clamp(i32::MIN.into(), i32::MAX.into()) as i32);
                    if was != Some(cut) {
                        want.push(InputEvent::Axis { control: axes, value: cut });
                    }
                    axes += 1;
                }
                *before = Some(value);
            }
            want.extend(turns);
            prop_assert_eq!(events, want);
        }
    }

    #[test]
    fn short_reports_are_rejected_and_others_ids_unknown(fields in box_of_controls(), id in 1_u8..255) {
        let mut codec = HidCodec::generic(&written((1, 4), None, Some(id), &fields)).expect("legal");
        let values: Vec<i64> = fields.iter().map(|f| f.low).collect();
        let report = Bits::fields(&fields, &values, false).bytes(Some(id));
        prop_assert!(heard(&mut codec, &report[..report.len() - 1]).is_empty());
        prop_assert!(heard(&mut codec, &[id + 1, 0, 0]).is_empty());
        prop_assert!(heard(&mut codec, &[]).is_empty());
        prop_assert_eq!(codec.counters(), Counters { reports: 0, unknown: 1, rejected: 2 });
    }

    #[test]
    fn any_bytes_are_survived(
        descriptor in prop::collection::vec(any::<u8>(), 0..200),
        reports in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..20), 0..10),
    ) {
        if let Ok(mut codec) = HidCodec::generic(&descriptor) {
            for report in &reports {
                heard(&mut codec, report);
            }
        }
    }
}

/// A mouse of the boot protocol: buttons, movement, wheel.
const MOUSE: &[u8] = &[
    0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x09, 0x01, 0xA1, 0x00, 0x05, 0x09, 0x19, 0x01, 0x29, 0x03, 0x15,
    0x00, 0x25, 0x01, 0x95, 0x03, 0x75, 0x01, 0x81, 0x02, 0x95, 0x01, 0x75, 0x05, 0x81, 0x01, 0x05, 0x01,
    0x09, 0x30, 0x09, 0x31, 0x09, 0x38, 0x15, 0x81, 0x25, 0x7F, 0x75, 0x08, 0x95, 0x03, 0x81, 0x06, 0xC0,
    0xC0,
];

#[test]
fn a_mouse_moves_and_presses() {
    let mut codec = HidCodec::generic(MOUSE).expect("legal");
    assert!(codec.is_pointer());
    let down = InputEvent::Button {
        control: 2,
        down: true,
    };
    let moved = InputEvent::Moved {
        dx: -1,
        dy: 2,
        wheel: -1,
    };
    assert_eq!(heard(&mut codec, &[4, 0xFF, 2, 0xFF]), [down, moved]);
    assert_eq!(heard(&mut codec, &[4, 0, 0, 0]), []);
}

/// Six axes that are called relative, as some caps' firmware has them, and two buttons.
const CAP: &[u8] = &[
    0x05, 0x01, 0x09, 0x08, 0xA1, 0x01, 0xA1, 0x00, 0x85, 0x01, 0x16, 0xA2, 0xFE, 0x26, 0x5E, 0x01, 0x09,
    0x30, 0x09, 0x31, 0x09, 0x32, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xC0, 0xA1, 0x00, 0x85, 0x02, 0x09,
    0x33, 0x09, 0x34, 0x09, 0x35, 0x81, 0x06, 0xC0, 0x85, 0x03, 0x05, 0x09, 0x19, 0x01, 0x29, 0x02, 0x15,
    0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x02, 0x81, 0x02, 0x95, 0x0E, 0x81, 0x03, 0xC0,
];

#[test]
fn a_cap_has_deflections_in_two_reports() {
    let mut codec = HidCodec::generic(CAP).expect("legal");
    let axis = |control, value| InputEvent::Axis { control, value };
    assert_eq!(
        heard(&mut codec, &[2, 0, 0, 0xE2, 0xFF, 0, 0]),
        [axis(3, 0), axis(4, -30), axis(5, 0)]
    );
    assert_eq!(heard(&mut codec, &[2, 0, 0, 0xE2, 0xFF, 0, 0]), []);
    let button = |control, down| InputEvent::Button { control, down };
    assert_eq!(heard(&mut codec, &[3, 3, 0]), [button(0, true), button(1, true)]);
    let profile = describe(CAP).expect("legal");
    let names: Vec<_> = profile.controls.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "z", "rx", "ry", "rz", "button"]);
    assert_eq!(profile.controls[0].range, Some([-350, 350]));
    assert_eq!(profile.controls[0].kind, ControlKind::Axis);
}

/// Keys as an array of three elements; 0 is no key.
#[test]
fn an_array_names_what_is_down() {
    let descriptor = [
        0x05, 0x01, 0x09, 0x04, 0xA1, 0x01, 0x05, 0x09, 0x19, 0x01, 0x29, 0x08, 0x15, 0x01, 0x25, 0x08, 0x75,
        0x08, 0x95, 0x03, 0x81, 0x00, 0xC0,
    ];
    let mut codec = HidCodec::generic(&descriptor).expect("legal");
    let button = |control, down| InputEvent::Button { control, down };
    assert_eq!(heard(&mut codec, &[3, 8, 0]), [button(2, true), button(7, true)]);
    assert_eq!(heard(&mut codec, &[0, 0, 8]), [button(2, false)]);
    assert_eq!(
        heard(&mut codec, &[9, 255, 1]),
        [button(7, false), button(0, true)]
    );
}

/// Two fingers, each with tip, id and place; then how many there are.
#[test]
fn fingers_come_and_go() {
    let mut writer = Writer::default();
    writer.begin((0xD, 4), 1);
    writer.report(Some(4));
    let field = |usage, width: u32, high| Made {
        usage,
        width,
        low: 0,
        high,
        relative: false,
        null: false,
        padding: 0,
        spelling: super::written::Spelling::Short,
    };
    for _ in 0..2 {
        writer.begin((0xD, 0x22), 2);
        writer.field(&field((0xD, 0x42), 1, 1));
        writer.padding(7);
        writer.field(&field((0xD, 0x51), 8, 31));
        writer.field(&field((1, 0x30), 16, 4095));
        writer.field(&field((1, 0x31), 16, 4095));
        writer.end();
    }
    writer.field(&field((0xD, 0x54), 8, 2));
    writer.end();
    let mut codec = HidCodec::generic(&writer.bytes).expect("legal");
    let touch = |id, at| InputEvent::Touch { id, at };
    let both = [4, 1, 7, 1, 0, 2, 0, 1, 9, 3, 0, 4, 0, 2];
    assert_eq!(
        heard(&mut codec, &both),
        [touch(7, Some([1, 2])), touch(9, Some([3, 4]))]
    );
    // Only one is told of: what stands in the other's place is stale.
    let one = [4, 0, 7, 1, 0, 2, 0, 0, 9, 3, 0, 4, 0, 1];
    assert_eq!(heard(&mut codec, &one), [touch(7, None)]);
    let mut left = Vec::new();
    codec.let_go(&mut |event| left.push(event));
    assert_eq!(left, [touch(9, None)]);
}
