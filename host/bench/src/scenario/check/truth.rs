//! Judging what no byte on a wire tells: shafts, memories and lives of servos.

use device_profiles::Role;

use super::servos::chosen;
use super::{Bound, EVENTS, Evidence, Near, SHAFT_PARTS, ShaftPart};
use crate::stand::JointTruth;

fn truth_of<'a>(evidence: &'a Evidence<'_>, joint: &'a str) -> Result<&'a JointTruth, String> {
    let mut all = chosen(evidence.truths, Some(joint))?;
    all.next().ok_or_else(|| format!("there is no joint {joint}"))
}

pub(super) fn shaft(evidence: &Evidence<'_>, joint: &str, part: ShaftPart, near: Near) -> Result<(), String> {
    let truth = truth_of(evidence, joint)?;
    let value = match part {
        ShaftPart::Position => truth.position_rad,
        ShaftPart::Speed => truth.velocity_rad_per_s,
        ShaftPart::Effort => truth.effort,
        ShaftPart::Temperature => truth.temperature_c,
    };
    let name = SHAFT_PARTS
        .iter()
        .find(|(_, known)| *known == part)
        .map_or("", |(name, _)| name);
    near.judge(&format!("{name} of {joint}"), Some(value), evidence.hil)
}

pub(super) fn register(evidence: &Evidence<'_>, joint: &str, role: Role, near: Near) -> Result<(), String> {
    let found = evidence
        .stand
        .register(joint, role)
        .map_err(|error| error.to_string())?;
    let value = found.map(|value| value as f64);
    near.judge(&format!("{role} of {joint}"), value, evidence.hil)
}

pub(super) fn life(evidence: &Evidence<'_>, joint: &str, event: usize, bound: Bound) -> Result<(), String> {
    let life = truth_of(evidence, joint)?.life;
    let count = [
        life.reboots,
        life.shutdowns,
        life.torque_ons,
        life.watchdog_trips,
        life.eeprom_changes,
        life.refused_writes,
        life.goal_writes,
    ][event];
    bound.judge(&format!("{} of {joint}", EVENTS[event]), count)
}
