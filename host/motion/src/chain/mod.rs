//! The body that moves: a robot whose rotations are inherited from joint to joint, as in URDF.
//!
//! Not to be confused with [`crate::figure`], whose links know their own directions in the world.
//! Source: the URDF joint element (origin, axis, limit), wiki.ros.org/urdf/XML/joint.

pub mod reach;
mod rigid;

pub use reach::{End, Reached, reach};
pub use rigid::Rigid;

use crate::curve::Interval;
use glam::{DQuat, DVec3};
use thiserror::Error;

/// Which joint of a chain: a parent's index is always smaller than its children's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JointIndex(pub u16);

impl JointIndex {
    /// For indexing slices.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind {
    /// About an axis in the joint's own frame; any length above zero is taken.
    Revolute {
        /// The axis; positive angles turn right-handed about it.
        axis: DVec3,
    },
    /// Not at all; its angle is ignored.
    Fixed,
}

/// One joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its name, unique in the chain.
    pub name: String,
    /// The joint it hangs from; none for those on the base.
    pub parent: Option<JointIndex>,
    /// Where it sits at angle zero.
    pub parent_from_joint: Rigid,
    /// How it moves.
    pub kind: JointKind,
    /// Where it may go, radians.
    pub range_rad: Interval,
    /// How fast it may go, radians per second, above zero; infinite where nobody knows.
    pub speed_max_rad_per_s: f64,
}

/// A joint that follows another: its angle is `ratio` times the other's, plus `offset_rad`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// The joint that is led.
    pub joint: JointIndex,
    /// The joint it follows, which follows none itself.
    pub follows: JointIndex,
    /// Its angle for one radian of the other's; finite, not zero.
    pub ratio: f64,
    /// Its angle where the other's is 0, radians.
    pub offset_rad: f64,
}

/// Why joints make no chain.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ChainError {
    /// Two joints have one name.
    #[error("two joints are called {name}; give each its own name")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A parent must come before its child.
    #[error(
        "joint {joint} hangs from joint number {parent}, which does not come before it; list parents first"
    )]
    ParentAfterChild {
        /// The child's name.
        joint: String,
        /// The index it names.
        parent: u16,
    },
    /// An axis is finite and not zero.
    #[error("joint {joint} turns about {axis}; an axis is finite and not zero")]
    BadAxis {
        /// The joint's name.
        joint: String,
        /// What it says.
        axis: DVec3,
    },
    /// A range has finite ends, the smaller first.
    #[error("joint {joint} ranges from {} to {} rad; a range is finite, the smaller end first", range.start, range.end)]
    BadRange {
        /// The joint's name.
        joint: String,
        /// What it says.
        range: Interval,
    },
    /// A speed is above zero.
    #[error("joint {joint} may turn at {speed} rad/s; a speed is above zero")]
    BadSpeed {
        /// The joint's name.
        joint: String,
        /// What it says.
        speed: f64,
    },
    /// A place is finite.
    #[error("joint {joint} sits at a place that is not finite")]
    NotFinite {
        /// The joint's name.
        joint: String,
    },
    /// A coupling names joints of the chain, of which the leading one is led by nobody, and each is led once.
    #[error(
        "joint number {joint} cannot follow joint number {follows} by {ratio}; a led joint follows one that leads, by a finite ratio other than 0"
    )]
    BadCoupling {
        /// The led joint.
        joint: u16,
        /// The one it follows.
        follows: u16,
        /// Its ratio.
        ratio: f64,
    },
    /// More joints than an index can count.
    #[error("{joints} joints are too many; {} are the most", u16::MAX)]
    TooMany {
        /// How many there are.
        joints: usize,
    },
}

/// A robot's joints. Invariants: parents first; axes are unit vectors; ranges are finite; who leads is not led.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    joints: Vec<Joint>,
    couplings: Vec<Coupling>,
}

impl Chain {
    /// A chain of these joints, parents first.
    pub fn new(mut joints: Vec<Joint>) -> Result<Self, ChainError> {
        if joints.len() > usize::from(u16::MAX) {
            return Err(ChainError::TooMany { joints: joints.len() });
        }
        for index in 0..joints.len() {
            let (before, rest) = joints.split_at_mut(index);
            if let Some(joint) = rest.first_mut() {
                check(before, joint)?;
            }
        }
        Ok(Self {
            joints,
            couplings: Vec::new(),
        })
    }

    /// The same chain with joints that follow others.
    pub fn coupled(self, couplings: Vec<Coupling>) -> Result<Self, ChainError> {
        let wrong = couplings.iter().enumerate().find(|(at, coupling)| {
            let is_led = |joint: JointIndex| couplings.iter().any(|other| other.joint == joint);
            let known = |joint: JointIndex| joint.index() < self.joints.len();
            let twice = couplings[..*at].iter().any(|other| other.joint == coupling.joint);
            let sound =
                coupling.ratio.is_finite() && coupling.ratio != 0.0 && coupling.offset_rad.is_finite();
            !(known(coupling.joint) && known(coupling.follows) && sound) || twice || is_led(coupling.follows)
        });
        if let Some((_, coupling)) = wrong {
            return Err(ChainError::BadCoupling {
                joint: coupling.joint.0,
                follows: coupling.follows.0,
                ratio: coupling.ratio,
            });
        }
        Ok(Self { couplings, ..self })
    }

    /// The joints that follow others.
    pub fn couplings(&self) -> &[Coupling] {
        &self.couplings
    }

    /// Puts every led joint where the one it follows wants it; `angles` as for [`Chain::place`].
    pub fn lead(&self, angles_rad: &mut [f64]) {
        for coupling in &self.couplings {
            if let Some(&leading) = angles_rad.get(coupling.follows.index())
                && let Some(led) = angles_rad.get_mut(coupling.joint.index())
            {
                *led = coupling.ratio * leading + coupling.offset_rad;
            }
        }
    }

    /// What leads a joint, if anything does.
    pub fn led(&self, joint: JointIndex) -> Option<&Coupling> {
        self.couplings.iter().find(|coupling| coupling.joint == joint)
    }

    /// All joints, parents first.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// How many joints there are.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether there is nothing to move.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// The joint of that name.
    pub fn by_name(&self, name: &str) -> Option<JointIndex> {
        self.joints
            .iter()
            .position(|joint| joint.name == name)
            .map(|i| JointIndex(i as u16))
    }

    /// The angles nearest to zero that all joints may have; led ones are where they are led.
    pub fn rest_angles(&self) -> Vec<f64> {
        let mut angles: Vec<f64> = self
            .joints
            .iter()
            .map(|joint| joint.range_rad.clamp(0.0))
            .collect();
        self.lead(&mut angles);
        angles
    }

    /// Forward kinematics: where every joint's frame lies after its own turn, in the chain's order,
    /// replacing what was in `placed`. `angles` are radians, one for each joint; missing ones are zero.
    pub fn place(&self, world_from_base: &Rigid, angles_rad: &[f64], placed: &mut Vec<Rigid>) {
        placed.clear();
        for (index, joint) in self.joints.iter().enumerate() {
            let parent = match joint.parent {
                Some(parent) => placed[parent.index()],
                None => *world_from_base,
            };
            let mut world_from_joint = parent * joint.parent_from_joint;
            if let (JointKind::Revolute { axis }, Some(&angle)) = (joint.kind, angles_rad.get(index)) {
                world_from_joint.rotation *= DQuat::from_axis_angle(axis, angle);
            }
            placed.push(world_from_joint);
        }
    }
}

fn check(before: &[Joint], joint: &mut Joint) -> Result<(), ChainError> {
    let name = || joint.name.clone();
    if before.iter().any(|other| other.name == joint.name) {
        return Err(ChainError::DuplicateName { name: name() });
    }
    if let Some(parent) = joint.parent.filter(|parent| parent.index() >= before.len()) {
        return Err(ChainError::ParentAfterChild {
            joint: name(),
            parent: parent.0,
        });
    }
    if !joint.parent_from_joint.is_finite() {
        return Err(ChainError::NotFinite { joint: name() });
    }
    let range = joint.range_rad;
    if !(range.start.is_finite() && range.end.is_finite() && range.start <= range.end) {
        return Err(ChainError::BadRange { joint: name(), range });
    }
    if joint.speed_max_rad_per_s.is_nan() || joint.speed_max_rad_per_s <= 0.0 {
        return Err(ChainError::BadSpeed {
            joint: name(),
            speed: joint.speed_max_rad_per_s,
        });
    }
    if let JointKind::Revolute { axis } = joint.kind {
        let axis = crate::figure::unit(axis).map_err(|_| ChainError::BadAxis { joint: name(), axis })?;
        joint.kind = JointKind::Revolute { axis };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn joint(name: &str, parent: Option<u16>, kind: JointKind) -> Joint {
        Joint {
            name: name.into(),
            parent: parent.map(JointIndex),
            parent_from_joint: Rigid::from_xyz_rpy(DVec3::X, DVec3::ZERO),
            kind,
            range_rad: Interval::new(-1.0, 2.0),
            speed_max_rad_per_s: 1.0,
        }
    }

    const ABOUT_Z: JointKind = JointKind::Revolute {
        axis: DVec3::new(0.0, 0.0, 2.0),
    };

    #[test]
    fn rotations_are_inherited() {
        let joints = vec![joint("a", None, ABOUT_Z), joint("b", Some(0), JointKind::Fixed)];
        let chain = Chain::new(joints).expect("valid");
        let mut placed = Vec::new();
        chain.place(&Rigid::IDENTITY, &[FRAC_PI_2, 7.0], &mut placed);
        assert!(placed[0].translation.abs_diff_eq(DVec3::X, 1e-15));
        assert!(
            placed[1]
                .translation
                .abs_diff_eq(DVec3::new(1.0, 1.0, 0.0), 1e-15)
        );
        assert!((placed[1].rotation * DVec3::X).abs_diff_eq(DVec3::Y, 1e-15));
    }

    #[test]
    fn what_is_no_chain() {
        let spoilt = |spoil: fn(&mut Joint)| {
            let mut one = joint("a", None, ABOUT_Z);
            spoil(&mut one);
            Chain::new(vec![one]).err()
        };
        assert!(matches!(
            spoilt(|j| j.parent = Some(JointIndex(0))),
            Some(ChainError::ParentAfterChild { .. })
        ));
        assert!(matches!(
            spoilt(|j| j.range_rad = Interval::new(1.0, 0.0)),
            Some(ChainError::BadRange { .. })
        ));
        assert!(matches!(
            spoilt(|j| j.speed_max_rad_per_s = 0.0),
            Some(ChainError::BadSpeed { .. })
        ));
        let no_axis = |j: &mut Joint| j.kind = JointKind::Revolute { axis: DVec3::ZERO };
        assert!(matches!(spoilt(no_axis), Some(ChainError::BadAxis { .. })));
        let nowhere = |j: &mut Joint| j.parent_from_joint.translation.x = f64::NAN;
        assert!(matches!(spoilt(nowhere), Some(ChainError::NotFinite { .. })));
        let twins = vec![joint("a", None, ABOUT_Z), joint("a", Some(0), ABOUT_Z)];
        assert_eq!(
            Chain::new(twins).err(),
            Some(ChainError::DuplicateName { name: "a".into() })
        );
    }

    #[test]
    fn led_joints_go_along() {
        let joints = vec![joint("a", None, ABOUT_Z), joint("b", Some(0), ABOUT_Z)];
        let coupling = |joint, follows, ratio| Coupling {
            joint: JointIndex(joint),
            follows: JointIndex(follows),
            ratio,
            offset_rad: 0.25,
        };
        let chain = Chain::new(joints).expect("valid");
        let led = chain.clone().coupled(vec![coupling(1, 0, -0.5)]).expect("valid");
        assert_eq!(led.rest_angles(), [0.0, 0.25]);
        let mut angles = [1.0, 9.0];
        led.lead(&mut angles);
        assert_eq!(angles, [1.0, -0.25]);
        for wrong in [
            vec![coupling(1, 0, 0.0)],
            vec![coupling(2, 0, 1.0)],
            vec![coupling(1, 1, 1.0)],
            vec![coupling(1, 0, 1.0), coupling(0, 1, 1.0)],
        ] {
            assert!(matches!(
                chain.clone().coupled(wrong),
                Err(ChainError::BadCoupling { .. })
            ));
        }
    }

    #[test]
    fn rest_is_as_near_to_zero_as_the_range_allows() {
        let mut away = joint("a", None, ABOUT_Z);
        away.range_rad = Interval::new(0.3, 2.0);
        let chain = Chain::new(vec![away, joint("b", Some(0), ABOUT_Z)]).expect("valid");
        assert_eq!(chain.rest_angles(), [0.3, 0.0]);
        assert_eq!(chain.by_name("b"), Some(JointIndex(1)));
    }
}
