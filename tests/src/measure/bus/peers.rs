//! Two peers, through their own interfaces.

use super::far::Far;
use super::{Boxed, Cycle, Setup, Way};
use anyhow::{Context, anyhow, ensure};
use dynamixel2::instructions::SyncWriteData;
use rustypot::DynamixelProtocolHandler;
use serialport::SerialPort;
use std::time::Duration;

/// Goal and Present Position of the X series. Source: their control tables.
const X_PLACES: [u8; 2] = [116, 132];
/// The same of STS. Source: its memory table.
const STS_PLACES: [u8; 2] = [42, 56];
/// The middle of the turn of both.
const CENTRE: u32 = 2048;
/// Room for a packet to twenty servos; the default of 128 bytes just suffices for 22.
const BUFFER_BYTES: usize = 1024;
/// How long `rustypot` waits for an answer; `dynamixel2` always adds 34 ms.
const ANSWER_MAX: Duration = Duration::from_millis(34);

/// Who can do what the setup asks for.
pub(crate) fn cycles(setup: Setup) -> anyhow::Result<Vec<(&'static str, Boxed)>> {
    cycles_with(setup, None)
}

/// The same of six servos by sync read of which one does not answer.
pub(crate) fn with_an_absent_servo() -> anyhow::Result<Vec<(&'static str, Boxed)>> {
    let setup = Setup {
        servos: 6,
        baud: 1_000_000,
        way: Way::Sync,
    };
    cycles_with(setup, Some("servo 2 silent"))
}

fn cycles_with(setup: Setup, fault: Option<&str>) -> anyhow::Result<Vec<(&'static str, Boxed)>> {
    let rustypot: Boxed = Box::new(Rustypot::open(setup, Far::start_with(&[setup], fault)?)?);
    let mut cycles = vec![("rustypot", rustypot)];
    // It has neither fast reads nor Feetech.
    if setup.way == Way::Sync {
        let peer: Boxed = Box::new(Dynamixel2::open(setup, Far::start_with(&[setup], fault)?)?);
        cycles.push(("dynamixel2", peer));
    }
    Ok(cycles)
}

struct Dynamixel2 {
    bus: dynamixel2::Bus<Vec<u8>, Vec<u8>>,
    ids: Vec<u8>,
    _far: Far,
}

impl Dynamixel2 {
    fn open(setup: Setup, far: Far) -> anyhow::Result<Self> {
        let [read, write] = [(); 2].map(|()| vec![0; BUFFER_BYTES]);
        let path = far.paths().first().context("one bus")?;
        Ok(Self {
            bus: dynamixel2::Bus::open_with_buffers(path, setup.baud, read, write)?,
            ids: (1..=setup.servos).collect(),
            _far: far,
        })
    }
}

impl Cycle for Dynamixel2 {
    fn run(&mut self) -> anyhow::Result<()> {
        let [goal, position] = X_PLACES.map(u16::from);
        let goals = self.ids.iter().map(|&motor_id| SyncWriteData {
            motor_id,
            data: CENTRE,
        });
        let goals: Vec<_> = goals.collect();
        self.bus.sync_write_u32(goal, &goals)?;
        let (mut answered, mut failed) = (0, None);
        let each = |answer: Result<dynamixel2::Response<&[u8]>, dynamixel2::ReadError>| match answer {
            Ok(answer) => answered += usize::from(answer.data.len() == 4),
            Err(error) => failed = failed.take().or(Some(error)),
        };
        self.bus.sync_read_cb(&self.ids, position, 4, each)?;
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
    places: [u8; 2],
    width: usize,
    fast: bool,
    _far: Far,
}

impl Rustypot {
    fn open(setup: Setup, far: Far) -> anyhow::Result<Self> {
        let path = far.paths().first().context("one bus")?;
        let sts = setup.way == Way::Sts;
        Ok(Self {
            protocol: if sts {
                DynamixelProtocolHandler::v1()
            } else {
                DynamixelProtocolHandler::v2()
            },
            port: serialport::new(path, setup.baud).timeout(ANSWER_MAX).open()?,
            ids: (1..=setup.servos).collect(),
            places: if sts { STS_PLACES } else { X_PLACES },
            width: if sts { 2 } else { 4 },
            fast: setup.way == Way::Fast,
            _far: far,
        })
    }
}

impl Cycle for Rustypot {
    fn run(&mut self) -> anyhow::Result<()> {
        let [goal, position] = self.places;
        let centre = CENTRE.to_le_bytes();
        let centre = centre.get(..self.width).unwrap_or_default();
        let goals = vec![centre.to_vec(); self.ids.len()];
        let told = |error: Box<dyn std::error::Error>| anyhow!("rustypot: {error}");
        let port = self.port.as_mut();
        self.protocol
            .sync_write(port, &self.ids, goal, &goals)
            .map_err(told)?;
        let width = self.width as u8;
        let read = if self.fast {
            self.protocol.fast_sync_read(port, &self.ids, position, width)
        } else {
            self.protocol.sync_read(port, &self.ids, position, width)
        };
        let read = read.map_err(told)?;
        let whole = read.iter().filter(|data| data.len() == self.width);
        ensure!(whole.count() == self.ids.len(), "a servo is missing");
        Ok(())
    }
}
