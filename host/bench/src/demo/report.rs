//! What the demo found out, as `report.json` has it (`docs/cli.md`).

use std::collections::BTreeMap;

use serde::Serialize;

/// The whole report.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DemoReport {
    /// Keys entered through dials, keys and puck.
    pub keys_entered: usize,
    /// Readings that the rig took although no answer measured after its question had come by then, counted
    /// from the simulator's own record of what was measured when.
    pub stale_reads: u64,
    /// Readings that were judged so.
    pub reads: u64,
    /// Digest of the journal; equal between runs.
    pub journal_hash: String,
    /// Whether the journal, played again without the devices, gave the same snapshots and the same bytes.
    pub journal_replay_identical: bool,
    /// Largest angle between a link as it was entered and as it was meant, degrees.
    pub pose_error_deg: f64,
    /// The same, on average.
    pub pose_error_mean_deg: f64,
    /// The puppet.
    pub servo: ServoReport,
    /// Virtual time the whole story took.
    pub virtual_secs: f64,
}

/// What the puppet did.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ServoReport {
    /// Largest difference between a joint's first goal with torque and where the joint really was, degrees.
    pub start_jump_deg: f64,
    /// Root of the mean square of goal minus measured over all rows, degrees.
    pub rms_error_deg: f64,
    /// Root of the mean square of measured minus what the clip has at the same moment, over the first performance,
    /// degrees; only where there are two, see `lag`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip_rms_error_before_deg: Option<f64>,
    /// The same over the second performance, with lag made up for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip_rms_error_after_deg: Option<f64>,
    /// How long after the clip each joint is where the clip is.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub lag: BTreeMap<String, LagReport>,
    /// Fastest change of a goal against its joint's limit; at most 1.
    pub max_speed_ratio: f64,
    /// Fastest change of a goal's speed against its joint's limit; at most 1.
    pub max_accel_ratio: f64,
    /// Rows written.
    pub rows: usize,
    /// What the profile allows each joint.
    pub limits: BTreeMap<String, Limits>,
}

/// Lag of a joint behind its clip, milliseconds; none where it did not move enough to tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LagReport {
    /// In the first performance.
    pub before_ms: Option<f64>,
    /// In the second, with goals taken ahead by the lag.
    pub after_ms: Option<f64>,
}

/// What the profile allows a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Limits {
    /// Radians per second.
    pub speed_rad_per_s: f64,
    /// Radians per second squared.
    pub accel_rad_per_s2: f64,
}

/// One joint in one control cycle with torque.
#[derive(Clone, Debug, PartialEq)]
pub struct ServoRow {
    /// Time of the story, seconds.
    pub t_secs: f64,
    /// Place of the joint in the puppet's order.
    pub joint: usize,
    /// What was asked of it.
    pub goal_rad: f64,
    /// Where it last said it was.
    pub measured_rad: f64,
}

/// The rows as `servo.csv`.
pub fn csv(rows: &[ServoRow], joints: &[String]) -> String {
    use std::fmt::Write;
    let mut text = String::from("t_secs,joint,goal_rad,measured_rad\n");
    for row in rows {
        let joint = joints.get(row.joint).map_or("", String::as_str);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:.3},{joint},{:.6},{:.6}",
            row.t_secs, row.goal_rad, row.measured_rad
        );
    }
    text
}
