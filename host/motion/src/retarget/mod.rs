//! Letting a robot's joints follow a figure's links.
//!
//! Each figure link is followed by a group of at most three joints. Groups are solved from the base
//! outwards, always against the rotation that was *reached* before them, so a limit at the shoulder is
//! made up for at the elbow and errors do not pile up.
//! Source: maths notes 5.5; one method for all layouts of axes, since the closed forms know no limits.

mod report;
mod solve;

pub use report::{GroupReport, RetargetReport};

use crate::chain::{Chain, JointIndex, JointKind};
use crate::figure::{Figure, Freedom, LinkIndex, Placed};
use glam::{DMat3, DQuat};
use solve::{Search, Task};
use std::sync::Arc;
use thiserror::Error;

/// Most joints of one group.
pub const GROUP_JOINTS_MAX: usize = 3;

/// Some joints that follow one link of the figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The link they follow.
    pub link: LinkIndex,
    /// The joints, each hanging from the one before (fixed joints between them are skipped); none for
    /// a base that follows a link rigidly.
    pub joints: Vec<JointIndex>,
    /// The link's frame as the last joint's frame carries it.
    pub joint_from_link: DQuat,
}

/// Why groups cannot follow a figure.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RetargetError {
    /// The figure has no such link.
    #[error("group {group} follows link {link:?}; the figure has {links} links")]
    NoSuchLink {
        /// The group, from 0.
        group: usize,
        /// What it says.
        link: LinkIndex,
        /// How many links there are.
        links: usize,
    },
    /// The chain has no such joint, or it does not turn.
    #[error("group {group} names joint {joint:?}, which is not a revolute joint of the chain")]
    NoSuchJoint {
        /// The group, from 0.
        group: usize,
        /// What it says.
        joint: JointIndex,
    },
    /// One to three joints follow a link.
    #[error("group {group} has {joints} joints; one to {GROUP_JOINTS_MAX} follow a link")]
    JointCount {
        /// The group, from 0.
        group: usize,
        /// How many it has.
        joints: usize,
    },
    /// The joints of a group hang from one another.
    #[error("in group {group}, joint {joint:?} does not hang from the joint before it")]
    NotInARow {
        /// The group, from 0.
        group: usize,
        /// The joint that does not.
        joint: JointIndex,
    },
    /// A joint follows one link.
    #[error("joint {joint:?} is in two groups; leave it out of one")]
    JointTwice {
        /// The joint.
        joint: JointIndex,
    },
}

/// A figure, a chain, and who follows whom.
#[derive(Clone, Debug)]
pub struct Retarget {
    figure: Arc<Figure>,
    chain: Arc<Chain>,
    base: Option<(LinkIndex, DMat3)>,
    tasks: Vec<Task>,
}

impl Retarget {
    /// Lets `groups` of the chain follow the figure. With `base`, the chain's base is carried by that link,
    /// in which it lies turned by the given `base_from_link`; otherwise it stands still, upright in the
    /// world. Joints in no group keep their angle.
    pub fn new(
        figure: Arc<Figure>,
        chain: Arc<Chain>,
        base: Option<(LinkIndex, DQuat)>,
        groups: &[Group],
    ) -> Result<Self, RetargetError> {
        let links = figure.len();
        if let Some((link, _)) = base.filter(|(link, _)| link.index() >= links) {
            return Err(RetargetError::NoSuchLink {
                group: 0,
                link,
                links,
            });
        }
        let mut taken = vec![false; chain.len()];
        let mut tasks = Vec::with_capacity(groups.len());
        for (group, spec) in groups.iter().enumerate() {
            let Some(link) = figure.link(spec.link) else {
                return Err(RetargetError::NoSuchLink {
                    group,
                    link: spec.link,
                    links,
                });
            };
            for joint in &spec.joints {
                match taken.get_mut(joint.index()) {
                    Some(taken) if !*taken => *taken = true,
                    Some(_) => return Err(RetargetError::JointTwice { joint: *joint }),
                    None => return Err(RetargetError::NoSuchJoint { group, joint: *joint }),
                }
            }
            tasks.push(task(&chain, group, spec, link.freedom)?);
        }
        // From the base outwards, whatever the order given.
        tasks.sort_by_key(|task| task.joints.first().copied());
        let base = base.map(|(link, turn)| (link, DMat3::from_quat(turn)));
        Ok(Self {
            figure,
            chain,
            base,
            tasks,
        })
    }

    /// The chain that follows.
    pub fn chain(&self) -> &Arc<Chain> {
        &self.chain
    }

    /// The figure that is followed.
    pub fn figure(&self) -> &Arc<Figure> {
        &self.figure
    }

    /// As [`Retarget::follow`], for the first frame: looks for other branches even where the nearest one is
    /// good, since nothing is moving yet.
    pub fn begin(&self, placed: &[Placed], angles: &mut [f64], report: &mut RetargetReport) {
        self.solve(placed, angles, Search::Always, report);
    }

    /// Turns `angles` (one for each joint of the chain, the frame before) into the angles for this frame.
    /// Extra angles are left alone, missing ones and links missing from `placed` leave their group as it is.
    pub fn follow(&self, placed: &[Placed], angles: &mut [f64], report: &mut RetargetReport) {
        self.solve(placed, angles, Search::WhenPoor, report);
    }

    fn solve(&self, placed: &[Placed], angles: &mut [f64], search: Search, report: &mut RetargetReport) {
        report.groups.clear();
        if angles.len() < self.chain.len() {
            return;
        }
        for task in &self.tasks {
            let Some(target) = placed.get(task.link.index()) else {
                continue;
            };
            let world_from_parent = self.world_rotation(task.parent, placed, angles);
            report
                .groups
                .push(task.solve(world_from_parent, &target.world_from_link, angles, search));
        }
    }

    /// By what factor a motion from one row of angles to the next within `secs` is too fast (1 if it is
    /// not), and for which joint.
    pub fn slow_down(&self, before: &[f64], after: &[f64], secs: f64) -> (f64, Option<JointIndex>) {
        let mut worst = (1.0, None);
        for (index, joint) in self.chain.joints().iter().enumerate() {
            let (Some(a), Some(b)) = (before.get(index), after.get(index)) else {
                break;
            };
            let factor = (b - a).abs() / secs / joint.speed_max_rad_per_s;
            if factor > worst.0 {
                worst = (factor, Some(JointIndex(index as u16)));
            }
        }
        worst
    }

    /// The world rotation of the chain's base for a placed figure.
    fn world_from_base(&self, placed: &[Placed]) -> DMat3 {
        match self.base {
            Some((link, base_from_link)) => placed.get(link.index()).map_or(DMat3::IDENTITY, |p| {
                p.world_from_link * base_from_link.transpose()
            }),
            None => DMat3::IDENTITY,
        }
    }

    /// The world rotation of a joint's frame at the angles reached so far.
    fn world_rotation(&self, joint: Option<JointIndex>, placed: &[Placed], angles: &[f64]) -> DMat3 {
        let mut rotation = DMat3::IDENTITY;
        let mut at = joint;
        while let Some(index) = at {
            let joint = &self.chain.joints()[index.index()];
            let turn = match joint.kind {
                JointKind::Revolute { axis } => DMat3::from_axis_angle(axis, angles[index.index()]),
                JointKind::Fixed => DMat3::IDENTITY,
            };
            rotation = DMat3::from_quat(joint.parent_from_joint.rotation) * turn * rotation;
            at = joint.parent;
        }
        self.world_from_base(placed) * rotation
    }
}

/// Works out what never changes about one group.
fn task(chain: &Chain, group: usize, spec: &Group, freedom: Freedom) -> Result<Task, RetargetError> {
    if spec.joints.is_empty() || spec.joints.len() > GROUP_JOINTS_MAX {
        return Err(RetargetError::JointCount {
            group,
            joints: spec.joints.len(),
        });
    }
    let mut steps = Vec::with_capacity(spec.joints.len());
    let mut parent = chain.joints()[spec.joints[0].index()].parent;
    let before_group = parent;
    for &index in &spec.joints {
        let joint = &chain.joints()[index.index()];
        let JointKind::Revolute { axis } = joint.kind else {
            return Err(RetargetError::NoSuchJoint { group, joint: index });
        };
        let Some(rotation) = fixed_between(chain, parent, index) else {
            return Err(RetargetError::NotInARow { group, joint: index });
        };
        steps.push(solve::Step {
            parent_from_joint: rotation,
            axis,
            range: joint.range_rad,
        });
        parent = Some(index);
    }
    Ok(Task {
        link: spec.link,
        joints: spec.joints.clone(),
        parent: before_group,
        steps,
        joint_from_link: DMat3::from_quat(spec.joint_from_link),
        twist_counts: freedom == Freedom::Three,
    })
}

/// The rotation from `ancestor`'s frame to the joint's own, over fixed joints only.
fn fixed_between(chain: &Chain, ancestor: Option<JointIndex>, joint: JointIndex) -> Option<DMat3> {
    let mut rotation = DMat3::IDENTITY;
    let mut at = joint;
    loop {
        let here = &chain.joints()[at.index()];
        rotation = DMat3::from_quat(here.parent_from_joint.rotation) * rotation;
        if here.parent == ancestor {
            return Some(rotation);
        }
        at = here.parent?;
        if chain.joints()[at.index()].kind != JointKind::Fixed {
            return None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Joint, Rigid};
    use crate::curve::Interval;
    use crate::figure::LinkSpec;
    use glam::DVec3;

    fn chain() -> Arc<Chain> {
        let joint = |name: &str, parent: Option<u16>, kind| Joint {
            name: name.into(),
            parent: parent.map(JointIndex),
            parent_from_joint: Rigid::from_xyz_rpy(DVec3::ZERO, DVec3::new(0.5, 0.0, 0.0)),
            kind,
            range_rad: Interval::new(-1.0, 1.0),
            speed_max_rad_per_s: 2.0,
        };
        let turns = |axis| JointKind::Revolute { axis };
        let joints = vec![
            joint("a", None, turns(DVec3::X)),
            joint("bracket", Some(0), JointKind::Fixed),
            joint("b", Some(1), turns(DVec3::Y)),
            joint("aside", Some(0), turns(DVec3::Z)),
        ];
        Arc::new(Chain::new(joints).expect("valid"))
    }

    fn retarget(groups: &[(u16, &[u16])]) -> Result<Retarget, RetargetError> {
        let link = |number, children: &[(u32, DVec3)]| LinkSpec {
            number,
            dof: 2,
            length: 1.0,
            children: children.to_vec(),
            ..LinkSpec::default()
        };
        let (figure, _) = Figure::new(&[link(0, &[(1, DVec3::Z)]), link(1, &[])]).expect("valid");
        let groups: Vec<Group> = groups
            .iter()
            .map(|(link, joints)| Group {
                link: LinkIndex(*link),
                joints: joints.iter().copied().map(JointIndex).collect(),
                joint_from_link: DQuat::IDENTITY,
            })
            .collect();
        Retarget::new(Arc::new(figure), chain(), None, &groups)
    }

    #[test]
    fn fixed_joints_between_are_skipped() {
        assert!(retarget(&[(0, &[0, 2]), (1, &[3])]).is_ok());
    }

    #[test]
    fn groups_that_cannot_follow() {
        let refused = |groups: &[(u16, &[u16])]| retarget(groups).err();
        let bracket = JointIndex(1);
        assert_eq!(
            refused(&[(0, &[1])]),
            Some(RetargetError::NoSuchJoint {
                group: 0,
                joint: bracket
            })
        );
        assert_eq!(
            refused(&[(0, &[])]),
            Some(RetargetError::JointCount { group: 0, joints: 0 })
        );
        let aside = JointIndex(3);
        assert_eq!(
            refused(&[(0, &[2, 3])]),
            Some(RetargetError::NotInARow {
                group: 0,
                joint: aside
            })
        );
        assert_eq!(
            refused(&[(0, &[0]), (1, &[0])]),
            Some(RetargetError::JointTwice { joint: JointIndex(0) })
        );
        let link = LinkIndex(2);
        assert_eq!(
            refused(&[(2, &[0])]),
            Some(RetargetError::NoSuchLink {
                group: 0,
                link,
                links: 2
            })
        );
    }

    #[test]
    fn too_fast_is_said_by_how_much_and_of_whom() {
        let retarget = retarget(&[(0, &[0, 2])]).expect("valid");
        let (factor, joint) = retarget.slow_down(&[0.0; 4], &[0.1, 0.0, 0.4, 0.0], 0.1);
        assert!((factor - 2.0).abs() < 1e-12);
        assert_eq!(joint, Some(JointIndex(2)));
        assert_eq!(retarget.slow_down(&[0.0; 4], &[0.1; 4], 1.0), (1.0, None));
    }
}
