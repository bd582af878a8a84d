//! Where a joint may go, and whether its servo can count and will follow there.
//!
//! Two families, two rules for where the count jumps. DYNAMIXEL: the encoder's own zero stays the jump, and the
//! homing offset moves counts and jump together. Feetech: the count is taken modulo a turn after the offset, so
//! that the offset moves the jump along the shaft. (e-manual, "Homing Offset"; LeRobot's calibration.)

use super::Case;
use crate::servo::doctor::facts::{Joint, Patient};
use crate::servo::doctor::kind::Kind;
use device_profiles::{Role, ServoProfile, ServoProtocol};

/// Counts by which a range may reach over: profiles are rounded.
const SLACK_COUNTS: f64 = 2.0;
/// Largest homing offset with an effect in DYNAMIXEL's position mode, counts (e-manual, "Homing Offset").
const OFFSET_MAX_COUNTS: i64 = 1024;
/// DYNAMIXEL's position mode within one turn.
const POSITION_MODE: i64 = 3;
/// How far outside its range a joint may stand before that is worth saying: three degrees.
const OUT_OF_RANGE_RAD: f64 = 0.052;

pub(super) fn judge(case: &mut Case<'_>, patient: &Patient, joint: &Joint) {
    let offset = offset(case, patient, joint);
    let reach = reach(&joint.model, patient, offset);
    wrap(case, joint, reach, offset);
    limits(case, patient, joint);
    place(case, patient, joint);
}

/// The homing offset in effect; says when there is one without.
fn offset(case: &mut Case<'_>, patient: &Patient, joint: &Joint) -> i64 {
    let offset = patient.get(Role::HomingOffset).unwrap_or(0);
    let one_turn = patient.get(Role::OperatingMode) == Some(POSITION_MODE);
    let ignored =
        joint.model.protocol == ServoProtocol::Dynamixel2 && one_turn && offset.abs() > OFFSET_MAX_COUNTS;
    if !ignored {
        return offset;
    }
    let off_deg = (offset as f64 * joint.model.rad_per_count()).abs().to_degrees();
    let finding = case
        .of_servo(
            Kind::HomingOffset,
            patient.id,
            format!(
                "homing offset {offset} is beyond the ±{OFFSET_MAX_COUNTS} counts that position mode applies, \
                 and is ignored"
            ),
        )
        .costing(format!("positions are {off_deg:.0}° from where the offset was meant to put them"))
        .mended_by(format!(
            "`{} {} homing-offset 0`, then calibrate the joint",
            case.command("write"),
            patient.id
        ));
    case.note(finding);
    0
}

/// First and last count that the servo can tell apart in one turn.
fn reach(model: &ServoProfile, patient: &Patient, offset: i64) -> [f64; 2] {
    let [first, last] = model.position_counts.map(|count| count as f64);
    let moves = model.protocol == ServoProtocol::Dynamixel2 && patient.get(Role::OperatingMode).is_some();
    let by = if moves { offset as f64 } else { 0.0 };
    [first + by, last + by]
}

fn wrap(case: &mut Case<'_>, joint: &Joint, reach: [f64; 2], offset: i64) {
    let [from, to] = joint.travel_counts();
    let over_below = (reach[0] - from).max(0.0);
    let over_above = (to - reach[1]).max(0.0);
    if over_below.max(over_above) <= SLACK_COUNTS {
        return;
    }
    let whole_turn = reach[1] - reach[0] + 1.0 >= joint.model.counts_per_turn - SLACK_COUNTS;
    let at = if over_below > over_above {
        reach[0]
    } else {
        reach[1]
    };
    let words = format!(
        "the joint's travel of {from:.0} to {to:.0} counts leaves the turn of {:.0} to {:.0} (homing offset {offset}): \
         the count jumps at {:.0}°",
        reach[0],
        reach[1],
        joint.rad_at(at).to_degrees()
    );
    if !whole_turn {
        let finding = case
            .of_servo(Kind::LimitsOutside, joint.id, words)
            .costing(format!(
                "{:.0}° of the travel cannot be reached",
                (over_below.max(over_above) * joint.model.rad_per_count()).to_degrees()
            ))
            .mended_by(
                "mount the horn anew, so that the travel lies inside the servo's range, and calibrate",
            );
        case.note(finding);
        return;
    }
    let middle = f64::midpoint(from, to);
    let centre = f64::midpoint(reach[0], reach[1]);
    let turn_deg = ((middle - centre) * joint.model.rad_per_count()).to_degrees();
    let remedy = match joint.model.protocol {
        ServoProtocol::Sts => format!(
            "`{}`: it moves the jump out of the travel by the homing offset",
            calibrate(case, joint)
        ),
        _ => format!(
            "mount the horn {:.0}° further {}, then `{}`",
            turn_deg.abs(),
            if turn_deg > 0.0 { "back" } else { "on" },
            calibrate(case, joint)
        ),
    };
    let finding = case
        .of_servo(Kind::Wrap, joint.id, words)
        .costing("at the jump the servo goes a whole turn the wrong way")
        .mended_by(remedy);
    case.note(finding);
}

fn calibrate(case: &Case<'_>, joint: &Joint) -> String {
    format!(
        "{} --puppet NAME --joint {}",
        case.command("calibrate"),
        joint.name
    )
}

/// The servo's own limits against the joint's range.
fn limits(case: &mut Case<'_>, patient: &Patient, joint: &Joint) {
    let (Some(min), Some(max)) = (patient.get(Role::MinPosition), patient.get(Role::MaxPosition)) else {
        return;
    };
    // Both 0: the wheel mode of AX, the multi-turn mode of Feetech. In extended mode limits do not count.
    let counts = patient
        .get(Role::OperatingMode)
        .is_none_or(|mode| joint.model.protocol != ServoProtocol::Dynamixel2 || mode != 4);
    if (min == 0 && max == 0) || !counts {
        return;
    }
    let [from, to] = joint.travel_counts();
    let (min, max) = (min as f64, max as f64);
    let words = format!(
        "the servo's limits are {min:.0} to {max:.0}, the joint's range is {from:.0} to {to:.0} counts"
    );
    if to <= min || from >= max {
        let finding = case
            .of_servo(Kind::LimitsOutside, joint.id, words)
            .mended_by(format!("`{}`", calibrate(case, joint)));
        case.note(finding);
        return;
    }
    let short = (min - from).max(to - max);
    if short > SLACK_COUNTS {
        let short_deg = (short * joint.model.rad_per_count()).to_degrees();
        let finding = case
            .of_servo(Kind::LimitsInside, joint.id, words)
            .costing(format!(
                "the joint stops {short_deg:.0}° short: goals behind that are refused"
            ))
            .mended_by(format!(
                "`{}`, which writes limits that fit",
                calibrate(case, joint)
            ));
        case.note(finding);
    }
}

/// Where the joint stands.
fn place(case: &mut Case<'_>, patient: &Patient, joint: &Joint) {
    let Some(counts) = patient.get(Role::PresentPosition) else {
        return;
    };
    let rad = joint.rad_at(counts as f64);
    let [min, max] = joint.range_rad;
    let out_rad = (min - rad).max(rad - max);
    if out_rad <= OUT_OF_RANGE_RAD {
        return;
    }
    let finding = case
        .of_servo(
            Kind::OutOfRange,
            joint.id,
            format!(
                "it stands at {:.0}°, its range is {:.0}° to {:.0}°",
                rad.to_degrees(),
                min.to_degrees(),
                max.to_degrees()
            ),
        )
        .mended_by(format!(
            "move it by hand into its range; if it is there already, `{}`",
            calibrate(case, joint)
        ));
    case.note(finding);
}
