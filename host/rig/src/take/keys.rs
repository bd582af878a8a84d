//! The poses of a performance become the keys of a clip.

use std::collections::BTreeMap;
use std::sync::Arc;

use motion::thin::{FigurePerformance, FigureTolerance, JointPerformance, SeenPose, ThinError, Thinning};
use motion::{Figure, FigurePose, JointKey, KineticsMode};
use serde::{Deserialize, Serialize};

use crate::document::{ClipDoc, JointClipDoc};

/// How far the clip of a take may be off what was performed, at the time of every step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TakeTolerance {
    /// Of every link's direction and turn, or of every joint, radians.
    pub angle_rad: f64,
    /// Of the figure's root, metres.
    pub distance_m: f64,
}

impl Default for TakeTolerance {
    /// Half a degree and two millimetres: what a hobby servo's play hides. The project's own.
    fn default() -> Self {
        Self {
            angle_rad: 0.5_f64.to_radians(),
            distance_m: 0.002,
        }
    }
}

/// A pose at the end of a step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Posed {
    Figure(Arc<FigurePose>),
    Joints(BTreeMap<String, f64>),
}

impl Posed {
    /// A digest of its bits, to compare many with many.
    pub(crate) fn bits(&self) -> u64 {
        // FNV-1a over 64-bit words (Fowler, Noll and Vo); only sameness is looked for.
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut mix = |number: f64| hash = (hash ^ number.to_bits()).wrapping_mul(0x0100_0000_01b3);
        match self {
            Self::Figure(pose) => {
                pose.root.to_array().into_iter().for_each(&mut mix);
                for link in &pose.links {
                    link.direction.to_array().into_iter().for_each(&mut mix);
                    mix(link.twist_rad);
                    mix(link.length);
                }
            }
            Self::Joints(angles) => angles.values().copied().for_each(mix),
        }
        hash
    }
}

/// Everything that was seen.
#[derive(Debug)]
pub(crate) enum Keys {
    Figure(Vec<SeenPose>),
    Joints(Vec<JointKey>),
}

impl Keys {
    pub(crate) fn beginning_with(posed: Posed) -> Self {
        match posed {
            Posed::Figure(pose) => Self::Figure(vec![(0.0, pose)]),
            Posed::Joints(angles_rad) => Self::Joints(vec![JointKey {
                secs: 0.0,
                angles_rad,
            }]),
        }
    }

    /// Adds a pose. One at no later time than the last takes its place; one of another kind is left out.
    pub(crate) fn add(&mut self, secs: f64, posed: Posed) {
        match (self, posed) {
            (Self::Figure(seen), Posed::Figure(pose)) => {
                seen.retain_last(|(last, _)| *last < secs);
                // Poses that did not change are kept once.
                let pose = match seen.last() {
                    Some((_, last)) if *last == pose => Arc::clone(last),
                    _ => pose,
                };
                seen.push((secs, pose));
            }
            (Self::Joints(seen), Posed::Joints(angles_rad)) => {
                seen.retain_last(|last| last.secs < secs);
                seen.push(JointKey { secs, angles_rad });
            }
            _ => {}
        }
    }
}

trait RetainLast<T> {
    fn retain_last(&mut self, keep: impl Fn(&T) -> bool);
}

impl<T> RetainLast<T> for Vec<T> {
    /// Takes the last off unless it is to be kept.
    fn retain_last(&mut self, keep: impl Fn(&T) -> bool) {
        if self.last().is_some_and(|last| !keep(last)) {
            self.pop();
        }
    }
}

/// Thinning, a piece at a time.
pub(crate) enum Keying {
    Figure(Box<Thinning<FigurePerformance>>, ClipDoc),
    Joints(Box<Thinning<JointPerformance>>, JointClipDoc),
}

/// The clip that came of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Keyed {
    Figure(ClipDoc),
    Joints(JointClipDoc),
}

impl Keying {
    /// Time never runs backwards in the clip of a take: what was performed did not.
    pub(crate) fn new(
        keys: Keys,
        figure: Option<&Arc<Figure>>,
        tolerance: TakeTolerance,
    ) -> Result<Self, ThinError> {
        match keys {
            Keys::Figure(seen) => {
                let figure = figure.ok_or(ThinError::Empty)?;
                let laws = ClipDoc {
                    kinetics: KineticsMode::Monotone,
                    ..ClipDoc::default()
                };
                let tolerance = FigureTolerance {
                    angle_rad: tolerance.angle_rad,
                    distance_m: tolerance.distance_m,
                };
                let performance = FigurePerformance::new(laws.keyframes(figure), seen, tolerance)?;
                Ok(Self::Figure(Box::new(Thinning::new(performance)?), laws))
            }
            Keys::Joints(seen) => {
                let laws = JointClipDoc {
                    kinetics: KineticsMode::Monotone,
                    ..JointClipDoc::default()
                };
                let joints = seen.first().map(|key| key.angles_rad.keys().cloned().collect());
                let joints = joints.unwrap_or_default();
                let performance = JointPerformance::new(joints, seen, laws.kinetics, tolerance.angle_rad)?;
                Ok(Self::Joints(Box::new(Thinning::new(performance)?), laws))
            }
        }
    }

    /// Goes on; the clip when it is done.
    pub(crate) fn advance(&mut self, poses: usize) -> Result<Option<Keyed>, ThinError> {
        Ok(match self {
            Self::Figure(thinning, laws) => thinning.advance(poses)?.then(|| {
                let keys = thinning.performance().keyframes(thinning.keys()).keys;
                Keyed::Figure(ClipDoc {
                    keys: keys.into_iter().map(Arc::new).collect(),
                    ..laws.clone()
                })
            }),
            Self::Joints(thinning, laws) => thinning.advance(poses)?.then(|| {
                let keys = thinning.performance().keys(thinning.keys());
                Keyed::Joints(JointClipDoc {
                    keys: keys.into_iter().map(Arc::new).collect(),
                    ..laws.clone()
                })
            }),
        })
    }
}

impl Keyed {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Figure(clip) => clip.keys.len(),
            Self::Joints(clip) => clip.keys.len(),
        }
    }
}
