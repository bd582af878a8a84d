//! Frames that real devices sent, with what they mean: every layout is held against them.
//!
//! Each row names its recording. Tables of layouts are `device-profiles`'; the frames here are facts of their own.

use super::HidCodec;
use crate::clock::Instant;
use crate::codec::{Codec, InputEvent, Outgoing, PenSample, Tool};
use device_profiles::{InputProfile, Profiles};
use std::time::Duration;

fn codec(profile: &str) -> HidCodec {
    let all = Profiles::builtin();
    HidCodec::new(all.input(profile).expect("it is built in")).expect("its tables are right")
}

/// Bytes as text, `02 e1 80`.
fn bytes(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).expect("two digits"))
        .collect()
}

fn heard(codec: &mut HidCodec, frame: &str) -> Vec<InputEvent> {
    let mut events = Vec::new();
    codec.decode(&bytes(frame), &mut |event| events.push(event));
    events
}

fn sample(codec: &mut HidCodec, frame: &str) -> PenSample {
    let events = heard(codec, frame);
    match events.last() {
        Some(&InputEvent::Pen(sample)) => sample,
        _ => panic!("{frame}: expected a sample, found {events:?}"),
    }
}

fn at(tool: Tool, x: u32, y: u32) -> PenSample {
    PenSample::hovering(tool, x, y)
}

fn pressed(pressure_counts: u32, buttons: u32, base: PenSample) -> PenSample {
    PenSample {
        pressure_counts,
        buttons,
        tip: true,
        ..base
    }
}

fn high(distance: u16, base: PenSample) -> PenSample {
    PenSample {
        distance: Some(distance),
        ..base
    }
}

fn tilted(x: i16, y: i16, base: PenSample) -> PenSample {
    PenSample {
        tilt: Some([x, y]),
        ..base
    }
}

/// bentiss/hid-devices at 54782922, `events/tablet`, and DIGImend/tablets at 358a1481.
#[test]
#[rustfmt::skip]
fn frames_of_tools_decode_to_what_they_mean() {
    use Tool::{Eraser, Mouse, Pen};
    let button = |buttons, base| PenSample { buttons, ..base };
    let pen = |x, y| at(Pen, x, y);
    let bamboo = [
        ("02 e1 80 39 ee 0b 8d 03 20", high(32, pressed(909, 0, pen(14_720, 3054)))),
        ("02 f3 e7 16 c7 0f a7 03 1c", high(28, pressed(935, 1, pen(5863, 4039)))),
        ("02 f5 78 16 4e 0f 24 03 1c", high(28, pressed(804, 2, pen(5752, 3918)))),
        ("02 f8 c5 15 21 0b 00 00 03", high(3, at(Eraser, 5573, 2849))),
        // Buttons and pressure are not valid.
        ("02 d0 00 00 96 0e 00 00 22 00", high(34, pen(0, 3734))),
    ];
    let fun = [
        ("02 d2 f9 20 40 15 18 00 00", high(24, button(2, at(Mouse, 8441, 5440)))),
        ("02 92 d0 13 f9 10 00 00 00", button(1, pen(5072, 4345))),
    ];
    let graphire = [("02 d2 db 12 12 13 00 24", high(36, button(2, at(Mouse, 4827, 4882))))];
    let hs610 = [
        ("08 80 88 47 EB 56 00 00 00 00 00 DC", tilted(0, -36, pen(18_312, 22_251))),
        ("08 81 F9 51 2C 3A FF 1F 00 00 FA 00", tilted(-6, 0, pressed(8191, 0, pen(20_985, 14_892)))),
    ];
    let xp_pen = [
        ("07 A1 65 29 E7 1E 80 1F", pressed(8064, 0, pen(10_597, 7911))),
        ("07 A1 BA 37 10 37 C2 11 3C 13", tilted(60, 19, pressed(4546, 0, pen(14_266, 14_096)))),
    ];
    let huion = [("0A C0 6B 38 BD 18 00 00 3C E7", tilted(60, -25, pen(14_443, 6333)))];
    let tables: [(&str, &[(&str, PenSample)]); 6] = [
        ("bamboo-pen", &bamboo),
        ("bamboo-fun", &fun),
        ("graphire3", &graphire),
        ("hs610", &hs610),
        ("xp-pen-coarse", &xp_pen),
        ("huion-coarse", &huion),
    ];
    let rows = tables.iter().flat_map(|&(profile, rows)| rows.iter().map(move |&(frame, want)| (profile, frame, want)));
    for (profile, frame, want) in rows {
        assert_eq!(sample(&mut codec(profile), frame), want, "{profile}: {frame}");
    }
}

/// 056A:00B8 and 056A:00B1: a tool says first which it is, then where.
#[test]
fn intuos_tools_bring_their_numbers() {
    let mut intuos4 = codec("intuos4-4x6");
    assert_eq!(heard(&mut intuos4, "02 c2 80 42 48 0d e2 11 00 00"), []);
    let art_pen = |base| PenSample {
        tool_serial: Some(0x2480_DE21),
        tool_type: Some(0x10804),
        ..base
    };
    // A rotation packet: a place, and nothing of pressure.
    let want = art_pen(high(47, at(Tool::Pen, 15_413, 5912)));
    assert_eq!(sample(&mut intuos4, "02 ea 1e 1a 0b 8c 42 a0 00 be"), want);
    let want = art_pen(tilted(27, 32, high(25, at(Tool::Pen, 7738, 8729))));
    // Bit 1 of the second byte is the first side button, as Linux's driver reads it.
    let want = PenSample { buttons: 1, ..want };
    assert_eq!(sample(&mut intuos4, "02 e2 0f 1d 11 0c 00 2d e0 65"), want);
    // Gone: where it was.
    assert_eq!(
        heard(&mut intuos4, "02 80 00 00 00 00 00 00 00 00"),
        [InputEvent::Pen(want.leaving())]
    );

    let mut intuos3 = codec("intuos3-6x8");
    assert_eq!(heard(&mut intuos3, "02 c2 01 70 46 25 81 00 00 00"), []);
    let want = PenSample {
        tool_serial: Some(0x0462_5810),
        tool_type: Some(0x017),
        ..high(14, at(Tool::Mouse, 7587, 17_787))
    };
    assert_eq!(sample(&mut intuos3, "02 f0 0e d1 22 bd 00 00 00 3b"), want);
}

#[test]
fn leaving_moves_nothing_to_the_corner() {
    let mut pen = codec("bamboo-pen");
    let last = sample(&mut pen, "02 e1 80 39 ee 0b 8d 03 20");
    assert_eq!(heard(&mut pen, "02 80 00 00 00 00 00 00 00"), []);
    assert_eq!(
        heard(&mut pen, "02 00 00 00 00 00 00 00 00"),
        [InputEvent::Pen(last.leaving())]
    );
    assert_eq!(heard(&mut pen, "02 00 00 00 00 00 00 00 00"), []);
    assert_eq!(pen.counters().unknown + pen.counters().rejected, 0);
}

/// A ring is told although no tool is there; keys come and go; stale bytes say nothing.
#[test]
fn pads_are_heard_beside_the_tool() {
    let ring = |value| InputEvent::Ring { control: 0, value };
    let mut fun = codec("bamboo-fun");
    assert_eq!(heard(&mut fun, "02 10 7f 1e 39 18 00 00 c7"), [ring(Some(0x47))]);
    assert_eq!(heard(&mut fun, "02 10 7f 1e 39 18 00 00 00"), [ring(None)]);
    let mut hs610 = codec("hs610");
    let key = |down| InputEvent::Button { control: 0, down };
    assert_eq!(
        heard(&mut hs610, "08 E0 01 01 01 00 00 00 00 00 DD 10"),
        [key(true)]
    );
    assert_eq!(
        heard(&mut hs610, "08 E0 01 01 00 00 00 00 00 00 DD 10"),
        [key(false)]
    );
    for step in [5, 4, 3] {
        let frame = format!("08 F0 01 01 00 {step:02x} 00 00 00 00 DD 10");
        assert_eq!(heard(&mut hs610, &frame), [ring(Some(step))]);
    }
    assert_eq!(
        heard(&mut hs610, "08 F0 01 01 00 00 00 00 00 00 DD 10"),
        [ring(None)]
    );
}

/// What real firmware sends between frames, and what a pad is before it is initialised.
#[test]
fn garbage_is_counted_and_means_nothing() {
    let mut hs610 = codec("hs610");
    assert_eq!(heard(&mut hs610, "78 CC 00 08 78 CC 00 08 78 CC 00 08"), []);
    assert_eq!(hs610.counters().unknown, 1);
    assert_eq!(heard(&mut hs610, "08 80"), []);
    assert_eq!(hs610.counters().rejected, 1);
    let mut g640s = codec("star-g640s");
    assert_eq!(heard(&mut g640s, "06 01 57 00 00 00 00 00"), []);
}

/// No report says so: 100 ms of silence.
#[test]
fn a_pen_that_falls_silent_has_left() {
    let mut hs610 = codec("hs610");
    let mut out = Outgoing::new();
    let at_ms = |ms| Instant::ZERO.after(Duration::from_millis(ms));
    let last = sample(&mut hs610, "08 81 F9 51 2C 3A FF 1F 00 00 FA 00");
    let mut events = Vec::new();
    for ms in [0, 99, 100, 500] {
        hs610.advance(at_ms(ms), &mut out, &mut |event| events.push((ms, event)));
    }
    assert_eq!(events, [(100, InputEvent::Pen(last.leaving()))]);
}

#[test]
fn boxes_turn_push_and_press() {
    let dial = |control, delta_counts| InputEvent::Dial {
        control,
        delta_counts,
    };
    let button = |control, down| InputEvent::Button { control, down };
    let axis = |control, value| InputEvent::Axis { control, value };
    let mut powermate = codec("powermate");
    assert_eq!(
        heard(&mut powermate, "01 ff 00 80 00 00"),
        [button(0, true), dial(0, -1)]
    );
    let mut shuttle = codec("shuttlepro-v2");
    // The first count only says where the jog stands; zero is a count like any other.
    assert_eq!(heard(&mut shuttle, "00 fe 00 00 00"), [axis(0, 0)]);
    assert_eq!(
        heard(&mut shuttle, "f9 00 00 10 00"),
        [axis(0, -7), button(4, true), dial(0, 2)]
    );
    let mut cap = codec("spacenavigator");
    let events = heard(&mut cap, "02 00 00 e2 ff 00 00");
    assert!(
        matches!(events[1], InputEvent::Axis { control: 4, value } if value.abs() == 30),
        "{events:?}"
    );
    assert_eq!(heard(&mut cap, "03 03 00"), [button(0, true), button(1, true)]);
    assert_eq!(heard(&mut cap, "03 02 00"), [button(0, false)]);
    let mut deck = codec("stream-deck-plus");
    assert_eq!(
        heard(&mut deck, "01 03 05 00 01 fe 00 00 03 00 00 00 00 00"),
        [dial(0, -2), dial(3, 3)]
    );
    let mut dial_of_surface = codec("surface-dial");
    assert_eq!(
        heard(&mut dial_of_surface, "01 01 f6 ff"),
        [button(0, true), dial(0, -10)]
    );
}

/// Every built-in profile of this format has tables that can be used.
#[test]
fn all_profiles_compile() {
    let all = Profiles::builtin();
    let hid: Vec<&InputProfile> = all.inputs().filter(|p| p.format == "hid").collect();
    assert!(hid.len() >= 40, "{} profiles", hid.len());
    for profile in hid {
        HidCodec::new(profile).expect(&profile.key);
    }
    let lost = InputProfile {
        layout: Some("nowhere".into()),
        of_layout: None,
        ..all.input("hs610").expect("built in").clone()
    };
    let error = HidCodec::new(&lost).expect_err("no layout");
    assert!(error.to_string().contains("its layout \"nowhere\""), "{error}");
}
