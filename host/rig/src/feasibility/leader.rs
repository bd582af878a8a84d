//! The figure as what leads a survey: its pose at a key coordinate, and the joints' answer to it.

use std::sync::Arc;

use motion::joint_track::survey::Leader;
use motion::{Clip, Placed};

use crate::puppet::{Body, Follower};

/// A link may be this far from where it was wanted before the pose counts as one that the puppet cannot take,
/// radians: ten degrees, about what a viewer of a small puppet notices (our choice).
pub(super) const REACH_RAD: f64 = 0.175;
/// What trying one pose costs for each group that follows, about microseconds.
const WORK_PER_GROUP: usize = 4;
/// What a group that looks for other branches costs more.
const WORK_PER_SEARCH: usize = 500;
/// The cost above which a group looks for other branches: see `motion::retarget`.
const SEARCH_COST: f64 = 0.02;

/// A clip of a figure, and the puppet that follows it.
#[derive(Clone, Debug)]
pub(super) struct FigureLeader {
    clip: Arc<Clip>,
    follower: Follower,
    placed: Vec<Placed>,
    other: Vec<Placed>,
    error_rad: f64,
}

impl FigureLeader {
    pub(super) fn new(clip: Arc<Clip>, body: &Body) -> Self {
        Self {
            clip,
            follower: Follower::new(body),
            placed: Vec::new(),
            other: Vec::new(),
            error_rad: 0.0,
        }
    }

    /// The largest angle between a link and what its joints could do about it so far.
    pub(super) fn error_rad(&self) -> f64 {
        self.error_rad
    }

    fn note(&mut self, strained: &mut Vec<(usize, f64)>) -> usize {
        strained.extend(
            self.follower
                .errors()
                .map(|(joint, error_rad)| (joint, error_rad / REACH_RAD)),
        );
        self.error_rad = self.error_rad.max(self.follower.report().direction_error_rad());
        let groups = &self.follower.report().groups;
        let searches = groups.iter().filter(|group| group.cost > SEARCH_COST).count();
        groups.len() * WORK_PER_GROUP + searches * WORK_PER_SEARCH
    }
}

impl Leader for FigureLeader {
    fn begin(&mut self, u: f64, angles: &mut [f64], strained: &mut Vec<(usize, f64)>) -> usize {
        self.clip.place_at(u, &mut self.placed);
        self.follower.begin_from(&self.placed, angles);
        self.note(strained) + self.follower.report().groups.len() * WORK_PER_SEARCH
    }

    fn follow(&mut self, u: f64, angles: &mut [f64], strained: &mut Vec<(usize, f64)>) -> usize {
        self.clip.place_at(u, &mut self.placed);
        self.follower.follow_from(&self.placed, angles);
        self.note(strained)
    }

    fn turning_rad(&self, key: usize) -> f64 {
        let (mut from, mut to) = (self.placed.clone(), self.other.clone());
        self.clip.place_at(key as f64, &mut from);
        self.clip.place_at((key + 1) as f64, &mut to);
        from.iter()
            .zip(&to)
            .map(|(a, b)| {
                let turn = a.world_from_link.transpose() * b.world_from_link;
                let trace = turn.x_axis.x + turn.y_axis.y + turn.z_axis.z;
                ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos()
            })
            .fold(0.0, f64::max)
    }
}
