//! Puppets: which servo sits in which joint, on which bus, and how the joints hang together.
//!
//! Geometry follows one rule: `body_from_joint` of each joint is its origin (translation, then
//! Rz(yaw)·Ry(pitch)·Rx(roll)) times a turn by q about its axis, chained from the parent group's last joint.
//! All groups' frames are parallel at rest only if their rpy are zero; nothing here requires that.

use crate::Status;
use crate::read::{Check, Flaw};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// One puppet: its buses and, parents first, the groups of joints that follow a figure's links.
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
    /// The figure whose link names the groups use, in words.
    pub figure: String,
    /// The serial lines the servos hang on.
    #[serde(rename = "bus")]
    pub buses: Vec<PuppetBus>,
    /// Parents before children; the first is the root and has no parent.
    #[serde(rename = "group")]
    pub groups: Vec<PuppetGroup>,
}

/// One serial line with servos on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PuppetBus {
    /// What joints call it.
    pub name: String,
    /// Line speed.
    pub baud: u32,
}

/// Up to three revolute joints that together give one figure link its direction.
/// Without joints it is a rigid part of its parent, there to be drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PuppetGroup {
    /// The figure link it follows, and this group's own name.
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

    /// The group that follows that figure link.
    pub fn group(&self, link: &str) -> Option<&PuppetGroup> {
        self.groups.iter().find(|g| g.link == link)
    }

    /// The bus of that name.
    pub fn bus(&self, name: &str) -> Option<&PuppetBus> {
        self.buses.iter().find(|b| b.name == name)
    }
}

impl Check for PuppetProfile {
    fn flaws(&self, flaws: &mut Vec<Flaw>) {
        if self.groups.is_empty() {
            flaws.push(Flaw::at_key(
                "group",
                "a puppet must have at least one [[group]], found none",
            ));
        }
        let mut links = BTreeSet::new();
        for (at, group) in self.groups.iter().enumerate() {
            if let Some(message) = group_flaw(at, group, &links) {
                flaws.push(Flaw::at_header("[[group]]", at, message));
            }
            links.insert(group.link.as_str());
        }
        self.flaws_of_buses(flaws);
        self.flaws_of_joints(flaws);
    }
}

impl PuppetProfile {
    fn flaws_of_buses(&self, flaws: &mut Vec<Flaw>) {
        for (at, bus) in self.buses.iter().enumerate() {
            if self.buses[..at].iter().any(|b| b.name == bus.name) {
                let message = format!(
                    "bus \"{}\" occurs more than once; names of buses must differ",
                    bus.name
                );
                flaws.push(Flaw::at_header("[[bus]]", at, message));
            }
        }
    }

    fn flaws_of_joints(&self, flaws: &mut Vec<Flaw>) {
        let mut names = BTreeSet::new();
        let mut ids = BTreeSet::new();
        for (at, joint) in self.joints().enumerate() {
            let mut flaw = |message: String| flaws.push(Flaw::at_header("[[group.joint]]", at, message));
            if !names.insert(&joint.name) {
                flaw(format!(
                    "joint \"{}\" occurs more than once; names of joints must differ",
                    joint.name
                ));
            }
            if !ids.insert((&joint.bus, joint.id)) {
                flaw(format!(
                    "joint \"{}\": id {} is taken on bus \"{}\"",
                    joint.name, joint.id, joint.bus
                ));
            }
            if self.bus(&joint.bus).is_none() {
                flaw(format!(
                    "joint \"{}\" is on bus \"{}\", which the puppet does not have",
                    joint.name, joint.bus
                ));
            }
            for message in joint.flaws() {
                flaw(format!("joint \"{}\": {message}", joint.name));
            }
        }
    }
}

fn group_flaw(at: usize, group: &PuppetGroup, links_before: &BTreeSet<&str>) -> Option<String> {
    let link = &group.link;
    if links_before.contains(link.as_str()) {
        return Some(format!("link \"{link}\" has two groups; one is allowed"));
    }
    if group.joints.len() > 3 {
        return Some(format!(
            "group \"{link}\" has {} joints; three are allowed",
            group.joints.len()
        ));
    }
    if !(group.length_m.is_finite() && group.length_m > 0.0) {
        return Some(format!(
            "group \"{link}\" must have a length_m above 0, found {}",
            group.length_m
        ));
    }
    match &group.parent {
        None if at > 0 => Some(format!(
            "group \"{link}\" has no parent; only the first group may be the root"
        )),
        Some(parent) if !links_before.contains(parent.as_str()) => Some(format!(
            "group \"{link}\" hangs from \"{parent}\", which no group above it follows"
        )),
        _ => None,
    }
}

impl PuppetJoint {
    fn flaws(&self) -> Vec<String> {
        let mut found = Vec::new();
        let length = self.axis.iter().map(|c| c * c).sum::<f64>().sqrt();
        // A profile may be typed by hand: four digits of an axis are enough.
        if !length.is_finite() || (length - 1.0).abs() > 1e-3 {
            found.push(format!(
                "axis must be a unit vector, found one of length {length}"
            ));
        }
        if ![-1, 1].contains(&self.sign) {
            found.push(format!("sign must be 1 or -1, found {}", self.sign));
        }
        // 253 and up mean something else on a DYNAMIXEL bus.
        if self.id > 252 {
            found.push(format!("id must be 0 to 252, found {}", self.id));
        }
        let range = [self.min_rad, self.max_rad];
        if !range.iter().all(|r| r.is_finite()) || self.min_rad >= self.max_rad {
            found.push(format!(
                "min_rad must lie below max_rad, found {} and {}",
                self.min_rad, self.max_rad
            ));
        }
        for (what, value) in [
            ("speed_max_rad_per_s", self.speed_max_rad_per_s),
            ("accel_max_rad_per_s2", self.accel_max_rad_per_s2),
        ] {
            if !(value.is_finite() && value > 0.0) {
                found.push(format!("{what} must be above 0, found {value}"));
            }
        }
        if !self
            .origin_xyz_m
            .iter()
            .chain(&self.origin_rpy_rad)
            .all(|c| c.is_finite())
        {
            found.push("origin_xyz_m and origin_rpy_rad must be finite".to_owned());
        }
        found
    }
}

fn is_zero3(v: &[f64; 3]) -> bool {
    *v == [0.0; 3]
}
