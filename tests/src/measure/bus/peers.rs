//! Two peers, through their own interfaces.

use super::far::{Far, Link};
use super::{Boxed, Cycle, Setup, Way};
use crate::measure::port::AsPort;
use anyhow::{Context, anyhow, ensure};
use device::{MonotonicClock, transport};
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

/// Six servos by sync read of which one does not answer, each peer on the terminal it would open.
pub(crate) fn with_an_absent_servo() -> anyhow::Result<Vec<(&'static str, Boxed)>> {
    let setup = Setup {
        servos: 6,
        baud: 1_000_000,
        way: Way::Sync,
    };
    let far = || Far::start_with(Link::Terminal, &[setup], Some("servo 2 silent"));
    Ok(vec![
        (
            "rustypot",
            Box::new(Rustypot::open(setup, Link::Terminal, far()?)?),
        ),
        ("dynamixel2", Box::new(Dynamixel2::open(setup, far()?)?)),
    ])
}

/// It takes any port, so also one that is a connection.
pub(super) fn rustypot(setup: Setup, link: Link) -> anyhow::Result<Boxed> {
    let far = Far::start(link, &[setup])?;
    Ok(Box::new(Rustypot::open(setup, link, far)?))
}

/// It opens terminals alone, and has neither fast reads nor Feetech.
pub(super) fn dynamixel2(setup: Setup) -> anyhow::Result<Boxed> {
    let far = Far::start(Link::Terminal, &[setup])?;
    Ok(Box::new(Dynamixel2::open(setup, far)?))
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
    fn open(setup: Setup, link: Link, far: Far) -> anyhow::Result<Self> {
        let path = far.paths().first().context("one bus")?;
        let port: Box<dyn SerialPort> = match link {
            Link::Terminal => serialport::new(path, setup.baud).timeout(ANSWER_MAX).open()?,
            Link::Tcp => {
                let line = transport::open(&path.parse()?, setup.baud)?;
                Box::new(AsPort::new(line, MonotonicClock::new(), setup.baud, ANSWER_MAX))
            }
        };
        let sts = setup.way == Way::Sts;
        Ok(Self {
            protocol: if sts {
                DynamixelProtocolHandler::v1()
            } else {
                DynamixelProtocolHandler::v2()
            },
            port,
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
