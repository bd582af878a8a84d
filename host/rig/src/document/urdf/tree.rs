//! The robot as a tree: parts that fixed joints hold together are one, joints that turn lie between.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use motion::Rigid;
use urdf_rs::{Joint, JointType, Link, Pose, Robot};

use super::LINKS_MAX;
use crate::document::fault::{FileError, Findings};
use crate::document::source::Source;

/// A robot whose links hang together.
pub(super) struct Tree {
    pub(super) source: Source,
    pub(super) robot: Robot,
    pub(super) root: String,
    /// Joints by the link they hang from, in the file's order.
    pub(super) children: BTreeMap<String, Vec<usize>>,
}

impl Tree {
    pub(super) fn read(source: &Source, found: &mut Findings) -> Option<Self> {
        let robot = match urdf_rs::read_from_string(source.text()) {
            Ok(robot) => robot,
            Err(error) => {
                let error = source.error(0, format!("this is no URDF: {error}"));
                found.error(error.with_hint(
                    "a URDF is XML with <robot>, <link> and <joint>; run xacro on .xacro files first",
                ));
                return None;
            }
        };
        if robot.links.is_empty() || robot.links.len() > LINKS_MAX {
            let count = robot.links.len();
            found.error(source.error(0, format!("{count} links; a robot has 1 to {LINKS_MAX}")));
            return None;
        }
        let before = found.errors.len();
        let mut tree = Self {
            source: source.clone(),
            root: String::new(),
            children: BTreeMap::new(),
            robot,
        };
        tree.check_names(found);
        tree.hang(found);
        (found.errors.len() == before).then_some(tree)
    }

    /// An error at the first mention of a name in quotes.
    pub(super) fn fault(&self, name: &str, message: impl Into<String>) -> FileError {
        let at = self.source.text().find(&format!("\"{name}\"")).unwrap_or(0);
        self.source.error(at, message)
    }

    pub(super) fn link(&self, name: &str) -> Option<&Link> {
        self.robot.links.iter().find(|link| link.name == name)
    }

    fn check_names(&self, found: &mut Findings) {
        let links = self.robot.links.iter().map(|link| ("link", &link.name));
        let joints = self.robot.joints.iter().map(|joint| ("joint", &joint.name));
        let mut seen = BTreeSet::new();
        for (what, name) in links.chain(joints) {
            if !seen.insert((what, name)) {
                found.error(self.fault(name, format!("two {what}s are called {name}")));
            }
        }
    }

    /// Finds the root, and that everything hangs from it.
    fn hang(&mut self, found: &mut Findings) {
        let mut parents: BTreeMap<&str, &Joint> = BTreeMap::new();
        let mut faults = Vec::new();
        for joint in &self.robot.joints {
            for link in [&joint.parent.link, &joint.child.link] {
                if self.link(link).is_none() {
                    let message = format!(
                        "joint {} names link {link}, which the robot does not have",
                        joint.name
                    );
                    faults.push(self.fault(&joint.name, message));
                }
            }
            if let Some(other) = parents.insert(&joint.child.link, joint) {
                let message = format!(
                    "link {} hangs from two joints, {} and {}",
                    joint.child.link, other.name, joint.name
                );
                faults.push(
                    self.fault(&joint.name, message)
                        .with_hint("loops cannot be puppets; cut one joint out"),
                );
            }
        }
        let roots: Vec<&str> = self
            .robot
            .links
            .iter()
            .map(|link| link.name.as_str())
            .filter(|link| !parents.contains_key(link))
            .collect();
        match roots.as_slice() {
            [root] => self.root = (*root).to_owned(),
            [] => faults.push(
                self.source
                    .error(0, "every link hangs from another; there is no base"),
            ),
            [_, second, ..] => {
                let message = format!("{} links hang from nothing: {}", roots.len(), roots.join(", "));
                let hint = "join them to the base with fixed joints, or take them out";
                faults.push(self.fault(second, message).with_hint(hint));
            }
        }
        for fault in faults {
            found.error(fault);
        }
        let mut children: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (index, joint) in self.robot.joints.iter().enumerate() {
            children.entry(joint.parent.link.clone()).or_default().push(index);
        }
        self.children = children;
    }
}

/// A pose as URDF writes it.
pub(super) fn rigid(pose: &Pose) -> Rigid {
    Rigid::from_xyz_rpy(DVec3::from_array(pose.xyz.0), DVec3::from_array(pose.rpy.0))
}

/// Whether a joint turns about one axis.
pub(super) fn turns(joint: &Joint) -> bool {
    matches!(joint.joint_type, JointType::Revolute | JointType::Continuous)
}
