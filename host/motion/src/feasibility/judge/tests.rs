//! Judged against closed forms: what is known exactly must be found exactly.

use std::sync::Arc;

use super::super::{CORNER_RAD, Slowing, Timing};
use super::*;
use crate::curve::Interval;
use crate::joint_track::{JointKey, keyed};
use crate::kinetics::{Kinetics, KineticsMode, Ordering};

fn limits(range: f64, speed: f64, accel: f64) -> Arc<[JointLimits]> {
    Arc::new([JointLimits {
        range_rad: Interval::new(-range, range),
        speed_max_rad_per_s: speed,
        accel_max_rad_per_s2: accel,
    }])
}

fn track(keys: &[(f64, f64)], mode: KineticsMode) -> JointTrack {
    let keys: Vec<JointKey> = keys
        .iter()
        .map(|&(secs, angle)| JointKey {
            secs,
            angles_rad: [("a".to_owned(), angle)].into(),
        })
        .collect();
    let times: Vec<f64> = keys.iter().map(|key| key.secs).collect();
    JointTrack {
        path: Arc::new(keyed(&["a".to_owned()], &[0.0], &keys.iter()).expect("a path")),
        kinetics: Kinetics::new(&times, mode).expect("kinetics"),
    }
}

fn one(found: &[Stretch], kind: Kind) -> Stretch {
    let of_kind: Vec<&Stretch> = found.iter().filter(|s| s.kind == kind).collect();
    assert_eq!(of_kind.len(), 1, "{kind:?}: {found:?}");
    *of_kind[0]
}

#[test]
fn a_straight_way_is_as_fast_as_its_chord() {
    let swing = track(&[(1.0, 0.0), (3.0, 1.0)], KineticsMode::Natural);
    assert!(Judge::whole(&swing, limits(2.0, 0.5, 1e9), None).is_empty());
    let found = Judge::whole(&swing, limits(2.0, 0.4, 1e9), None);
    let speed = one(&found, Kind::Speed);
    assert!((speed.factor - 1.25).abs() < 1e-9 && (speed.from_secs, speed.to_secs) == (1.0, 3.0));
    assert_eq!(speed.slow_down, Some(speed.factor));
}

#[test]
fn ends_are_corners() {
    // Half a radian a second begins and ends at once.
    let swing = track(&[(0.0, 0.0), (2.0, 1.0)], KineticsMode::Natural);
    let asked = 0.25 / (8.0 * CORNER_RAD);
    assert!(Judge::whole(&swing, limits(2.0, 1.0, asked * 1.001), None).is_empty());
    let found = Judge::whole(&swing, limits(2.0, 1.0, 0.5), None);
    assert_eq!(found.len(), 2);
    assert!((found[0].factor - asked / 0.5).abs() < 1e-9);
    // The blend takes a second, half of it on either side.
    assert!((found[1].from_secs - 1.5).abs() < 1e-9 && (found[1].to_secs - 2.5).abs() < 1e-9);
}

#[test]
fn a_peak_between_frames_is_not_missed() {
    // Natural cubic through 0, 1, 0 at even keys 8 ms apart: no film frame and no player cycle falls inside.
    // Its speed is largest at both ends, 1.5 a key interval, and its acceleration in the middle, 3 a square.
    let flick = track(&[(0.0, 0.0), (0.008, 0.01), (0.016, 0.0)], KineticsMode::Natural);
    let found = Judge::whole(&flick, limits(1.0, 1.0, 100.0), None);
    let speed: Vec<&Stretch> = found.iter().filter(|s| s.kind == Kind::Speed).collect();
    assert_eq!(speed.len(), 2, "{found:?}");
    for speed in speed {
        assert!((speed.factor - 1.5 * 0.01 / 0.008).abs() < 1e-6);
    }
    let accel = one(&found, Kind::Acceleration);
    assert!(
        (accel.factor - 3.0 * 0.01 / 0.008_f64.powi(2) / 100.0).abs() < 1e-4,
        "{accel:?}"
    );
}

#[test]
fn an_overshoot_beyond_the_range_is_out_of_reach_though_no_key_is() {
    let keys = [(0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 0.0)];
    let over = track(&keys, KineticsMode::Natural);
    let found = Judge::whole(&over, limits(1.05, 1e9, 1e9), None);
    let reach = one(&found, Kind::Reach);
    // Between two keys of the same angle its top is in the middle, by symmetry.
    let mut top = [0.0];
    over.angles(1.5, &mut top);
    assert!((reach.factor - top[0] / (1.05 + 1e-5)).abs() < 1e-9 && reach.slow_down.is_none());
    assert!(reach.from_secs > 1.0 && reach.to_secs < 2.0);
    assert!((reach.from_secs + reach.to_secs - 3.0).abs() < 1e-3);
}

#[test]
fn what_is_found_is_what_a_dense_look_finds() {
    let keys = [
        (0.0, 0.0),
        (1.0, 0.05),
        (1.4, 0.8),
        (1.8, -0.2),
        (2.7, 0.9),
        (4.2, 0.85),
    ];
    for mode in [
        KineticsMode::Natural,
        KineticsMode::Monotone,
        KineticsMode::Linear,
    ] {
        let track = track(&keys, mode);
        let (mut fastest, mut hardest, dt) = (0.0_f64, 0.0_f64, 1e-5);
        let at = |secs: f64| {
            let mut angle = [0.0];
            track.angles(secs, &mut angle);
            angle[0]
        };
        let corner = |secs: f64| keys.iter().any(|key| (key.0 - secs).abs() < 2.0 * dt);
        for i in 2..419_998 {
            let secs = f64::from(i) * dt;
            if !corner(secs) {
                fastest = fastest.max((at(secs + dt) - at(secs - dt)).abs() / (2.0 * dt));
                hardest = hardest.max((at(secs + dt) + at(secs - dt) - 2.0 * at(secs)).abs() / (dt * dt));
            }
        }
        let found = Judge::whole(&track, limits(9.0, fastest / 2.0, 1e9), None);
        let speed = found.iter().map(|s| s.factor).fold(0.0, f64::max);
        assert!((speed - 2.0).abs() < 1e-3, "{mode:?}: {speed}");
        if mode == KineticsMode::Natural {
            let found = Judge::whole(&track, limits(9.0, 1e9, hardest / 2.0), None);
            let accel = found.iter().filter(|s| s.from_secs > 0.01 && s.to_secs < 4.1);
            let accel = accel.map(|s| s.factor).fold(0.0, f64::max);
            assert!((accel - 2.0).abs() < 1e-2, "{accel}");
        }
    }
}

#[test]
fn judged_in_pieces_is_judged_the_same() {
    let keys = [
        (0.0, 0.0),
        (0.3, 0.8),
        (0.5, -0.2),
        (1.4, 0.9),
        (1.5, 0.85),
        (2.5, 0.0),
    ];
    let track = track(&keys, KineticsMode::Natural);
    let limits = limits(0.7, 1.0, 10.0);
    let mut judge = Judge::new(Arc::clone(&limits), None);
    let pieces = std::iter::from_fn(|| Some(judge.advance(&track, 1)))
        .flatten()
        .next();
    assert_eq!(pieces, Some(Judge::whole(&track, limits, None)));
}

#[test]
fn slowed_to_fit_it_fits_and_the_path_is_the_same() {
    let keys = [
        (0.0, 0.0),
        (0.6, 0.8),
        (1.0, -0.2),
        (1.9, 0.9),
        (2.3, 0.85),
        (4.0, 0.0),
        (5.0, 0.3),
        (6.0, 0.4),
        (7.0, 0.5),
    ];
    for mode in [
        KineticsMode::Natural,
        KineticsMode::Monotone,
        KineticsMode::Linear,
    ] {
        let fast = track(&keys, mode);
        let limits = limits(2.0, 1.2, 10.0);
        let whole = Judge::whole(&fast, Arc::clone(&limits), None);
        let most = whole.iter().filter_map(|s| s.slow_down).fold(1.0, f64::max);
        assert!(most > 2.0);
        let timing = Timing {
            mode,
            edits: Vec::new(),
            ordering: Ordering::Free,
        };
        let times = keys.iter().map(|key| key.0).collect();
        let mut slowing = Slowing::new(
            Arc::clone(&fast.path),
            timing.clone(),
            times,
            Arc::clone(&limits),
            None,
        )
        .expect("begins");
        let times = (0..1000)
            .find_map(|_| slowing.advance(100))
            .expect("ends")
            .expect("fits");
        let slow = JointTrack {
            path: Arc::clone(&fast.path),
            kinetics: timing.kinetics(&times).expect("kinetics"),
        };
        let left = Judge::whole(&slow, limits, None);
        assert!(left.is_empty(), "{mode:?}: {left:?}");
        // Cheaper than slowing all of it, since most of it is slow enough.
        assert!(times[8] < 7.0 * most * 0.8, "{mode:?}: {times:?} by {most}");
        assert!(times.windows(2).all(|pair| pair[1] > pair[0]));
    }
}
