//! What input devices cost: bytes to events, bytes to tokens, a flood, and how long a dial takes to reach a servo.

mod decoding;
mod flood;
mod frames;
mod latency;
mod recorded;
mod tokens;

use super::{Row, Subject, Tell, repeated};
use frames::LAYOUTS;

/// Name of the measure.
pub const NAME: &str = "input";

const ROUNDS: usize = 11;
/// Ticks from byte to packet: what is heard in a tick goes out in it.
const TICKS_MAX: f64 = 1.0;

/// Takes the measure.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    decode(tell)?;
    tokens(tell)?;
    flooded(tell)?;
    let ticks = f64::from(latency::ticks()?);
    tell(&row(
        "dial's byte to servo's packet",
        ticks,
        ticks,
        "ticks",
        Some(TICKS_MAX),
    ));
    Ok(())
}

fn decode(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let mut all = decoding::all()?;
    let allocations: Vec<_> = all
        .iter_mut()
        .map(|one| (one.name.clone(), one.allocations()))
        .collect();
    let mut subjects: Vec<Subject<'_>> = all
        .iter_mut()
        .map(|one| Subject {
            row: format!("{}: bytes to event", one.name),
            name: "dialrig",
            repeat: Box::new(|| Ok(one.nanos())),
        })
        .collect();
    for (taken, subject) in repeated(&mut subjects, ROUNDS)?.iter().zip(&subjects) {
        tell(&row(&subject.row, taken.median, taken.least, "ns", None));
    }
    for (name, count) in allocations {
        tell(&row(
            &format!("{name}: allocations"),
            count,
            count,
            "an event",
            Some(0.0),
        ));
    }
    Ok(())
}

fn tokens(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let mut rigs = LAYOUTS
        .iter()
        .map(|layout| Ok((layout.name, tokens::Heard::new(layout)?)))
        .collect::<anyhow::Result<Vec<_>>>()?;
    let allocations: Vec<_> = rigs
        .iter_mut()
        .map(|(name, rig)| (*name, rig.allocations()))
        .collect();
    for (name, count) in allocations {
        tell(&row(
            &format!("{name}: allocations of a step for its report"),
            count,
            count,
            "a report",
            Some(0.0),
        ));
    }
    let mut subjects: Vec<Subject<'_>> = rigs
        .iter_mut()
        .map(|(name, rig)| Subject {
            row: format!("{name}: bytes to network token, a step"),
            name: "dialrig",
            repeat: Box::new(|| Ok(rig.nanos())),
        })
        .collect();
    for (taken, subject) in repeated(&mut subjects, ROUNDS)?.iter().zip(&subjects) {
        tell(&row(&subject.row, taken.median, taken.least, "ns", None));
    }
    Ok(())
}

fn flooded(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let Some(layout) = LAYOUTS.first() else {
        return Ok(());
    };
    let flooded = flood::flood(layout)?;
    let lost = flooded.sent.saturating_sub(flooded.heard) as f64;
    tell(&row(
        "8 kHz for 10 s: reports lost",
        lost,
        lost,
        "reports",
        Some(0.0),
    ));
    let grown = flooded.grown_bytes as f64;
    tell(&row("8 kHz for 10 s: memory grown", grown, grown, "bytes", None));
    Ok(())
}

fn row(row: &str, value: f64, best: f64, unit: &'static str, limit: Option<f64>) -> Row {
    Row {
        measure: NAME,
        row: row.to_owned(),
        subject: "dialrig",
        value,
        best,
        unit,
        limit,
        ratio: limit.filter(|&limit| limit > 0.0).map(|limit| value / limit),
    }
}
