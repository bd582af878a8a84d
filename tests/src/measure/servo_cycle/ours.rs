//! Our own side: the player's bus as it is, and its framing alone.

use super::{BAUD, Boxed, Cycle, SERVOS, TICK, line, served};
use crate::simulated::{POSITION, Served, members};
use anyhow::{Context, ensure};
use device::servo::framing::{Decoder, dynamixel2};
use device::servo::{Armed, Bus, BusSettings, Commanded, Goal};
use device::transport::serial;
use device::{Clock, MonotonicClock, Transport};
use device_profiles::ServoProtocol;
use firmware_sim::ServoBus;
use std::time::Duration;

/// Goal Position of the X series. Source: their control tables.
const GOAL: u16 = 116;
/// The middle of the turn.
const CENTRE: u32 = 2048;
/// Longest wait for the answers of a cycle.
const ANSWERS_MAX: Duration = Duration::from_millis(60);

/// The player's bus, with limits, freshness and everything.
struct OnBus {
    bus: Bus,
    clock: MonotonicClock,
    goals: Vec<f64>,
    /// Kept, so that it goes on being served.
    _served: Option<Served<ServoBus>>,
}

pub(super) fn bus_pty() -> anyhow::Result<Boxed> {
    let served = served()?;
    let transport = serial::open(&served.path_text(), BAUD)?;
    on_bus(Box::new(transport), MonotonicClock::new(), Some(served))
}

pub(super) fn bus_memory(clock: MonotonicClock) -> anyhow::Result<Boxed> {
    on_bus(Box::new(line(clock)), clock, None)
}

fn on_bus(
    transport: Box<dyn Transport>,
    clock: MonotonicClock,
    served: Option<Served<ServoBus>>,
) -> anyhow::Result<Boxed> {
    let settings = BusSettings {
        // The other subjects' cycles lie between two repetitions.
        watchdog: Duration::from_millis(2540),
        ..BusSettings::new("measured", BAUD)
    };
    let bus = Bus::new(transport, members(SERVOS), settings)?;
    Ok(Box::new(OnBus {
        bus,
        clock,
        goals: vec![0.0; SERVOS.into()],
        _served: served,
    }))
}

impl OnBus {
    /// Arms the bus where it is not, or where the pause was so long that it must be done again.
    fn arm(&mut self) -> anyhow::Result<()> {
        let armed = self.bus.arm_blocking(&self.clock, &mut |_| {})?;
        ensure!(
            armed == Armed::Yes,
            "arming was refused: {:?}",
            self.bus.refusals()
        );
        Ok(())
    }
}

impl Cycle for OnBus {
    fn run(&mut self) -> anyhow::Result<()> {
        if self.bus.armed() != Armed::Yes {
            self.arm()?;
            anyhow::bail!("the bus was being armed");
        }
        let missed = self.bus.counters().timeouts;
        let done = self.bus.cycle_blocking(
            Goal::Positions(&self.goals),
            &self.clock,
            &mut |_| {},
            &mut |_| {},
        )?;
        ensure!(done == Commanded::Sent, "the bus was {done:?}");
        let missed = self.bus.counters().timeouts - missed;
        ensure!(missed == 0, "{missed} servos did not answer");
        let last = self.bus.reading(usize::from(SERVOS) - 1);
        last.context("the last servo was never read")?;
        Ok(())
    }
}

/// The framing of the bus and a transport, and nothing between.
struct Framing {
    transport: Box<dyn Transport>,
    decoder: Decoder,
    clock: MonotonicClock,
    address: u16,
    block: u16,
    out: Vec<u8>,
    _served: Option<Served<ServoBus>>,
}

pub(super) fn framing_pty(block: u16) -> anyhow::Result<Boxed> {
    let served = served()?;
    let transport = serial::open(&served.path_text(), BAUD)?;
    Ok(framing(
        Box::new(transport),
        MonotonicClock::new(),
        block,
        Some(served),
    ))
}

pub(super) fn framing_memory(clock: MonotonicClock, block: u16) -> Boxed {
    framing(Box::new(line(clock)), clock, block, None)
}

fn framing(
    transport: Box<dyn Transport>,
    clock: MonotonicClock,
    block: u16,
    served: Option<Served<ServoBus>>,
) -> Boxed {
    Box::new(Framing {
        transport,
        decoder: Decoder::new(ServoProtocol::Dynamixel2),
        clock,
        address: if block > 4 { TICK } else { POSITION },
        block,
        out: Vec::with_capacity(256),
        _served: served,
    })
}

impl Cycle for Framing {
    fn run(&mut self) -> anyhow::Result<()> {
        self.out.clear();
        let goals = (1..=SERVOS).map(|id| (id, CENTRE.to_le_bytes()));
        dynamixel2::sync_write(&mut self.out, GOAL, goals)?;
        dynamixel2::sync_read(&mut self.out, self.address, self.block, 1..=SERVOS)?;
        self.transport.write(&self.out)?;
        let until = self.clock.now().after(ANSWERS_MAX);
        let mut answered = 0;
        let mut chunk = [0; 512];
        while answered < SERVOS && self.clock.now() < until {
            self.transport.wait(&self.clock, until);
            let count = self.transport.read(&mut chunk)?;
            let block = usize::from(self.block);
            let heard = chunk.get(..count).unwrap_or_default();
            self.decoder.push(heard, &mut |packet| {
                let right = packet
                    .status()
                    .is_some_and(|status| status.id == answered + 1 && status.data.len() == block);
                answered += u8::from(right);
            });
        }
        ensure!(answered == SERVOS, "{answered} of {SERVOS} servos answered");
        Ok(())
    }
}
