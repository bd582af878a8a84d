//! What a joint may be asked for.

use crate::curve::Interval;

/// Limits of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLimits {
    /// Where it may go, radians.
    pub range_rad: Interval,
    /// How fast, radians a second; infinite where nobody knows.
    pub speed_max_rad_per_s: f64,
    /// How fast its speed may change, radians a second squared; infinite where nobody knows.
    pub accel_max_rad_per_s2: f64,
}

/// How far a joint may be off its path where the path has a corner, radians (our choice: two degrees, which nobody
/// sees on a small puppet).
pub const CORNER_RAD: f64 = 0.035;

impl JointLimits {
    /// The acceleration that a sudden change of speed asks for, when the corner is cut by no more than
    /// [`CORNER_RAD`]: a blend of duration T leaves the path by dv T / 8 and takes dv / T.
    /// Source: T. Kunz, M. Stilman, Time-Optimal Trajectory Generation for Path Following with Bounded
    /// Acceleration and Velocity, RSS 2012 (blends); Lynch and Park, Modern Robotics, section 9.2 (parabolic blends).
    pub(super) fn corner_accel(change_rad_per_s: f64) -> f64 {
        change_rad_per_s * change_rad_per_s / (8.0 * CORNER_RAD)
    }
}
