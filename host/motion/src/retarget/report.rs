//! What following cost: errors, limits and changes of mind.

use crate::figure::LinkIndex;

/// How one group did in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroupReport {
    /// The link it follows.
    pub link: LinkIndex,
    /// What was minimised: squared direction error, a quarter of the squared error of the x axis where
    /// twist counts, and a trace of the squared change of angles.
    pub cost: f64,
    /// Angle between the link's direction and the reached one, radians.
    pub direction_error_rad: f64,
    /// Which of its joints stand at a limit.
    pub at_limit: [bool; super::GROUP_JOINTS_MAX],
    /// Whether another branch was at least twice as good and was taken.
    pub switched: bool,
}

/// How all groups did in one frame, base first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RetargetReport {
    /// One for each group.
    pub groups: Vec<GroupReport>,
}

impl RetargetReport {
    /// The largest direction error, radians.
    pub fn direction_error_rad(&self) -> f64 {
        self.groups
            .iter()
            .map(|group| group.direction_error_rad)
            .fold(0.0, f64::max)
    }

    /// Whether any joint stands at a limit.
    pub fn at_limit(&self) -> bool {
        self.groups.iter().any(|group| group.at_limit.contains(&true))
    }

    /// Whether any group took another branch.
    pub fn switched(&self) -> bool {
        self.groups.iter().any(|group| group.switched)
    }
}
