use super::*;
use crate::codec::trial::{Trial, assert_cut_invariant, counted};
use proptest::prelude::*;

fn bars(noise: f64) -> Settings {
    Settings {
        controls: 3,
        separator: b'|',
        key: None,
        hexadecimal: false,
        max: 1023,
        noise,
        invert: false,
    }
}

fn named() -> Settings {
    Settings {
        separator: b',',
        key: Some(Key {
            before: "A".to_owned(),
            after: ":".to_owned(),
        }),
        ..bars(0.0)
    }
}

fn axis(control: u16, value: i32) -> InputEvent {
    InputEvent::Axis { control, value }
}

/// A box whose first line is over.
fn joined(settings: Settings) -> Trial<Deej> {
    let mut trial = Trial::new(Deej::new(settings));
    assert_eq!(trial.start(), []);
    assert_eq!(
        trial.said(b"23|1023\r\n"),
        [],
        "half a line looks whole and is none"
    );
    trial
}

#[test]
fn the_first_whole_line_says_that_the_box_is_there() {
    let mut trial = joined(bars(0.0));
    assert!(!trial.codec.started());
    let told = trial.said(b"0|240|1023\r\n");
    assert_eq!(
        told,
        [InputEvent::Started, axis(0, 0), axis(1, 240), axis(2, 1023)]
    );
    assert_eq!(trial.said(b"0|241|1023\r\n"), [axis(1, 241)]);
    assert_eq!(trial.said(b"0|241|1023\r\n"), []);
    trial.start();
    trial.hear(b"3\r\n");
    let told = trial.said(b"1|2|3\r\n");
    assert_eq!(told, [InputEvent::Restarted, axis(0, 1), axis(1, 2), axis(2, 3)]);
}

#[test]
fn lines_that_are_wrong_in_any_place_count_in_none() {
    let mut trial = joined(bars(0.0));
    trial.hear(b"1|2|3\n");
    trial.told();
    let bad: [&[u8]; 9] = [
        b"1|2\n",
        b"1|2|3|4\n",
        b"9|9|1024\n",
        b"9|9|\n",
        b"9|9|x\n",
        b"9|-9|9\n",
        b"9,9,9\n",
        b"9|9|\xC3\n",
        b"9|9|10230\n",
    ];
    for line in bad {
        assert_eq!(trial.said(line), [], "{line:?}");
    }
    let long = [b"1".repeat(400), b"\n".to_vec()].concat();
    assert_eq!(trial.said(&long), []);
    assert_eq!(trial.codec.counters(), counted(1, 0, 10));
    assert_eq!(trial.said(b"1|2|4\n"), [axis(2, 4)]);
}

#[test]
fn noise_stays_out_and_ends_are_reached() {
    // deej's default gate: 0.025 of 1023 is 25.6 counts.
    let mut trial = joined(bars(0.025));
    trial.hear(b"500|500|1000\n");
    trial.told();
    assert_eq!(trial.said(b"525|475|1020\n"), []);
    assert_eq!(
        trial.said(b"526|474|1023\n"),
        [axis(0, 526), axis(1, 474), axis(2, 1023)]
    );
    assert_eq!(trial.said(b"526|474|1023\n"), [], "an end is reached once");
    assert_eq!(trial.said(b"526|474|1010\n"), []);
    assert_eq!(trial.said(b"0|474|1023\n"), [axis(0, 0)]);
}

#[test]
fn wiring_may_be_the_other_way_round() {
    let mut trial = joined(Settings {
        invert: true,
        ..bars(0.0)
    });
    let told = trial.said(b"0|240|1023\n");
    assert_eq!(told[1..], [axis(0, 1023), axis(1, 783), axis(2, 0)]);
}

#[test]
fn names_come_in_any_order_and_number() {
    let mut trial = joined(named());
    assert_eq!(trial.said(b"A0:512\r\n"), [InputEvent::Started, axis(0, 512)]);
    assert_eq!(trial.said(b"A2:7,A1:9\r\n"), [axis(1, 9), axis(2, 7)]);
    assert_eq!(trial.said(b" A1: 10 , A0:1\r\n"), [axis(0, 1), axis(1, 10)]);
    for line in ["A3:1\n", "B0:1\n", "A:1\n", "A0=1\n", "A0:\n", "A0:1,\n", "512\n"] {
        assert_eq!(trial.said(line.as_bytes()), [], "{line}");
    }
    assert_eq!(trial.codec.counters(), counted(3, 0, 7));
}

#[test]
fn numbers_may_be_hexadecimal() {
    let mut trial = joined(Settings {
        hexadecimal: true,
        separator: b' ',
        ..bars(0.0)
    });
    assert_eq!(
        trial.said(b"0 3fF 1A\n")[1..],
        [axis(0, 0), axis(1, 1023), axis(2, 26)]
    );
    assert_eq!(trial.said(b"0 400 1A\n"), []);
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(text in "([0-9|A:,]{0,12}\r?\n){0,12}", cut in 0_usize..150) {
        assert_cut_invariant(|| Deej::new(bars(0.02)), text.as_bytes(), cut);
        assert_cut_invariant(|| Deej::new(named()), text.as_bytes(), cut);
    }

    #[test]
    fn any_bytes_are_survived(stream in prop::collection::vec(any::<u8>(), 0..400), cut in 0_usize..400) {
        assert_cut_invariant(|| Deej::new(bars(0.0)), &stream, cut);
    }
}
