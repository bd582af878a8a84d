//! Small forward kinematics of profiles, for tests that ask where links point.

use device_profiles::{PuppetJoint, PuppetProfile};
use std::collections::BTreeMap;

pub(crate) type V = [f64; 3];
pub(crate) type M = [V; 3];

pub(crate) const IDENTITY: M = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

pub(crate) fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn turn(m: M, v: V) -> V {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

pub(crate) fn times(a: M, b: M) -> M {
    let column = |c: usize| turn(a, [b[0][c], b[1][c], b[2][c]]);
    let [x, y, z] = [column(0), column(1), column(2)];
    [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]]
}

/// Rodrigues' formula.
pub(crate) fn about(axis: V, angle: f64) -> M {
    let [x, y, z] = axis;
    let (s, c) = angle.sin_cos();
    let k = 1.0 - c;
    [
        [c + x * x * k, x * y * k - z * s, x * z * k + y * s],
        [y * x * k + z * s, c + y * y * k, y * z * k - x * s],
        [z * x * k - y * s, z * y * k + x * s, c + z * z * k],
    ]
}

pub(crate) fn rpy([roll, pitch, yaw]: V) -> M {
    times(
        about([0.0, 0.0, 1.0], yaw),
        times(about([0.0, 1.0, 0.0], pitch), about([1.0, 0.0, 0.0], roll)),
    )
}

pub(crate) fn close(a: V, b: V) -> bool {
    (0..3).all(|i| (a[i] - b[i]).abs() < 1e-9)
}

/// A link's frame and both its ends.
#[derive(Clone, Copy)]
pub(crate) struct Placed {
    pub(crate) frame: M,
    pub(crate) start: V,
    pub(crate) end: V,
}

impl Placed {
    /// Where the link points: its own z.
    pub(crate) fn direction(&self) -> V {
        turn(self.frame, [0.0, 0.0, 1.0])
    }
}

/// Angles of the joints that do not stand at 0.
pub(crate) type Pose<'a> = &'a [(&'a str, f64)];

/// Forward kinematics; joints not named stand at 0.
pub(crate) fn place(puppet: &PuppetProfile, angles: Pose<'_>) -> BTreeMap<String, Placed> {
    let angle = |joint: &PuppetJoint| {
        angles
            .iter()
            .find(|(n, _)| *n == joint.name)
            .map_or(0.0, |(_, q)| *q)
    };
    let mut ends: BTreeMap<String, (M, V)> = BTreeMap::new();
    let mut placed = BTreeMap::new();
    for group in &puppet.groups {
        let (mut frame, mut at) = group.parent.as_ref().map_or((IDENTITY, [0.0; 3]), |p| ends[p]);
        for joint in &group.joints {
            at = add(at, turn(frame, joint.origin_xyz_m));
            frame = times(
                frame,
                times(rpy(joint.origin_rpy_rad), about(joint.axis, angle(joint))),
            );
        }
        ends.insert(group.link.clone(), (frame, at));
        let start = add(at, turn(frame, group.tool_xyz_m));
        let link = times(frame, rpy(group.tool_rpy_rad));
        let end = add(start, turn(link, [0.0, 0.0, group.length_m]));
        placed.insert(
            group.link.clone(),
            Placed {
                frame: link,
                start,
                end,
            },
        );
    }
    placed
}
