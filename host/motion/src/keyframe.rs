//! The editable form of a figure's motion: poses at times, and how to go between them.
//!
//! Edits are pure: each gives new keyframes or says why not, so history is a list of values.
//! [`crate::Clip`] is the playable form made from this.

use crate::figure::{DirectionLaw, Figure, FigurePose, TwistLaw};
use crate::kinetics::{Kinetics, KineticsError, KineticsMode, Ordering};
use std::sync::Arc;
use thiserror::Error;

/// One pose at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureKey {
    /// When it is meant to be met, seconds.
    pub secs: f64,
    /// How the figure stands.
    pub pose: FigurePose,
}

/// Poses at times. Any field may be set to any value; [`crate::Clip::build`] is where they are judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframes {
    /// Whose poses these are.
    pub figure: Arc<Figure>,
    /// In order of time.
    pub keys: Vec<FigureKey>,
    /// How directions go from key to key.
    pub direction_law: DirectionLaw,
    /// How twists go from key to key.
    pub twist_law: TwistLaw,
    /// How time goes from key to key.
    pub kinetics: KineticsMode,
    /// Amounts added to coefficients of the kinetic spline, by index. They wait unused while `kinetics` is
    /// a mode without coefficients.
    pub coefficient_edits: Vec<(usize, f64)>,
    /// Whether edited coefficients are kept in order, so that time never runs backwards.
    pub keep_forward: bool,
}

/// Why keyframes could not be changed or used. Keys count from 0.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum KeyframeError {
    /// There is no such key.
    #[error("there is no key {key}; there are {count}, counted from 0")]
    NoSuchKey {
        /// The key asked for.
        key: usize,
        /// How many there are.
        count: usize,
    },
    /// Another key is at that time.
    #[error("key {key} is already at {secs} s; move it or choose another time")]
    TimeTaken {
        /// The key that is there.
        key: usize,
        /// The time asked for.
        secs: f64,
    },
    /// A time is a finite number.
    #[error("{secs} is no time for a key; a time is a finite number of seconds")]
    BadTime {
        /// What came.
        secs: f64,
    },
    /// A pose has one entry for each link.
    #[error("the pose has {links} links and the figure has {wanted}")]
    PoseOfAnotherFigure {
        /// Links of the pose.
        links: usize,
        /// Links of the figure.
        wanted: usize,
    },
    /// The change would make no kinetics.
    #[error(transparent)]
    Kinetics(#[from] KineticsError),
}

impl Keyframes {
    /// No keys yet, everything else as it is by default.
    pub fn new(figure: Arc<Figure>) -> Self {
        Self {
            figure,
            keys: Vec::new(),
            direction_law: DirectionLaw::default(),
            twist_law: TwistLaw::default(),
            kinetics: KineticsMode::default(),
            coefficient_edits: Vec::new(),
            keep_forward: false,
        }
    }

    /// The times of all keys.
    pub fn times_secs(&self) -> Vec<f64> {
        self.keys.iter().map(|key| key.secs).collect()
    }

    /// The kinetics of these keys, edits included.
    pub fn build_kinetics(&self) -> Result<Kinetics, KineticsError> {
        let kinetics = Kinetics::new(&self.times_secs(), self.kinetics)?;
        if self.kinetics != KineticsMode::Natural || (self.coefficient_edits.is_empty() && !self.keep_forward)
        {
            return Ok(kinetics);
        }
        kinetics.edited(&self.coefficient_edits, self.ordering())
    }

    fn ordering(&self) -> Ordering {
        if self.keep_forward {
            Ordering::KeepForward
        } else {
            Ordering::Free
        }
    }

    /// With a new key at its place in time. Coefficient edits are dropped, since they belong to the
    /// coefficients of the old keys; so they are by every edit that changes the number of keys.
    pub fn with_key(&self, key: FigureKey) -> Result<Self, KeyframeError> {
        self.check_pose(&key.pose)?;
        let at = self.free_place(key.secs, None)?;
        let mut new = self.clone();
        new.keys.insert(at, key);
        new.coefficient_edits.clear();
        Ok(new)
    }

    /// Without key `key`.
    pub fn without_key(&self, key: usize) -> Result<Self, KeyframeError> {
        self.check_key(key)?;
        let mut new = self.clone();
        new.keys.remove(key);
        new.coefficient_edits.clear();
        Ok(new)
    }

    /// With key `key` at another time; it may pass other keys.
    pub fn with_key_moved(&self, key: usize, secs: f64) -> Result<Self, KeyframeError> {
        self.check_key(key)?;
        let at = self.free_place(secs, Some(key))?;
        let mut new = self.clone();
        let mut moved = new.keys.remove(key);
        moved.secs = secs;
        new.keys.insert(at - usize::from(at > key), moved);
        Ok(new)
    }

    /// With another pose at key `key`.
    pub fn with_pose(&self, key: usize, pose: FigurePose) -> Result<Self, KeyframeError> {
        self.check_key(key)?;
        self.check_pose(&pose)?;
        let mut new = self.clone();
        new.keys[key].pose = pose;
        Ok(new)
    }

    /// With an amount added to a coefficient of the kinetic spline, on top of earlier edits.
    pub fn with_coefficient_moved(&self, index: usize, change: f64) -> Result<Self, KeyframeError> {
        let mut new = self.clone();
        match new.coefficient_edits.iter_mut().find(|(i, _)| *i == index) {
            Some((_, so_far)) => *so_far += change,
            None => new.coefficient_edits.push((index, change)),
        }
        // Judged in any mode: one without coefficients refuses.
        Kinetics::new(&new.times_secs(), new.kinetics)?.edited(&new.coefficient_edits, new.ordering())?;
        Ok(new)
    }

    fn check_key(&self, key: usize) -> Result<(), KeyframeError> {
        let count = self.keys.len();
        if key < count {
            Ok(())
        } else {
            Err(KeyframeError::NoSuchKey { key, count })
        }
    }

    fn check_pose(&self, pose: &FigurePose) -> Result<(), KeyframeError> {
        let (links, wanted) = (pose.links.len(), self.figure.len());
        if links == wanted {
            Ok(())
        } else {
            Err(KeyframeError::PoseOfAnotherFigure { links, wanted })
        }
    }

    /// Where a key at `secs` belongs, if no key but `except` is there.
    fn free_place(&self, secs: f64, except: Option<usize>) -> Result<usize, KeyframeError> {
        if !secs.is_finite() {
            return Err(KeyframeError::BadTime { secs });
        }
        match self.keys.iter().position(|key| key.secs == secs) {
            Some(key) if Some(key) != except => Err(KeyframeError::TimeTaken { key, secs }),
            _ => Ok(self.keys.partition_point(|key| key.secs < secs)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::LinkSpec;

    fn keyframes(times: &[f64]) -> Keyframes {
        let spec = LinkSpec {
            dof: 2,
            length: 1.0,
            ..LinkSpec::default()
        };
        let (figure, _) = Figure::new(&[spec]).expect("valid");
        let empty = Keyframes::new(Arc::new(figure));
        let key = |secs| FigureKey {
            secs,
            pose: empty.figure.rest_pose(),
        };
        times
            .iter()
            .fold(empty.clone(), |k, &secs| k.with_key(key(secs)).expect("free"))
    }

    #[test]
    fn keys_stay_in_order_of_time() {
        let keys = keyframes(&[2.0, 0.0, 1.0]);
        assert_eq!(keys.times_secs(), [0.0, 1.0, 2.0]);
        assert_eq!(
            keys.with_key_moved(0, 1.5).expect("free").times_secs(),
            [1.0, 1.5, 2.0]
        );
        assert_eq!(
            keys.with_key_moved(2, 0.5).expect("free").times_secs(),
            [0.0, 0.5, 1.0]
        );
        assert_eq!(
            keys.with_key_moved(1, 1.0).expect("its own").times_secs(),
            [0.0, 1.0, 2.0]
        );
        assert_eq!(keys.without_key(0).expect("there").times_secs(), [1.0, 2.0]);
    }

    #[test]
    fn edits_that_cannot_be() {
        let keys = keyframes(&[0.0, 1.0]);
        assert_eq!(
            keys.with_key_moved(0, 1.0),
            Err(KeyframeError::TimeTaken { key: 1, secs: 1.0 })
        );
        assert!(matches!(
            keys.with_key_moved(0, f64::NAN),
            Err(KeyframeError::BadTime { .. })
        ));
        assert_eq!(
            keys.without_key(2),
            Err(KeyframeError::NoSuchKey { key: 2, count: 2 })
        );
        let stranger = FigurePose::default();
        assert!(matches!(
            keys.with_pose(0, stranger),
            Err(KeyframeError::PoseOfAnotherFigure { .. })
        ));
        assert!(matches!(
            keys.with_coefficient_moved(0, 1.0),
            Err(KeyframeError::Kinetics(_))
        ));
    }
}
