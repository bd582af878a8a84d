//! Timing: the chain rule, and time that runs forward where it must.

use motion::{Curve, Kinetics, KineticsMode, Natural, Ordering, Track};
use proptest::prelude::*;

fn times(steps: &[f64]) -> Vec<f64> {
    let mut secs = 0.0;
    steps
        .iter()
        .map(|step| {
            secs += step;
            secs
        })
        .collect()
}

fn never_falls(kinetics: &Kinetics) -> bool {
    let domain = kinetics.domain();
    let at = |i: i32| kinetics.u(domain.start + domain.length() * f64::from(i) / 500.0);
    (1..=500).all(|i| at(i) >= at(i - 1) - 1e-12)
}

proptest! {
    #![proptest_config(super::cases(128))]

    #[test]
    fn velocity_and_acceleration_obey_the_chain_rule(
        steps in prop::collection::vec(0.3..1.0_f64, 3..9),
        values in prop::collection::vec(-3.0..3.0_f64, 9),
        share in 0.01..0.99_f64,
    ) {
        let times = times(&steps);
        let keys: Vec<f64> = (0..times.len()).map(|j| j as f64).collect();
        let kinetics = Kinetics::new(&times, KineticsMode::Natural).expect("valid");
        let (domain, last) = (kinetics.domain(), kinetics.last_key() as f64);
        let track = Track { path: Natural::new(&keys, &values[..times.len()]).expect("valid"), kinetics };
        let (t, h) = (domain.start + share * domain.length(), 1e-5);
        // A held end has a corner, where a difference means nothing.
        let inside = |t: f64| (1e-3..last - 1e-3).contains(&track.kinetics.u(t));
        prop_assume!(inside(t - h) && inside(t + h));
        let velocity = (track.value(t + h) - track.value(t - h)) / (2.0 * h);
        let acceleration = (track.velocity(t + h) - track.velocity(t - h)) / (2.0 * h);
        prop_assert!((track.velocity(t) - velocity).abs() < 1e-4 * (1.0 + velocity.abs()));
        prop_assert!((track.acceleration(t) - acceleration).abs() < 1e-2 * (1.0 + acceleration.abs()));
    }

    #[test]
    fn monotone_kinetics_never_run_backwards(steps in prop::collection::vec(0.01..4.0_f64, 1..12)) {
        let times = times(&steps);
        let kinetics = Kinetics::new(&times, KineticsMode::Monotone).expect("valid");
        prop_assert!(never_falls(&kinetics));
        prop_assert!(kinetics.reversals().is_empty());
        for (j, &t) in times.iter().enumerate() {
            prop_assert_eq!(kinetics.u(t), j as f64);
        }
    }

    #[test]
    fn monotone_is_natural_where_that_is_tame(steps in prop::collection::vec(1.0..1.5_f64, 1..12)) {
        let times = times(&steps);
        let natural = Kinetics::new(&times, KineticsMode::Natural).expect("valid");
        let monotone = Kinetics::new(&times, KineticsMode::Monotone).expect("valid");
        for i in 0..=200 {
            let t = times[0] + natural.domain().length() * f64::from(i) / 200.0;
            prop_assert_eq!(natural.u(t), monotone.u(t));
        }
    }

    #[test]
    fn ordered_coefficients_never_run_backwards(
        steps in prop::collection::vec(0.05..3.0_f64, 2..10),
        edits in prop::collection::vec((any::<prop::sample::Index>(), -3.0..3.0_f64), 0..5),
    ) {
        let plain = Kinetics::new(&times(&steps), KineticsMode::Natural).expect("valid");
        let free = plain.coefficients().len() - 2;
        let edits: Vec<(usize, f64)> = edits.iter().map(|(i, by)| (1 + i.index(free), *by)).collect();
        let kinetics = plain.edited(&edits, Ordering::KeepForward).expect("valid");
        prop_assert!(never_falls(&kinetics));
        prop_assert!(kinetics.coefficients().is_sorted());
        prop_assert_eq!(kinetics.u(kinetics.domain().end), kinetics.last_key() as f64);
    }

    #[test]
    fn reversals_and_first_reaches_are_what_sampling_finds(
        steps in prop::collection::vec(0.05..3.0_f64, 2..9),
        edit in -2.0..2.0_f64,
    ) {
        let plain = Kinetics::new(&times(&steps), KineticsMode::Natural).expect("valid");
        let kinetics = plain.edited(&[(1, edit)], Ordering::Free).expect("valid");
        let domain = kinetics.domain();
        let reversals = kinetics.reversals();
        for i in 0..500 {
            let t = domain.start + domain.length() * (f64::from(i) + 0.5) / 500.0;
            let speed = kinetics.derivative(t, 1);
            let backwards = reversals.iter().any(|r| r.contains(t));
            prop_assert!(speed.abs() < 1e-6 || backwards == (speed < 0.0), "at {}", t);
        }
        for key in 0..=kinetics.last_key() {
            let reached = kinetics.first_reach(key).expect("a key");
            prop_assert!((kinetics.u(reached) - key as f64).abs() < 1e-9);
            for i in 0..200 {
                let t = domain.start + (reached - domain.start) * f64::from(i) / 200.0;
                prop_assert!(kinetics.u(t) < key as f64 + 1e-9, "key {} before {} at {}", key, reached, t);
            }
        }
        prop_assert!(kinetics.first_reach(kinetics.last_key() + 1).is_none());
    }
}

#[test]
fn the_ends_hold() {
    let kinetics = Kinetics::new(&[1.0, 3.0], KineticsMode::Natural).expect("valid");
    let track = Track {
        path: Natural::new(&[0.0, 1.0], &[10.0, 20.0]).expect("valid"),
        kinetics,
    };
    let rows = [
        (0.0, 10.0, 0.0),
        (1.0, 10.0, 5.0),
        (2.0, 15.0, 5.0),
        (3.0, 20.0, 5.0),
        (4.0, 20.0, 0.0),
    ];
    for (t, value, velocity) in rows {
        assert_eq!(
            (track.value(t), track.velocity(t), track.acceleration(t)),
            (value, velocity, 0.0),
            "at {t}"
        );
    }
    assert_eq!(track.path.domain().end, 1.0);
}
