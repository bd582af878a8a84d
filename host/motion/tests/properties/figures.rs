//! Figures: directions of length one, circles in a plane, cursors met, clips that are what their keys say.

use glam::{DMat3, DVec2, DVec3};
use motion::figure::posing::{self, Side, Sight, View};
use motion::figure::{GreatCircle, Sweep, Zyz, frame_of, matrix_from_zyz};
use motion::{
    Clip, ClipWarning, DirectionLaw, Figure, FigureKey, FigurePose, Keyframes, LinkPose, LinkSpec, TwistLaw,
};
use proptest::prelude::*;
use std::sync::Arc;

const DIRECTION_LAWS: [DirectionLaw; 2] = [DirectionLaw::Chord, DirectionLaw::Constant];
const TWIST_LAWS: [TwistLaw; 2] = [TwistLaw::Transport, TwistLaw::Zyz];

fn vector() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn direction() -> impl Strategy<Value = DVec3> {
    let axis = prop::sample::select(vec![
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        -DVec3::X,
        -DVec3::Y,
        -DVec3::Z,
    ]);
    prop_oneof![4 => vector().prop_filter("has a direction", |v| v.length() > 0.1), 1 => axis]
}

fn link_pose() -> impl Strategy<Value = LinkPose> {
    (direction(), -12.0..12.0_f64, 0.1..2.0_f64).prop_map(|(direction, twist_rad, length)| LinkPose {
        direction,
        twist_rad,
        length,
    })
}

/// A trunk with two arms of two links each.
fn figure() -> Arc<Figure> {
    let link = |number, children: &[(u32, DVec3)]| LinkSpec {
        number,
        dof: 3,
        length: 0.5,
        children: children.to_vec(),
        ..LinkSpec::default()
    };
    let shoulders = [(1, DVec3::new(0.2, 0.0, 0.4)), (3, DVec3::new(-0.2, 0.1, 0.4))];
    let elbow = DVec3::new(0.0, 0.0, 0.5);
    let specs = [
        link(0, &shoulders),
        link(1, &[(2, elbow)]),
        link(2, &[]),
        link(3, &[(4, elbow)]),
        link(4, &[]),
    ];
    Arc::new(Figure::new(&specs).expect("valid").0)
}

fn keyframes(keys: usize) -> impl Strategy<Value = Keyframes> {
    let pose = (vector(), prop::collection::vec(link_pose(), 5));
    let key = (0.1..2.0_f64, pose);
    (prop::collection::vec(key, 1..keys), 0..2_usize, 0..2_usize).prop_map(|(keys, direction, twist)| {
        let mut secs = 0.0;
        let keys = keys
            .into_iter()
            .map(|(step, (root, links))| {
                secs += step;
                FigureKey {
                    secs,
                    pose: FigurePose { root, links },
                }
            })
            .collect();
        let (direction_law, twist_law) = (DIRECTION_LAWS[direction], TWIST_LAWS[twist]);
        Keyframes {
            keys,
            direction_law,
            twist_law,
            ..Keyframes::new(figure())
        }
    })
}

proptest! {
    #![proptest_config(super::cases(96))]

    #[test]
    fn directions_are_units_on_one_great_circle(from in direction(), to in direction(), s in 0.0..=1.0_f64) {
        let aside = frame_of(from.normalize_or_zero()).x_axis;
        for law in DIRECTION_LAWS {
            let circle = GreatCircle::between(from, to, aside, law).expect("directions");
            let at = circle.direction(s);
            prop_assert!((at.length() - 1.0).abs() < 1e-14);
            let normal = circle.from().cross(circle.towards());
            prop_assert!(at.dot(normal).abs() < 1e-14);
            prop_assert!(circle.direction(0.0).abs_diff_eq(from.normalize_or_zero(), 1e-14));
            prop_assert!(circle.direction(1.0).abs_diff_eq(to.normalize_or_zero(), 1e-8));
            // Progress and speed belong together.
            let h = 1e-6;
            let by_difference = (circle.progress_rad(s + h) - circle.progress_rad(s - h)) / (2.0 * h);
            prop_assert!((by_difference - circle.speed(s)).abs() < 1e-3 * (1.0 + circle.speed(s)));
        }
    }

    #[test]
    fn sweeps_meet_both_keys_and_stay_rotations(from in link_pose(), to in link_pose(), s in 0.0..=1.0_f64) {
        let pose_frame = |pose: &LinkPose| {
            frame_of(pose.direction.normalize_or_zero()) * DMat3::from_rotation_z(pose.twist_rad)
        };
        for direction_law in DIRECTION_LAWS {
            for twist_law in TWIST_LAWS {
                let sweep = Sweep::between(&from, &to, direction_law, twist_law).expect("directions");
                prop_assert!(sweep.frame(0.0).abs_diff_eq(pose_frame(&from), 1e-9));
                prop_assert!(sweep.frame(1.0).abs_diff_eq(pose_frame(&to), 1e-7));
                let frame = sweep.frame(s);
                prop_assert!((frame.transpose() * frame).abs_diff_eq(DMat3::IDENTITY, 1e-12));
                prop_assert!(frame.determinant() > 0.0);
            }
        }
    }

    #[test]
    fn transport_never_jumps(from in link_pose(), to in link_pose(), s in 0.0..0.999_f64) {
        let sweep = Sweep::between(&from, &to, DirectionLaw::Constant, TwistLaw::Transport).expect("directions");
        let step = 1e-3;
        let gap = sweep.frame(s).transpose() * sweep.frame(s + step);
        let turned = ((gap.x_axis.x + gap.y_axis.y + gap.z_axis.z - 1.0) / 2.0).clamp(-1.0, 1.0).acos();
        // Half a turn of direction, and the twist's own change with at most half a turn of holonomy.
        let fastest = 2.0 * std::f64::consts::PI + (to.twist_rad - from.twist_rad).abs();
        prop_assert!(turned <= fastest * step * 1.01 + 1e-6, "{} in a thousandth", turned);
    }

    #[test]
    fn a_clip_places_what_it_samples(keyframes in keyframes(6), share in -0.1..1.1_f64) {
        let clip = Clip::build(&keyframes).expect("sound keys");
        let secs = clip.start_secs() + share * clip.duration_secs();
        let (mut pose, mut by_pose, mut placed) = (FigurePose::default(), Vec::new(), Vec::new());
        clip.sample(secs, &mut pose);
        clip.figure().place(&pose, &mut by_pose);
        clip.place(secs, &mut placed);
        prop_assert_eq!(placed.len(), clip.figure().len());
        for (a, b) in placed.iter().zip(&by_pose) {
            prop_assert!(a.start.abs_diff_eq(b.start, 1e-7) && a.end.abs_diff_eq(b.end, 1e-7));
            prop_assert!(a.world_from_link.abs_diff_eq(b.world_from_link, 1e-7));
        }
    }

    #[test]
    fn a_clip_is_its_sweeps_and_meets_its_keys(keyframes in keyframes(5), s in 0.0..=1.0_f64) {
        let clip = Clip::build(&keyframes).expect("sound keys");
        let mut placed = Vec::new();
        for (j, key) in keyframes.keys.iter().enumerate() {
            clip.place(key.secs, &mut placed);
            for (link, at) in key.pose.links.iter().zip(&placed) {
                prop_assert!((at.end - at.start).abs_diff_eq(link.direction.normalize_or_zero() * link.length, 1e-7));
            }
            let Some(next) = keyframes.keys.get(j + 1) else { continue };
            let secs = key.secs + s * (next.secs - key.secs);
            let u = clip.kinetics().u(secs).clamp(0.0, clip.kinetics().last_key() as f64);
            let interval = (u as usize).min(clip.kinetics().last_key() - 1);
            let (from, to) = (&keyframes.keys[interval].pose, &keyframes.keys[interval + 1].pose);
            clip.place(secs, &mut placed);
            for ((from, to), at) in from.links.iter().zip(&to.links).zip(&placed) {
                let sweep = Sweep::between(from, to, keyframes.direction_law, keyframes.twist_law).expect("sound");
                prop_assert!(at.world_from_link.abs_diff_eq(sweep.frame(u - interval as f64), 1e-12));
            }
        }
    }

    #[test]
    fn a_posed_link_ends_nearest_to_the_sight_line(
        start in vector(), length in 0.1..2.0_f64, turns in vector(), centre in vector(),
        scale in 10.0..500.0_f64, cursor in (-300.0..300.0_f64, -300.0..300.0_f64), others in prop::collection::vec(direction(), 40),
    ) {
        let view_from_world = matrix_from_zyz(Zyz { azimuth_rad: turns.x * 3.0, polar_rad: turns.y * 3.0, twist_rad: turns.z * 3.0 });
        let view = View { view_from_world, centre, scale };
        let cursor = DVec2::new(cursor.0, cursor.1);
        let answer = posing::aim(&view, start, length, cursor).expect("sound");
        let miss = |direction: DVec3| view.screen(start + direction * length).distance(cursor) / scale;
        for side in [Side::Near, Side::Far] {
            let direction = answer.direction(side);
            prop_assert!((direction.length() - 1.0).abs() < 1e-12);
            prop_assert!(others.iter().all(|other| miss(direction) <= miss(other.normalize_or_zero()) + 1e-12));
            if answer.sight == Sight::Inside {
                prop_assert!(miss(direction) < 1e-12);
            }
        }
        prop_assert!((view_from_world * answer.near).z >= (view_from_world * answer.far).z);
    }
}

#[test]
fn a_link_that_turns_right_round_is_reported_under_both_laws() {
    let figure = figure();
    let key = |secs, direction| {
        let mut pose = figure.rest_pose();
        pose.links[2].direction = direction;
        FigureKey { secs, pose }
    };
    for direction_law in DIRECTION_LAWS {
        let keys = vec![key(0.0, DVec3::X), key(1.0, -DVec3::X)];
        let keyframes = Keyframes {
            keys,
            direction_law,
            ..Keyframes::new(Arc::clone(&figure))
        };
        let clip = Clip::build(&keyframes).expect("sound keys");
        assert_eq!(
            clip.warnings(),
            [ClipWarning::Ambiguous {
                key: 0,
                link: motion::LinkIndex(2)
            }]
        );
        let mut placed = Vec::new();
        clip.place(0.5, &mut placed);
        // Own x of a link along +x, untwisted, is -z.
        assert!(placed[2].world_from_link.z_axis.abs_diff_eq(-DVec3::Z, 1e-15));
    }
}

#[test]
fn children_move_with_their_parent_and_never_turn() {
    let figure = figure();
    let (mut before, mut after) = (Vec::new(), Vec::new());
    let mut pose = figure.rest_pose();
    figure.place(&pose, &mut before);
    pose.links[0].direction = DVec3::X;
    figure.place(&pose, &mut after);
    for link in 1..figure.len() {
        assert_eq!(before[link].world_from_link, after[link].world_from_link);
        assert_ne!(before[link].start, after[link].start);
    }
}
