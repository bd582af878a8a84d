//! How far joints lag behind: estimated while they move, from what was asked and what was measured.
//!
//! A delay is found by comparing the measured angles of the last seconds with the asked ones of 0, 10, 20 … ms
//! before: the delay that explains them best is the lag, refined by a parabola through its neighbours. For signals
//! of equal size the least sum of squared differences is where their cross-correlation is greatest (expand the
//! square); unlike a correlation it needs no mean of either. A constant difference, as of a joint that gravity
//! holds below its goal, is allowed for at a price, so that a movement in one direction alone still tells a delay
//! from a difference. Online: a few hundred additions a joint and tick, nothing allocated after the start.

mod course;
mod delay;

use course::Course;
use delay::Delay;

/// Longest lag that is looked for, seconds. Published leads of hobby servos reach 0.2 s
/// (Reachy Mini's constants of 2026: 0.205 s for head and body, 0.090 s for antennas).
pub const LAG_MAX_SECS: f64 = 0.3;
/// How far ahead of the clip's time its course is noted, so that a joint that comes early is seen, too.
pub const AHEAD_SECS: f64 = 0.05;
/// Fastest change of a lead: the motion is a tenth faster or slower meanwhile, which its limits still bound.
const LEAD_RATE: f64 = 0.1;
/// A lead this near to what it should be counts as reached, seconds.
const LEAD_REACHED_SECS: f64 = 0.002;

/// How well one joint follows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tracking {
    /// How long after its goals the joint is where they were, seconds; none until it has moved enough.
    pub lag_secs: Option<f64>,
    /// How long after the clip's time the joint is where the clip is, seconds, negative when it is early: with
    /// compensation what is left of the lag, without it the lag.
    pub behind_clip_secs: Option<f64>,
    /// How far ahead of the clip's time goals are taken, seconds; 0 without compensation.
    pub lead_secs: f64,
    /// Root mean square of measured angle minus goal of the same moment since playing began, radians.
    pub goal_error_rms_rad: f64,
    /// The same of measured angle minus the clip's angle, where compensation had what it wanted.
    pub clip_error_rms_rad: f64,
    /// Measurements in `goal_error_rms_rad`.
    pub goal_samples: u32,
    /// Measurements in `clip_error_rms_rad`.
    pub clip_samples: u32,
    /// Greatest speed of the goals as a share of the joint's limit since playing began.
    pub speed_ratio_max: f64,
    /// Greatest acceleration of the goals, likewise.
    pub acceleration_ratio_max: f64,
}

/// A sum of squares.
#[derive(Debug, Clone, Copy, Default)]
struct Squares {
    sum: f64,
    count: u32,
}

impl Squares {
    fn add(&mut self, difference: f64) {
        self.sum += difference * difference;
        self.count = self.count.saturating_add(1);
    }

    fn rms(self) -> f64 {
        (self.sum / f64::from(self.count.max(1))).sqrt()
    }
}

/// What one joint was asked, what it did, and the lag between.
#[derive(Debug, Clone)]
pub struct Follower {
    goals: Course,
    clip: Course,
    behind_goals: Delay,
    behind_clip: Delay,
    goal_errors: Squares,
    clip_errors: Squares,
    lead_secs: f64,
    lead_reached: bool,
    measured_secs: f64,
    goal: Option<(f64, f64)>,
    velocity_rad_per_s: Option<f64>,
    ratios: [f64; 2],
}

impl Default for Follower {
    fn default() -> Self {
        Self {
            goals: Course::default(),
            clip: Course::default(),
            behind_goals: Delay::default(),
            behind_clip: Delay::default(),
            goal_errors: Squares::default(),
            clip_errors: Squares::default(),
            lead_secs: 0.0,
            lead_reached: false,
            measured_secs: f64::NEG_INFINITY,
            goal: None,
            velocity_rad_per_s: None,
            ratios: [0.0; 2],
        }
    }
}

impl Follower {
    /// A goal was sent; limits are of speed and acceleration, for the shares in [`Tracking`].
    pub fn goal_sent(&mut self, at_secs: f64, goal_rad: f64, limits: [f64; 2]) {
        let [speed_max, acceleration_max] = limits;
        if let Some((before_secs, before_rad)) = self.goal
            && at_secs > before_secs
        {
            let dt_secs = at_secs - before_secs;
            let velocity = (goal_rad - before_rad) / dt_secs;
            let acceleration = self
                .velocity_rad_per_s
                .map_or(0.0, |before| (velocity - before) / dt_secs);
            let [speed, bend] = self.ratios;
            self.ratios = [
                speed.max(velocity.abs() / speed_max),
                bend.max(acceleration.abs() / acceleration_max),
            ];
            self.velocity_rad_per_s = Some(velocity);
        }
        self.goal = Some((at_secs, goal_rad));
        self.goals.push(at_secs, goal_rad);
    }

    /// Between this goal and the next no rate of change means anything: they were not sent one after the other.
    pub fn goals_interrupted(&mut self) {
        self.goal = None;
        self.velocity_rad_per_s = None;
    }

    /// The angle that the clip has [`AHEAD_SECS`] after `now_secs`.
    pub fn clip_ahead(&mut self, now_secs: f64, angle_rad: f64) {
        self.clip.push(now_secs + AHEAD_SECS, angle_rad);
    }

    /// The clip's time has jumped, or another clip is played: what was noted of it says nothing any more.
    pub fn clip_interrupted(&mut self) {
        self.clip.clear();
    }

    /// The joint was measured; older measurements and repeated ones change nothing.
    pub fn measured(&mut self, at_secs: f64, angle_rad: f64) {
        if at_secs <= self.measured_secs {
            return;
        }
        let since_secs = at_secs - self.measured_secs;
        self.measured_secs = at_secs;
        let since_secs = since_secs.min(LAG_MAX_SECS);
        self.behind_goals
            .take(&self.goals, at_secs, angle_rad, since_secs);
        self.behind_clip
            .take(&self.clip, at_secs + AHEAD_SECS, angle_rad, since_secs);
        let playing = self.clip.at(at_secs);
        if let (Some(wished), Some(goal)) = (playing, self.goals.at(at_secs)) {
            self.goal_errors.add(angle_rad - goal);
            if self.lead_reached {
                self.clip_errors.add(angle_rad - wished);
            }
        }
    }

    /// Moves the lead towards the lag, or back to nothing, by as much as `dt_secs` allow. Returns it.
    pub fn lead(&mut self, compensate: bool, dt_secs: f64) -> f64 {
        let wanted = if compensate {
            self.lag_secs().unwrap_or(self.lead_secs)
        } else {
            0.0
        };
        let reach = LEAD_RATE * dt_secs.max(0.0);
        self.lead_secs += (wanted - self.lead_secs).clamp(-reach, reach);
        let known = !compensate || self.lag_secs().is_some();
        self.lead_reached = known && (wanted - self.lead_secs).abs() <= LEAD_REACHED_SECS;
        self.lead_secs
    }

    /// Playing begins at a pose that the goals have approached: without a lead.
    pub fn playing_begins(&mut self) {
        self.lead_secs = 0.0;
        self.lead_reached = false;
        self.clip.clear();
    }

    /// Something new is played: errors and shares are counted from here. What is known of the lag stays.
    pub fn count_anew(&mut self) {
        self.goal_errors = Squares::default();
        self.clip_errors = Squares::default();
        self.ratios = [0.0; 2];
        self.behind_clip.forget();
    }

    /// Torque was off or lines were silent: courses begin anew.
    pub fn forget_courses(&mut self) {
        self.goals.clear();
        self.clip.clear();
        self.goals_interrupted();
    }

    /// The lag behind the goals, if it is known.
    pub fn lag_secs(&self) -> Option<f64> {
        self.behind_goals.secs()
    }

    /// All that is known.
    pub fn tracking(&self) -> Tracking {
        let [speed_ratio_max, acceleration_ratio_max] = self.ratios;
        Tracking {
            lag_secs: self.lag_secs(),
            behind_clip_secs: self.behind_clip.secs().map(|secs| secs - AHEAD_SECS),
            lead_secs: self.lead_secs,
            goal_error_rms_rad: self.goal_errors.rms(),
            clip_error_rms_rad: self.clip_errors.rms(),
            goal_samples: self.goal_errors.count,
            clip_samples: self.clip_errors.count,
            speed_ratio_max,
            acceleration_ratio_max,
        }
    }
}

#[cfg(test)]
mod tests;
