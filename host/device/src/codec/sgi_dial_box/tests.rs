use super::*;
use device_profiles::{InputProfile, Profiles, Sgi};
use proptest::prelude::*;

fn profile(name: &str) -> InputProfile {
    Profiles::builtin().input(name).unwrap().clone()
}

/// A codec and the time, with everything it says.
struct Host {
    codec: SgiDialBox,
    now: Instant,
    events: Vec<InputEvent>,
}

impl Host {
    fn new(name: &str) -> Self {
        Self {
            codec: SgiDialBox::new(&profile(name)),
            now: Instant::ZERO,
            events: Vec::new(),
        }
    }

    /// A box that has been initialised.
    fn running(name: &str) -> Self {
        let mut host = Self::new(name);
        host.start();
        host.hear(&[0x20]);
        host.after_ms(1_000);
        host.events.clear();
        host
    }

    fn start(&mut self) -> Vec<u8> {
        let mut out = Outgoing::new();
        self.codec.start(self.now, &mut out);
        out.all_bytes()
    }

    fn hear(&mut self, bytes: &[u8]) -> Vec<u8> {
        let events = &mut self.events;
        self.codec.decode(bytes, &mut |e| events.push(e));
        self.after_ms(0)
    }

    fn after_ms(&mut self, ms: u64) -> Vec<u8> {
        self.now = self.now.after(Duration::from_millis(ms));
        let mut out = Outgoing::new();
        let events = &mut self.events;
        self.codec.advance(self.now, &mut out, &mut |e| events.push(e));
        out.all_bytes()
    }

    fn show(&mut self, feedback: &Feedback) -> Vec<u8> {
        let mut out = Outgoing::new();
        self.codec.encode(feedback, &mut out);
        out.all_bytes()
    }

    fn said(&mut self) -> Vec<InputEvent> {
        std::mem::take(&mut self.events)
    }
}

fn dial(control: u16, delta_counts: i32) -> InputEvent {
    InputEvent::Dial {
        control,
        delta_counts,
    }
}

fn button(control: u16, down: bool) -> InputEvent {
    InputEvent::Button { control, down }
}

/// `50 00 FF`, then twice 71 and 73 with all buttons, then dark lamps.
const SET_UP: [u8; 28] = [
    0x50, 0x00, 0xFF, 0x71, 0xFF, 0xFF, 0xFF, 0xFF, 0x73, 0xFF, 0xFF, 0xFF, 0xFF, 0x71, 0xFF, 0xFF, 0xFF,
    0xFF, 0x73, 0xFF, 0xFF, 0xFF, 0xFF, 0x75, 0x00, 0x00, 0x00, 0x00,
];

#[test]
fn asks_until_answered_and_then_sets_up() {
    let mut host = Host::new("sgi-dialbox");
    assert_eq!(host.start(), [0x20]);
    assert_eq!(host.after_ms(999), []);
    assert_eq!(host.after_ms(1), [0x20]);
    assert!(!host.codec.started());
    assert_eq!(host.hear(&[0x20]), SET_UP);
    assert_eq!(host.said(), [InputEvent::Started]);
    assert!(host.codec.started());
}

#[test]
fn counts_become_differences_that_wrap_in_sixteen_bits() {
    let rows: [(&[u8], &[InputEvent]); 6] = [
        (&[0x30, 0x00, 0x05], &[dial(0, 5)]),
        (&[0x30, 0x00, 0x05], &[]),
        (&[0x30, 0xFF, 0xFF], &[dial(0, -6)]),
        (&[0x37, 0x7F, 0xFF], &[dial(7, 0x7FFF)]),
        (&[0x37, 0x80, 0x00], &[dial(7, 1)]),
        (&[0x43, 0xFF, 0xFE], &[dial(3, -2)]),
    ];
    let mut host = Host::running("sgi-dialbox");
    for (bytes, want) in rows {
        host.hear(bytes);
        assert_eq!(host.said(), want, "{bytes:02X?}");
    }
}

#[test]
fn a_box_that_does_not_begin_at_zero_gives_a_reference_first() {
    let profile = InputProfile {
        sgi: Some(Sgi {
            counts_start_at_zero: false,
        }),
        ..profile("sgi-dialbox")
    };
    let mut codec = SgiDialBox::listening(&profile);
    let mut events = Vec::new();
    codec.decode(&[0x32, 0x10, 0x00, 0x32, 0x0F, 0xFF], &mut |e| events.push(e));
    assert_eq!(events, [dial(2, -1)]);
}

#[test]
fn buttons_are_coded_downwards_in_eights() {
    let rows = [
        (0xD8, button(0, true)),
        (0xDF, button(7, true)),
        (0xD0, button(8, true)),
        (0xC8, button(16, true)),
        (0xC0, button(24, true)),
        (0xC7, button(31, true)),
        (0xF8, button(0, false)),
        (0xF7, button(15, false)),
        (0xEF, button(23, false)),
        (0xE7, button(31, false)),
    ];
    let mut host = Host::running("sgi-dialbox");
    for (byte, want) in rows {
        host.hear(&[byte]);
        assert_eq!(host.said(), [want], "{byte:02X}");
    }
}

#[test]
fn a_power_cycle_lets_buttons_go_and_shows_everything_again() {
    let mut host = Host::running("sgi-dialbox-display");
    host.show(&Feedback::Lamps(0x8000_0001));
    host.show(&Feedback::Label {
        control: 2,
        text: "X-Trans".into(),
    });
    host.hear(&[0xD9, 0x30, 0x01, 0x00]);
    host.said();
    assert_eq!(host.hear(&[0x20]), [0x20]);
    assert_eq!(host.said(), [button(1, false)]);
    let sent = host.hear(&[0x20]);
    assert_eq!(sent[..23], SET_UP[..23]);
    assert_eq!(sent[23..28], [0x75, 0x01, 0x00, 0x00, 0x80]);
    assert_eq!(sent[28..], *b"\x61\x02X-Trans ");
    assert_eq!(host.said(), [InputEvent::Restarted]);
    host.hear(&[0x30, 0x00, 0x03]);
    assert_eq!(host.said(), [dial(0, 3)]);
}

#[test]
fn a_chained_pair_is_no_power_cycle() {
    let mut host = Host::new("sgi-dialbox");
    host.start();
    assert_eq!(host.hear(&[0x20, 0x20]).len(), SET_UP.len());
    host.after_ms(2);
    assert_eq!(host.hear(&[0x20]), []);
    assert_eq!(host.said(), [InputEvent::Started]);
}

#[test]
fn only_changes_are_sent() {
    let mut host = Host::running("sgi-dialbox-display");
    assert_eq!(host.show(&Feedback::Lamps(1)), [0x75, 1, 0, 0, 0]);
    assert_eq!(host.show(&Feedback::Lamps(1)), []);
    let label = |control, text: &str| Feedback::Label {
        control,
        text: text.into(),
    };
    assert_eq!(host.show(&label(8, "Grösse 12345")), *b"\x61\x08Gr?sse 1");
    assert_eq!(host.show(&label(8, "Grösse 1")), []);
    assert_eq!(host.show(&label(20, "no such")), []);
    let mut plain = Host::running("sgi-dialbox");
    assert_eq!(plain.show(&label(0, "none")), []);
}

#[test]
fn what_is_shown_before_the_start_comes_with_it() {
    let mut host = Host::new("sgi-dialbox");
    host.start();
    assert_eq!(host.show(&Feedback::Lamps(2)), []);
    assert!(host.hear(&[0x20]).ends_with(&[0x75, 2, 0, 0, 0]));
}

#[test]
fn leftovers_from_before_the_answer_are_not_events() {
    let mut host = Host::new("sgi-dialbox");
    host.start();
    host.hear(&[0x31, 0x12, 0x34, 0xD8, 0x20, 0x31, 0x00, 0x01]);
    assert_eq!(host.said(), [dial(1, 1), InputEvent::Started]);
}

#[test]
fn noise_is_counted_and_skipped() {
    let mut host = Host::running("sgi-dialbox");
    host.hear(&[0x00, 0x38, 0x7F, 0xBF, 0x30, 0x00, 0x01]);
    assert_eq!(host.said(), [dial(0, 1)]);
    assert_eq!(
        host.codec.counters(),
        Counters {
            reports: 2,
            unknown: 4,
            rejected: 0
        }
    );
}

#[test]
fn half_a_report_is_given_up() {
    let mut host = Host::running("sgi-dialbox");
    host.hear(&[0x30, 0x00]);
    host.after_ms(101);
    assert_eq!(host.codec.counters().rejected, 1);
    host.hear(&[0xD8]);
    assert_eq!(host.said(), [button(0, true)]);
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        cuts in prop::collection::vec(0_usize..200, 0..20),
    ) {
        let whole = {
            let mut codec = SgiDialBox::listening(&profile("sgi-dialbox"));
            let mut events = Vec::new();
            codec.decode(&bytes, &mut |e| events.push(e));
            (events, codec.counters())
        };
        let mut cuts: Vec<_> = cuts.into_iter().map(|c| c.min(bytes.len())).collect();
        cuts.extend([0, bytes.len()]);
        cuts.sort_unstable();
        let mut codec = SgiDialBox::listening(&profile("sgi-dialbox"));
        let mut events = Vec::new();
        for pair in cuts.windows(2) {
            codec.decode(&bytes[pair[0]..pair[1]], &mut |e| events.push(e));
        }
        prop_assert_eq!((events, codec.counters()), whole);
    }

    #[test]
    fn turns_add_up_whatever_the_counts(counts in prop::collection::vec(any::<u16>(), 1..50)) {
        let mut codec = SgiDialBox::listening(&profile("sgi-dialbox"));
        let mut sum = 0_i64;
        for count in &counts {
            let [high, low] = count.to_be_bytes();
            codec.decode(&[0x35, high, low], &mut |e| {
                if let InputEvent::Dial { delta_counts, .. } = e { sum += i64::from(delta_counts); }
            });
        }
        prop_assert_eq!(sum as u16, *counts.last().unwrap());
    }
}
