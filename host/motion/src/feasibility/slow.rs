//! Slow to fit: other key times for the same path, so that every joint can.
//!
//! Intervals between keys are stretched where something asks for it, round by round, since a natural spline hears
//! its neighbours; what is left after that is stretched as a whole, which is exact: time stretched by s divides
//! speeds by s and accelerations by its square.

use std::sync::Arc;

use super::judge::Judge;
use super::limits::JointLimits;
use super::torque::Loads;
use super::{Kind, Stretch};
use crate::joint_track::{JointPath, JointTrack};
use crate::kinetics::{Kinetics, KineticsError, KineticsMode, Ordering};
use thiserror::Error;

/// Rounds of stretching interval by interval (our choice).
const ROUNDS_MAX: u32 = 16;
/// The most that an interval is stretched in one round: neighbours then share what it needs (our choice).
const ROUND_MAX: f64 = 1.5;
/// Rounds of stretching as a whole; one is enough but for torque.
const WHOLE_ROUNDS_MAX: u32 = 8;
/// Neighbouring intervals are stretched by no more than this against each other in one round: abrupt spacing makes
/// a natural spline overshoot (our choice).
const NEIGHBOURS: f64 = 1.2;
/// Stretched by a hair more, so that rounding does not leave a joint just above its limit.
const HAIR: f64 = 1.0 + 1e-6;

/// How key times become kinetics.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// The mode.
    pub mode: KineticsMode,
    /// Amounts added to coefficients.
    pub edits: Vec<(usize, f64)>,
    /// Whether coefficients are kept in order.
    pub ordering: Ordering,
}

impl Timing {
    /// The kinetics of these key times.
    pub fn kinetics(&self, times_secs: &[f64]) -> Result<Kinetics, KineticsError> {
        let kinetics = Kinetics::new(times_secs, self.mode)?;
        if self.mode == KineticsMode::Natural
            && (!self.edits.is_empty() || self.ordering == Ordering::KeepForward)
        {
            return kinetics.edited(&self.edits, self.ordering);
        }
        Ok(kinetics)
    }
}

/// Why slowing does not help.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SlowError {
    /// The times make no kinetics.
    #[error(transparent)]
    Kinetics(#[from] KineticsError),
    /// Torque stayed too much, however slow.
    #[error(
        "slowing down by {factor:.1} is still not enough at joint {joint}; its load is too much at any speed"
    )]
    StillTooMuch {
        /// The joint's name.
        joint: String,
        /// How much slower was tried.
        factor: f64,
    },
}

/// A search for key times under way.
#[derive(Clone, Debug)]
pub struct Slowing {
    path: Arc<JointPath>,
    timing: Timing,
    limits: Arc<[JointLimits]>,
    loads: Option<Arc<Loads>>,
    given_secs: Vec<f64>,
    times_secs: Vec<f64>,
    kinetics: Kinetics,
    judge: Judge,
    round: u32,
    /// Times of the one whole stretch that would do, from the first round.
    whole_secs: Option<Vec<f64>>,
}

impl Slowing {
    /// Of a path with these key times.
    pub fn new(
        path: Arc<JointPath>,
        timing: Timing,
        times_secs: Vec<f64>,
        limits: Arc<[JointLimits]>,
        loads: Option<Arc<Loads>>,
    ) -> Result<Self, SlowError> {
        let kinetics = timing.kinetics(&times_secs)?;
        Ok(Self {
            judge: Judge::new(Arc::clone(&limits), loads.clone()),
            path,
            timing,
            limits,
            loads,
            given_secs: times_secs.clone(),
            times_secs,
            kinetics,
            round: 0,
            whole_secs: None,
        })
    }

    /// Goes on until about `work` microseconds were spent; gives the key times once they are known.
    pub fn advance(&mut self, work: usize) -> Option<Result<Vec<f64>, SlowError>> {
        let track = JointTrack {
            path: Arc::clone(&self.path),
            kinetics: self.kinetics.clone(),
        };
        let found = self.judge.advance(&track, work)?;
        let asks: Vec<(Stretch, f64)> = found
            .into_iter()
            .filter_map(|stretch| Some((stretch, stretch.slow_down?)))
            .filter(|(stretch, _)| stretch.kind != Kind::Reach)
            .collect();
        if asks.is_empty() {
            return Some(Ok(self.times_secs.clone()));
        }
        if self.round >= ROUNDS_MAX + WHOLE_ROUNDS_MAX {
            let joint = self.path.joints()[asks[0].0.joint].clone();
            let factor = span(&self.times_secs) / span(&self.given_secs);
            return Some(Err(SlowError::StillTooMuch { joint, factor }));
        }
        let next = self.next(&asks);
        self.round += 1;
        match self.timing.kinetics(&next) {
            Ok(kinetics) => {
                (self.times_secs, self.kinetics) = (next, kinetics);
                self.judge = Judge::new(Arc::clone(&self.limits), self.loads.clone());
                None
            }
            Err(error) => Some(Err(error.into())),
        }
    }

    /// The times of the next round.
    fn next(&mut self, asks: &[(Stretch, f64)]) -> Vec<f64> {
        let most = asks.iter().fold(1.0_f64, |most, (_, by)| most.max(*by)) * HAIR;
        if self.whole_secs.is_none() {
            self.whole_secs = Some(stretched(
                &self.given_secs,
                &vec![most; self.given_secs.len() - 1],
            ));
        }
        let intervals = self.times_secs.len() - 1;
        if self.round >= ROUNDS_MAX {
            return stretched(&self.times_secs, &vec![most; intervals]);
        }
        let next = stretched(&self.times_secs, &self.by_interval(asks));
        let whole = self
            .whole_secs
            .as_ref()
            .filter(|whole| span(whole) <= span(&next));
        let backwards = |times: &[f64]| {
            let now = self
                .timing
                .kinetics(times)
                .map_or(0, |kinetics| kinetics.reversals().len());
            now > self.kinetics.reversals().len()
        };
        match whole {
            Some(whole) => {
                self.round = ROUNDS_MAX;
                whole.clone()
            }
            // Not what slowing may do to a motion: all alike from here on.
            None if backwards(&next) => {
                self.round = ROUNDS_MAX;
                stretched(&self.times_secs, &vec![most; intervals])
            }
            None => next,
        }
    }

    /// How much each interval is asked to be stretched, with slopes towards those that are not.
    fn by_interval(&self, asks: &[(Stretch, f64)]) -> Vec<f64> {
        let mut by = vec![1.0_f64; self.times_secs.len() - 1];
        for (stretch, factor) in asks {
            for (interval, by) in by.iter_mut().enumerate() {
                let (start, end) = (self.times_secs[interval], self.times_secs[interval + 1]);
                if stretch.from_secs < end && stretch.to_secs > start {
                    *by = by.max((factor * HAIR).min(ROUND_MAX));
                }
            }
        }
        for i in 1..by.len() {
            by[i] = by[i].max(by[i - 1] / NEIGHBOURS);
        }
        for i in (1..by.len()).rev() {
            by[i - 1] = by[i - 1].max(by[i] / NEIGHBOURS);
        }
        by
    }
}

fn span(times_secs: &[f64]) -> f64 {
    times_secs.last().unwrap_or(&0.0) - times_secs.first().unwrap_or(&0.0)
}

/// Every interval by its own factor, from the first key on.
fn stretched(times_secs: &[f64], by: &[f64]) -> Vec<f64> {
    let mut at = times_secs.first().copied().unwrap_or(0.0);
    let mut out = vec![at];
    for (pair, by) in times_secs.windows(2).zip(by) {
        at += (pair[1] - pair[0]) * by;
        out.push(at);
    }
    out
}
