//! Every case of the decision table, what its users miss in it, and that nothing ever steps.

use super::*;
use proptest::prelude::*;

/// A row of Mixxx's table; nothing where it does not matter.
struct Row {
    same_side: Option<bool>,
    was_near: Option<bool>,
    is_near: bool,
    quick: Option<bool>,
    takes: bool,
}

const fn row(
    same_side: Option<bool>,
    was_near: Option<bool>,
    is_near: bool,
    quick: Option<bool>,
    takes: bool,
) -> Row {
    Row {
        same_side,
        was_near,
        is_near,
        quick,
        takes,
    }
}

const TABLE: [Row; 6] = [
    row(None, None, true, None, true),
    row(Some(false), None, false, Some(true), true),
    row(Some(false), None, false, Some(false), false),
    row(Some(true), Some(true), false, Some(true), true),
    row(Some(true), Some(true), false, Some(false), false),
    row(Some(true), Some(false), false, None, false),
];

/// All places of a control of 128 steps against all values of one: no case is left out, none fits two rows.
#[test]
fn every_case_of_the_table_is_decided_as_it_says() {
    let share = |step: u32| f64::from(step) / 127.0;
    let mut seen = [0_u32; 6];
    for target in (0..128).map(share) {
        for before in (0..128).map(share) {
            for now in (0..128).map(share) {
                let is_near = |place: f64| (place - target).abs() <= NEAR;
                let same_side = (before < target) == (now < target);
                for quick in [false, true] {
                    let fits = |row: &Row| {
                        row.is_near == is_near(now)
                            && row.same_side.is_none_or(|it| it == same_side)
                            && row.was_near.is_none_or(|it| it == is_near(before))
                            && row.quick.is_none_or(|it| it == quick)
                    };
                    let rows: Vec<usize> = (0..TABLE.len()).filter(|&at| fits(&TABLE[at])).collect();
                    assert_eq!(rows.len(), 1, "{target} {before} {now} {quick}");
                    seen[rows[0]] += 1;
                    let takes = takes_hold(target, before, now, quick);
                    assert_eq!(takes, TABLE[rows[0]].takes, "{target} {before} {now} {quick}");
                }
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 0), "{seen:?}");
}

/// A control and a parameter that takes what is set at the end of each step.
struct Bench {
    pickup: Pickup,
    parameter: f64,
    step: u64,
    secs: f64,
    fine: bool,
}

impl Bench {
    fn new(way: Way, parameter: f64) -> Self {
        let mut pickup = Pickup::default();
        pickup.choose(way);
        Self {
            pickup,
            parameter,
            step: 0,
            secs: 0.0,
            fine: false,
        }
    }

    /// Moves the control through these places, one a step.
    fn moves(&mut self, apart_secs: f64, places: &[f64]) -> f64 {
        for &place in places {
            self.secs += apart_secs;
            self.step += 1;
            self.pickup.look(self.step, Some(self.parameter));
            let moment = Moment {
                secs: self.secs,
                step: self.step,
                target: Some(self.parameter),
                fine: self.fine,
            };
            if let Some(set) = self.pickup.hear(place, moment) {
                self.parameter = set;
            }
            self.pickup.look(self.step + 1, Some(self.parameter));
        }
        self.parameter
    }
}

const SLOW: f64 = 0.2;
const QUICK: f64 = 0.01;

#[test]
fn the_first_value_is_swallowed_even_where_it_is_near() {
    for way in [Way::Pickup, Way::Jump, Way::Scaled, Way::Relative] {
        for place in [0.5, 0.51, 0.9] {
            assert_eq!(Bench::new(way, 0.5).moves(SLOW, &[place]), 0.5, "{way:?} {place}");
        }
    }
}

#[test]
fn a_control_that_says_where_it_is_again_and_again_has_not_moved() {
    for way in [Way::Pickup, Way::Jump, Way::Scaled, Way::Relative] {
        assert_eq!(Bench::new(way, 0.5).moves(QUICK, &[0.9; 20]), 0.5, "{way:?}");
    }
}

#[test]
fn it_takes_hold_where_it_meets_the_value() {
    let mut bench = Bench::new(Way::Pickup, 0.5);
    assert_eq!(bench.moves(SLOW, &[0.1, 0.2, 0.3, 0.4, 0.45]), 0.5);
    assert!(!bench.pickup.holds());
    assert_eq!(bench.moves(SLOW, &[0.48]), 0.48);
    assert!(bench.pickup.holds());
    assert_eq!(bench.moves(SLOW, &[0.3, 0.9]), 0.9, "and goes with it from there");
}

/// The reference goes by the time of the last value taken: this control would be left behind.
#[test]
fn after_a_rest_a_quick_turn_takes_its_value_along() {
    let mut bench = Bench::new(Way::Pickup, 0.5);
    bench.moves(SLOW, &[0.4, 0.49]);
    assert!(!takes_hold(0.49, 0.49, 0.8, false), "the table alone swallows it");
    assert_eq!(bench.moves(5.0, &[0.8]), 0.8);
}

/// The reference never catches: nothing was ever taken, so every turn is late.
#[test]
fn a_quick_turn_that_jumps_over_the_value_takes_it_along() {
    let mut bench = Bench::new(Way::Pickup, 0.5);
    assert_eq!(bench.moves(QUICK, &[0.1, 0.3, 0.7]), 0.7);
    assert!(bench.pickup.holds());
    let mut bench = Bench::new(Way::Pickup, 0.5);
    assert_eq!(
        bench.moves(SLOW, &[0.3, 0.7]),
        0.5,
        "two places, not one movement"
    );
}

#[test]
fn switched_while_it_is_not_moved_it_neither_jumps_nor_forgets_where_it_is() {
    // Just taken, then switched to a value elsewhere: the clock of the reference would let the next one through.
    let mut bench = Bench::new(Way::Pickup, 0.5);
    bench.moves(QUICK, &[0.49, 0.5, 0.51]);
    bench.pickup.release();
    bench.parameter = 0.9;
    assert_eq!(bench.moves(QUICK, &[0.52]), 0.9);
    assert_eq!(bench.moves(QUICK, &[0.53, 0.55]), 0.9);
    // Switched to one that happens to stand where the control is: its first movement counts.
    bench.pickup.release();
    bench.parameter = 0.55;
    assert_eq!(bench.moves(SLOW, &[0.56]), 0.56);
}

#[test]
fn what_something_else_moved_is_picked_up_again() {
    let mut bench = Bench::new(Way::Pickup, 0.5);
    bench.moves(SLOW, &[0.49, 0.5, 0.52]);
    bench.parameter = 0.8;
    assert_eq!(bench.moves(SLOW, &[0.53, 0.6]), 0.8);
    assert!(!bench.pickup.holds());
    assert_eq!(bench.moves(SLOW, &[0.79]), 0.79);
}

/// A parameter may stop short of what is set.
#[test]
fn a_value_that_is_cut_off_is_still_held() {
    let mut pickup = Pickup::default();
    let at = |step: u64, target| Moment {
        secs: step as f64,
        step,
        target: Some(target),
        fine: false,
    };
    assert_eq!(pickup.hear(0.4, at(1, 0.42)), None);
    assert_eq!(pickup.hear(0.42, at(2, 0.42)), Some(0.42));
    assert_eq!(pickup.hear(0.9, at(3, 0.42)), Some(0.9));
    assert_eq!(pickup.hear(0.8, at(4, 0.5)), Some(0.8), "it got as far as 0.5");
}

/// Several values within one step, of which the parameter has heard nothing yet.
#[test]
fn within_one_step_it_goes_by_what_it_set() {
    let mut pickup = Pickup::default();
    let at = |secs| Moment {
        secs,
        step: 7,
        target: Some(0.5),
        fine: false,
    };
    let sent: Vec<_> = [0.45, 0.5, 0.6, 0.8, 0.95]
        .iter()
        .map(|&place| pickup.hear(place, at(place)))
        .collect();
    assert_eq!(sent, [None, Some(0.5), Some(0.6), Some(0.8), Some(0.95)]);
}

#[test]
fn the_other_ways_do_what_they_are_called() {
    assert_eq!(Bench::new(Way::Jump, 0.2).moves(SLOW, &[0.8, 0.81]), 0.81);
    let half = Bench::new(Way::Scaled, 0.5).moves(SLOW, &[0.0, 0.5]);
    assert!((half - 0.75).abs() < 1e-12, "{half}");
    let end = Bench::new(Way::Scaled, 0.3).moves(SLOW, &[0.6, 0.5, 0.9, 1.0]);
    assert!((end - 1.0).abs() < 1e-12, "both reach the end: {end}");
    let on = Bench::new(Way::Relative, 0.5).moves(SLOW, &[0.0, 0.2]);
    assert!((on - 0.7).abs() < 1e-12, "{on}");
}

#[test]
fn in_fine_gear_it_goes_a_tenth_and_must_then_be_picked_up() {
    let mut bench = Bench::new(Way::Pickup, 0.5);
    bench.moves(SLOW, &[0.49, 0.5]);
    bench.fine = true;
    assert!((bench.moves(SLOW, &[0.7]) - 0.52).abs() < 1e-12);
    bench.fine = false;
    assert!((bench.moves(SLOW, &[0.75]) - 0.52).abs() < 1e-12);
    // Fine gear needs no hold: nothing steps.
    let mut bench = Bench::new(Way::Pickup, 0.1);
    bench.fine = true;
    assert!((bench.moves(SLOW, &[0.9, 1.0]) - 0.11).abs() < 1e-12);
}

#[test]
fn what_lies_out_of_reach_is_not_fetched() {
    for way in [Way::Pickup, Way::Scaled, Way::Relative] {
        let mut bench = Bench::new(way, 3.0);
        assert_eq!(bench.moves(QUICK, &[0.1, 0.5, 1.0, 0.2, 1.0]), 3.0, "{way:?}");
    }
}

#[test]
fn where_nobody_knows_it_goes_by_what_it_set_last() {
    let mut pickup = Pickup::default();
    let at = |secs: f64| Moment {
        secs,
        step: secs as u64,
        target: None,
        fine: false,
    };
    assert_eq!(pickup.hear(0.2, at(1.0)), None);
    assert_eq!(pickup.hear(0.3, at(2.0)), Some(0.3));
    pickup.lose();
    assert_eq!(pickup.hear(0.8, at(3.0)), None);
    assert_eq!(pickup.hear(0.7, at(4.0)), None, "0.3 is what the network has");
    assert_eq!(pickup.hear(0.31, at(5.0)), Some(0.31));
}

/// What may happen to a control.
#[derive(Clone, Debug)]
enum Event {
    Move { place: f64, apart_secs: f64 },
    Switch { parameter: f64 },
    Replug { place: f64 },
    Elsewhere { parameter: f64 },
}

fn event() -> impl Strategy<Value = Event> {
    let share = || (0..=1000_u32).prop_map(|n| f64::from(n) / 1000.0);
    prop_oneof![
        6 => (share(), prop_oneof![Just(0.005), Just(0.04), Just(0.06), Just(1.0)])
            .prop_map(|(place, apart_secs)| Event::Move { place, apart_secs }),
        1 => share().prop_map(|parameter| Event::Switch { parameter }),
        1 => share().prop_map(|place| Event::Replug { place }),
        1 => share().prop_map(|parameter| Event::Elsewhere { parameter }),
    ]
}

proptest! {
    /// On first touch, after a switch, a return or a change from elsewhere, no parameter goes farther than the hand
    /// did (and the pickup distance): and the first value of all never moves it.
    #[test]
    fn nothing_steps(start in 0.0..=1.0_f64, events in prop::collection::vec(event(), 1..60)) {
        let mut bench = Bench::new(Way::Pickup, start);
        let mut first = true;
        for event in events {
            let (before, place_before) = (bench.parameter, bench.pickup.place());
            match event {
                Event::Move { place, apart_secs } => {
                    let held = bench.pickup.holds();
                    bench.moves(apart_secs, &[place]);
                    let by = (bench.parameter - before).abs();
                    if first {
                        prop_assert_eq!(by, 0.0);
                    }
                    let hand = place_before.map_or(0.0, |it| (place - it).abs());
                    prop_assert!(by <= hand + NEAR + 1e-12, "{by} for {hand}");
                    if !held && apart_secs > MOVEMENT_SECS {
                        prop_assert!(by <= NEAR + 1e-12, "a slow touch took {by}");
                    }
                    first = false;
                }
                Event::Switch { parameter } => {
                    bench.pickup.release();
                    bench.parameter = parameter;
                }
                Event::Replug { place } => {
                    bench.pickup.lose();
                    bench.moves(SLOW, &[place]);
                    prop_assert_eq!(bench.parameter, before);
                    first = false;
                }
                Event::Elsewhere { parameter } => bench.parameter = parameter,
            }
        }
    }
}
