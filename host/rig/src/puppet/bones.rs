//! What a puppet looks like at given joint angles, standing upright: one line a group, and one from each group to
//! the nearer end of the group it hangs from.

use device_profiles::PuppetProfile;
use glam::{DQuat, DVec3};
use motion::{Chain, Figure, Rigid};

use super::body::{chain_of, tree_of, upright};

/// Ends nearer than this need no line between them, metres.
const JOINED_M: f64 = 1e-3;

/// Lines to draw a puppet with.
#[derive(Debug)]
pub(super) struct Bones {
    chain: Chain,
    lines: Vec<Bone>,
    /// Reused from call to call.
    placed: Vec<Rigid>,
}

/// The link of one group.
#[derive(Debug)]
struct Bone {
    /// The joint it hangs from; `None` for the base.
    joint: Option<usize>,
    start: DVec3,
    end: DVec3,
    /// The bone it hangs from.
    parent: Option<usize>,
}

impl Bones {
    /// For a profile whose joints make a chain; `None` for others, which cannot be drawn.
    pub(super) fn new(profile: &PuppetProfile) -> Option<Self> {
        let (tree, _) = Figure::new(&tree_of(profile)).ok()?;
        let (chain, _) = chain_of(profile, &tree).ok()?;
        let mut bones: Vec<Bone> = Vec::new();
        let mut joints = 0;
        for group in &profile.groups {
            joints += group.joints.len();
            let parent = group
                .parent
                .as_deref()
                .and_then(|p| profile.groups.iter().position(|g| g.link == p));
            let joint = match (group.joints.len(), parent) {
                (0, Some(parent)) => bones.get(parent)?.joint,
                (0, None) => None,
                _ => Some(joints - 1),
            };
            let tool = Rigid::from_xyz_rpy(
                DVec3::from_array(group.tool_xyz_m),
                DVec3::from_array(group.tool_rpy_rad),
            );
            let end = tool.transform_point(DVec3::Z * group.length_m);
            bones.push(Bone {
                joint,
                start: tool.translation,
                end,
                parent,
            });
        }
        Some(Self {
            chain,
            lines: bones,
            placed: Vec::new(),
        })
    }

    /// Start and end of every group's link and of the lines that join them, metres, world axes (x right, y up, z towards the viewer), the base at
    /// the origin.
    pub(super) fn at(&mut self, angles_rad: &[f64]) -> Vec<[DVec3; 2]> {
        let base = Rigid {
            rotation: DQuat::from_mat3(&upright()),
            translation: DVec3::ZERO,
        };
        self.chain.place(&base, angles_rad, &mut self.placed);
        let frame = |joint: Option<usize>| joint.and_then(|j| self.placed.get(j)).copied().unwrap_or(base);
        let line = |bone: &Bone| {
            let frame = frame(bone.joint);
            [frame.transform_point(bone.start), frame.transform_point(bone.end)]
        };
        let mut lines: Vec<[DVec3; 2]> = self.lines.iter().map(line).collect();
        for (index, bone) in self.lines.iter().enumerate() {
            let Some([from, to]) = bone.parent.and_then(|parent| lines.get(parent).copied()) else {
                continue;
            };
            let start = lines[index][0];
            let nearer = if start.distance_squared(from) <= start.distance_squared(to) {
                from
            } else {
                to
            };
            if nearer.distance(start) > JOINED_M {
                lines.push([nearer, start]);
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::Profiles;

    #[test]
    fn the_marionette_stands_on_two_feet() {
        let profiles = Profiles::builtin();
        let profile = profiles.puppet("marionette").expect("it is shipped");
        let mut bones = Bones::new(profile).expect("it can be drawn");
        let at_rest = bones.at(&vec![0.0; profile.joints().count()]);
        let named = |link: &str| {
            at_rest[profile
                .groups
                .iter()
                .position(|g| g.link == link)
                .expect("a group")]
        };
        let ([_, right], [_, left]) = (named("rf"), named("lf"));
        assert!(
            (right.y - left.y).abs() < 1e-9 && right.y < -0.4,
            "feet at {right} and {left}"
        );
        assert!(right.z > 0.0 && left.z > 0.0, "it looks at the viewer");
        assert!(right.x < 0.0 && left.x > 0.0, "its right is the viewer's left");
    }
}
