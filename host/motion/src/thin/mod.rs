//! Thinning: which of many poses must stay keys, so that what is played between them stays near all the others.
//!
//! The judge is the playable form itself, kinetics included: what a clip of the kept keys shows at the time of
//! every pose that was dropped, not a line between neighbours. Two poses, the first and the last, are kept at
//! first; where the clip is too far off, the worst pose of each interval becomes a key, until nothing is too far
//! off. A pose that is a key is met, so this ends. Then keys that are no longer needed are taken out again, each
//! time judged anew. The work is cut into pieces, for a caller that has other things to do.

mod figure;
mod joints;

pub use figure::{FigurePerformance, FigureTolerance, SeenPose};
pub use joints::JointPerformance;

use std::collections::BTreeSet;
use thiserror::Error;

/// Why a performance cannot be thinned. Poses count from 0.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ThinError {
    /// There is nothing to keep.
    #[error("there is no pose to thin")]
    Empty,
    /// A tolerance is above zero, or nothing could be left out.
    #[error("a tolerance must be a number above zero; {what} is {value}")]
    Tolerance {
        /// Which one.
        what: &'static str,
        /// What it is.
        value: f64,
    },
    /// Some keys make no playable form.
    #[error("poses {from} to {to} make no motion: {why}")]
    Unplayable {
        /// The first of them.
        from: usize,
        /// The last of them.
        to: usize,
        /// In the words of what was built.
        why: String,
    },
    /// A pose stays off even where it is a key.
    #[error(
        "pose {pose} is off by {factor} times the tolerance although it is a key; a wider tolerance is needed"
    )]
    Unmet {
        /// Which.
        pose: usize,
        /// How far off, against what is tolerated.
        factor: f64,
    },
}

/// Many poses, and how far a clip of some of them is off the others.
pub trait Performance {
    /// How many poses there are.
    fn len(&self) -> usize;

    /// Whether there is none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Takes these poses, ascending and not empty, as the only keys.
    fn keep(&mut self, keys: &[usize]) -> Result<(), ThinError>;

    /// How far what is then shown at the time of a pose is off it, against what is tolerated: 1 is as far as may be.
    fn off(&mut self, pose: usize) -> f64;
}

/// The larger one; what is no number is larger than all.
fn larger(a: f64, b: f64) -> f64 {
    if a >= b { a } else { b }
}

/// The work on one performance.
#[derive(Debug)]
pub struct Thinning<P> {
    performance: P,
    keys: BTreeSet<usize>,
    phase: Phase,
}

#[derive(Debug)]
enum Phase {
    /// Keys were added; all poses are to be judged from here on.
    Judging {
        next: usize,
        worst: Vec<(usize, f64)>,
    },
    /// Keys are being tried without, from the last to the first; the one in question.
    Trying {
        without: usize,
    },
    Done,
}

impl<P: Performance> Thinning<P> {
    /// Nothing is judged yet.
    pub fn new(performance: P) -> Result<Self, ThinError> {
        let last = performance.len().checked_sub(1).ok_or(ThinError::Empty)?;
        let mut thinning = Self {
            performance,
            keys: BTreeSet::from([0, last]),
            phase: Phase::Done,
        };
        thinning.judge_anew()?;
        Ok(thinning)
    }

    /// Goes on until done or until about `poses` poses have been looked at. Whether it is done.
    pub fn advance(&mut self, poses: usize) -> Result<bool, ThinError> {
        let mut left = poses.max(1);
        while left > 0 {
            left = match &mut self.phase {
                Phase::Done => return Ok(true),
                Phase::Judging { .. } => self.judge(left)?,
                Phase::Trying { without } => {
                    let without = *without;
                    self.try_without(without, left)?
                }
            };
        }
        Ok(matches!(self.phase, Phase::Done))
    }

    /// The poses that stay keys, ascending; all that are needed once [`Thinning::advance`] is done.
    pub fn keys(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.keys.iter().copied()
    }

    /// What was thinned.
    pub fn performance(&self) -> &P {
        &self.performance
    }

    fn kept(&self) -> Vec<usize> {
        self.keys.iter().copied().collect()
    }

    fn judge_anew(&mut self) -> Result<(), ThinError> {
        self.performance.keep(&self.kept())?;
        self.phase = Phase::Judging {
            next: 0,
            worst: Vec::new(),
        };
        Ok(())
    }

    /// Looks at up to `budget` poses; gives what is left of it.
    fn judge(&mut self, budget: usize) -> Result<usize, ThinError> {
        let Phase::Judging { next, worst } = &mut self.phase else {
            return Ok(budget);
        };
        let end = self.performance.len().min(*next + budget);
        for pose in *next..end {
            let off = self.performance.off(pose);
            // Whatever cannot be compared is too far.
            if off <= 1.0 {
                continue;
            }
            if self.keys.contains(&pose) {
                return Err(ThinError::Unmet { pose, factor: off });
            }
            let same_interval = |other: usize| self.keys.range(other..pose).next().is_none();
            match worst.last_mut() {
                Some((other, most)) if same_interval(*other) => {
                    if off > *most {
                        (*other, *most) = (pose, off);
                    }
                }
                _ => worst.push((pose, off)),
            }
        }
        let left = budget - (end - *next);
        *next = end;
        if end < self.performance.len() {
            return Ok(left);
        }
        let added: Vec<usize> = worst.iter().map(|&(pose, _)| pose).collect();
        if added.is_empty() {
            self.phase = Phase::Trying { without: usize::MAX };
        } else {
            self.keys.extend(added);
            self.judge_anew()?;
        }
        Ok(left)
    }

    /// Tries the last key before `before` that is not an end; gives what is left of the budget.
    fn try_without(&mut self, before: usize, budget: usize) -> Result<usize, ThinError> {
        let last = self.performance.len() - 1;
        let Some(&key) = self.keys.range(1..before.min(last).max(1)).next_back() else {
            self.performance.keep(&self.kept())?;
            self.phase = Phase::Done;
            return Ok(budget);
        };
        self.keys.remove(&key);
        self.performance.keep(&self.kept())?;
        // The key itself is where it is most likely off; then every other, since kinetics reach far.
        let mut looked = 1;
        let mut fits = self.performance.off(key) <= 1.0;
        while fits && looked <= last + 1 {
            fits = self.performance.off(looked - 1) <= 1.0;
            looked += 1;
        }
        if !fits {
            self.keys.insert(key);
        }
        self.phase = Phase::Trying { without: key };
        Ok(budget.saturating_sub(looked))
    }
}
