//! The player's bus as it is.

use super::far::{Far, Link};
use super::{Boxed, Cycle, Setup, Way};
use anyhow::{Context, ensure};
use device::MonotonicClock;
use device::servo::{Armed, Bus, BusSettings, Commanded, Goal, Limits, Member, Readings};
use device::transport;
use std::time::Duration;

/// A thread of its own for the bus, awake when answers are due; longer than a cycle at 4 Mbaud, where it stays awake.
const ALERT: Duration = Duration::from_micros(400);

struct OnBus {
    bus: Bus,
    clock: MonotonicClock,
    goals: Vec<f64>,
    servos: usize,
    /// Kept, so that it goes on being served.
    _far: Far,
}

pub(super) fn cycle(setup: Setup, link: Link) -> anyhow::Result<Boxed> {
    let far = Far::start(link, &[setup])?;
    let path = far.paths().first().context("one bus")?;
    Ok(Box::new(OnBus {
        bus: bus(setup, path)?,
        clock: MonotonicClock::new(),
        goals: vec![0.0; setup.servos.into()],
        servos: setup.servos.into(),
        _far: far,
    }))
}

/// The bus of a setup, on a line.
pub(super) fn bus(setup: Setup, path: &str) -> anyhow::Result<Bus> {
    let settings = BusSettings {
        // Other subjects' cycles lie between two repetitions.
        watchdog: Duration::from_millis(2540),
        readings: Readings::Position,
        alert: ALERT,
        fast_reads: setup.way == Way::Fast,
        ..BusSettings::new("measured", setup.baud)
    };
    let profile = setup.profile()?;
    let limits = Limits::new([-1.5, 1.5], 4.0, 20.0)?;
    let member = |id: u8| {
        let centre = profile.centre_counts;
        Member::new(&format!("joint {id}"), id, profile.clone(), 1, centre, limits)
    };
    let members = (1..=setup.servos).map(member).collect::<Result<Vec<_>, _>>()?;
    let transport = transport::open(&path.parse()?, setup.baud)?;
    Ok(Bus::new(transport, members, settings)?)
}

impl Cycle for OnBus {
    fn run(&mut self) -> anyhow::Result<()> {
        if self.bus.armed() != Armed::Yes {
            let armed = self.bus.arm_blocking(&self.clock, &mut |_| {})?;
            ensure!(armed == Armed::Yes, "refused: {:?}", self.bus.refusals());
            anyhow::bail!("the bus was being armed");
        }
        let before = self.bus.counters();
        let goal = Goal::Positions(&self.goals);
        let done = self
            .bus
            .cycle_blocking(goal, &self.clock, &mut |_| {}, &mut |_| {})?;
        ensure!(done == Commanded::Sent, "the bus was {done:?}");
        let missed = self.bus.counters().timeouts - before.timeouts;
        ensure!(missed == 0, "{missed} servos did not answer");
        for member in 0..self.servos {
            self.bus.reading(member).context("a servo was never read")?;
        }
        Ok(())
    }
}
