//! Curves, kinetics, figures and chains: the pure mathematics of posing.
//!
//! **Knows**: splines, the double interpolant (path and timing as two curves), link figures whose
//! directions live on a sphere, robot chains, and how the one follows the other.
//!
//! **Must not know**: files, clocks, threads, devices, networks of functions, random numbers.
//! Time comes in as a number of seconds; everything here is a function of its arguments.
//!
//! **Start reading** at [`Kinetics`], then [`Clip`]: value(t) = path(kinetics(t)). [`figure`] is what
//! people pose, [`chain`] is what moves, [`Retarget`] lets the second follow the first, [`JointTrack`] is
//! what then moves over time, judged by [`feasibility`], and [`JointClip`] the baked result that a puppet plays.
//!
//! Frames are right-handed, `target_from_source`, column vectors. Angles are radians, lengths metres,
//! times seconds. The definitions are those of the visual keyframing thesis of 1989; where it is silent,
//! the choice made is stated at the item.

pub mod chain;
pub mod clip;
pub mod curve;
pub mod feasibility;
pub mod figure;
pub mod joint_clip;
pub mod joint_track;
pub mod keyframe;
pub mod kinetics;
pub mod retarget;
pub mod thin;
pub mod track;

pub use chain::{Chain, ChainError, Coupling, Joint, JointIndex, JointKind, Rigid};
pub use clip::{Clip, ClipError, ClipWarning};
pub use curve::{BSpline, Blend, Curve, Interval, Natural, Smooth, SplineError};
pub use figure::{
    Attachment, DirectionLaw, Figure, FigureError, FigurePose, FigureWarning, Freedom, Link, LinkIndex,
    LinkPose, LinkSpec, Placed, TwistLaw,
};
pub use joint_clip::{BakeReport, JointClip, JointClipError};
pub use joint_track::{JointKey, JointPath, JointTrack, KeyedJointsError};
pub use keyframe::{FigureKey, KeyframeError, Keyframes};
pub use kinetics::{Kinetics, KineticsError, KineticsMode, Ordering};
pub use retarget::{Group, GroupReport, Retarget, RetargetError, RetargetReport};
pub use track::Track;
