//! Puppets: which servo sits in which joint, on which bus, and how the joints hang together.
//!
//! Geometry follows one rule: `body_from_joint` of each joint is its origin (translation, then
//! Rz(yaw)·Ry(pitch)·Rx(roll)) times a turn by q about its axis, chained from the parent group's last joint.
//! All groups' frames are parallel at rest only if their rpy are zero; nothing here requires that.

mod check;
mod fit;

pub(crate) use fit::misfits;

use crate::{Policy, Status};
use serde::{Deserialize, Serialize};

/// One puppet: its buses and, parents first, the groups of joints.
/// A puppet with a figure names its groups after the figure's links and follows it; one without is posed
/// joint by joint, and its groups are named after its own links.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PuppetProfile {
    /// The file's name without its ending; what programs ask for.
    #[serde(skip)]
    pub key: String,
    /// What people call it.
    pub name: String,
    /// How far it was tried.
    pub status: Status,
    /// Where the numbers are from.
    pub source: String,
    /// The figure whose link names the groups use, in words; absent: it follows none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub figure: Option<String>,
    /// What it does about trouble.
    #[serde(default)]
    pub policy: Policy,
    /// The serial lines the servos hang on.
    #[serde(rename = "bus")]
    pub buses: Vec<PuppetBus>,
    /// Parents before children; the first is the root and has no parent.
    #[serde(rename = "group")]
    pub groups: Vec<PuppetGroup>,
    /// Joints that another joint leads.
    #[serde(rename = "coupling", default, skip_serializing_if = "Vec::is_empty")]
    pub couplings: Vec<Coupling>,
}

/// A joint that follows another: two servos on one shaft, or fingers that close together.
/// Its angle is `ratio · (angle of the joint it follows) + offset_rad`; it is never posed by itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// The joint that is led; it has a servo like any other.
    pub joint: String,
    /// The joint it follows, which must not follow another.
    pub follows: String,
    /// Angle of the led joint for one radian of the leading one.
    pub ratio: f64,
    /// Angle of the led joint where the leading one's is 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset_rad: f64,
}

impl Coupling {
    /// The led joint's angle.
    pub fn angle_rad(&self, leading_rad: f64) -> f64 {
        self.ratio * leading_rad + self.offset_rad
    }
}

/// One serial line with servos on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PuppetBus {
    /// What joints call it.
    pub name: String,
    /// Line speed.
    pub baud: u32,
    /// Serial number of the USB adapter it hangs on, to find its port whatever the port is called today.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub usb_serial: Option<String>,
}

/// One link and the joints that carry it: up to three revolute ones, which together give a figure's link its
/// direction. Without joints it is a rigid part of its parent, there to be drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PuppetGroup {
    /// This link's name; with a figure, the figure link it follows.
    pub link: String,
    /// What the same link is called in other figures, motion capture above all; tried in this order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<String>,
    /// The link of the group it hangs from; absent for the root.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parent: Option<String>,
    /// From the link's start to its end, along its own z; metres; for drawing.
    pub length_m: f64,
    /// Where the link starts, in the last joint's frame (without joints: the parent group's last); metres.
    #[serde(default, skip_serializing_if = "is_zero3")]
    pub tool_xyz_m: [f64; 3],
    /// How the link's frame (z along the link) is turned in that frame: roll, pitch, yaw.
    #[serde(default, skip_serializing_if = "is_zero3")]
    pub tool_rpy_rad: [f64; 3],
    /// Mass of everything that is rigid with the link; absent: not known, and loads cannot be reckoned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Where that mass's centre is, in the last joint's frame (without joints: the parent group's last); metres.
    #[serde(default, skip_serializing_if = "is_zero3")]
    pub centre_of_mass_xyz_m: [f64; 3],
    /// From the parent outwards; at most three.
    #[serde(rename = "joint", default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<PuppetJoint>,
}

/// One revolute joint and the servo that turns it.
/// Counts of the servo are `zero_counts + sign · q · counts_per_turn / 2π`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PuppetJoint {
    /// Unique in the puppet.
    pub name: String,
    /// One of the puppet's buses.
    pub bus: String,
    /// The servo's id, unique on its bus.
    pub id: u8,
    /// Name of a servo profile.
    pub model: String,
    /// +1: counts grow with the joint's angle; −1: they fall.
    pub sign: i8,
    /// The servo's count where the joint's angle is 0.
    pub zero_counts: i32,
    /// Smallest angle.
    pub min_rad: f64,
    /// Largest angle.
    pub max_rad: f64,
    /// Never faster than this.
    pub speed_max_rad_per_s: f64,
    /// Never gains or loses speed faster than this.
    pub accel_max_rad_per_s2: f64,
    /// Never changes its acceleration faster than this; absent: as fast as it likes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jerk_max_rad_per_s3: Option<f64>,
    /// The joint's place in the frame before it (parent group's last joint, or the joint above in this group).
    pub origin_xyz_m: [f64; 3],
    /// How the joint's frame is turned in the frame before it: roll, pitch, yaw.
    #[serde(default, skip_serializing_if = "is_zero3")]
    pub origin_rpy_rad: [f64; 3],
    /// Unit vector in the joint's own frame; positive angles turn right-handed about it.
    pub axis: [f64; 3],
}

impl PuppetProfile {
    /// All joints, in the order of groups and then outwards; the order of a puppet's pose.
    pub fn joints(&self) -> impl Iterator<Item = &PuppetJoint> {
        self.groups.iter().flat_map(|g| &g.joints)
    }

    /// The joints on one bus, in the same order.
    pub fn joints_on<'a>(&'a self, bus: &'a str) -> impl Iterator<Item = &'a PuppetJoint> {
        self.joints().filter(move |j| j.bus == bus)
    }

    /// The joint of that name.
    pub fn joint(&self, name: &str) -> Option<&PuppetJoint> {
        self.joints().find(|j| j.name == name)
    }

    /// What leads that joint, if it is led.
    pub fn coupling(&self, joint: &str) -> Option<&Coupling> {
        self.couplings.iter().find(|c| c.joint == joint)
    }

    /// The group of that link.
    pub fn group(&self, link: &str) -> Option<&PuppetGroup> {
        self.groups.iter().find(|g| g.link == link)
    }

    /// The bus of that name.
    pub fn bus(&self, name: &str) -> Option<&PuppetBus> {
        self.buses.iter().find(|b| b.name == name)
    }
}

fn is_zero3(v: &[f64; 3]) -> bool {
    *v == [0.0; 3]
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands references to `skip_serializing_if`"
)]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
