//! Torque: what gravity and inertia ask of each motor, where masses are known.
//!
//! The recursion of Newton and Euler from the base outwards and back, in the base's frame. What a motor can give
//! falls in a straight line from its stall torque at rest to nothing at its no-load speed.
//! Source: Luh, Walker and Paul, On-Line Computational Scheme for Mechanical Manipulators, 1980; the line is that
//! of a direct-current motor (Lynch and Park, Modern Robotics, section 8.9).

use super::limits::JointLimits;
use super::polynomial::Polynomial;
use super::{Kind, Stretch};
use crate::chain::{Chain, JointKind, Rigid};
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// Torque between two points is straight when the middle is off by no more than this share of the limit
/// (our choice).
const STRAIGHT_SHARE: f64 = 0.01;
/// Halvings at most.
const HALVINGS_MAX: u32 = 7;
/// However fast it turns, a motor is granted this share of its stall torque: being too fast is another matter,
/// said elsewhere.
const LEAST_SHARE: f64 = 0.05;

/// What one joint carries: the mass that moves with it and before the next joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Kilograms.
    pub mass_kg: f64,
    /// Its centre, in the joint's frame, metres.
    pub centre_m: DVec3,
    /// About its centre, in axes of the joint's frame.
    pub inertia_kg_m2: DMat3,
}

impl Default for Load {
    /// Nothing; the default of a matrix would be 1.
    fn default() -> Self {
        Self {
            mass_kg: 0.0,
            centre_m: DVec3::ZERO,
            inertia_kg_m2: DMat3::ZERO,
        }
    }
}

/// What turns a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Torque at rest.
    pub stall_nm: f64,
    /// Speed without load.
    pub no_load_rad_per_s: f64,
    /// Of the rotor, seen through the gears.
    pub rotor_kg_m2: f64,
}

/// Masses and motors of a chain.
#[derive(Clone, Debug)]
pub struct Loads {
    chain: Arc<Chain>,
    carried: Vec<Option<Load>>,
    motors: Vec<Option<Motor>>,
    gravity_in_base: DVec3,
    /// Whether a joint has a motor and everything outwards of it has a known mass.
    known: Vec<bool>,
}

/// What is asked of one joint.
#[derive(Clone, Copy, Debug, Default)]
struct Demand {
    /// Against what the motor can give at that speed.
    share: f64,
    /// Of that, what gravity alone asks, against what it can give at rest.
    still_share: f64,
}

impl Loads {
    /// Of a chain: one load and one motor for each joint, `None` where nobody knows; a load of zero mass is
    /// known. `gravity_in_base` is metres a second squared, pointing down.
    pub fn new(
        chain: Arc<Chain>,
        mut loads: Vec<Option<Load>>,
        mut motors: Vec<Option<Motor>>,
        gravity_in_base: DVec3,
    ) -> Self {
        loads.resize(chain.len(), None);
        motors.resize(chain.len(), None);
        let mut sure: Vec<bool> = loads.iter().map(Option::is_some).collect();
        for (index, joint) in chain.joints().iter().enumerate().rev() {
            if let (false, Some(parent)) = (sure[index], joint.parent) {
                sure[parent.index()] = false;
            }
        }
        let known = sure.iter().zip(&motors).map(|(c, m)| *c && m.is_some()).collect();
        Self {
            chain,
            carried: loads,
            motors,
            gravity_in_base,
            known,
        }
    }

    /// Joints whose torque cannot be judged, for want of a motor or of a mass that they carry.
    pub fn unknown(&self) -> impl Iterator<Item = usize> {
        self.known
            .iter()
            .enumerate()
            .filter_map(|(joint, known)| (!known).then_some(joint))
    }

    /// Newton metres at every joint, right-handed about its axis, for angles, speeds and accelerations.
    pub fn torques_nm(&self, angles: &[f64], speeds: &[f64], accels: &[f64]) -> Vec<f64> {
        let joints = self.chain.joints();
        let mut placed = Vec::new();
        self.chain.place(&Rigid::IDENTITY, angles, &mut placed);
        // Angular speed and acceleration, and the linear acceleration of the origin less gravity.
        let mut moving = vec![(DVec3::ZERO, DVec3::ZERO, -self.gravity_in_base); joints.len()];
        let mut forces = vec![(DVec3::ZERO, DVec3::ZERO); joints.len()];
        for (index, joint) in joints.iter().enumerate() {
            let (mut spin, mut spin_up, mut lift) = match joint.parent {
                Some(parent) => moving[parent.index()],
                None => (DVec3::ZERO, DVec3::ZERO, -self.gravity_in_base),
            };
            if let Some(parent) = joint.parent {
                let arm = placed[index].translation - placed[parent.index()].translation;
                lift += spin_up.cross(arm) + spin.cross(spin.cross(arm));
            }
            if let JointKind::Revolute { axis } = joint.kind {
                let axis = placed[index].rotation * axis;
                let (speed, accel) = (of(speeds, index), of(accels, index));
                spin_up += axis * accel + spin.cross(axis * speed);
                spin += axis * speed;
            }
            moving[index] = (spin, spin_up, lift);
            let load = self.carried[index].unwrap_or_default();
            let turned = DMat3::from_quat(placed[index].rotation);
            let centre = turned * load.centre_m;
            let inertia = turned * load.inertia_kg_m2 * turned.transpose();
            let force = (lift + spin_up.cross(centre) + spin.cross(spin.cross(centre))) * load.mass_kg;
            let moment = inertia * spin_up + spin.cross(inertia * spin) + centre.cross(force);
            forces[index] = (force, moment);
        }
        let mut torques = vec![0.0; joints.len()];
        for (index, joint) in joints.iter().enumerate().rev() {
            let (force, moment) = forces[index];
            if let JointKind::Revolute { axis } = joint.kind {
                let rotor = self.motors[index].map_or(0.0, |motor| motor.rotor_kg_m2);
                torques[index] = (placed[index].rotation * axis).dot(moment) + rotor * of(accels, index);
            }
            if let Some(parent) = joint.parent {
                let arm = placed[index].translation - placed[parent.index()].translation;
                let onto = &mut forces[parent.index()];
                onto.0 += force;
                onto.1 += moment + arm.cross(force);
            }
        }
        torques
    }

    /// Finds where motors are asked too much over one cut; `motions` are angle, speed and acceleration.
    ///
    /// More speed and acceleration than the limits allow is judged elsewhere and never reaches a motor: torque is that
    /// of what the limits let through.
    pub(super) fn judge(
        &self,
        motions: &[[Polynomial; 3]],
        limits: &[JointLimits],
        from_secs: f64,
        span_secs: f64,
        found: &mut Vec<Stretch>,
    ) {
        let at = |s: f64| self.demands(motions, limits, s);
        let (begin, end) = (at(0.0), at(1.0));
        let cut = Halving {
            at: &at,
            from_secs,
            span_secs,
        };
        cut.search((0.0, &begin), (1.0, &end), HALVINGS_MAX, found);
    }

    fn demands(&self, motions: &[[Polynomial; 3]], limits: &[JointLimits], s: f64) -> Vec<Demand> {
        let [angles, mut speeds, mut accels] =
            [0, 1, 2].map(|what| -> Vec<f64> { motions.iter().map(|motion| motion[what].at(s)).collect() });
        for (joint, limits) in limits.iter().enumerate() {
            let (speed, accel) = (limits.speed_max_rad_per_s, limits.accel_max_rad_per_s2);
            speeds[joint] = speeds[joint].clamp(-speed, speed);
            accels[joint] = accels[joint].clamp(-accel, accel);
        }
        let torques = self.torques_nm(&angles, &speeds, &accels);
        let still = self.torques_nm(&angles, &[], &[]);
        let demand = |joint: usize| match self.motors[joint].filter(|_| self.known[joint]) {
            None => Demand::default(),
            Some(motor) => {
                let left = 1.0 - speeds[joint].abs() / motor.no_load_rad_per_s;
                Demand {
                    share: torques[joint].abs() / (motor.stall_nm * left.max(LEAST_SHARE)),
                    still_share: still[joint].abs() / motor.stall_nm,
                }
            }
        };
        (0..motions.len()).map(demand).collect()
    }
}

/// A missing number is a joint that stands.
fn of(values: &[f64], index: usize) -> f64 {
    values.get(index).copied().unwrap_or(0.0)
}

struct Halving<'a> {
    at: &'a dyn Fn(f64) -> Vec<Demand>,
    from_secs: f64,
    span_secs: f64,
}

impl Halving<'_> {
    fn search(
        &self,
        (from, begin): (f64, &[Demand]),
        (to, end): (f64, &[Demand]),
        halvings: u32,
        found: &mut Vec<Stretch>,
    ) {
        let half = f64::midpoint(from, to);
        let middle = (self.at)(half);
        let bent = |joint: usize| {
            let straight = f64::midpoint(begin[joint].share, end[joint].share);
            (middle[joint].share - straight).abs() > STRAIGHT_SHARE
        };
        let over = |joint: usize| [begin, &middle, end].map(|d| d[joint].share > 1.0);
        let mixed = |joint: usize| over(joint).contains(&true) && over(joint).contains(&false);
        if halvings > 0 && (0..middle.len()).any(|joint| bent(joint) || mixed(joint)) {
            self.search((from, begin), (half, &middle), halvings - 1, found);
            self.search((half, &middle), (to, end), halvings - 1, found);
            return;
        }
        for joint in 0..middle.len() {
            let most = [begin, &middle, end].map(|d| d[joint]);
            let most = most
                .into_iter()
                .fold(Demand::default(), |a, b| if b.share > a.share { b } else { a });
            if most.share > 1.0 {
                let stretch = |s: f64| self.from_secs + s * self.span_secs;
                found.push(Stretch {
                    from_secs: stretch(from),
                    to_secs: stretch(to),
                    joint,
                    kind: Kind::Torque,
                    factor: most.share,
                    slow_down: most.slow_down(),
                });
            }
        }
    }
}

impl Demand {
    /// Inertia asks for the square of the speed less, gravity for as much as ever. Too much rather than too little
    /// for the motor's line, which gets better too.
    fn slow_down(self) -> Option<f64> {
        let (inertia, room) = (self.share - self.still_share, 1.0 - self.still_share);
        (room > 0.0 && inertia > 0.0).then(|| (inertia / room).sqrt().max(1.0 + 1e-3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Joint, JointIndex};
    use crate::curve::Interval;

    /// Two rods of one kilogram and one metre in a row, turning about y, hanging along x at rest.
    fn rods() -> Loads {
        let joint = |name: &str, parent: Option<u16>, x: f64| Joint {
            name: name.into(),
            parent: parent.map(JointIndex),
            parent_from_joint: Rigid::from_xyz_rpy(DVec3::X * x, DVec3::ZERO),
            kind: JointKind::Revolute { axis: DVec3::Y },
            range_rad: Interval::new(-3.0, 3.0),
            speed_max_rad_per_s: 1.0,
        };
        let chain = Chain::new(vec![joint("a", None, 0.0), joint("b", Some(0), 1.0)]).expect("valid");
        let rod = Load {
            mass_kg: 1.0,
            centre_m: DVec3::X * 0.5,
            inertia_kg_m2: DMat3::from_diagonal(DVec3::new(0.0, 1.0 / 12.0, 1.0 / 12.0)),
        };
        let motor = Motor {
            stall_nm: 30.0,
            no_load_rad_per_s: 10.0,
            rotor_kg_m2: 0.0,
        };
        let down = DVec3::NEG_Z * 9.81;
        Loads::new(Arc::new(chain), vec![Some(rod); 2], vec![Some(motor); 2], down)
    }

    #[test]
    fn gravity_alone_asks_for_weight_times_arm() {
        let torques = rods().torques_nm(&[0.0, 0.0], &[], &[]);
        // Positive about y turns x towards -z, as gravity does; the motor holds against it.
        assert!(
            (torques[0] + 9.81 * 2.0).abs() < 1e-12 && (torques[1] + 9.81 * 0.5).abs() < 1e-12,
            "{torques:?}"
        );
    }

    #[test]
    fn inertia_and_speed_ask_as_the_double_pendulum_says() {
        // Spong, Hutchinson, Vidyasagar, Robot Modeling and Control, planar elbow manipulator, without gravity:
        // m22 = I + m/4, m12 = m22 + m c2 / 2, m11 = 2 I + m/4 + m (5/4 + c2), h = -m s2 / 2.
        let mut rods = rods();
        rods.gravity_in_base = DVec3::ZERO;
        let (q, v, a) = ([0.4, 0.9], [0.7, -1.1], [1.3, 0.6]);
        let (s, c) = 0.9_f64.sin_cos();
        let m22 = 1.0 / 12.0 + 0.25;
        let m12 = m22 + 0.5 * c;
        let m11 = 2.0 / 12.0 + 0.25 + 1.25 + c;
        let h = -0.5 * s;
        let want = [
            m11 * a[0] + m12 * a[1] + h * (2.0 * v[0] * v[1] + v[1] * v[1]),
            m12 * a[0] + m22 * a[1] - h * v[0] * v[0],
        ];
        let got = rods.torques_nm(&q, &v, &a);
        for joint in 0..2 {
            assert!((got[joint] - want[joint]).abs() < 1e-12, "{got:?} {want:?}");
        }
    }

    #[test]
    fn nothing_weighs_nothing_and_turns_freely() {
        let rods = rods();
        let carried = vec![Some(Load::default()); 2];
        let empty = Loads::new(rods.chain.clone(), carried, rods.motors.clone(), DVec3::NEG_Z);
        assert_eq!(
            empty.torques_nm(&[0.3, 0.4], &[1.0, 2.0], &[3.0, 4.0]),
            [0.0, 0.0]
        );
    }

    #[test]
    fn a_joint_that_carries_the_unknown_is_unknown() {
        let rods = rods();
        let known = Loads::new(
            rods.chain.clone(),
            vec![rods.carried[0], None],
            rods.motors.clone(),
            DVec3::ZERO,
        );
        assert_eq!(known.unknown().collect::<Vec<_>>(), [0, 1]);
        let without_a = Loads::new(
            rods.chain.clone(),
            vec![None, rods.carried[1]],
            rods.motors.clone(),
            DVec3::ZERO,
        );
        assert_eq!(without_a.unknown().collect::<Vec<_>>(), [0]);
    }
}
