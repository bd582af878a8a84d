//! The line as a whole: adapter, speed, noise, firmwares.

use super::Case;
use crate::servo::doctor::cost::{Cycle, hz, ms};
use crate::servo::doctor::finding::Fix;
use crate::servo::doctor::kind::Kind;
use crate::transport::adapter::LATENCY_WANTED_MS;
use std::collections::BTreeMap;

/// An answer held back longer than this is the adapter's doing: two frames of full-speed USB and some slack.
const HELD_BACK_MAX_SECS: f64 = 0.003;
/// A line at least this fast is fast enough: 20 servos then still make 200 cycles a second.
const FAST_BAUD: u32 = 1_000_000;
/// Answers lost by one servo alone that make it, and not the line, the suspect.
const LOST_BY_ONE_MIN: u32 = 3;

pub(super) fn judge(case: &mut Case<'_>) {
    latency(case);
    echo(case);
    noise(case);
    speed(case);
    mixed(case);
}

fn latency(case: &mut Case<'_>) {
    let seen = case.seen;
    let held_secs = seen.held_back_secs.unwrap_or(0.0);
    let timer_is_long = seen.timer_ms.is_some_and(|ms| ms > LATENCY_WANTED_MS);
    if !timer_is_long && held_secs <= HELD_BACK_MAX_SECS {
        return;
    }
    let read = seen
        .timer_ms
        .map(|ms| format!("the adapter's latency timer is at {ms} ms"));
    let measured = (held_secs > HELD_BACK_MAX_SECS)
        .then(|| format!("answers come {} later than wire and servo need", ms(held_secs)));
    let what: Vec<String> = [read, measured].into_iter().flatten().collect();
    let longest_secs = seen
        .timer_ms
        .map_or(held_secs, |ms| f64::from(ms) / 1e3)
        .max(held_secs);
    let now = Cycle::now(seen).plus(longest_secs);
    let then = Cycle::now(seen).plus(f64::from(LATENCY_WANTED_MS) / 1e3);
    let mut finding = case
        .of_bus(Kind::AdapterLatency, what.join("; "))
        .costing(format!(
            "up to {} in every cycle: at most {} where {} could be",
            ms(longest_secs),
            hz(now),
            hz(then)
        ));
    if timer_is_long {
        finding = finding
            .mended_by(format!("`{} --fix`", case.command("doctor")))
            .with_fix(Fix::LatencyTimer {
                ms: LATENCY_WANTED_MS,
            });
    } else {
        finding = finding.mended_by(
            "this adapter tells no timer that could be set: choose one with an FTDI chip, or raise answer_slack",
        );
    }
    case.note(finding);
}

fn echo(case: &mut Case<'_>) {
    if case.seen.echo {
        let finding = case.of_bus(Kind::Echo, "the adapter hands back what it sends");
        case.note(finding);
    }
}

fn noise(case: &mut Case<'_>) {
    let seen = case.seen;
    if seen.lost == 0 && seen.damaged == 0 {
        return;
    }
    let lossy: Vec<_> = seen.patients.iter().filter(|patient| patient.lost > 0).collect();
    let share = f64::from(seen.lost) / f64::from(seen.asked.max(1));
    let costs = format!(
        "one cycle in {:.0} misses an answer; a joint then goes on with an old measurement",
        1.0 / (share * seen.patients.len().max(1) as f64).clamp(1e-4, 1.0)
    );
    let finding = match lossy[..] {
        [only] if only.lost >= LOST_BY_ONE_MIN && seen.patients.len() > 1 => {
            let what = format!(
                "{} of {} answers of this servo alone were lost",
                only.lost, only.asked
            );
            case.of_servo(Kind::Noise, only.id, what)
                .mended_by("look at this servo's plugs and cable first: the others are heard well")
        }
        _ => {
            let what = format!(
                "{} of {} answers were lost, {} packets damaged",
                seen.lost, seen.asked, seen.damaged
            );
            case.of_bus(Kind::Noise, what)
        }
    };
    case.note(finding.costing(costs));
}

fn speed(case: &mut Case<'_>) {
    let seen = case.seen;
    if seen.baud >= FAST_BAUD || seen.patients.is_empty() {
        return;
    }
    let mut common: Option<Vec<u32>> = None;
    for patient in &seen.patients {
        let Some(model) = &patient.profile else { return };
        common = Some(match common {
            None => model.bauds.clone(),
            Some(bauds) => bauds
                .into_iter()
                .filter(|baud| model.bauds.contains(baud))
                .collect(),
        });
    }
    let bauds = common.unwrap_or_default();
    let best = bauds.iter().copied().filter(|&baud| baud > seen.baud);
    // More than enough helps nobody and is harder on long cables.
    let enough = best.clone().filter(|&baud| baud >= FAST_BAUD).min();
    let Some(baud) = enough.or_else(|| best.max()) else {
        return;
    };
    let now = Cycle::now(seen);
    let then = Cycle::at(seen, baud, &|_, delay_secs| delay_secs);
    let what = format!(
        "the line runs at {} baud; all its servos could do {baud}",
        seen.baud
    );
    let finding = case
        .of_bus(Kind::SlowBaud, what)
        .costing(format!(
            "a cycle takes {} instead of {}: at most {} where {} could be",
            ms(now.secs),
            ms(then.secs),
            hz(now),
            hz(then)
        ))
        .mended_by(format!(
            "set every servo (`{} ID {baud}`), then `baud = {baud}` in the puppet's profile",
            case.command("set-baud")
        ));
    case.note(finding);
}

/// One model with several firmwares.
fn mixed(case: &mut Case<'_>) {
    let mut firmwares: BTreeMap<String, BTreeMap<u8, Vec<u8>>> = BTreeMap::new();
    for patient in &case.seen.patients {
        let of_model = firmwares.entry(patient.model_name()).or_default();
        of_model.entry(patient.firmware).or_default().push(patient.id);
    }
    for (model, firmwares) in firmwares {
        if firmwares.len() < 2 {
            continue;
        }
        let told: Vec<String> = firmwares
            .iter()
            .map(|(firmware, ids)| {
                let ids: Vec<String> = ids.iter().map(ToString::to_string).collect();
                format!("{firmware} on {}", ids.join(", "))
            })
            .collect();
        let finding = case.of_bus(
            Kind::MixedFirmware,
            format!("{model} has firmware {}", told.join("; ")),
        );
        case.note(finding);
    }
}
