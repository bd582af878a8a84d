//! Thinning: whatever was performed, what is played of the kept keys is nowhere farther off than was asked for.

use glam::DVec3;
use motion::joint_track::{JointTrack, keyed};
use motion::thin::{FigurePerformance, FigureTolerance, JointPerformance, Performance, ThinError, Thinning};
use motion::{
    Clip, DirectionLaw, Figure, FigureKey, FigurePose, JointKey, Keyframes, Kinetics, KineticsMode, LinkPose,
    LinkSpec, TwistLaw,
};
use proptest::prelude::*;
use std::sync::Arc;

fn figure() -> Arc<Figure> {
    let link = |number, children| LinkSpec {
        number,
        name: format!("l{number}"),
        dof: 3,
        length: 0.5,
        children,
    };
    let specs = [link(0, vec![(1, DVec3::Z * 0.5)]), link(1, vec![])];
    Arc::new(Figure::new(&specs).expect("a chain of two").0)
}

fn pose(root: DVec3, turned: [[f64; 3]; 2]) -> FigurePose {
    let link = |[azimuth, polar, twist_rad]: [f64; 3]| LinkPose {
        direction: DVec3::new(
            azimuth.cos() * polar.sin(),
            azimuth.sin() * polar.sin(),
            polar.cos(),
        ),
        twist_rad,
        length: 0.5,
    };
    FigurePose {
        root,
        links: turned.map(link).to_vec(),
    }
}

fn performance(
    keys: &[FigureKey],
    kinetics: KineticsMode,
    twist_law: TwistLaw,
    tolerance: FigureTolerance,
) -> Result<FigurePerformance, ThinError> {
    let laws = Keyframes {
        kinetics,
        twist_law,
        direction_law: DirectionLaw::Constant,
        ..Keyframes::new(figure())
    };
    let seen = keys.iter().map(|key| (key.secs, Arc::new(key.pose.clone())));
    FigurePerformance::new(laws, seen.collect(), tolerance)
}

const TOLERANCE: FigureTolerance = FigureTolerance {
    angle_rad: 0.01,
    distance_m: 0.002,
};

fn thinned<P: Performance>(performance: P, piece: usize) -> Thinning<P> {
    let mut thinning = Thinning::new(performance).expect("it can be played");
    let mut pieces = 0;
    while !thinning.advance(piece).expect("it can be thinned") {
        pieces += 1;
        assert!(pieces < 1_000_000, "it does not end");
    }
    thinning
}

/// Where the links end: seen from outside, without the arithmetic of the judge.
fn ends(pose: &FigurePose) -> Vec<DVec3> {
    let mut placed = Vec::new();
    figure().place(pose, &mut placed);
    placed.iter().map(|link| link.end).collect()
}

/// What sticks out sideways of each link, in the world.
fn sides(pose: &FigurePose) -> Vec<DVec3> {
    let mut placed = Vec::new();
    figure().place(pose, &mut placed);
    placed
        .iter()
        .map(|link| link.world_from_link * DVec3::X)
        .collect()
}

/// A hand's way: steps of changing speed with pauses, jumps now and then.
fn walks() -> impl Strategy<Value = Vec<(f64, [f64; 9])>> {
    let step = (
        1_u32..60,
        prop::array::uniform9(-1.0..1.0_f64),
        prop::sample::select(vec![0.0, 0.002, 0.01, 0.05, 0.3]),
    );
    prop::collection::vec(step, 1..120).prop_map(|steps| {
        let (mut secs, mut at) = (0.0, [0.0, 1.0, 0.0, 1.0, 1.2, 0.0, -1.0, 0.8, 0.0]);
        let walk = |(ms, by, size): (u32, [f64; 9], f64)| {
            secs += f64::from(ms) * 1e-3;
            for (value, by) in at.iter_mut().zip(by) {
                *value += by * size;
            }
            (secs, at)
        };
        steps.into_iter().map(walk).collect()
    })
}

fn keys(walk: &[(f64, [f64; 9])]) -> Vec<FigureKey> {
    let key = |&(secs, v): &(f64, [f64; 9])| FigureKey {
        secs,
        pose: pose(
            DVec3::new(v[0], v[1], v[2]) * 0.1,
            [[v[3], v[4], v[5]], [v[6], v[7], v[8]]],
        ),
    };
    walk.iter().map(key).collect()
}

fn modes() -> impl Strategy<Value = KineticsMode> {
    prop::sample::select(vec![
        KineticsMode::Natural,
        KineticsMode::Monotone,
        KineticsMode::Linear,
    ])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

    #[test]
    fn a_figure_is_nowhere_farther_off_than_tolerated(
        walk in walks(),
        mode in modes(),
        law in prop::sample::select(vec![TwistLaw::Transport, TwistLaw::Zyz]),
        piece in 1_usize..5000,
    ) {
        let all = keys(&walk);
        let done = thinned(performance(&all, mode, law, TOLERANCE).expect("tolerances"), piece);
        let kept: Vec<usize> = done.keys().collect();
        prop_assert_eq!((kept[0], kept[kept.len() - 1]), (0, walk.len() - 1));
        let clip = Clip::build(&done.performance().keyframes(done.keys())).expect("it plays");
        let mut shown = FigurePose::default();
        for key in &all {
            clip.sample(key.secs, &mut shown);
            prop_assert!(shown.root.distance(key.pose.root) <= TOLERANCE.distance_m * (1.0 + 1e-9));
            // A direction that is off by an angle moves the end of a link by no more than that times its length.
            let reach = TOLERANCE.distance_m + 2.0 * 0.5 * TOLERANCE.angle_rad * 2.0;
            for (shown, wanted) in ends(&shown).iter().zip(ends(&key.pose)) {
                prop_assert!(shown.distance(wanted) <= reach, "{} at {} s", shown.distance(wanted), key.secs);
            }
            for (shown, wanted) in shown.links.iter().zip(&key.pose.links) {
                let angle = shown.direction.angle_between(wanted.direction);
                prop_assert!(angle <= TOLERANCE.angle_rad * (1.0 + 1e-6), "{angle} at {} s", key.secs);
                prop_assert!((shown.length - wanted.length).abs() <= TOLERANCE.distance_m * (1.0 + 1e-9));
            }
            // What sticks out of a link at a right angle shows its twist: however a frame is turned, nothing in it turns
            // farther.
            for (shown, wanted) in sides(&shown).iter().zip(sides(&key.pose)) {
                let angle = shown.angle_between(wanted);
                prop_assert!(angle <= TOLERANCE.angle_rad * (1.0 + 1e-6), "twisted {angle} at {} s", key.secs);
            }
        }
        // In pieces or at once is the same.
        let at_once = thinned(performance(&all, mode, law, TOLERANCE).expect("tolerances"), usize::MAX / 2);
        prop_assert_eq!(kept, at_once.keys().collect::<Vec<_>>());
    }

    #[test]
    fn joints_are_nowhere_farther_off_than_tolerated(walk in walks(), mode in modes(), piece in 1_usize..5000) {
        let joints = ["a".to_owned(), "b".to_owned()];
        let key = |&(secs, v): &(f64, [f64; 9])| JointKey {
            secs,
            angles_rad: joints.iter().cloned().zip([v[0], v[4]]).collect(),
        };
        let all: Vec<JointKey> = walk.iter().map(key).collect();
        let performance = JointPerformance::new(joints.to_vec(), all.clone(), mode, 0.01).expect("a tolerance");
        let done = thinned(performance, piece);
        let kept = done.performance().keys(done.keys());
        let times: Vec<f64> = kept.iter().map(|key| key.secs).collect();
        let track = JointTrack {
            path: Arc::new(keyed(&joints, &[], &kept.iter()).expect("a path")),
            kinetics: Kinetics::new(&times, mode).expect("times"),
        };
        let mut shown = [0.0; 2];
        for key in &all {
            track.angles(key.secs, &mut shown);
            for (joint, shown) in joints.iter().zip(shown) {
                prop_assert!((shown - key.angles_rad[joint]).abs() <= 0.01 * (1.0 + 1e-9));
            }
        }
    }
}

/// Two seconds of a hand that lifts, waits and comes back: 400 poses.
fn smooth() -> Vec<FigureKey> {
    let ease = |s: f64| s * s * s * (10.0 - s * (15.0 - 6.0 * s));
    let key = |i: u32| {
        let secs = f64::from(i) * 0.005;
        let up = ease((secs / 0.8).min(1.0)) - ease(((secs - 1.2) / 0.8).clamp(0.0, 1.0));
        FigureKey {
            secs,
            pose: pose(DVec3::ZERO, [[0.3 * up, 1.0, up], [-1.0, 0.4 + 1.2 * up, 0.0]]),
        }
    };
    (0..=400).map(key).collect()
}

#[test]
fn a_smooth_movement_needs_few_keys_and_a_still_one_two() {
    for mode in [KineticsMode::Natural, KineticsMode::Monotone] {
        let all = performance(&smooth(), mode, TwistLaw::Transport, TOLERANCE);
        let done = thinned(all.expect("tolerances"), 1000);
        assert!(
            (4..=40).contains(&done.keys().len()),
            "{mode:?}: {} keys",
            done.keys().len()
        );
    }
    let mut still = smooth();
    let first = still[0].pose.clone();
    for key in &mut still {
        key.pose = first.clone();
    }
    let all = performance(&still, KineticsMode::Natural, TwistLaw::Transport, TOLERANCE);
    let done = thinned(all.expect("tolerances"), 1000);
    assert_eq!(done.keys().collect::<Vec<_>>(), [0, 400]);
}

#[test]
fn wider_tolerances_keep_less() {
    let kept = |angle_rad| {
        let tolerance = FigureTolerance {
            angle_rad,
            ..TOLERANCE
        };
        let all = performance(&smooth(), KineticsMode::Natural, TwistLaw::Transport, tolerance);
        thinned(all.expect("tolerances"), 1000).keys().len()
    };
    let counts = [0.001, 0.01, 0.1].map(kept);
    assert!(counts[0] > counts[1] && counts[1] > counts[2], "{counts:?}");
}

#[test]
fn what_cannot_be_thinned_says_why() {
    let all = |keys: &[FigureKey]| {
        let all = performance(keys, KineticsMode::Natural, TwistLaw::Transport, TOLERANCE);
        all.expect("tolerances")
    };
    assert_eq!(Thinning::new(all(&[])).err(), Some(ThinError::Empty));
    for angle_rad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let tolerance = FigureTolerance {
            angle_rad,
            ..TOLERANCE
        };
        let refused = performance(&smooth(), KineticsMode::Natural, TwistLaw::Transport, tolerance);
        assert!(matches!(refused, Err(ThinError::Tolerance { .. })), "{angle_rad}");
    }
    let mut backwards = smooth();
    backwards.swap(0, 400);
    let mut lost = smooth();
    lost[0].pose.root.x = f64::NAN;
    for keys in [backwards, lost] {
        let refused = Thinning::new(all(&keys)).err();
        assert!(
            matches!(refused, Some(ThinError::Unplayable { .. })),
            "{refused:?}"
        );
    }
    assert_eq!(thinned(all(&smooth()[..1]), 10).keys().collect::<Vec<_>>(), [0]);
}
