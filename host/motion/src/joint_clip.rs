//! Joint angles over time, evenly sampled: the only thing a puppet is ever played from.
//!
//! Between samples the angle follows a cubic whose slopes are limited, so that it never leaves the range
//! of its two neighbouring samples: what was checked sample by sample holds in between.

use crate::clip::Clip;
use crate::figure::Placed;
use crate::kinetics::limit_slope;
use crate::retarget::{Retarget, RetargetReport};
use thiserror::Error;

/// Most rows a clip is baked into: eleven hours at a hundred a second (our choice).
const ROWS_MAX: f64 = 4e6;

/// Why samples make no clip.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum JointClipError {
    /// No joints.
    #[error("a joint clip needs at least one joint")]
    NoJoints,
    /// The samples are no whole number of rows.
    #[error("{samples} samples do not make whole rows of {joints} joints, at least one")]
    RaggedSamples {
        /// How many numbers came.
        samples: usize,
        /// How many joints there are.
        joints: usize,
    },
    /// The period is a finite number above zero.
    #[error("the sampling period is {period_secs} s; it must be a finite number above zero")]
    BadPeriod {
        /// What came.
        period_secs: f64,
    },
    /// Baking at that period would fill the memory.
    #[error(
        "{rows} rows are too many for one clip, {} are the most; use a longer period",
        ROWS_MAX
    )]
    TooLong {
        /// How many there would be.
        rows: f64,
    },
    /// An angle is NaN or infinite.
    #[error("the angle of joint {joint} in row {row} is not finite")]
    NotFinite {
        /// The joint's name.
        joint: String,
        /// The row, from 0.
        row: usize,
    },
}

/// Angles of some joints at even steps of time, starting at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct JointClip {
    joints: Vec<String>,
    period_secs: f64,
    /// Row by row, one row for each step.
    samples: Vec<f64>,
}

/// How well a baked clip follows its figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BakeReport {
    /// The largest angle between a link's direction and the joints' best, radians.
    pub direction_error_rad: f64,
    /// How many samples have some joint at a limit.
    pub samples_at_limit: usize,
    /// How many samples took another branch than the one before.
    pub switches: usize,
    /// By what factor the motion must be slowed for every joint to keep its speed; 1 if it is slow enough.
    pub slow_down: f64,
    /// The joint that asks for it, and when.
    pub fastest: Option<(String, f64)>,
}

impl JointClip {
    /// A clip of these joints: `samples` row by row, one row each `period_secs`, all finite.
    pub fn new(joints: Vec<String>, period_secs: f64, samples: Vec<f64>) -> Result<Self, JointClipError> {
        let count = joints.len();
        if count == 0 {
            return Err(JointClipError::NoJoints);
        }
        if samples.is_empty() || !samples.len().is_multiple_of(count) {
            return Err(JointClipError::RaggedSamples {
                samples: samples.len(),
                joints: count,
            });
        }
        if !(period_secs.is_finite() && period_secs > 0.0) {
            return Err(JointClipError::BadPeriod { period_secs });
        }
        if let Some(at) = samples.iter().position(|angle| !angle.is_finite()) {
            return Err(JointClipError::NotFinite {
                joint: joints[at % count].clone(),
                row: at / count,
            });
        }
        Ok(Self {
            joints,
            period_secs,
            samples,
        })
    }

    /// Lets the chain follow the clip from `start_angles`, and keeps one row each `period_secs`, the last
    /// one at or just after the end. Time 0 is the clip's first key.
    pub fn bake(
        clip: &Clip,
        retarget: &Retarget,
        start_angles: &[f64],
        period_secs: f64,
    ) -> Result<(Self, BakeReport), JointClipError> {
        if !(period_secs.is_finite() && period_secs > 0.0) {
            return Err(JointClipError::BadPeriod { period_secs });
        }
        let chain = retarget.chain();
        let rows = Self::rows_for(clip.duration_secs(), period_secs)?;
        let mut report = BakeReport {
            slow_down: 1.0,
            ..BakeReport::default()
        };
        let mut angles = start_angles.to_vec();
        angles.resize(chain.len(), 0.0);
        let mut samples = Vec::with_capacity(rows * chain.len());
        let (mut placed, mut solved): (Vec<Placed>, _) = (Vec::new(), RetargetReport::default());
        for row in 0..rows {
            let since_secs = row as f64 * period_secs;
            clip.place(clip.start_secs() + since_secs, &mut placed);
            let before = angles.clone();
            if row == 0 {
                retarget.begin(&placed, &mut angles, &mut solved);
            } else {
                retarget.follow(&placed, &mut angles, &mut solved);
            }
            report.direction_error_rad = report.direction_error_rad.max(solved.direction_error_rad());
            report.samples_at_limit += usize::from(solved.at_limit());
            report.switches += usize::from(row > 0 && solved.switched());
            if row > 0 {
                let (factor, joint) = retarget.slow_down(&before, &angles, period_secs);
                if factor > report.slow_down {
                    report.slow_down = factor;
                    report.fastest = joint.map(|j| (chain.joints()[j.index()].name.clone(), since_secs));
                }
            }
            samples.extend_from_slice(&angles);
        }
        let names = chain.joints().iter().map(|joint| joint.name.clone()).collect();
        Ok((Self::new(names, period_secs, samples)?, report))
    }

    /// How many rows cover a duration, the last at or just after its end.
    pub(crate) fn rows_for(duration_secs: f64, period_secs: f64) -> Result<usize, JointClipError> {
        // A hair less, so that a whole number of periods does not become one more by rounding.
        let rows = (duration_secs / period_secs - 1e-9).ceil().max(0.0) + 1.0;
        if rows > ROWS_MAX {
            return Err(JointClipError::TooLong { rows });
        }
        Ok(rows as usize)
    }

    /// The joints, in the order of every row.
    pub fn joints(&self) -> &[String] {
        &self.joints
    }

    /// Time between rows, seconds.
    pub fn period_secs(&self) -> f64 {
        self.period_secs
    }

    /// All angles, row by row, radians.
    pub fn samples(&self) -> &[f64] {
        &self.samples
    }

    /// How many rows there are; at least one.
    pub fn rows(&self) -> usize {
        self.samples.len() / self.joints.len()
    }

    /// One row of angles.
    pub fn row(&self, row: usize) -> Option<&[f64]> {
        self.samples.chunks_exact(self.joints.len()).nth(row)
    }

    /// From the first row to the last, seconds; zero for one row.
    pub fn duration_secs(&self) -> f64 {
        (self.rows() - 1) as f64 * self.period_secs
    }

    /// The angles at a time since the first row, radians, one for each joint as far as `angles` has room.
    /// Continuous with its first derivative inside; the ends are held. NaN reads as the start.
    pub fn sample(&self, secs: f64, angles: &mut [f64]) {
        let (row, x) = self.place(secs);
        for (joint, angle) in angles.iter_mut().enumerate().take(self.joints.len()) {
            *angle = self.between(row, joint, x);
        }
    }

    /// One joint's angle at a time, as [`JointClip::sample`]; none for a joint that is not in the clip.
    pub fn sample_joint(&self, joint: usize, secs: f64) -> Option<f64> {
        let (row, x) = self.place(secs);
        (joint < self.joints.len()).then(|| self.between(row, joint, x))
    }

    /// The row before a time, and how much of the way to the next is gone.
    fn place(&self, secs: f64) -> (usize, f64) {
        let last = self.rows() - 1;
        let at = if secs > 0.0 {
            (secs / self.period_secs).min(last as f64)
        } else {
            0.0
        };
        let row = (at as usize).min(last.saturating_sub(1));
        (row, at - row as f64)
    }

    /// One angle, `x` of the way from `row` to the next.
    fn between(&self, row: usize, joint: usize, x: f64) -> f64 {
        let angle = |row: usize| self.samples[row * self.joints.len() + joint];
        let (here, last) = (angle(row), self.rows() - 1);
        if x == 0.0 || row == last {
            return here;
        }
        let next = angle(row + 1);
        if x == 1.0 {
            return next;
        }
        // Slopes per period: the mean of the chords on both sides, limited; at the ends the one chord.
        let chord = next - here;
        let before = if row == 0 { chord } else { here - angle(row - 1) };
        let after = if row + 1 == last {
            chord
        } else {
            angle(row + 2) - next
        };
        let from = limit_slope(f64::midpoint(before, chord), before, chord);
        let to = limit_slope(f64::midpoint(chord, after), chord, after);
        here + x * (from + x * ((3.0 * chord - 2.0 * from - to) + x * (from + to - 2.0 * chord)))
    }
}
