//! Several servos on one wire: every byte and every turn to answer, in order of time.
//!
//! Nothing happens between events, and events are ordered by when they happen on the wire, so the result
//! does not depend on how the calls are cut up.

use super::chain::{Absent, Chain};
use super::dynamixel2::receiver::{BadCrc, InnerHeader};
use super::fault::BusFault;
use super::fault_run::Running;
use super::heard::{Framing, Heard};
use super::servo::Servo;
use super::unit::Unit;
use super::wire::{Adapter, Byte, Wire, WireTime};
use super::{dynamixel2, summed};
use crate::firmware::Firmware;
use device_profiles::{ServoProfile, ServoProtocol};
use std::collections::VecDeque;

/// How many answers are remembered for `statuses`.
const STATUSES_KEPT: usize = 4096;
/// Bits of a byte on the wire, start and stop included, in a nanosecond's worth of baud.
const BYTE_BITS_NS: u64 = 10 * 1_000_000_000;

/// What is common to the whole bus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BusOptions {
    /// The host's line speed in baud.
    pub baud: u32,
    /// Whether bytes take time.
    pub wire: WireTime,
    /// The host hears its own bytes.
    pub echo: bool,
    /// Hands bytes over in pieces; none: each byte at once.
    pub adapter: Option<Adapter>,
    /// What servos do behind an absent one.
    pub absent: Absent,
    /// What a servo does with a packet whose checksum is wrong.
    pub bad_crc: BadCrc,
    /// What a servo makes of a header inside a packet.
    pub inner_header: InnerHeader,
    /// Decides which answers and bytes the faults hit.
    pub seed: u64,
}

impl Default for BusOptions {
    /// A perfect adapter on a real wire at 1 Mbaud.
    fn default() -> Self {
        Self {
            baud: 1_000_000,
            wire: WireTime::Real,
            echo: false,
            adapter: None,
            absent: Absent::default(),
            bad_crc: BadCrc::default(),
            inner_header: InnerHeader::default(),
            seed: 0,
        }
    }
}

/// Why a servo cannot be put on the bus.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AddError {
    /// a number no such servo can have
    #[error("{servo}: expected an id from 0 to {max}, found {id}")]
    Id {
        /// Name of the model.
        servo: String,
        /// What was asked for.
        id: u8,
        /// The largest there is in its protocol.
        max: u8,
    },
    /// the model has no such line speed
    #[error("{servo} cannot speak at {baud} baud; it has {known:?}")]
    Baud {
        /// Name of the model.
        servo: String,
        /// What was asked for.
        baud: u32,
        /// What there is.
        known: Vec<u32>,
    },
}

/// One answer that went on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StatusSent {
    /// Who.
    pub id: u8,
    /// When its values were measured.
    pub sampled_us: u64,
    /// When its first byte began.
    pub first_us: u64,
    /// When its last byte was out.
    pub last_us: u64,
    /// A fault took it: the host never sees it.
    pub lost: bool,
}

/// The servos, the wire between them, and whatever is wrong with it.
#[derive(Clone, Debug)]
pub struct ServoBus {
    pub(super) options: BusOptions,
    pub(super) servos: Vec<Servo>,
    receivers: Receivers,
    pub(super) chain: Chain,
    pub(super) faults: Vec<Running>,
    pub(super) random: fastrand::Rng,
    pub(super) answer_params: Vec<u8>,
    pub(super) one_answer: Vec<u8>,
    pub(super) reboots: Vec<usize>,
    pub(super) wire: Wire,
    pub(super) ohms: f64,
    heard_until_ns: u64,
    params: Vec<u8>,
    reached_ns: u64,
    merged: Vec<u8>,
    merged_delay_ns: Option<u64>,
    statuses: VecDeque<StatusSent>,
}

impl ServoBus {
    /// A bus without servos.
    pub fn new(options: BusOptions) -> Self {
        Self {
            wire: Wire::new(byte_ns(options.wire, options.baud), options.adapter),
            random: fastrand::Rng::with_seed(options.seed),
            receivers: Receivers {
                dynamixel2: dynamixel2::receiver::Receiver::new(options.inner_header),
                summed: summed::receiver::Receiver::default(),
            },
            options,
            servos: Vec::new(),
            chain: Chain::new(),
            faults: Vec::new(),
            answer_params: Vec::new(),
            one_answer: Vec::new(),
            reboots: Vec::new(),
            ohms: 0.0,
            heard_until_ns: 0,
            params: Vec::new(),
            reached_ns: 0,
            merged: Vec::new(),
            merged_delay_ns: None,
            statuses: VecDeque::new(),
        }
    }

    /// Hangs a servo on the end of the chain. Two of the same number are allowed, as on a real bus.
    pub fn add(&mut self, profile: &ServoProfile, unit: Unit) -> Result<(), AddError> {
        let max = match profile.protocol {
            ServoProtocol::Dynamixel2 => dynamixel2::packet::ID_MAX,
            _ => summed::packet::ID_MAX,
        };
        if unit.id > max {
            return Err(AddError::Id {
                servo: profile.name.clone(),
                id: unit.id,
                max,
            });
        }
        let baud = unit.baud.unwrap_or(self.options.baud);
        if !profile.bauds.contains(&baud) {
            let known = profile.bauds.clone();
            return Err(AddError::Baud {
                servo: profile.name.clone(),
                baud,
                known,
            });
        }
        let mut servo = Servo::new(profile, unit, self.options.baud);
        servo.advance(self.reached_ns);
        servo
            .plant
            .seed(self.options.seed.wrapping_add(self.servos.len() as u64));
        self.servos.push(servo);
        Ok(())
    }

    /// The first servo with number `id`.
    pub fn servo(&self, id: u8) -> Option<&Servo> {
        self.servos.iter().find(|servo| servo.id() == id)
    }

    /// The first servo with number `id`.
    pub(super) fn servo_mut(&mut self, id: u8) -> Option<&mut Servo> {
        self.servos.iter_mut().find(|servo| servo.id() == id)
    }

    /// All servos in the order of the chain.
    pub fn servos(&self) -> &[Servo] {
        &self.servos
    }

    /// The same, to put back their EEPROM.
    pub fn servos_mut(&mut self) -> &mut [Servo] {
        &mut self.servos
    }

    /// The last answers, oldest first.
    pub fn statuses(&self) -> impl Iterator<Item = &StatusSent> {
        self.statuses.iter()
    }

    /// Bytes spoilt because two spoke at once.
    pub fn collisions(&self) -> u64 {
        self.wire.collisions
    }

    /// Packets of the host that no servo could read.
    pub fn dropped_packets(&self) -> u64 {
        self.receivers.dynamixel2.dropped + self.receivers.summed.dropped
    }

    /// Whether a servo of the bus hears packets put together like this.
    fn speaks(&self, framing: Framing) -> bool {
        self.servos.iter().any(|servo| servo.framing() == framing)
    }

    pub(super) fn catch_up(&mut self, now_us: u64) -> u64 {
        let now_ns = (now_us * 1000).max(self.reached_ns);
        self.advance(now_ns);
        now_ns
    }

    /// Lets everything happen, in its order, that happens up to `to_ns`.
    pub(super) fn advance(&mut self, to_ns: u64) {
        loop {
            let events = [
                self.next_fault_ns(),
                self.wire.next_arrival_ns(),
                self.chain.next_ns(),
            ];
            let Some(at_ns) = events.into_iter().flatten().min().filter(|&at| at <= to_ns) else {
                break;
            };
            self.reached_ns = self.reached_ns.max(at_ns);
            if self.ohms > 0.0 {
                // None goes ahead of those it shares the supply with, or it would matter how calls are cut up.
                self.advance_servos(at_ns);
            }
            if self.next_fault_ns().is_some_and(|due| due <= at_ns) {
                self.change_faults(at_ns);
            } else if self.chain.next_ns().is_some_and(|due| due <= at_ns) {
                self.step_chain();
            } else if let Some(byte) = self.wire.arrival(at_ns) {
                self.hear(byte);
            }
        }
        self.reached_ns = self.reached_ns.max(to_ns);
        self.advance_servos(to_ns);
    }

    /// A byte of the host has reached the servos: whatever it completes is carried out.
    fn hear(&mut self, byte: Byte) {
        let idle_ns = match self.options.wire {
            WireTime::Real => byte.start_ns.saturating_sub(self.heard_until_ns),
            WireTime::None => 0,
        };
        self.heard_until_ns = byte.end_ns;
        let value = self.through_noise(None, byte.value);
        let mut params = std::mem::take(&mut self.params);
        for framing in [Framing::Dynamixel2, Framing::Summed] {
            if !self.speaks(framing) {
                continue;
            }
            params.clear();
            if let Some(heard) = self
                .receivers
                .push(framing, idle_ns, byte.end_ns, value, &mut params)
            {
                self.dispatch(byte.end_ns, heard, &params);
                self.babble(byte.end_ns);
            }
        }
        self.params = params;
    }

    /// Nobody has answered yet.
    pub(super) fn begin_answer(&mut self) {
        self.merged.clear();
        self.merged_delay_ns = None;
    }

    /// One more servo sends `one_answer` after `delay_ns`. Two with the same number talk over each other:
    /// their clocks differ, so even equal answers do not fit.
    pub(super) fn add_answer(&mut self, delay_ns: u64) {
        match self.merged_delay_ns {
            None => {
                self.merged.extend_from_slice(&self.one_answer);
                self.merged_delay_ns = Some(delay_ns);
            }
            Some(first_ns) => {
                for (at, &byte) in self.one_answer.iter().enumerate() {
                    match self.merged.get_mut(at) {
                        Some(other) => *other &= byte.rotate_left(1),
                        None => self.merged.push(byte),
                    }
                }
                self.merged_delay_ns = Some(first_ns.min(delay_ns));
            }
        }
    }

    /// Puts the answer measured at `sampled_ns` on the wire; the time after its last byte, or none if nobody
    /// answered.
    pub(super) fn finish_answer(&mut self, id: u8, sampled_ns: u64) -> Option<u64> {
        let delay_ns = self.merged_delay_ns?;
        let delay_ns = if self.options.wire == WireTime::Real {
            delay_ns
        } else {
            0
        };
        let start_ns = sampled_ns + delay_ns + self.lateness_ns(id);
        let lost = self.loses_answer(id);
        let end_ns = if lost {
            start_ns + self.wire.byte_ns * self.merged.len() as u64
        } else {
            let mut bytes = std::mem::take(&mut self.merged);
            for byte in &mut bytes {
                *byte = self.through_noise(Some(id), *byte);
            }
            let end_ns = self.wire.servos_send(start_ns, &bytes);
            self.merged = bytes;
            end_ns
        };
        if self.statuses.len() == STATUSES_KEPT {
            self.statuses.pop_front();
        }
        let [sampled_us, first_us, last_us] = [sampled_ns, start_ns, end_ns].map(|ns| ns / 1000);
        self.statuses.push_back(StatusSent {
            id,
            sampled_us,
            first_us,
            last_us,
            lost,
        });
        Some(end_ns)
    }
}

/// What the servos have heard of a packet so far, in each way a packet may be put together.
#[derive(Clone, Debug)]
struct Receivers {
    dynamixel2: dynamixel2::receiver::Receiver,
    summed: summed::receiver::Receiver,
}

impl Receivers {
    /// A packet that `byte` completes; its parameters go to `params`.
    fn push(
        &mut self,
        framing: Framing,
        idle_ns: u64,
        end_ns: u64,
        byte: u8,
        params: &mut Vec<u8>,
    ) -> Option<Heard> {
        match framing {
            Framing::Dynamixel2 => {
                let heard = self.dynamixel2.push(idle_ns, end_ns, byte)?;
                params.extend_from_slice(self.dynamixel2.params());
                self.dynamixel2.clear();
                Some(heard)
            }
            Framing::Summed => {
                let heard = self.summed.push(idle_ns, end_ns, byte)?;
                params.extend_from_slice(self.summed.params());
                self.summed.clear();
                Some(heard)
            }
        }
    }

    /// A packet under way comes at another speed from here on: noise.
    fn give_up(&mut self) {
        self.dynamixel2.give_up();
        self.summed.give_up();
    }
}

/// What one byte takes on the wire.
fn byte_ns(wire: WireTime, baud: u32) -> u64 {
    match wire {
        WireTime::Real => BYTE_BITS_NS / u64::from(baud.max(1)),
        WireTime::None => 0,
    }
}

impl Firmware for ServoBus {
    fn receive(&mut self, now_us: u64, bytes: &[u8]) {
        let now_ns = self.catch_up(now_us);
        let echo = self.options.echo || self.suffers_until_ns(BusFault::Echo).is_some();
        for &byte in bytes {
            self.wire.host_sends(now_ns, byte, echo);
        }
        self.advance(now_ns);
    }

    fn transmit(&mut self, now_us: u64, out: &mut Vec<u8>) {
        let now_ns = self.catch_up(now_us);
        if self.stalled_until_ns().is_none() {
            self.wire.deliver(now_ns, out);
        }
    }

    fn set_line_baud(&mut self, now_us: u64, baud: u32) {
        self.catch_up(now_us);
        if baud == self.options.baud {
            return;
        }
        self.receivers.give_up();
        self.wire.spoil(self.reached_ns);
        self.options.baud = baud.max(1);
        self.wire.byte_ns = byte_ns(self.options.wire, baud);
    }

    fn next_byte_us(&self) -> Option<u64> {
        let next_ns = self.wire.next_delivery_ns()?;
        let stalled_ns = self.stalled_until_ns().unwrap_or(0);
        Some(next_ns.max(stalled_ns).div_ceil(1000))
    }
}
