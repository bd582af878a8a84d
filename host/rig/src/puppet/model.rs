//! What is known of a puppet without a servo in sight: its chain, its limits, its masses, and how it stands.
//!
//! One reading of the profile for everybody: who follows a figure, who draws, who poses, who judges.

use std::sync::Arc;

use device_profiles::{Profiles, PuppetGroup, PuppetProfile};
use glam::{DMat3, DQuat, DVec3};
use motion::chain::End;
use motion::feasibility::{JointLimits, Load, Loads, Motor};
use motion::{Chain, ChainError, Coupling, Interval, Joint, JointIndex, JointKind, Rigid};

/// Metres a second squared, standard gravity (CGPM 1901).
const GRAVITY: f64 = 9.806_65;

/// A profile's chain and where its groups sit on it.
#[derive(Clone, Debug)]
pub struct Model {
    /// The profile's name.
    pub(crate) name: String,
    /// Joint names, in the order of all rows of angles.
    pub(crate) joints: Vec<String>,
    pub(crate) chain: Arc<Chain>,
    /// In the profile's order.
    pub(crate) links: Vec<LinkOfModel>,
    pub(crate) world_from_base: Rigid,
}

/// The link of one group.
#[derive(Clone, Debug)]
pub(crate) struct LinkOfModel {
    pub(crate) name: String,
    /// The joint it moves with; none for the base.
    pub(crate) joint: Option<JointIndex>,
    /// Its group's own joints.
    pub(crate) own: Vec<JointIndex>,
    /// The group it hangs from.
    pub(crate) parent: Option<usize>,
    /// In the joint's frame.
    pub(crate) start: DVec3,
    pub(crate) end: DVec3,
}

impl Model {
    /// Of a profile whose joints make a chain.
    pub fn new(profile: &PuppetProfile) -> Result<Self, ChainError> {
        let (mut joints, mut links) = (Vec::new(), Vec::<LinkOfModel>::new());
        for group in &profile.groups {
            let parent = group
                .parent
                .as_deref()
                .and_then(|p| profile.groups.iter().position(|g| g.link == p))
                .filter(|&parent| parent < links.len());
            let mut last = parent.and_then(|parent| links[parent].joint);
            let mut own = Vec::new();
            for joint in &group.joints {
                let index = JointIndex(joints.len() as u16);
                joints.push(chain_joint(joint, last));
                own.push(index);
                last = Some(index);
            }
            let tool = tool(group);
            links.push(LinkOfModel {
                name: group.link.clone(),
                joint: last,
                own,
                parent,
                start: tool.translation,
                end: tool.transform_point(DVec3::Z * group.length_m),
            });
        }
        let names: Vec<String> = joints.iter().map(|joint: &Joint| joint.name.clone()).collect();
        let place = |name: &str| {
            names
                .iter()
                .position(|n| n == name)
                .map(|at| JointIndex(at as u16))
        };
        let couplings = profile.couplings.iter().filter_map(|coupling| {
            Some(Coupling {
                joint: place(&coupling.joint)?,
                follows: place(&coupling.follows)?,
                ratio: coupling.ratio,
                offset_rad: coupling.offset_rad,
            })
        });
        let chain = Chain::new(joints)?.coupled(couplings.collect())?;
        Ok(Self {
            name: profile.name.clone(),
            joints: names,
            chain: Arc::new(chain),
            links,
            world_from_base: Rigid {
                rotation: DQuat::from_mat3(&standing(profile)),
                translation: DVec3::ZERO,
            },
        })
    }

    /// The place of a joint.
    pub(crate) fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint == name)
    }

    /// The end of a link that joints can bring somewhere.
    pub(crate) fn end(&self, link: &str) -> Option<End> {
        let link = self.links.iter().find(|known| known.name == link)?;
        Some(End {
            joint: link.joint?,
            joint_from_point: link.end,
        })
    }

    /// What every joint may be asked for.
    pub fn limits(profile: &PuppetProfile) -> Arc<[JointLimits]> {
        profile
            .joints()
            .map(|joint| JointLimits {
                range_rad: Interval::new(joint.min_rad, joint.max_rad),
                speed_max_rad_per_s: joint.speed_max_rad_per_s,
                accel_max_rad_per_s2: joint.accel_max_rad_per_s2,
            })
            .collect()
    }

    /// Masses and motors, as far as the profiles know them.
    pub fn loads(&self, profile: &PuppetProfile, profiles: &Profiles) -> Loads {
        let motor = |joint: &device_profiles::PuppetJoint| {
            let motor = profiles.servo(&joint.model).ok()?.motor.as_ref()?;
            Some(Motor {
                stall_nm: motor.stall_torque_nm,
                no_load_rad_per_s: motor.no_load_speed_rad_per_s,
                rotor_kg_m2: motor.rotor_inertia_kg_m2,
            })
        };
        let down = self.world_from_base.rotation.inverse() * (DVec3::NEG_Y * GRAVITY);
        let motors = profile.joints().map(motor).collect();
        Loads::new(Arc::clone(&self.chain), self.carried(profile), motors, down)
    }

    /// What moves with each joint: its group's mass, and those of rigid parts on it.
    fn carried(&self, profile: &PuppetProfile) -> Vec<Option<Load>> {
        // Inner joints of a group carry nothing of their own.
        let mut carried: Vec<Option<Load>> = vec![Some(Load::default()); self.chain.len()];
        for (group, link) in profile.groups.iter().zip(&self.links) {
            let Some(joint) = link.joint else { continue };
            let onto = &mut carried[joint.index()];
            *onto = onto.zip(load(group, link)).map(|(a, b)| together(a, b));
        }
        carried
    }
}

/// A link as a rod along itself, about the centre the profile gives: profiles know masses, not inertias.
fn load(group: &PuppetGroup, link: &LinkOfModel) -> Option<Load> {
    let mass_kg = group.mass_kg?;
    let along = (link.end - link.start).normalize_or_zero();
    let across = DMat3::IDENTITY - DMat3::from_cols(along * along.x, along * along.y, along * along.z);
    Some(Load {
        mass_kg,
        centre_m: DVec3::from_array(group.centre_of_mass_xyz_m),
        inertia_kg_m2: across * (mass_kg * group.length_m * group.length_m / 12.0),
    })
}

/// Two rigid parts as one. Source: the parallel axis theorem.
fn together(a: Load, b: Load) -> Load {
    let mass_kg = a.mass_kg + b.mass_kg;
    if mass_kg <= 0.0 {
        return Load::default();
    }
    let centre_m = (a.centre_m * a.mass_kg + b.centre_m * b.mass_kg) / mass_kg;
    let about = |part: Load| {
        let off = part.centre_m - centre_m;
        let outer = DMat3::from_cols(off * off.x, off * off.y, off * off.z);
        part.inertia_kg_m2 + (DMat3::IDENTITY * off.length_squared() - outer) * part.mass_kg
    };
    Load {
        mass_kg,
        centre_m,
        inertia_kg_m2: about(a) + about(b),
    }
}

fn chain_joint(joint: &device_profiles::PuppetJoint, parent: Option<JointIndex>) -> Joint {
    Joint {
        name: joint.name.clone(),
        parent,
        parent_from_joint: Rigid::from_xyz_rpy(
            DVec3::from_array(joint.origin_xyz_m),
            DVec3::from_array(joint.origin_rpy_rad),
        ),
        kind: JointKind::Revolute {
            axis: DVec3::from_array(joint.axis),
        },
        range_rad: Interval::new(joint.min_rad, joint.max_rad),
        speed_max_rad_per_s: joint.speed_max_rad_per_s,
    }
}

/// Where a group's link lies in its last joint's frame.
pub(super) fn tool(group: &PuppetGroup) -> Rigid {
    Rigid::from_xyz_rpy(
        DVec3::from_array(group.tool_xyz_m),
        DVec3::from_array(group.tool_rpy_rad),
    )
}

/// How the base stands in the world (x right, y up, z towards the viewer). A puppet that follows a figure stands as
/// the figure's root link does; one without stands on its base and looks at the viewer.
fn standing(profile: &PuppetProfile) -> DMat3 {
    match profile.groups.first().filter(|_| profile.figure.is_some()) {
        Some(root) => upright() * DMat3::from_quat(tool(root).rotation).transpose(),
        // x forward, y to the left, z up: REP 103 of the Robot Operating System, which URDF files keep.
        None => DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
    }
}

/// A link's axes when everybody stands upright and looks at the viewer: z down along the link, x to the body's own
/// right, y to its back; world axes are x right, y up, z towards the viewer.
pub(super) fn upright() -> DMat3 {
    DMat3::from_cols(DVec3::NEG_X, DVec3::NEG_Z, DVec3::NEG_Y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_rods_end_to_end_are_one_twice_as_long() {
        let half = |x: f64| Load {
            mass_kg: 1.0,
            centre_m: DVec3::X * x,
            inertia_kg_m2: DMat3::from_diagonal(DVec3::new(0.0, 1.0, 1.0) / 12.0),
        };
        let whole = together(half(0.5), half(1.5));
        assert!((whole.mass_kg - 2.0).abs() < 1e-12 && whole.centre_m.abs_diff_eq(DVec3::X, 1e-12));
        assert!((whole.inertia_kg_m2.y_axis.y - 2.0 * 4.0 / 12.0).abs() < 1e-12);
        assert!(whole.inertia_kg_m2.x_axis.x.abs() < 1e-12);
        assert_eq!(
            together(Load::default(), half(0.5)).inertia_kg_m2,
            half(0.5).inertia_kg_m2
        );
    }
}
