use super::*;
use crate::codec::trial::{Trial, assert_cut_invariant, assert_lets_go, bytes, counted, text};
use proptest::prelude::*;

fn settings(framing: Framing) -> Settings {
    Settings {
        framing,
        tool: Tool::Puck,
        buttons: Buttons::Number,
        lines_per_inch: 1000,
        increment: 1,
        y_up: false,
        surface: Surface::flat([11_700, 11_700], [1000.0, 1000.0], 0),
        leave_after: None,
    }
}

fn listening(framing: Framing) -> Trial<Mm> {
    Trial::new(Mm::listening(settings(framing)))
}

const WAKE: &[u8] = b"          \0";

#[test]
fn a_tablet_is_woken_quieted_asked_and_set_up() {
    let mut trial = Trial::new(Mm::new(settings(Framing::Absolute)));
    assert_eq!(trial.start(), [bytes(WAKE)]);
    assert_eq!(trial.after_ms(399), []);
    assert_eq!(trial.after_ms(1), [text("B")]);
    // What was still under way says nothing.
    assert_eq!(trial.hear(&[0x98, 1, 2, 3, 4]), []);
    assert_eq!(trial.after_ms(50), [text("z?")]);
    let id = b"MM2 12x12 Tablet by Summagraphics Firmware Version 2.10\r";
    assert_eq!(trial.hear(id), [text("ja")]);
    // 11811 by 11811: 92 * 128 + 35.
    assert_eq!(trial.hear(&[0x98, 35, 92, 35]), []);
    assert_eq!(trial.hear(&[92]), [text("0bzb@I!FP")]);
    assert_eq!(trial.told(), [InputEvent::Started]);
    assert_eq!(
        trial.codec.identity(),
        Some("MM2 12x12 Tablet by Summagraphics Firmware Version 2.10")
    );
    assert_eq!(
        trial.codec.surface().map(|s| s.max_counts),
        Some([11_811, 11_811])
    );
    assert_eq!(trial.codec.counters(), counted(2, 0, 0));
}

#[test]
fn resolution_increment_and_mode_follow_the_profile() {
    let rows = [
        (1, 'l'),
        (2, 'n'),
        (4, 'p'),
        (100, 'd'),
        (200, 'e'),
        (254, 'f'),
        (400, 'g'),
        (500, 'h'),
        (508, 'i'),
        (1000, 'j'),
        (1016, 'q'),
        (2000, 's'),
        (2032, 'u'),
        (2540, 'v'),
        (777, 'h'),
    ];
    for (lines_per_inch, code) in rows {
        let settings = Settings {
            lines_per_inch,
            increment: 200,
            ..settings(Framing::Relative)
        };
        let mut trial = Trial::new(Mm::new(settings));
        trial.start();
        trial.after_ms(400);
        trial.after_ms(50);
        // A compatible tablet does not answer z?.
        assert_eq!(trial.after_ms(1_000), [text(&format!("{code}a"))]);
        assert_eq!(trial.hear(&[0x80, 1, 0, 1, 0]), [bytes(b"0bzb@I\x7FEP")]);
    }
}

#[test]
fn silence_after_the_wake_starts_over_and_a_restart_is_told() {
    let mut trial = Trial::new(Mm::new(settings(Framing::Absolute)));
    for round in [InputEvent::Started, InputEvent::Restarted] {
        trial.start();
        trial.after_ms(400);
        trial.after_ms(50);
        trial.after_ms(1_000);
        assert_eq!(trial.after_ms(1_000), [bytes(WAKE)], "nobody there");
        trial.after_ms(400);
        trial.after_ms(50);
        trial.hear(b"x\n");
        // The first byte need not have bit 7, and the answer before may have ended twice.
        trial.hear(b"\n\x00\x64\x5B\x64\x5B");
        assert_eq!(trial.told(), [round]);
    }
}

#[test]
fn an_answer_of_nothing_leaves_the_profiles_size() {
    let mut trial = Trial::new(Mm::new(settings(Framing::Absolute)));
    trial.start();
    trial.after_ms(400);
    trial.after_ms(50);
    trial.after_ms(1_000);
    trial.hear(&[0x98, 0, 0, 5, 0]);
    assert!(trial.codec.started());
    assert_eq!(
        trial.codec.surface().map(|s| s.max_counts),
        Some([11_700, 11_700])
    );
    assert_eq!(trial.codec.counters().rejected, 1);
}

#[test]
fn every_field_of_five_bytes_is_found() {
    let mut trial = listening(Framing::Absolute);
    let rows: [(&[u8], Option<[u32; 3]>); 7] = [
        (&[0x98, 0, 0, 0, 0], Some([0, 0, 0])),
        (&[0x98, 0x7F, 0x7F, 0x7F, 0x7F], Some([16_383, 16_383, 0])),
        (&[0x99, 1, 2, 3, 4], Some([257, 515, 0b0001])),
        (&[0x9A, 0x34, 0x5B, 0x00, 0x01], Some([11_700, 128, 0b0010])),
        (&[0x9B, 1, 0, 2, 0], Some([1, 2, 0b0100])),
        (&[0xBC, 1, 0, 2, 0], Some([1, 2, 0b1000])),
        (&[0xD8, 1, 0, 2, 0], None),
    ];
    for (packet, want) in rows {
        let got = trial.samples(packet);
        match want {
            Some([x, y, buttons]) => {
                let want = PenSample {
                    buttons,
                    ..PenSample::hovering(Tool::Puck, x, y)
                };
                assert_eq!(got, [want], "{packet:02X?}");
            }
            None => assert_eq!(got[0], PenSample::hovering(Tool::Puck, 1, 2).leaving()),
        }
    }
    assert_eq!(trial.samples(&[0xD8, 1, 0, 2, 0]), [], "it leaves once");
}

#[test]
fn button_codes_are_numbers_or_bits() {
    let numbers = [0, 0b1, 0b10, 0b100, 0b1000, 0b1001, 0b1010, 0b1100];
    for (code, number) in (0_u8..8).zip(numbers) {
        for (buttons, tool, want, tip) in [
            (Buttons::Number, Tool::Puck, number, false),
            (Buttons::Mask, Tool::Puck, u32::from(code), false),
            (Buttons::Number, Tool::Pen, u32::from(code >> 1), code & 1 == 1),
        ] {
            let settings = Settings {
                tool,
                buttons,
                ..settings(Framing::Absolute)
            };
            let mut trial = Trial::new(Mm::listening(settings));
            let got = trial.samples(&[0x98 | code, 1, 0, 1, 0])[0];
            assert_eq!((got.buttons, got.tip), (want, tip), "{code} {buttons:?} {tool:?}");
        }
    }
}

#[test]
fn y_may_count_from_below() {
    let settings = Settings {
        y_up: true,
        ..settings(Framing::Absolute)
    };
    let mut trial = Trial::new(Mm::listening(settings));
    assert_eq!(trial.samples(&[0x98, 0, 0, 0, 0])[0].y_counts, 11_700);
    assert_eq!(trial.samples(&[0x98, 0, 0, 0x34, 0x5B])[0].y_counts, 0);
    assert_eq!(trial.samples(&[0x98, 0, 0, 0x7F, 0x7F])[0].y_counts, 0);
}

#[test]
fn three_bytes_are_moves_and_buttons() {
    let mut trial = listening(Framing::Relative);
    let moved = |dx, dy| InputEvent::Moved { dx, dy, wheel: 0 };
    let button = |control, down| InputEvent::Button { control, down };
    let rows: [(&[u8], &[InputEvent]); 7] = [
        (&[0x98, 5, 7], &[moved(5, 7)]),
        (&[0x80, 5, 7], &[moved(-5, -7)]),
        (&[0x89, 127, 0], &[moved(-127, 0), button(0, true)]),
        (&[0x9A, 0, 0], &[button(0, false), button(1, true)]),
        (&[0x9A, 0, 0], &[]),
        (&[0xDA, 3, 3], &[button(1, false)]),
        (&[0x9C, 0, 1], &[moved(0, 1), button(3, true)]),
    ];
    for (packet, want) in rows {
        assert_eq!(trial.said(packet), want, "{packet:02X?}");
    }
    assert_eq!(trial.codec.surface(), None);
}

#[test]
fn seven_bytes_have_a_third_axis_and_name_the_tool() {
    let mut trial = listening(Framing::Flair);
    let rows: [(&[u8], Tool, u32, u32, bool); 5] = [
        (&[0x99, 1, 0, 2, 0, 0x7F, 0x15], Tool::Pen, 511, 0, true),
        (&[0x98, 1, 0, 2, 0, 0x01, 0x04], Tool::Pen, 4, 0, false),
        (&[0x98, 1, 0, 2, 0, 0x00, 0x05], Tool::Pen, 2, 0, false),
        (&[0x98, 1, 0, 2, 0, 0x00, 0x14], Tool::Pen, 1, 0, false),
        (&[0x99, 1, 0, 2, 0, 0x7F, 0x11], Tool::Puck, 0, 1, false),
    ];
    for (packet, tool, pressure, buttons, tip) in rows {
        let got = trial.samples(packet);
        let got = got.last().expect("each is a sample");
        let seen = (got.tool, got.pressure_counts, got.buttons, got.tip);
        assert_eq!(seen, (tool, pressure, buttons, tip), "{packet:02X?}");
    }
}

#[test]
fn lines_of_text_are_read_in_all_their_forms() {
    let mut trial = Trial::new(Mm::new(settings(Framing::Ascii)));
    assert_eq!(trial.start(), [], "such a tablet is not asked");
    trial.after_ms(0);
    assert!(!trial.codec.started());
    let puck = |x, y, buttons| {
        InputEvent::Pen(PenSample {
            buttons,
            ..PenSample::hovering(Tool::Puck, x, y)
        })
    };
    // MM1103: line feed; Bit Pad Two: return, or both.
    let first = trial.said(b"0012,3456,0\n");
    assert_eq!(first, [InputEvent::Started, puck(12, 3456, 0)]);
    assert_eq!(trial.said(b"1099,1099, 4\r"), [puck(1099, 1099, 0b1000)]);
    assert_eq!(trial.said(b"0000,0001,1\r\n"), [puck(0, 1, 1)]);
    let left = PenSample::hovering(Tool::Puck, 0, 1).leaving();
    assert_eq!(trial.said(b"0000,0001,9\r\n"), [InputEvent::Pen(left)]);
    let bad: [&[u8]; 8] = [
        b"12,34\n",
        b"12,34,5,6\n",
        b"x,1,1\n",
        b"-1,1,1\n",
        b"1,1,10\n",
        b",,\n",
        b"\xFF\xFE\n",
        b"12345678901,1,1\n",
    ];
    for line in bad {
        assert_eq!(trial.said(line), [], "{line:?}");
    }
    let long = [b"1".repeat(200), b"\n".to_vec()].concat();
    assert_eq!(trial.said(&long), []);
    assert_eq!(trial.codec.counters(), counted(4, 0, 9));
}

#[test]
fn silence_may_be_leaving() {
    let settings = Settings {
        leave_after: Some(Duration::from_millis(200)),
        ..settings(Framing::Ascii)
    };
    let mut trial = Trial::new(Mm::listening(settings));
    trial.hear(b"1,2,0\n");
    trial.told();
    trial.after_ms(199);
    assert_eq!(trial.told(), []);
    trial.after_ms(1);
    assert_eq!(
        trial.told(),
        [InputEvent::Pen(PenSample::hovering(Tool::Puck, 1, 2).leaving())]
    );
}

#[test]
fn damage_is_counted_and_skipped() {
    let mut trial = listening(Framing::Absolute);
    assert_eq!(trial.samples(&[1, 2, 0x98, 1, 0, 0x98, 5, 0, 6, 0]).len(), 1);
    assert_eq!(trial.codec.counters(), counted(1, 2, 1));
    trial.hear(&[0x98, 1, 0]);
    trial.after_ms(101);
    trial.hear(&[2, 0]);
    assert_eq!(trial.codec.counters(), counted(1, 4, 2));
}

const FRAMINGS: [Framing; 4] = [
    Framing::Absolute,
    Framing::Relative,
    Framing::Flair,
    Framing::Ascii,
];

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(
        framing in prop::sample::select(FRAMINGS.to_vec()),
        stream in prop::collection::vec(any::<u8>(), 0..200),
        cut in 0_usize..200,
    ) {
        assert_cut_invariant(|| Mm::listening(settings(framing)), &stream, cut);
    }

    #[test]
    fn cutting_lines_changes_nothing(text in "([0-9]{0,5},){0,3}[0-9]{0,2}(\r|\n|\r\n|[0-9,]{0,90})*", cut in 0_usize..100) {
        assert_cut_invariant(|| Mm::listening(settings(Framing::Ascii)), text.as_bytes(), cut);
    }

    #[test]
    fn everything_is_let_go(
        framing in prop::sample::select(FRAMINGS.to_vec()),
        stream in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        assert_lets_go(Mm::listening(settings(framing)), &stream);
    }

    #[test]
    fn answers_of_any_bytes_are_survived(stream in prop::collection::vec(any::<u8>(), 0..300)) {
        let mut trial = Trial::new(Mm::new(settings(Framing::Flair)));
        trial.start();
        for ms in [400, 50, 1_000, 1_000] {
            trial.hear(&stream);
            trial.after_ms(ms);
        }
    }
}
