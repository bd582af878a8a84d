use super::*;
use crate::codec::RingStyle;
use crate::codec::trial::{Trial, all_bytes, assert_cut_invariant, assert_lets_go, bytes, counted};
use proptest::prelude::*;
use ring::{LAMPS, draw};

const FOUR: Settings = Settings { rings: 4 };

fn id(text: &str) -> Vec<u8> {
    let mut message = vec![0x01];
    message.extend(text.as_bytes());
    message.resize(33, 0);
    message
}

fn ring(control: u16, value: Option<f64>, style: RingStyle) -> Feedback {
    Feedback::Ring {
        control,
        value,
        style,
    }
}

fn dark(number: u8) -> Vec<u8> {
    [&[0x92, number][..], &[0; 32]].concat()
}

#[test]
fn an_arc_is_asked_and_all_rings_are_drawn() {
    let mut trial = Trial::new(MonomeArc::new(FOUR));
    assert_eq!(trial.start(), [bytes(&[0x00, 0x01, 0x0F])]);
    assert_eq!(trial.after_ms(999), []);
    assert_eq!(trial.after_ms(1), [bytes(&[0x00, 0x01, 0x0F])], "again, for ever");
    let drawn = trial.hear(&[0x00, 0x05, 0x04]);
    assert_eq!(all_bytes(&drawn), [dark(0), dark(1), dark(2), dark(3)].concat());
    assert_eq!(trial.told(), [InputEvent::Started]);
    trial.hear(&id("monome arc 4 m0000123"));
    assert_eq!(trial.codec.identity(), Some("monome arc 4 m0000123"));
    trial.hear(&[0x0F, 1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(trial.codec.counters(), counted(3, 0, 0));
    trial.start();
    assert_eq!(
        all_bytes(&trial.hear(&[0x00, 0x05, 0x04])).len(),
        4 * 34,
        "everything again"
    );
    assert_eq!(trial.told(), [InputEvent::Restarted]);
}

#[test]
fn encoders_turn_and_are_pressed() {
    let mut trial = Trial::new(MonomeArc::listening(FOUR));
    let dial = |control, delta_counts| InputEvent::Dial {
        control,
        delta_counts,
    };
    let button = |control, down| InputEvent::Button { control, down };
    let rows: [(&[u8], Vec<InputEvent>); 8] = [
        (&[0x50, 0, 1], vec![dial(0, 1)]),
        (&[0x50, 3, 0xFF], vec![dial(3, -1)]),
        (&[0x50, 1, 0x7F], vec![dial(1, 127)]),
        (&[0x50, 1, 0x80], vec![dial(1, -128)]),
        (&[0x50, 1, 0], vec![]),
        (&[0x52, 2], vec![button(2, true)]),
        (&[0x51, 2], vec![button(2, false)]),
        (&[0x51, 2], vec![]),
    ];
    for (message, want) in rows {
        assert_eq!(trial.said(message), want, "{message:02X?}");
    }
    assert_eq!(trial.said(&[0x50, 4, 1]), [], "there is no fifth");
    assert_eq!(trial.codec.counters(), counted(8, 0, 1));
}

#[test]
fn a_ring_is_sent_when_it_changes() {
    let mut trial = Trial::new(MonomeArc::new(Settings { rings: 2 }));
    let mut out = Outgoing::new();
    trial.start();
    // Kept until the arc answers.
    trial.codec.encode(&ring(1, Some(0.0), RingStyle::Dot), &mut out);
    assert!(out.is_empty());
    let drawn = all_bytes(&trial.hear(&[0x00, 0x05, 0x02]));
    let mut second = dark(1);
    second[2] = 0xF0;
    assert_eq!(drawn, [dark(0), second].concat());
    trial.codec.encode(&ring(1, Some(0.0), RingStyle::Dot), &mut out);
    assert!(out.is_empty(), "it shows that");
    trial.codec.encode(&ring(0, Some(1.0), RingStyle::Dot), &mut out);
    let mut first = dark(0);
    first[33] = 0x0F;
    assert_eq!(out.all_bytes(), first);
    out.clear();
    trial.codec.encode(&ring(2, Some(1.0), RingStyle::Dot), &mut out);
    trial.codec.encode(&Feedback::Lamps(1), &mut out);
    assert!(out.is_empty(), "there is no third ring and no lamp");
}

#[test]
fn styles_light_what_they_say() {
    let lit = |value, style| {
        let levels = draw(value, style);
        let runs: Vec<(usize, u8)> = levels
            .iter()
            .enumerate()
            .filter(|(_, level)| **level > 0)
            .map(|(lamp, level)| (lamp, *level))
            .collect();
        runs
    };
    let full = |lamps: std::ops::Range<usize>| lamps.map(|lamp| (lamp, 15)).collect::<Vec<_>>();
    assert_eq!(lit(None, RingStyle::Fan), []);
    assert_eq!(lit(Some(f64::NAN), RingStyle::Fan), []);
    assert_eq!(lit(Some(0.5), RingStyle::Dot), [(32, 15)]);
    assert_eq!(lit(Some(7.0), RingStyle::Dot), [(63, 15)]);
    assert_eq!(lit(Some(0.0), RingStyle::Fan), []);
    assert_eq!(lit(Some(1.0), RingStyle::Fan), full(0..LAMPS));
    assert_eq!(lit(Some(2.0 / 64.0), RingStyle::Fan), full(0..2));
    assert_eq!(lit(Some(1.0 / 128.0), RingStyle::Fan), [(0, 8)]);
    assert_eq!(lit(Some(0.5), RingStyle::Pan), []);
    assert_eq!(lit(Some(0.0), RingStyle::Pan), full(0..32));
    assert_eq!(lit(Some(0.75), RingStyle::Pan), full(32..48));
    assert_eq!(lit(Some(4.0 / 64.0), RingStyle::Spread), full(30..34));
}

#[test]
fn damage_is_counted_and_skipped() {
    let mut trial = Trial::new(MonomeArc::listening(FOUR));
    let dial = InputEvent::Dial {
        control: 0,
        delta_counts: 1,
    };
    assert_eq!(trial.said(&[0xA0, 0x7F, 0x50, 0, 1]), [dial]);
    assert_eq!(trial.codec.counters(), counted(1, 2, 0));
    trial.hear(&[0x01, b'm', b'0']);
    trial.after_ms(101);
    assert_eq!(trial.said(&[0x50, 0, 1]), [dial]);
    assert_eq!(trial.codec.counters(), counted(2, 2, 1));
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(stream in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..200) {
        assert_cut_invariant(|| MonomeArc::listening(FOUR), &stream, cut);
    }

    #[test]
    fn everything_is_let_go(stream in prop::collection::vec(prop_oneof![0x50_u8..0x53, 0_u8..6, any::<u8>()], 0..300)) {
        assert_lets_go(MonomeArc::listening(FOUR), &stream);
    }
}
