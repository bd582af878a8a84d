//! How near to the wire's own time a full cycle of twenty servos comes: ours, and two peers, on the same
//! simulator.
//!
//! Every subject has a simulated bus of its own, all made alike: 20 XL430, 1 Mbaud, return delay 0, bytes
//! arriving when the wire has carried them. Two media: a pseudo-terminal with a thread behind it (as any program
//! would see an adapter without latency), and memory in the same thread (the host's own cost). Two blocks: Present
//! Position alone, 4 bytes, as peers are usually measured; and 16 bytes from Realtime Tick to Present Position,
//! which the player's bus reads, because the tick is what tells a late answer from a fresh one.
//! The bus has no way to read less, so its framing alone is measured beside it with 4 bytes.
//! Source of the limit: `docs/protocols/dynamixel2.md` and the servo reference, "Wire limit".

mod ours;
mod peers;

use super::{Row, Subject, Tell, median, repeated};
use crate::simulated::{Line, Served, bus_of};
use device::{Clock, MonotonicClock};
use firmware_sim::ServoBus;
use firmware_sim::servo_bus::BusOptions;
use std::num::NonZeroU64;
use std::sync::Arc;

/// Name of the measure.
pub const NAME: &str = "servo-cycle";

/// Servos on the bus.
pub(crate) const SERVOS: u8 = 20;
/// Bits a second.
pub(crate) const BAUD: u32 = 1_000_000;
/// Realtime Tick, where the player's block begins, and its length up to Present Position's end.
pub(crate) const TICK: u16 = 120;
const PLAYER_BLOCK: u16 = 16;
const POSITION_BLOCK: u16 = 4;
/// Cycles of one repetition; its value is their median.
const CYCLES: usize = 30;
const ROUNDS: usize = 9;
/// Cycles of a repetition that may fail before the measure is given up.
const FAILURES_MAX: usize = 10;
/// Sleeping is part of the simulated wire here, so it must not be late by the kernel's default of 50 us.
const TIMER_SLACK_NANOS: u64 = 1_000;

/// Milliseconds that a sync write of four bytes to every servo and a sync read of `block` bytes need.
pub fn limit_ms(servos: usize, block: usize, baud: u32) -> f64 {
    let write = 14 + servos * 5;
    let ask = 14 + servos;
    let answers = servos * (11 + block);
    (write + ask + answers) as f64 * 10.0 / f64::from(baud) * 1e3
}

/// A cycle that can be run again and again.
pub(crate) trait Cycle {
    /// Goals out, readings in; every answer looked at. An error is a cycle that failed and may be tried again.
    fn run(&mut self) -> anyhow::Result<()>;
}

type Boxed = Box<dyn Cycle>;

fn served() -> anyhow::Result<Served<ServoBus>> {
    Ok(Served::start(bus_of(SERVOS, BusOptions::default()))?)
}

fn line(clock: MonotonicClock) -> Line<ServoBus> {
    Line::new(bus_of(SERVOS, BusOptions::default()), Arc::new(clock))
}

/// Takes the measure.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    // Only exactness is lost where the kernel refuses.
    let _ = rustix::thread::set_current_timer_slack(NonZeroU64::new(TIMER_SLACK_NANOS));
    let clock = MonotonicClock::new();
    let (short, long) = (POSITION_BLOCK, PLAYER_BLOCK);
    let cycles: Vec<(&str, &'static str, u16, Boxed)> = vec![
        (
            "pty, 4 bytes, framing alone",
            "dialrig",
            short,
            ours::framing_pty(short)?,
        ),
        ("pty, 4 bytes", "dynamixel2", short, peers::dynamixel2(short)?),
        ("pty, 4 bytes", "rustypot", short, peers::rustypot_pty(short)?),
        (
            "pty, 16 bytes, the player's bus",
            "dialrig",
            long,
            ours::bus_pty()?,
        ),
        ("pty, 16 bytes", "dynamixel2", long, peers::dynamixel2(long)?),
        ("pty, 16 bytes", "rustypot", long, peers::rustypot_pty(long)?),
        (
            "memory, 4 bytes, framing alone",
            "dialrig",
            short,
            ours::framing_memory(clock, short),
        ),
        (
            "memory, 4 bytes",
            "rustypot",
            short,
            peers::rustypot_memory(clock, short),
        ),
        (
            "memory, 16 bytes, the player's bus",
            "dialrig",
            long,
            ours::bus_memory(clock)?,
        ),
        (
            "memory, 16 bytes",
            "rustypot",
            long,
            peers::rustypot_memory(clock, long),
        ),
    ];
    let blocks: Vec<u16> = cycles.iter().map(|(_, _, block, _)| *block).collect();
    let mut subjects: Vec<Subject<'_>> = cycles
        .into_iter()
        .map(|(row, name, _, mut cycle)| Subject {
            row: row.to_owned(),
            name,
            repeat: Box::new(move || repetition(clock, cycle.as_mut())),
        })
        .collect();
    let taken = repeated(&mut subjects, ROUNDS)?;
    for ((subject, taken), block) in subjects.iter().zip(taken).zip(blocks) {
        let limit = limit_ms(SERVOS.into(), block.into(), BAUD);
        tell(&Row {
            measure: NAME,
            row: subject.row.clone(),
            subject: subject.name,
            value: taken.median,
            best: taken.least,
            unit: "ms",
            limit: Some(limit),
            ratio: Some(limit / taken.median),
        });
    }
    Ok(())
}

/// The median time of a cycle, in milliseconds.
fn repetition(clock: MonotonicClock, cycle: &mut dyn Cycle) -> anyhow::Result<f64> {
    let mut took_ms = Vec::with_capacity(CYCLES);
    let mut failures = 0;
    while took_ms.len() < CYCLES {
        let began = clock.now();
        match cycle.run() {
            Ok(()) => took_ms.push(clock.now().since(began).as_secs_f64() * 1e3),
            Err(error) if failures < FAILURES_MAX => {
                // A machine that stops us for longer than a peer's time limit fails its cycle.
                eprintln!("a cycle failed and is not counted: {error:#}");
                failures += 1;
            }
            Err(error) => return Err(error),
        }
    }
    Ok(median(&mut took_ms))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_the_reference_table_s() {
        // Source: the servo reference, sync write 4 + sync read 4.
        assert!((limit_ms(20, 4, 1_000_000) - 4.48).abs() < 1e-12);
        assert_eq!((1e3 / limit_ms(6, 4, 57_600)).round(), 37.0);
        assert_eq!((1e3 / limit_ms(12, 4, 1_000_000)).round(), 357.0);
        assert_eq!((1e3 / limit_ms(20, 4, 4_000_000)).round(), 893.0);
    }

    #[test]
    fn every_subject_runs_a_cycle() {
        let clock = MonotonicClock::new();
        let mut cycles: [Boxed; 6] = [
            ours::framing_pty(4).expect("a terminal"),
            ours::bus_pty().expect("a terminal"),
            ours::framing_memory(clock, 4),
            ours::bus_memory(clock).expect("it arms"),
            peers::rustypot_pty(16).expect("a terminal"),
            peers::rustypot_memory(clock, 4),
        ];
        for cycle in &mut cycles {
            // A bus arms itself first; and a busy machine may stop us for longer than a peer waits.
            let went_well = (0..8).any(|_| cycle.run().is_ok());
            assert!(went_well, "the cycle never comes about");
        }
    }
}
