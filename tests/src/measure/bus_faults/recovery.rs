//! What one servo that stops answering costs the others, beside what it costs two peers.
//!
//! Six XL430 on one bus; the second falls silent in mid run, and firmware behind it waits for it. Ours is counted in
//! cycles of 20 ms, as a player ticks; a cycle is lost when one of the five others was not read in it. Peers give back
//! nothing, or less than the others, as long as they are asked for a servo that is not there: what is told is how long
//! one read of theirs takes then.

use super::super::bus::peers;
use super::super::{Row, Tell, median};
use super::chain::CHAINS;
use crate::simulated::Line;
use device::servo::{Armed, Bus, BusSettings, Commanded, Goal};
use device::{Clock, MonotonicClock, VirtualClock};
use firmware_sim::servo_bus::{Absent, BusOptions};
use firmware_sim::{Fault, ServoBus};
use std::sync::Arc;
use std::time::Duration;

/// A player's period.
const PERIOD: Duration = Duration::from_millis(20);
/// The servo that falls silent, by its place.
const SILENT: usize = 1;
/// Cycles looked at after it has.
const LOOKED_AT: u32 = 100;
/// Reads of a peer.
const READS: usize = 5;

/// Cycles in which another servo than the silent one was not read; `between`: the line is looked at between ticks, too.
pub(crate) fn lost_cycles(absent: Absent, between: bool) -> anyhow::Result<u32> {
    let clock = VirtualClock::new();
    clock.advance(Duration::from_secs(1));
    let options = BusOptions {
        absent,
        ..BusOptions::default()
    };
    let chain = &CHAINS[0];
    let far: Line<ServoBus> = Line::new(chain.bus(options)?, Arc::new(clock.clone()));
    let mut settings = BusSettings::new("tried", 1_000_000);
    if !between {
        // Who never looks between two ticks has health read instead of positions now and then, which is not what is asked.
        settings.health_interval = Duration::from_mins(1);
    }
    let mut bus = Bus::new(Box::new(far.clone()), chain.members()?, settings)?;
    let armed = bus.arm_blocking(&clock, &mut |_| {})?;
    anyhow::ensure!(armed == Armed::Yes, "{:?}", bus.refusals());
    let goals = vec![0.0; chain.models.len()];
    let mut lost = 0;
    for cycle in 0..LOOKED_AT + 50 {
        if cycle == 50 {
            let fault = Fault::parse("servo 2 silent")?;
            far.with(|bus, now_us| bus.inject(now_us, &fault));
        }
        let now = clock.now();
        bus.poll(now, &mut |_| {})?;
        let sent = bus.command(Goal::Positions(&goals), now, &mut |_| {})?;
        anyhow::ensure!(sent == Commanded::Sent, "{sent:?} in cycle {cycle}");
        let until = now.after(PERIOD);
        while between && clock.now() < until {
            bus.wait(&clock, until);
            bus.poll(clock.now(), &mut |_| {})?;
            bus.use_pause(clock.now(), until)?;
        }
        clock.sleep_until(until);
        bus.poll(until, &mut |_| {})?;
        let fresh = |member: usize| bus.reading(member).is_some_and(|reading| reading.at >= now);
        let others = (0..chain.models.len()).filter(|member| *member != SILENT);
        lost += u32::from(!others.into_iter().all(fresh));
    }
    Ok(lost)
}

/// Takes this part of the measure.
pub(super) fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    for (name, absent) in [
        ("the others wait for it", Absent::Silence),
        ("the others go on", Absent::GoOnAfter(1000)),
    ] {
        let lost = f64::from(lost_cycles(absent, true)?);
        tell(&Row {
            measure: super::NAME,
            row: format!("one absent of six, {name}: cycles lost"),
            subject: "dialrig",
            value: lost,
            best: lost,
            unit: "cycles",
            limit: Some(1.0),
            ratio: Some(lost),
        });
    }
    let clock = MonotonicClock::new();
    for (subject, mut read) in peers::with_an_absent_servo()? {
        let mut took_ms: Vec<f64> = Vec::with_capacity(READS);
        for _ in 0..READS {
            let began = clock.now();
            // It fails, which is the point.
            let _ = read.run();
            took_ms.push(clock.now().since(began).as_secs_f64() * 1e3);
        }
        let value = median(&mut took_ms);
        tell(&Row {
            measure: super::NAME,
            row: "one absent of six: every cycle from then on takes".to_owned(),
            subject,
            value,
            best: took_ms.first().copied().unwrap_or(value),
            unit: "ms",
            limit: None,
            ratio: None,
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_absent_servo_costs_the_others_one_cycle_at_most() {
        for absent in [Absent::Silence, Absent::GoOnAfter(1000)] {
            let lost = [true, false].map(|between| lost_cycles(absent, between).expect("it runs"));
            assert!(lost[0] == 0, "what is left of the period is used to ask again");
            assert!(lost[1] <= 1, "{absent:?}: {} cycles lost", lost[1]);
        }
    }
}
