mod korg;

use super::*;
use crate::firmware::Firmware;
use crate::hands::Turn;
use crate::script::Script;

/// A host with a box on its cable.
struct Desk<P> {
    midi: MidiBox<P>,
    now_us: u64,
}

impl<P: Panel> Desk<P> {
    fn new(midi: MidiBox<P>) -> Self {
        let mut desk = Self { midi, now_us: 0 };
        desk.midi.port_opened(0);
        desk
    }

    /// Bytes that arrive within `us`.
    fn listen(&mut self, us: u64) -> Vec<u8> {
        self.now_us += us;
        let mut out = Vec::new();
        self.midi.transmit(self.now_us, &mut out);
        out
    }

    fn tell(&mut self, bytes: &[u8]) -> Vec<u8> {
        self.midi.receive(self.now_us, bytes);
        self.listen(20_000)
    }

    fn shown(&mut self) -> Vec<MidiShown> {
        self.midi.drain_shown().map(|(_, shown)| shown).collect()
    }

    fn turn(&mut self, control: u8, clicks: i32) -> Vec<u8> {
        assert!(self.midi.turn(self.now_us, control, clicks, 0));
        self.listen(20_000)
    }

    fn press(&mut self, control: u8, down: bool) -> Vec<u8> {
        assert!(self.midi.press(self.now_us, control, down));
        self.listen(20_000)
    }

    fn slide(&mut self, control: u8, to: f64) -> Vec<u8> {
        assert!(self.midi.slide(self.now_us, control, to, 0));
        self.listen(20_000)
    }
}

fn x_touch() -> Desk<x_touch_mini::XTouchMiniPanel> {
    Desk::new(XTouchMini::new(MidiOptions::default()))
}

/// The same in MC mode, what led there forgotten.
fn x_touch_mc() -> Desk<x_touch_mini::XTouchMiniPanel> {
    let mut desk = x_touch();
    assert_eq!(desk.tell(&[0xBA, 127, 1]), [], "it does not answer");
    assert_eq!(desk.shown(), [MidiShown::Mode(1)]);
    desk
}

fn nano() -> Desk<nano_kontrol2::NanoKontrol2Panel> {
    Desk::new(NanoKontrol2::with_host_lamps(MidiOptions::default()))
}

#[test]
fn a_host_s_messages_are_found_in_any_dress() {
    let cases: [(&[u8], Vec<Heard<'_>>); 7] = [
        (
            &[0xB0, 1, 2, 3, 4],
            vec![
                Heard::Control {
                    channel: 1,
                    number: 1,
                    value: 2,
                },
                Heard::Control {
                    channel: 1,
                    number: 3,
                    value: 4,
                },
            ],
        ),
        (
            &[0x9A, 0xF8, 5, 0xFE, 7],
            vec![Heard::Note {
                channel: 11,
                key: 5,
                velocity: 7,
            }],
        ),
        (
            &[0x8F, 5, 64],
            vec![Heard::Note {
                channel: 16,
                key: 5,
                velocity: 0,
            }],
        ),
        (
            &[0xCA, 1, 0],
            vec![
                Heard::Program {
                    channel: 11,
                    program: 1,
                },
                Heard::Program {
                    channel: 11,
                    program: 0,
                },
            ],
        ),
        // A sysex cut short is none, and ends the running status.
        (&[0xB0, 0xF0, 1, 2, 0x90, 0xF7, 3, 4], vec![]),
        (&[0xE0, 1, 2, 0xD0, 5, 0xA0, 1, 2, 9, 9], vec![]),
        (&[7, 7, 0xF7, 7], vec![]),
    ];
    for (bytes, want) in cases {
        let mut parser = Parser::default();
        let mut seen = 0;
        for &byte in bytes {
            if let Some(heard) = parser.push(byte) {
                assert_eq!(Some(&heard), want.get(seen), "{bytes:02X?}");
                seen += 1;
            }
        }
        assert_eq!(seen, want.len(), "{bytes:02X?}");
    }
    let mut parser = Parser::default();
    for byte in [0xF0, 1, 0xF8, 2] {
        assert_eq!(parser.push(byte), None);
    }
    assert_eq!(parser.push(0xF7), Some(Heard::Sysex(&[1, 2])));
}

#[test]
fn standard_dials_have_values_that_stop_at_their_ends() {
    let mut desk = x_touch();
    assert_eq!(desk.turn(0, 5), [0xBA, 1, 5]);
    assert_eq!(desk.turn(0, -9), [0xBA, 1, 0]);
    assert_eq!(desk.turn(0, -1), [], "it cannot go below");
    assert_eq!(desk.turn(7, 1000), [0xBA, 8, 127]);
    assert_eq!(desk.slide(0, 1.0), [0xBA, 9, 127]);
    assert_eq!(desk.slide(0, 0.5), [0xBA, 9, 64]);
    assert_eq!(desk.slide(0, 0.5), []);
    assert_eq!(desk.press(0, true), [0x9A, 0, 127]);
    assert_eq!(desk.press(0, false), [0x8A, 0, 0]);
    assert_eq!(desk.press(8, true), [0x9A, 8, 127]);
    assert_eq!(desk.press(23, true), [0x9A, 23, 127]);
    assert!(!desk.midi.turn(desk.now_us, 8, 1, 0), "there is no ninth dial");
    assert!(!desk.midi.slide(desk.now_us, 1, 1.0, 0));
    assert!(!desk.midi.press(desk.now_us, 26, true));
}

#[test]
fn layers_have_their_own_values_and_numbers() {
    let mut desk = x_touch();
    desk.turn(2, 10);
    assert_eq!(desk.press(25, true), [], "a layer's button says nothing");
    assert_eq!(desk.shown()[0], MidiShown::Layer(1));
    assert_eq!(desk.turn(2, 3), [0xBA, 13, 3]);
    assert_eq!(desk.slide(0, 1.0), [0xBA, 10, 127]);
    assert_eq!(desk.press(0, true), [0x9A, 24, 127]);
    assert_eq!(
        desk.tell(&[0xCA, 0]),
        [0xBA, 9, 127],
        "layer A has not heard of the fader"
    );
    assert_eq!(desk.turn(2, 1), [0xBA, 3, 11], "and kept its dials");
    assert_eq!(desk.tell(&[0xCA, 2]), [], "there is no third");
}

#[test]
fn standard_lamps_and_rings_are_what_the_host_says() {
    let mut desk = x_touch();
    let lamp = |control, glow| MidiShown::Lamp { control, glow };
    let ring = |control, lamps, blinking| MidiShown::Ring {
        control,
        lamps,
        blinking,
    };
    let rows: [(&[u8], Vec<MidiShown>); 13] = [
        (&[0x9A, 0, 1], vec![lamp(8, Glow::On)]),
        (&[0x9A, 15, 2], vec![lamp(23, Glow::Blinking)]),
        (&[0x9A, 15, 0], vec![lamp(23, Glow::Off)]),
        (&[0x8A, 3, 64], vec![lamp(11, Glow::Off)]),
        (&[0x9A, 3, 3], vec![]),
        (&[0x9A, 16, 1], vec![]),
        (&[0x90, 3, 1], vec![]),
        (&[0xBA, 9, 1], vec![ring(0, 0b1, false)]),
        (&[0xBA, 16, 13], vec![ring(7, 1 << 12, false)]),
        (&[0xBA, 10, 14], vec![ring(1, 0b1, true)]),
        (&[0xBA, 10, 27], vec![ring(1, 0x1FFF, false)]),
        (&[0xBA, 10, 29], vec![]),
        (&[0xB0, 48, 1], vec![]),
    ];
    for (message, want) in rows {
        assert_eq!(desk.tell(message), [], "{message:02X?}");
        assert_eq!(desk.shown(), want, "{message:02X?}");
    }
}

#[test]
fn dials_draw_their_own_rings_in_five_ways() {
    let mut desk = x_touch();
    desk.turn(0, 127);
    desk.turn(1, 64);
    for (style, full, middle) in [
        (0, 1 << 12, 1 << 6),
        (1, 0x1FC0, 1 << 6),
        (2, 0x1FFF, 0x7F),
        (3, 0x1FFF, 0x3F8),
        (4, 1 << 12 | 1 << 6, 1 << 6),
    ] {
        desk.tell(&[0xBA, 1, style, 2, style]);
        let ring = |control, lamps| MidiShown::Ring {
            control,
            lamps,
            blinking: false,
        };
        assert_eq!(desk.shown(), [ring(0, full), ring(1, middle)], "style {style}");
    }
    desk.tell(&[0xBA, 1, 5]);
    assert_eq!(desk.shown(), []);
}

#[test]
fn mc_dials_tell_clicks_and_buttons_their_notes() {
    let mut desk = x_touch_mc();
    assert_eq!(desk.turn(0, 1), [0xB0, 16, 1]);
    assert_eq!(desk.turn(7, -1), [0xB0, 23, 65]);
    assert_eq!(desk.turn(3, -63), [0xB0, 19, 127]);
    assert_eq!(desk.turn(3, 100), [0xB0, 19, 63, 0xB0, 19, 37]);
    let notes = [
        (0, 32),
        (7, 39),
        (8, 89),
        (10, 40),
        (15, 45),
        (16, 87),
        (20, 86),
        (23, 95),
        (24, 84),
        (25, 85),
    ];
    for (control, note) in notes {
        assert_eq!(desk.press(control, true), [0x90, note, 127]);
        assert_eq!(desk.press(control, false), [0x90, note, 0]);
    }
    assert_eq!(desk.slide(0, 1.0), [0xE8, 0x7F, 0x7F]);
    assert_eq!(desk.slide(0, 0.0), [0xE8, 0, 0]);
}

#[test]
fn mc_rings_are_v_pots() {
    let mut desk = x_touch_mc();
    // Eleven lamps, of which the first is the ring's second.
    let rows = [
        (0x00, 0),
        (0x01, 0b10),
        (0x0B, 1 << 11),
        (0x16, 1 << 6),
        (0x18, 0b111 << 6),
        (0x14, 0b111 << 4),
        (0x23, 0b1110),
        (0x2B, 0xFFE),
        (0x31, 1 << 6),
        (0x33, 0b11111 << 4),
        (0x36, 0xFFE),
        (0x40, 1 << 6),
        (0x41, 1 << 6 | 0b10),
    ];
    for (value, lamps) in rows {
        desk.tell(&[0xB0, 50, value]);
        let want = MidiShown::Ring {
            control: 2,
            lamps,
            blinking: false,
        };
        assert_eq!(desk.shown(), [want], "{value:02X}");
    }
    desk.tell(&[0x90, 40, 127, 40, 1, 40, 0]);
    let lamp = |glow| MidiShown::Lamp { control: 10, glow };
    assert_eq!(
        desk.shown(),
        [lamp(Glow::On), lamp(Glow::Blinking), lamp(Glow::Off)]
    );
    desk.tell(&[0xCA, 1, 0xBA, 9, 1]);
    assert_eq!(desk.shown(), [], "standard mode's orders are nothing here");
    desk.tell(&[0xBA, 127, 0]);
    assert_eq!(desk.shown(), [MidiShown::Mode(0)]);
}

#[test]
fn a_slow_cable_makes_steps_larger_and_forgets_no_button() {
    let options = MidiOptions {
        cable: Cable::Din,
        ..MidiOptions::default()
    };
    let mut desk = Desk::new(XTouchMini::new(options));
    desk.tell(&[0xBA, 127, 1]);
    // A hundred clicks in 10 ms, but a message takes 960 us.
    assert!(desk.midi.turn(desk.now_us, 0, 100, 10_000));
    for n in 0..10 {
        let at = desk.now_us + n * 1000;
        assert!(desk.midi.press(at, 0, n % 2 == 0));
    }
    let heard = desk.listen(100_000);
    let messages: Vec<&[u8]> = heard.chunks(3).collect();
    let clicks: u32 = messages
        .iter()
        .filter(|m| m[0] == 0xB0)
        .map(|m| u32::from(m[2]))
        .sum();
    let turns = messages.iter().filter(|m| m[0] == 0xB0).count();
    let presses: Vec<u8> = messages.iter().filter(|m| m[0] == 0x90).map(|m| m[2]).collect();
    assert_eq!(clicks, 100);
    assert!(turns < 15, "{turns} messages");
    assert_eq!(presses, [127, 0, 127, 0, 127, 0, 127, 0, 127, 0]);
    // The first three bytes came after three times 320 us.
    let mut early = Desk::new(XTouchMini::new(options));
    early.midi.press(0, 0, true);
    assert_eq!(early.listen(959).len(), 2);
    assert_eq!(early.listen(1), [127]);
}

#[test]
fn running_status_and_active_sensing_are_midi_too() {
    let options = MidiOptions {
        running_status: true,
        active_sensing: true,
        ..MidiOptions::default()
    };
    let mut desk = Desk::new(XTouchMini::new(options));
    assert_eq!(desk.turn(0, 1), [0xBA, 1, 1]);
    assert_eq!(desk.turn(1, 1), [2, 1]);
    assert_eq!(desk.press(0, true), [0x9A, 0, 127]);
    assert_eq!(desk.turn(1, 1), [0xBA, 2, 2]);
    let quiet = desk.listen(950_000);
    assert_eq!(quiet, [0xFE, 0xFE, 0xFE]);
    assert_eq!(desk.turn(1, 1), [2, 3], "real time is no status");
}

#[test]
fn moves_over_time_come_at_their_times() {
    let mut desk = x_touch_mc();
    desk.midi.turn(desk.now_us, 4, 4, 400_000);
    for _ in 0..4 {
        assert_eq!(desk.listen(98_990), []);
        assert_eq!(desk.listen(1_020), [0xB0, 20, 1]);
    }
    desk.midi.slide(desk.now_us, 0, 1.0, 255_000);
    let heard = desk.listen(300_000);
    let values: Vec<u16> = heard
        .chunks(3)
        .map(|m| u16::from(m[2]) << 7 | u16::from(m[1]))
        .collect();
    assert_eq!(values.len(), 255, "every one of its steps");
    assert!(values.is_sorted());
    assert_eq!(values.last(), Some(&16_383));
}

#[test]
fn power_takes_modes_and_lamps_but_not_hands() {
    let mut desk = x_touch_mc();
    desk.slide(0, 1.0);
    desk.turn(0, 5);
    assert!(desk.midi.touch(desk.now_us, &Touch::PowerCycle));
    assert_eq!(desk.tell(&[0xBA, 127, 1]), [], "it is booting");
    desk.listen(600_000);
    assert_eq!(desk.turn(0, 5), [0xBA, 1, 5], "standard mode, from 0");
    assert_eq!(desk.slide(0, 1.0), [], "the fader stands where it stood");
    assert!(desk.midi.touch(desk.now_us, &Touch::Noise(7)));
    assert_eq!(desk.listen(1000).len(), 7);
    assert!(!desk.midi.touch(desk.now_us, &Touch::Away));
}

#[test]
fn scripts_play_from_the_opening_of_the_port() {
    let mut midi = XTouchMini::new(MidiOptions::default());
    let script = Script::parse(
        midi.controls(),
        "at 0.1 dial 2 +3\nat 0.2 button 8 down\nat 0.3 axis 0 1 over 0.1\nat 0.5 dial 0 +1turns\n",
    )
    .expect("it is a script");
    midi.play(&script);
    let mut out = Vec::new();
    midi.transmit(5_000_000, &mut out);
    assert_eq!(out, [], "nobody has opened it");
    midi.port_opened(5_000_000);
    midi.transmit(5_250_000, &mut out);
    assert_eq!(out, [0xBA, 3, 3, 0x9A, 8, 127]);
    assert!(!midi.script_is_done());
    out.clear();
    midi.transmit(5_600_000, &mut out);
    assert_eq!(out[out.len() - 6..], [0xBA, 9, 127, 0xBA, 1, 24]);
    assert!(midi.script_is_done());
    assert_eq!(midi.reporting_since_us(), Some(5_000_000));
}

#[test]
fn how_calls_are_cut_changes_nothing() {
    let run = |step_us: u64| {
        let mut midi = XTouchMini::new(MidiOptions {
            cable: Cable::Din,
            running_status: true,
            active_sensing: true,
        });
        midi.port_opened(0);
        midi.receive(1_000, &[0xBA, 127, 1, 0xB0, 48, 0x16]);
        midi.touch(
            20_000,
            &Touch::Dial {
                control: 1,
                by: Turn::Counts(-40),
                over_us: 100_000,
            },
        );
        midi.slide(30_000, 0, 0.7, 50_000);
        midi.press(40_000, 3, true);
        let mut out = Vec::new();
        let mut now_us = 40_000;
        while now_us < 1_000_000 {
            now_us += step_us;
            midi.transmit(now_us.min(1_000_000), &mut out);
        }
        (out, midi.drain_shown().collect::<Vec<_>>())
    };
    assert_eq!(run(1_000_000), run(333));
}

#[test]
fn novation_s_lamps_belong_to_templates() {
    let mut desk = Desk::new(LaunchControlXl::new(MidiOptions::default()));
    assert_eq!(desk.slide(0, 1.0), [0xB8, 13, 127]);
    assert_eq!(desk.slide(23, 1.0), [0xB8, 56, 127]);
    assert_eq!(desk.slide(24, 0.5), [0xB8, 77, 64]);
    assert_eq!(desk.press(0, true), [0x98, 41, 127]);
    assert_eq!(desk.press(15, false), [0x88, 92, 0]);
    assert_eq!(desk.press(20, true), [0xB8, 104, 127]);
    assert!(!desk.midi.press(0, 24, true));
    let lamps =
        |template: u8, rest: &[u8]| [&[0xF0, 0, 0x20, 0x29, 2, 0x11, 0x78, template], rest, &[0xF7]].concat();
    let colour = |index, red, green, blinking| MidiShown::Colour {
        index,
        red,
        green,
        blinking,
    };
    desk.tell(&lamps(8, &[0, 0x0F, 47, 0x3C, 24, 0x38]));
    assert_eq!(
        desk.shown(),
        [
            colour(0, 3, 0, false),
            colour(47, 0, 3, false),
            colour(24, 0, 3, true)
        ]
    );
    desk.tell(&lamps(9, &[1, 0x1D]));
    assert_eq!(desk.shown(), [], "another template's");
    desk.tell(&[0xF0, 0, 0x20, 0x29, 2, 0x11, 0x77, 9, 0xF7]);
    let shown = desk.shown();
    assert_eq!(
        (shown[0], shown[2]),
        (MidiShown::Layer(9), colour(1, 1, 1, false))
    );
    assert_eq!(desk.press(0, true), [0x99, 41, 127]);
    desk.tell(&[0xB9, 0, 0]);
    assert!(
        desk.shown()
            .iter()
            .all(|lamp| matches!(lamp, MidiShown::Colour { red: 0, green: 0, .. }))
    );
    desk.tell(&lamps(16, &[0, 1]));
    desk.tell(&lamps(9, &[48, 1]));
    assert_eq!(desk.shown(), []);
}
