//! What is said about feasibility.

use std::sync::Arc;

/// Whether the puppet can do the clip.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FeasibilityView {
    /// How much of the clip as it is now has been judged, 0 to 1. Below 1, `stretches` are those of the clip as it was
    /// before, or none.
    pub progress: f64,
    /// Where a joint is asked too much, in order of time.
    pub stretches: Arc<[StretchView]>,
    /// What was not judged, and why, in words for a person.
    pub unjudged: Arc<[String]>,
    /// By what the whole clip would have to be slowed; 1 for one that is slow enough. [`crate::Command::SlowToFit`]
    /// does with less, where it can slow only parts.
    pub slow_down: f64,
    /// The largest angle between a link of the figure and what its joints could do about it, radians; 0 for a clip of
    /// joints.
    pub error_rad: f64,
    /// Whether [`crate::Command::SlowToFit`] is looking for key times.
    pub slowing: bool,
}

/// A stretch of the clip over which one joint is asked too much.
#[derive(Clone, Debug, PartialEq)]
pub struct StretchView {
    /// Animation time of its beginning.
    pub from_secs: f64,
    /// Animation time of its end.
    pub to_secs: f64,
    /// The joint, by its name in the puppet profile.
    pub joint: String,
    /// The figure's link that the joint follows, by its place in the figure's order.
    pub link: Option<u16>,
    /// Of what.
    pub kind: StretchKind,
    /// The most that is asked, against what it can; above 1.
    pub factor: f64,
    /// Whether slowing down helps.
    pub slowable: bool,
}

/// What a joint is asked too much of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StretchKind {
    /// A pose that it cannot take.
    Reach,
    /// Speed.
    Speed,
    /// Change of speed.
    Acceleration,
    /// Torque.
    Torque,
}

impl StretchKind {
    /// As tables and files say it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Reach => "reach",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
            Self::Torque => "torque",
        }
    }
}

impl std::fmt::Display for StretchView {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{:.2} s to {:.2} s: {} is asked {:.2} times its {}",
            self.from_secs,
            self.to_secs,
            self.joint,
            self.factor,
            match self.kind {
                StretchKind::Reach => "reach",
                StretchKind::Speed => "speed limit",
                StretchKind::Acceleration => "acceleration limit",
                StretchKind::Torque => "torque",
            }
        )
    }
}
