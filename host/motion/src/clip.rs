//! The playable form of a figure's motion: built once from keyframes, then constant.
//!
//! Everything that depends on a pair of keys is worked out beforehand, so that a sample costs the same at
//! any time, in any order, and needs no memory of the sample before.

use crate::figure::{BadDirection, Figure, FigurePose, LinkIndex, Placed, Sweep};
use crate::keyframe::Keyframes;
use crate::kinetics::{Kinetics, KineticsError};
use glam::DVec3;
use std::sync::Arc;
use thiserror::Error;

/// Why keyframes cannot be played. Keys count from 0.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ClipError {
    /// The key times make no kinetics.
    #[error(transparent)]
    Kinetics(#[from] KineticsError),
    /// A pose has one entry for each link.
    #[error("the pose of key {key} has {links} links and the figure has {wanted}")]
    PoseOfAnotherFigure {
        /// The key.
        key: usize,
        /// Links of the pose.
        links: usize,
        /// Links of the figure.
        wanted: usize,
    },
    /// A root, twist or length is NaN or infinite, or a length is not above zero.
    #[error("key {key} has a root, twist or length that is not finite, or a length not above zero")]
    BadPose {
        /// The key.
        key: usize,
    },
    /// A direction is zero or not finite.
    #[error("link {link:?} has no direction at key {key} or the next; a direction is finite and not zero")]
    BadDirection {
        /// The key where the interval begins.
        key: usize,
        /// The link.
        link: LinkIndex,
    },
}

/// What a clip does that its author may not have meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ClipWarning {
    /// The directions of two keys are opposite, so the way between them was chosen and not given.
    #[error(
        "link {link:?} turns right round between key {key} and the next; it bends towards its own x axis"
    )]
    Ambiguous {
        /// The key where the interval begins.
        key: usize,
        /// The link.
        link: LinkIndex,
    },
}

/// A figure's motion, ready to play. Before the first key and after the last it holds still.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    figure: Arc<Figure>,
    kinetics: Kinetics,
    /// One for each key; a clip of one key has it twice.
    roots: Vec<DVec3>,
    /// For each interval of keys, one for each link.
    sweeps: Vec<Sweep>,
    warnings: Vec<ClipWarning>,
}

impl Clip {
    /// Judges keyframes and prepares every interval of keys.
    pub fn build(keyframes: &Keyframes) -> Result<Self, ClipError> {
        let kinetics = keyframes.build_kinetics()?;
        check_poses(keyframes)?;
        let keys = &keyframes.keys;
        let mut roots: Vec<DVec3> = keys.iter().map(|key| key.pose.root).collect();
        let mut pairs: Vec<(usize, usize)> = (1..keys.len()).map(|next| (next - 1, next)).collect();
        if let [only] = roots[..] {
            roots.push(only);
            pairs.push((0, 0));
        }
        let (mut sweeps, mut warnings) = (Vec::new(), Vec::new());
        for (key, next) in pairs {
            for (index, (from, to)) in keys[key]
                .pose
                .links
                .iter()
                .zip(&keys[next].pose.links)
                .enumerate()
            {
                let link = LinkIndex(index as u16);
                let sweep = Sweep::between(from, to, keyframes.direction_law, keyframes.twist_law)
                    .map_err(|BadDirection| ClipError::BadDirection { key, link })?;
                if sweep.circle().ambiguous() {
                    warnings.push(ClipWarning::Ambiguous { key, link });
                }
                sweeps.push(sweep);
            }
        }
        Ok(Self {
            figure: Arc::clone(&keyframes.figure),
            kinetics,
            roots,
            sweeps,
            warnings,
        })
    }

    /// Whose motion this is.
    pub fn figure(&self) -> &Arc<Figure> {
        &self.figure
    }

    /// The timing, shared by all links.
    pub fn kinetics(&self) -> &Kinetics {
        &self.kinetics
    }

    /// What its author may not have meant.
    pub fn warnings(&self) -> &[ClipWarning] {
        &self.warnings
    }

    /// The time of the first key, seconds.
    pub fn start_secs(&self) -> f64 {
        self.kinetics.domain().start
    }

    /// From the first key to the last, seconds; zero for one key.
    pub fn duration_secs(&self) -> f64 {
        self.kinetics.domain().length()
    }

    /// The figure's pose at a time; allocates nothing once `pose` has room for all links.
    pub fn sample(&self, secs: f64, pose: &mut FigurePose) {
        let (interval, s) = self.locate(secs);
        pose.root = self.root(interval, s);
        pose.links.clear();
        pose.links
            .extend(self.interval(interval).iter().map(|sweep| sweep.pose(s)));
    }

    /// Where every link lies at a time; allocates nothing once `placed` has room for all links.
    pub fn place(&self, secs: f64, placed: &mut Vec<Placed>) {
        let (interval, s) = self.locate(secs);
        let root = self.root(interval, s);
        placed.clear();
        for (link, sweep) in self.figure.links().iter().zip(self.interval(interval)) {
            let frame = sweep.frame(s);
            let start = match link.parent {
                None => root,
                Some(parent) => {
                    let on = &placed[parent.index()];
                    let stretch = self.interval(interval)[parent.index()].length(s)
                        / self.figure.links()[parent.index()].length;
                    let offset = DVec3::new(link.offset.x, link.offset.y, link.offset.z * stretch);
                    on.start + on.world_from_link * offset
                }
            };
            placed.push(Placed {
                start,
                end: start + frame.z_axis * sweep.length(s),
                world_from_link: frame,
            });
        }
    }

    /// Which interval of keys a time falls into, and how far: 0 to 1.
    fn locate(&self, secs: f64) -> (usize, f64) {
        let last_key = self.kinetics.last_key();
        let u = self.kinetics.u(secs).clamp(0.0, last_key as f64);
        let interval = (u as usize).min(last_key.saturating_sub(1));
        (interval, u - interval as f64)
    }

    fn root(&self, interval: usize, s: f64) -> DVec3 {
        self.roots[interval].lerp(self.roots[interval + 1], s)
    }

    fn interval(&self, interval: usize) -> &[Sweep] {
        let links = self.figure.len();
        &self.sweeps[interval * links..][..links]
    }
}

fn check_poses(keyframes: &Keyframes) -> Result<(), ClipError> {
    let wanted = keyframes.figure.len();
    for (key, frame) in keyframes.keys.iter().enumerate() {
        let pose = &frame.pose;
        let links = pose.links.len();
        if links != wanted {
            return Err(ClipError::PoseOfAnotherFigure { key, links, wanted });
        }
        let sound = |length: f64, twist: f64| length.is_finite() && length > 0.0 && twist.is_finite();
        if !(pose.root.is_finite() && pose.links.iter().all(|l| sound(l.length, l.twist_rad))) {
            return Err(ClipError::BadPose { key });
        }
    }
    Ok(())
}
