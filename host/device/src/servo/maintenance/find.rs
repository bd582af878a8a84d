//! Who is on a line: one broadcast ping in protocol 2.0, and a sweep over all ids in the frame of 1.0.
//!
//! The sweep does not wait for each id's silence, which would take 16 ms and more of an adapter's latency 254 times:
//! requests leave as far apart as an answer needs on the wire, and answers say themselves whose they are, whenever
//! the adapter hands them over.

use super::identify::{PING_DATA_BYTES, TELLING_ADDRESS, TELLING_BYTES, pinged};
use super::{Maintenance, MaintenanceError, Overheard, SLACK, is_stuffed};
use crate::clock::{Clock, Instant};
use crate::servo::framing::{self, BROADCAST_ID, dynamixel1, dynamixel2, id_max};
use crate::servo::line::RETURN_DELAY_MAX;
use device_profiles::ServoProtocol;
use std::time::Duration;

/// What each servo may take for its turn in answering a broadcast ping (the maker's SDK uses 3 ms), and what is left
/// between two requests of the sweep, so that an adapter that sends late does not send into an answer.
const TURN: Duration = Duration::from_millis(3);
/// Bytes of a read in the frame of 1.0, and of its answer.
const SWEEP_BYTES: usize =
    dynamixel1::INSTRUCTION_OVERHEAD_BYTES + 2 + dynamixel1::STATUS_OVERHEAD_BYTES + TELLING_BYTES as usize;
/// So many bytes without sense are no spark: most of an answer.
const GARBAGE_BYTES_MIN: u64 = 6;
/// Garbage in so many exchanges with one id is no spark.
const GARBLED_TIMES: usize = 2;

/// A servo that said who it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Found {
    /// What it speaks.
    pub protocol: ServoProtocol,
    /// Line speed at which it answered.
    pub baud: u32,
    /// Its id.
    pub id: u8,
    /// Model Number.
    pub model_number: u16,
    /// Firmware Version; on Feetech the part before the point.
    pub firmware: u8,
}

/// What was heard at one line speed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Heard {
    /// The line speed.
    pub baud: u32,
    /// Who answered, by id.
    pub found: Vec<Found>,
    /// Bytes came that made no packet: two servos with one id, or noise.
    pub garbled: bool,
}

impl Maintenance {
    /// Asks everybody who they are, at each of `bauds` in turn, and says what was heard as it goes on.
    /// Takes about two seconds at 1 Mbaud in all protocols. Afterwards the line is back at its speed.
    pub fn scan(
        &mut self,
        bauds: &[u32],
        clock: &dyn Clock,
        heard: &mut dyn FnMut(&Heard),
    ) -> Result<Vec<Found>, MaintenanceError> {
        let before = self.line.baud();
        let mut all = Vec::new();
        for &baud in bauds {
            self.set_baud(baud)?;
            let result = self.scan_here(clock);
            if result.is_err() {
                self.set_baud(before)?;
            }
            let here = result?;
            heard(&here);
            all.extend(here.found);
        }
        self.set_baud(before)?;
        Ok(all)
    }

    fn scan_here(&mut self, clock: &dyn Clock) -> Result<Heard, MaintenanceError> {
        self.hush(clock)?;
        let before = self.heard();
        let mut found = Vec::new();
        if self.protocols.contains(&ServoProtocol::Dynamixel2) {
            found = self.ping_all(clock)?;
        }
        if self.protocols.iter().any(|&protocol| !is_stuffed(protocol)) {
            for id in self.sweep(clock)? {
                match self.look_closer(id, clock) {
                    Ok(one) => found.push(one),
                    Err(
                        MaintenanceError::Silent { .. }
                        | MaintenanceError::Unidentified { .. }
                        | MaintenanceError::OtherProtocol { .. },
                    ) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        found.sort_by_key(|found| found.id);
        for found in &found {
            self.remember(found);
        }
        Ok(Heard {
            baud: self.line.baud(),
            found,
            garbled: self.is_garbage_since(before),
        })
    }

    /// Whether more was heard than a spark that no packet comes of.
    fn is_garbage_since(&self, before: Overheard) -> bool {
        let now = self.heard();
        now.damaged > before.damaged || now.stray_bytes >= before.stray_bytes + GARBAGE_BYTES_MIN
    }

    /// Broadcast ping in protocol 2.0.
    fn ping_all(&mut self, clock: &dyn Clock) -> Result<Vec<Found>, MaintenanceError> {
        let protocol = ServoProtocol::Dynamixel2;
        let baud = self.line.baud();
        self.line.speak(protocol);
        framing::ping(protocol, self.line.packet(), BROADCAST_ID)?;
        self.line.send(clock.now(), [], 0)?;
        let servos = u32::from(id_max(protocol)) + 1;
        let wire = self
            .line
            .wire_time(dynamixel2::STATUS_OVERHEAD_BYTES + PING_DATA_BYTES);
        let until = clock.now().after((wire + TURN) * servos + SLACK);
        let mut seen: Vec<Found> = Vec::new();
        self.listen_until(until, clock, &mut |id, data| {
            let known = seen.iter().any(|seen| seen.id == id);
            seen.extend(pinged(baud, id, data).filter(|_| !known));
        })?;
        self.line.drain(clock.now())?;
        Ok(seen)
    }

    /// Everybody who answers in the frame of 1.0, by id.
    fn sweep(&mut self, clock: &dyn Clock) -> Result<Vec<u8>, MaintenanceError> {
        let protocol = self.summed();
        self.line.speak(protocol);
        let spacing = self.line.wire_time(SWEEP_BYTES) + RETURN_DELAY_MAX + TURN;
        let mut ids = Vec::new();
        let mut take = |id: u8, data: &[u8]| {
            if data.len() == usize::from(TELLING_BYTES) && !ids.contains(&id) {
                ids.push(id);
            }
        };
        for id in 0..=id_max(protocol) {
            framing::read(protocol, self.line.packet(), id, TELLING_ADDRESS, TELLING_BYTES)?;
            self.line.send_on(clock.now())?;
            self.listen_until(clock.now().after(spacing), clock, &mut take)?;
        }
        self.listen_until(clock.now().after(SLACK), clock, &mut take)?;
        self.line.drain(clock.now())?;
        ids.sort_unstable();
        Ok(ids)
    }

    /// Hands out whatever answers come until then.
    fn listen_until(
        &mut self,
        until: Instant,
        clock: &dyn Clock,
        take: &mut dyn FnMut(u8, &[u8]),
    ) -> Result<(), MaintenanceError> {
        loop {
            let now = clock.now();
            self.line
                .overhear(now, &mut |status| take(status.id, status.data))?;
            if now >= until {
                break;
            }
            self.wait(clock, until);
        }
        Ok(())
    }

    /// The ids, other than those in `found`, whose answers are nothing but garbage each time they are asked: two
    /// servos have that id. For a line on which a scan heard something garbled; takes some seconds.
    pub fn garbled_ids(&mut self, found: &[u8], clock: &dyn Clock) -> Result<Vec<u8>, MaintenanceError> {
        let mut frames = Vec::new();
        if self.protocols.contains(&ServoProtocol::Dynamixel2) {
            frames.push(ServoProtocol::Dynamixel2);
        }
        if self.protocols.iter().any(|&protocol| !is_stuffed(protocol)) {
            frames.push(self.summed());
        }
        let mut garbled = Vec::new();
        for protocol in frames {
            for id in 0..=id_max(protocol) {
                let named = found.contains(&id) || garbled.contains(&id);
                if !named && self.is_garbled(protocol, id, clock)? {
                    garbled.push(id);
                }
            }
        }
        garbled.sort_unstable();
        Ok(garbled)
    }

    fn is_garbled(
        &mut self,
        protocol: ServoProtocol,
        id: u8,
        clock: &dyn Clock,
    ) -> Result<bool, MaintenanceError> {
        for _ in 0..GARBLED_TIMES {
            let before = self.heard();
            let (bytes, address) = match protocol {
                ServoProtocol::Dynamixel2 => (PING_DATA_BYTES, 0),
                _ => (usize::from(TELLING_BYTES), TELLING_ADDRESS),
            };
            let answer = self.ask_once(protocol, id, bytes, clock, &|out| match protocol {
                ServoProtocol::Dynamixel2 => framing::ping(protocol, out, id),
                _ => framing::read(protocol, out, id, address, TELLING_BYTES),
            })?;
            self.line.drain(clock.now())?;
            if answer.is_some() || !self.is_garbage_since(before) {
                return Ok(false);
            }
            self.hush(clock)?;
        }
        Ok(true)
    }
}
