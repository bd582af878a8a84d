//! The tablet against the driver's conversation and packets worked out by hand.

use super::*;
use crate::firmware::Firmware;
use crate::hands::Hands;
use crate::hands::{Pen, Puck};
use crate::script::Script;
use proptest::prelude::*;

fn heard(tablet: &mut SummagraphicsMm, now_us: u64) -> Vec<u8> {
    let mut out = Vec::new();
    tablet.transmit(now_us, &mut out);
    out
}

fn ask(tablet: &mut SummagraphicsMm, now_us: &mut u64, bytes: &[u8]) -> Vec<u8> {
    tablet.receive(*now_us, bytes);
    *now_us += 100_000;
    heard(tablet, *now_us)
}

/// Awake and in prompt mode.
fn awake(model: Model) -> (SummagraphicsMm, u64) {
    let mut tablet = SummagraphicsMm::new(model, 0);
    let mut now = 0;
    tablet.receive(now, b"          \0");
    now += 400_000;
    assert!(heard(&mut tablet, now).is_empty() && tablet.is_awake());
    assert_eq!(ask(&mut tablet, &mut now, b"B"), []);
    (tablet, now)
}

fn puck(x: f64, y: f64, buttons: u8) -> Touch {
    Touch::Puck(Puck {
        x,
        y,
        buttons,
        ..Puck::default()
    })
}

#[test]
fn hears_nothing_until_spaces_have_told_it_the_speed() {
    let mut tablet = SummagraphicsMm::new(Model::default(), 0);
    let mut now = 0;
    assert_eq!(ask(&mut tablet, &mut now, b"z?a"), []);
    assert!(!tablet.is_awake());
    // At any speed.
    tablet.set_line_baud(now, 4800);
    tablet.receive(now, b"          \0");
    now += 200_000;
    assert_eq!(ask(&mut tablet, &mut now, b"z?"), [], "still deaf after 200 ms");
    now += 200_000;
    let mut text = ask(&mut tablet, &mut now, b"Bz?");
    text.extend(ask(&mut tablet, &mut now, &[]));
    assert_eq!(text, b"MM2 12x12 Tablet by Summagraphics Firmware Version 1.00\r");
}

#[test]
fn the_drivers_conversation() {
    let (mut tablet, mut now) = awake(Model::default());
    let text = ask(&mut tablet, &mut now, b"z?");
    assert!(text.starts_with(b"MM2 12x12 Tablet") && text.ends_with(b"\r"));
    // 12 inches at 500: 6000 = 46 << 7 | 112; at 1016: 12192 = 95 << 7 | 32.
    assert_eq!(ask(&mut tablet, &mut now, b"ha"), [0x98, 112, 46, 112, 46]);
    assert_eq!(ask(&mut tablet, &mut now, b"qa"), [0x98, 32, 95, 32, 95]);
    // More lines than fourteen bits hold.
    assert_eq!(ask(&mut tablet, &mut now, b"va"), [0x98, 127, 127, 127, 127]);
    ask(&mut tablet, &mut now, b"h0bzb@I\x21F");
    tablet.touch(now, &puck(-1.0, 1.0, 0));
    assert_eq!(ask(&mut tablet, &mut now, &[]), [0x98, 0, 0, 0, 0]);
    tablet.touch(now, &puck(1.0, 1.0, 1));
    assert_eq!(ask(&mut tablet, &mut now, &[]), [0x99, 112, 46, 0, 0]);
    tablet.touch(now, &puck(1.0, -1.0, 0b1000));
    assert_eq!(ask(&mut tablet, &mut now, &[]), [0x9C, 112, 46, 112, 46]);
    tablet.touch(now, &Touch::Away);
    assert_eq!(ask(&mut tablet, &mut now, &[]), [0xD8, 112, 46, 112, 46]);
    assert_eq!(tablet.unknown_commands(), 0);
}

#[test]
fn two_buttons_look_like_a_third() {
    let (mut tablet, mut now) = awake(Model::default());
    for (buttons, code) in [(0b0001, 1), (0b0010, 2), (0b0100, 3), (0b0011, 3), (0b1001, 5)] {
        tablet.touch(now, &puck(0.0, 0.0, buttons));
        assert_eq!(ask(&mut tablet, &mut now, b"P")[0], 0x98 | code, "{buttons:04b}");
    }
    let pen = Touch::Pen(Pen {
        tip: true,
        buttons: 1,
        ..Pen::default()
    });
    tablet.touch(now, &pen);
    assert_eq!(
        ask(&mut tablet, &mut now, b"P")[0],
        0x98 | 3,
        "point and side button"
    );
}

#[test]
fn prompted_it_says_one_report_and_says_nothing_otherwise() {
    let (mut tablet, mut now) = awake(Model::default());
    assert_eq!(ask(&mut tablet, &mut now, b"P")[0], 0xD8, "nothing there");
    tablet.touch(now, &puck(0.5, 0.0, 0));
    assert_eq!(ask(&mut tablet, &mut now, &[]), []);
    // 4500 = 35 << 7 | 20, 3000 = 23 << 7 | 56.
    assert_eq!(
        ask(&mut tablet, &mut now, b"PP"),
        [0x98, 20, 35, 56, 23].repeat(2)
    );
    assert_eq!(
        ask(&mut tablet, &mut now, b"1P")[0],
        0xB8,
        "the second tablet on the line"
    );
}

#[test]
fn streams_what_lies_still_only_without_an_increment() {
    let (mut tablet, mut now) = awake(Model::default());
    tablet.touch(now, &puck(0.0, 0.0, 0));
    tablet.receive(now, b"@");
    now += 1_000_000;
    let still = heard(&mut tablet, now).len() / 5;
    assert!((95..=101).contains(&still), "{still}");
    tablet.receive(now, b"I*");
    heard(&mut tablet, now + 20_000);
    now += 100_000;
    assert_eq!(heard(&mut tablet, now), []);
    // An increment of 10: nine counts are nothing, ten are a report. 6000 counts across.
    tablet.touch(now, &puck(18.0 / 6000.0, 0.0, 0));
    assert_eq!(ask(&mut tablet, &mut now, &[]), []);
    tablet.touch(now, &puck(20.0 / 6000.0, 0.0, 0));
    assert_eq!(ask(&mut tablet, &mut now, &[]), [0x98, 66, 23, 56, 23]);
}

#[test]
fn relative_packets_are_three_bytes_with_signs_and_long_ways_take_several() {
    let (mut tablet, mut now) = awake(Model::default());
    ask(&mut tablet, &mut now, b"bEI!@");
    tablet.touch(now, &puck(-1.0, 1.0, 0));
    ask(&mut tablet, &mut now, &[]);
    tablet.touch(now, &puck(-1.0 + 400.0 / 6000.0, 1.0 - 20.0 / 6000.0, 0));
    assert_eq!(ask(&mut tablet, &mut now, &[]), [0x98, 127, 10, 0x98, 73, 0]);
    tablet.touch(now, &puck(-1.0 + 396.0 / 6000.0, 1.0, 2));
    assert_eq!(ask(&mut tablet, &mut now, &[]), [0x82, 2, 10]);
}

#[test]
fn text_forms_are_lines() {
    let table = [
        (Form::Mm1103, "3000,3000,2\n", "3000,3000,0\n"),
        (Form::BitPadTwo, "3000,3000,2\r\n", "3000,3000,9\r\n"),
    ];
    for (form, near, away) in table {
        let (mut tablet, mut now) = awake(Model {
            form,
            ..Model::default()
        });
        tablet.touch(now, &puck(0.0, 0.0, 2));
        assert_eq!(ask(&mut tablet, &mut now, b"P"), near.as_bytes());
        tablet.touch(now, &Touch::Away);
        assert_eq!(ask(&mut tablet, &mut now, b"P"), away.as_bytes());
    }
}

#[test]
fn a_host_without_parity_is_hard_to_understand_and_hears_zeros() {
    let (mut tablet, mut now) = awake(Model::default());
    tablet.set_line_parity(now, Parity::None);
    // `B` has two ones, so its missing bit looks right; `z` has five.
    assert_eq!(ask(&mut tablet, &mut now, b"z?"), []);
    // Everybody's `a` has three ones: lost. `P` has two: heard.
    assert_eq!(ask(&mut tablet, &mut now, b"a"), []);
    tablet.touch(now, &puck(-1.0, -1.0, 0));
    // 0x98 has three ones: its bit is 0 where the host expects the stop bit.
    assert_eq!(ask(&mut tablet, &mut now, b"P"), [0, 0, 0, 0, 0]);
    tablet.touch(now, &puck(-1.0, -1.0, 1));
    assert_eq!(ask(&mut tablet, &mut now, b"P")[0], 0x99);
}

#[test]
fn a_power_cycle_puts_it_to_sleep() {
    let (mut tablet, mut now) = awake(Model::default());
    ask(&mut tablet, &mut now, b"@");
    tablet.touch(now, &Touch::PowerCycle);
    tablet.touch(now, &puck(0.0, 0.0, 0));
    assert_eq!(ask(&mut tablet, &mut now, b"BP"), []);
    tablet.receive(now, b"          \0");
    now += 500_000;
    assert!(!heard(&mut tablet, now).is_empty(), "it streams after waking");
}

proptest! {
    #[test]
    fn any_bytes_are_survived_and_cuts_change_nothing(
        bytes in prop::collection::vec(any::<u8>(), 0..60),
        cuts in prop::collection::vec(500_000u64..900_000, 0..20),
        moves in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, 0u8..16), 0..12),
    ) {
        let run = |cuts: &[u64]| {
            let (mut tablet, now) = awake(Model::default());
            let actions = moves.iter().enumerate().map(|(n, &(x, y, buttons))| crate::script::Action {
                at_us: n as u64 * 9_000,
                touch: puck(x, y, buttons),
            });
            tablet.play(&Script { actions: actions.collect() });
            tablet.receive(now, b"@");
            tablet.receive(now, &bytes);
            let mut out = Vec::new();
            for &at in cuts {
                tablet.transmit(at, &mut out);
            }
            tablet.transmit(1_200_000, &mut out);
            out
        };
        let mut cuts = cuts;
        cuts.sort_unstable();
        prop_assert_eq!(run(&[]), run(&cuts));
    }
}
