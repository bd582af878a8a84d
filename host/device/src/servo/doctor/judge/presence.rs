//! Who is there and who is not, and what may have become of those who are not.

use super::Case;
use crate::servo::doctor::facts::{Joint, Stray};
use crate::servo::doctor::kind::Kind;
use device_profiles::Role;

pub(super) fn judge(case: &mut Case<'_>) {
    let mut missing: Vec<&Joint> = case
        .expected
        .joints
        .iter()
        .filter(|joint| case.answered(joint).is_none())
        .collect();
    let mut strays = case.seen.strays.clone();
    duplicates(case, &mut missing);
    let whole_line_elsewhere = elsewhere(case, &mut missing, &mut strays);
    fresh(case, &mut missing, &mut strays);
    if !whole_line_elsewhere {
        absent(case, &missing);
    }
    unexpected(case);
    for stray in strays {
        let finding = case.of_servo(
            Kind::OtherBaud,
            stray.id,
            format!(
                "a servo answers at {} baud, the line runs at {}",
                stray.baud, case.seen.baud
            ),
        );
        case.note(finding);
    }
}

/// Ids whose answers are garbled every time, on a line where others are heard well.
fn duplicates(case: &mut Case<'_>, missing: &mut Vec<&Joint>) {
    for &id in &case.seen.garbled_ids {
        let words = format!("answers to id {id} are damaged every time: two servos have this id");
        let finding = case.of_servo(Kind::DuplicateId, id, words).mended_by(format!(
            "unplug one of the two, then give it another id: `{} {id} NEW`",
            case.command("set-id")
        ));
        case.note(finding);
        missing.retain(|joint| joint.id != id);
    }
}

/// Servos of the puppet that answer at another speed. Gives whether that is all there is to say of the line.
fn elsewhere(case: &mut Case<'_>, missing: &mut Vec<&Joint>, strays: &mut Vec<Stray>) -> bool {
    let first = strays.first().map(|stray| stray.baud);
    let all_alike = strays.iter().all(|stray| Some(stray.baud) == first);
    if let (true, Some(baud), true) = (case.seen.patients.is_empty(), first, all_alike)
        && !is_one_fresh(case, strays)
    {
        let words = format!(
            "nobody answers at {} baud, but {} servos do at {baud}",
            case.seen.baud,
            strays.len()
        );
        let finding = case.of_bus(Kind::OtherBaud, words).mended_by(format!(
            "set `baud = {baud}` for the bus in the puppet's profile and give `--baud {baud}`, or change the servos' own speed"
        ));
        case.note(finding);
        strays.clear();
        return true;
    }
    strays.retain(|stray| {
        let of = missing
            .iter()
            .position(|joint| joint.id == stray.id && joint.model.model_number == stray.model_number);
        let Some(place) = of.filter(|_| !is_fresh(case, *stray)) else {
            return true;
        };
        let joint = missing.remove(place);
        let words = format!(
            "{} answers at {} baud, the bus runs at {}",
            joint.name, stray.baud, case.seen.baud
        );
        let remedy = match joint.model.baud_code(case.seen.baud) {
            Some(_) => format!(
                "`dialrig servo set-baud --port {} --baud {} {} {}`",
                case.seen.port, stray.baud, stray.id, case.seen.baud
            ),
            None => format!(
                "a {} cannot speak at {} baud: choose a speed for the bus that all its servos have",
                joint.model.name, case.seen.baud
            ),
        };
        let finding = case.of_servo(Kind::OtherBaud, stray.id, words).mended_by(remedy);
        case.note(finding);
        false
    });
    false
}

/// Whether a servo has the factory's id and speed while its line runs at another.
fn is_fresh(case: &Case<'_>, stray: Stray) -> bool {
    let Some(model) = case.expected.model(stray.model_number) else {
        return false;
    };
    let factory = |role| model.role(role).and_then(|row| row.init);
    let id = factory(Role::Id).unwrap_or(1);
    let baud = factory(Role::BaudRate)
        .and_then(|code| u8::try_from(code).ok())
        .and_then(|code| model.baud_of_code(code));
    i64::from(stray.id) == id && Some(stray.baud) == baud && stray.baud != case.seen.baud
}

/// Exactly one servo, fresh, where a puppet of several joints is expected.
fn is_one_fresh(case: &Case<'_>, strays: &[Stray]) -> bool {
    matches!(strays, [only] if is_fresh(case, *only)) && case.expected.joints.len() > 1
}

/// One servo as from its box, where one joint of its model is missing. Without a puppet: on a line of others.
fn fresh(case: &mut Case<'_>, missing: &mut Vec<&Joint>, strays: &mut Vec<Stray>) {
    let [stray] = strays[..] else { return };
    if !is_fresh(case, stray) {
        return;
    }
    let fitting: Vec<usize> = (0..missing.len())
        .filter(|&place| missing[place].model.model_number == stray.model_number)
        .collect();
    let [place] = fitting[..] else { return };
    let joint = missing.remove(place);
    let words = format!(
        "{} (id {}) is missing, and a {} as from the factory (id {}, {} baud) is on the line",
        joint.name, joint.id, joint.model.name, stray.id, stray.baud
    );
    let finding = case
        .of_servo(Kind::FactoryFresh, joint.id, words)
        .mended_by(format!("`{} --adopt {}`", case.command("doctor"), joint.name));
    case.note(finding);
    strays.clear();
}

/// Joints nobody answers for: all, those behind one place of the chain, or some.
fn absent(case: &mut Case<'_>, missing: &[&Joint]) {
    if case.expected.joints.is_empty() {
        let nobody =
            case.seen.patients.is_empty() && case.seen.strays.is_empty() && case.seen.garbled_ids.is_empty();
        if nobody {
            let finding = case.of_bus(Kind::SilentLine, "no servo answers, at any line speed");
            case.note(finding);
        }
        return;
    }
    let all = &case.expected.joints;
    if missing.len() == all.len() {
        let words = format!("none of the {} servos answers, at any line speed", all.len());
        let finding = case.of_bus(Kind::SilentLine, words);
        case.note(finding);
        return;
    }
    let behind = all.len() - missing.len();
    let is_tail = missing
        .iter()
        .zip(all.iter().skip(behind))
        .all(|(gone, last)| gone.id == last.id);
    if let (true, 2.., Some(last), Some(first)) = (
        is_tail,
        missing.len(),
        all.get(behind.wrapping_sub(1)),
        missing.first(),
    ) {
        let names: Vec<&str> = missing.iter().map(|joint| joint.name.as_str()).collect();
        let words = format!(
            "the chain answers up to {} (id {}), its servo number {behind}; nothing behind it: {}",
            last.name,
            last.id,
            names.join(", ")
        );
        let finding = case
            .of_servo(Kind::Cable, first.id, words)
            .costing(format!("{} joints are limp and unseen; arming is refused", missing.len()))
            .mended_by(format!(
                "press the plugs of the cable between {} (id {}) and {} (id {}), and change it if that does not help",
                last.name, last.id, first.name, first.id
            ));
        case.note(finding);
        return;
    }
    for joint in missing {
        let finding = case.of_servo(
            Kind::MissingServo,
            joint.id,
            format!(
                "no {} with id {} answers, at any line speed",
                joint.model.name, joint.id
            ),
        );
        let finding = finding.mended_by(format!(
            "check its plug and power; if it has another id, `{}` shows it",
            case.command("scan")
        ));
        case.note(finding);
    }
}

/// Servos that are not as the profile says.
fn unexpected(case: &mut Case<'_>) {
    for patient in &case.seen.patients {
        if patient.profile.is_none() {
            let words = format!("model number {} has no profile", patient.model_number);
            let finding = case.of_servo(Kind::UnknownModel, patient.id, words);
            case.note(finding);
        }
        match case.expected.joint(patient.id) {
            Some(joint) if joint.model.model_number != patient.model_number => {
                let words = format!(
                    "the profile has a {}, a {} answers",
                    joint.model.name,
                    patient.model_name()
                );
                let finding = case.of_servo(Kind::WrongModel, patient.id, words);
                case.note(finding);
            }
            None if !case.expected.joints.is_empty() => {
                let words = format!(
                    "a {} with id {} answers, which the puppet does not have",
                    patient.model_name(),
                    patient.id
                );
                let finding = case.of_servo(Kind::UnexpectedServo, patient.id, words);
                case.note(finding);
            }
            _ => {}
        }
    }
}
