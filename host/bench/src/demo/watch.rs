//! Watching the puppet: goals against limits, first goals against the truth, readings against the simulator's
//! record of what was measured when.

use std::collections::{BTreeMap, VecDeque};

use firmware_sim::servo_bus::StatusSent;
use rig::{PuppetView, Snapshot};

use super::report::{Limits, ServoReport, ServoRow};
use crate::stand::{HandError, JointTruth, Stand};

/// How many writes and answers of a bus are kept: more than a cycle has.
const KEPT: usize = 256;
/// A reading may be dated by the host up to this much before its bytes could be written; microseconds. The host
/// counts nanoseconds, the record microseconds.
const ROUNDING_US: u64 = 1;

/// What went over one bus lately.
#[derive(Debug, Default)]
struct Wire {
    writes_us: VecDeque<u64>,
    answers: VecDeque<StatusSent>,
}

/// One joint so far.
#[derive(Clone, Debug, Default)]
struct Course {
    at_secs: Option<f64>,
    goal_rad: f64,
    speed_rad_per_s: Option<f64>,
    measured_us: u64,
}

/// Keeps watch over a puppet for as long as it is fed every step.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    pub(crate) rows: Vec<ServoRow>,
    pub(crate) stale_reads: u64,
    pub(crate) reads: u64,
    courses: Vec<Course>,
    wires: BTreeMap<String, Wire>,
    start_jump_rad: f64,
    squares: f64,
    speed_ratio: f64,
    accel_ratio: f64,
}

impl Watch {
    /// Looks at one step.
    pub(crate) fn step(&mut self, seen: &Snapshot, stand: &Stand) -> Result<(), HandError> {
        let Some(puppet) = &seen.puppet else { return Ok(()) };
        self.listen(stand)?;
        let truths = stand.joints();
        self.courses.resize(puppet.joints.len(), Course::default());
        let joints = puppet.joints.iter().zip(&truths).enumerate();
        for (place, (joint, truth)) in joints {
            self.judge_reading(place, truth, joint.age_secs, stand);
            match (puppet.torque, joint.goal_rad) {
                (true, Some(goal_rad)) => {
                    self.judge_goal(place, seen.at_secs, goal_rad, truth, puppet.goals_sent);
                }
                _ => {
                    self.courses[place] = Course {
                        measured_us: self.courses[place].measured_us,
                        ..Course::default()
                    }
                }
            }
        }
        self.note_rows(seen.at_secs, puppet);
        Ok(())
    }

    fn listen(&mut self, stand: &Stand) -> Result<(), HandError> {
        for bus in stand.buses() {
            let traffic = stand.take_traffic(bus)?;
            let wire = self.wires.entry(bus.to_owned()).or_default();
            wire.writes_us.extend(traffic.writes_us);
            wire.answers.extend(traffic.answers);
            wire.writes_us.drain(..wire.writes_us.len().saturating_sub(KEPT));
            wire.answers.drain(..wire.answers.len().saturating_sub(KEPT));
        }
        Ok(())
    }

    /// A reading the rig has just taken was asked for by the last write before it is said to be measured. It is
    /// stale if nothing that the servo measured since that write has reached the host by now.
    fn judge_reading(&mut self, place: usize, truth: &JointTruth, age_secs: f64, stand: &Stand) {
        if !age_secs.is_finite() {
            return;
        }
        let now = stand.clock().now();
        let age_ns = (age_secs * 1e9).round() as u64;
        let measured_us = now.as_nanos().saturating_sub(age_ns) / 1000;
        let before_us = std::mem::replace(&mut self.courses[place].measured_us, measured_us);
        let Some(wire) = self
            .wires
            .get(&truth.bus)
            .filter(|_| measured_us > before_us + ROUNDING_US)
        else {
            return;
        };
        // What is written in this very step was not yet asked when its readings were taken in.
        let until_us = (measured_us + ROUNDING_US).min(now.as_micros().saturating_sub(1));
        let asked = wire.writes_us.iter().rev().find(|&&at_us| at_us <= until_us);
        let asked_us = asked.copied().unwrap_or(0);
        let fresh = wire.answers.iter().any(|answer| {
            answer.id == truth.id
                && !answer.lost
                && answer.sampled_us >= asked_us
                && answer.last_us <= now.as_micros()
        });
        self.reads += 1;
        self.stale_reads += u64::from(!fresh);
    }

    fn judge_goal(&mut self, place: usize, at_secs: f64, goal_rad: f64, truth: &JointTruth, sent: bool) {
        let course = &mut self.courses[place];
        let Some(before_secs) = course.at_secs else {
            self.start_jump_rad = self.start_jump_rad.max((goal_rad - truth.position_rad).abs());
            *course = Course {
                at_secs: Some(at_secs),
                goal_rad,
                speed_rad_per_s: None,
                ..*course
            };
            return;
        };
        // Between cycles that did not go out there is no rate of change to speak of.
        if !sent || at_secs <= before_secs {
            return;
        }
        let dt_secs = at_secs - before_secs;
        let speed = (goal_rad - course.goal_rad) / dt_secs;
        self.speed_ratio = self.speed_ratio.max(speed.abs() / truth.speed_max_rad_per_s);
        let accel = (speed - course.speed_rad_per_s.unwrap_or(0.0)).abs() / dt_secs;
        self.accel_ratio = self.accel_ratio.max(accel / truth.accel_max_rad_per_s2);
        *course = Course {
            at_secs: Some(at_secs),
            goal_rad,
            speed_rad_per_s: Some(speed),
            ..*course
        };
    }

    fn note_rows(&mut self, t_secs: f64, puppet: &PuppetView) {
        if !(puppet.torque && puppet.goals_sent) {
            return;
        }
        for (joint, view) in puppet.joints.iter().enumerate() {
            if let (Some(goal_rad), Some(measured_rad)) = (view.goal_rad, view.measured_rad) {
                self.squares += (goal_rad - measured_rad).powi(2);
                self.rows.push(ServoRow {
                    t_secs,
                    joint,
                    goal_rad,
                    measured_rad,
                });
            }
        }
    }

    /// What was found.
    pub(crate) fn report(&self, joints: &[JointTruth]) -> ServoReport {
        let mean_square = self.squares / self.rows.len().max(1) as f64;
        let limits = joints.iter().map(|joint| {
            let limits = Limits {
                speed_rad_per_s: joint.speed_max_rad_per_s,
                accel_rad_per_s2: joint.accel_max_rad_per_s2,
            };
            (joint.joint.clone(), limits)
        });
        ServoReport {
            start_jump_deg: self.start_jump_rad.to_degrees(),
            rms_error_deg: mean_square.sqrt().to_degrees(),
            clip_rms_error_before_deg: None,
            clip_rms_error_after_deg: None,
            lag: BTreeMap::new(),
            max_speed_ratio: self.speed_ratio,
            max_accel_ratio: self.accel_ratio,
            rows: self.rows.len(),
            limits: limits.collect(),
        }
    }
}
