//! A scripted far end for tests: registers that answer reads, and switches for what may go wrong on a line.
//!
//! No servo: nothing moves but a goal into the present position, and nothing is refused. It speaks with the
//! driver's own framing, so it proves nothing about bytes; the simulator in `firmware-sim` does that.

use super::world::{
    Boundary, Clock, Decoder, Heard, Instant, ServoProfile, ServoProtocol, Transport, TransportError,
    VirtualClock, encode,
};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

pub(crate) const TORQUE: usize = 64;
pub(crate) const ERROR: usize = 70;
pub(crate) const WATCHDOG: usize = 98;
pub(crate) const GOAL: usize = 116;
pub(crate) const POSITION: usize = 132;
pub(crate) const TEMPERATURE: usize = 146;
const TICK: usize = 120;
/// Bytes of a table that are kept.
const TABLE: usize = 256;

/// One write as it arrived: id, address, bytes.
pub(crate) type Write = (u8, usize, Vec<u8>);

/// What both ends of the test see.
pub(crate) struct Desk {
    pub(crate) servos: BTreeMap<u8, [u8; TABLE]>,
    pub(crate) silent: BTreeSet<u8>,
    /// Servos behind a silent one in a sync read stay silent too.
    pub(crate) waits_for_silent: bool,
    /// Answers come so much later.
    pub(crate) delay: Duration,
    /// Questions are looked at so much later, as by a machine that is busy.
    pub(crate) held_up: Duration,
    /// Their positions do not follow goals.
    pub(crate) stuck: BTreeSet<u8>,
    pub(crate) gone: bool,
    pub(crate) writes: Vec<Write>,
    answers: VecDeque<(Instant, Vec<u8>)>,
}

impl Desk {
    pub(crate) fn get(&self, id: u8, address: usize, size: usize) -> i64 {
        let bytes = &self.servos[&id][address..address + size];
        bytes
            .iter()
            .rev()
            .fold(0, |value, byte| value << 8 | i64::from(*byte))
    }

    pub(crate) fn set(&mut self, id: u8, address: usize, bytes: &[u8]) {
        self.servos.get_mut(&id).expect("on the desk")[address..address + bytes.len()].copy_from_slice(bytes);
    }

    fn read(&mut self, now: Instant, id: u8, address: usize, length: usize) {
        let now = now.after(self.held_up);
        let ticks = (now.as_nanos() / 1_000_000 + u64::from(id) * 1000) % 32_768;
        self.set(id, TICK, &(ticks as u16).to_le_bytes());
        let mut params = vec![0];
        params.extend_from_slice(&self.servos[&id][address..address + length]);
        let mut out = Vec::new();
        encode(&mut out, id, 0x55, &params).expect("short");
        self.answers.push_back((now.after(self.delay), out));
    }

    fn write(&mut self, id: u8, address: usize, bytes: &[u8]) {
        self.writes.push((id, address, bytes.to_vec()));
        self.set(id, address, bytes);
        if !self.stuck.contains(&id) && self.get(id, TORQUE, 1) == 1 && self.get(id, WATCHDOG, 1) != 0xff {
            let goal = self.servos[&id][GOAL..GOAL + 4].to_vec();
            self.set(id, POSITION, &goal);
        }
    }

    fn obey(&mut self, now: Instant, id: u8, instruction: u8, params: &[u8]) {
        let word = |at: usize| usize::from(u16::from_le_bytes([params[at], params[at + 1]]));
        match instruction {
            0x01 => {
                let here: Vec<u8> = self
                    .servos
                    .keys()
                    .copied()
                    .filter(|there| id == 0xfe || id == *there)
                    .collect();
                for id in here {
                    let model = [self.servos[&id][0], self.servos[&id][1], self.servos[&id][6]];
                    let mut out = Vec::new();
                    encode(&mut out, id, 0x55, &[0, model[0], model[1], model[2]]).expect("short");
                    self.answers.push_back((now, out));
                }
            }
            0x02 if self.servos.contains_key(&id) && !self.silent.contains(&id) => {
                self.read(now, id, word(0), word(2));
            }
            0x03 => {
                let ids: Vec<u8> = self
                    .servos
                    .keys()
                    .copied()
                    .filter(|there| id == 0xfe || id == *there)
                    .collect();
                for id in ids {
                    self.write(id, word(0), &params[2..]);
                }
                if self.servos.contains_key(&id) {
                    let mut out = Vec::new();
                    encode(&mut out, id, 0x55, &[0]).expect("short");
                    self.answers.push_back((now, out));
                }
            }
            0x82 => {
                for &id in &params[4..] {
                    if !self.silent.contains(&id) {
                        self.read(now, id, word(0), word(2));
                    } else if self.waits_for_silent {
                        return;
                    }
                }
            }
            0x83 => {
                for item in params[4..].chunks(1 + word(2)) {
                    self.write(item[0], word(0), &item[1..]);
                }
            }
            _ => {}
        }
    }
}

/// The test's end.
#[derive(Clone)]
pub(crate) struct Responder {
    clock: VirtualClock,
    desk: Arc<Mutex<Desk>>,
}

impl Responder {
    /// Servos of one model at position 2048, as they come from the factory.
    pub(crate) fn new(clock: &VirtualClock, servo: &ServoProfile, ids: &[u8]) -> Self {
        let mut table = [0; TABLE];
        for row in servo.registers.iter().filter(|row| row.count == 1) {
            let at = usize::from(row.address);
            let size = usize::from(row.size);
            if let (Some(init), Some(bytes)) = (row.init, table.get_mut(at..at + size)) {
                bytes.copy_from_slice(&(init as u32).to_le_bytes()[..size]);
            }
        }
        table[6] = servo.firmware;
        table[POSITION..POSITION + 2].copy_from_slice(&2048_u16.to_le_bytes());
        table[TEMPERATURE] = 30;
        let desk = Desk {
            servos: ids.iter().map(|id| (*id, table)).collect(),
            silent: BTreeSet::new(),
            waits_for_silent: true,
            delay: Duration::ZERO,
            held_up: Duration::ZERO,
            stuck: BTreeSet::new(),
            gone: false,
            writes: Vec::new(),
            answers: VecDeque::new(),
        };
        Self {
            clock: clock.clone(),
            desk: Arc::new(Mutex::new(desk)),
        }
    }

    pub(crate) fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().expect("no test panics while it holds the desk")
    }

    /// The driver's end.
    pub(crate) fn transport(&self) -> Box<dyn Transport> {
        Box::new(End {
            responder: self.clone(),
            decoder: Decoder::new(ServoProtocol::Dynamixel2),
        })
    }
}

struct End {
    responder: Responder,
    decoder: Decoder,
}

impl Transport for End {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let now = self.responder.clock.now();
        let mut desk = self.responder.desk();
        if desk.gone {
            return Err(TransportError::Gone {
                address: "test".to_owned(),
            });
        }
        match desk.answers.front() {
            Some((due, bytes)) if *due <= now => {
                let count = bytes.len();
                buffer[..count].copy_from_slice(bytes);
                desk.answers.pop_front();
                Ok(count)
            }
            _ => Ok(0),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let now = self.responder.clock.now();
        let mut desk = self
            .responder
            .desk
            .lock()
            .expect("no test panics while it holds the desk");
        if desk.gone {
            return Err(TransportError::Gone {
                address: "test".to_owned(),
            });
        }
        self.decoder.push(bytes, &mut |heard| {
            if let Heard::Instruction(packet) = heard {
                desk.obey(now, packet.id, packet.instruction, packet.params);
            }
        });
        Ok(())
    }
}
