use super::*;
use crate::codec::trial::{Trial, assert_cut_invariant, assert_lets_go, counted, text};
use crate::codec::{PenSample, Step, Tool};
use proptest::prelude::*;

fn settings(baud: u32) -> Settings {
    Settings {
        prefix: "GD".to_owned(),
        baud,
        surface: Surface::flat([30_480, 24_060], [2540.0, 2540.0], 0),
        tip_pressure: 61,
    }
}

fn listening() -> Trial<WacomV> {
    Trial::new(WacomV::listening(settings(9_600)))
}

/// Written from the table of the page, not from the code: x, y and ten bits over bytes 1 to 6.
fn packet(head: u8, x: u16, y: u16, ten: u16, b7: u8, b8: u8) -> [u8; 9] {
    [
        head,
        (x >> 9) as u8 & 0x7F,
        (x >> 2) as u8 & 0x7F,
        ((x & 3) << 5) as u8 | (y >> 11) as u8,
        (y >> 4) as u8 & 0x7F,
        ((y & 15) << 3) as u8 | (ten >> 7) as u8,
        ten as u8 & 0x7F,
        b7,
        b8,
    ]
}

fn enter(channel: u8, kind: u16, serial: u32) -> [u8; 9] {
    [
        0xC0 | channel,
        (kind >> 5) as u8,
        ((kind & 0x1F) << 2) as u8 | (serial >> 30) as u8,
        (serial >> 23) as u8 & 0x7F,
        (serial >> 16) as u8 & 0x7F,
        (serial >> 9) as u8 & 0x7F,
        (serial >> 2) as u8 & 0x7F,
        ((serial & 3) << 5) as u8,
        0,
    ]
}

/// Through the resets, up to the first question.
fn reset(trial: &mut Trial<WacomV>) {
    let mut steps = trial.start();
    for ms in [250, 75, 250, 75, 250, 75] {
        assert_eq!(trial.after_ms(ms - 1), []);
        steps.extend(trial.after_ms(1));
    }
    let at = |baud| [Step::Baud(baud), text("\r$"), text("\r#")];
    let mut want = [at(38_400), at(19_200), at(9_600)].concat();
    want.push(text("SP\r"));
    assert_eq!(steps, want);
    assert_eq!(trial.after_ms(30), [text("~#")]);
}

#[test]
fn an_intuos_is_asked_for_everything_and_reports_faster_where_its_rom_can() {
    let fast = [
        ("~#GD-0912-R00,V2.0-0\r", 38_400, "BA38\r", 38_400),
        ("~#GD-0912-R00,V1.1-2\r", 38_400, "BA19\r", 19_200),
        ("~#GD-0912-R00,V1.1-2\r", 19_200, "BA19\r", 19_200),
        ("~#XD-0608-U00,V2.4-1\r", 38_400, "BA38\r", 38_400),
    ];
    for (answer, baud, command, spoken) in fast {
        let mut trial = Trial::new(WacomV::new(settings(baud)));
        reset(&mut trial);
        assert_eq!(trial.hear(answer.as_bytes()), [text("~C\r")]);
        assert_eq!(trial.hear(b"~C30480,24060\r"), [text("~R\r")]);
        let set_up = trial.hear(b"~RE202C900,002,02,2540,2540\r");
        assert_eq!(set_up, [text("MT1\rID1\rIT0\r")]);
        assert_eq!(trial.after_ms(20), [text(command)], "{answer}");
        assert!(!trial.codec.started());
        assert_eq!(trial.after_ms(89), []);
        assert_eq!(trial.after_ms(1), [Step::Baud(spoken), text("ST\r")]);
        assert_eq!(trial.events, [InputEvent::Started]);
        assert_eq!(trial.codec.identity(), Some(answer[2..].trim()));
        let surface = trial.codec.surface().expect("a tablet has one");
        assert_eq!(surface.max_counts, [30_480, 24_060]);
        assert_eq!(surface.pressure_max, 1023);
    }
}

#[test]
fn a_slow_line_stays_slow_and_missing_sizes_are_the_profiles() {
    let mut trial = Trial::new(WacomV::new(settings(9_600)));
    reset(&mut trial);
    trial.hear(b"~#GD-0608-R00,V2.0-0");
    assert_eq!(
        trial.after_ms(1_000),
        [text("~C\r")],
        "silence ends an answer too"
    );
    assert_eq!(trial.after_ms(1_000), [text("~R\r")]);
    assert_eq!(trial.after_ms(1_000), [text("MT1\rID1\rIT0\rST\r")]);
    assert!(trial.codec.started());
    assert_eq!(
        trial.codec.surface().map(|s| s.max_counts),
        Some([30_480, 24_060])
    );
    assert_eq!(trial.codec.counters(), counted(1, 0, 0));
}

#[test]
fn nobody_there_starts_over_and_another_model_is_counted() {
    let mut trial = Trial::new(WacomV::new(settings(9_600)));
    reset(&mut trial);
    assert_eq!(trial.after_ms(1_000), [Step::Baud(38_400), text("\r$")]);
    assert!(!trial.codec.started());
    let mut trial = Trial::new(WacomV::new(settings(9_600)));
    reset(&mut trial);
    trial.hear(b"\xE0\x01rest\r~#UD-0608-R00,V1.4-0\r");
    assert_eq!(
        trial.codec.counters(),
        counted(1, 0, 2),
        "the rest, and the model"
    );
}

#[test]
fn every_field_of_a_pen_is_found() {
    let mut trial = listening();
    assert_eq!(
        trial.samples(&enter(0, 0x822, 0x2480_DE21)),
        [],
        "entering has no place"
    );
    let rows = [
        (packet(0xE0, 0, 0, 0, 0, 0), [0, 0], 0, false, 0, [0, 0]),
        (
            packet(0xE0, 65_535, 65_535, 1023, 0x3F, 0x40),
            [65_535, 65_535],
            1023,
            true,
            0,
            [63, -64],
        ),
        (
            packet(0xE2, 30_479, 24_059, 60, 0x7F, 0x01),
            [30_479, 24_059],
            60,
            true,
            1,
            [-1, 1],
        ),
        (packet(0xE4, 1, 2, 31, 10, 118), [1, 2], 31, true, 2, [10, -10]),
        (packet(0xE6, 1, 2, 30, 0, 0), [1, 2], 30, false, 3, [0, 0]),
        (packet(0xE0, 1, 2, 60, 0, 0), [1, 2], 60, false, 0, [0, 0]),
        (packet(0xE0, 1, 2, 61, 0, 0), [1, 2], 61, true, 0, [0, 0]),
    ];
    for (bytes, [x, y], pressure, tip, buttons, tilt) in rows {
        let want = PenSample {
            pressure_counts: pressure,
            tip,
            buttons,
            tilt: Some(tilt),
            tool_serial: Some(0x2480_DE21),
            tool_type: Some(0x822),
            ..PenSample::hovering(Tool::Pen, x, y)
        };
        assert_eq!(trial.samples(&bytes), [want], "{bytes:02X?}");
    }
}

#[test]
fn the_bytes_of_the_page_decode_as_it_says() {
    // Worked out by hand on the page.
    let rows: [(&[u8], _); 3] = [
        (&[0xC0, 0x41, 0x0A, 0x00, 0x49, 0x01, 0x5E, 0x10, 0x20], None),
        (
            &[0xE0, 0x00, 0x00, 0x20, 0x00, 0x10, 0x00, 0x00, 0x00],
            Some([1, 2, 0]),
        ),
        (
            &[0xE2, 0x3B, 0x44, 0x0B, 0x60, 0x1C, 0x7F, 0x05, 0x7B],
            Some([30_480, 24_067, 639]),
        ),
    ];
    let mut trial = listening();
    for (bytes, want) in rows {
        let got = trial.samples(bytes);
        let serials = got.iter().map(|s| (s.tool_type, s.tool_serial));
        assert!(serials.eq(got.iter().map(|_| (Some(0x822), Some(0x8049_0378)))));
        let got = got.first().map(|s| [s.x_counts, s.y_counts, s.pressure_counts]);
        assert_eq!(got, want, "{bytes:02X?}");
    }
}

#[test]
fn tools_are_told_apart_by_their_codes() {
    let rows = [
        (0x822, Tool::Pen),
        (0x012, Tool::Pen),
        (0x832, Tool::Pen),
        (0x912, Tool::Pen),
        (0xD12, Tool::Pen),
        (0x82A, Tool::Eraser),
        (0x85A, Tool::Eraser),
        (0x91A, Tool::Eraser),
        (0xD1A, Tool::Eraser),
        (0x0FA, Tool::Eraser),
        (0x555, Tool::Pen),
    ];
    for (kind, tool) in rows {
        let mut trial = listening();
        trial.hear(&enter(1, kind, 7));
        let sample = trial.samples(&packet(0xE1, 5, 6, 0, 0, 0))[0];
        assert_eq!(
            (sample.tool, sample.tool_type),
            (tool, Some(u32::from(kind))),
            "{kind:03X}"
        );
    }
}

#[test]
fn two_tools_are_there_at_once_and_leave_one_by_one() {
    let mut trial = listening();
    trial.hear(&[enter(0, 0x822, 11), enter(1, 0x096, 22)].concat());
    let both = [
        packet(0xE0, 100, 200, 500, 0, 0),
        packet(0xF1, 300, 400, 0, 0, 0x05),
    ]
    .concat();
    let got = trial.samples(&both);
    let seen: Vec<_> = got.iter().map(|s| (s.tool, s.tool_serial, s.x_counts)).collect();
    assert_eq!(seen, [(Tool::Pen, Some(11), 100), (Tool::Puck, Some(22), 300)]);
    assert_eq!(got[1].buttons, 0b101);
    assert_eq!(trial.samples(&[0x80, 0, 0, 0, 0, 0, 0, 0, 0]), [got[0].leaving()]);
    assert_eq!(trial.samples(&[0x80, 0, 0, 0, 0, 0, 0, 0, 0]), [], "once");
    trial.events.clear();
    let events = &mut trial.events;
    trial.codec.let_go(&mut |e| events.push(e));
    assert_eq!(trial.told(), [InputEvent::Pen(got[1].leaving())]);
}

#[test]
fn a_lost_leaving_is_made_up_when_the_next_tool_comes() {
    let mut trial = listening();
    trial.hear(&enter(0, 0x822, 11));
    let pen = trial.samples(&packet(0xE0, 100, 200, 0, 0, 0))[0];
    assert_eq!(trial.samples(&enter(0, 0x82A, 11)), [pen.leaving()]);
    assert_eq!(trial.samples(&packet(0xE0, 1, 2, 0, 0, 0))[0].tool, Tool::Eraser);
    // A packet without the bit for proximity is a leaving, wherever it says the tool is.
    let out = trial.samples(&packet(0xA0, 9, 9, 0, 0, 0));
    assert_eq!((out.len(), out[0].in_range, out[0].x_counts), (1, false, 1));
}

#[test]
fn an_airbrush_has_a_wheel_beside_its_pressure() {
    let mut trial = listening();
    trial.hear(&enter(0, 0x912, 5));
    let pen = trial.samples(&packet(0xE2, 10, 20, 700, 1, 2))[0];
    let second = trial.said(&packet(0xF4, 11, 21, 512, 3, 4));
    let moved = PenSample {
        x_counts: 11,
        y_counts: 21,
        tilt: Some([3, 4]),
        ..pen
    };
    let wheel = |value| InputEvent::Axis {
        control: AIRBRUSH_WHEEL,
        value,
    };
    assert_eq!(second, [InputEvent::Pen(moved), wheel(512)]);
    assert_eq!(
        trial.said(&packet(0xF4, 11, 21, 512, 3, 4)),
        [InputEvent::Pen(moved)]
    );
    assert_eq!(trial.said(&packet(0xF4, 11, 21, 0, 3, 4))[1], wheel(0));
}

#[test]
fn a_4d_mouse_turns_throttles_and_comes_to_rest() {
    let mut trial = listening();
    trial.hear(&enter(0, 0x094, 6));
    let throttle = |value| InputEvent::Axis {
        control: THROTTLE,
        value,
    };
    let first = trial.said(&packet(0xE8, 10, 20, 300, 0, 0x51));
    let want = PenSample {
        buttons: 0b10_1001,
        tool_serial: Some(6),
        tool_type: Some(0x094),
        ..PenSample::hovering(Tool::Mouse, 10, 20)
    };
    assert_eq!(first, [InputEvent::Pen(want), throttle(300)]);
    assert_eq!(trial.said(&packet(0xE8, 10, 20, 300, 0, 0x59))[1], throttle(-300));
    for (turn, twist) in [(0, 0), (1, -1), (899, -899), (900, 900), (1799, 1)] {
        let bytes = packet(0xEA, 12, 22, turn >> 7, (turn & 0x7F) as u8, 0);
        // The turn stands where pressure's low bits are, four bits and seven.
        let sample = trial.samples(&bytes)[0];
        assert_eq!((sample.twist, sample.buttons), (Some(twist), 0b10_1001), "{turn}");
    }
    let gone = trial.said(&[0x80, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(gone[0], throttle(0));
    assert!(matches!(
        gone[1],
        InputEvent::Pen(PenSample { in_range: false, .. })
    ));
}

#[test]
fn a_2d_mouse_has_three_buttons_and_a_wheel() {
    for (last, buttons, wheel) in [
        (0x04, 1, 0),
        (0x10, 4, 0),
        (0x1C, 7, 0),
        (0x01, 0, -1),
        (0x02, 0, 1),
    ] {
        let mut trial = listening();
        trial.hear(&enter(0, 0x007, 6));
        let sample = trial.samples(&packet(0xF0, 1, 2, 0, 0, last))[0];
        assert_eq!(
            (sample.tool, sample.buttons, sample.wheel),
            (Tool::Mouse, buttons, wheel)
        );
    }
}

#[test]
fn a_tool_whose_coming_was_not_heard_has_no_number() {
    let mut trial = listening();
    let pen = trial.samples(&packet(0xE2, 1, 2, 100, 0, 0))[0];
    assert_eq!((pen.tool, pen.tool_serial, pen.buttons), (Tool::Pen, None, 1));
    let mut trial = listening();
    let puck = trial.samples(&packet(0xF0, 1, 2, 0, 0, 0x1F))[0];
    assert_eq!((puck.tool, puck.tool_serial, puck.buttons), (Tool::Puck, None, 0));
}

#[test]
fn damage_is_counted_and_skipped() {
    let mut trial = listening();
    let good = packet(0xE0, 1, 2, 3, 0, 0);
    let mut stream = vec![0x11, 0x22];
    stream.extend(&good[..4]);
    stream.extend(good);
    stream.extend([0x88, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(trial.samples(&stream).len(), 1);
    assert_eq!(
        trial.codec.counters(),
        counted(1, 2, 2),
        "cut short, and of no kind"
    );
    trial.hear(&good[..5]);
    trial.after_ms(101);
    assert_eq!(trial.samples(&good[5..]), []);
    assert_eq!(trial.codec.counters(), counted(1, 6, 3));
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(stream in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..200) {
        assert_cut_invariant(|| WacomV::listening(settings(9_600)), &stream, cut);
    }

    #[test]
    fn everything_is_let_go(heads in prop::collection::vec((0x80_u8..=0xFF, any::<[u8; 8]>()), 0..40)) {
        let stream: Vec<u8> = heads
            .iter()
            .flat_map(|(head, rest)| std::iter::once(*head).chain(rest.map(|byte| byte & 0x7F)))
            .collect();
        assert_lets_go(WacomV::listening(settings(9_600)), &stream);
    }

    #[test]
    fn what_is_written_is_read(x: u16, y: u16, ten in 0_u16..1024, serial: u32, channel in 0_u8..2) {
        let mut trial = listening();
        trial.hear(&enter(channel, 0x822, serial));
        let got = trial.samples(&packet(0xE0 | channel, x, y, ten, 0, 0))[0];
        prop_assert_eq!([got.x_counts, got.y_counts, got.pressure_counts], [x.into(), y.into(), ten.into()]);
        prop_assert_eq!(got.tool_serial, Some(serial.into()));
    }

    #[test]
    fn answers_of_any_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let mut trial = Trial::new(WacomV::new(settings(38_400)));
        reset(&mut trial);
        trial.hear(&bytes);
        trial.after_ms(1_000);
        trial.after_ms(1_000);
    }
}
