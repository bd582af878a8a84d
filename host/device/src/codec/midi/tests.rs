//! Whole controllers: what they send becomes events, what is wanted becomes messages, as their profiles say.

use super::*;
use crate::codec::RingStyle;
use device_profiles::Profiles;
use proptest::prelude::*;

/// A profile as its file says it, under a name of its own.
fn profile(text: &str) -> InputProfile {
    let head =
        "name = \"test\"\nstatus = \"untested\"\nkind = \"midi\"\nformat = \"midi\"\nsource = \"test\"\n";
    toml::from_str(&format!("{head}{text}")).expect("a profile")
}

static BUILTIN: std::sync::LazyLock<Profiles> = std::sync::LazyLock::new(Profiles::builtin);

fn builtin(key: &str) -> InputProfile {
    BUILTIN.input(key).expect("built in").clone()
}

fn at_ms(ms: u64) -> Instant {
    Instant::ZERO.after(Duration::from_millis(ms))
}

struct Bench {
    codec: Midi,
    now_ms: u64,
    events: Vec<InputEvent>,
}

impl Bench {
    /// Opened and woken; what was sent meanwhile.
    fn woken(profile: &InputProfile) -> (Self, Vec<u8>) {
        let mut bench = Self {
            codec: Midi::new(profile),
            now_ms: 0,
            events: Vec::new(),
        };
        bench.codec.start(at_ms(0), &mut Outgoing::new());
        let sent = bench.pass(5_000);
        assert!(bench.codec.started());
        assert_eq!(std::mem::take(&mut bench.events), [InputEvent::Started]);
        (bench, sent)
    }

    /// Lets time pass in steps of ten milliseconds.
    fn pass(&mut self, ms: u64) -> Vec<u8> {
        let mut out = Outgoing::new();
        for _ in 0..=ms / 10 {
            let events = &mut self.events;
            self.codec
                .advance(at_ms(self.now_ms), &mut out, &mut |event| events.push(event));
            self.now_ms += 10;
        }
        out.all_bytes()
    }

    fn hear(&mut self, bytes: &[u8]) -> Vec<InputEvent> {
        let events = &mut self.events;
        self.codec.decode(bytes, &mut |event| events.push(event));
        std::mem::take(&mut self.events)
    }

    fn show(&mut self, feedback: &Feedback) -> Vec<u8> {
        let mut out = Outgoing::new();
        self.codec.encode(feedback, &mut out);
        out.all_bytes()
    }
}

fn dial(control: u16, delta_counts: i32) -> InputEvent {
    InputEvent::Dial {
        control,
        delta_counts,
    }
}

fn axis(control: u16, value: i32) -> InputEvent {
    InputEvent::Axis { control, value }
}

fn button(control: u16, down: bool) -> InputEvent {
    InputEvent::Button { control, down }
}

#[test]
fn the_x_touch_mini_in_its_standard_mode() {
    let (mut bench, sent) = Bench::woken(&builtin("x-touch-mini"));
    assert!(sent.starts_with(&[0xBA, 127, 0]), "standard mode: {sent:02x?}");
    assert!(
        sent.windows(3).any(|message| message == [0x9A, 15, 0]),
        "every lamp dark"
    );
    assert_eq!(
        bench.hear(&[0xBA, 1, 64, 8, 127, 9, 5]),
        [axis(0, 64), axis(7, 127), axis(8, 5)]
    );
    assert_eq!(
        bench.hear(&[0x9A, 0, 127, 0, 0, 23, 127, 0x8A, 23, 0]),
        [
            button(0, true),
            button(0, false),
            button(23, true),
            button(23, false)
        ]
    );
    let ring = |control, value, style| Feedback::Ring {
        control,
        value,
        style,
    };
    // The way of lighting is a message of its own, and goes only when it changes.
    assert_eq!(
        bench.show(&ring(2, Some(1.0), RingStyle::Fan)),
        [0xBA, 3, 2, 0xBA, 11, 13]
    );
    assert_eq!(bench.show(&ring(2, Some(0.0), RingStyle::Fan)), [0xBA, 11, 1]);
    assert_eq!(bench.show(&ring(2, None, RingStyle::Fan)), [0xBA, 11, 0]);
    assert_eq!(bench.show(&Feedback::Lamps(0b101)), [0x9A, 0, 1, 0x9A, 2, 1]);
    assert_eq!(bench.show(&Feedback::Lamps(0b101)), []);
}

#[test]
fn the_x_touch_mini_in_mc_mode() {
    let (mut bench, sent) = Bench::woken(&builtin("x-touch-mini-mc"));
    assert!(sent.starts_with(&[0xBA, 127, 1]), "MC mode: {sent:02x?}");
    assert_eq!(
        bench.hear(&[0xB0, 16, 1, 23, 65, 17, 0x47]),
        [dial(0, 1), dial(7, -1), dial(1, -7)]
    );
    assert_eq!(bench.hear(&[0xE8, 0x7F, 0x7F]), [axis(0, 16383)]);
    assert_eq!(
        bench.hear(&[0x90, 89, 127, 95, 127, 84, 127]),
        [button(8, true), button(23, true), button(24, true)]
    );
    let table = [
        (Some(0.0), RingStyle::Dot, 0x01),
        (Some(1.0), RingStyle::Dot, 0x0B),
        (Some(0.5), RingStyle::Pan, 0x16),
        (Some(1.0), RingStyle::Fan, 0x2B),
        (Some(1.0), RingStyle::Spread, 0x36),
        (Some(0.0), RingStyle::Spread, 0x31),
        (None, RingStyle::Spread, 0x00),
    ];
    for (value, style, wanted) in table {
        let sent = bench.show(&Feedback::Ring {
            control: 7,
            value,
            style,
        });
        assert_eq!(sent, [0xB0, 55, wanted], "{value:?} {style:?}");
    }
    let lamp = bench.show(&Feedback::Lamp {
        control: 8,
        level: 1,
        colour: None,
    });
    assert_eq!(lamp, [0x90, 87, 127]);
}

#[test]
fn the_nanokontrol2_says_who_it_is_and_lights_by_its_own_controllers() {
    let mut bench = Bench {
        codec: Midi::new(&builtin("nanokontrol2")),
        now_ms: 0,
        events: Vec::new(),
    };
    bench.codec.start(at_ms(0), &mut Outgoing::new());
    assert_eq!(bench.pass(0), [0xF0, 0x7E, 0x7F, 0x06, 0x01, 0xF7]);
    assert!(!bench.codec.started());
    bench.hear(&[
        0xF0, 0x7E, 0x00, 0x06, 0x02, 0x42, 0x13, 0x01, 0, 0, 3, 0, 1, 0, 0xF7,
    ]);
    let sent = bench.pass(10);
    assert!(bench.codec.started());
    assert_eq!(bench.codec.identity(), Some("42 13 01 00 00 03 00 01 00"));
    // Solo, mute and record of eight strips, cycle, and five of transport; track and marker have none.
    assert_eq!(sent.len(), 3 * 30, "all lamps dark");
    bench.events.clear();
    assert_eq!(
        bench.hear(&[0xB0, 0, 12, 23, 99, 41, 127, 41, 0, 62, 127]),
        [
            axis(0, 12),
            axis(15, 99),
            button(33, true),
            button(33, false),
            button(29, true)
        ]
    );
    // The last of thirty lamps, record.
    assert_eq!(bench.show(&Feedback::Lamps(1 << 29)), [0xB0, 45, 127]);

    // One that does not answer works all the same, a little later.
    let (bench, _) = Bench::woken(&builtin("nanokontrol2"));
    assert_eq!(bench.codec.counters().rejected, 1);
}

#[test]
fn the_launch_control_xl_takes_its_colours_by_system_exclusive() {
    let (mut bench, sent) = Bench::woken(&builtin("launch-control-xl"));
    let template = [0xF0, 0x00, 0x20, 0x29, 0x02, 0x11, 0x77, 0x08, 0xF7];
    assert!(sent.starts_with(&template), "{sent:02x?}");
    assert_eq!(
        bench.hear(&[
            0xB8, 13, 1, 36, 2, 56, 3, 84, 4, 107, 127, 0x98, 60, 127, 0x88, 60, 0
        ]),
        [
            axis(0, 1),
            axis(15, 2),
            axis(23, 3),
            axis(31, 4),
            button(23, true),
            button(7, true),
            button(7, false)
        ]
    );
    let lamp = |control, level, colour| Feedback::Lamp {
        control,
        level,
        colour,
    };
    // value = 16 green + red + 12; red, green and both; dark; dim.
    let table = [
        (0, 255, Some([255, 0, 0]), 0, 0x0F),
        (8, 255, Some([0, 255, 0]), 8, 0x3C),
        (23, 255, None, 23, 0x3F),
        (39, 1, Some([255, 255, 0]), 39, 0x1D),
        (40, 255, Some([255, 0, 0]), 40, 0x0F),
        (44, 255, Some([255, 255, 255]), 44, 0x0F),
    ];
    for (control, level, colour, index, value) in table {
        let wanted = [0xF0, 0x00, 0x20, 0x29, 0x02, 0x11, 0x78, 0x08, index, value, 0xF7];
        assert_eq!(
            bench.show(&lamp(control, level, colour)),
            wanted,
            "lamp {control}"
        );
    }
    assert_eq!(bench.show(&lamp(0, 0, None))[9], 0x0C);
}

#[test]
fn the_beatstep_is_told_to_be_relative() {
    let (mut bench, sent) = Bench::woken(&builtin("beatstep"));
    assert!(sent.starts_with(&[
        0xF0, 0x00, 0x20, 0x6B, 0x7F, 0x42, 0x02, 0x00, 0x06, 0x20, 0x01, 0xF7
    ]));
    assert_eq!(sent.len(), 16 * 12);
    assert_eq!(
        bench.hear(&[0xB0, 10, 65, 74, 61, 72, 67]),
        [dial(0, 1), dial(1, -3), dial(15, 3)]
    );
}

#[test]
fn a_motor_fader_is_not_driven_against_a_finger() {
    let (mut bench, _) = Bench::woken(&builtin("mackie-control"));
    let motor = |value| Feedback::Motor { control: 8, value };
    bench.show(&motor(8192));
    assert_eq!(bench.pass(10), [0xE8, 0, 0x40]);
    assert_eq!(
        bench.hear(&[0x90, 112, 127, 0xE8, 0, 0x50]),
        [
            InputEvent::AxisTouched {
                control: 8,
                down: true
            },
            axis(8, 0x2800)
        ]
    );
    bench.show(&motor(100));
    assert_eq!(bench.pass(2_000), []);
    assert_eq!(
        bench.hear(&[0x90, 112, 0]),
        [InputEvent::AxisTouched {
            control: 8,
            down: false
        }]
    );
    assert_eq!(bench.pass(10), [0xE8, 100, 0]);
    bench.show(&motor(100));
    assert_eq!(bench.pass(1_000), []);
    // What is beyond the message's fourteen bits is kept within them.
    bench.show(&motor(1_000_000));
    assert_eq!(bench.pass(10), [0xE8, 0x7F, 0x7F]);
}

#[test]
fn scribble_strips_take_seven_characters_each_at_their_place() {
    let (mut bench, sent) = Bench::woken(&builtin("mackie-control"));
    let blank = [&[0xF0, 0, 0, 0x66, 0x14, 0x12, 49][..], b"       ", &[0xF7]].concat();
    assert!(
        sent.windows(blank.len()).any(|part| part == blank),
        "everything is blanked"
    );
    let label = |text: &str| Feedback::Label {
        control: 3,
        text: text.to_owned(),
    };
    let written = [&[0xF0, 0, 0, 0x66, 0x14, 0x12, 21][..], b"Elb?w R", &[0xF7]].concat();
    assert_eq!(bench.show(&label("Elböw Right")), written);
    assert_eq!(bench.show(&label("Elböw Right")), []);
}

#[test]
fn fine_values_wait_for_their_low_bits_and_not_for_ever() {
    let (mut bench, _) = Bench::woken(&builtin("generic-14-bit"));
    assert_eq!(bench.hear(&[0xB0, 48, 9]), [], "low bits of nothing");
    assert_eq!(bench.hear(&[0xB0, 16, 10]), []);
    assert_eq!(bench.hear(&[48, 127]), [axis(0, 0x057F)]);
    assert_eq!(bench.hear(&[48, 126]), [axis(0, 0x057E)], "low bits alone");
    assert_eq!(
        bench.hear(&[17, 3, 16, 11]),
        [axis(1, 3 << 7)],
        "another control's message says that none follow"
    );
    assert_eq!(bench.hear(&[]), []);
    bench.pass(30);
    assert_eq!(
        std::mem::take(&mut bench.events),
        [axis(0, 11 << 7)],
        "silence says so too"
    );
}

#[test]
fn data_increment_and_decrement_are_steps_whatever_their_value() {
    let one = profile(
        "[[control]]\nkind = \"dial\"\nname = \"dial\"\nencoding = \"data-inc-dec\"\nmidi = { channel = 2, cc = 96 }\n",
    );
    let (mut bench, _) = Bench::woken(&one);
    assert_eq!(
        bench.hear(&[0xB1, 96, 0, 97, 127, 96, 5]),
        [dial(0, 1), dial(0, -1), dial(0, 1)]
    );
}

#[test]
fn a_pad_is_a_button_and_its_velocity_an_axis() {
    let pads = profile(
        "[[control]]\nkind = \"button\"\nname = \"pad\"\ncount = 2\nmidi = { channel = 10, note = 36 }\n\
         [[control]]\nkind = \"axis\"\nname = \"force\"\ncount = 2\nmidi = { channel = 10, note = 36 }\n",
    );
    let (mut bench, _) = Bench::woken(&pads);
    assert_eq!(bench.hear(&[0x99, 37, 100]), [button(1, true), axis(1, 100)]);
    assert_eq!(
        bench.hear(&[0x99, 37, 90]),
        [axis(1, 90)],
        "struck again while it sounds"
    );
    assert_eq!(bench.hear(&[0x89, 37, 64]), [button(1, false), axis(1, 0)]);
}

#[test]
fn impossible_values_are_counted_and_say_nothing() {
    let (mut bench, _) = Bench::woken(&builtin("generic-relative"));
    let before = bench.codec.counters();
    assert_eq!(bench.hear(&[0xB0, 16, 64, 99, 1, 5]), []);
    let counters = bench.codec.counters();
    assert_eq!(counters.rejected - before.rejected, 1);
    assert_eq!(
        counters.reports - before.reports,
        2,
        "a controller of nobody's is well-formed"
    );
}

#[test]
fn what_is_held_is_let_go_and_a_returning_device_is_shown_everything() {
    let (mut bench, first) = Bench::woken(&builtin("x-touch-mini-mc"));
    bench.show(&Feedback::Lamps(1));
    bench.hear(&[0x90, 32, 127]);
    let mut events = Vec::new();
    bench.codec.let_go(&mut |event| events.push(event));
    assert_eq!(events, [button(0, false)]);
    bench.codec.start(at_ms(bench.now_ms), &mut Outgoing::new());
    let again = bench.pass(100);
    assert_eq!(bench.events, [InputEvent::Restarted]);
    assert_eq!(again.len(), first.len());
    assert!(
        again.windows(3).any(|message| message == [0x90, 89, 127]),
        "with what is wanted now"
    );
}

#[test]
fn a_step_that_must_be_answered_is_tried_again() {
    let asked = profile("[[init]]\noutput = \"f0 01 f7\"\nexpect = \"f0 02\"\n");
    let mut codec = Midi::new(&asked);
    codec.start(at_ms(0), &mut Outgoing::new());
    let (mut out, mut said) = (Outgoing::new(), Vec::new());
    for ms in (0..5_000).step_by(10) {
        codec.advance(at_ms(ms), &mut out, &mut |event| said.push(event));
    }
    assert_eq!(
        out.all_bytes(),
        [0xF0, 1, 0xF7].repeat(4),
        "after 0, 1.3, 2.6 and 3.9 s"
    );
    assert!(!codec.started() && said.is_empty());
    codec.decode(&[0xF0, 2, 9, 0xF7], &mut |_| {});
    codec.advance(at_ms(5_000), &mut out, &mut |event| said.push(event));
    assert!(!codec.started(), "nobody asked just now");
}

proptest! {
    /// Any bytes, cut anywhere, give the same events and the same counts; nothing is held for ever.
    #[test]
    fn any_cutting_of_any_stream_gives_the_same_events(
        bytes in prop::collection::vec(prop_oneof![any::<u8>(), 0x80u8..0xF8, Just(0xB0), Just(16), Just(48)], 0..300),
        cuts in prop::collection::vec(0usize..300, 0..20),
    ) {
        for key in ["mackie-control", "generic-14-bit", "x-touch-mini"] {
            let profile = builtin(key);
            let run = |cuts: &[usize]| {
                let mut codec = Midi::listening(&profile);
                let mut events = Vec::new();
                let mut from = 0;
                for &to in cuts {
                    let to = to.min(bytes.len()).max(from);
                    codec.decode(&bytes[from..to], &mut |event| events.push(event));
                    from = to;
                }
                codec.decode(&bytes[from..], &mut |event| events.push(event));
                codec.let_go(&mut |event| events.push(event));
                (events, codec.counters())
            };
            let mut cuts = cuts.clone();
            cuts.sort_unstable();
            let whole = run(&[]);
            prop_assert_eq!(&whole, &run(&cuts));
            let mut held = std::collections::BTreeMap::new();
            for event in whole.0 {
                match event {
                    InputEvent::Button { control, down } => {
                        prop_assert_ne!(held.insert((control, 0), down), Some(down));
                    }
                    InputEvent::AxisTouched { control, down } => {
                        prop_assert_ne!(held.insert((control, 1), down), Some(down));
                    }
                    InputEvent::Axis { value, .. } => prop_assert!((0..16384).contains(&value)),
                    InputEvent::Dial { delta_counts, .. } => prop_assert!((-64..=64).contains(&delta_counts)),
                    _ => {}
                }
            }
            prop_assert!(held.values().all(|down| !down));
        }
    }

    /// Whatever is wanted in whatever order, what was sent last for each lamp is what is wanted last, and nothing is
    /// sent twice running.
    #[test]
    fn a_shadow_sends_changes_and_only_changes(wishes in prop::collection::vec((0u16..18, any::<bool>()), 0..60)) {
        let (mut bench, first) = Bench::woken(&builtin("x-touch-mini-mc"));
        let mut shown = std::collections::BTreeMap::new();
        for message in first.chunks(3).filter(|message| message[0] == 0x90) {
            shown.insert(message[1], message[2]);
        }
        let mut wanted = shown.clone();
        let notes = [89, 90, 40, 41, 42, 43, 44, 45, 87, 88, 91, 92, 86, 93, 94, 95];
        for (control, lit) in wishes {
            if let Some(&note) = notes.get(usize::from(control)) {
                wanted.insert(note, if lit { 127 } else { 0 });
            }
            let level = if lit { 255 } else { 0 };
            for message in bench.show(&Feedback::Lamp { control, level, colour: None }).chunks(3) {
                prop_assert_ne!(shown.insert(message[1], message[2]), Some(message[2]));
            }
            prop_assert_eq!(&shown, &wanted);
        }
    }
}

/// A ring that is to be lit another way shows its value only when that is said again.
#[test]
fn another_way_of_lighting_is_followed_by_the_value() {
    let (mut bench, _) = Bench::woken(&builtin("x-touch-mini"));
    let ring = |value, style| Feedback::Ring {
        control: 0,
        value: Some(value),
        style,
    };
    assert_eq!(bench.show(&ring(0.5, RingStyle::Fan)), [0xBA, 1, 2, 0xBA, 9, 7]);
    assert_eq!(bench.show(&ring(0.5, RingStyle::Fan)), []);
    assert_eq!(bench.show(&ring(0.5, RingStyle::Pan)), [0xBA, 1, 1, 0xBA, 9, 7]);
    assert_eq!(bench.show(&ring(1.0, RingStyle::Pan)), [0xBA, 9, 13]);
}

/// They fall by themselves and are held up, until they are to be down.
#[test]
fn meters_are_held_up() {
    let (mut bench, _) = Bench::woken(&builtin("mackie-control"));
    let level = |level| Feedback::Level { control: 2, level };
    assert_eq!(bench.show(&level(255)), [0xD0, 0x2C]);
    assert_eq!(bench.pass(1000), [0xD0, 0x2C].repeat(5));
    assert_eq!(bench.show(&level(1)), [0xD0, 0x21], "what is not nothing is seen");
    assert_eq!(bench.show(&level(0)), [0xD0, 0x20]);
    assert_eq!(bench.pass(1000), []);
}
