//! Two peers, through their own interfaces. `dynamixel2` needs a terminal; `rustypot` takes any serial port.

use super::{BAUD, Boxed, Cycle, SERVOS, TICK, line, served};
use crate::measure::port::AsPort;
use crate::simulated::{POSITION, Served};
use anyhow::{anyhow, ensure};
use device::MonotonicClock;
use dynamixel2::instructions::SyncWriteData;
use firmware_sim::ServoBus;
use rustypot::DynamixelProtocolHandler;
use serialport::SerialPort;
use std::time::Duration;

/// Goal Position of the X series. Source: their control tables.
const GOAL: u8 = 116;
/// The middle of the turn.
const CENTRE: u32 = 2048;
/// Room for a packet to twenty servos; the default of 128 bytes just suffices for 22.
const BUFFER_BYTES: usize = 1024;
/// How long `rustypot` waits for an answer; `dynamixel2` always adds 34 ms.
const ANSWER_MAX: Duration = Duration::from_millis(34);

fn ids() -> Vec<u8> {
    (1..=SERVOS).collect()
}

fn address(block: u16) -> u16 {
    if block > 4 { TICK } else { POSITION }
}

struct Dynamixel2 {
    bus: dynamixel2::Bus<Vec<u8>, Vec<u8>>,
    ids: Vec<u8>,
    block: u16,
    _served: Served<ServoBus>,
}

pub(super) fn dynamixel2(block: u16) -> anyhow::Result<Boxed> {
    let served = served()?;
    let [read, write] = [(); 2].map(|()| vec![0; BUFFER_BYTES]);
    let bus = dynamixel2::Bus::open_with_buffers(served.path(), BAUD, read, write)?;
    Ok(Box::new(Dynamixel2 {
        bus,
        ids: ids(),
        block,
        _served: served,
    }))
}

impl Cycle for Dynamixel2 {
    fn run(&mut self) -> anyhow::Result<()> {
        let goals = self.ids.iter().map(|&motor_id| SyncWriteData {
            motor_id,
            data: CENTRE,
        });
        let goals: Vec<_> = goals.collect();
        self.bus.sync_write_u32(GOAL.into(), &goals)?;
        let (mut answered, mut failed) = (0, None);
        let each = |answer: Result<dynamixel2::Response<&[u8]>, dynamixel2::ReadError>| match answer {
            Ok(answer) => answered += usize::from(answer.data.len() == usize::from(self.block)),
            Err(error) => failed = failed.take().or(Some(error)),
        };
        self.bus
            .sync_read_cb(&self.ids, address(self.block), self.block, each)?;
        if let Some(error) = failed {
            return Err(anyhow!("dynamixel2: {error}"));
        }
        ensure!(answered == self.ids.len(), "{answered} servos answered");
        Ok(())
    }
}

struct Rustypot {
    protocol: DynamixelProtocolHandler,
    port: Box<dyn SerialPort>,
    ids: Vec<u8>,
    block: u8,
    _served: Option<Served<ServoBus>>,
}

pub(super) fn rustypot_pty(block: u16) -> anyhow::Result<Boxed> {
    let served = served()?;
    let port = serialport::new(served.path_text(), BAUD)
        .timeout(ANSWER_MAX)
        .open()?;
    Ok(rustypot(port, block, Some(served)))
}

pub(super) fn rustypot_memory(clock: MonotonicClock, block: u16) -> Boxed {
    let port = AsPort::new(Box::new(line(clock)), clock, BAUD, ANSWER_MAX);
    rustypot(Box::new(port), block, None)
}

fn rustypot(port: Box<dyn SerialPort>, block: u16, served: Option<Served<ServoBus>>) -> Boxed {
    Box::new(Rustypot {
        protocol: DynamixelProtocolHandler::v2(),
        port,
        ids: ids(),
        block: block as u8,
        _served: served,
    })
}

impl Cycle for Rustypot {
    fn run(&mut self) -> anyhow::Result<()> {
        let goals = vec![CENTRE.to_le_bytes().to_vec(); self.ids.len()];
        let told = |error: Box<dyn std::error::Error>| anyhow!("rustypot: {error}");
        let port = self.port.as_mut();
        self.protocol
            .sync_write(port, &self.ids, GOAL, &goals)
            .map_err(told)?;
        let address = address(self.block.into()) as u8;
        let read = self.protocol.sync_read(port, &self.ids, address, self.block);
        let read = read.map_err(told)?;
        let whole = read.iter().filter(|data| data.len() == usize::from(self.block));
        ensure!(whole.count() == self.ids.len(), "a servo is missing");
        Ok(())
    }
}
