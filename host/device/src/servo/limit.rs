//! The one stage every goal passes before it can reach a servo.
//!
//! Pure: numbers in, numbers out. For any targets (jumping, reversing, not finite) and any
//! time steps, the goals given out keep, between successive goals p with v = Δp/Δt,
//! |v| <= velocity limit, |Δv|/Δt <= acceleration limit, and stay inside the range, because a
//! step is only taken if one could still brake inside the range afterwards. A target that
//! itself keeps the limits is followed without lag once it is caught up with.
//!
//! Source: the stopping distance v²/2a of uniform deceleration; in discrete time with step h the
//! fastest v whose step and stopping distance fit into d solves v·h + v²/2a = d. Braking in
//! steps of any size needs no more than v²/2a, so the bound holds for irregular ticks.
//!
//! A limit of jerk is kept by rounding the wishes before (module `jerk`), so that none of this depends on it; braking is
//! as short as ever.

use super::jerk::Rounding;

/// Part of a limit that is never used, so that rounding in whoever takes differences of the
/// goals cannot show more than the limit: 1e-6 covers positions to 10 rad at 0.1 ms steps.
const HEADROOM: f64 = 1e-6;
/// Longest step in which a target is followed, in seconds. After a longer pause (a stall of the
/// host) the goal only brakes, for where the target went meanwhile may be far away.
pub const STEP_MAX_SECS: f64 = 0.1;
/// Longest time over which wishes are rounded, in seconds.
pub const ROUNDING_MAX_SECS: f64 = 2.0;
/// Difference of position that is not worth reporting, in radians.
const NEGLIGIBLE_RAD: f64 = 1e-9;

/// Why limits are no limits.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LimitsError {
    /// The ends of the range are not numbers, or the wrong way round.
    #[error("range {min_rad} to {max_rad} rad: expected two finite numbers, the lower first")]
    Range {
        /// Lower end as given.
        min_rad: f64,
        /// Upper end as given.
        max_rad: f64,
    },
    /// Speed and acceleration must be positive, or nothing could move or brake.
    #[error("{what} limit {value}: expected a finite number above zero")]
    Rate {
        /// "speed", "acceleration" or "jerk".
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// A limit of jerk so low that rounding would take longer than anybody can wait for a joint.
    #[error(
        "jerk limit {jerk_max_rad_per_s3}: at least {least} for this limit of acceleration, or each change takes longer than {ROUNDING_MAX_SECS} s"
    )]
    Jerk {
        /// As given.
        jerk_max_rad_per_s3: f64,
        /// The least that is allowed.
        least: f64,
    },
    /// A servo whose position is unknown must not be commanded.
    #[error("start position {position_rad} rad: expected a finite measured position")]
    Start {
        /// As given.
        position_rad: f64,
    },
}

/// What one joint may do. Valid by construction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    min_rad: f64,
    max_rad: f64,
    velocity_max_rad_per_s: f64,
    acceleration_max_rad_per_s2: f64,
    jerk_max_rad_per_s3: Option<f64>,
}

impl Limits {
    /// Refuses anything that is not finite, an empty range, and rates that are not positive.
    pub fn new(
        range_rad: [f64; 2],
        velocity_max_rad_per_s: f64,
        acceleration_max_rad_per_s2: f64,
    ) -> Result<Self, LimitsError> {
        let [min_rad, max_rad] = range_rad;
        if !(min_rad.is_finite() && max_rad.is_finite() && min_rad <= max_rad) {
            return Err(LimitsError::Range { min_rad, max_rad });
        }
        for (what, value) in [
            ("speed", velocity_max_rad_per_s),
            ("acceleration", acceleration_max_rad_per_s2),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(LimitsError::Rate { what, value });
            }
        }
        Ok(Self {
            min_rad,
            max_rad,
            velocity_max_rad_per_s,
            acceleration_max_rad_per_s2,
            jerk_max_rad_per_s3: None,
        })
    }

    /// The same limits with one of jerk, in rad/s³. Refuses what is not positive, and what would round for longer than
    /// [`ROUNDING_MAX_SECS`].
    pub fn with_jerk(mut self, jerk_max_rad_per_s3: f64) -> Result<Self, LimitsError> {
        if !(jerk_max_rad_per_s3.is_finite() && jerk_max_rad_per_s3 > 0.0) {
            return Err(LimitsError::Rate {
                what: "jerk",
                value: jerk_max_rad_per_s3,
            });
        }
        let least = 2.0 * self.acceleration_max_rad_per_s2 / ROUNDING_MAX_SECS;
        if jerk_max_rad_per_s3 < least {
            return Err(LimitsError::Jerk {
                jerk_max_rad_per_s3,
                least,
            });
        }
        self.jerk_max_rad_per_s3 = Some(jerk_max_rad_per_s3);
        Ok(self)
    }

    /// Lower end of the range.
    pub fn min_rad(&self) -> f64 {
        self.min_rad
    }

    /// Upper end of the range.
    pub fn max_rad(&self) -> f64 {
        self.max_rad
    }

    /// Fastest change of the goal.
    pub fn velocity_max_rad_per_s(&self) -> f64 {
        self.velocity_max_rad_per_s
    }

    /// Fastest change of the goal's velocity.
    pub fn acceleration_max_rad_per_s2(&self) -> f64 {
        self.acceleration_max_rad_per_s2
    }

    /// Fastest change of the goal's acceleration while wishes are followed in steady ticks, if there is such a limit.
    /// Braking may be quicker.
    pub fn jerk_max_rad_per_s3(&self) -> Option<f64> {
        self.jerk_max_rad_per_s3
    }

    /// The same limits with a lower speed; a speed that is no lower, or no speed, changes nothing.
    #[must_use]
    pub fn slower(mut self, velocity_max_rad_per_s: f64) -> Self {
        if velocity_max_rad_per_s > 0.0 && velocity_max_rad_per_s < self.velocity_max_rad_per_s {
            self.velocity_max_rad_per_s = velocity_max_rad_per_s;
        }
        self
    }

    /// Whether a position is inside the range, give or take `slack_rad`.
    pub fn contains(&self, position_rad: f64, slack_rad: f64) -> bool {
        position_rad >= self.min_rad - slack_rad && position_rad <= self.max_rad + slack_rad
    }
}

/// What the limiter changed about a wish.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change {
    /// The wish was no number: the goal brakes instead.
    NotFinite,
    /// The wish was outside the range, by so much.
    Position {
        /// Distance from the nearer end; positive above the range.
        by_rad: f64,
    },
    /// The wish could not be reached in this step at the highest speed.
    Velocity,
    /// The wish could not be reached in this step at the highest acceleration or deceleration.
    Acceleration,
    /// The time since the last goal was too long (or none): the goal brakes instead.
    Stalled,
}

/// The goal after one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limited {
    /// The goal to send, before it is rounded to counts.
    pub position_rad: f64,
    /// Its velocity in this step.
    pub velocity_rad_per_s: f64,
    /// What was changed, if anything; the first that applies in the order of [`Change`].
    pub change: Option<Change>,
}

/// The memory of one joint's goal: where it is and how fast it moves.
#[derive(Debug, Clone)]
pub struct Limiter {
    limits: Limits,
    velocity_max: f64,
    acceleration_max: f64,
    position: f64,
    velocity: f64,
    target_before: Option<f64>,
    target_velocity: f64,
    rounding: Option<Box<Rounding>>,
}

impl Limiter {
    /// Starts where the servo was *measured*, at rest. Outside the range it may only move inwards.
    pub fn at_rest(limits: Limits, measured_rad: f64) -> Result<Self, LimitsError> {
        let rounding = Rounding::at_rest(limits, measured_rad)?.map(Box::new);
        Ok(Self {
            rounding,
            ..Self::unrounded(limits, measured_rad)?
        })
    }

    /// The same without a limit of jerk.
    pub(super) fn unrounded(limits: Limits, measured_rad: f64) -> Result<Self, LimitsError> {
        if !measured_rad.is_finite() {
            return Err(LimitsError::Start {
                position_rad: measured_rad,
            });
        }
        Ok(Self {
            limits,
            velocity_max: limits.velocity_max_rad_per_s * (1.0 - HEADROOM),
            acceleration_max: limits.acceleration_max_rad_per_s2 * (1.0 - HEADROOM),
            position: measured_rad,
            velocity: 0.0,
            target_before: None,
            target_velocity: 0.0,
            rounding: None,
        })
    }

    /// The last goal.
    pub fn position_rad(&self) -> f64 {
        self.position
    }

    /// The last goal's velocity.
    pub fn velocity_rad_per_s(&self) -> f64 {
        self.velocity
    }

    /// Whether the goal stands, and stays where it is if the wish does.
    pub fn is_still(&self) -> bool {
        self.velocity == 0.0 && self.rounding.as_ref().is_none_or(|rounding| rounding.is_still())
    }

    /// The next goal, `dt_secs` after the last one, towards `target_rad`.
    pub fn step(&mut self, target_rad: f64, dt_secs: f64) -> Limited {
        if !(dt_secs > 0.0 && dt_secs.is_finite()) {
            return self.unmoved();
        }
        if dt_secs > STEP_MAX_SECS {
            return self.brake_because(Change::Stalled, dt_secs);
        }
        if !target_rad.is_finite() {
            return self.brake_because(Change::NotFinite, dt_secs);
        }
        match &mut self.rounding {
            Some(rounding) => {
                let (rounded_rad, change) = rounding.round(target_rad, dt_secs);
                let limited = self.follow(rounded_rad, dt_secs);
                Limited {
                    change: change.or(limited.change),
                    ..limited
                }
            }
            None => self.follow(target_rad, dt_secs),
        }
    }

    fn follow(&mut self, target_rad: f64, dt_secs: f64) -> Limited {
        let target = target_rad.clamp(self.limits.min_rad, self.limits.max_rad);
        let before = self.position;
        let velocity_before = self.velocity;
        let wanted = self.wanted_velocity(target, dt_secs);
        self.advance(wanted, dt_secs);
        let direct = (target - before) / dt_secs;
        let change = if target == target_rad {
            self.rate_change(target, direct, velocity_before, dt_secs)
        } else {
            Some(Change::Position {
                by_rad: target_rad - target,
            })
        };
        self.goal(change)
    }

    /// The next goal when nothing is wanted but to stand: the shortest stop.
    pub fn brake(&mut self, dt_secs: f64) -> Limited {
        if !(dt_secs > 0.0 && dt_secs.is_finite()) {
            return self.unmoved();
        }
        self.forget_target();
        self.advance(0.0, dt_secs);
        if let Some(rounding) = &mut self.rounding {
            rounding.rest_at(self.position);
        }
        self.goal(None)
    }

    fn brake_because(&mut self, change: Change, dt_secs: f64) -> Limited {
        let limited = self.brake(dt_secs);
        Limited {
            change: Some(change),
            ..limited
        }
    }

    fn unmoved(&mut self) -> Limited {
        self.forget_target();
        if let Some(rounding) = &mut self.rounding {
            rounding.rest_at(self.position);
        }
        Limited {
            position_rad: self.position,
            velocity_rad_per_s: 0.0,
            change: Some(Change::Stalled),
        }
    }

    fn goal(&self, change: Option<Change>) -> Limited {
        Limited {
            position_rad: self.position,
            velocity_rad_per_s: self.velocity,
            change,
        }
    }

    fn forget_target(&mut self) {
        self.target_before = None;
        self.target_velocity = 0.0;
    }

    /// Follows the target's own velocity and closes what is left as fast as one can brake
    /// relative to it.
    fn wanted_velocity(&mut self, target: f64, dt: f64) -> f64 {
        let seen = self.target_before.map_or(0.0, |before| (target - before) / dt);
        // A target that keeps the limits changes its velocity by no more than this; a jump must
        // not be mistaken for a very fast target.
        let slew = self.acceleration_max * dt;
        self.target_velocity = seen
            .clamp(self.target_velocity - slew, self.target_velocity + slew)
            .clamp(-self.velocity_max, self.velocity_max);
        self.target_before = Some(target);
        let left = target - self.position - self.target_velocity * dt;
        self.target_velocity + self.braking_velocity(left.abs(), dt).copysign(left)
    }

    /// The highest velocity whose step and whose stopping distance fit into `distance`.
    fn braking_velocity(&self, distance: f64, dt: f64) -> f64 {
        let a = self.acceleration_max;
        let d = distance.max(0.0);
        // a·(sqrt(h² + 2d/a) − h), written without the cancellation for small d.
        2.0 * d / ((dt * dt + 2.0 * d / a).sqrt() + dt)
    }

    /// Moves with the velocity nearest to `wanted` that all limits allow.
    fn advance(&mut self, wanted: f64, dt: f64) {
        let slew = self.acceleration_max * dt;
        let up = self
            .braking_velocity(self.limits.max_rad - self.position, dt)
            .min(self.velocity_max);
        let down = self
            .braking_velocity(self.position - self.limits.min_rad, dt)
            .min(self.velocity_max);
        // Range last but one, acceleration last: from inside the range the range can always be
        // kept by braking, so both hold, and rounding is settled in favour of a smooth motion.
        let velocity = wanted
            .clamp(-down, up)
            .clamp(self.velocity - slew, self.velocity + slew);
        let inside = self.limits.contains(self.position, 0.0);
        self.position += velocity * dt;
        if inside {
            self.position = self.position.clamp(self.limits.min_rad, self.limits.max_rad);
        }
        self.velocity = velocity;
    }

    fn rate_change(&self, target: f64, direct: f64, velocity_before: f64, dt: f64) -> Option<Change> {
        if (self.position - target).abs() <= NEGLIGIBLE_RAD {
            None
        } else if direct.abs() > self.velocity_max {
            Some(Change::Velocity)
        } else if (direct - velocity_before).abs() > self.acceleration_max * dt {
            Some(Change::Acceleration)
        } else {
            // Reachable now, but not without overshooting afterwards.
            Some(Change::Acceleration)
        }
    }
}

#[cfg(test)]
#[path = "limit_tests.rs"]
mod tests;
