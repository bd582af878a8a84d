//! From servos in any state to servos that hold exactly where they are.
//!
//! The order is the point: everything is read before anything is written, settings are changed only where they
//! differ and only with torque off, the goal is set to the measured position and read back before torque goes
//! on, and the Bus Watchdog is armed with it, so that servos stop by themselves when the host is gone.
//! Sync writes are unanswered, so each write is proved by reading back; that also keeps a late answer from
//! being taken for an acknowledgement.
//!
//! Source: e-manual, "Control Table of EEPROM Area" (locked while torque is on), "Bus Watchdog (98)"; users'
//! reports of first-frame lunges, `docs/protocols/dynamixel2.md`.

use super::bus::{Bus, BusError, BusEvent, Mode};
use super::framing::dynamixel2;
use super::gather::{Gather, Gathered};
use super::limit::Limiter;
use super::member::error_names;
use super::register::Field;
use super::table::Block;
use crate::clock::Instant;

/// A joint that moved further than this between measuring and reading back is being moved by somebody.
const RESTLESS_RAD: f64 = 0.05;
/// How often a moving joint is measured again before arming is refused.
const MEASURE_TRIES: u8 = 8;
/// How often a setting is written before the servo is believed to refuse it.
const WRITE_TRIES: u8 = 3;
/// Operating Mode 3: position control within one turn.
const POSITION_MODE: u8 = 3;
/// Drive Mode 0: not reversed, velocity-based profile, torque only by Torque Enable.
const PLAIN_DRIVE: u8 = 0;

/// Why one servo cannot be armed, and what to do about it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("bus \"{bus}\", joint \"{joint}\", servo {id}: {why}")]
pub struct Refusal {
    /// The bus's name.
    pub bus: String,
    /// The joint's name.
    pub joint: String,
    /// The servo's id.
    pub id: u8,
    /// What is wrong and what helps.
    pub why: Why,
}

/// What is wrong with a servo that cannot be armed, or released.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Why {
    /// It did not answer, asked together with the others and alone.
    #[error(
        "does not answer; check its cable and power first, then its id and baud rate (`dialrig servo scan`)"
    )]
    Missing,
    /// Another model answers.
    #[error("is model {found}, the puppet expects {expected}; correct the puppet file or swap the servo")]
    Model {
        /// Model Number in the profile.
        expected: i64,
        /// Model Number read.
        found: i64,
    },
    /// Without Bus Watchdog a servo would run on when the host dies.
    #[error(
        "has firmware {found}; the Bus Watchdog needs {needed} or later: update it with the maker's tool"
    )]
    Firmware {
        /// First firmware that will do.
        needed: u8,
        /// Firmware Version read.
        found: i64,
    },
    /// A hardware error is latched.
    #[error("has a latched hardware error ({}); remove the cause, then reboot it (`dialrig servo doctor`)", error_names(*bits))]
    HardwareError {
        /// Hardware Error Status.
        bits: u8,
    },
    /// Too warm to start.
    #[error("is at {temperature_c} C, the limit is {limit_c} C; let it cool down")]
    Hot {
        /// Present Temperature.
        temperature_c: f64,
        /// The bus's limit.
        limit_c: f64,
    },
    /// It answered an instruction with an error.
    #[error("answered \"{error}\" to reading address {address}; check model and firmware")]
    Answer {
        /// The e-manual's name of the error.
        error: &'static str,
        /// First byte read.
        address: u16,
    },
    /// A setting reads differently from what was written.
    #[error("keeps \"{register}\" at {found} instead of {wanted}; power it off and on, and try again")]
    Setting {
        /// The row.
        register: &'static str,
        /// What was written.
        wanted: i64,
        /// What was read.
        found: i64,
    },
    /// The servo's own limits are narrower than the joint's range.
    #[error(
        "limits positions to {found_min} to {found_max} counts, the joint needs {needed_min} to {needed_max}; \
         widen \"Min/Max Position Limit\" or narrow the joint's range"
    )]
    Range {
        /// Min Position Limit read.
        found_min: i64,
        /// Max Position Limit read.
        found_max: i64,
        /// Lowest count of the joint's range.
        needed_min: i64,
        /// Highest count of the joint's range.
        needed_max: i64,
    },
    /// Its position cannot be a goal, so it cannot be held where it is.
    #[error(
        "stands at {counts} counts, outside the positions it accepts ({min} to {max}); turn it back by hand"
    )]
    Outside {
        /// Present Position.
        counts: i64,
        /// Min Position Limit.
        min: i64,
        /// Max Position Limit.
        max: i64,
    },
    /// It does not stand still.
    #[error("is moving; hold it still while arming")]
    Restless,
    /// Torque is still on after it was switched off several times.
    #[error("still has torque after it was switched off; cut its power")]
    StillOn,
}

/// How far arming has come. Each stage begins with its writes, gathers a block, and judges it.
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
}

/// Arming under way.
#[derive(Debug, Clone)]
pub(super) struct Arming {
    pub(super) stage: Stage,
    pub(super) gather: Gather,
    /// Min and Max Position Limit of each member; none until read.
    pub(super) range: Vec<Option<[i64; 2]>>,
}

/// What follows from a stage's answers.
enum Next {
    Stage(Stage),
    Refuse(Vec<(usize, Why)>),
    Armed,
}

impl Arming {
    pub(super) fn begin(stage: Stage, block: Block, ids: Vec<u8>) -> Self {
        let range = vec![None; ids.len()];
        Self {
            stage,
            gather: Gather::new(block, ids).after_silence(),
            range,
        }
    }
}

impl Bus {
    /// Begins to read, configure, pin and switch on all members; [`Bus::poll`] carries it on, and
    /// [`Bus::armed`] tells how far it is. Nothing moves: the first goals are the measured positions.
    /// Refused as a whole when one member cannot be armed; [`Bus::refusals`] says why.
    pub fn begin_arming(&mut self, now: Instant) -> Result<(), BusError> {
        self.begin_stage(Stage::Identity, now)
    }

    /// As arming, but for members that were armed already: measures, pins, clears and re-arms the watchdog.
    pub(super) fn begin_pinning(&mut self, now: Instant) -> Result<(), BusError> {
        let known: Vec<Option<[i64; 2]>> = self.slots.iter().map(|slot| slot.accepts).collect();
        self.begin_stage(Stage::Measure { tries: 0 }, now)?;
        if let Mode::Arming(arming) = &mut self.mode {
            arming.range = known;
        }
        Ok(())
    }

    fn begin_stage(&mut self, stage: Stage, now: Instant) -> Result<(), BusError> {
        self.refusals.clear();
        self.drain(now)?;
        for slot in &mut self.slots {
            slot.limiter = None;
        }
        let block = self.stage_block(stage);
        self.mode = Mode::Arming(Arming::begin(stage, block, self.ids()));
        Ok(())
    }

    fn stage_block(&self, stage: Stage) -> Block {
        match stage {
            Stage::Identity => self.table.identity,
            Stage::Errors => self.table.error_block,
            Stage::Supply => self.table.supply,
            Stage::Settings { .. } => self.table.settings,
            Stage::Range => self.table.range,
            Stage::Profile { .. } => self.table.profile,
            Stage::Measure { .. } => self.table.status,
            Stage::Pin { .. } => self.table.goal_and_status,
            Stage::Torque { .. } => self.table.torque_block,
        }
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
                Next::Stage(stage) => self.enter(stage, arming, now)?,
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
    fn enter(&mut self, stage: Stage, arming: Arming, now: Instant) -> Result<(), BusError> {
        match stage {
            Stage::Settings { written } if written > 0 => self.write_settings(&arming, now)?,
            Stage::Profile { .. } => self.write_profiles(now)?,
            Stage::Pin { .. } => self.write_pins(now)?,
            Stage::Torque { .. } => self.write_torque_on(now)?,
            _ => {}
        }
        let gather = Gather::new(self.stage_block(stage), self.ids());
        self.mode = Mode::Arming(Arming {
            stage,
            gather,
            range: arming.range,
        });
        Ok(())
    }

    /// The servos' answers to this stage, or everybody who refuses.
    fn judge(&mut self, arming: &Arming) -> Next {
        let block = arming.gather.block();
        let mut refused = Vec::new();
        let mut answers = Vec::new();
        for (at, answer) in arming.gather.answers().iter().enumerate() {
            match answer {
                None => refused.push((at, Why::Missing)),
                Some(answer) if answer.error.number() != 0 => {
                    refused.push((
                        at,
                        Why::Answer {
                            error: answer.error.name(),
                            address: block.address,
                        },
                    ));
                }
                Some(answer) => answers.push((at, *answer)),
            }
        }
        if !refused.is_empty() {
            return Next::Refuse(refused);
        }
        match arming.stage {
            Stage::Identity => check(self.judge_identity(&answers, block), Stage::Errors),
            Stage::Errors => check(self.judge_errors(&answers, block), Stage::Supply),
            Stage::Supply => check(self.judge_supply(&answers, block), Stage::Settings { written: 0 }),
            Stage::Settings { written } => self.judge_settings(&answers, block, written),
            Stage::Range => check(self.judge_range(&answers, block), Stage::Profile { written: 0 }),
            Stage::Profile { written } => self.judge_profile(&answers, block, written),
            Stage::Measure { tries } => self.judge_measure(&answers, block, tries, &arming.range),
            Stage::Pin { tries } => self.judge_pin(&answers, block, tries),
            Stage::Torque { written } => self.judge_torque(&answers, block, written),
        }
    }

    fn judge_identity(&self, answers: &[(usize, Gathered)], block: Block) -> Vec<(usize, Why)> {
        let mut refused = Vec::new();
        for (at, answer) in answers {
            let Some(slot) = self.slots.get(*at) else { continue };
            let servo = slot.member.servo();
            let found = value(self.table.model, answer, block);
            let expected = i64::from(servo.model_number);
            let firmware = value(self.table.firmware, answer, block);
            if found != expected {
                refused.push((*at, Why::Model { expected, found }));
            } else if servo
                .bus_watchdog_from_firmware
                .is_none_or(|needed| firmware < i64::from(needed))
            {
                let needed = servo.bus_watchdog_from_firmware.unwrap_or(u8::MAX);
                refused.push((
                    *at,
                    Why::Firmware {
                        needed,
                        found: firmware,
                    },
                ));
            }
        }
        refused
    }

    fn judge_errors(&mut self, answers: &[(usize, Gathered)], block: Block) -> Vec<(usize, Why)> {
        let mut refused = Vec::new();
        for (at, answer) in answers {
            let bits = value(self.table.error, answer, block) as u8;
            if let Some(slot) = self.slots.get_mut(*at) {
                slot.supply.error_bits = bits;
            }
            if bits != 0 {
                refused.push((*at, Why::HardwareError { bits }));
            }
        }
        refused
    }

    fn judge_supply(&mut self, answers: &[(usize, Gathered)], block: Block) -> Vec<(usize, Why)> {
        let limit_c = self.settings.hot_c;
        let mut refused = Vec::new();
        for (at, answer) in answers {
            let Some(slot) = self.slots.get_mut(*at) else {
                continue;
            };
            slot.take_supply(answer.bytes(), block.address);
            match slot.supply.temperature_c {
                Some(temperature_c) if temperature_c >= limit_c => {
                    refused.push((
                        *at,
                        Why::Hot {
                            temperature_c,
                            limit_c,
                        },
                    ));
                }
                _ => {}
            }
        }
        refused
    }

    fn judge_settings(&mut self, answers: &[(usize, Gathered)], block: Block, written: u8) -> Next {
        let mut different = Vec::new();
        for (register, field, wanted) in self.wanted_settings() {
            for (at, answer) in answers {
                let found = value(field, answer, block);
                if found != i64::from(wanted) {
                    let wanted = i64::from(wanted);
                    different.push((
                        *at,
                        Why::Setting {
                            register,
                            wanted,
                            found,
                        },
                    ));
                }
            }
        }
        if different.is_empty() {
            let delay = self.settings.return_delay();
            self.line.set_return_delay(delay);
            Next::Stage(Stage::Range)
        } else if written >= WRITE_TRIES {
            Next::Refuse(different)
        } else {
            Next::Stage(Stage::Settings { written: written + 1 })
        }
    }

    fn wanted_settings(&self) -> [(&'static str, Field, u8); 3] {
        [
            (
                "Return Delay Time",
                self.table.return_delay,
                self.settings.return_delay_counts,
            ),
            ("Drive Mode", self.table.drive_mode, PLAIN_DRIVE),
            ("Operating Mode", self.table.operating_mode, POSITION_MODE),
        ]
    }

    /// EEPROM is worn by writing and locked while torque is on: only what differs, and torque off there first.
    fn write_settings(&mut self, arming: &Arming, now: Instant) -> Result<(), BusError> {
        let block = arming.gather.block();
        let wanted = self.wanted_settings();
        let differs = |answer: &Option<Gathered>, field: Field, wanted: u8| {
            answer.is_some_and(|answer| value(field, &answer, block) != i64::from(wanted))
        };
        let answers = || arming.gather.answers().iter().zip(&self.slots);
        let torque = self.table.torque.address;
        let out = self.line.packet();
        let off =
            answers().filter(|(answer, _)| wanted.iter().any(|(_, field, to)| differs(answer, *field, *to)));
        // Packets of this size cannot be too long: at most 253 ids with a byte each.
        let _ = dynamixel2::sync_write(out, torque, off.map(|(_, slot)| (slot.member.id(), [0])));
        for (_, field, to) in wanted {
            let there = answers().filter(|(answer, _)| differs(answer, field, to));
            let items: Vec<(u8, [u8; 1])> = there.map(|(_, slot)| (slot.member.id(), [to])).collect();
            if !items.is_empty() {
                let _ = dynamixel2::sync_write(out, field.address, items);
            }
        }
        self.send_unanswered(now)
    }

    fn judge_range(&mut self, answers: &[(usize, Gathered)], block: Block) -> Vec<(usize, Why)> {
        let mut refused = Vec::new();
        for (at, answer) in answers {
            let Some(slot) = self.slots.get_mut(*at) else {
                continue;
            };
            let found_min = value(self.table.position_min, answer, block);
            let found_max = value(self.table.position_max, answer, block);
            let [needed_min, needed_max] = slot.member.range_counts();
            slot.accepts = Some([found_min, found_max]);
            if needed_min < found_min || needed_max > found_max {
                refused.push((
                    *at,
                    Why::Range {
                        found_min,
                        found_max,
                        needed_min,
                        needed_max,
                    },
                ));
            }
        }
        refused
    }

    /// Profile Acceleration 0 (none), Profile Velocity the speed limit: a backstop that the limited goals
    /// never run into.
    fn write_profiles(&mut self, now: Instant) -> Result<(), BusError> {
        let [acceleration, velocity] = [
            self.table.profile_acceleration.address,
            self.table.profile_velocity.address,
        ];
        let out = self.line.packet();
        let members = || self.slots.iter().map(|slot| &slot.member);
        let _ = dynamixel2::sync_write(out, acceleration, members().map(|member| (member.id(), [0; 4])));
        let velocities =
            members().map(|member| (member.id(), member.profile_velocity_counts().to_le_bytes()));
        let _ = dynamixel2::sync_write(out, velocity, velocities);
        self.send_unanswered(now)
    }

    fn judge_profile(&self, answers: &[(usize, Gathered)], block: Block, written: u8) -> Next {
        let mut different = Vec::new();
        for (at, answer) in answers {
            let Some(slot) = self.slots.get(*at) else { continue };
            let wanted = i64::from(slot.member.profile_velocity_counts());
            let found = value(self.table.profile_velocity, answer, block);
            if found != wanted {
                different.push((
                    *at,
                    Why::Setting {
                        register: "Profile Velocity",
                        wanted,
                        found,
                    },
                ));
            }
        }
        match (different.is_empty(), written) {
            (true, _) => Next::Stage(Stage::Measure { tries: 0 }),
            (false, written) if written < WRITE_TRIES => Next::Stage(Stage::Profile { written: written + 1 }),
            (false, _) => Next::Refuse(different),
        }
    }

    fn judge_measure(
        &mut self,
        answers: &[(usize, Gathered)],
        block: Block,
        tries: u8,
        ranges: &[Option<[i64; 2]>],
    ) -> Next {
        let mut refused = Vec::new();
        let mut again = false;
        for (at, answer) in answers {
            let Some(slot) = self.slots.get_mut(*at) else {
                continue;
            };
            let Some(reading) = slot.fresh_reading(answer, block.address) else {
                again = true;
                continue;
            };
            let turn = i64::from(slot.member.servo().counts_per_turn);
            let [min, max] = ranges.get(*at).copied().flatten().unwrap_or([0, turn - 1]);
            let counts = reading.position_counts;
            if counts < min || counts > max {
                refused.push((*at, Why::Outside { counts, min, max }));
            }
            slot.pin = Some(reading);
        }
        if !refused.is_empty() {
            Next::Refuse(refused)
        } else if !again {
            Next::Stage(Stage::Pin { tries })
        } else if tries < MEASURE_TRIES {
            Next::Stage(Stage::Measure { tries: tries + 1 })
        } else {
            Next::Refuse(answers.iter().map(|(at, _)| (*at, Why::Restless)).collect())
        }
    }

    /// Clears a tripped watchdog (goals are refused until then) and sets each goal to the measured position,
    /// back to back, so that a servo has no time to resume an older goal in between.
    fn write_pins(&mut self, now: Instant) -> Result<(), BusError> {
        let [watchdog, goal] = [self.table.watchdog.address, self.table.goal.address];
        let out = self.line.packet();
        let _ = dynamixel2::sync_write(
            out,
            watchdog,
            self.slots.iter().map(|slot| (slot.member.id(), [0])),
        );
        let pins = self.slots.iter().filter_map(|slot| {
            let pin = slot.pin?;
            Some((slot.member.id(), (pin.position_counts as u32).to_le_bytes()))
        });
        let _ = dynamixel2::sync_write(out, goal, pins);
        self.send_unanswered(now)
    }

    fn judge_pin(&mut self, answers: &[(usize, Gathered)], block: Block, tries: u8) -> Next {
        let mut restless = Vec::new();
        for (at, answer) in answers {
            let Some(slot) = self.slots.get_mut(*at) else {
                continue;
            };
            let goal = value(self.table.goal, answer, block);
            let reading = slot.fresh_reading(answer, block.address);
            let holds = slot.pin.zip(reading).is_some_and(|(pin, reading)| {
                goal == pin.position_counts && (reading.position_rad - pin.position_rad).abs() <= RESTLESS_RAD
            });
            if !holds {
                restless.push((*at, Why::Restless));
            }
        }
        if restless.is_empty() {
            Next::Stage(Stage::Torque { written: 0 })
        } else if tries < MEASURE_TRIES {
            Next::Stage(Stage::Measure { tries: tries + 1 })
        } else {
            Next::Refuse(restless)
        }
    }

    fn write_torque_on(&mut self, now: Instant) -> Result<(), BusError> {
        let [watchdog, torque] = [self.table.watchdog.address, self.table.torque.address];
        let counts = self.settings.watchdog_counts();
        let out = self.line.packet();
        let ids = || self.slots.iter().map(|slot| slot.member.id());
        let _ = dynamixel2::sync_write(out, watchdog, ids().map(|id| (id, [counts])));
        let _ = dynamixel2::sync_write(out, torque, ids().map(|id| (id, [1])));
        self.send_unanswered(now)
    }

    fn judge_torque(&mut self, answers: &[(usize, Gathered)], block: Block, written: u8) -> Next {
        let mut off = Vec::new();
        for (at, answer) in answers {
            let found = value(self.table.torque, answer, block);
            if let Some(slot) = self.slots.get_mut(*at) {
                slot.supply.torque = Some(found == 1);
            }
            if found != 1 {
                off.push((
                    *at,
                    Why::Setting {
                        register: "Torque Enable",
                        wanted: 1,
                        found,
                    },
                ));
            }
        }
        if off.is_empty() {
            Next::Armed
        } else if written < WRITE_TRIES {
            Next::Stage(Stage::Torque { written: written + 1 })
        } else {
            Next::Refuse(off)
        }
    }

    /// The limiters start where the goals were pinned, at rest.
    fn become_armed(&mut self, now: Instant) {
        for slot in &mut self.slots {
            let pinned = slot.pin.map(|pin| pin.position_rad);
            slot.limiter = pinned.and_then(|rad| Limiter::at_rest(slot.member.limits(), rad).ok());
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

fn check(refused: Vec<(usize, Why)>, next: Stage) -> Next {
    if refused.is_empty() {
        Next::Stage(next)
    } else {
        Next::Refuse(refused)
    }
}

/// A field of an answer that has the block's length; the line hands out no other.
fn value(field: Field, answer: &Gathered, block: Block) -> i64 {
    field.get(answer.bytes(), block.address).unwrap_or_default()
}
