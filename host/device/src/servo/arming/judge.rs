//! What each stage of arming makes of the servos' answers.

use super::writes::WRITE_TRIES;
use super::{Arming, Next, Stage, Why};
use crate::servo::bus::Bus;
use crate::servo::gather::Gathered;
use crate::servo::register::Field;
use crate::servo::table::Block;

/// A joint that moved further than this between two looks is being moved by somebody.
const RESTLESS_RAD: f64 = 0.05;
/// How often a joint that moves, or answers late, is measured again before arming is refused. Each time comes after a
/// silence: together half a second, in which a servo that its own watchdog has just stopped comes to rest.
const MEASURE_TRIES: u8 = 12;

impl Bus {
    /// The servos' answers to this stage, or everybody who refuses.
    pub(super) fn judge(&mut self, arming: &Arming) -> Next {
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
                            error: answer.error,
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
            Stage::Measure { tries } => self.judge_measure(&answers, block, tries),
            Stage::Pin { tries } => self.judge_pin(&answers, block, tries),
            Stage::Torque { written } => self.judge_torque(&answers, block, written),
            Stage::Held { tries } => self.judge_held(&answers, block, tries),
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

    fn judge_measure(&mut self, answers: &[(usize, Gathered)], block: Block, tries: u8) -> Next {
        let mut refused = Vec::new();
        let mut late = Vec::new();
        for (at, answer) in answers {
            let Some(slot) = self.slots.get_mut(*at) else {
                continue;
            };
            let Some(reading) = slot.fresh_reading(answer, block.address) else {
                late.push((*at, Why::Late));
                continue;
            };
            let [min, max] = slot.accepts.unwrap_or(slot.member.servo().position_counts);
            let counts = reading.position_counts;
            if counts < min || counts > max {
                refused.push((*at, Why::Outside { counts, min, max }));
            }
            slot.pin = Some(reading);
        }
        if !refused.is_empty() {
            Next::Refuse(refused)
        } else if late.is_empty() {
            Next::Stage(Stage::Pin { tries })
        } else if tries < MEASURE_TRIES {
            Next::Stage(Stage::Measure { tries: tries + 1 })
        } else {
            Next::Refuse(late)
        }
    }

    fn judge_pin(&mut self, answers: &[(usize, Gathered)], block: Block, tries: u8) -> Next {
        let mut unpinned = Vec::new();
        for (at, answer) in answers {
            let Some(slot) = self.slots.get_mut(*at) else {
                continue;
            };
            let found = value(self.table.goal, answer, block);
            let goal_rad = slot.member.position_rad(found);
            let reading = slot.fresh_reading(answer, block.address);
            let Some((pin, reading)) = slot.pin.zip(reading) else {
                unpinned.push((*at, Why::Late));
                continue;
            };
            // Some firmware lets the goal follow the horn while torque is off, so the goal must be where the
            // horn is, not to the count what was written.
            if (reading.position_rad - pin.position_rad).abs() > RESTLESS_RAD {
                unpinned.push((*at, Why::Restless));
            } else if (reading.position_rad - goal_rad).abs() > RESTLESS_RAD {
                let (register, wanted) = ("Goal Position", pin.position_counts);
                unpinned.push((
                    *at,
                    Why::Setting {
                        register,
                        wanted,
                        found,
                    },
                ));
            }
        }
        if unpinned.is_empty() {
            Next::Stage(Stage::Torque { written: 0 })
        } else if tries < MEASURE_TRIES {
            Next::Stage(Stage::Measure { tries: tries + 1 })
        } else {
            Next::Refuse(unpinned)
        }
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
            Next::Stage(Stage::Held { tries: 0 })
        } else if written < WRITE_TRIES {
            Next::Stage(Stage::Torque { written: written + 1 })
        } else {
            Next::Refuse(off)
        }
    }

    /// With torque on each goal must be where the joint is; it is where the limiter starts.
    fn judge_held(&mut self, answers: &[(usize, Gathered)], block: Block, tries: u8) -> Next {
        let mut away = Vec::new();
        for (at, answer) in answers {
            let Some(slot) = self.slots.get_mut(*at) else {
                continue;
            };
            let goal_rad = slot.member.position_rad(value(self.table.goal, answer, block));
            let reading = slot.fresh_reading(answer, block.address);
            match reading {
                None => away.push((*at, Why::Late)),
                Some(reading) if (reading.position_rad - goal_rad).abs() > 2.0 * RESTLESS_RAD => {
                    away.push((*at, Why::Restless));
                }
                Some(_) => slot.held_rad = Some(goal_rad),
            }
        }
        if away.is_empty() {
            Next::Armed
        } else if tries < MEASURE_TRIES {
            Next::Stage(Stage::Held { tries: tries + 1 })
        } else {
            Next::Refuse(away)
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
pub(super) fn value(field: Field, answer: &Gathered, block: Block) -> i64 {
    field.get(answer.bytes(), block.address).unwrap_or_default()
}
