//! Rounds the corners of a joint's wishes, so that its acceleration changes no faster than a limit of jerk allows.
//!
//! A wish first goes through a limiter of its own, which makes a motion of it that keeps range, speed and
//! acceleration. The mean of that motion over the last `2 a / j` seconds, `a` being the limit of acceleration and `j`
//! that of jerk, keeps them too, for a mean lies between what it is taken of; and since its acceleration is the
//! difference of two speeds over that time, and each of these changes by at most `a` a second, it changes by at most
//! `2 a / (2 a / j) = j` a second. It is late by half of that time, as a joint is late for other reasons, and lag
//! compensation sees both. (The S-curve as a moving mean of a trapezoid: Biagiotti and Melchiorri, *Trajectory
//! Planning for Automatic Machines and Robots*, 2008, section 4.5.)
//!
//! This stands *before* the one stage that limits and changes nothing about it: braking is never delayed.

use super::limit::{Change, Limiter, Limits, LimitsError};

/// A wish comes at most so often; more often, and the window is shorter than wanted.
const STEP_MIN_SECS: f64 = 5e-4;
/// How long time is counted from one beginning.
const EPOCH_SECS: f64 = 60.0;

/// One joint's wishes over a window of time.
#[derive(Debug, Clone)]
pub(super) struct Rounding {
    limits: Limits,
    window_secs: f64,
    limiter: Limiter,
    /// A ring; the last window of time lies in it.
    points: Vec<Point>,
    newest: usize,
    count: usize,
}

/// Where the motion was, and the integral of it from some time before to then.
#[derive(Debug, Clone, Copy, Default)]
struct Point {
    secs: f64,
    position: f64,
    integral: f64,
}

impl Rounding {
    /// Starts at rest at the measured position. `None` where there is no limit of jerk.
    pub(super) fn at_rest(limits: Limits, measured_rad: f64) -> Result<Option<Self>, LimitsError> {
        let Some(jerk_max) = limits.jerk_max_rad_per_s3() else {
            return Ok(None);
        };
        let window_secs = 2.0 * limits.acceleration_max_rad_per_s2() / jerk_max;
        let points = (window_secs / STEP_MIN_SECS).ceil() as usize + 2;
        let mut rounding = Self {
            limits,
            window_secs,
            limiter: Limiter::unrounded(limits, measured_rad)?,
            points: vec![Point::default(); points],
            newest: 0,
            count: 0,
        };
        rounding.rest_at(measured_rad);
        Ok(Some(rounding))
    }

    /// Begins again at rest.
    pub(super) fn rest_at(&mut self, position_rad: f64) {
        // The position is a goal that was given out, or a measured one that was accepted: a number.
        if let Ok(limiter) = Limiter::unrounded(self.limits, position_rad) {
            self.limiter = limiter;
        }
        (self.newest, self.count) = (0, 1);
        if let Some(first) = self.points.first_mut() {
            *first = Point {
                position: position_rad,
                ..Point::default()
            };
        }
    }

    /// Whether the motion stood all through the window.
    pub(super) fn is_still(&self) -> bool {
        let newest = self.point(0);
        let in_window = (0..self.count)
            .map(|back| self.point(back))
            .take_while(|point| point.secs > newest.secs - self.window_secs);
        self.limiter.is_still()
            && in_window
                .into_iter()
                .all(|point| point.position == newest.position)
    }

    /// The rounded wish, `dt_secs` after the last one, and what had to be changed about the wish before.
    pub(super) fn round(&mut self, target_rad: f64, dt_secs: f64) -> (f64, Option<Change>) {
        if self.point(0).secs > EPOCH_SECS {
            self.begin_anew();
        }
        let limited = self.limiter.step(target_rad, dt_secs);
        let before = self.point(0);
        let secs = before.secs + dt_secs;
        // The motion is straight between two points.
        let integral = before.integral + dt_secs * f64::midpoint(before.position, limited.position_rad);
        self.push(Point {
            secs,
            position: limited.position_rad,
            integral,
        });
        let mean = (integral - self.integral_at(secs - self.window_secs)) / self.window_secs;
        (mean, limited.change)
    }

    fn push(&mut self, point: Point) {
        self.newest = (self.newest + 1) % self.points.len();
        self.count = (self.count + 1).min(self.points.len());
        if let Some(place) = self.points.get_mut(self.newest) {
            *place = point;
        }
    }

    /// Counts time and integral from the newest point again, lest they grow until small differences drown in them.
    fn begin_anew(&mut self) {
        let newest = self.point(0);
        for point in &mut self.points {
            point.secs -= newest.secs;
            point.integral -= newest.integral;
        }
    }

    /// The point so many before the newest.
    fn point(&self, back: usize) -> Point {
        let place = (self.newest + self.points.len() - back) % self.points.len();
        self.points.get(place).copied().unwrap_or_default()
    }

    /// The integral at a time that lies among the points, or before them, when the joint stood at the oldest.
    fn integral_at(&self, secs: f64) -> f64 {
        let mut after = self.point(0);
        for back in 1..self.count {
            let point = self.point(back);
            if point.secs <= secs {
                let share = (secs - point.secs) / (after.secs - point.secs);
                let there = point.position + share * (after.position - point.position);
                return point.integral + (secs - point.secs) * f64::midpoint(point.position, there);
            }
            after = point;
        }
        after.integral - (after.secs - secs) * after.position
    }
}

#[cfg(test)]
#[path = "jerk_tests.rs"]
mod tests;
