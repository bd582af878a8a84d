//! Lines as the sketch prints them, at the pace of the wire.

use super::*;
use crate::firmware::Firmware;
use crate::hands::Hands;
use crate::script::Script;
use proptest::prelude::*;

fn steady(pots: u8) -> Options {
    Options {
        pots,
        jitter_counts: 0,
        restarts_when_opened: false,
        ..Options::default()
    }
}

fn heard(deej: &mut Deej, now_us: u64) -> String {
    let mut out = Vec::new();
    deej.transmit(now_us, &mut out);
    String::from_utf8(out).expect("text")
}

fn axis(control: u8, to: f64, over_us: u64) -> Touch {
    Touch::Axis { control, to, over_us }
}

#[test]
fn a_line_is_all_pots_with_bars_between() {
    let mut deej = Deej::new(steady(3));
    assert!(deej.touch(0, &axis(1, 0.235, 0)));
    assert!(deej.touch(0, &axis(2, 1.0, 0)));
    assert!(!deej.touch(0, &axis(3, 1.0, 0)));
    let said = heard(&mut deej, 60_000);
    // The line at 0 was begun before the hands came.
    assert_eq!(said.lines().nth(1), Some("0|240|1023"), "{said:?}");
    assert!(said.contains("\r\n"));
}

#[test]
fn the_pause_sets_the_pace_of_short_lines_and_the_wire_that_of_long_ones() {
    // One pot at 0: 3 bytes, 3.1 ms; every 10 ms.
    let lines = |pots: u8, at: f64| {
        let mut deej = Deej::new(steady(pots));
        for pot in 0..pots {
            deej.touch(0, &axis(pot, at, 0));
        }
        heard(&mut deej, 10_000_000).matches("\r\n").count()
    };
    assert_eq!(lines(1, 0.0), 1000);
    // Five pots of four digits: 26 bytes at 960 a second, 36.9 lines a second.
    let five = lines(5, 1.0);
    assert!((367..=371).contains(&five), "{five}");
}

#[test]
fn opening_restarts_the_board_and_what_it_was_saying_is_cut_off() {
    let mut deej = Deej::new(Options {
        restarts_when_opened: true,
        ..steady(2)
    });
    heard(&mut deej, 20_300);
    deej.port_opened(20_300);
    assert_eq!(heard(&mut deej, 1_620_000), "", "still booting");
    let said = heard(&mut deej, 1_700_000);
    assert!(said.starts_with("0|0\r\n"), "{said:?}");
    assert_eq!(deej.reporting_since_us(), Some(0));

    let mut joined = Deej::new(steady(2));
    heard(&mut joined, 1_500);
    joined.port_opened(1_500);
    assert_eq!(heard(&mut joined, 5_300), "|0\r\n", "joined in the middle");
}

#[test]
fn jitter_stays_within_its_counts_and_the_converter_within_its_range() {
    for (share, inverted) in [(0.0, false), (1.0, false), (0.5, true), (1.0, true)] {
        let mut deej = Deej::new(Options {
            jitter_counts: 3,
            inverted,
            seed: 5,
            ..steady(1)
        });
        deej.touch(0, &axis(0, share, 0));
        let true_share: f64 = if inverted { 1.0 - share } else { share };
        let said = heard(&mut deej, 2_000_000);
        let mut seen = std::collections::BTreeSet::new();
        for line in said.lines().skip(1) {
            let counts: f64 = line.parse().expect("a number");
            assert!((0.0..=1023.0).contains(&counts));
            assert!((counts - true_share * 1023.0).abs() <= 3.5, "{counts} at {share}");
            seen.insert(line.to_owned());
        }
        assert!(seen.len() > 2, "it does jitter");
    }
}

proptest! {
    #[test]
    fn how_calls_are_cut_up_changes_nothing(
        cuts in prop::collection::vec(0u64..400_000, 0..20),
        moves in prop::collection::vec((0u8..4, 0.0..1.0f64, 0u64..100_000), 0..6),
    ) {
        let make = || {
            let mut deej = Deej::new(Options { pots: 4, drift_ppm: 800, ..Options::default() });
            let actions = moves.iter().enumerate().map(|(n, &(control, to, over_us))| crate::script::Action {
                at_us: n as u64 * 50_000,
                touch: axis(control, to, over_us),
            });
            deej.play(&Script { actions: actions.collect() });
            deej
        };
        let mut whole = make();
        let (mut once, mut piecewise) = (Vec::new(), Vec::new());
        whole.transmit(400_000, &mut once);
        let mut cut = make();
        let mut cuts = cuts;
        cuts.sort_unstable();
        for at in cuts {
            cut.transmit(at, &mut piecewise);
        }
        cut.transmit(400_000, &mut piecewise);
        prop_assert_eq!(once, piecewise);
    }
}
