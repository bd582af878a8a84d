//! The board as the protocol's pages describe it, message by message.

use super::*;
use crate::firmware::Firmware;
use crate::hands::Hands;
use proptest::prelude::*;

fn heard(board: &mut Firmata, now_us: u64) -> Vec<u8> {
    let mut out = Vec::new();
    board.transmit(now_us, &mut out);
    out
}

/// Sends and waits long enough for any answer, and not for a sampling interval.
fn ask(board: &mut Firmata, now_us: &mut u64, bytes: &[u8]) -> Vec<u8> {
    board.receive(*now_us, bytes);
    *now_us += 15_000;
    heard(board, *now_us)
}

fn outputs(board: &mut Firmata) -> Vec<Output> {
    let mut shown = Vec::new();
    shown.extend(board.drain_outputs().map(|(_, output)| output));
    shown
}

fn axis(control: u8, to: f64) -> Touch {
    Touch::Axis {
        control,
        to,
        over_us: 0,
    }
}

const GREETING: &[u8] =
    b"\xF9\x02\x05\xF0\x79\x02\x05C\0o\0n\0f\0i\0g\0u\0r\0a\0b\0l\0e\0F\0i\0r\0m\0a\0t\0a\0\xF7";

#[test]
fn opening_the_port_restarts_the_board_which_is_deaf_until_it_greets() {
    let mut board = Firmata::new(Options::default());
    board.port_opened(0);
    board.receive(1_000_000, &[0xF9]);
    assert_eq!(heard(&mut board, 1_799_000), []);
    assert_eq!(
        heard(&mut board, 1_830_000),
        GREETING,
        "and no answer to what came while it booted"
    );
    board.port_opened(3_000_000);
    assert_eq!(heard(&mut board, 4_799_000), []);
    assert_eq!(heard(&mut board, 4_830_000), GREETING);
}

#[test]
fn answers_what_it_is_asked() {
    let mut board = Firmata::new(Options::default());
    let mut now = 0;
    assert_eq!(ask(&mut board, &mut now, &[0xF9]), [0xF9, 2, 5]);
    assert_eq!(ask(&mut board, &mut now, &[0xF0, 0x79, 0xF7]), GREETING[3..]);
    let map = ask(&mut board, &mut now, &[0xF0, 0x69, 0xF7]);
    assert_eq!(map[..2], [0xF0, 0x6A]);
    assert_eq!(map[2 + 13..2 + 20], [127, 0, 1, 2, 3, 4, 5]);
    let mut able = ask(&mut board, &mut now, &[0xF0, 0x6B, 0xF7]);
    able.extend(ask(&mut board, &mut now, &[]));
    able.extend(ask(&mut board, &mut now, &[]));
    let pins: Vec<&[u8]> = able[2..able.len() - 1].split(|&byte| byte == 0x7F).collect();
    assert_eq!(pins.len(), 21, "twenty pins, each with its end");
    assert_eq!(pins[0], [] as [u8; 0]);
    assert_eq!(pins[2], [0, 1, 0x0B, 1, 1, 1, 9, 28]);
    assert_eq!(pins[3], [0, 1, 0x0B, 1, 1, 1, 3, 8, 9, 28]);
    assert_eq!(pins[14], [0, 1, 0x0B, 1, 1, 1, 2, 10, 9, 28]);
    ask(&mut board, &mut now, &[0xF4, 7, 0x0B]);
    assert_eq!(
        ask(&mut board, &mut now, &[0xF0, 0x6D, 7, 0xF7]),
        [0xF0, 0x6E, 7, 0x0B, 0, 0, 0xF7]
    );
}

#[test]
fn analog_values_come_at_once_and_then_every_interval() {
    let mut board = Firmata::new(Options::default());
    board.touch(0, &axis(2, 0.5));
    board.receive(0, &[0xC2, 1]);
    // 512 = 4 << 7.
    assert_eq!(heard(&mut board, 10_000), [0xE2, 0, 4]);
    let second = heard(&mut board, 1_010_000);
    assert_eq!(
        second.len() / 3,
        53,
        "every 19 ms, first 19 ms after it was switched on"
    );
    board.receive(1_010_000, &[0xF0, 0x7A, 100, 0, 0xF7]);
    heard(&mut board, 1_050_000);
    assert_eq!(heard(&mut board, 2_050_000).len() / 3, 10, "every 100 ms");
    board.receive(2_050_000, &[0xC2, 0]);
    heard(&mut board, 2_060_000);
    assert_eq!(heard(&mut board, 3_000_000), []);
    // A pin that is no analog input is not sampled.
    board.receive(3_000_000, &[0xF4, 16, 0, 0xC2, 1]);
    assert_eq!(
        heard(&mut board, 3_500_000).len(),
        3,
        "told once, when switched on"
    );
}

#[test]
fn a_button_pulls_its_pin_down_and_its_port_is_said_when_it_changes() {
    let mut board = Firmata::new(Options::default());
    let mut now = 0;
    // Pins 7 and 8 with pull-ups; ports 0 and 1.
    let set_up = [0xF4, 7, 0x0B, 0xF4, 8, 0x0B, 0xD0, 1, 0xD1, 1];
    assert_eq!(ask(&mut board, &mut now, &set_up), [0x90, 0, 1, 0x91, 1, 0]);
    let press = |control, down| Touch::Button { control, down };
    assert!(board.touch(now, &press(0, true)));
    assert_eq!(ask(&mut board, &mut now, &[]), [0x90, 0, 0]);
    board.touch(now, &press(1, true));
    board.touch(now, &press(0, false));
    assert_eq!(ask(&mut board, &mut now, &[]), [0x90, 0, 1, 0x91, 0, 0]);
    assert_eq!(ask(&mut board, &mut now, &[]), []);
    assert!(!board.touch(now, &press(4, true)), "there is no fifth button");
}

#[test]
fn encoders_are_attached_turned_asked_reset_and_let_go() {
    let mut board = Firmata::new(Options::default());
    let mut now = 0;
    let turn = |counts| Touch::Dial {
        control: 0,
        by: crate::hands::Turn::Counts(counts),
        over_us: 0,
    };
    board.touch(now, &turn(50));
    ask(&mut board, &mut now, &[0xF0, 0x61, 0, 1, 2, 3, 0xF7]);
    board.touch(now, &turn(-300));
    // −300: direction bit 0x40, 300 = 2 << 7 | 44.
    assert_eq!(
        ask(&mut board, &mut now, &[0xF0, 0x61, 1, 1, 0xF7]),
        [0xF0, 0x61, 0x41, 44, 2, 0, 0, 0xF7]
    );
    ask(&mut board, &mut now, &[0xF0, 0x61, 3, 1, 0xF7]);
    assert_eq!(
        ask(&mut board, &mut now, &[0xF0, 0x61, 2, 0xF7]),
        [0xF0, 0x61, 1, 0, 0, 0, 0, 0xF7]
    );
    // Attached the other way round it counts backwards.
    ask(&mut board, &mut now, &[0xF0, 0x61, 0, 0, 3, 2, 0xF7]);
    board.touch(now, &turn(5));
    assert_eq!(
        ask(&mut board, &mut now, &[0xF0, 0x61, 1, 0, 0xF7]),
        [0xF0, 0x61, 0x40, 5, 0, 0, 0, 0xF7]
    );
    ask(&mut board, &mut now, &[0xF0, 0x61, 5, 0, 0xF7]);
    board.receive(now, &[0xF0, 0x61, 4, 1, 0xF7]);
    now += 100_000;
    assert_eq!(
        heard(&mut board, now).len(),
        5 * 8,
        "every interval, moved or not"
    );
    board.receive(now, &[0xF0, 0x61, 5, 1, 0xF7]);
    now += 100_000;
    assert_eq!(heard(&mut board, now), [], "nothing attached, nothing to say");
}

#[test]
fn outputs_light_and_a_restart_puts_them_out() {
    let mut board = Firmata::new(Options::default());
    let mut now = 0;
    ask(
        &mut board,
        &mut now,
        &[0xF4, 13, 1, 0xF5, 13, 1, 0xF4, 9, 3, 0xE9, 0x7F, 1, 0x91, 0x10, 0],
    );
    let shown = outputs(&mut board);
    assert_eq!(
        shown,
        [
            Output::Lamps(1 << 13),
            Output::Lamps(1 << 13 | 1 << 9),
            Output::Lamps(1 << 12 | 1 << 9)
        ]
    );
    board.touch(now, &Touch::PowerCycle);
    assert_eq!(outputs(&mut board), [Output::Lamps(0)]);
}

#[test]
fn nonsense_is_counted() {
    let mut board = Firmata::new(Options::default());
    let mut now = 0;
    let long = [vec![0xF0], vec![1; 70], vec![0xF7]].concat();
    assert_eq!(
        ask(
            &mut board,
            &mut now,
            &[&[0x12, 0xA0, 0xF0, 0x05, 0xF7][..], &long].concat()
        ),
        []
    );
    assert_eq!(board.unknown_messages(), 4);
    assert_eq!(
        ask(&mut board, &mut now, &[0xF0, 0x79, 0xF9]),
        [0xF9, 2, 5],
        "a command cuts a sysex off"
    );
}

proptest! {
    #[test]
    fn how_calls_are_cut_up_changes_nothing_and_any_bytes_are_survived(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        cuts in prop::collection::vec(0u64..300_000, 0..20),
    ) {
        let run = |cuts: &[u64]| {
            let mut board = Firmata::new(Options { drift_ppm: -900, ..Options::default() });
            board.receive(0, &[0xC0, 1, 0xD0, 1, 0xF4, 7, 0x0B]);
            board.receive(20_000, &bytes);
            let mut out = Vec::new();
            for &at in cuts {
                board.transmit(at, &mut out);
            }
            board.transmit(400_000, &mut out);
            out
        };
        let mut cuts = cuts;
        cuts.retain(|&at| at > 20_000);
        cuts.sort_unstable();
        prop_assert_eq!(run(&[]), run(&cuts));
    }
}
