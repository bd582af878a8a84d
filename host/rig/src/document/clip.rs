//! A clip as the document keeps it: key poses, and how time and space run between them.

use std::sync::Arc;

use motion::feasibility::Timing;
use motion::joint_track::{JointTrack, KeyedJointsError, keyed};
use motion::kinetics::Ordering;
use motion::{
    Clip, ClipError, DirectionLaw, Figure, FigureKey, JointKey, Keyframes, Kinetics, KineticsError,
    KineticsMode, TwistLaw,
};

/// A pose at a time, of whatever kind.
pub trait Keyed: Clone {
    /// When it is meant to be met, seconds.
    fn secs(&self) -> f64;

    /// The same pose at another time.
    #[must_use]
    fn at(&self, secs: f64) -> Self;
}

impl Keyed for FigureKey {
    fn secs(&self) -> f64 {
        self.secs
    }

    fn at(&self, secs: f64) -> Self {
        Self {
            secs,
            pose: self.pose.clone(),
        }
    }
}

impl Keyed for JointKey {
    fn secs(&self) -> f64 {
        self.secs
    }

    fn at(&self, secs: f64) -> Self {
        Self {
            secs,
            angles_rad: self.angles_rad.clone(),
        }
    }
}

/// A clip of a puppet's own joints, without a figure. Direction and twist laws say nothing in it.
pub type JointClipDoc = ClipDoc<JointKey>;

/// Keys and laws of one clip. The figure it belongs to is the show's; a clip of joints belongs to the puppet.
///
/// Keys are shared one by one, so that a history of a clip with thousands of keys holds each once.
#[derive(Clone, Debug, PartialEq)]
pub struct ClipDoc<K = FigureKey> {
    /// Keys, earliest first, at strictly increasing times; each pose of a figure has one entry per link.
    pub keys: Vec<Arc<K>>,
    /// How directions go from key to key.
    pub direction_law: DirectionLaw,
    /// How twists go from key to key.
    pub twist_law: TwistLaw,
    /// How key times become the kinetic spline.
    pub kinetics: KineticsMode,
    /// Amounts added to kinetic coefficients: index, keys. At most one entry an index, ascending. They
    /// wait unused while `kinetics` is a mode without coefficients.
    pub coefficient_edits: Vec<(usize, f64)>,
    /// Whether coefficients are held in order, so that time cannot run backwards.
    pub keep_forward: bool,
    /// Seconds from frame to frame in the file the clip came from, and in files made from it.
    pub frame_secs: Option<f64>,
}

/// Frame time of exports when the clip does not say: 30 frames a second, as the thesis filmed.
const FRAME_SECS_DEFAULT: f64 = 1.0 / 30.0;

/// Most frames exported from one clip; more is a mistyped time.
const FRAMES_MAX: usize = 1_000_000;

impl<K> Default for ClipDoc<K> {
    fn default() -> Self {
        Self {
            keys: Vec::new(),
            direction_law: DirectionLaw::default(),
            twist_law: TwistLaw::default(),
            kinetics: KineticsMode::default(),
            coefficient_edits: Vec::new(),
            keep_forward: false,
            frame_secs: None,
        }
    }
}

impl ClipDoc {
    /// The keyframes in `motion`'s editable form.
    pub fn keyframes(&self, figure: &Arc<Figure>) -> Keyframes {
        Keyframes {
            figure: Arc::clone(figure),
            keys: self.keys.iter().map(|key| FigureKey::clone(key)).collect(),
            direction_law: self.direction_law,
            twist_law: self.twist_law,
            kinetics: self.kinetics,
            coefficient_edits: self.coefficient_edits.clone(),
            keep_forward: self.keep_forward,
        }
    }

    /// The playable form; `None` while there is no key.
    pub fn clip(&self, figure: &Arc<Figure>) -> Result<Option<Clip>, ClipError> {
        if self.keys.is_empty() {
            return Ok(None);
        }
        Clip::build(&self.keyframes(figure)).map(Some)
    }
}

/// Why a clip of joints cannot be played on a puppet.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JointClipDocError {
    /// Its keys do not suit the puppet.
    #[error(transparent)]
    Keys(#[from] KeyedJointsError),
    /// Its times make no kinetics.
    #[error(transparent)]
    Timing(#[from] KineticsError),
}

impl JointClipDoc {
    /// The playable form for these joints; `rest_rad` for those that no key names. `None` while there is no key.
    pub fn track(
        &self,
        joints: &[String],
        rest_rad: &[f64],
    ) -> Result<Option<JointTrack>, JointClipDocError> {
        if self.keys.is_empty() {
            return Ok(None);
        }
        let path = keyed(joints, rest_rad, &self.keys.iter().map(Arc::as_ref))?;
        Ok(Some(JointTrack {
            path: Arc::new(path),
            kinetics: self.timing().kinetics(&self.times_secs())?,
        }))
    }
}

impl<K: Keyed> ClipDoc<K> {
    /// How key times become kinetics.
    pub fn timing(&self) -> Timing {
        Timing {
            mode: self.kinetics,
            edits: self.coefficient_edits.clone(),
            ordering: if self.keep_forward {
                Ordering::KeepForward
            } else {
                Ordering::Free
            },
        }
    }

    /// Whether key times and adjustments make a kinetic spline. Judged as natural ones whatever the mode,
    /// so that the mode can be changed at any time.
    pub(super) fn check_timing(&self) -> Result<(), KineticsError> {
        if self.keys.is_empty() && self.coefficient_edits.is_empty() {
            return Ok(());
        }
        let kinetics = Kinetics::new(&self.times_secs(), KineticsMode::Natural)?;
        kinetics
            .edited(&self.coefficient_edits, Ordering::Free)
            .map(|_| ())
    }

    /// Times of the keys, seconds.
    pub fn times_secs(&self) -> Vec<f64> {
        self.keys.iter().map(|key| key.secs()).collect()
    }

    /// Seconds from frame to frame in exports.
    pub fn export_frame_secs(&self) -> f64 {
        self.frame_secs.unwrap_or(FRAME_SECS_DEFAULT)
    }

    /// Times at which exports sample the clip, from the first key to the last. `None` when there would be
    /// more than a million.
    pub fn frame_times_secs(&self) -> Option<Vec<f64>> {
        let (Some(first), Some(last)) = (self.keys.first(), self.keys.last()) else {
            return Some(Vec::new());
        };
        let step = self.export_frame_secs();
        // The tolerance is the thesis notes' (frames of a double interpolant): a frame on the last key counts.
        let count = ((last.secs() - first.secs()) / step + 1e-6).floor();
        if !(0.0..FRAMES_MAX as f64).contains(&count) {
            return None;
        }
        Some(
            (0..=count as usize)
                .map(|frame| first.secs() + frame as f64 * step)
                .collect(),
        )
    }
}
