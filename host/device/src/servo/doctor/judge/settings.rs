//! What is set in a servo's own memory.

use super::Case;
use crate::servo::doctor::cost::{Cycle, hz, ms};
use crate::servo::doctor::facts::Patient;
use crate::servo::doctor::finding::Fix;
use crate::servo::doctor::kind::Kind;
use device_profiles::{Role, ServoProfile, ServoProtocol};

/// Modes of DYNAMIXEL 2.0 beside position in which goals are positions: extended, and with a limited current.
const ALSO_POSITION: [i64; 2] = [4, 5];
/// Drive Mode's bits, with what they do (e-manual).
const DRIVE_BITS: [(i64, &str); 3] = [
    (1, "turns the other way"),
    (1 << 2, "takes speeds for durations"),
    (1 << 3, "switches torque on by itself when a goal comes"),
];
/// Phase's bit that counts several turns (LeRobot clears it).
const PHASE_TURNS: i64 = 1 << 4;

pub(super) fn judge(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    return_delay(case, patient);
    status_level(case, patient, model);
    firmware(case, patient, model);
    mode(case, patient, model);
    drive(case, patient, model);
    lock(case, patient, model);
}

fn return_delay(case: &mut Case<'_>, patient: &Patient) {
    let Some(delay_secs) = patient.get_si(Role::ReturnDelay).filter(|secs| *secs > 0.0) else {
        return;
    };
    let now = Cycle::now(case.seen);
    let without = |id, secs| if id == patient.id { 0.0 } else { secs };
    let alone = Cycle::at(case.seen, case.seen.baud, &without);
    // In a fast read only the longest delay counts: then all must go together.
    let all = Cycle::at(case.seen, case.seen.baud, &|_, _| 0.0);
    let (then, with) = if alone.secs < now.secs {
        (alone, "")
    } else {
        (all, "together with the others' delays ")
    };
    let costs = format!(
        "{with}{} of a cycle of {}: {} instead of {}",
        ms(now.secs - then.secs),
        ms(now.secs),
        hz(now),
        hz(then)
    );
    let what = format!("waits {} before it answers", ms(delay_secs));
    let finding = case
        .of_servo(Kind::ReturnDelay, patient.id, what)
        .costing(costs)
        .mended_by(format!("`{} --fix`", case.command("doctor")))
        .with_fix(Fix::Register {
            id: patient.id,
            role: Role::ReturnDelay,
            value: 0,
        });
    case.note(finding);
}

fn status_level(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    let level = patient.get(Role::StatusReturnLevel);
    let most = model.role(Role::StatusReturnLevel).and_then(|row| row.max);
    let (Some(level), Some(most)) = (level, most) else {
        return;
    };
    if level < most {
        let words = format!("answers at level {level} only, where {most} answers everything");
        let finding = case
            .of_servo(Kind::StatusLevel, patient.id, words)
            .mended_by(format!(
                "`{} {} status-return-level {most}`",
                case.command("write"),
                patient.id
            ));
        case.note(finding);
    }
}

fn firmware(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    let lacks = |from: Option<u8>| from.filter(|from| patient.firmware < *from);
    let fast = lacks(model.fast_sync_read_from_firmware);
    let watchdog = lacks(model.bus_watchdog_from_firmware);
    let mut what = Vec::new();
    let mut costs = Vec::new();
    if let Some(from) = fast {
        what.push(format!("no fast reads, which come with {from}"));
        costs.push("longer cycles for the whole bus".to_owned());
    }
    if let Some(from) = watchdog {
        what.push(format!("no bus watchdog, which comes with {from}"));
        costs.push("it goes on moving when the host is lost".to_owned());
    }
    if what.is_empty() {
        return;
    }
    let words = format!(
        "{} firmware {} has {}",
        model.name,
        patient.firmware,
        what.join(" and ")
    );
    let finding = case
        .of_servo(Kind::OldFirmware, patient.id, words)
        .costing(costs.join("; "));
    case.note(finding);
}

fn mode(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    let wheel = model.role(Role::OperatingMode).is_none()
        && patient.get(Role::MinPosition) == Some(0)
        && patient.get(Role::MaxPosition) == Some(0);
    let usual = model.role(Role::OperatingMode).and_then(|row| row.init);
    let words = match (patient.get(Role::OperatingMode), usual) {
        _ if wheel => "both position limits are 0: it turns endlessly".to_owned(),
        (Some(mode), Some(usual)) => {
            let also = model.protocol == ServoProtocol::Dynamixel2 && ALSO_POSITION.contains(&mode);
            if mode == usual || also {
                return;
            }
            format!("operating mode {mode}, where {usual} goes to positions")
        }
        _ => return,
    };
    let finding = case.of_servo(Kind::OperatingMode, patient.id, words);
    let finding = match usual {
        Some(usual) => finding.mended_by(format!(
            "`{} {} operating-mode {usual}`",
            case.command("write"),
            patient.id
        )),
        None => finding,
    };
    case.note(finding);
}

fn drive(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    let mut does = Vec::new();
    let mut role = Role::DriveMode;
    if let Some(bits) = patient.get(Role::DriveMode) {
        let usual = model.role(role).and_then(|row| row.init).unwrap_or(0);
        let differs = DRIVE_BITS.iter().filter(|(bit, _)| (bits ^ usual) & bit != 0);
        does.extend(differs.map(|(_, does)| *does));
    }
    if patient
        .get(Role::Phase)
        .is_some_and(|bits| bits & PHASE_TURNS != 0)
    {
        role = Role::Phase;
        does.push("counts several turns");
    }
    if does.is_empty() {
        return;
    }
    let finding = case
        .of_servo(
            Kind::DriveMode,
            patient.id,
            format!("by its {role} the servo {}", does.join(", and ")),
        )
        .mended_by(format!(
            "`{} {} {role} {}`",
            case.command("write"),
            patient.id,
            match role {
                Role::Phase => patient.get(role).unwrap_or(0) & !PHASE_TURNS,
                _ => model.role(role).and_then(|row| row.init).unwrap_or(0),
            }
        ));
    case.note(finding);
}

/// A lock that rests locked guards settings; one that rests open (AX) is shut until power-off.
fn lock(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    let rests = model.role(Role::Lock).and_then(|row| row.init);
    let (Some(lock), Some(rests)) = (patient.get(Role::Lock), rests) else {
        return;
    };
    if lock == rests {
        return;
    }
    let finding = if rests == 0 {
        case.of_servo(
            Kind::Lock,
            patient.id,
            "the EEPROM is locked: no setting can be changed",
        )
        .costing("calibration and settings are refused")
        .mended_by("switch its power off and on: nothing else opens this lock")
    } else {
        case.of_servo(
            Kind::Lock,
            patient.id,
            "the EEPROM was left open after a change of settings",
        )
        .costing("every stray write to a setting is kept, and wears the memory")
        .mended_by(format!("`{} --fix`", case.command("doctor")))
        .with_fix(Fix::Register {
            id: patient.id,
            role: Role::Lock,
            value: rests,
        })
    };
    case.note(finding);
}
