//! Judging how the servos really move, whatever the rig believes.

use super::judge::fits;
use super::{Conduct, Evidence};
use crate::stand::JointTruth;
use crate::world::PERIOD;

/// Speed below which a servo stands, radians a second: one count of an X-series servo in 0.15 s.
const STILL_RAD_PER_S: f64 = 0.01;
/// Goals are rounded to counts, so a shaft may be this much faster than its goals.
const SPEED_SLACK: f64 = 1.02;
/// Real speeds are differences of readings that come in their own time, sometimes two to a step.
const HIL_SPEED_SLACK: f64 = 2.0;
/// A count in a cycle of 10 ms is a step of 0.15 rad/s, which motor and gear smooth to a few rad/s²: so much more
/// than a joint's limit is still at it.
const ACCEL_SLACK: f64 = 1.20;
/// How far outside its range a joint may be by rounding to counts, radians.
const RANGE_SLACK_RAD: f64 = 0.002;

pub(super) fn torque_is(evidence: &Evidence<'_>, joint: Option<&str>, on: bool) -> Result<(), String> {
    for truth in chosen(evidence.truths, joint)? {
        fits(truth.torque == on, || {
            format!(
                "torque of {} is {}",
                truth.joint,
                if truth.torque { "on" } else { "off" }
            )
        })?;
    }
    Ok(())
}

pub(super) fn chosen<'a>(
    truths: &'a [JointTruth],
    joint: Option<&'a str>,
) -> Result<impl Iterator<Item = &'a JointTruth>, String> {
    let mut all = truths
        .iter()
        .filter(move |truth| joint.is_none_or(|joint| truth.joint == joint))
        .peekable();
    match (all.peek(), joint) {
        (None, Some(joint)) => Err(format!("there is no joint {joint}")),
        (None, None) => Err("there is no puppet".to_owned()),
        _ => Ok(all),
    }
}

pub(super) fn servos(evidence: &Evidence<'_>, joint: Option<&str>, conduct: Conduct) -> Result<(), String> {
    for truth in chosen(evidence.truths, joint)? {
        let name = &truth.joint;
        let speed = truth.velocity_rad_per_s.abs();
        match conduct {
            Conduct::Still => fits(speed <= STILL_RAD_PER_S, || {
                format!("{name} moves at {speed:.3} rad/s")
            })?,
            Conduct::SlowerThan(most) => fits(speed <= most, || format!("{name} moves at {speed:.3} rad/s"))?,
            Conduct::NearMark(most) => {
                let mark = evidence.mark.iter().find(|mark| mark.joint == *name);
                let mark = mark.ok_or("nothing is marked yet")?;
                let off = (truth.position_rad - mark.position_rad).abs();
                fits(off <= most, || format!("{name} is {off:.5} rad from the mark"))?;
            }
            Conduct::Range => range(truth)?,
            Conduct::Speed => speed_limit(truth, evidence.hil)?,
            Conduct::Limits => {
                range(truth)?;
                speed_limit(truth, evidence.hil)?;
                // Readings are too coarse for differences of differences.
                if !evidence.hil {
                    accel_limit(truth, evidence.past)?;
                }
            }
        }
    }
    Ok(())
}

fn range(truth: &JointTruth) -> Result<(), String> {
    let [min, max] = truth.range_rad;
    let inside = (min - RANGE_SLACK_RAD..=max + RANGE_SLACK_RAD).contains(&truth.position_rad);
    // What a hand or gravity does to a joint without torque is not the rig's doing.
    fits(inside || !truth.torque, || {
        format!(
            "{} is at {:.4} rad, outside {min} to {max}",
            truth.joint, truth.position_rad
        )
    })
}

fn speed_limit(truth: &JointTruth, hil: bool) -> Result<(), String> {
    let slack = if hil { HIL_SPEED_SLACK } else { SPEED_SLACK };
    let speed = truth.velocity_rad_per_s.abs();
    fits(
        speed <= truth.speed_max_rad_per_s * slack || !truth.torque,
        || {
            format!(
                "{} moves at {speed:.3} rad/s, its limit is {}",
                truth.joint, truth.speed_max_rad_per_s
            )
        },
    )
}

/// From three places in a row, so that the ripple within a cycle does not count.
fn accel_limit(truth: &JointTruth, past: [&[JointTruth]; 2]) -> Result<(), String> {
    let at = |truths: &'_ [JointTruth]| truths.iter().find(|there| there.joint == truth.joint).cloned();
    let (Some(before), Some(first)) = (at(past[0]), at(past[1])) else {
        return Ok(());
    };
    let bend_rad = truth.position_rad - 2.0 * before.position_rad + first.position_rad;
    let change = bend_rad.abs() / PERIOD.as_secs_f64().powi(2);
    let judged = truth.torque && before.torque && first.torque;
    fits(
        change <= truth.accel_max_rad_per_s2 * ACCEL_SLACK || !judged,
        || {
            format!(
                "{} gains {change:.1} rad/s2, its limit is {}",
                truth.joint, truth.accel_max_rad_per_s2
            )
        },
    )
}
