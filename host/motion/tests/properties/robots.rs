//! Chains that follow figures within their limits, and clips of angles that interpolate.

use glam::{DQuat, DVec3};
use motion::{
    Chain, Clip, Figure, FigureKey, FigurePose, Group, Interval, Joint, JointClip, JointIndex, JointKind,
    Keyframes, LinkIndex, LinkPose, LinkSpec, Placed, Retarget, RetargetReport, Rigid,
};
use proptest::prelude::*;
use std::sync::Arc;

/// A shoulder of three joints and an elbow of one, hanging from a still base.
fn arm() -> Arc<Chain> {
    let joint = |name: &str, parent: Option<u16>, axis, start, end| Joint {
        name: name.into(),
        parent: parent.map(JointIndex),
        parent_from_joint: Rigid::from_xyz_rpy(DVec3::new(0.0, 0.0, 0.1), DVec3::new(0.1, -0.2, 0.3)),
        kind: JointKind::Revolute { axis },
        range_rad: Interval::new(start, end),
        speed_max_rad_per_s: 4.0,
    };
    let joints = vec![
        joint("yaw", None, DVec3::Z, -1.5, 1.5),
        joint("pitch", Some(0), DVec3::Y, -1.0, 1.2),
        joint("roll", Some(1), DVec3::Z, -1.4, 1.4),
        joint("elbow", Some(2), DVec3::Y, 0.0, 2.0),
    ];
    Arc::new(Chain::new(joints).expect("valid"))
}

fn figure() -> Arc<Figure> {
    let upper = LinkSpec {
        dof: 3,
        length: 0.3,
        children: vec![(1, DVec3::Z * 0.3)],
        ..LinkSpec::default()
    };
    let lower = LinkSpec {
        number: 1,
        dof: 2,
        length: 0.3,
        ..LinkSpec::default()
    };
    Arc::new(Figure::new(&[upper, lower]).expect("valid").0)
}

fn retarget() -> Retarget {
    let group = |link, joints: &[u16]| Group {
        link: LinkIndex(link),
        joints: joints.iter().copied().map(JointIndex).collect(),
        joint_from_link: DQuat::from_rotation_x(0.2),
    };
    Retarget::new(figure(), arm(), None, &[group(1, &[3]), group(0, &[0, 1, 2])]).expect("valid")
}

/// Where the figure's links would be if they lay on the chain at these angles.
fn placed_on_chain(chain: &Chain, angles: &[f64]) -> Vec<Placed> {
    let mut joints = Vec::new();
    chain.place(&Rigid::IDENTITY, angles, &mut joints);
    [2, 3]
        .map(|last: usize| {
            let rotation = joints[last].rotation * DQuat::from_rotation_x(0.2);
            let world_from_link = glam::DMat3::from_quat(rotation);
            Placed {
                start: DVec3::ZERO,
                end: world_from_link.z_axis,
                world_from_link,
            }
        })
        .to_vec()
}

fn share_of_range() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(0.02..0.98_f64, 4)
}

fn angles_at(chain: &Chain, shares: &[f64]) -> Vec<f64> {
    let at = |(joint, share): (&Joint, &f64)| joint.range_rad.start + joint.range_rad.length() * share;
    chain.joints().iter().zip(shares).map(at).collect()
}

fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64)
        .prop_map(|(x, y, z)| DVec3::new(x, y, z))
        .prop_filter("has a direction", |v| v.length() > 0.1)
}

proptest! {
    #![proptest_config(super::cases(48))]

    #[test]
    fn a_reachable_pose_is_reached(shares in share_of_range()) {
        let retarget = retarget();
        let chain = retarget.chain();
        let placed = placed_on_chain(chain, &angles_at(chain, &shares));
        let (mut angles, mut report) = (chain.rest_angles(), RetargetReport::default());
        retarget.begin(&placed, &mut angles, &mut report);
        // Staying where one is has a weight, whose trace shows where two axes nearly line up.
        prop_assert!(report.direction_error_rad() < 2e-3, "{:?}", report);
        let reached = placed_on_chain(chain, &angles);
        for (want, got) in placed.iter().zip(&reached) {
            prop_assert!(want.world_from_link.z_axis.abs_diff_eq(got.world_from_link.z_axis, 2e-3));
        }
    }

    #[test]
    fn limits_hold_whatever_is_asked(upper in direction(), lower in direction(), twist in -9.0..9.0_f64, shares in share_of_range()) {
        let retarget = retarget();
        let pose = FigurePose {
            root: DVec3::ZERO,
            links: vec![
                LinkPose { direction: upper.normalize_or_zero(), twist_rad: twist, length: 0.3 },
                LinkPose { direction: lower.normalize_or_zero(), twist_rad: 0.0, length: 0.3 },
            ],
        };
        let (mut placed, mut report) = (Vec::new(), RetargetReport::default());
        retarget.figure().place(&pose, &mut placed);
        let mut angles = angles_at(retarget.chain(), &shares);
        retarget.follow(&placed, &mut angles, &mut report);
        for (joint, angle) in retarget.chain().joints().iter().zip(&angles) {
            prop_assert!(joint.range_rad.contains(*angle), "{} at {}", joint.name, angle);
        }
        // Asked again it stays, but for a slow drift along valleys of equal cost.
        let before = angles.clone();
        retarget.follow(&placed, &mut angles, &mut report);
        if !report.switched() {
            prop_assert!(before.iter().zip(&angles).all(|(a, b)| (a - b).abs() < 5e-2), "{:?} {:?}", before, angles);
        }
    }

    #[test]
    fn a_joint_clip_interpolates_and_never_overshoots(
        rows in prop::collection::vec(prop::collection::vec(-2.0..2.0_f64, 2), 1..9),
        period in 0.01..0.5_f64, share in -0.2..1.2_f64,
    ) {
        let clip = JointClip::new(vec!["a".into(), "b".into()], period, rows.concat()).expect("valid");
        let mut angles = [0.0; 2];
        for (index, row) in rows.iter().enumerate() {
            clip.sample(index as f64 * period, &mut angles);
            prop_assert!(angles.iter().zip(row).all(|(got, want)| (got - want).abs() < 1e-12));
        }
        let secs = share * clip.duration_secs();
        clip.sample(secs, &mut angles);
        let at = (secs / period).clamp(0.0, (rows.len() - 1) as f64);
        let (here, next) = (&rows[at as usize], &rows[(at as usize + 1).min(rows.len() - 1)]);
        for joint in 0..2 {
            let (low, high) = (here[joint].min(next[joint]), here[joint].max(next[joint]));
            prop_assert!((low - 1e-12..=high + 1e-12).contains(&angles[joint]));
        }
        // Once differentiable: the slopes on both sides of a row agree.
        if rows.len() > 2 {
            let (mut before, mut after, h) = ([0.0; 2], [0.0; 2], period * 1e-6);
            clip.sample(period, &mut angles);
            clip.sample(period - h, &mut before);
            clip.sample(period + h, &mut after);
            for joint in 0..2 {
                let (left, right) = (angles[joint] - before[joint], after[joint] - angles[joint]);
                prop_assert!((left - right).abs() / 1e-6 < 1e-3, "{} {}", left, right);
            }
        }
    }
}

#[test]
fn a_figure_is_baked_into_a_clip_of_angles() {
    let retarget = retarget();
    let key = |secs: f64, upper: DVec3, lower: DVec3| {
        let mut pose = retarget.figure().rest_pose();
        pose.links[0].direction = upper;
        pose.links[1].direction = lower;
        FigureKey { secs, pose }
    };
    let keys = vec![
        key(2.0, DVec3::Z, DVec3::Z),
        key(3.0, DVec3::new(0.5, 0.0, 1.0), DVec3::X),
        key(3.2, DVec3::new(-0.5, 0.3, 1.0), DVec3::Y),
    ];
    let clip = Clip::build(&Keyframes {
        keys,
        ..Keyframes::new(Arc::clone(retarget.figure()))
    })
    .expect("sound");
    let start = retarget.chain().rest_angles();
    let (baked, report) = JointClip::bake(&clip, &retarget, &start, 0.02).expect("sound");
    assert!(
        JointClip::bake(&clip, &retarget, &start, 1e-9).is_err(),
        "a thousand million rows"
    );
    assert_eq!(baked.rows(), 61);
    assert!((baked.duration_secs() - clip.duration_secs()).abs() < 1e-9);
    assert_eq!(baked.joints(), ["yaw", "pitch", "roll", "elbow"]);
    assert!(
        report.slow_down > 1.0,
        "a fifth of a second is too fast for 4 rad/s: {report:?}"
    );
    assert!(report.fastest.is_some());
    for row in 0..baked.rows() {
        let angles = baked.row(row).expect("a row");
        for (joint, angle) in retarget.chain().joints().iter().zip(angles) {
            assert!(joint.range_rad.contains(*angle));
        }
    }
}

#[test]
fn samples_that_make_no_clip() {
    let names = || vec!["a".to_string(), "b".to_string()];
    let refused = |joints, period, samples: &[f64]| JointClip::new(joints, period, samples.to_vec()).err();
    assert!(refused(vec![], 0.1, &[]).is_some());
    assert!(refused(names(), 0.1, &[1.0]).is_some());
    assert!(refused(names(), 0.1, &[]).is_some());
    assert!(refused(names(), 0.0, &[1.0, 2.0]).is_some());
    let message = refused(names(), 0.1, &[1.0, 2.0, 3.0, f64::NAN]).map(|e| e.to_string());
    assert_eq!(
        message.as_deref(),
        Some("the angle of joint b in row 1 is not finite")
    );
    let held = JointClip::new(names(), 0.1, vec![1.0, 2.0]).expect("one row is a clip");
    let mut angles = [0.0; 2];
    held.sample(f64::NAN, &mut angles);
    assert_eq!(angles, [1.0, 2.0]);
}
