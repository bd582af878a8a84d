//! Whether a puppet can do a motion, judged along the whole of it before anything moves.
//!
//! Path and timing are both piecewise cubic, so between two cuts every joint's angle is one polynomial of time;
//! its speed and acceleration are bounded by hulls, not by looking at samples, and no peak can hide between two
//! frames. Where speeds change at once (corners of the path, the ends) the blend that cuts the corner is judged.
//! Torque is not polynomial; it is followed by halving until it is straight between the points looked at.

mod cuts;
mod judge;
mod limits;
mod polynomial;
mod slow;
mod torque;

pub use judge::{Judge, joined};
pub use limits::{CORNER_RAD, JointLimits};
pub use slow::{SlowError, Slowing, Timing};
pub use torque::{Load, Loads, Motor};

/// What a joint is asked too much of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// To be where it cannot be: beyond its range, or a pose that the puppet cannot take.
    Reach,
    /// To move faster than it can.
    Speed,
    /// To change its speed faster than it can.
    Acceleration,
    /// To push harder than its motor can at that speed.
    Torque,
}

/// A stretch of time over which one joint is asked too much of one thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// When it begins, seconds.
    pub from_secs: f64,
    /// When it ends, seconds; the same for a clip of one pose.
    pub to_secs: f64,
    /// Which joint, by its place in the path.
    pub joint: usize,
    /// Of what.
    pub kind: Kind,
    /// The most that is asked, against what it can; above 1.
    pub factor: f64,
    /// By what the time here must be stretched for this alone to fit, above 1; none where slowing does not help.
    pub slow_down: Option<f64>,
}
