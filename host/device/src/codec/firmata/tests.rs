use super::*;
use crate::codec::trial::{Trial, all_bytes, assert_cut_invariant, assert_lets_go, bytes, counted};
use proptest::prelude::*;

fn settings() -> Settings {
    Settings {
        analog: vec![0, 2],
        analog_max: 1023,
        digital: vec![
            Switch {
                pin: 4,
                pull_up: true,
            },
            Switch {
                pin: 9,
                pull_up: false,
            },
        ],
        encoders: vec![[2, 3]],
        lamps: vec![
            Lamp {
                pin: 13,
                dimmed: false,
            },
            Lamp { pin: 5, dimmed: true },
        ],
        interval_ms: 19,
        boot_wait_ms: 3_000,
    }
}

fn listening() -> Trial<Firmata> {
    Trial::new(Firmata::listening(settings()))
}

const VERSION_25: [u8; 3] = [0xF9, 2, 5];

/// Pins of an Uno as StandardFirmata tells them, with encoders: 2 to 13 digital, 14 to 19 analog.
fn capabilities(analog_bits: u8) -> Vec<u8> {
    let mut message = vec![0xF0, 0x6C];
    for pin in 0..20_u8 {
        match pin {
            0 | 1 => {}
            2 | 3 => message.extend([0, 1, 1, 1, 11, 1, 9, 1]),
            5 => message.extend([0, 1, 1, 1, 11, 1, 3, 8]),
            14.. => message.extend([0, 1, 1, 1, 11, 1, 2, analog_bits]),
            _ => message.extend([0, 1, 1, 1, 11, 1]),
        }
        message.push(0x7F);
    }
    message.push(0xF7);
    message
}

fn mapping() -> Vec<u8> {
    let mut message = vec![0xF0, 0x6A];
    message.extend([0x7F; 14]);
    message.extend(0..6);
    message.push(0xF7);
    message
}

/// Through all questions; gives the set-up.
fn answered(trial: &mut Trial<Firmata>, analog_bits: u8) -> Vec<u8> {
    trial.hear(&VERSION_25);
    trial.hear(&VERSION_25);
    trial.hear(&[0xF0, 0x79, 2, 5, b'U', 0, b'n', 0, b'o', 0, 0xF7]);
    trial.hear(&capabilities(analog_bits));
    all_bytes(&trial.hear(&mapping()))
}

const SET_UP: &[u8] = &[
    0xFF, // reset
    0xF0, 0x7A, 19, 0, 0xF7, // interval
    0xF4, 14, 2, 0xC0, 1, // A0
    0xF4, 16, 2, 0xC2, 1, // A2
    0xF4, 4, 0x0B, // pull-up
    0xF4, 9, 0, // input
    0xD0, 1, 0xD1, 1, // their ports
    0xF0, 0x61, 0, 0, 2, 3, 0xF7, // encoder
    0xF0, 0x61, 4, 1, 0xF7, // by itself
    0xF4, 13, 1, // lamp
    0xF4, 5, 3, // dimmed lamp
    0xF5, 13, 0, 0xE5, 0, 0, // both dark
];

/// A board that says all of itself again, and goes on.
#[test]
fn hearing_asks_for_no_memory() {
    let mut codec = Firmata::listening(settings());
    let firmware = [
        0xF0, 0x79, 2, 5, b' ', 0, b'D', 0, b'e', 0, b's', 0, b'k', 0, 0xF7,
    ];
    let turned = [0xE0, 0x10, 0x02, 0xE2, 0x20, 0x01];
    let said = [&firmware[..], &capabilities(10), &mapping(), &turned].concat();
    let mut heard = 0;
    codec.decode(&said, &mut |_| heard += 1);
    assert_eq!((codec.identity(), heard), (Some("Desk 2.5"), 2));
    let counted = allocation_counter::measure(|| codec.decode(&said, &mut |_| heard += 1));
    assert_eq!((counted.count_total, codec.identity()), (0, Some("Desk 2.5")));
}

#[test]
fn a_board_that_announces_itself_is_asked_and_set_up() {
    let mut trial = Trial::new(Firmata::new(settings()));
    assert_eq!(trial.start(), [], "it may be booting");
    assert_eq!(trial.after_ms(2_000), []);
    assert_eq!(trial.hear(&VERSION_25), [bytes(&[0xF9])]);
    assert_eq!(trial.hear(&VERSION_25), [bytes(&[0xF0, 0x79, 0xF7])]);
    let name = [0xF0, 0x79, 2, 5, b'U', 0, b'n', 0, b'o', 0, 0xF7];
    assert_eq!(trial.hear(&name), [bytes(&[0xF0, 0x6B, 0xF7])]);
    assert_eq!(trial.hear(&capabilities(10)), [bytes(&[0xF0, 0x69, 0xF7])]);
    assert_eq!(all_bytes(&trial.hear(&mapping())), SET_UP);
    assert_eq!(trial.told(), [InputEvent::Started]);
    assert_eq!(trial.codec.identity(), Some("Uno 2.5"));
    assert_eq!(trial.codec.counters(), counted(5, 0, 0));
}

#[test]
fn a_board_that_was_running_is_asked_after_the_wait() {
    let mut trial = Trial::new(Firmata::new(settings()));
    trial.start();
    assert_eq!(trial.after_ms(2_999), []);
    assert_eq!(trial.after_ms(1), [bytes(&[0xF9])]);
    assert_eq!(trial.after_ms(1_000), [], "nobody: the wait begins again");
    assert_eq!(trial.after_ms(3_000), [bytes(&[0xF9])]);
    trial.hear(&[0xF9, 1, 0]);
    assert_eq!(trial.codec.counters(), counted(0, 0, 1), "another generation");
    assert_eq!(trial.hear(&VERSION_25), [bytes(&[0xF0, 0x79, 0xF7])]);
    // What it does not tell is assumed: channels without pins, ten bits.
    trial.after_ms(1_000);
    trial.after_ms(1_000);
    let set_up = all_bytes(&trial.after_ms(1_000));
    assert!(set_up.starts_with(&[0xFF, 0xF0, 0x7A, 19, 0, 0xF7, 0xC0, 1, 0xC2, 1, 0xF4, 4, 0x0B]));
    assert!(trial.codec.started());
}

#[test]
fn pins_that_cannot_are_left_out_and_counted() {
    let settings = Settings {
        analog: vec![9],
        digital: vec![Switch {
            pin: 0,
            pull_up: true,
        }],
        encoders: vec![[2, 4]],
        lamps: vec![Lamp {
            pin: 13,
            dimmed: true,
        }],
        ..settings()
    };
    let mut trial = Trial::new(Firmata::new(settings));
    trial.start();
    let set_up = answered(&mut trial, 10);
    assert_eq!(
        set_up,
        [0xFF, 0xF0, 0x7A, 19, 0, 0xF7, 0xF4, 13, 1, 0xF5, 13, 0],
        "the lamp is only switched"
    );
    assert_eq!(trial.codec.counters().rejected, 3);
}

#[test]
fn potentiometers_have_the_profiles_scale() {
    let axis = |control, value| InputEvent::Axis { control, value };
    for (bits, rows) in [
        (10, [(0x00, 0x00, 0), (0x00, 0x04, 512), (0x7F, 0x07, 1023)]),
        (12, [(0x00, 0x00, 0), (0x00, 0x10, 512), (0x7F, 0x1F, 1023)]),
    ] {
        let mut trial = Trial::new(Firmata::new(settings()));
        trial.start();
        answered(&mut trial, bits);
        for (low, high, value) in rows {
            assert_eq!(trial.said(&[0xE2, low, high]), [axis(1, value)], "{bits} bits");
        }
        assert_eq!(
            trial.said(&[0xE2, 0x7F, 0x7F]),
            [],
            "above the largest is the largest"
        );
        assert_eq!(trial.said(&[0xE1, 1, 1]), [], "nobody asked for A1");
        // Pin 14 is A0.
        assert_eq!(trial.said(&[0xF0, 0x6F, 14, 0, 0, 0, 0xF7]), [axis(0, 0)]);
    }
}

#[test]
fn switches_tell_edges_and_pull_ups_turn_them_over() {
    let button = |control, down| InputEvent::Button { control, down };
    let mut trial = listening();
    let rows: [(&[u8], Vec<InputEvent>); 6] = [
        (&[0x90, 0x10, 0], vec![]),
        (&[0x90, 0x00, 0], vec![button(0, true)]),
        (&[0x90, 0x6F, 1], vec![]),
        (&[0x90, 0x10, 0], vec![button(0, false)]),
        (&[0x91, 0x02, 0], vec![button(1, true)]),
        (&[0x91, 0x00, 1], vec![button(1, false)]),
    ];
    for (message, want) in rows {
        assert_eq!(trial.said(message), want, "{message:02X?}");
    }
}

#[test]
fn encoders_count_in_28_bits_with_a_sign() {
    let dial = |delta_counts| InputEvent::Dial {
        control: 0,
        delta_counts,
    };
    let mut trial = listening();
    let at = |sign, p0, p1, p2, p3| [0xF0, 0x61, sign, p0, p1, p2, p3, 0xF7];
    assert_eq!(trial.said(&at(0, 5, 0, 0, 0)), [], "it says where it stands");
    assert_eq!(trial.said(&at(0, 7, 0, 0, 0)), [dial(2)]);
    assert_eq!(trial.said(&at(0x40, 1, 0, 0, 0)), [dial(-8)]);
    assert_eq!(trial.said(&at(0x40, 1, 0, 0, 0)), []);
    assert_eq!(trial.said(&at(0, 0x7F, 0x7F, 0x7F, 0x7F)), [dial(268_435_456)]);
    assert_eq!(trial.codec.counters(), counted(5, 0, 0));
    assert_eq!(trial.said(&[0xF0, 0x61, 0, 1, 2, 0xF7]), [], "too short");
    assert_eq!(trial.said(&at(1, 1, 0, 0, 0)), [], "there is no second");
    assert_eq!(trial.codec.counters(), counted(5, 0, 2));
}

#[test]
fn lamps_are_sent_when_they_change() {
    let mut trial = listening();
    let mut out = Outgoing::new();
    let mut show = |feedback: Feedback, out: &mut Outgoing| {
        out.clear();
        trial.codec.encode(&feedback, out);
        out.all_bytes()
    };
    assert_eq!(
        show(Feedback::Lamps(0b11), &mut out),
        [0xF5, 13, 1, 0xE5, 0x7F, 1]
    );
    assert_eq!(show(Feedback::Lamps(0b11), &mut out), []);
    let dim = Feedback::Lamp {
        control: 1,
        level: 130,
        colour: None,
    };
    assert_eq!(show(dim, &mut out), [0xE5, 2, 1]);
    assert_eq!(show(Feedback::Lamps(0), &mut out), [0xF5, 13, 0, 0xE5, 0, 0]);
}

#[test]
fn a_board_that_starts_anew_is_asked_anew() {
    let mut trial = Trial::new(Firmata::new(settings()));
    trial.start();
    answered(&mut trial, 10);
    trial.told();
    trial.hear(&[0x90, 0, 0]);
    trial.told();
    assert_eq!(trial.hear(&VERSION_25), [], "booting");
    assert_eq!(
        trial.told(),
        [InputEvent::Button {
            control: 0,
            down: false
        }]
    );
    assert!(!trial.codec.started());
    assert_eq!(answered(&mut trial, 10), SET_UP);
    assert_eq!(trial.told(), [InputEvent::Restarted]);
}

#[test]
fn damage_is_counted_and_skipped() {
    let axis = InputEvent::Axis { control: 0, value: 1 };
    let mut trial = listening();
    assert_eq!(trial.said(&[1, 2, 0xC0, 0xE0, 5, 0xE0, 1, 0, 0xF7]), [axis]);
    // Two bytes and a status of no kind; a message cut short; an end of nothing.
    assert_eq!(trial.codec.counters(), counted(1, 3, 2));
    let mut long = vec![0xF0, 0x71];
    long.extend([0x11; 5000]);
    long.push(0xF7);
    assert_eq!(trial.said(&long), []);
    assert_eq!(trial.codec.counters(), counted(1, 3, 3));
    assert_eq!(trial.said(&[0xF0, 0x71, b'h', 0, 0xF7]), [], "text for people");
    assert_eq!(trial.codec.counters(), counted(2, 3, 3));
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(
        stream in prop::collection::vec(prop_oneof![Just(0xE0_u8), Just(0x90), Just(0xF0), Just(0xF7), Just(0x61), any::<u8>()], 0..200),
        cut in 0_usize..200,
    ) {
        assert_cut_invariant(|| Firmata::listening(settings()), &stream, cut);
    }

    #[test]
    fn everything_is_let_go(stream in prop::collection::vec(prop_oneof![Just(0x90_u8), 0_u8..0x80], 0..200)) {
        assert_lets_go(Firmata::listening(settings()), &stream);
    }

    #[test]
    fn answers_of_any_bytes_are_survived(stream in prop::collection::vec(any::<u8>(), 0..300)) {
        let mut trial = Trial::new(Firmata::new(settings()));
        trial.start();
        for command in [0x79, 0x6C, 0x6A, 0x61, 0x6F] {
            trial.hear(&VERSION_25);
            trial.hear(&[0xF0, command]);
            trial.hear(&stream);
            trial.hear(&[0xF7]);
            trial.after_ms(1_000);
        }
        trial.hear(&[0xE0, 1, 1, 0x90, 1, 1]);
    }
}
