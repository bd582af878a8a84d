use super::*;
use crate::codec::trial::{Trial, assert_cut_invariant, assert_lets_go, counted, text};
use packet::Code;
use proptest::prelude::*;

fn meaning(tool: Tool, code: Code) -> Meaning {
    Meaning {
        tool,
        proximity_bit: 0x40,
        code,
        y_up: false,
    }
}

fn settings(meaning: Meaning) -> Settings {
    Settings {
        meaning,
        lines_per_inch: 1000,
        surface: Surface::flat([12_000, 12_000], [1000.0, 1000.0], 0),
        leave_after: None,
    }
}

fn puck() -> Meaning {
    meaning(Tool::Puck, Code::Buttons)
}

fn listening(meaning: Meaning) -> Trial<CalComp> {
    Trial::new(CalComp::listening(settings(meaning)))
}

fn command(name: &str) -> crate::codec::Step {
    text(&format!("\x1b%{name}\r"))
}

#[test]
fn a_tablet_is_quieted_asked_set_up_and_run() {
    let mut trial = Trial::new(CalComp::new(settings(puck())));
    assert_eq!(trial.start(), [command("C1N81")]);
    assert_eq!(trial.after_ms(50), [command("Q?")]);
    assert_eq!(trial.after_ms(50), [command("__V")]);
    assert_eq!(trial.hear(b"\r\nDBIII 2.01\r"), [command("__p")]);
    assert_eq!(trial.hear(b"33120\r"), [command("L1")]);
    for name in ["^23", "X1", "Y1", "JR1000,0", "VS"] {
        assert_eq!(trial.after_ms(50), [command(name)]);
    }
    // 12000 by 12005 in a packet: 93 * 128 + 96, 93 * 128 + 101.
    assert_eq!(trial.hear(&[0x80, 93, 96, 0, 93, 101]), [command("VA0")]);
    assert_eq!(trial.after_ms(50), [command("IR")]);
    assert_eq!(trial.told(), []);
    assert_eq!(trial.after_ms(50), []);
    assert_eq!(trial.told(), [InputEvent::Started]);
    assert_eq!(trial.codec.identity(), Some("33120, DBIII 2.01"));
    assert_eq!(
        trial.codec.surface().map(|s| s.max_counts),
        Some([12_000, 12_005])
    );
    assert_eq!(trial.codec.counters(), counted(3, 0, 0));
}

/// Through the whole opening without an answer.
fn unanswered(trial: &mut Trial<CalComp>) {
    for ms in [50, 50, 500, 500, 50, 50, 50, 50, 50, 500, 50, 50] {
        trial.after_ms(ms);
    }
}

#[test]
fn a_tablet_that_only_talks_is_there_when_it_talks() {
    // A real DrawingBoard 23120 was read with nothing but its transmit line connected.
    let mut trial = Trial::new(CalComp::new(settings(puck())));
    trial.start();
    let frame = [0xBC, 0x31, 0x2D, 0x00, 0x2E, 0x0F];
    trial.hear(&frame);
    unanswered(&mut trial);
    assert_eq!(trial.told(), [], "nothing has come since the questions");
    trial.hear(&frame);
    let told = trial.told();
    assert_eq!(told.len(), 2);
    assert_eq!(told[0], InputEvent::Started);
    assert!(trial.codec.started());
}

#[test]
fn silence_starts_over() {
    let mut trial = Trial::new(CalComp::new(settings(puck())));
    trial.start();
    unanswered(&mut trial);
    assert_eq!(trial.after_ms(2_999), []);
    assert_eq!(trial.after_ms(1), [command("C1N81")]);
    assert!(!trial.codec.started());
}

#[test]
fn packets_are_no_text_and_pressure_is_asked_for() {
    let mut trial = Trial::new(CalComp::new(settings(meaning(
        Tool::Pen,
        Code::Pressure { tip: 16 },
    ))));
    trial.start();
    trial.after_ms(50);
    trial.after_ms(50);
    // Its y is 0x2E0D, so that it seems to end in a return.
    assert_eq!(trial.hear(&[0x80, 0x31, 0x2D, 0x41, 0x2E, 0x0D]), []);
    assert_eq!(trial.codec.identity(), None);
    for ms in [500, 500, 50, 50, 50, 50, 50] {
        trial.after_ms(ms);
    }
    assert_eq!(trial.after_ms(500), [command("VA1")]);
}

#[test]
fn the_frame_of_a_real_tablet_is_what_its_reader_says() {
    // hansake/CalComp_DrawingBoard_interface_test: X 6317, Y 5903 (from below), buttons 0 1 2 3.
    let from_below = Meaning { y_up: true, ..puck() };
    let mut trial = listening(from_below);
    let got = trial.samples(&[0xBC, 0x31, 0x2D, 0x00, 0x2E, 0x0F])[0];
    assert_eq!(
        (got.x_counts, got.y_counts, got.buttons),
        (6317, 12_000 - 5903, 0b1111)
    );
}

#[test]
fn every_field_of_a_packet_is_found() {
    let mut trial = listening(puck());
    let rows: [(&[u8], [u32; 3]); 7] = [
        (&[0x80, 0, 0, 0, 0, 0], [0, 0, 0]),
        (&[0x83, 0x7F, 0x7F, 0x0F, 0x7F, 0x7F], [65_535, 262_143, 0]),
        (&[0x84, 0, 1, 0, 0, 2], [1, 2, 0b0001]),
        (&[0x88, 0, 1, 0, 0, 2], [1, 2, 0b0010]),
        (&[0x90, 0, 1, 0, 0, 2], [1, 2, 0b0100]),
        (&[0xA0, 0, 1, 0, 0, 2], [1, 2, 0b1000]),
        (&[0xBC, 0, 1, 0, 0, 2], [1, 2, 0b1111]),
    ];
    for (packet, [x, y, buttons]) in rows {
        let want = PenSample {
            buttons,
            ..PenSample::hovering(Tool::Puck, x, y)
        };
        assert_eq!(trial.samples(packet), [want], "{packet:02X?}");
    }
}

#[test]
fn a_puck_of_sixteen_sends_numbers() {
    let mut trial = listening(puck());
    for number in 0_u8..16 {
        let got = trial.samples(&[0x80 | (0x10 | number) << 2, 0, 1, 0, 0, 2])[0];
        assert_eq!(got.buttons, 1 << number, "{number}");
    }
}

#[test]
fn leaving_is_the_bit_that_the_profile_names() {
    for (proximity_bit, fourth, leaves) in [
        (0x40, 0x40, true),
        (0x40, 0x20, false),
        (0x20, 0x20, true),
        (0x20, 0x40, false),
        (0x00, 0x60, false),
    ] {
        let mut trial = listening(Meaning {
            proximity_bit,
            ..puck()
        });
        let held = trial.samples(&[0x84, 0, 1, 0, 0, 2])[0];
        let got = trial.samples(&[0x84, 0, 9, fourth, 0, 9])[0];
        assert_eq!(got.in_range, !leaves, "{proximity_bit:02X} {fourth:02X}");
        if leaves {
            assert_eq!(got, held.leaving(), "from where it was");
            assert_eq!(trial.samples(&[0x84, 0, 9, fourth, 0, 9]), []);
        }
    }
}

#[test]
fn a_pen_has_a_tip_by_its_bit_or_by_its_pressure() {
    let mut trial = listening(meaning(Tool::Pen, Code::Buttons));
    let got = trial.samples(&[0x8C, 0, 1, 0, 0, 2])[0];
    assert_eq!((got.tip, got.buttons), (true, 1));
    let mut trial = listening(meaning(Tool::Pen, Code::Pressure { tip: 16 }));
    for (pressure, tip) in [
        (0, false),
        (15, false),
        (16, true),
        (8, true),
        (7, false),
        (15, false),
        (31, true),
    ] {
        let got = trial.samples(&[0x80 | pressure << 2, 0, 1, 0, 0, 2])[0];
        assert_eq!(
            (got.pressure_counts, got.tip),
            (pressure.into(), tip),
            "{pressure}"
        );
    }
}

#[test]
fn damage_is_counted_and_skipped() {
    let mut trial = listening(puck());
    let stream = [7, 0x80, 0, 1, 0x80, 0, 1, 0, 0, 2];
    assert_eq!(trial.samples(&stream).len(), 1);
    assert_eq!(trial.codec.counters(), counted(1, 1, 1));
    trial.hear(&[0x80, 0, 1]);
    trial.after_ms(101);
    trial.hear(&[0, 0, 2]);
    assert_eq!(trial.codec.counters(), counted(1, 4, 2));
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(stream in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..200) {
        assert_cut_invariant(|| CalComp::listening(settings(puck())), &stream, cut);
    }

    #[test]
    fn everything_is_let_go(stream in prop::collection::vec(any::<u8>(), 0..300)) {
        assert_lets_go(CalComp::listening(settings(meaning(Tool::Pen, Code::Pressure { tip: 3 }))), &stream);
    }

    #[test]
    fn answers_of_any_bytes_are_survived(stream in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut trial = Trial::new(CalComp::new(settings(puck())));
        trial.start();
        for ms in [50, 50, 500, 500, 50, 50, 50, 50, 50, 500, 50, 50] {
            trial.hear(&stream);
            trial.after_ms(ms);
        }
    }
}
