//! The tablet against a driver's handshake, its packets by hand, and the wire's pace.

use super::*;
use crate::firmware::Firmware;
use crate::hands::Hands;
use crate::hands::{Pen, Puck};
use proptest::prelude::*;

fn graphire() -> Model {
    Model {
        text: "ET-0405-U".into(),
        version: "1.1-7".into(),
        resolution: [1016; 2],
        max: [5103, 3711],
        pressure_max: 511,
        eraser_bit: 3,
        tilt: false,
        answers_size: true,
        wheel: true,
    }
}

fn digitizer() -> Model {
    Model {
        text: "UD-1212-R00".into(),
        pressure_max: 255,
        eraser_bit: 2,
        tilt: true,
        ..graphire()
    }
}

#[test]
fn the_shipped_models_are_what_their_profiles_say() {
    let profiles = device_profiles::Profiles::builtin();
    let graphire = Model::from(profiles.input("graphire-serial").expect("shipped"));
    let mut tablet = WacomIv::new(graphire, 0);
    let mut now = 0;
    assert!(ask(&mut tablet, &mut now, b"~#", 100_000).starts_with(b"~#ET"));
    assert_eq!(
        ask(&mut tablet, &mut now, b"~C\r", 100_000),
        b"",
        "a Graphire keeps its size to itself"
    );
    let digitizer = Model::from(profiles.input("digitizer-ii").expect("shipped"));
    let mut tablet = WacomIv::new(digitizer, 0);
    assert_eq!(ask(&mut tablet, &mut now, b"~C\r", 100_000), b"~C15240,15240\r");
}

fn ask(tablet: &mut WacomIv, now_us: &mut u64, bytes: &[u8], wait_us: u64) -> Vec<u8> {
    tablet.receive(*now_us, bytes);
    *now_us += wait_us;
    let mut out = Vec::new();
    tablet.transmit(*now_us, &mut out);
    out
}

/// What the Linux driver does up to `ST`.
fn start(tablet: &mut WacomIv, now: &mut u64, more: &[u8]) {
    for baud in [38_400, 19_200, 9_600] {
        tablet.set_line_baud(*now, baud);
        ask(tablet, now, b"\r$", 250_000);
        ask(tablet, now, b"\r#", 75_000);
    }
    ask(tablet, now, b"SP\r", 30_000);
    ask(tablet, now, b"MU1\rOC1\r~M0\r~M1\rIT0\rIN0\rSR\rZF1\r", 60_000);
    ask(tablet, now, more, 60_000);
    ask(tablet, now, b"ST\r", 10_000);
    assert!(tablet.is_streaming());
}

#[test]
fn answers_a_drivers_questions() {
    let mut tablet = WacomIv::new(graphire(), 0);
    let mut now = 0;
    start(&mut tablet, &mut now, b"SP\r");
    // What came at 38400 and 19200 may have looked like a line.
    let garbage = tablet.unknown_commands();
    let answer = ask(&mut tablet, &mut now, b"~#", 100_000);
    assert_eq!(answer, b"~#ET-0405-U,V1.1-7\r");
    assert!(answer.len() <= 32);
    assert_eq!(
        ask(&mut tablet, &mut now, b"~R\r", 100_000),
        b"~RE202C900,002,02,1016,1016\r"
    );
    assert_eq!(ask(&mut tablet, &mut now, b"~C\r", 100_000), b"~C5103,3711\r");
    assert_eq!(tablet.unknown_commands(), garbage);
}

#[test]
fn hears_nothing_at_the_wrong_speed() {
    let mut tablet = WacomIv::new(graphire(), 0);
    let mut now = 0;
    tablet.set_line_baud(0, 38_400);
    assert_eq!(ask(&mut tablet, &mut now, b"~#", 100_000), b"");
    tablet.set_line_baud(now, 9_600);
    assert_eq!(
        ask(&mut tablet, &mut now, b"\r~#", 100_000),
        b"~#ET-0405-U,V1.1-7\r"
    );
}

#[test]
fn is_deaf_while_it_resets() {
    let mut tablet = WacomIv::new(graphire(), 0);
    let mut now = 0;
    ask(&mut tablet, &mut now, b"\r#", 20_000);
    assert_eq!(ask(&mut tablet, &mut now, b"~#", 30_000), b"");
    now += 30_000;
    assert_eq!(ask(&mut tablet, &mut now, b"~#", 100_000).len(), 19);
}

#[test]
fn a_pen_down_in_the_corners() {
    let mut tablet = WacomIv::new(graphire(), 0);
    let mut now = 0;
    start(&mut tablet, &mut now, b"");
    let pen = Pen {
        x: 1.0,
        y: -1.0,
        pressure: 1.0,
        tip: true,
        buttons: 2,
        ..Pen::default()
    };
    tablet.touch(now, &Touch::Pen(pen));
    // x 5103 = 0x13EF, y from the top 3711 = 0x0E7F, pressure 511 all ones, buttons 1 | 4.
    assert_eq!(
        ask(&mut tablet, &mut now, b"", 20_000),
        [0xEC, 0x27, 0x6F, 0x2C, 0x1C, 0x7F, 0x3F]
    );
    tablet.touch(
        now,
        &Touch::Pen(Pen {
            x: -1.0,
            y: 1.0,
            eraser: true,
            ..Pen::default()
        }),
    );
    assert_eq!(
        ask(&mut tablet, &mut now, b"", 20_000),
        [0xE8, 0, 0, 0x40, 0, 0, 0x40]
    );
    tablet.touch(now, &Touch::Away);
    assert_eq!(
        ask(&mut tablet, &mut now, b"", 20_000),
        [0xA0, 0, 0, 0, 0, 0, 0x40]
    );
    assert_eq!(
        ask(&mut tablet, &mut now, b"", 20_000),
        [],
        "one report, then quiet"
    );
}

#[test]
fn a_puck_with_its_wheel() {
    let mut tablet = WacomIv::new(graphire(), 0);
    let mut now = 0;
    start(&mut tablet, &mut now, b"");
    tablet.touch(
        now,
        &Touch::Puck(Puck {
            x: -1.0,
            y: 1.0,
            buttons: 2,
            wheel: -2,
            serial: 0,
        }),
    );
    assert_eq!(
        ask(&mut tablet, &mut now, b"", 20_000),
        [0xC8, 0, 0, 0x10, 0, 0, 0x60]
    );
    tablet.touch(
        now,
        &Touch::Puck(Puck {
            x: -1.0,
            y: 1.0,
            buttons: 0,
            wheel: 1,
            serial: 0,
        }),
    );
    assert_eq!(
        ask(&mut tablet, &mut now, b"", 20_000),
        [0xC0, 0, 0, 0, 0, 0, 0x10]
    );
}

#[test]
fn tilt_makes_nine_bytes_where_there_is_tilt() {
    let pen = Touch::Pen(Pen {
        x: -1.0,
        y: 1.0,
        pressure: 1.0,
        tilt_deg: [-10, 20],
        ..Pen::default()
    });
    let mut now = 0;
    let mut tablet = WacomIv::new(digitizer(), 0);
    start(&mut tablet, &mut now, b"FM1\r");
    tablet.touch(now, &pen);
    assert_eq!(
        ask(&mut tablet, &mut now, b"", 20_000),
        [0xE0, 0, 0, 0x04, 0, 0, 0x3F, 0x76, 0x6C]
    );
    let mut tablet = WacomIv::new(graphire(), 0);
    let mut now = 0;
    start(&mut tablet, &mut now, b"FM1\r");
    tablet.touch(now, &pen);
    assert_eq!(ask(&mut tablet, &mut now, b"", 20_000).len(), 7);
}

#[test]
fn a_fast_hand_is_held_to_the_wire_and_to_the_interval() {
    for (interval, packets) in [(&b"IT0\r"[..], 136..=138), (&b"IT4\r"[..], 49..=51)] {
        let mut tablet = WacomIv::new(graphire(), 0);
        let mut now = 0;
        start(&mut tablet, &mut now, interval);
        let mut out = Vec::new();
        for step in 0..1000u32 {
            let pen = Pen {
                x: f64::from(step) / 1000.0,
                ..Pen::default()
            };
            tablet.touch(now + u64::from(step) * 1000, &Touch::Pen(pen));
        }
        tablet.transmit(now + 1_000_000, &mut out);
        assert!(packets.contains(&(out.len() / 7)), "{}", out.len() / 7);
    }
}

#[test]
fn a_click_between_two_packets_is_not_merged_away() {
    let mut tablet = WacomIv::new(graphire(), 0);
    let mut now = 0;
    start(&mut tablet, &mut now, b"");
    let pen = |tip| {
        Touch::Pen(Pen {
            tip,
            ..Pen::default()
        })
    };
    for tip in [false, true, false, true, false] {
        tablet.touch(now, &pen(tip));
    }
    let out = ask(&mut tablet, &mut now, b"", 50_000);
    let tips: Vec<bool> = out.chunks(7).map(|packet| packet[3] & 8 != 0).collect();
    assert_eq!(tips, [false, true, false, true, false]);
}

proptest! {
    #[test]
    fn how_calls_are_cut_up_changes_nothing(
        bytes in proptest::collection::vec(
            prop_oneof![Just(b'\r'), Just(b'~'), Just(b'#'), Just(b'S'), Just(b'T'), Just(b'$'), any::<u8>()], 0..40),
        cuts in proptest::collection::vec(0u64..400_000, 0..20),
        places in proptest::collection::vec((0u64..300_000, -1.0f64..1.0, any::<bool>()), 0..20),
    ) {
        let play = |cuts: &[u64]| {
            let mut doings: Vec<(u64, Option<(f64, bool)>)> = places.iter().map(|&(at, x, tip)| (at, Some((x, tip)))).collect();
            doings.extend(cuts.iter().map(|&at| (at, None)));
            doings.sort_by_key(|&(at, _)| at);
            let mut tablet = WacomIv::new(graphire(), 30);
            let mut out = Vec::new();
            tablet.receive(0, b"ZF1\rST\r");
            tablet.receive(0, &bytes);
            for (at, doing) in doings {
                match doing {
                    Some((x, tip)) => {
                        let pen = Pen { x, tip, pressure: x.abs(), ..Pen::default() };
                        tablet.touch(at, &Touch::Pen(pen));
                    }
                    None => tablet.transmit(at, &mut out),
                }
            }
            tablet.transmit(1_000_000, &mut out);
            out
        };
        prop_assert_eq!(play(&[]), play(&cuts));
    }

    #[test]
    fn only_the_first_byte_has_bit_seven(x in -1.0f64..1.0, y in -1.0f64..1.0, pressure in 0.0f64..1.0, tip: bool, eraser: bool) {
        let pen = Pen { x, y, pressure, tip, eraser, buttons: 3, tilt_deg: [-64, 63], serial: 0 };
        let mut scale = Scale::of(&graphire());
        scale.pressure = true;
        let (bytes, _) = packet::packet(&Pointer::pen(&pen, 3), &scale, true);
        prop_assert!(bytes[0] & 0x80 != 0);
        prop_assert!(bytes[1..].iter().all(|byte| byte & 0x80 == 0));
    }
}
