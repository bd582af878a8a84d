//! How near to the wire's own time a bus comes: 6, 12 and 20 servos at 1, 2 and 4 Mbaud, by sync and by fast sync read,
//! STS at 1 Mbaud, beside two peers; and four buses at once.
//!
//! Everybody does the same: goal positions to all, present positions of all, each value looked at. Each has a
//! simulated bus of its own; a thread that is awake when answers are due hands them over so that they are there when
//! the wire has carried them (module `far`): what is above the limit is the program's own.
//! Buses are reached by TCP inside the machine, which takes the same few microseconds each time, by us and by the peer
//! that takes any port. The other peer opens terminals alone, whose kernel workers come 10 us sooner or later by chance;
//! beside it we are measured on a terminal too.
//! Ours is the player's bus as it is, limits, watchdog, health and all, told to read positions alone, by a thread that
//! may stay awake around the time when answers are due.
//! Source of the limit: the servo reference, 7.1.

mod channel;
mod far;
mod ours;
mod parallel;
pub(crate) mod peers;

use far::Link;

use super::{Row, Subject, Tell, median, repeated};
use device::{Clock, MonotonicClock};
use std::num::NonZeroU64;

/// Name of the measure.
pub const NAME: &str = "bus";

/// Cycles of one repetition; its value is their median.
const CYCLES: usize = 30;
const ROUNDS: usize = 9;
/// Cycles of a repetition that may fail before the measure is given up.
const FAILURES_MAX: usize = 300;
/// Sleeping is part of the simulated wire here, so it must not be late by the kernel's default of 50 us.
pub(super) const TIMER_SLACK_NANOS: u64 = 1_000;

/// How positions are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    /// XL430 by sync read.
    Sync,
    /// XL430 by fast sync read.
    Fast,
    /// STS3215 by sync read.
    Sts,
}

/// A bus of so many servos at some speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Setup {
    pub(crate) servos: u8,
    pub(crate) baud: u32,
    pub(crate) way: Way,
}

impl Setup {
    /// What bytes alone need, in milliseconds.
    pub(crate) fn limit_ms(self) -> f64 {
        let n = usize::from(self.servos);
        let bytes = match self.way {
            Way::Sync => 14 + n * 5 + 14 + n + n * (11 + 4),
            Way::Fast => 14 + n * 5 + 14 + n + 8 + n * (4 + 4),
            Way::Sts => 8 + n * 3 + 8 + n + n * (6 + 2),
        };
        bytes as f64 * 10.0 / f64::from(self.baud) * 1e3
    }

    fn name(self) -> String {
        let way = match self.way {
            Way::Sync => "sync",
            Way::Fast => "fast",
            Way::Sts => "sts",
        };
        format!(
            "{way}, {} servos, {} Mbaud",
            self.servos,
            f64::from(self.baud) / 1e6
        )
    }
}

/// Who is measured on a bus.
fn cycles(setup: Setup) -> anyhow::Result<Vec<(&'static str, Boxed)>> {
    let mut cycles = vec![
        ("dialrig", ours::cycle(setup, Link::Tcp)?),
        ("rustypot", peers::rustypot(setup, Link::Tcp)?),
    ];
    if setup.way == Way::Sync {
        cycles.push(("dialrig on a terminal", ours::cycle(setup, Link::Terminal)?));
        cycles.push(("dynamixel2 on a terminal", peers::dynamixel2(setup)?));
    }
    Ok(cycles)
}

/// A cycle that can be run again and again.
pub(crate) trait Cycle {
    /// Goals out, readings in; every answer looked at. An error is a cycle that failed and may be tried again.
    fn run(&mut self) -> anyhow::Result<()>;
}

pub(crate) type Boxed = Box<dyn Cycle>;

fn setups() -> Vec<Setup> {
    let mut setups = Vec::new();
    for (way, bauds) in [
        (Way::Sync, &[1_000_000, 2_000_000, 4_000_000][..]),
        (Way::Fast, &[1_000_000, 2_000_000, 4_000_000]),
        (Way::Sts, &[1_000_000]),
    ] {
        for &baud in bauds {
            setups.extend([6, 12, 20].map(|servos| Setup { servos, baud, way }));
        }
    }
    setups
}

/// Takes the measure.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    // Only exactness is lost where the kernel refuses.
    let _ = rustix::thread::set_current_timer_slack(NonZeroU64::new(TIMER_SLACK_NANOS));
    let clock = MonotonicClock::new();
    for link in [Link::Terminal, Link::Tcp] {
        let channel_ms = channel::there_and_back(link)?.as_secs_f64() * 1e3;
        tell(&Row {
            measure: NAME,
            row: format!("{}, there and back, taken off", link.name()),
            subject: "kernel",
            value: channel_ms,
            best: channel_ms,
            unit: "ms",
            limit: None,
            ratio: None,
        });
    }
    for setup in setups() {
        let mut subjects: Vec<Subject<'_>> = cycles(setup)?
            .into_iter()
            .map(|(name, mut cycle)| Subject {
                row: setup.name(),
                name,
                repeat: Box::new(move || repetition(clock, cycle.as_mut())),
            })
            .collect();
        let taken = repeated(&mut subjects, ROUNDS)?;
        for (subject, taken) in subjects.iter().zip(taken) {
            let limit = setup.limit_ms();
            tell(&row(
                &subject.row,
                subject.name,
                [taken.median, taken.least, limit],
            ));
        }
    }
    parallel::take(tell)
}

fn row(name: &str, subject: &'static str, [value, best, limit]: [f64; 3]) -> Row {
    Row {
        measure: NAME,
        row: name.to_owned(),
        subject,
        value,
        best,
        unit: "ms",
        limit: Some(limit),
        ratio: Some(limit / value),
    }
}

/// The median time of a cycle, in milliseconds.
fn repetition(clock: MonotonicClock, cycle: &mut dyn Cycle) -> anyhow::Result<f64> {
    let mut took_ms = Vec::with_capacity(CYCLES);
    let mut failures = 0;
    while took_ms.len() < CYCLES {
        let began = clock.now();
        match cycle.run() {
            Ok(()) => took_ms.push(clock.now().since(began).as_secs_f64() * 1e3),
            // A machine that stops us for longer than a peer's time limit fails its cycle.
            Err(error) if failures < FAILURES_MAX => {
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
        for (servos, baud, way, hz) in [
            (20, 1_000_000, Way::Sync, 223.0),
            (20, 1_000_000, Way::Fast, 316.0),
            (12, 1_000_000, Way::Fast, 490.0),
            (20, 4_000_000, Way::Sync, 893.0),
            (20, 4_000_000, Way::Fast, 1266.0),
            (20, 1_000_000, Way::Sts, 391.0),
            (6, 1_000_000, Way::Sts, 1136.0),
        ] {
            let setup = Setup { servos, baud, way };
            assert_eq!((1e3 / setup.limit_ms()).round(), hz, "{setup:?}");
        }
    }

    #[test]
    fn every_subject_runs_a_cycle() {
        for way in [Way::Sync, Way::Fast, Way::Sts] {
            let setup = Setup {
                servos: 6,
                baud: 1_000_000,
                way,
            };
            for (name, mut cycle) in cycles(setup).expect("terminals and connections") {
                // A bus arms itself first; and a busy machine may stop us for longer than a peer waits.
                let went_well = (0..20).any(|_| cycle.run().is_ok());
                assert!(went_well, "{name}, {way:?}: the cycle never comes about");
            }
        }
    }
}
