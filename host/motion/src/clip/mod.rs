//! The playable form of a figure's motion: built once from keyframes, then constant.
//!
//! Everything that depends on a pair of keys is worked out beforehand, so that a sample costs the same at
//! any time, in any order, and needs no memory of the sample before.

mod segment;
mod trig;

use crate::figure::{BadDirection, Figure, FigurePose, LinkIndex, LinkPose, Placed, Sweep, twist_of};
use crate::keyframe::Keyframes;
use crate::kinetics::{Kinetics, KineticsError};
use glam::{DMat3, DVec3};
use segment::{CHUNK, Course, Segment, Way};
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
    segments: Vec<Segment>,
    /// For each interval of keys.
    courses: Vec<Course>,
    /// For each interval of keys, one for each link: the twist at its beginning and its change.
    twists_rad: Vec<[f64; 2]>,
    /// Where each link hangs, apart from the figure's names and lists.
    hangs: Vec<Hang>,
    warnings: Vec<ClipWarning>,
}

/// Where a link starts.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Hang {
    parent: Option<LinkIndex>,
    /// In the parent's frame, metres; its z for one metre of parent.
    offset: DVec3,
}

impl Hang {
    fn all(figure: &Figure) -> Vec<Self> {
        let hang = |link: &crate::figure::Link| {
            let rest = link
                .parent
                .and_then(|parent| figure.link(parent))
                .map_or(1.0, |link| link.length);
            Self {
                parent: link.parent,
                offset: link.offset * DVec3::new(1.0, 1.0, 1.0 / rest),
            }
        };
        figure.links().iter().map(hang).collect()
    }
}

impl Clip {
    /// Judges keyframes and prepares every interval of keys.
    pub fn build(keyframes: &Keyframes) -> Result<Self, ClipError> {
        let kinetics = keyframes.build_kinetics()?;
        check_poses(keyframes)?;
        let keys = &keyframes.keys;
        let mut clip = Self {
            figure: Arc::clone(&keyframes.figure),
            kinetics,
            roots: keys.iter().map(|key| key.pose.root).collect(),
            segments: Vec::with_capacity(keys.len() * keyframes.figure.len()),
            courses: Vec::with_capacity(keys.len()),
            twists_rad: Vec::with_capacity(keys.len() * keyframes.figure.len()),
            hangs: Hang::all(&keyframes.figure),
            warnings: Vec::new(),
        };
        for key in 1..keys.len() {
            clip.add_interval(keyframes, key - 1, key)?;
        }
        if let [only] = clip.roots[..] {
            clip.roots.push(only);
            clip.add_interval(keyframes, 0, 0)?;
        }
        Ok(clip)
    }

    fn add_interval(&mut self, keyframes: &Keyframes, key: usize, next: usize) -> Result<(), ClipError> {
        let (from, to) = (&keyframes.keys[key].pose, &keyframes.keys[next].pose);
        let (direction_law, twist_law) = (keyframes.direction_law, keyframes.twist_law);
        let mut sweeps = Vec::with_capacity(from.links.len());
        for (index, (from, to)) in from.links.iter().zip(&to.links).enumerate() {
            let link = LinkIndex(index as u16);
            let sweep = Sweep::between(from, to, direction_law, twist_law)
                .map_err(|BadDirection| ClipError::BadDirection { key, link })?;
            if sweep.circle().ambiguous() {
                self.warnings.push(ClipWarning::Ambiguous { key, link });
            }
            self.twists_rad
                .push([from.twist_rad, to.twist_rad - from.twist_rad]);
            sweeps.push(sweep);
        }
        let (begin, way) = (self.segments.len(), Way::of(direction_law, &sweeps));
        self.segments
            .extend(sweeps.iter().map(|sweep| Segment::pack(sweep, way)));
        let wild = self.segments[begin..].iter().any(Segment::wild);
        self.courses.push(Course { way, twist_law, wild });
        Ok(())
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
        let (links, mut frames) = (self.hangs.len(), [DMat3::IDENTITY; CHUNK]);
        let twists = &self.twists_rad[interval * links..][..links];
        for (segments, twists) in self.interval(interval).chunks(CHUNK).zip(twists.chunks(CHUNK)) {
            segment::frames(self.courses[interval], segments, s, &mut frames);
            for ((segment, twist), frame) in segments.iter().zip(twists).zip(&frames) {
                let twist_rad = twist_of(frame, twist[0] + twist[1] * s);
                pose.links.push(LinkPose {
                    direction: frame.z_axis,
                    twist_rad,
                    length: segment.length(s),
                });
            }
        }
    }

    /// Where every link lies at a time; allocates nothing once `placed` has room for all links.
    pub fn place(&self, secs: f64, placed: &mut Vec<Placed>) {
        self.place_at(self.kinetics.u(secs), placed);
    }

    /// Where every link lies at a key coordinate, whenever that is reached; clamped to the keys.
    pub fn place_at(&self, u: f64, placed: &mut Vec<Placed>) {
        let (interval, s) = self.interval_of(u);
        let (root, segments) = (self.root(interval, s), self.interval(interval));
        let mut frames = [DMat3::IDENTITY; CHUNK];
        placed.clear();
        placed.reserve(segments.len());
        for (chunk, hangs) in segments.chunks(CHUNK).zip(self.hangs.chunks(CHUNK)) {
            segment::frames(self.courses[interval], chunk, s, &mut frames);
            for ((segment, hang), &frame) in chunk.iter().zip(hangs).zip(&frames) {
                let start = match hang.parent {
                    None => root,
                    Some(parent) => {
                        let (on, length) = (&placed[parent.index()], segments[parent.index()].length(s));
                        let offset = DVec3::new(hang.offset.x, hang.offset.y, hang.offset.z * length);
                        on.start + on.world_from_link * offset
                    }
                };
                let end = start + frame.z_axis * segment.length(s);
                placed.push(Placed {
                    start,
                    end,
                    world_from_link: frame,
                });
            }
        }
    }

    /// Which interval of keys a time falls into, and how far: 0 to 1.
    fn locate(&self, secs: f64) -> (usize, f64) {
        self.interval_of(self.kinetics.u(secs))
    }

    fn interval_of(&self, u: f64) -> (usize, f64) {
        let last_key = self.kinetics.last_key();
        let u = u.clamp(0.0, last_key as f64);
        let interval = (u as usize).min(last_key.saturating_sub(1));
        (interval, u - interval as f64)
    }

    fn root(&self, interval: usize, s: f64) -> DVec3 {
        self.roots[interval].lerp(self.roots[interval + 1], s)
    }

    fn interval(&self, interval: usize) -> &[Segment] {
        let links = self.hangs.len();
        &self.segments[interval * links..][..links]
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
