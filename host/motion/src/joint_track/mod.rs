//! A robot's motion as path and timing: joint angles over key coordinate, met at the times of its kinetics.
//!
//! Both kinds of motion end here: poses keyed joint by joint are natural cubics between their keys, and a figure
//! that is followed is surveyed ([`survey`]) until cubics describe its path. What is judged, slowed and played is
//! this one thing.

mod keyed;
pub mod survey;

pub use keyed::{JointKey, KeyedJointsError, keyed};

use crate::chain::Coupling;
use crate::curve::Interval;
use crate::joint_clip::{JointClip, JointClipError};
use crate::kinetics::Kinetics;

/// Joint angles over key coordinate: a cubic for every joint between any two knots.
///
/// Invariants: at least one joint; knots increase strictly; one row of cubics between two knots.
#[derive(Clone, Debug, PartialEq)]
pub struct JointPath {
    joints: Vec<String>,
    knots: Vec<f64>,
    /// Row by row, power coefficients about the left knot, constant first.
    cubics: Vec<[f64; 4]>,
    /// The angles at the last knot.
    last_rad: Vec<f64>,
    strains: Vec<Strain>,
}

/// A stretch of a path on which the joints cannot be where they were wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct Strain {
    /// Where, in key coordinate.
    pub over: Interval,
    /// Which joint, by its place.
    pub joint: usize,
    /// How far off, against what is tolerated; above 1.
    pub factor: f64,
}

impl JointPath {
    /// Joint names, in the order of all angles.
    pub fn joints(&self) -> &[String] {
        &self.joints
    }

    /// Where the cubics meet, in key coordinate.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Where joints cannot be where they were wanted.
    pub fn strains(&self) -> &[Strain] {
        &self.strains
    }

    /// The same path where the joints that follow others do; couplings count joints in the path's own order.
    #[must_use]
    pub fn coupled(&self, couplings: &[Coupling]) -> Self {
        let mut path = self.clone();
        for coupling in couplings {
            let (led, leading) = (coupling.joint.index(), coupling.follows.index());
            for row in path.cubics.chunks_exact_mut(self.joints.len()) {
                row[led] = row[leading].map(|c| coupling.ratio * c);
                row[led][0] += coupling.offset_rad;
            }
            path.last_rad[led] = coupling.ratio * path.last_rad[leading] + coupling.offset_rad;
        }
        path
    }

    /// Which row of cubics holds at a coordinate, and how far from its left knot; none outside the knots' range.
    fn locate(&self, u: f64) -> Option<(usize, f64)> {
        let rows = self.knots.len().checked_sub(2)?;
        let row = self.knots.partition_point(|&knot| knot <= u).checked_sub(1)?;
        let row = row.min(rows);
        Some((row, u - self.knots[row]))
    }

    /// One row of cubics, one for each joint; empty beyond the last.
    pub(crate) fn row(&self, row: usize) -> &[[f64; 4]] {
        let count = self.joints.len();
        self.cubics
            .get(row * count..(row + 1) * count)
            .unwrap_or_default()
    }

    /// All angles at a key coordinate, radians, as far as `angles` has room; the ends are held.
    pub fn angles(&self, u: f64, angles: &mut [f64]) {
        if self.knots.last().is_none_or(|&last| u >= last) {
            for (into, angle) in angles.iter_mut().zip(&self.last_rad) {
                *into = *angle;
            }
            return;
        }
        let first = self.knots.first().copied().unwrap_or(0.0);
        if let Some((row, x)) = self.locate(u.max(first)) {
            for (into, c) in angles.iter_mut().zip(self.row(row)) {
                *into = c[0] + (c[1] + (c[2] + c[3] * x) * x) * x;
            }
        }
    }
}

/// A path and its timing.
#[derive(Clone, Debug, PartialEq)]
pub struct JointTrack {
    /// Where: angles over key coordinate.
    pub path: std::sync::Arc<JointPath>,
    /// When: seconds to key coordinate.
    pub kinetics: Kinetics,
}

impl JointTrack {
    /// All angles at a time, radians; the ends are held.
    pub fn angles(&self, secs: f64, angles: &mut [f64]) {
        self.path.angles(self.kinetics.u(secs), angles);
    }

    /// Angles at even steps of time, the last at or just after the end: what a player takes.
    pub fn bake(&self, period_secs: f64) -> Result<JointClip, JointClipError> {
        if !(period_secs.is_finite() && period_secs > 0.0) {
            return Err(JointClipError::BadPeriod { period_secs });
        }
        let domain = self.kinetics.domain();
        let rows = JointClip::rows_for(domain.length(), period_secs)?;
        let count = self.path.joints.len();
        let mut samples = vec![0.0; rows * count];
        for (row, angles) in samples.chunks_exact_mut(count.max(1)).enumerate() {
            self.angles(domain.start + row as f64 * period_secs, angles);
        }
        JointClip::new(self.path.joints.clone(), period_secs, samples)
    }
}
