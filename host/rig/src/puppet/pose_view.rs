//! The puppet as it is posed, for windows: angles, lines, and where hands can take hold.

use glam::DVec3;

/// A puppet posed joint by joint or by its ends, or as its clip of joints shows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PuppetPoseView {
    /// The puppet's name.
    pub puppet: String,
    /// Joint names, in the order of `angles_rad`, `ranges_rad` and `joints`.
    pub names: Vec<String>,
    /// Radians.
    pub angles_rad: Vec<f64>,
    /// Where each may go, radians.
    pub ranges_rad: Vec<[f64; 2]>,
    /// Joints that follow another are not posed by themselves.
    pub led: Vec<bool>,
    /// As [`crate::PuppetView::bones`], in the same order.
    pub bones: Vec<[DVec3; 2]>,
    /// Where each joint sits.
    pub joints: Vec<JointHandle>,
    /// What can be dragged.
    pub ends: Vec<EndHandle>,
    /// Whether it was changed by hand since it was last a pose of the clip.
    pub by_hand: bool,
    /// How far the last drag stayed from where the end was wanted, metres.
    pub drag_error_m: f64,
}

/// A joint to be turned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointHandle {
    /// World axes, metres.
    pub at: DVec3,
    /// Unit vector, world axes; positive angles turn right-handed about it.
    pub axis: DVec3,
}

/// The end of a link, to be dragged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EndHandle {
    /// The link's name.
    pub link: String,
    /// World axes, metres.
    pub at: DVec3,
}
