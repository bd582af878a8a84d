//! What a puppet looks like at given joint angles, standing upright: one line a group, and one from each group to
//! the nearer end of the group it hangs from.

use std::sync::Arc;

use glam::DVec3;
use motion::{JointKind, Rigid};

use super::model::{LinkOfModel, Model};
use super::pose_view::{EndHandle, JointHandle};

/// Ends nearer than this need no line between them, metres.
const JOINED_M: f64 = 1e-3;

/// Lines to draw a puppet with.
#[derive(Clone, Debug)]
pub(super) struct Bones {
    model: Arc<Model>,
    /// Reused from call to call.
    placed: Vec<Rigid>,
}

impl Bones {
    pub(super) fn new(model: Arc<Model>) -> Self {
        Self {
            model,
            placed: Vec::new(),
        }
    }

    /// Start and end of every group's link and of the lines that join them, metres, world axes (x right, y up,
    /// z towards the viewer), the base at the origin.
    pub(super) fn at(&mut self, angles_rad: &[f64]) -> Vec<[DVec3; 2]> {
        self.place(angles_rad);
        let line = |link: &LinkOfModel| {
            let frame = self.frame(link);
            [frame.transform_point(link.start), frame.transform_point(link.end)]
        };
        let mut lines: Vec<[DVec3; 2]> = self.model.links.iter().map(line).collect();
        for (index, link) in self.model.links.iter().enumerate() {
            let Some([from, to]) = link.parent.and_then(|parent| lines.get(parent).copied()) else {
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

    /// Where joints and the ends of links can be taken hold of.
    pub(super) fn handles(&mut self, angles_rad: &[f64]) -> (Vec<JointHandle>, Vec<EndHandle>) {
        self.place(angles_rad);
        let chain = &self.model.chain;
        let joints = chain.joints().iter().zip(&self.placed).map(|(joint, placed)| {
            let axis = match joint.kind {
                JointKind::Revolute { axis } => placed.rotation * axis,
                JointKind::Fixed => DVec3::ZERO,
            };
            JointHandle {
                at: placed.translation,
                axis,
            }
        });
        let ends = self.model.links.iter().filter(|link| link.joint.is_some());
        let ends = ends.map(|link| EndHandle {
            link: link.name.clone(),
            at: self.frame(link).transform_point(link.end),
        });
        (joints.collect(), ends.collect())
    }

    fn place(&mut self, angles_rad: &[f64]) {
        let model = &self.model;
        model
            .chain
            .place(&model.world_from_base, angles_rad, &mut self.placed);
    }

    fn frame(&self, link: &LinkOfModel) -> Rigid {
        let joint = link.joint.and_then(|joint| self.placed.get(joint.index()));
        joint.copied().unwrap_or(self.model.world_from_base)
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
        let mut bones = Bones::new(Arc::new(Model::new(profile).expect("it can be drawn")));
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
