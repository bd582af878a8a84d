//! Supply, heat, and errors that servos keep.

use super::Case;
use crate::servo::doctor::facts::Patient;
use crate::servo::doctor::kind::Kind;
use device_profiles::{Role, ServoProfile, ServoProtocol};
use std::collections::BTreeSet;

/// This near above its Min Voltage Limit a servo counts as starved.
const LOW_SHARE: f64 = 1.05;
/// Shares of the rated voltage below which a supply is weak, and above which it is another model's.
const RATED_LOW: f64 = 0.7;
const RATED_HIGH: f64 = 1.3;
/// A supply that varies by more than this share breaks down under load.
const SAG_SHARE: f64 = 0.08;
/// This close to its Temperature Limit a servo is hot, degrees.
const HOT_MARGIN_C: f64 = 10.0;
/// The error bit of input voltage, in all families.
const VOLTAGE_BIT: i64 = 1;

/// Names of error bits: DYNAMIXEL X ("Hardware Error Status"), and Feetech ("Status"; the vendor's protocol notes).
const X_BITS: [(u8, &str); 5] = [
    (0, "input voltage"),
    (2, "overheating"),
    (3, "encoder"),
    (4, "electrical shock"),
    (5, "overload"),
];
const FEETECH_BITS: [(u8, &str); 5] = [
    (0, "voltage"),
    (1, "encoder"),
    (2, "temperature"),
    (3, "current"),
    (5, "overload"),
];

pub(super) fn judge(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    supply(case, patient, model);
    heat(case, patient);
    errors(case, patient, model);
}

fn supply(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    let Some(volts) = patient.voltage() else { return };
    let rated = model.motor.as_ref().map(|motor| motor.rated_voltage_v);
    let least = patient.get_si(Role::MinVoltage);
    let most = patient.get_si(Role::MaxVoltage);
    let for_words = rated.map_or_else(String::new, |rated| format!(" (made for {rated} V)"));
    let too_high = most
        .into_iter()
        .chain(rated.map(|rated| rated * RATED_HIGH))
        .fold(f64::INFINITY, f64::min);
    let too_low = least
        .map(|least| least * LOW_SHARE)
        .into_iter()
        .chain(rated.map(|rated| rated * RATED_LOW))
        .fold(0.0, f64::max);
    if volts > too_high {
        let what = format!("{volts:.1} V at a {}{for_words}", model.name);
        let finding = case
            .of_servo(Kind::WrongSupply, patient.id, what)
            .costing(format!("above {too_high:.1} V the servo can burn"));
        case.note(finding);
    } else if volts < too_low {
        let what = format!("{volts:.1} V at a {}{for_words}", model.name);
        let weaker = rated.map_or_else(String::new, |rated| {
            format!(
                "about {:.0} % of its speed and force; ",
                100.0 * (volts / rated).min(1.0)
            )
        });
        let finding = case
            .of_servo(Kind::LowVoltage, patient.id, what)
            .costing(format!("{weaker}it restarts when the load comes"));
        case.note(finding);
    }
    let latched = patient
        .get(Role::HardwareError)
        .is_some_and(|bits| bits & VOLTAGE_BIT != 0);
    if latched && (too_low..=too_high).contains(&volts) {
        let what = format!("its voltage was out of bounds since it was switched on; now it has {volts:.1} V");
        let finding = case.of_servo(Kind::VoltageSag, patient.id, what);
        case.note(finding);
    }
}

/// Voltages of all servos of one model on the line: they differ in time, or along the chain.
pub(super) fn judge_supply(case: &mut Case<'_>) {
    let seen = case.seen;
    let models: BTreeSet<u16> = seen.patients.iter().map(|patient| patient.model_number).collect();
    for model in models {
        let readings = || {
            let alike = seen
                .patients
                .iter()
                .filter(move |patient| patient.model_number == model);
            alike.flat_map(|patient| patient.volts.iter().map(|&volts| (patient.id, volts)))
        };
        let least = readings().min_by(|a, b| a.1.total_cmp(&b.1));
        let most = readings().max_by(|a, b| a.1.total_cmp(&b.1));
        let (Some((weakest, low)), Some((strongest, high))) = (least, most) else {
            continue;
        };
        if high - low <= SAG_SHARE * high {
            continue;
        }
        let what = format!(
            "{low:.1} V at id {weakest} and {high:.1} V at id {strongest} were read on this line while nothing moved"
        );
        let finding = case.of_servo(Kind::VoltageSag, weakest, what);
        case.note(finding);
    }
}

fn heat(case: &mut Case<'_>, patient: &Patient) {
    let limit_c = patient.get_si(Role::TemperatureLimit);
    let (Some(celsius), Some(limit_c)) = (patient.get_si(Role::PresentTemperature), limit_c) else {
        return;
    };
    if celsius > limit_c - HOT_MARGIN_C {
        let what = format!("{celsius:.0} °C; it switches itself off above {limit_c:.0} °C");
        let finding = case.of_servo(Kind::Hot, patient.id, what);
        case.note(finding);
    }
}

fn errors(case: &mut Case<'_>, patient: &Patient, model: &ServoProfile) {
    let Some(bits) = patient.get(Role::HardwareError).filter(|bits| *bits != 0) else {
        return;
    };
    let names = match model.protocol {
        ServoProtocol::Dynamixel1 | ServoProtocol::Dynamixel2 => &X_BITS,
        ServoProtocol::Sts | ServoProtocol::Scs => &FEETECH_BITS,
    };
    let told: Vec<&str> = names
        .iter()
        .filter(|(bit, _)| bits >> bit & 1 == 1)
        .map(|(_, name)| *name)
        .collect();
    let what = if told.is_empty() {
        format!("error bits {bits:#04x}")
    } else {
        format!("error: {}", told.join(", "))
    };
    let finding = case
        .of_servo(Kind::HardwareError, patient.id, what)
        .mended_by(format!(
            "find the cause, then `{} {}`",
            case.command("reboot"),
            patient.id
        ));
    case.note(finding);
}
