//! Korg's box: what its scene says, its lamps, its questions.

use super::*;

#[test]
fn korg_s_controls_say_what_its_scene_says() {
    let mut desk = nano();
    assert_eq!(desk.slide(0, 1.0), [0xB0, 0, 127]);
    assert_eq!(desk.slide(7, 0.5), [0xB0, 7, 64]);
    assert_eq!(desk.slide(8, 1.0), [0xB0, 16, 127]);
    assert_eq!(desk.slide(15, 1.0), [0xB0, 23, 127]);
    let numbers = [
        (0, 32),
        (7, 39),
        (8, 48),
        (15, 55),
        (16, 64),
        (23, 71),
        (24, 58),
        (25, 59),
        (26, 46),
        (27, 60),
        (28, 61),
        (29, 62),
        (30, 43),
        (31, 44),
        (32, 42),
        (33, 41),
        (34, 45),
    ];
    for (control, number) in numbers {
        assert_eq!(desk.press(control, true), [0xB0, number, 127]);
        assert_eq!(desk.press(control, false), [0xB0, number, 0]);
    }
    assert!(!desk.midi.press(0, 35, true));
    assert!(!desk.midi.slide(0, 16, 0.0, 0));
    assert!(!desk.midi.turn(0, 0, 1, 0), "it has no endless dials");
}

#[test]
fn korg_s_lamps_are_the_host_s_or_the_buttons_own() {
    let lamp = |control, glow| MidiShown::Lamp { control, glow };
    let mut desk = nano();
    desk.tell(&[0xB0, 32, 127, 71, 127, 41, 127, 41, 0]);
    assert_eq!(
        desk.shown(),
        [
            lamp(0, Glow::On),
            lamp(23, Glow::On),
            lamp(33, Glow::On),
            lamp(33, Glow::Off)
        ]
    );
    desk.tell(&[0xB0, 58, 127, 0, 127, 0xB1, 32, 127]);
    assert_eq!(desk.shown(), [], "no lamp, no lamp, another channel");
    desk.press(0, true);
    assert_eq!(desk.shown(), [], "the host's business");
    let mut own = Desk::new(NanoKontrol2::new(MidiOptions::default()));
    own.tell(&[0xB0, 32, 127]);
    assert_eq!(own.shown(), []);
    own.press(0, true);
    own.press(0, false);
    assert_eq!(own.shown(), [lamp(0, Glow::On), lamp(0, Glow::Off)]);
}

#[test]
fn korg_s_questions_are_answered() {
    let mut desk = nano();
    let identity = [0xF0, 0x7E, 0, 6, 2, 0x42, 0x13, 1, 0, 0, 3, 0, 1, 0, 0xF7];
    assert_eq!(desk.tell(&[0xF0, 0x7E, 0x7F, 6, 1, 0xF7]), identity);
    assert_eq!(desk.tell(&[0xF0, 0x7E, 0x00, 6, 1, 0xF7]), identity);
    assert_eq!(desk.tell(&[0xF0, 0x7E, 0x01, 6, 1, 0xF7]), [], "another channel");
    let found = desk.tell(&[0xF0, 0x42, 0x50, 0, 0x55, 0xF7]);
    assert_eq!(
        found,
        [0xF0, 0x42, 0x50, 1, 0, 0x55, 0x13, 1, 0, 0, 3, 0, 1, 0, 0xF7]
    );
    let own = |rest: &[u8]| [&[0xF0, 0x42, 0x40, 0, 1, 0x13, 0], rest, &[0xF7]].concat();
    assert_eq!(desk.tell(&own(&[0x1F, 0x12, 0])), own(&[0x5F, 0x42, 0]));
    assert_eq!(desk.tell(&own(&[0, 0, 1])), own(&[0x40, 0, 3]));
    assert_eq!(desk.tell(&own(&[0x1F, 0x12, 0])), own(&[0x5F, 0x42, 1]));
    // Native mode speaks on channel 16, and its lamps go by halves.
    assert_eq!(desk.press(0, true), [0xBF, 32, 127]);
    assert_eq!(desk.slide(8, 1.0), [0xBF, 16, 127]);
    desk.shown();
    desk.tell(&[0xBF, 0x2E, 0x41, 0x2E, 0x40]);
    let lamp = |glow| MidiShown::Lamp { control: 26, glow };
    assert_eq!(desk.shown(), [lamp(Glow::On), lamp(Glow::Off)]);
    assert_eq!(desk.tell(&own(&[0, 0, 0])), own(&[0x40, 0, 2]));
    assert_eq!(
        desk.tell(&[0xF0, 0x42, 0x41, 0, 1, 0x13, 0, 0x1F, 0x12, 0, 0xF7]),
        []
    );
}

#[test]
fn korg_s_scene_is_read_changed_and_kept() {
    let mut desk = Desk::new(NanoKontrol2::new(MidiOptions::default()));
    let own = |rest: &[u8]| [&[0xF0, 0x42, 0x40, 0, 1, 0x13, 0], rest, &[0xF7]].concat();
    let dump = desk.tell(&own(&[0x1F, 0x10, 0]));
    let head = own(&[0x7F, 0x7F, 2, 3, 5, 0x40]);
    let (head, packed) = (&head[..head.len() - 1], &dump[13..dump.len() - 1]);
    assert!(dump.starts_with(head));
    // 1 + 388 bytes are announced: 3 * 128 + 5.
    assert_eq!(packed.len(), 388);
    // Group of seven: tops, then bytes. LED mode is byte 2, strip 1's S button at 16 to 20.
    let mut changed = packed.to_vec();
    changed[3] = 1;
    let at = |byte: usize| byte + byte / 7 + 1;
    assert_eq!(
        [16, 17, 18, 19, 20].map(|byte| changed[at(byte)]),
        [1, 0, 32, 0, 127]
    );
    changed[at(16)] = 2;
    changed[at(17)] = 1;
    changed[at(18)] = 60;
    let load = [head, &changed, &[0xF7]].concat();
    assert_eq!(desk.tell(&load), own(&[0x5F, 0x23, 0]));
    assert_eq!(desk.press(0, true), [0x90, 60, 127], "a note that toggles");
    assert_eq!(desk.press(0, false), []);
    assert_eq!(desk.press(0, true), [0x80, 60, 64]);
    desk.tell(&[0x90, 60, 127]);
    let lit = MidiShown::Lamp {
        control: 0,
        glow: Glow::On,
    };
    assert_eq!(desk.shown(), [lit], "lamps are the host's now");
    assert_eq!(
        desk.tell(&own(&[0x7F, 0x7F, 2, 3, 5, 0x40, 0, 1, 2])),
        own(&[0x5F, 0x24, 0])
    );
    assert_eq!(desk.tell(&own(&[0x1F, 0x11, 0])), own(&[0x5F, 0x21, 0]));
    desk.midi.touch(desk.now_us, &Touch::PowerCycle);
    desk.listen(600_000);
    assert_eq!(desk.press(0, true), [0x90, 60, 127], "it was kept");
}
