//! The tablet against the driver's conversation, and packets taken apart by the formulas of the driver's page.

use super::*;
use crate::firmware::Firmware;
use crate::hands::Hands;
use crate::hands::{Pen, Puck};
use proptest::prelude::*;

fn heard(tablet: &mut WacomV, now_us: u64) -> Vec<u8> {
    let mut out = Vec::new();
    tablet.transmit(now_us, &mut out);
    out
}

fn ask(tablet: &mut WacomV, now_us: &mut u64, bytes: &[u8]) -> Vec<u8> {
    tablet.receive(*now_us, bytes);
    *now_us += 100_000;
    heard(tablet, *now_us)
}

/// Set up as a driver does and reporting.
fn started(model: Model) -> (WacomV, u64) {
    let mut tablet = WacomV::new(model, 0);
    let mut now = 0;
    assert_eq!(ask(&mut tablet, &mut now, b"MT1\rID1\rIT0\rST\r"), []);
    assert!(tablet.is_streaming());
    (tablet, now)
}

fn pen(x: f64, y: f64) -> Pen {
    Pen {
        x,
        y,
        ..Pen::default()
    }
}

/// x and y as the driver's formulas take them out of a packet.
fn place(packet: &[u8]) -> [u16; 2] {
    let b = |n: usize| u16::from(packet[n] & 0x7F);
    [
        b(1) << 9 | b(2) << 2 | b(3) >> 5,
        (b(3) & 0x1F) << 11 | b(4) << 4 | b(5) >> 3,
    ]
}

#[test]
fn says_who_it_is_and_how_large_at_its_own_speed_only() {
    let mut tablet = WacomV::new(Model::default(), 0);
    let mut now = 0;
    for baud in [38_400, 19_200, 9600] {
        tablet.set_line_baud(now, baud);
        ask(&mut tablet, &mut now, b"\r$");
        now += 250_000;
        ask(&mut tablet, &mut now, b"SP\r");
    }
    assert_eq!(ask(&mut tablet, &mut now, b"~#"), b"~#GD-0608-R00,V1.2-0\r");
    assert_eq!(ask(&mut tablet, &mut now, b"~C\r"), b"~C20320,16240\r");
    assert!(ask(&mut tablet, &mut now, b"~R\r").ends_with(b",2540,2540\r"));
}

#[test]
fn goes_to_19200_and_from_rom_2_to_38400_and_comes_back_with_a_reset() {
    let table = [
        ("1.2-0", b"BA19\r", 19_200),
        ("1.2-0", b"BA38\r", 9600),
        ("2.0-2", b"BA38\r", 38_400),
    ];
    for (version, order, baud) in table {
        let mut tablet = WacomV::new(
            Model {
                text: "XD-0608-R00".to_owned(),
                version: version.to_owned(),
                ..Model::default()
            },
            0,
        );
        let mut now = 0;
        assert_eq!(ask(&mut tablet, &mut now, order), []);
        assert_eq!(tablet.baud(), baud, "{version}");
        tablet.set_line_baud(now, baud);
        assert!(ask(&mut tablet, &mut now, b"~#").starts_with(b"~#XD"));
        ask(&mut tablet, &mut now, b"\r$");
        now += 250_000;
        tablet.set_line_baud(now, 9600);
        assert!(ask(&mut tablet, &mut now, b"~#").starts_with(b"~#XD"));
    }
}

#[test]
fn a_pen_is_introduced_drawn_and_taken_away() {
    let (mut tablet, mut now) = started(Model {
        pen_serial: 0xC123_4567,
        ..Model::default()
    });
    let drawn = Pen {
        pressure: 1.0,
        tip: true,
        buttons: 2,
        tilt_deg: [-64, 63],
        ..pen(1.0, -1.0)
    };
    tablet.touch(now, &Touch::Pen(drawn));
    let said = ask(&mut tablet, &mut now, &[]);
    // Id 0x822 = 0x41 << 5 | 2; serial 0xC1234567 by two, seven, seven, seven, seven and two bits.
    assert_eq!(said[..9], [0xC0, 0x41, 0x0B, 0x02, 0x23, 0x22, 0x59, 0x60, 0]);
    let report = &said[9..];
    assert_eq!(report[0], 0xE4, "proximity, pen, side button 2");
    assert_eq!(place(report), [20_320, 16_240]);
    assert_eq!((report[5] & 7, report[6]), (7, 0x7F), "1023");
    assert_eq!(report[7..], [0x40, 0x41], "to the left, and away from the user");
    tablet.touch(now, &Touch::Lift(Held::Pen));
    assert_eq!(ask(&mut tablet, &mut now, &[]), [0x80, 0, 0, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn a_pen_turned_over_goes_and_another_tool_comes() {
    let (mut tablet, mut now) = started(Model::default());
    tablet.touch(now, &Touch::Pen(pen(0.0, 0.0)));
    ask(&mut tablet, &mut now, &[]);
    let over = Pen {
        eraser: true,
        ..pen(0.0, 0.0)
    };
    tablet.touch(now, &Touch::Pen(over));
    let said = ask(&mut tablet, &mut now, &[]);
    let heads: Vec<u8> = said.chunks(9).map(|packet| packet[0]).collect();
    assert_eq!(heads, [0x80, 0xC0, 0xE0]);
    let id = u16::from(said[10]) << 5 | u16::from(said[11]) >> 2;
    assert_eq!(id, 0x82A);
    // Another pen of the same kind is another tool too.
    let other = Pen {
        serial: 7,
        ..pen(0.0, 0.0)
    };
    tablet.touch(now, &Touch::Pen(other));
    assert_eq!(ask(&mut tablet, &mut now, &[]).len(), 27);
}

#[test]
fn two_tools_are_followed_at_once_each_on_its_channel() {
    let (mut tablet, mut now) = started(Model::default());
    let puck = Puck {
        x: -1.0,
        y: 1.0,
        buttons: 0b101,
        wheel: -2,
        serial: 0,
    };
    tablet.touch(now, &Touch::Pen(pen(0.5, 0.5)));
    tablet.touch(now, &Touch::Puck(puck));
    let said = ask(&mut tablet, &mut now, &[]);
    let heads: Vec<u8> = said.chunks(9).map(|packet| packet[0]).collect();
    assert_eq!(
        heads,
        [0xC0, 0xE0, 0xC1, 0xF1, 0xF1],
        "a packet for each click of the wheel"
    );
    assert_eq!(place(&said[27..]), [0, 0]);
    assert_eq!(
        [said[35], said[44]],
        [0b1_0101; 2],
        "buttons from bit 2, wheel back"
    );
    tablet.touch(now, &Touch::Lift(Held::Pen));
    assert_eq!(ask(&mut tablet, &mut now, &[])[0], 0x80);
    tablet.touch(now, &Touch::Puck(Puck { wheel: 0, ..puck }));
    assert_eq!(
        ask(&mut tablet, &mut now, &[])[0],
        0xF1,
        "the puck stays on its channel"
    );
    tablet.touch(now, &Touch::Away);
    assert_eq!(ask(&mut tablet, &mut now, &[])[0], 0x81);
}

#[test]
fn without_two_tool_mode_and_introductions_there_are_neither() {
    let mut tablet = WacomV::new(Model::default(), 0);
    let mut now = 0;
    ask(&mut tablet, &mut now, b"ST\r");
    tablet.touch(now, &Touch::Pen(pen(0.0, 0.0)));
    tablet.touch(now, &Touch::Puck(Puck::default()));
    let said = ask(&mut tablet, &mut now, &[]);
    assert_eq!((said.len(), said[0]), (9, 0xE0));
}

#[test]
fn lens_cursor_and_4d_mouse_have_their_own_packets() {
    let laid = |puck: PuckKind| {
        let (mut tablet, mut now) = started(Model {
            puck,
            ..Model::default()
        });
        tablet.touch(
            now,
            &Touch::Puck(Puck {
                buttons: 0b1_1010,
                wheel: -10,
                ..Puck::default()
            }),
        );
        let said = ask(&mut tablet, &mut now, &[]);
        let id = u16::from(said[1]) << 5 | u16::from(said[2]) >> 2;
        (id, said[9..].to_vec())
    };
    let (id, lens) = laid(PuckKind::Lens);
    assert_eq!((id, lens[0], lens[8], lens.len()), (0x096, 0xF0, 0b1_1010, 9));
    let (id, mouse) = laid(PuckKind::FourD);
    assert_eq!((id, mouse[0], mouse[9], mouse.len()), (0x094, 0xE8, 0xEA, 18));
    // Buttons 2, 4, 5: bit 1, bits 4 and 5; bit 3 because the wheel is pushed back, by 1020.
    assert_eq!(mouse[8], 0b0011_1010);
    assert_eq!(u16::from(mouse[5] & 7) << 7 | u16::from(mouse[6]), 1020);
}

#[test]
fn the_wire_merges_places_and_never_edges() {
    let (mut tablet, mut now) = started(Model::default());
    tablet.touch(now, &Touch::Pen(pen(-1.0, 0.0)));
    ask(&mut tablet, &mut now, &[]);
    for step in 0..500u16 {
        let at = f64::from(step) / 250.0 - 1.0;
        let button = step / 50 % 2;
        tablet.touch(
            now + u64::from(step) * 200,
            &Touch::Pen(Pen {
                buttons: button as u8,
                ..pen(at, 0.0)
            }),
        );
    }
    now += 300_000;
    let said = heard(&mut tablet, now);
    let pressed: Vec<bool> = said.chunks(9).map(|packet| packet[0] & 2 != 0).collect();
    let edges = pressed.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!(edges, 9);
    assert!(said.len() / 9 < 40, "{} packets", said.len() / 9);
}

proptest! {
    #[test]
    fn places_are_the_right_count(x in -1.0..=1.0f64, y in -1.0..=1.0f64, pressure in 0.0..=1.0f64) {
        let (mut tablet, mut now) = started(Model::default());
        tablet.touch(now, &Touch::Pen(Pen { pressure, ..pen(x, y) }));
        let said = ask(&mut tablet, &mut now, &[]);
        let report = &said[9..18];
        prop_assert!(report[1..].iter().all(|byte| byte & 0x80 == 0));
        let [across, down] = place(report);
        prop_assert!((f64::from(across) - f64::midpoint(x, 1.0) * 20_320.0).abs() <= 0.5);
        prop_assert!((f64::from(down) - f64::midpoint(1.0, -y) * 16_240.0).abs() <= 0.5);
        let pressed = f64::from(report[5] & 7) * 128.0 + f64::from(report[6]);
        prop_assert!((pressed - pressure * 1023.0).abs() <= 0.5);
    }

    #[test]
    fn any_bytes_are_survived_and_cuts_change_nothing(
        bytes in prop::collection::vec(any::<u8>(), 0..60),
        cuts in prop::collection::vec(100_000u64..500_000, 0..20),
    ) {
        let run = |cuts: &[u64]| {
            let (mut tablet, now) = started(Model::default());
            tablet.touch(now, &Touch::Pen(pen(0.1, 0.2)));
            tablet.receive(now, &bytes);
            let mut out = Vec::new();
            for &at in cuts {
                tablet.transmit(at, &mut out);
            }
            tablet.transmit(900_000, &mut out);
            out
        };
        let mut cuts = cuts;
        cuts.sort_unstable();
        prop_assert_eq!(run(&[]), run(&cuts));
    }
}
