//! The puppet as snapshots show it.

use device::clock::Instant;
use device::servo::Presence;
use device::servo::member::error_names;
use device_profiles::{PuppetJoint, PuppetProfile};
use player::{JointReport, Report, State, Trouble};

use super::bones::Bones;
use crate::snapshot::{JointView, PuppetState, PuppetView};

/// A puppet that has a player.
pub(super) fn of(profile: &PuppetProfile, report: &Report, now: Instant) -> PuppetView {
    let (state, fault) = match &report.state {
        State::Released => (PuppetState::Released, None),
        State::Arming => (PuppetState::Arming, None),
        State::Holding => (PuppetState::Holding, None),
        State::Playing => (PuppetState::Playing, None),
        State::Faulted(fault) => (PuppetState::Faulted, Some(fault.to_string())),
    };
    let joints = of_bones(profile)
        .zip(&report.joints)
        .map(|((bone, joint), report)| seen((bone, joint), report, now))
        .collect();
    PuppetView {
        name: profile.name.clone(),
        state,
        fault,
        joints,
        clip_secs: report.clip_secs,
        stale_discarded: report.stale_discarded,
        interventions: report.interventions.total(),
        late_cycles: report.late_ticks,
        bones: Vec::new(),
        on_its_base: profile.figure.is_none(),
        goal_bones: Vec::new(),
        torque: report.torque,
        torque_unknown: report.torque_unknown,
        compensates_lag: report.compensates_lag,
        backing_off: backing_off(profile, report),
        pace: report.pace,
        goals_sent: report.goals_sent,
    }
}

/// A puppet whose lines are not open.
pub(super) fn absent(profile: &PuppetProfile, why: String) -> PuppetView {
    let joints = of_bones(profile)
        .map(|(bone, joint)| JointView {
            name: joint.name.clone(),
            bone,
            range_rad: [joint.min_rad, joint.max_rad],
            ..JointView::default()
        })
        .collect();
    PuppetView {
        name: profile.name.clone(),
        fault: Some(why),
        joints,
        on_its_base: profile.figure.is_none(),
        ..PuppetView::default()
    }
}

/// Joints, each with the line it moves: lines of groups come first, in the profile's order.
fn of_bones(profile: &PuppetProfile) -> impl Iterator<Item = (usize, &PuppetJoint)> {
    let groups = profile.groups.iter().enumerate();
    groups.flat_map(|(bone, group)| group.joints.iter().map(move |joint| (bone, joint)))
}

impl PuppetView {
    /// Draws it where it was last measured, or at rest where nothing was; and where its goals are.
    pub(super) fn draw(&mut self, bones: &mut Bones) {
        let goals_rad: Option<Vec<f64>> = self.joints.iter().map(|joint| joint.goal_rad).collect();
        self.goal_bones = goals_rad
            .map(|goals_rad| bones.at(&goals_rad))
            .unwrap_or_default();
        let angles_rad: Vec<f64> = self
            .joints
            .iter()
            .map(|joint| joint.measured_rad.unwrap_or(0.0))
            .collect();
        self.bones = bones.at(&angles_rad);
    }
}

/// What the puppet backs off for, in words; none while it does not.
pub(super) fn backing_off(profile: &PuppetProfile, report: &Report) -> Option<String> {
    let (trouble, joint) = report.backing_off?;
    let name = profile.joints().nth(joint).map(|joint| joint.name.as_str());
    let seen = report.joints.get(joint)?;
    let value = match trouble {
        Trouble::Heat => seen.temperature_c.map(|celsius| format!("{celsius:.0} C")),
        Trouble::BrownOut => seen.voltage_v.map(|volts| format!("{volts:.1} V")),
        Trouble::Overload => None,
    };
    let value = value.map(|value| format!(" ({value})")).unwrap_or_default();
    Some(format!(
        "joint \"{}\" has {}{value}: playing slower and softer",
        name.unwrap_or_default(),
        trouble.name()
    ))
}

fn seen((bone, joint): (usize, &PuppetJoint), report: &JointReport, now: Instant) -> JointView {
    JointView {
        name: joint.name.clone(),
        bone,
        goal_rad: report.goal_rad,
        measured_rad: report.measured_rad,
        age_secs: report
            .measured_at
            .map_or(f64::INFINITY, |at| now.since(at).as_secs_f64()),
        range_rad: [joint.min_rad, joint.max_rad],
        temperature_c: report.temperature_c,
        voltage_v: report.voltage_v,
        present: matches!(report.presence, Some(Presence::Present)),
        lag_secs: report.lag_secs,
        tracking: report.tracking,
        trouble: report.trouble.map(Trouble::name),
        retreat: report.retreat,
        error: (report.error_bits != 0).then(|| error_names(report.error_bits)),
    }
}
