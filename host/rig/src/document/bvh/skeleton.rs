//! The skeleton of a BVH file: joints with offsets, and channels in the file's own order.
//!
//! Source: Biovision's BVH format as described by Meredith and Maddock, "Motion Capture File Formats
//! Explained" (University of Sheffield, CS-01-11), section 2.

use glam::{DMat3, DVec3};

/// One column of the motion section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// A coordinate of the joint's position: axis 0, 1, 2 for x, y, z.
    Position(u8),
    /// A rotation about one axis of the joint: axis 0, 1, 2 for x, y, z.
    Rotation(u8),
}

/// The words of the format, with what they mean.
pub(super) const CHANNEL_WORDS: [(&str, Channel); 6] = [
    ("Xposition", Channel::Position(0)),
    ("Yposition", Channel::Position(1)),
    ("Zposition", Channel::Position(2)),
    ("Xrotation", Channel::Rotation(0)),
    ("Yrotation", Channel::Rotation(1)),
    ("Zrotation", Channel::Rotation(2)),
];

impl Channel {
    /// The word that stands for it in a file.
    pub fn word(self) -> &'static str {
        CHANNEL_WORDS
            .iter()
            .find(|(_, channel)| *channel == self)
            .map_or("", |&(word, _)| word)
    }
}

/// How position channels of a joint below the root are to be read; programs disagree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PositionStyle {
    /// Added to `OFFSET`: all zero for a rigid skeleton.
    #[default]
    Added,
    /// Instead of `OFFSET`: always repeating it for a rigid skeleton.
    Repeated,
}

/// A joint and the bone that begins at it.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonJoint {
    /// The name as written, which may hold spaces.
    pub name: String,
    /// Index of the joint it hangs on; joints come after their parents.
    pub parent: Option<usize>,
    /// Its place in the parent's axes.
    pub offset: DVec3,
    /// Its columns, in order.
    pub channels: Vec<Channel>,
    /// `End Site` offsets below it.
    pub ends: Vec<DVec3>,
    /// What its position channels mean; of no consequence at the root.
    pub positions: PositionStyle,
}

impl SkeletonJoint {
    /// The order of its three rotations, or `None` when it does not rotate.
    pub fn rotation_axes(&self) -> Option<[u8; 3]> {
        let mut axes = self.channels.iter().filter_map(|channel| match channel {
            Channel::Rotation(axis) => Some(*axis),
            Channel::Position(_) => None,
        });
        Some([axes.next()?, axes.next()?, axes.next()?])
    }
}

/// All joints in the order of the file, which is the order of its columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    /// Joints; the first is the root.
    pub joints: Vec<SkeletonJoint>,
}

/// Links of joints without extent get this share of the figure's height as a length, so that they can be
/// seen and picked.
const NOMINAL_SHARE: f64 = 0.01;

/// Offsets shorter than this share of the figure's height give no direction.
const NO_EXTENT_SHARE: f64 = 1e-6;

impl Skeleton {
    /// Number of columns of the motion section.
    pub fn column_count(&self) -> usize {
        self.joints.iter().map(|joint| joint.channels.len()).sum()
    }

    /// Largest extent, along any axis, of the skeleton with all rotations zero; 1 if it has none.
    pub fn height(&self) -> f64 {
        let mut places = Vec::with_capacity(self.joints.len());
        let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
        for joint in &self.joints {
            let place: DVec3 = joint
                .parent
                .map_or(DVec3::ZERO, |parent| places[parent] + joint.offset);
            places.push(place);
            for point in std::iter::once(place).chain(joint.ends.iter().map(|end| place + *end)) {
                low = low.min(point);
                high = high.max(point);
            }
        }
        let extent = (high - low).max_element();
        if extent > 0.0 { extent } else { 1.0 }
    }

    /// For each joint the bone in its axes: towards the first child, or end, that lies apart from it.
    /// Joints without such a child get a short nominal bone along their own z axis.
    pub fn bones(&self) -> Vec<DVec3> {
        let height = self.height();
        let mut bones: Vec<Option<DVec3>> = vec![None; self.joints.len()];
        for joint in &self.joints {
            if let Some(parent) = joint.parent
                && bones[parent].is_none()
                && joint.offset.length() > NO_EXTENT_SHARE * height
            {
                bones[parent] = Some(joint.offset);
            }
        }
        let own = |(joint, bone): (&SkeletonJoint, Option<DVec3>)| {
            let apart = |end: &&DVec3| end.length() > NO_EXTENT_SHARE * height;
            bone.or_else(|| joint.ends.iter().find(apart).copied())
                .unwrap_or(DVec3::Z * (NOMINAL_SHARE * height))
        };
        self.joints.iter().zip(bones).map(own).collect()
    }
}

/// The constant rotation from link axes (z along the bone) to joint axes.
///
/// Source of the other two axes: Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 6, 2017),
/// which is well conditioned for every direction and the identity for z.
pub fn joint_from_link(bone: DVec3) -> DMat3 {
    let z = bone.normalize_or(DVec3::Z);
    let (x, y) = z.any_orthonormal_pair();
    DMat3::from_cols(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(parent: Option<usize>, offset: [f64; 3], ends: &[[f64; 3]]) -> SkeletonJoint {
        SkeletonJoint {
            name: "j".into(),
            parent,
            offset: offset.into(),
            channels: Vec::new(),
            ends: ends.iter().map(|&end| end.into()).collect(),
            positions: PositionStyle::Added,
        }
    }

    #[test]
    fn bones_lead_to_the_first_child_that_is_apart() {
        let skeleton = Skeleton {
            joints: vec![
                joint(None, [5.0, 0.0, 0.0], &[]),
                joint(Some(0), [0.0, 0.0, 0.0], &[]),
                joint(Some(0), [0.0, 2.0, 0.0], &[[0.0, 3.0, 0.0]]),
            ],
        };
        assert_eq!(skeleton.height(), 5.0);
        assert_eq!(
            skeleton.bones(),
            [DVec3::Y * 2.0, DVec3::Z * 0.05, DVec3::Y * 3.0]
        );
    }

    #[test]
    fn link_axes_are_a_rotation_with_z_along_the_bone() {
        for bone in [
            DVec3::Z,
            DVec3::NEG_Z,
            DVec3::X,
            DVec3::new(1e-9, 0.0, -1.0),
            DVec3::new(1.0, -2.0, 0.5),
        ] {
            let axes = joint_from_link(bone);
            assert!((axes.z_axis - bone.normalize_or_zero()).length() < 1e-9, "{bone}");
            assert!(
                (axes.transpose() * axes - DMat3::IDENTITY)
                    .to_cols_array()
                    .iter()
                    .all(|e| e.abs() < 1e-12)
            );
            assert!((axes.determinant() - 1.0).abs() < 1e-12);
        }
    }
}
