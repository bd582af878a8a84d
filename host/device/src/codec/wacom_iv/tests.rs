use super::*;
use crate::codec::Step;
use device_profiles::{InputProfile, Profiles};
use proptest::prelude::*;

fn profile(name: &str) -> InputProfile {
    Profiles::builtin().input(name).unwrap().clone()
}

fn heard(codec: &mut WacomIv, bytes: &[u8]) -> Vec<InputEvent> {
    let mut events = Vec::new();
    codec.decode(bytes, &mut |e| events.push(e));
    events
}

fn samples(codec: &mut WacomIv, bytes: &[u8]) -> Vec<PenSample> {
    let pen = |e| match e {
        InputEvent::Pen(sample) => sample,
        other => panic!("{other:?}"),
    };
    heard(codec, bytes).into_iter().map(pen).collect()
}

/// A tablet and the time, from the first step of the reset.
struct Host {
    codec: WacomIv,
    now: Instant,
    events: Vec<InputEvent>,
}

impl Host {
    fn new(name: &str) -> Self {
        Self {
            codec: WacomIv::new(&profile(name)),
            now: Instant::ZERO,
            events: Vec::new(),
        }
    }

    fn after_ms(&mut self, ms: u64) -> Vec<Step> {
        self.now = self.now.after(Duration::from_millis(ms));
        let mut out = Outgoing::new();
        let events = &mut self.events;
        self.codec.advance(self.now, &mut out, &mut |e| events.push(e));
        out.drain().collect()
    }

    fn hear(&mut self, bytes: &[u8]) -> Vec<Step> {
        let events = &mut self.events;
        self.codec.decode(bytes, &mut |e| events.push(e));
        self.after_ms(0)
    }

    /// Through the reset, up to the first question.
    fn reset(&mut self) {
        let mut out = Outgoing::new();
        self.codec.start(self.now, &mut out);
        let mut steps: Vec<Step> = out.drain().collect();
        for ms in [250, 75, 250, 75, 250, 75] {
            assert_eq!(self.after_ms(ms - 1), []);
            steps.extend(self.after_ms(1));
        }
        let at = |baud| [Step::Baud(baud), bytes(b"\r$"), bytes(b"\r#")];
        let mut want = [at(38_400), at(19_200), at(9_600)].concat();
        want.push(bytes(b"SP\r"));
        assert_eq!(steps, want);
        assert_eq!(self.after_ms(30), [bytes(b"~#")]);
    }
}

fn bytes(bytes: &[u8]) -> Step {
    Step::Bytes(bytes.to_vec())
}

#[test]
fn a_digitizer_is_asked_for_everything_and_set_up_with_tilt() {
    let mut host = Host::new("digitizer-ii");
    host.reset();
    assert_eq!(host.hear(b"~#UD-0608-R00,V1.4-0"), []);
    assert_eq!(host.hear(b"\r"), [bytes(b"~C\r")]);
    assert_eq!(host.hear(b"~C06144,08448\r"), [bytes(b"~R\r")]);
    let set_up = b"MU1\rOC1\r~M0\r~M1\rIT0\rIN0\rSR\rZF1\rFM1\rST\r";
    assert_eq!(host.hear(b"~RE202C900,002,02,1016,2540\r"), [bytes(set_up)]);
    assert_eq!(host.events, [InputEvent::Started]);
    assert_eq!(host.codec.identity(), Some("UD-0608-R00,V1.4-0"));
    // A step of tilt is a degree.
    let want = Surface {
        tilt_steps_per_rad: Some(57.0),
        ..Surface::flat([6144, 8448], [1016.0, 2540.0], 255)
    };
    assert_eq!(host.codec.surface(), Some(want));
    assert_eq!(
        host.codec.counters(),
        Counters {
            reports: 3,
            unknown: 0,
            rejected: 0
        }
    );
}

#[test]
fn a_graphire_is_not_asked_for_its_size() {
    let mut host = Host::new("graphire-serial");
    host.reset();
    let set_up = b"MU1\rOC1\r~M0\r~M1\rIT0\rIN0\rSR\rZF1\rST\r";
    assert_eq!(host.hear(b"~#ET-0405-R00,V1.1-0\r"), [bytes(set_up)]);
    assert_eq!(host.codec.surface().unwrap().max_counts, [5103, 3711]);
}

#[test]
fn an_answer_may_end_in_silence_and_a_size_may_be_missing() {
    let mut host = Host::new("digitizer-ii");
    host.reset();
    host.hear(b"~#UD-1212-R00,V1.1-0");
    assert_eq!(host.after_ms(999), []);
    assert_eq!(host.after_ms(1), [bytes(b"~C\r")]);
    assert_eq!(host.after_ms(1_000), [bytes(b"~R\r")]);
    // ROM 1.1: no tilt, and 120 steps of pressure.
    let set_up = b"MU1\rOC1\r~M0\r~M1\rIT0\rIN0\rSR\rZF1\rST\r";
    assert_eq!(host.after_ms(1_000), [bytes(set_up)]);
    assert_eq!(host.codec.surface().unwrap().max_counts, [15_240, 15_240]);
    assert_eq!(host.codec.surface().unwrap().pressure_max, 120);
}

#[test]
fn silence_starts_everything_again() {
    let mut host = Host::new("graphire-serial");
    host.reset();
    let again = host.after_ms(1_000);
    assert_eq!(again, [Step::Baud(38_400), bytes(b"\r$")]);
    assert!(!host.codec.started());
    assert_eq!(host.events, []);
}

#[test]
fn another_models_answer_is_counted_and_used() {
    let mut host = Host::new("graphire-serial");
    host.reset();
    host.hear(b"\xE0\x01garbage\r~#UD-0608-R00,V1.4-0\r");
    assert!(host.codec.started());
    assert_eq!(host.codec.counters().rejected, 1);
}

/// x 5103, y 3711, pressure 511 on a Graphire: pen, tip and first side button.
const GRAPHIRE_FULL: [u8; 7] = [0xEC, 0x27, 0x6F, 0x1C, 0x1C, 0x7F, 0x3F];

#[test]
fn every_field_of_a_pen_packet_is_found() {
    let mut codec = WacomIv::listening(&profile("graphire-serial"));
    let want = PenSample {
        pressure_counts: 511,
        buttons: 1,
        tip: true,
        ..PenSample::hovering(Tool::Pen, 5103, 3711)
    };
    assert_eq!(samples(&mut codec, &GRAPHIRE_FULL), [want]);
    let light = [0xE0, 0, 1, 0, 0, 2, 0x40];
    let want = PenSample {
        x_counts: 1,
        y_counts: 2,
        pressure_counts: 0,
        buttons: 0,
        tip: false,
        ..want
    };
    assert_eq!(samples(&mut codec, &light), [want]);
    // Bits 14 and 15 of both axes.
    let far = samples(&mut codec, &[0xE3, 0x7F, 0x7F, 0x03, 0x7F, 0x7F, 0x40]);
    assert_eq!((far[0].x_counts, far[0].y_counts), (0xFFFF, 0xFFFF));
}

#[test]
fn pressure_has_as_many_bits_as_the_model() {
    let mut graphire = WacomIv::listening(&profile("graphire-serial"));
    let mut digitizer = WacomIv::listening(&InputProfile {
        surface: Some(device_profiles::Surface {
            tilt_steps_per_rad: None,
            ..profile("digitizer-ii").area()
        }),
        ..profile("digitizer-ii")
    });
    // b0 bit 2, b3 bit 2, b6: nine bits on the Graphire, the upper eight of them on the Digitizer II.
    let rows = [
        ([0xE0, 0, 0, 0x00, 0, 0, 0x40], 0, 0),
        ([0xE4, 0, 0, 0x00, 0, 0, 0x40], 1, 0),
        ([0xE0, 0, 0, 0x04, 0, 0, 0x40], 2, 1),
        ([0xE0, 0, 0, 0x00, 0, 0, 0x41], 4, 2),
        ([0xE0, 0, 0, 0x00, 0, 0, 0x00], 256, 128),
        ([0xE4, 0, 0, 0x04, 0, 0, 0x3F], 511, 255),
    ];
    for (packet, nine, eight) in rows {
        assert_eq!(
            samples(&mut graphire, &packet)[0].pressure_counts,
            nine,
            "{packet:02X?}"
        );
        assert_eq!(
            samples(&mut digitizer, &packet)[0].pressure_counts,
            eight,
            "{packet:02X?}"
        );
    }
}

#[test]
fn leaving_lets_everything_go_once_where_it_was() {
    let mut codec = WacomIv::listening(&profile("graphire-serial"));
    let held = samples(&mut codec, &GRAPHIRE_FULL)[0];
    let away = [0xA0, 0, 0, 0, 0, 0, 0x40];
    assert_eq!(samples(&mut codec, &away), [held.leaving()]);
    assert_eq!(samples(&mut codec, &away), []);
    assert_eq!(codec.counters().reports, 3);
}

#[test]
fn a_graphire_eraser_has_its_own_bit() {
    let mut codec = WacomIv::listening(&profile("graphire-serial"));
    let eraser = samples(&mut codec, &[0xE8, 0, 9, 0x48, 0, 9, 0x00]);
    assert_eq!(
        (eraser[0].tool, eraser[0].tip, eraser[0].buttons),
        (Tool::Eraser, true, 0)
    );
    let turned = samples(&mut codec, &[0xE0, 0, 9, 0x00, 0, 9, 0x40]);
    assert_eq!(
        turned.iter().map(|s| (s.tool, s.in_range)).collect::<Vec<_>>(),
        [(Tool::Eraser, false), (Tool::Pen, true)]
    );
}

#[test]
fn a_shared_eraser_bit_is_read_when_the_tool_arrives() {
    let mut codec = WacomIv::listening(&profile("digitizer-ii"));
    let with_bit = [0xE8, 0, 9, 0x20, 0, 9, 0x40, 0, 0];
    let without = [0xE0, 0, 9, 0x00, 0, 9, 0x40, 0, 0];
    let away = [0xA0, 0, 0, 0x00, 0, 0, 0x40, 0, 0];
    assert_eq!(samples(&mut codec, &with_bit)[0].tool, Tool::Eraser);
    assert_eq!(samples(&mut codec, &without)[0].tool, Tool::Eraser);
    samples(&mut codec, &away);
    assert_eq!(samples(&mut codec, &without)[0].tool, Tool::Pen);
    let pressed = samples(&mut codec, &with_bit)[0];
    assert_eq!((pressed.tool, pressed.buttons), (Tool::Pen, 0b10));
}

#[test]
fn a_puck_has_buttons_and_a_wheel_and_no_pressure() {
    let mut codec = WacomIv::listening(&profile("graphire-serial"));
    let packet = |b3, b6| [0xC8, 0, 1, b3, 0, 1, b6];
    let rows = [
        (0x08, 0x10, 0b001, 1),
        (0x28, 0x30, 0b101, 3),
        (0x40, 0x50, 0b000, -1),
        (0x10, 0x70, 0b010, -3),
    ];
    for (b3, b6, buttons, wheel) in rows {
        let got = samples(&mut codec, &packet(b3, b6))[0];
        let seen = (got.tool, got.buttons, got.wheel, got.pressure_counts, got.tip);
        assert_eq!(seen, (Tool::Puck, buttons, wheel, 0, false), "{b3:02X} {b6:02X}");
    }
    let mut digitizer = WacomIv::listening(&profile("digitizer-ii"));
    let lens = samples(&mut digitizer, &[0xC8, 0, 1, 0x78, 0, 1, 0x70, 0, 0])[0];
    assert_eq!((lens.buttons, lens.wheel, lens.tilt), (0b1111, 0, None));
}

#[test]
fn tilt_is_seven_bits_with_a_sign() {
    let mut codec = WacomIv::listening(&profile("digitizer-ii"));
    let rows = [
        (0x00, 0x3F, [0, 63]),
        (0x40, 0x7F, [-64, -1]),
        (0x0A, 0x76, [10, -10]),
    ];
    for (b7, b8, tilt) in rows {
        assert_eq!(
            samples(&mut codec, &[0xE0, 0, 1, 0, 0, 1, 0x40, b7, b8])[0].tilt,
            Some(tilt)
        );
    }
}

#[test]
fn a_new_packet_ends_a_broken_one() {
    let mut codec = WacomIv::listening(&profile("graphire-serial"));
    let mut bytes = vec![0x11, 0x22, 0xE0, 0x01, 0x02];
    bytes.extend(GRAPHIRE_FULL);
    assert_eq!(samples(&mut codec, &bytes).len(), 1);
    assert_eq!(
        codec.counters(),
        Counters {
            reports: 1,
            unknown: 2,
            rejected: 1
        }
    );
    // With tilt set, a packet that ends after seven bytes is whole.
    let mut codec = WacomIv::listening(&profile("digitizer-ii"));
    assert_eq!(
        samples(&mut codec, &[0xE0, 0, 1, 0, 0, 1, 0x40, 0xE0])[0].tilt,
        None
    );
    assert_eq!(codec.counters().rejected, 0);
}

#[test]
fn half_a_packet_is_given_up() {
    let mut host = Host::new("graphire-serial");
    host.codec = WacomIv::listening(&profile("graphire-serial"));
    host.hear(&GRAPHIRE_FULL[..4]);
    host.after_ms(101);
    host.hear(&GRAPHIRE_FULL[4..]);
    assert_eq!(host.events, []);
    assert_eq!(
        host.codec.counters(),
        Counters {
            reports: 0,
            unknown: 3,
            rejected: 1
        }
    );
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        cut in 0_usize..200,
        tablet in prop::sample::select(vec!["graphire-serial", "digitizer-ii"]),
    ) {
        let profile = profile(tablet);
        let mut whole = WacomIv::listening(&profile);
        let want = heard(&mut whole, &bytes);
        let mut cut_up = WacomIv::listening(&profile);
        let (head, tail) = bytes.split_at(cut.min(bytes.len()));
        let mut got = heard(&mut cut_up, head);
        for byte in tail {
            got.extend(heard(&mut cut_up, &[*byte]));
        }
        prop_assert_eq!(got, want);
        prop_assert_eq!(cut_up.counters(), whole.counters());
    }

    #[test]
    fn nothing_is_pressed_out_of_range(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let mut codec = WacomIv::listening(&profile("graphire-serial"));
        for sample in samples(&mut codec, &bytes) {
            if !sample.in_range {
                prop_assert!(!sample.tip && sample.buttons == 0 && sample.pressure_counts == 0);
            }
        }
    }

    #[test]
    fn answers_of_any_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let mut host = Host::new("digitizer-ii");
        host.reset();
        host.hear(&bytes);
        host.after_ms(1_000);
        host.after_ms(1_000);
    }
}
