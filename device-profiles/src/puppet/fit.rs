//! Whether a puppet and its servos fit each other: what no file can know of itself.

use super::{PuppetJoint, PuppetProfile};
use crate::read::Flaw;
use crate::{Profiles, ServoProfile};

/// Everything that keeps `puppet` from working with the servos there are.
pub(crate) fn misfits(puppet: &PuppetProfile, among: &Profiles) -> Vec<Flaw> {
    let mut flaws = Vec::new();
    for (at, joint) in puppet.joints().enumerate() {
        let mut flaw = |message: String| {
            let message = format!("joint \"{}\": {message}", joint.name);
            flaws.push(Flaw::at_header("[[group.joint]]", at, message));
        };
        match among.servo(&joint.model) {
            Ok(servo) => {
                if let Some(message) = out_of_range(joint, servo) {
                    flaw(message);
                }
            }
            Err(absent) => flaw(format!("{absent}; add one or correct `model`")),
        }
    }
    for (at, bus) in puppet.buses.iter().enumerate() {
        let deaf = puppet
            .joints_on(&bus.name)
            .filter_map(|joint| among.servo(&joint.model).ok())
            .find(|servo| servo.baud_code(bus.baud).is_none());
        if let Some(servo) = deaf {
            let known: Vec<String> = servo.bauds.iter().map(u32::to_string).collect();
            let message = format!(
                "bus \"{}\" has {} baud, which {} cannot; it can {}",
                bus.name,
                bus.baud,
                servo.name,
                known.join(", ")
            );
            flaws.push(Flaw::at_header("[[bus]]", at, message));
        }
    }
    flaws
}

fn out_of_range(joint: &PuppetJoint, servo: &ServoProfile) -> Option<String> {
    let counts =
        |rad: f64| f64::from(joint.zero_counts) + f64::from(joint.sign) * rad / servo.rad_per_count();
    let ends = [counts(joint.min_rad), counts(joint.max_rad)].map(|c| c.round() as i64);
    let [first, last] = servo.position_counts;
    let inside = ends.iter().all(|end| (first..=last).contains(end));
    (!inside).then(|| {
        format!(
            "its range is counts {} to {}, and {} takes goals from {first} to {last}; mount the horn so that the range \
             lies inside and set zero_counts accordingly, or narrow min_rad and max_rad",
            ends[0].min(ends[1]),
            ends[0].max(ends[1]),
            servo.name
        )
    })
}
