//! Building the profile: one group for every link that turns by itself, and one for the base.

use std::collections::BTreeSet;

use device_profiles::{Coupling, PuppetGroup, PuppetJoint, PuppetProfile, Status};
use glam::{DVec3, EulerRot};
use motion::Rigid;
use urdf_rs::{Joint, JointType};

use super::map::{Map, Servo};
use super::tree::{Tree, rigid, turns};
use crate::document::fault::Findings;

/// A link without anything to show its length by is drawn this long, metres.
const STUB_M: f64 = 0.02;
/// How far a joint without end may go to either side, radians: once around, less what keeps a servo of 1024 counts off
/// its own seam.
const CONTINUOUS_RAD: f64 = 3.13;
/// Shorter than this is no length, metres.
const LENGTH_MIN_M: f64 = 1e-4;

/// What a link and everything rigid with it comes to, in the link's own frame.
#[derive(Default)]
struct Part {
    mass_kg: f64,
    /// Mass times place.
    moment: DVec3,
    /// Some piece of it has no mass in the file.
    unknown: bool,
    /// Where frames and joints sit on it.
    marks: Vec<DVec3>,
    /// Joints that turn: place in the file, and from where on this link.
    joints: Vec<(usize, Rigid)>,
}

struct Building<'a> {
    tree: &'a Tree,
    map: &'a Map,
    found: &'a mut Findings,
    groups: Vec<PuppetGroup>,
    couplings: Vec<Coupling>,
}

/// The profile, unless something is missing.
pub(super) fn profile(tree: &Tree, map: &Map, found: &mut Findings) -> Option<PuppetProfile> {
    let before = found.errors.len();
    let mut building = Building {
        tree,
        map,
        found,
        groups: Vec::new(),
        couplings: Vec::new(),
    };
    building.check_map();
    building.group(&tree.root, None, None);
    building.couple();
    let Building {
        groups, couplings, ..
    } = building;
    (found.errors.len() == before).then(|| PuppetProfile {
        key: String::new(),
        name: map.name.clone().unwrap_or_else(|| tree.robot.name.clone()),
        status: Status::Untested,
        source: map.source.clone().unwrap_or_else(|| {
            let file = tree
                .source
                .path()
                .file_name()
                .unwrap_or_default()
                .to_string_lossy();
            format!("converted from {file}")
        }),
        figure: map.figure.clone(),
        policy: map.policy.unwrap_or_default(),
        buses: map.buses.clone(),
        groups,
        couplings,
    })
}

impl Building<'_> {
    /// Names in the mapping must be names in the robot.
    fn check_map(&mut self) {
        let joints: BTreeSet<&str> = self
            .tree
            .robot
            .joints
            .iter()
            .map(|joint| joint.name.as_str())
            .collect();
        for name in self.map.joints.keys().chain(&self.map.rigid) {
            if !joints.contains(name.as_str()) {
                let known: Vec<&str> = joints.iter().copied().collect();
                let error = self.map.fault(name, format!("the robot has no joint {name}"));
                self.found
                    .error(error.with_hint(format!("it has {}", known.join(", "))));
            }
        }
        for name in self
            .map
            .links
            .keys()
            .filter(|name| self.tree.link(name).is_none())
        {
            let links: Vec<&str> = self
                .tree
                .robot
                .links
                .iter()
                .map(|link| link.name.as_str())
                .collect();
            let error = self.map.fault(name, format!("the robot has no link {name}"));
            self.found
                .error(error.with_hint(format!("it has {}", links.join(", "))));
        }
        for joint in &self.tree.robot.joints {
            if self.drives(joint) && !turns(joint) {
                let message = format!(
                    "joint {} is {:?}, and a servo turns",
                    joint.name, joint.joint_type
                );
                let error = self.map.fault(&joint.name, message.to_lowercase());
                self.found.error(
                    error.with_hint("leave it out here; give the joint that moves the linkage instead"),
                );
            }
        }
    }

    fn drives(&self, joint: &Joint) -> bool {
        self.map.joints.contains_key(&joint.name)
    }

    /// A link, everything rigid with it, and then what turns on it.
    fn group(&mut self, link: &str, parent: Option<&str>, joint: Option<PuppetJoint>) {
        let mut part = Part::default();
        self.gather(link, Rigid::IDENTITY, &mut part);
        let (length_m, tool_rpy_rad) = along(&part);
        let known = part.mass_kg > 0.0 && !part.unknown;
        let names = self.map.links.get(link).cloned().unwrap_or_default();
        let name = names.name.unwrap_or_else(|| link.to_owned());
        self.groups.push(PuppetGroup {
            link: name.clone(),
            also: names.also,
            parent: parent.map(str::to_owned),
            length_m,
            tool_xyz_m: [0.0; 3],
            tool_rpy_rad,
            mass_kg: known.then_some(part.mass_kg),
            centre_of_mass_xyz_m: if known {
                (part.moment / part.mass_kg).to_array()
            } else {
                [0.0; 3]
            },
            joints: joint.into_iter().collect(),
        });
        for (index, from) in part.joints {
            let joint = &self.tree.robot.joints[index];
            let made = self.joint(joint, from);
            self.group(&joint.child.link, Some(&name), made);
        }
    }

    /// Adds a link, which lies at `at` in the part, and what is rigid with it.
    fn gather(&mut self, name: &str, at: Rigid, part: &mut Part) {
        if let Some(link) = self.tree.link(name) {
            let mass = link.inertial.mass.value;
            part.mass_kg += mass;
            part.moment += at.transform_point(rigid(&link.inertial.origin).translation) * mass;
            // Frames without shape weigh nothing; a shape without mass is a mass that was left out.
            part.unknown |= mass <= 0.0 && !link.visual.is_empty();
        }
        let indices = self.tree.children.get(name).cloned().unwrap_or_default();
        for index in indices {
            let joint = &self.tree.robot.joints[index];
            let place = at * rigid(&joint.origin);
            part.marks.push(place.translation);
            if self.stays(joint) {
                self.gather(&joint.child.link, place, part);
            } else {
                part.joints.push((index, at));
            }
        }
    }

    /// Whether a joint holds its parts together.
    fn stays(&mut self, joint: &Joint) -> bool {
        if joint.joint_type == JointType::Fixed || self.map.rigid.contains(&joint.name) {
            return true;
        }
        if self.drives(joint) {
            return false;
        }
        if joint.mimic.is_some() || !turns(joint) {
            let message = format!("joint {} has no servo and is taken to stay at 0", joint.name);
            let warning = self.tree.fault(&joint.name, message);
            self.found
                .warn(warning.with_hint("name it in `rigid` of the mapping to be rid of this"));
            return true;
        }
        let error = self.tree.fault(
            &joint.name,
            format!("joint {} turns, but the mapping has no servo for it", joint.name),
        );
        let hint = format!(
            "add [joint.{}] with an id to the mapping, or name it in `rigid`",
            joint.name
        );
        self.found.error(error.with_hint(hint));
        true
    }

    /// The joint and its servo, from a URDF joint whose parent lies at `from` in the group.
    fn joint(&mut self, joint: &Joint, from: Rigid) -> Option<PuppetJoint> {
        let servo = self.map.joints.get(&joint.name)?;
        let defaults = &self.map.defaults;
        let origin = from * rigid(&joint.origin);
        let (yaw, pitch, roll) = origin.rotation.to_euler(EulerRot::ZYX);
        let axis = DVec3::from_array(joint.axis.xyz.0).try_normalize();
        if axis.is_none() {
            let error = self
                .tree
                .fault(&joint.name, format!("joint {} turns about no axis", joint.name));
            self.found.error(error);
        }
        let [min_rad, max_rad] = self.range(joint, servo)?;
        Some(PuppetJoint {
            name: joint.name.clone(),
            bus: self.wanted(
                joint,
                "bus",
                servo
                    .bus
                    .clone()
                    .or(defaults.bus.clone())
                    .or_else(|| self.only_bus()),
            )?,
            id: self.wanted(joint, "id", servo.id)?,
            model: self.wanted(joint, "model", servo.model.clone().or(defaults.model.clone()))?,
            sign: servo.sign.or(defaults.sign).unwrap_or(1),
            zero_counts: self.wanted(joint, "zero_counts", servo.zero_counts.or(defaults.zero_counts))?,
            min_rad,
            max_rad,
            speed_max_rad_per_s: self.speed(joint, servo)?,
            accel_max_rad_per_s2: self.accel(joint, servo)?,
            jerk_max_rad_per_s3: servo.jerk_max_rad_per_s3.or(defaults.jerk_max_rad_per_s3),
            origin_xyz_m: origin.translation.to_array(),
            origin_rpy_rad: [roll, pitch, yaw],
            axis: axis?.to_array(),
        })
    }

    fn only_bus(&self) -> Option<String> {
        match self.map.buses.as_slice() {
            [bus] => Some(bus.name.clone()),
            _ => None,
        }
    }

    fn wanted<T>(&mut self, joint: &Joint, key: &str, value: Option<T>) -> Option<T> {
        if value.is_none() {
            let error = self
                .map
                .fault(&joint.name, format!("joint {} has no {key}", joint.name));
            self.found
                .error(error.with_hint(format!("give {key} in [joint.{}] or in [defaults]", joint.name)));
        }
        value
    }

    /// The mapping's range, else the robot's; a continuous joint may go once around.
    fn range(&mut self, joint: &Joint, servo: &Servo) -> Option<[f64; 2]> {
        let limit = &joint.limit;
        let given = match joint.joint_type {
            JointType::Continuous => Some([-CONTINUOUS_RAD, CONTINUOUS_RAD]),
            _ => (limit.lower < limit.upper).then_some([limit.lower, limit.upper]),
        };
        let defaults = &self.map.defaults;
        let min = servo.min_rad.or(given.map(|g| g[0])).or(defaults.min_rad);
        let max = servo.max_rad.or(given.map(|g| g[1])).or(defaults.max_rad);
        let range = min.zip(max).filter(|(min, max)| min < max);
        if range.is_none() {
            let error = self.tree.fault(
                &joint.name,
                format!("joint {} has no range to move in", joint.name),
            );
            let hint = format!(
                "give min_rad and max_rad in [joint.{}] of the mapping",
                joint.name
            );
            self.found.error(error.with_hint(hint));
        }
        range.map(|(min, max)| [min, max])
    }

    /// The slowest that anybody names.
    fn speed(&mut self, joint: &Joint, servo: &Servo) -> Option<f64> {
        let robot = Some(joint.limit.velocity).filter(|v| v.is_finite() && *v > 0.0);
        let ours = servo
            .speed_max_rad_per_s
            .or(self.map.defaults.speed_max_rad_per_s);
        let slowest = match (robot, ours) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        self.wanted(joint, "speed_max_rad_per_s", slowest)
    }

    fn accel(&mut self, joint: &Joint, servo: &Servo) -> Option<f64> {
        let robot = Some(joint.limit.acceleration).filter(|a| a.is_finite() && *a > 0.0);
        let ours = servo
            .accel_max_rad_per_s2
            .or(self.map.defaults.accel_max_rad_per_s2);
        let gentlest = match (robot, ours) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        self.wanted(joint, "accel_max_rad_per_s2", gentlest)
    }

    /// Mimic joints with a servo follow the joint that leads, over however many that follow in turn.
    fn couple(&mut self) {
        let (tree, map) = (self.tree, self.map);
        let joints = &tree.robot.joints;
        let drives = |joint: &Joint| map.joints.contains_key(&joint.name);
        let find = |name: &str| joints.iter().find(|joint| joint.name == name);
        for joint in joints.iter().filter(|joint| drives(joint)) {
            let (mut ratio, mut offset_rad) = (1.0, 0.0);
            let mut leads = joint;
            let mut steps = 0;
            while let Some(mimic) = &leads.mimic {
                offset_rad += ratio * mimic.offset.unwrap_or(0.0);
                ratio *= mimic.multiplier.unwrap_or(1.0);
                steps += 1;
                let Some(next) = find(&mimic.joint).filter(|_| steps <= joints.len()) else {
                    let message = format!("joint {} mimics {}, which leads nowhere", joint.name, mimic.joint);
                    self.found.error(tree.fault(&joint.name, message));
                    return;
                };
                leads = next;
            }
            if steps == 0 {
                continue;
            }
            if !drives(leads) {
                let message = format!("joint {} follows {}, which has no servo", joint.name, leads.name);
                self.found.error(map.fault(&joint.name, message));
            }
            self.couplings.push(Coupling {
                joint: joint.name.clone(),
                follows: leads.name.clone(),
                ratio,
                offset_rad,
            });
        }
    }
}

/// Length and direction a link is drawn with: to the farthest thing that sits on it, else through its centre of mass.
fn along(part: &Part) -> (f64, [f64; 3]) {
    let farthest = part
        .marks
        .iter()
        .copied()
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        .filter(|mark| mark.length() > LENGTH_MIN_M);
    let through_mass = (part.mass_kg > 0.0)
        .then(|| part.moment / part.mass_kg * 2.0)
        .filter(|end| end.length() > LENGTH_MIN_M);
    match farthest.or(through_mass) {
        // z along the link: first about y, then about z.
        Some(end) => (
            end.length(),
            [0.0, end.truncate().length().atan2(end.z), end.y.atan2(end.x)],
        ),
        None => (STUB_M, [0.0; 3]),
    }
}
