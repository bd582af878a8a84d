//! `play --report`: how well the joints followed, their lags, and the limits that were kept, as one JSON object.
//!
//! *Before* is what the joints did after the goals they were given: what a clip would look like that is sent as it
//! is. *After* is what they did beside the clip itself while goals ran ahead of it: what is left. Both are from one
//! performance; without `--compensate-lag` there is no after. Numbers are the player's own (`player::lag`).

use std::path::Path;

use rig::{JointView, Profiles, PuppetView};
use serde_json::{Map, Value, json};

use crate::failure::Failure;

/// What a performance was like, as far as it went.
#[derive(Debug, Default)]
pub(super) struct Report {
    puppet: Option<PuppetView>,
}

fn rms(sum: f64, count: f64) -> Option<f64> {
    (count > 0.0).then(|| (sum / count).sqrt().to_degrees())
}

/// Root mean square over several joints, degrees.
fn together(joints: &[JointView], of: fn(&JointView) -> (f64, u32)) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for joint in joints {
        let (error_rad, samples) = of(joint);
        sum += error_rad * error_rad * f64::from(samples);
        count += f64::from(samples);
    }
    rms(sum, count)
}

fn before(joint: &JointView) -> (f64, u32) {
    (joint.tracking.goal_error_rms_rad, joint.tracking.goal_samples)
}

fn after(joint: &JointView) -> (f64, u32) {
    (joint.tracking.clip_error_rms_rad, joint.tracking.clip_samples)
}

/// Milliseconds to a hundredth.
fn ms(secs: Option<f64>) -> Option<f64> {
    secs.map(|secs| (secs * 1e5).round() / 100.0)
}

impl Report {
    /// The latest wins: what counts is counted by the player.
    pub(super) fn see(&mut self, puppet: &PuppetView) {
        if puppet.joints.iter().any(|joint| joint.tracking.goal_samples > 0) {
            self.puppet = Some(puppet.clone());
        }
    }

    /// Writes the file; `what` is said of the performance besides.
    pub(super) fn write(
        &self,
        path: &Path,
        profiles: &Profiles,
        key: &str,
        what: Value,
    ) -> Result<(), Failure> {
        let mut all = what;
        all["servo"] = self.servo(profiles, key);
        let text = format!("{all:#}\n");
        std::fs::write(path, text)
            .map_err(|error| Failure::refused(format!("cannot write {}: {error}", path.display())))
    }

    fn servo(&self, profiles: &Profiles, key: &str) -> Value {
        let none = PuppetView::default();
        let puppet = self.puppet.as_ref().unwrap_or(&none);
        let compensated = puppet.compensates_lag;
        let mut lag = Map::new();
        for joint in &puppet.joints {
            let known = joint.tracking;
            let left = known.behind_clip_secs.filter(|_| compensated);
            let one = |(error_rad, samples): (f64, u32)| (samples > 0).then(|| error_rad.to_degrees());
            lag.insert(
                joint.name.clone(),
                json!({
                    "before_ms": ms(known.lag_secs), "after_ms": ms(left),
                    "rms_before_deg": one(before(joint)),
                    "rms_after_deg": one(after(joint)).filter(|_| compensated),
                }),
            );
        }
        let mut limits = Map::new();
        for joint in profiles.puppet(key).iter().flat_map(|puppet| puppet.joints()) {
            let kept = json!({
                "speed_rad_per_s": joint.speed_max_rad_per_s, "accel_rad_per_s2": joint.accel_max_rad_per_s2,
            });
            limits.insert(joint.name.clone(), kept);
        }
        let most = |of: fn(&JointView) -> f64| puppet.joints.iter().map(of).fold(0.0, f64::max);
        json!({
            "rms_error_deg": {
                "before": together(&puppet.joints, before),
                "after": together(&puppet.joints, after).filter(|_| compensated),
            },
            "lag": lag,
            "limits": limits,
            "max_speed_ratio": most(|joint| joint.tracking.speed_ratio_max),
            "max_accel_ratio": most(|joint| joint.tracking.acceleration_ratio_max),
            "interventions": puppet.interventions,
            "stale_reads": puppet.stale_discarded,
            "late_cycles": puppet.late_cycles,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rig::Tracking;

    #[test]
    fn a_report_says_what_was_before_and_after() {
        let joint = |name: &str, goal_error_rms_rad, goal_samples| JointView {
            name: name.to_owned(),
            tracking: Tracking {
                lag_secs: Some(0.0421),
                behind_clip_secs: Some(-0.0011),
                goal_error_rms_rad,
                goal_samples,
                clip_error_rms_rad: 0.01,
                clip_samples: 10,
                speed_ratio_max: 0.5,
                ..Tracking::default()
            },
            ..JointView::default()
        };
        let mut puppet = PuppetView {
            joints: vec![joint("pan", 0.03, 30), joint("tilt", 0.05, 10)],
            compensates_lag: true,
            ..PuppetView::default()
        };
        let mut report = Report::default();
        report.see(&puppet);
        let servo = report.servo(&Profiles::builtin(), "starter");
        assert_eq!(servo["lag"]["pan"]["before_ms"], 42.1);
        assert_eq!(servo["lag"]["pan"]["after_ms"], -1.1);
        let rms = servo["rms_error_deg"]["before"].as_f64().expect("known");
        assert!((rms - 0.036_055_5_f64.to_degrees()).abs() < 1e-3, "{rms}");
        assert_eq!(servo["limits"]["tilt"]["speed_rad_per_s"], 6.0);
        puppet.compensates_lag = false;
        report.see(&puppet);
        let servo = report.servo(&Profiles::builtin(), "starter");
        assert!(servo["rms_error_deg"]["after"].is_null());
        assert!(servo["lag"]["pan"]["after_ms"].is_null());
    }
}
