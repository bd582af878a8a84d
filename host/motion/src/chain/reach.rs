//! Dragging the end of a chain somewhere: joint angles that bring it there, or as near as limits allow.
//!
//! Damped least squares, step by step, each step no longer than the linear picture is good for. Joints that stand
//! at a limit and would be pushed through it are held and the rest solves again without them. What freedom is left
//! pulls every joint towards rest, in the null space, so that the end does not notice. Deterministic: the same
//! angles, target and rest give the same answer, and small moves of the target small moves of the joints.
//! Source: Y. Nakamura, H. Hanafusa, Inverse Kinematic Solutions With Singularity Robustness, 1986 (damping);
//! A. Liegeois, Automatic Supervisory Control of Multibody Mechanisms, 1977 (null space).

use super::{Chain, JointIndex, JointKind, Rigid};
use crate::curve::Interval;
use glam::{DMat3, DVec3};

/// Steps at most; a drag by a hand's breadth takes about ten.
const STEPS_MAX: usize = 200;
/// This near is there, metres: a tenth of what the smallest servos' play moves the end.
const THERE_M: f64 = 1e-6;
/// The longest way of the end in one step, as a share of the arm from the end to the farthest joint (our choice).
const STEP_SHARE: f64 = 0.15;
/// Damping against the square of that arm (our choice): about two per cent of the arm where a joint loses all effect.
const DAMPING_SHARE: f64 = 4e-4;
/// Damping close to the target, so that it is met and not only approached.
const DAMPING_SHARE_NEAR: f64 = 1e-7;
/// How much of the way to rest a step goes in what freedom is left (our choice).
const REST_SHARE: f64 = 0.02;
/// Given up when so many steps in a row came no nearer.
const IDLE_STEPS_MAX: usize = 12;

/// A point that moves with a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// The joint it moves with.
    pub joint: JointIndex,
    /// Where it is in that joint's frame, metres.
    pub joint_from_point: DVec3,
}

/// How a drag went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reached {
    /// How far the end is from where it was wanted, metres.
    pub error_m: f64,
    /// Whether some joint that could bring it nearer stands at its limit.
    pub at_limit: bool,
}

/// One joint that can move the end, and whatever it leads.
struct Mover {
    joint: JointIndex,
    range: Interval,
    /// Joints on the way to the end that turn with it: itself, those it leads, and by how much.
    turns: Vec<(usize, f64)>,
}

/// Turns `angles_rad` so that the end comes to `target`, both in the world. Angles outside their range are first
/// brought into it. `rest_rad` is where joints go as far as the end does not mind. Missing angles are left alone.
pub fn reach(
    chain: &Chain,
    world_from_base: &Rigid,
    end: End,
    target: DVec3,
    rest_rad: &[f64],
    angles_rad: &mut [f64],
) -> Reached {
    let drag = Drag {
        chain,
        world_from_base,
        end,
        movers: movers(chain, end.joint),
    };
    if angles_rad.len() < chain.len() || !target.is_finite() || end.joint.index() >= chain.len() {
        return Reached {
            error_m: f64::INFINITY,
            at_limit: false,
        };
    }
    drag.pull(target, rest_rad, angles_rad)
}

struct Drag<'a> {
    chain: &'a Chain,
    world_from_base: &'a Rigid,
    end: End,
    movers: Vec<Mover>,
}

impl Drag<'_> {
    fn pull(&self, target: DVec3, rest_rad: &[f64], angles: &mut [f64]) -> Reached {
        for mover in &self.movers {
            let angle = &mut angles[mover.joint.index()];
            *angle = mover.range.clamp(*angle);
        }
        self.chain.lead(angles);
        let mut placed = Vec::new();
        let mut best = (f64::INFINITY, angles.to_vec());
        let (mut idle, mut held) = (0, Vec::new());
        for _ in 0..STEPS_MAX {
            let at = self.place(angles, &mut placed);
            let error_m = at.distance(target);
            let nearer = error_m < best.0 * (1.0 - 1e-3);
            if error_m < best.0 {
                best = (error_m, angles.to_vec());
            }
            idle = if nearer { 0 } else { idle + 1 };
            if error_m <= THERE_M || idle > IDLE_STEPS_MAX {
                break;
            }
            let columns = self.columns(&placed, at);
            let arm = columns.iter().map(|c| c.length()).fold(0.0, f64::max);
            if arm <= 0.0 {
                break;
            }
            let wanted = (target - at).clamp_length_max(STEP_SHARE * arm);
            held = self.step(&columns, wanted, arm, rest_rad, angles);
            self.chain.lead(angles);
        }
        angles.copy_from_slice(&best.1);
        Reached {
            error_m: best.0,
            at_limit: best.0 > THERE_M && held.contains(&true),
        }
    }

    fn place(&self, angles: &[f64], placed: &mut Vec<Rigid>) -> DVec3 {
        self.chain.place(self.world_from_base, angles, placed);
        placed[self.end.joint.index()].transform_point(self.end.joint_from_point)
    }

    /// How the end moves for a radian of each mover.
    fn columns(&self, placed: &[Rigid], at: DVec3) -> Vec<DVec3> {
        let by_joint = |&(joint, share): &(usize, f64)| match self.chain.joints()[joint].kind {
            JointKind::Revolute { axis } => {
                let frame = &placed[joint];
                (frame.rotation * axis).cross(at - frame.translation) * share
            }
            JointKind::Fixed => DVec3::ZERO,
        };
        self.movers
            .iter()
            .map(|mover| mover.turns.iter().map(by_joint).sum())
            .collect()
    }

    /// One step; says which movers were held at a limit.
    fn step(
        &self,
        columns: &[DVec3],
        wanted: DVec3,
        arm: f64,
        rest_rad: &[f64],
        angles: &mut [f64],
    ) -> Vec<bool> {
        let mut held = vec![false; self.movers.len()];
        // Each round holds one more joint at least, or is the last.
        for _ in 0..=self.movers.len() {
            let near = wanted.length() < 0.1 * STEP_SHARE * arm;
            let share = if near { DAMPING_SHARE_NEAR } else { DAMPING_SHARE };
            let moves = self.solve(columns, wanted, share * arm * arm, rest_rad, angles, &held);
            let mut pushed = false;
            for ((mover, by), held) in self.movers.iter().zip(&moves).zip(&mut held) {
                let next = angles[mover.joint.index()] + by;
                let out = next < mover.range.start || next > mover.range.end;
                let at_end = mover.range.clamp(next) == angles[mover.joint.index()];
                if out && at_end && !*held {
                    (*held, pushed) = (true, true);
                }
            }
            if !pushed {
                for (mover, by) in self.movers.iter().zip(moves) {
                    let angle = &mut angles[mover.joint.index()];
                    *angle = mover.range.clamp(*angle + by);
                }
                break;
            }
        }
        held
    }

    /// J^T (J J^T + damping)^-1 wanted, and what of the way to rest the end does not notice.
    fn solve(
        &self,
        columns: &[DVec3],
        wanted: DVec3,
        damping: f64,
        rest_rad: &[f64],
        angles: &[f64],
        held: &[bool],
    ) -> Vec<f64> {
        let free = |i: usize| if held[i] { DVec3::ZERO } else { columns[i] };
        let mut square = DMat3::from_diagonal(DVec3::splat(damping));
        for i in 0..columns.len() {
            let c = free(i);
            square += DMat3::from_cols(c * c.x, c * c.y, c * c.z);
        }
        let inverse = square.inverse();
        let to_rest: Vec<f64> = self
            .movers
            .iter()
            .enumerate()
            .map(|(i, mover)| {
                let joint = mover.joint.index();
                let rest = rest_rad.get(joint).copied().unwrap_or(0.0);
                if held[i] {
                    0.0
                } else {
                    REST_SHARE * (rest - angles[joint])
                }
            })
            .collect();
        let noticed: DVec3 = to_rest.iter().enumerate().map(|(i, by)| free(i) * *by).sum();
        let pull = inverse * (wanted - noticed);
        (0..columns.len())
            .map(|i| free(i).dot(pull) + to_rest[i])
            .collect()
    }
}

/// The joints that move a point on `joint`, outermost last. A joint that is led moves with the one that leads it,
/// whose range is narrowed to what the led one allows.
fn movers(chain: &Chain, joint: JointIndex) -> Vec<Mover> {
    let mut on_the_way = Vec::new();
    let mut at = Some(joint);
    while let Some(joint) = at.and_then(|index| chain.joints().get(index.index())) {
        on_the_way.extend(at);
        at = joint.parent;
    }
    let mut movers: Vec<Mover> = Vec::new();
    for index in on_the_way.into_iter().rev() {
        let joint = &chain.joints()[index.index()];
        if joint.kind == JointKind::Fixed {
            continue;
        }
        let (leader, share) = chain.led(index).map_or((index, 1.0), |c| (c.follows, c.ratio));
        match movers.iter_mut().find(|mover| mover.joint == leader) {
            Some(mover) => mover.turns.push((index.index(), share)),
            None => movers.push(Mover {
                joint: leader,
                range: leading_range(chain, leader),
                turns: vec![(index.index(), share)],
            }),
        }
    }
    movers
}

/// Where a joint may go so that those it leads may too.
fn leading_range(chain: &Chain, joint: JointIndex) -> Interval {
    let mut range = chain.joints()[joint.index()].range_rad;
    for coupling in chain.couplings().iter().filter(|c| c.follows == joint) {
        let led = chain.joints()[coupling.joint.index()].range_rad;
        let ends = [led.start, led.end].map(|end| (end - coupling.offset_rad) / coupling.ratio);
        range.start = range.start.max(ends[0].min(ends[1]));
        range.end = range.end.min(ends[0].max(ends[1]));
    }
    range.end = range.end.max(range.start);
    range
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Coupling, Joint};

    /// An arm as hobby arms are: pan, lift, elbow, wrist; links of 0.1, 0.1 and 0.05.
    fn arm() -> Chain {
        let joint = |name: &str, parent: Option<u16>, at: DVec3, axis: DVec3| Joint {
            name: name.into(),
            parent: parent.map(JointIndex),
            parent_from_joint: Rigid::from_xyz_rpy(at, DVec3::ZERO),
            kind: JointKind::Revolute { axis },
            range_rad: Interval::new(-1.7, 1.7),
            speed_max_rad_per_s: 1.0,
        };
        let joints = vec![
            joint("pan", None, DVec3::ZERO, DVec3::Z),
            joint("lift", Some(0), DVec3::Z * 0.05, DVec3::Y),
            joint("elbow", Some(1), DVec3::X * 0.1, DVec3::Y),
            joint("wrist", Some(2), DVec3::X * 0.1, DVec3::Y),
        ];
        Chain::new(joints).expect("valid")
    }

    const HAND: End = End {
        joint: JointIndex(3),
        joint_from_point: DVec3::new(0.05, 0.0, 0.0),
    };

    fn pull(chain: &Chain, target: DVec3, angles: &mut [f64]) -> Reached {
        reach(chain, &Rigid::IDENTITY, HAND, target, &[0.0; 4], angles)
    }

    fn hand(chain: &Chain, angles: &[f64]) -> DVec3 {
        let mut placed = Vec::new();
        chain.place(&Rigid::IDENTITY, angles, &mut placed);
        placed[3].transform_point(HAND.joint_from_point)
    }

    #[test]
    fn what_can_be_reached_is_reached_within_limits() {
        let chain = arm();
        // Poses inside the ranges: their hands can be reached by construction.
        for i in 0..200 {
            let turn = |k: f64| 1.5 * (f64::from(i) * k).sin();
            let pose = [turn(1.0), turn(1.7), turn(2.3), turn(0.9)];
            let target = hand(&chain, &pose);
            // From nearby, as a hand drags; around a limit it has to go the long way itself.
            let mut angles = pose.map(|angle| 0.8 * angle + 0.1);
            let got = pull(&chain, target, &mut angles);
            assert!(got.error_m < 2e-3, "{i}: {got:?} from {pose:?}");
            assert!(hand(&chain, &angles).distance(target) <= got.error_m + 1e-12);
            assert!(angles.iter().all(|angle| angle.abs() <= 1.7));
        }
    }

    #[test]
    fn out_of_reach_it_points_there() {
        let chain = arm();
        let mut angles = [0.3, 0.4, 0.5, 0.2];
        let target = DVec3::new(0.6, 0.6, 0.05);
        let got = pull(&chain, target, &mut angles);
        // A quarter metre of arm, stretched out at 45 degrees.
        assert!(
            (got.error_m - (target.truncate().length() - 0.25)).abs() < 1e-3,
            "{got:?} at {angles:?}"
        );
        assert!((angles[0] - std::f64::consts::FRAC_PI_4).abs() < 1e-2);
        let behind = DVec3::new(-0.2, 0.01, 0.05);
        let mut angles = [1.6, 0.4, 0.5, 0.2];
        let got = pull(&chain, behind, &mut angles);
        assert!(angles.iter().all(|angle| angle.abs() <= 1.7) && got.error_m.is_finite());
    }

    #[test]
    fn a_drag_is_smooth_and_the_same_every_time() {
        let chain = arm();
        let way = |angles: &mut [f64; 4]| {
            let mut most = 0.0_f64;
            for i in 0..100 {
                let before = *angles;
                let turn = f64::from(i) * 0.02;
                pull(
                    &chain,
                    DVec3::new(0.17 * turn.cos(), 0.17 * turn.sin().min(0.8), 0.1),
                    angles,
                );
                let step = angles
                    .iter()
                    .zip(before)
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, f64::max);
                most = if i > 0 { most.max(step) } else { most };
            }
            most
        };
        let (mut one, mut two) = ([0.0, -0.4, 0.8, 0.3], [0.0, -0.4, 0.8, 0.3]);
        let most = way(&mut one);
        way(&mut two);
        assert!(most < 0.2, "a jump of {most} rad");
        assert_eq!(one, two);
    }

    #[test]
    fn freedom_left_over_goes_to_rest() {
        let chain = arm();
        let mut angles = [0.0, -1.2, 1.5, 1.0];
        let target = hand(&chain, &angles);
        let away = |angles: &[f64; 4]| angles.iter().map(|a| a * a).sum::<f64>();
        let before = away(&angles);
        for _ in 0..50 {
            // A hand that holds still lets the rest settle.
            let near = target + DVec3::Z * 2e-6;
            pull(&chain, near, &mut angles);
            pull(&chain, target, &mut angles);
        }
        assert!(hand(&chain, &angles).distance(target) < 1e-5);
        assert!(away(&angles) < before, "{angles:?}");
    }

    #[test]
    fn led_joints_come_along_and_keep_their_range() {
        let coupling = Coupling {
            joint: JointIndex(2),
            follows: JointIndex(1),
            ratio: -2.0,
            offset_rad: 0.0,
        };
        let chain = arm().coupled(vec![coupling]).expect("valid");
        let mut angles = [0.0, 0.2, 0.0, 0.1];
        pull(&chain, DVec3::new(0.12, 0.05, 0.1), &mut angles);
        assert_eq!(angles[2], -2.0 * angles[1]);
        let got = pull(&chain, DVec3::new(0.0, 0.0, 0.3), &mut angles);
        assert!(angles[2].abs() <= 1.7 && angles[1].abs() <= 0.85 && got.error_m > 0.0);
    }

    #[test]
    fn what_is_no_target_moves_nothing() {
        let chain = arm();
        let mut angles = [0.1; 4];
        assert!(
            pull(&chain, DVec3::splat(f64::NAN), &mut angles)
                .error_m
                .is_infinite()
        );
        assert_eq!(angles, [0.1; 4]);
    }
}
