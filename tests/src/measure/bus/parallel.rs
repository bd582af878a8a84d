//! Four buses at once, driven from one thread: none of them waits for another.
//!
//! By TCP inside the machine: behind four pseudo-terminals at 4 Mbaud the kernel's workers that carry bytes between them
//! would want as much of two processors as everybody else together.

use super::far::{Far, Link};
use super::{CYCLES, ROUNDS, Setup, Way, ours, row};
use crate::measure::{Tell, median};
use anyhow::ensure;
use device::servo::{Armed, Bus, Commanded, Goal};
use device::{Clock, Instant, MonotonicClock};

/// Buses.
const BUSES: usize = 4;
/// How many times a round is tried that a busy machine spoils.
const TRIES: usize = 20;

struct Driven {
    bus: Bus,
    goals: Vec<f64>,
    began: Instant,
    took_ms: Vec<f64>,
}

impl Driven {
    /// The next cycle, if the last one is over.
    fn go_on(&mut self, clock: &MonotonicClock) -> anyhow::Result<()> {
        self.bus.poll(clock.now(), &mut |_| {})?;
        if self.bus.deadline().is_some() {
            return Ok(());
        }
        let now = clock.now();
        if self.began > Instant::ZERO {
            self.took_ms.push(now.since(self.began).as_secs_f64() * 1e3);
        }
        self.began = now;
        let goal = Goal::Positions(&self.goals);
        let sent = self.bus.command(goal, now, &mut |_| {})?;
        ensure!(sent == Commanded::Sent, "the bus was {sent:?}");
        Ok(())
    }
}

/// Each bus's median time of a cycle, in milliseconds.
fn round(buses: &mut [Driven], clock: &MonotonicClock) -> anyhow::Result<Vec<f64>> {
    for driven in buses.iter_mut() {
        let armed = driven.bus.arm_blocking(clock, &mut |_| {})?;
        ensure!(armed == Armed::Yes, "refused: {:?}", driven.bus.refusals());
        driven.began = Instant::ZERO;
        driven.took_ms.clear();
    }
    while buses.iter().any(|driven| driven.took_ms.len() < CYCLES) {
        for driven in buses.iter_mut() {
            driven.go_on(clock)?;
        }
        let until = clock.now().after(super::far::QUIET);
        Bus::wait_any(buses.iter_mut().map(|driven| &mut driven.bus), clock, until);
    }
    Ok(buses
        .iter_mut()
        .map(|driven| median(&mut driven.took_ms))
        .collect())
}

/// Takes this part of the measure: the slowest of four is told.
pub(super) fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let clock = MonotonicClock::new();
    for (way, baud, servos) in [
        (Way::Sync, 1_000_000, 20),
        (Way::Fast, 1_000_000, 20),
        (Way::Sync, 4_000_000, 5),
        (Way::Fast, 4_000_000, 5),
    ] {
        let setup = Setup { servos, baud, way };
        let far = Far::start(Link::Tcp, &[setup; BUSES])?;
        let mut buses = Vec::new();
        for path in far.paths() {
            buses.push(Driven {
                bus: ours::bus(setup, path)?,
                goals: vec![0.0; servos.into()],
                began: Instant::ZERO,
                took_ms: Vec::with_capacity(CYCLES * 2),
            });
        }
        let mut slowest = Vec::new();
        for _ in 0..TRIES {
            match round(&mut buses, &clock) {
                Ok(took) => slowest.push(took.into_iter().fold(0.0, f64::max)),
                Err(error) => eprintln!("a round failed and is not counted: {error:#}"),
            }
            if slowest.len() == ROUNDS {
                break;
            }
        }
        let value = median(&mut slowest);
        let best = slowest.first().copied().unwrap_or(value);
        let name = format!("four at once, the slowest: {}", setup.name());
        tell(&row(&name, "dialrig", [value, best, setup.limit_ms()]));
    }
    Ok(())
}
