//! One group against one link: damped least squares in a box.
//!
//! Minimises E = |d - d_t|^2 + w |x - x_t|^2 + mu |q - q_before|^2 over the joints' ranges, warm from the
//! frame before; when that ends badly, from a grid as well, and another branch is taken only if it halves E.
//! Source: K. Levenberg (1944), D. Marquardt (1963), with the box kept by holding joints that push outwards.

use super::GROUP_JOINTS_MAX;
use super::report::GroupReport;
use crate::chain::JointIndex;
use crate::curve::Interval;
use crate::figure::LinkIndex;
use glam::{DMat3, DVec3};

/// Weight of the x axis against the direction, for links with twist (our choice).
const TWIST_WEIGHT: f64 = 0.25;
/// Weight of staying where one is, so that a free joint has one answer (our choice).
const STAY_WEIGHT: f64 = 1e-6;
/// Above this E other branches are looked for (our choice).
const POOR_COST: f64 = 0.02;
/// Points of the search grid along each joint's range (our choice).
const GRID_POINTS: usize = 7;
/// How many of the grid's best are refined (our choice).
const GRID_BEST: usize = 24;
/// Another branch must be this much better, or the puppet would flicker between two (our choice).
const BRANCH_SHARE: f64 = 0.5;
/// Steps of one refinement; a warm start needs three or four.
const STEPS_MAX: usize = 200;
/// A step that gains less than this share has arrived.
const LEAST_GAIN: f64 = 1e-15;
/// A step that gains less than this share is slow, and the next may be longer.
const SLOW_GAIN: f64 = 0.1;
/// The longest stride, in steps.
const STRIDE_MAX: f64 = 64.0;
/// A joint this near its limit stands at it, radians.
const LIMIT_SLACK_RAD: f64 = 1e-9;

type Angles = [f64; GROUP_JOINTS_MAX];

/// When other branches than the nearest are looked for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Search {
    /// In any case.
    Always,
    /// Only where the nearest one is poor.
    WhenPoor,
}

/// One joint of a group.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub(super) parent_from_joint: DMat3,
    pub(super) axis: DVec3,
    pub(super) range: Interval,
}

/// One group, prepared.
#[derive(Clone, Debug)]
pub(super) struct Task {
    pub(super) link: LinkIndex,
    pub(super) joints: Vec<JointIndex>,
    /// The joint that the group hangs from.
    pub(super) parent: Option<JointIndex>,
    pub(super) steps: Vec<Step>,
    pub(super) joint_from_link: DMat3,
    pub(super) twist_counts: bool,
}

/// What a group is asked for in one frame.
struct Goal<'a> {
    task: &'a Task,
    world_from_parent: DMat3,
    direction: DVec3,
    x: DVec3,
    twist_weight: f64,
    before: Angles,
}

/// Where the group's link is at some angles, and about which world axes it turns.
struct Reached {
    direction: DVec3,
    x: DVec3,
    axes: [DVec3; GROUP_JOINTS_MAX],
}

impl Task {
    /// Finds the group's angles and writes them into `angles`, which hold those of the frame before.
    pub(super) fn solve(
        &self,
        world_from_parent: DMat3,
        world_from_link: &DMat3,
        angles: &mut [f64],
        search: Search,
    ) -> GroupReport {
        let mut before = [0.0; GROUP_JOINTS_MAX];
        for (into, joint) in before.iter_mut().zip(&self.joints) {
            *into = angles[joint.index()];
        }
        let goal = Goal {
            task: self,
            world_from_parent,
            direction: world_from_link.z_axis,
            x: world_from_link.x_axis,
            twist_weight: if self.twist_counts { TWIST_WEIGHT } else { 0.0 },
            before,
        };
        let (mut best, mut cost) = goal.refine(goal.boxed(before));
        let mut switched = false;
        if search == Search::Always || cost > POOR_COST {
            let (other, other_cost) = goal.search();
            if other_cost < BRANCH_SHARE * cost {
                (best, cost, switched) = (other, other_cost, true);
            }
        }
        for (joint, angle) in self.joints.iter().zip(best) {
            angles[joint.index()] = angle;
        }
        self.report(&goal, best, cost, switched)
    }

    fn report(&self, goal: &Goal<'_>, angles: Angles, cost: f64, switched: bool) -> GroupReport {
        let reached = goal.reach(&angles).direction;
        let mut at_limit = [false; GROUP_JOINTS_MAX];
        for ((flag, step), angle) in at_limit.iter_mut().zip(&self.steps).zip(angles) {
            let gap = (angle - step.range.start).min(step.range.end - angle);
            *flag = gap <= LIMIT_SLACK_RAD;
        }
        let direction_error_rad = reached
            .cross(goal.direction)
            .length()
            .atan2(reached.dot(goal.direction));
        GroupReport {
            link: self.link,
            cost,
            direction_error_rad,
            at_limit,
            switched,
        }
    }
}

impl Goal<'_> {
    fn count(&self) -> usize {
        self.task.steps.len()
    }

    fn boxed(&self, mut angles: Angles) -> Angles {
        for (angle, step) in angles.iter_mut().zip(&self.task.steps) {
            *angle = step.range.clamp(*angle);
        }
        angles
    }

    fn reach(&self, angles: &Angles) -> Reached {
        let mut rotation = self.world_from_parent;
        let mut axes = [DVec3::ZERO; GROUP_JOINTS_MAX];
        for ((step, &angle), axis) in self.task.steps.iter().zip(angles).zip(&mut axes) {
            rotation *= step.parent_from_joint;
            *axis = rotation * step.axis;
            rotation *= DMat3::from_axis_angle(step.axis, angle);
        }
        rotation *= self.task.joint_from_link;
        Reached {
            direction: rotation.z_axis,
            x: rotation.x_axis,
            axes,
        }
    }

    fn cost(&self, angles: &Angles) -> f64 {
        self.cost_of(&self.reach(angles), angles)
    }

    fn cost_of(&self, reached: &Reached, angles: &Angles) -> f64 {
        let moved: f64 = angles
            .iter()
            .zip(&self.before)
            .take(self.count())
            .map(|(a, b)| (a - b) * (a - b))
            .sum();
        (reached.direction - self.direction).length_squared()
            + self.twist_weight * (reached.x - self.x).length_squared()
            + STAY_WEIGHT * moved
    }

    /// Gradient halves and Gauss-Newton matrix of the cost.
    fn normal_equations(&self, reached: &Reached, angles: &Angles) -> (Angles, [Angles; GROUP_JOINTS_MAX]) {
        let n = self.count();
        let (mut gradient, mut matrix) = ([0.0; 3], [[0.0; 3]; 3]);
        let direction_by = reached.axes.map(|axis| axis.cross(reached.direction));
        let x_by = reached.axes.map(|axis| axis.cross(reached.x));
        let (direction_gap, x_gap) = (reached.direction - self.direction, reached.x - self.x);
        for i in 0..n {
            gradient[i] = direction_by[i].dot(direction_gap)
                + self.twist_weight * x_by[i].dot(x_gap)
                + STAY_WEIGHT * (angles[i] - self.before[i]);
            for j in 0..n {
                matrix[i][j] =
                    direction_by[i].dot(direction_by[j]) + self.twist_weight * x_by[i].dot(x_by[j]);
            }
            matrix[i][i] += STAY_WEIGHT;
        }
        (gradient, matrix)
    }

    /// Walks downhill from there to the nearest minimum in the box.
    fn refine(&self, start: Angles) -> (Angles, f64) {
        let mut angles = start;
        let mut reached = self.reach(&angles);
        let mut cost = self.cost_of(&reached, &angles);
        let (mut damping, mut stride) = (1e-3, 1.0);
        for _ in 0..STEPS_MAX {
            let step = self.step(&reached, &angles, damping) * stride;
            let next = self.boxed([angles[0] + step.x, angles[1] + step.y, angles[2] + step.z]);
            let next_reached = self.reach(&next);
            let next_cost = self.cost_of(&next_reached, &next);
            if next_cost < cost {
                let gain = cost - next_cost;
                if gain <= LEAST_GAIN * cost && stride == 1.0 {
                    return (next, next_cost);
                }
                // Far from the goal the model is too stiff and steps are too short: try longer ones.
                stride = if gain < SLOW_GAIN * cost {
                    (stride * 2.0).min(STRIDE_MAX)
                } else {
                    1.0
                };
                (angles, reached, cost) = (next, next_reached, next_cost);
                damping = (damping * 0.3).max(1e-12);
            } else if stride > 1.0 {
                stride = 1.0;
            } else if damping > 1e9 || next == angles {
                break;
            } else {
                damping *= 10.0;
            }
        }
        (angles, cost)
    }

    /// The damped step from there; joints at a limit that would push outwards are held.
    fn step(&self, reached: &Reached, angles: &Angles, damping: f64) -> DVec3 {
        let (gradient, mut matrix) = self.normal_equations(reached, angles);
        let mut downhill = gradient.map(|g| -g);
        for i in 0..GROUP_JOINTS_MAX {
            if i >= self.count() || self.pushes_outwards(i, angles[i], downhill[i]) {
                for row in &mut matrix {
                    row[i] = 0.0;
                }
                matrix[i] = [0.0; GROUP_JOINTS_MAX];
                matrix[i][i] = 1.0;
                downhill[i] = 0.0;
            } else {
                matrix[i][i] *= 1.0 + damping;
            }
        }
        // Symmetric, so rows serve as columns; damped, so it has an inverse.
        let [a, b, c] = matrix.map(DVec3::from_array);
        DMat3::from_cols(a, b, c).inverse() * DVec3::from_array(downhill)
    }

    fn pushes_outwards(&self, joint: usize, angle: f64, downhill: f64) -> bool {
        let range = self.task.steps[joint].range;
        (angle <= range.start && downhill < 0.0) || (angle >= range.end && downhill > 0.0)
    }

    /// The best minimum from a grid over the whole box.
    fn search(&self) -> (Angles, f64) {
        let mut starts: Vec<(f64, Angles)> = Vec::new();
        let total = GRID_POINTS.pow(self.count() as u32);
        for cell in 0..total {
            let (mut angles, mut rest) = ([0.0; GROUP_JOINTS_MAX], cell);
            for (angle, step) in angles.iter_mut().zip(&self.task.steps) {
                let share = (rest % GRID_POINTS) as f64 / (GRID_POINTS - 1) as f64;
                // Clamped, since start plus length can round to a hair beyond the end.
                *angle = step.range.clamp(step.range.start + step.range.length() * share);
                rest /= GRID_POINTS;
            }
            starts.push((self.cost(&angles), angles));
        }
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts
            .into_iter()
            .take(GRID_BEST)
            .map(|(_, start)| self.refine(start))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((self.before, f64::INFINITY))
    }
}
