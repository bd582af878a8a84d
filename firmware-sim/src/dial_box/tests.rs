//! The box against its independent readers, the wire's pace, and itself.

use super::*;
use crate::firmware::Firmware;
use proptest::prelude::*;

fn heard(dial_box: &mut SgiDialBox, now_us: u64) -> Vec<u8> {
    let mut out = Vec::new();
    dial_box.transmit(now_us, &mut out);
    out
}

/// Sends and waits long enough for any answer.
fn ask(dial_box: &mut SgiDialBox, now_us: &mut u64, bytes: &[u8]) -> Vec<u8> {
    dial_box.receive(*now_us, bytes);
    *now_us += 100_000;
    heard(dial_box, *now_us)
}

#[test]
fn is_silent_until_initialised_and_answers_each_20_once() {
    let mut dial_box = SgiDialBox::new(Options::default());
    let mut now = 0;
    dial_box.turn(now, 0, 5, 0);
    dial_box.press(now, 0, true);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), []);
    assert_eq!(ask(&mut dial_box, &mut now, &[0x20]), [0x20]);
    assert_eq!(ask(&mut dial_box, &mut now, &[0x20, 0x20]), [0x20, 0x20]);
}

#[test]
fn the_answer_comes_after_both_bytes_have_been_carried() {
    let mut dial_box = SgiDialBox::new(Options::default());
    dial_box.receive(0, &[0x20]);
    // Two bytes of ten bits at 9600 baud: 2083 us.
    assert_eq!(heard(&mut dial_box, 2_082), []);
    assert_eq!(heard(&mut dial_box, 2_084), [0x20]);
}

#[test]
fn satisfies_vrpn_which_asks_twice_and_sets_buttons_twice() {
    let mut dial_box = SgiDialBox::new(Options {
        loses_first_button_setup: true,
        ..Options::default()
    });
    let mut now = 0;
    assert_eq!(ask(&mut dial_box, &mut now, &[0x20]), [0x20]);
    assert_eq!(ask(&mut dial_box, &mut now, &[0x20]), [0x20]);
    let buttons = [0x71, 0xFF, 0xFF, 0xFF, 0xFF, 0x73, 0xFF, 0xFF, 0xFF, 0xFF];
    assert_eq!(ask(&mut dial_box, &mut now, &[0x50, 0xFF, 0xFF]), []);
    assert_eq!(ask(&mut dial_box, &mut now, &buttons), []);
    dial_box.press(now, 3, true);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), [], "the first set-up was lost");
    dial_box.press(now, 3, false);
    assert_eq!(ask(&mut dial_box, &mut now, &buttons), []);
    assert_eq!(ask(&mut dial_box, &mut now, &[0x75, 1, 0, 0, 0x80]), []);
    assert_eq!(dial_box.lamps(), 0x8000_0001);
    dial_box.press(now, 3, true);
    dial_box.press(now, 31, true);
    dial_box.press(now, 3, false);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), [0xDB, 0xC7, 0xFB]);
}

#[test]
fn satisfies_freeglut_and_the_usb_adapter() {
    let mut dial_box = SgiDialBox::new(Options::default());
    let mut now = 0;
    // The adapter sends it all in one go.
    assert_eq!(ask(&mut dial_box, &mut now, &[0x20, 0x50, 0x00, 0xFF]), [0x20]);
    dial_box.turn(now, 2, -1, 0);
    dial_box.turn(now, 7, 300, 0);
    assert_eq!(
        ask(&mut dial_box, &mut now, &[]),
        [0x32, 0xFF, 0xFF, 0x37, 0x01, 0x2C]
    );
}

#[test]
fn every_button_has_its_two_codes() {
    for (control, press) in [
        (0, 0xD8),
        (7, 0xDF),
        (8, 0xD0),
        (15, 0xD7),
        (16, 0xC8),
        (24, 0xC0),
        (31, 0xC7),
    ] {
        assert_eq!(button_code(control, true), press);
        assert_eq!(button_code(control, false), press + 0x20);
    }
}

#[test]
fn enabling_dials_disables_buttons() {
    let mut dial_box = SgiDialBox::new(Options::default());
    let mut now = 0;
    ask(
        &mut dial_box,
        &mut now,
        &[0x20, 0x71, 0xFF, 0xFF, 0xFF, 0xFF, 0x73, 0xFF, 0xFF, 0xFF, 0xFF],
    );
    dial_box.press(now, 0, true);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), [0xD8]);
    ask(&mut dial_box, &mut now, &[0x50, 0x00, 0xFF]);
    dial_box.press(now, 0, false);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), []);
}

#[test]
fn a_count_wraps_and_a_delta_does_not_notice() {
    let mut dial_box = SgiDialBox::new(Options::default());
    let mut now = 0;
    ask(&mut dial_box, &mut now, &[0x20, 0x50, 0x00, 0xFF]);
    dial_box.turn(now, 0, 0x7FFF, 0);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), [0x30, 0x7F, 0xFF]);
    dial_box.turn(now, 0, 1, 0);
    assert_eq!(
        ask(&mut dial_box, &mut now, &[0x51, 0x00, 0xFF]),
        [0x30, 0x80, 0x00]
    );
    dial_box.turn(now, 0, -1, 0);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), [0x40, 0xFF, 0xFF]);
}

#[test]
fn a_fast_turn_makes_one_report_a_slot_and_loses_no_count() {
    let mut dial_box = SgiDialBox::new(Options::default());
    let mut now = 0;
    ask(&mut dial_box, &mut now, &[0x20, 0x51, 0x00, 0xFF]);
    dial_box.turn(now, 4, 2000, 1_000_000);
    let reports = heard(&mut dial_box, now + 1_100_000);
    let deltas: Vec<i16> = reports
        .chunks(3)
        .map(|report| i16::from_be_bytes([report[1], report[2]]))
        .collect();
    assert!(reports.chunks(3).all(|report| report[0] == 0x44));
    assert_eq!(deltas.iter().map(|&delta| i32::from(delta)).sum::<i32>(), 2000);
    // 3 bytes at 9600 baud: 3.125 ms, so 320 a second.
    assert!((319..=322).contains(&deltas.len()), "{}", deltas.len());
}

#[test]
fn a_power_cycle_announces_itself_and_forgets() {
    let mut dial_box = SgiDialBox::new(Options {
        labels: true,
        ..Options::default()
    });
    let mut now = 0;
    ask(&mut dial_box, &mut now, &[0x20, 0x50, 0x00, 0xFF, 0x4B]);
    dial_box.turn(now, 0, 9, 0);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), [0x30, 0, 9]);
    dial_box.power_cycle(now);
    assert_eq!(dial_box.lamps(), 0);
    assert_eq!(ask(&mut dial_box, &mut now, &[0x20]), [], "deaf while it boots");
    now += 500_000;
    assert_eq!(heard(&mut dial_box, now), [0x20]);
    dial_box.turn(now, 0, 1, 0);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), []);
    assert_eq!(ask(&mut dial_box, &mut now, &[0x20, 0x50, 0x00, 0xFF]), [0x20]);
    dial_box.turn(now, 0, 1, 0);
    assert_eq!(ask(&mut dial_box, &mut now, &[]), [0x30, 0, 1]);
}

#[test]
fn labels_reach_a_box_that_has_them() {
    let text = [0x61, 2, b'X', b'-', b'T', b'r', b'a', b'n', b's', b' '];
    let mut dial_box = SgiDialBox::new(Options {
        labels: true,
        ..Options::default()
    });
    let mut now = 0;
    assert_eq!(ask(&mut dial_box, &mut now, &text), []);
    let outputs: Vec<Output> = dial_box.drain_outputs().map(|(_, output)| output).collect();
    assert_eq!(
        outputs,
        [Output::Label {
            control: 2,
            text: "X-Trans ".into()
        }]
    );
    // Without a display such bytes are noise, and each space in them initialises.
    let mut plain = SgiDialBox::new(Options::default());
    let text = [0x61, 2, b'X', b'-', b'T', b'r', b'a', b'n', b' ', b' '];
    assert_eq!(ask(&mut plain, &mut 0, &text), [0x20, 0x20]);
    assert_eq!(plain.unknown_bytes(), 8);
}

#[test]
fn a_port_at_the_wrong_speed_gets_no_sense() {
    let mut dial_box = SgiDialBox::new(Options::default());
    dial_box.set_line_baud(0, 19_200);
    let mut now = 0;
    assert_ne!(ask(&mut dial_box, &mut now, &[0x20]), [0x20]);
    dial_box.set_line_baud(now, 9600);
    ask(&mut dial_box, &mut now, &[0; 9]);
    assert_eq!(ask(&mut dial_box, &mut now, &[0x20]), [0x20]);
}

proptest! {
    #[test]
    fn how_calls_are_cut_up_changes_nothing(
        bytes in proptest::collection::vec(prop_oneof![Just(0x20u8), Just(0x50), Just(0xFF), any::<u8>()], 0..40),
        cuts in proptest::collection::vec(0u64..200_000, 0..30),
        counts in -500i32..500,
        drift_ppm in -200i32..200,
    ) {
        let play = |cuts: &[u64]| {
            let mut dial_box = SgiDialBox::new(Options { drift_ppm, ..Options::default() });
            let mut out = Vec::new();
            dial_box.receive(0, &[0x20, 0x51, 0x00, 0xFF]);
            dial_box.turn(0, 1, counts, 150_000);
            dial_box.receive(1000, &bytes);
            let mut cuts = cuts.to_vec();
            cuts.sort_unstable();
            for cut in cuts {
                dial_box.transmit(1000 + cut, &mut out);
            }
            dial_box.transmit(400_000, &mut out);
            out
        };
        prop_assert_eq!(play(&[]), play(&cuts));
    }
}
