//! What can be wrong with a puppet beyond its shape.

use super::{Coupling, PuppetGroup, PuppetJoint, PuppetProfile};
use crate::read::{Check, Flaw};
use std::collections::BTreeSet;

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
        for (at, coupling) in self.couplings.iter().enumerate() {
            for message in self.coupling_flaws(at, coupling) {
                flaws.push(Flaw::at_header("[[coupling]]", at, message));
            }
        }
        self.policy.flaws(flaws);
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

impl PuppetProfile {
    fn coupling_flaws(&self, at: usize, coupling: &Coupling) -> Vec<String> {
        let Coupling {
            joint,
            follows,
            ratio,
            offset_rad,
        } = coupling;
        let mut found = Vec::new();
        if !(ratio.is_finite() && *ratio != 0.0 && offset_rad.is_finite()) {
            found.push(format!(
                "the coupling of \"{joint}\" must have a ratio other than 0 and a finite offset_rad, found {ratio} \
                 and {offset_rad}"
            ));
        }
        if self.couplings[..at].iter().any(|c| c.joint == *joint) {
            found.push(format!("joint \"{joint}\" has two couplings; one is allowed"));
        }
        if joint == follows || self.coupling(follows).is_some() {
            found.push(format!(
                "joint \"{joint}\" follows \"{follows}\", which follows a joint itself; name the joint that leads"
            ));
        }
        for name in [joint, follows] {
            if self.joint(name).is_none() {
                found.push(format!(
                    "the coupling of \"{joint}\" names joint \"{name}\", which the puppet does not have"
                ));
            }
        }
        if let (Some(led), Some(leading)) = (self.joint(joint), self.joint(follows)) {
            let ends = [leading.min_rad, leading.max_rad].map(|rad| coupling.angle_rad(rad));
            // Ranges are typed by hand: a thousandth of a radian is no contradiction.
            if ends
                .iter()
                .any(|&rad| rad < led.min_rad - 1e-3 || rad > led.max_rad + 1e-3)
            {
                found.push(format!(
                    "joint \"{joint}\" would be led to between {} and {} rad, out of its own {} to {}; narrow the \
                     range of \"{follows}\"",
                    ends[0].min(ends[1]),
                    ends[0].max(ends[1]),
                    led.min_rad,
                    led.max_rad
                ));
            }
        }
        found
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
    if group.mass_kg.is_some_and(|kg| !(kg.is_finite() && kg >= 0.0))
        || !group.centre_of_mass_xyz_m.iter().all(|c| c.is_finite())
    {
        return Some(format!(
            "group \"{link}\" must have a mass_kg of at least 0 and a finite centre_of_mass_xyz_m"
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
            ("jerk_max_rad_per_s3", self.jerk_max_rad_per_s3.unwrap_or(1.0)),
        ] {
            if !(value.is_finite() && value > 0.0) {
                found.push(format!("{what} must be above 0, found {value}"));
            }
        }
        // Acceleration is built up over twice its limit by that of jerk: more than two seconds is no joint's.
        if let Some(jerk) = self.jerk_max_rad_per_s3
            && jerk > 0.0
            && jerk < self.accel_max_rad_per_s2
        {
            found.push(format!(
                "jerk_max_rad_per_s3 must be at least accel_max_rad_per_s2, {}, or each change takes longer than 2 s; found {jerk}",
                self.accel_max_rad_per_s2
            ));
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
