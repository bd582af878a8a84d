//! From servos in any state to servos that hold exactly where they are.
//!
//! The order is the point: everything is read before anything is written, settings are changed only where they
//! differ and only with torque off, the goal is set to the measured position and read back before torque goes
//! on, and read back once more with torque on, which is where the limiters start. Where a servo has a Bus Watchdog it
//! is armed with torque, so that it stops by itself when the host is gone; where it has none nothing can promise
//! that, and [`Bus::unwatched`] says which those are.
//! Sync writes are unanswered, so each write is proved by reading back; that also keeps a late answer from
//! being taken for an acknowledgement.
//!
//! Source: e-manual, "Control Table of EEPROM Area" (locked while torque is on), "Bus Watchdog (98)"; users'
//! reports of first-frame lunges, `docs/protocols/dynamixel2.md`; Feetech's lock, servo reference 3.5.

mod judge;
mod refusal;
mod writes;

pub use refusal::{Refusal, Why};

use super::block::{Block, is_covered};
use super::bus::{Bus, BusError, Mode};
use super::event::BusEvent;
use super::gather::Gather;
use super::limit::Limiter;
use super::member::Member;
use super::register::Field;
use super::slot::Slot;
use crate::clock::Instant;

/// How far arming has come. Each stage begins with its writes, gathers rows, and judges them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    Identity,
    Errors,
    Supply,
    Settings { written: u8 },
    Range,
    Profile { written: u8 },
    Measure { tries: u8 },
    Pin { tries: u8 },
    Torque { written: u8 },
    Held { tries: u8 },
}

/// Arming under way.
#[derive(Debug, Clone)]
pub(super) struct Arming {
    stage: Stage,
    gather: Gather,
}

/// What follows from a stage's answers.
enum Next {
    Stage(Stage),
    Refuse(Vec<(usize, Why)>),
    Armed,
}

impl Stage {
    /// What is read of a servo in this stage.
    fn blocks(self, slot: &Slot) -> Vec<Block> {
        let table = &slot.table;
        let servo = slot.member.servo();
        let covering = |rows: &[Option<Field>]| {
            let rows: Vec<Field> = rows.iter().copied().flatten().collect();
            Block::covering(servo, &rows)
        };
        match self {
            Self::Identity => covering(&[table.model, table.firmware]),
            Self::Errors => covering(&[table.error]),
            Self::Supply => covering(&[table.voltage, table.temperature]),
            Self::Settings { .. } => covering(&[table.return_delay, table.drive_mode, table.operating_mode]),
            Self::Range => covering(&[table.position_max, table.position_min]),
            Self::Profile { .. } => covering(&[table.acceleration, table.speed, table.goal_time]),
            Self::Measure { .. } => vec![table.status],
            Self::Pin { .. } | Self::Held { .. } => goal_and_status(slot),
            Self::Torque { .. } => covering(&[Some(table.torque)]),
        }
    }
}

/// In one block if nothing but registers lies between them.
fn goal_and_status(slot: &Slot) -> Vec<Block> {
    let (goal, status) = (slot.table.goal, slot.table.status);
    let servo = slot.member.servo();
    let end = status.address + status.bytes;
    let near = end.saturating_sub(goal.address) <= 32;
    if goal.address < status.address && near && is_covered(servo, goal.address, end) {
        let whole = Field {
            address: status.address,
            size: status.bytes as u8,
            ..goal
        };
        return vec![Block::spanning(servo, &[goal, whole])];
    }
    vec![status, Block::spanning(servo, &[goal])]
}

impl Bus {
    /// Begins to read, configure, pin and switch on all members; [`Bus::poll`] carries it on, and
    /// [`Bus::armed`] tells how far it is. Nothing moves: the first goals are the measured positions.
    /// Refused as a whole when one member cannot be armed; [`Bus::refusals`] says why.
    pub fn begin_arming(&mut self, now: Instant) -> Result<(), BusError> {
        self.begin_stage(Stage::Identity, now)
    }

    /// Members whose servos cannot stop by themselves when the host falls silent: they hold the last goal until
    /// somebody switches torque off or cuts the power.
    pub fn unwatched(&self) -> impl Iterator<Item = &Member> {
        let slots = self.slots.iter().filter(|slot| slot.table.watchdog.is_none());
        slots.map(|slot| &slot.member)
    }

    /// As arming, but for members that were armed already: measures, pins, clears and re-arms the watchdog.
    pub(super) fn begin_pinning(&mut self, now: Instant) -> Result<(), BusError> {
        // From the profile on: a servo that restarted meanwhile has forgotten how fast it may turn.
        self.begin_stage(Stage::Profile { written: 0 }, now)
    }

    fn begin_stage(&mut self, stage: Stage, now: Instant) -> Result<(), BusError> {
        self.refusals.clear();
        self.drain(now)?;
        for slot in &mut self.slots {
            slot.limiter = None;
            slot.let_go = false;
            slot.pin = None;
            slot.held_rad = None;
        }
        let gather = Gather::new(&self.slots, |slot| stage.blocks(slot)).after_silence();
        self.mode = Mode::Arming(Arming { stage, gather });
        Ok(())
    }

    /// Carries arming on as far as it goes without waiting.
    pub(super) fn poll_arming(
        &mut self,
        now: Instant,
        emit: &mut dyn FnMut(BusEvent),
    ) -> Result<(), BusError> {
        loop {
            let quiet = self.settings.quiet;
            let Mode::Arming(arming) = &mut self.mode else {
                return Ok(());
            };
            let asked = arming.gather.advance(&mut self.line, quiet, now);
            if !asked.map_err(|source| BusError::transport(&self.settings.name, source))? {
                return Ok(());
            }
            let arming = arming.clone();
            match self.judge(&arming) {
                Next::Stage(stage) => self.enter(stage, &arming, now)?,
                Next::Refuse(found) => {
                    self.refuse(found);
                    emit(BusEvent::ArmingRefused);
                    // Whatever was switched on so far must not stay so.
                    return self.release(now);
                }
                Next::Armed => {
                    self.become_armed(now);
                    emit(BusEvent::Armed);
                    return Ok(());
                }
            }
        }
    }

    /// Does the writes that a stage begins with, then asks its question.
    fn enter(&mut self, stage: Stage, arming: &Arming, now: Instant) -> Result<(), BusError> {
        let mut deaf_until = now;
        match stage {
            Stage::Settings { written } if written > 0 => deaf_until = self.write_settings(arming, now)?,
            Stage::Profile { .. } => self.write_profiles(now)?,
            Stage::Pin { .. } => self.write_pins(now)?,
            Stage::Torque { .. } => self.write_torque_on(now)?,
            _ => {}
        }
        let gather = Gather::new(&self.slots, |slot| stage.blocks(slot)).not_before(deaf_until);
        // What is measured again is measured after a silence: then nothing late can be taken for an answer.
        let again = matches!(stage, Stage::Measure { tries } | Stage::Held { tries } if tries > 0);
        let gather = if again { gather.after_silence() } else { gather };
        self.mode = Mode::Arming(Arming { stage, gather });
        Ok(())
    }

    /// The limiters start at the goals that the servos hold, at rest: the first goal changes nothing.
    fn become_armed(&mut self, now: Instant) {
        for slot in &mut self.slots {
            let limits = slot.member.limits();
            slot.limiter = slot.held_rad.and_then(|rad| Limiter::at_rest(limits, rad).ok());
        }
        self.cycle.restart(now);
        self.mode = Mode::Armed;
    }

    pub(super) fn refuse(&mut self, found: Vec<(usize, Why)>) {
        for (at, why) in found {
            if let Some(slot) = self.slots.get(at) {
                self.refusals.push(Refusal {
                    bus: self.settings.name.clone(),
                    joint: slot.member.joint().to_owned(),
                    id: slot.member.id(),
                    why,
                });
            }
        }
    }
}
