use super::*;
use crate::codec::calcomp::packet::Code;
use crate::codec::trial::{Trial, assert_cut_invariant, assert_lets_go, counted, text};
use crate::codec::{PenSample, Tool};
use proptest::prelude::*;

fn settings() -> Settings {
    Settings {
        meaning: Meaning {
            tool: Tool::Puck,
            proximity_bit: 0x40,
            code: Code::Buttons,
            y_up: true,
        },
        surface: Surface::flat([20_000, 20_000], [1000.0, 1000.0], 0),
    }
}

#[test]
fn a_tablet_is_prompted_asked_and_set_up() {
    let mut trial = Trial::new(Gtco::new(settings()));
    assert_eq!(trial.start(), [text("\x01")]);
    assert_eq!(trial.hear(b">"), [text("VR\r")]);
    assert_eq!(trial.hear(b"VR\r\nSL3 V1.04\r\n"), []);
    assert_eq!(trial.hear(b">"), [text("SZ\r")]);
    assert_eq!(trial.hear(b"SZ\r3648\r\n>"), [text("BI\r")]);
    assert_eq!(trial.hear(b"BI\r>"), [text("IN\r")]);
    assert_eq!(trial.hear(b"IN\r>"), [text("HR\r")]);
    assert_eq!(trial.hear(b"HR\r>"), [text("CN\r")]);
    assert_eq!(trial.hear(b"CN\r>"), [text("\x1b")]);
    assert_eq!(trial.told(), [InputEvent::Started]);
    assert_eq!(trial.codec.identity(), Some("SL3 V1.04"));
    assert_eq!(
        trial.codec.surface().map(|s| s.max_counts),
        Some([48_000, 36_000])
    );
    assert_eq!(trial.codec.counters(), counted(7, 0, 0));
    // The largest y is now 36000, and y counts from below.
    let got = trial.samples(&[0x84, 0, 1, 0, 0, 2])[0];
    let want = PenSample {
        buttons: 1,
        ..PenSample::hovering(Tool::Puck, 1, 35_998)
    };
    assert_eq!(got, want);
}

#[test]
fn refused_and_silent_questions_leave_the_profiles_values() {
    let mut trial = Trial::new(Gtco::new(settings()));
    trial.start();
    assert_eq!(trial.after_ms(500), [text("\x01")], "nobody there");
    trial.hear(b">");
    assert_eq!(trial.after_ms(500), [text("SZ\r")]);
    assert_eq!(trial.hear(b"SZ\r?\r\n>"), [text("BI\r")]);
    for _ in 0..4 {
        trial.after_ms(500);
    }
    assert_eq!(trial.told(), [InputEvent::Started]);
    assert_eq!(trial.codec.identity(), None);
    assert_eq!(
        trial.codec.surface().map(|s| s.max_counts),
        Some([20_000, 20_000])
    );
    assert_eq!(trial.codec.counters(), counted(2, 0, 1));
}

#[test]
fn sizes_that_are_none_are_counted() {
    for (answer, rejected) in [
        ("0012", 1),
        ("12", 1),
        ("12x4", 1),
        ("123456", 1),
        ("", 0),
        ("2436", 0),
    ] {
        let mut trial = Trial::new(Gtco::new(settings()));
        trial.start();
        trial.hear(b">");
        trial.hear(b">");
        trial.hear(format!("SZ\r{answer}\r\n>").as_bytes());
        assert_eq!(trial.codec.counters().rejected, rejected, "{answer}");
    }
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(stream in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..200) {
        assert_cut_invariant(|| Gtco::listening(settings()), &stream, cut);
    }

    #[test]
    fn everything_is_let_go(stream in prop::collection::vec(any::<u8>(), 0..300)) {
        assert_lets_go(Gtco::listening(settings()), &stream);
    }

    #[test]
    fn answers_of_any_bytes_are_survived(stream in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut trial = Trial::new(Gtco::new(settings()));
        trial.start();
        for _ in 0..8 {
            trial.hear(&stream);
            trial.after_ms(500);
        }
    }
}
