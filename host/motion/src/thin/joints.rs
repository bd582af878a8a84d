//! Angles of a puppet's joints, judged by the track they make.

use super::{Performance, ThinError, larger};
use crate::joint_track::{JointKey, JointTrack, keyed};
use crate::kinetics::{Kinetics, KineticsMode};
use std::sync::Arc;

/// Angles at times, and the track of those that are kept.
#[derive(Debug)]
pub struct JointPerformance {
    joints: Vec<String>,
    all: Vec<JointKey>,
    kinetics: KineticsMode,
    tolerance_rad: f64,
    track: Option<JointTrack>,
    shown_rad: Vec<f64>,
}

impl JointPerformance {
    /// All keys name all joints; one that a key does not name is not judged there.
    pub fn new(
        joints: Vec<String>,
        all: Vec<JointKey>,
        kinetics: KineticsMode,
        tolerance_rad: f64,
    ) -> Result<Self, ThinError> {
        if !(tolerance_rad.is_finite() && tolerance_rad > 0.0) {
            return Err(ThinError::Tolerance {
                what: "the angle",
                value: tolerance_rad,
            });
        }
        let shown_rad = vec![0.0; joints.len()];
        Ok(Self {
            joints,
            all,
            kinetics,
            tolerance_rad,
            track: None,
            shown_rad,
        })
    }

    /// The keys at these places.
    pub fn keys(&self, keys: impl Iterator<Item = usize>) -> Vec<JointKey> {
        keys.filter_map(|key| self.all.get(key).cloned()).collect()
    }
}

impl Performance for JointPerformance {
    fn len(&self) -> usize {
        self.all.len()
    }

    fn keep(&mut self, keys: &[usize]) -> Result<(), ThinError> {
        let unplayable = |why: String| ThinError::Unplayable {
            from: keys.first().copied().unwrap_or(0),
            to: keys.last().copied().unwrap_or(0),
            why,
        };
        let kept: Vec<&JointKey> = keys.iter().filter_map(|&key| self.all.get(key)).collect();
        let times: Vec<f64> = kept.iter().map(|key| key.secs).collect();
        let path = keyed(&self.joints, &[], &kept.iter().copied()).map_err(|e| unplayable(e.to_string()))?;
        let kinetics = Kinetics::new(&times, self.kinetics).map_err(|e| unplayable(e.to_string()))?;
        self.track = Some(JointTrack {
            path: Arc::new(path),
            kinetics,
        });
        Ok(())
    }

    fn off(&mut self, pose: usize) -> f64 {
        let (Some(track), Some(wanted)) = (&self.track, self.all.get(pose)) else {
            return f64::INFINITY;
        };
        track.angles(wanted.secs, &mut self.shown_rad);
        let mut off = 0.0;
        for (joint, shown) in self.joints.iter().zip(&self.shown_rad) {
            if let Some(angle) = wanted.angles_rad.get(joint) {
                off = larger(off, (shown - angle).abs() / self.tolerance_rad);
            }
        }
        off
    }
}
