//! Poses of a figure, judged by the clip they make.

use super::{Performance, ThinError, larger};
use crate::clip::Clip;
use crate::figure::{FigurePose, LinkPose, frame_of};
use crate::keyframe::{FigureKey, Keyframes};
use glam::DMat3;
use std::sync::Arc;

/// How far a figure may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FigureTolerance {
    /// Of a link's direction and of its frame about it, radians.
    pub angle_rad: f64,
    /// Of the root's place and of a link's length, metres.
    pub distance_m: f64,
}

impl FigureTolerance {
    fn check(self) -> Result<Self, ThinError> {
        for (what, value) in [("the angle", self.angle_rad), ("the distance", self.distance_m)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(ThinError::Tolerance { what, value });
            }
        }
        Ok(self)
    }

    /// How far one pose is off another of the same figure, against this.
    pub fn off(&self, shown: &FigurePose, wanted: &FigurePose) -> f64 {
        let mut off = shown.root.distance(wanted.root) / self.distance_m;
        for (shown, wanted) in shown.links.iter().zip(&wanted.links) {
            let turned = angle_between_frames(shown, wanted) / self.angle_rad;
            let longer = (shown.length - wanted.length).abs() / self.distance_m;
            off = larger(off, larger(turned, longer));
        }
        off
    }
}

/// How far a link's frame is turned against another, radians, 0 to π: direction and twist together, since a twist
/// means nothing apart from its direction.
fn angle_between_frames(a: &LinkPose, b: &LinkPose) -> f64 {
    let frame = |link: &LinkPose| frame_of(link.direction) * DMat3::from_rotation_z(link.twist_rad);
    let (a, b) = (frame(a), frame(b));
    let between = a.transpose() * b;
    // The chord between two rotations: |a − b| = 2 √2 sin(angle / 2) in the Frobenius norm. Unlike an arc cosine
    // it is exact for small angles, which are the ones that tolerances are about.
    let difference = between - DMat3::IDENTITY;
    let square: f64 = difference.to_cols_array().iter().map(|x| x * x).sum();
    2.0 * (square / 8.0).sqrt().min(1.0).asin()
}

/// A pose and when it was seen, seconds. Poses that did not change are shared.
pub type SeenPose = (f64, Arc<FigurePose>);

/// Poses of a figure at times, and the clip of those that are kept.
#[derive(Debug)]
pub struct FigurePerformance {
    tolerance: FigureTolerance,
    seen: Vec<SeenPose>,
    /// How the kept ones will be played; without keys.
    laws: Keyframes,
    clip: Option<Clip>,
    shown: FigurePose,
}

impl FigurePerformance {
    /// What was seen, earliest first, and how the kept poses will be played. Keys and coefficient edits of `laws` are
    /// dropped.
    pub fn new(
        mut laws: Keyframes,
        seen: Vec<SeenPose>,
        tolerance: FigureTolerance,
    ) -> Result<Self, ThinError> {
        laws.keys.clear();
        laws.coefficient_edits.clear();
        Ok(Self {
            tolerance: tolerance.check()?,
            seen,
            laws,
            clip: None,
            shown: FigurePose::default(),
        })
    }

    /// The laws with these poses as keys.
    pub fn keyframes(&self, keys: impl Iterator<Item = usize>) -> Keyframes {
        let key = |key: usize| {
            let (secs, pose) = self.seen.get(key)?;
            Some(FigureKey {
                secs: *secs,
                pose: FigurePose::clone(pose),
            })
        };
        Keyframes {
            keys: keys.filter_map(key).collect(),
            ..self.laws.clone()
        }
    }
}

impl Performance for FigurePerformance {
    fn len(&self) -> usize {
        self.seen.len()
    }

    fn keep(&mut self, keys: &[usize]) -> Result<(), ThinError> {
        let clip = Clip::build(&self.keyframes(keys.iter().copied()));
        self.clip = Some(clip.map_err(|error| ThinError::Unplayable {
            from: keys.first().copied().unwrap_or(0),
            to: keys.last().copied().unwrap_or(0),
            why: error.to_string(),
        })?);
        Ok(())
    }

    fn off(&mut self, pose: usize) -> f64 {
        let (Some(clip), Some((secs, wanted))) = (&self.clip, self.seen.get(pose)) else {
            return f64::INFINITY;
        };
        clip.sample(*secs, &mut self.shown);
        self.tolerance.off(&self.shown, wanted)
    }
}
