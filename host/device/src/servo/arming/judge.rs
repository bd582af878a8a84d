//! What each stage of arming makes of the servos' answers.

use super::writes::WRITE_TRIES;
use super::{Arming, Next, Stage, Why};
use crate::servo::bus::Bus;
use crate::servo::gather::Gather;
use crate::servo::health::{faults, reported};
use device_profiles::{Role, ServoProtocol};

/// A joint that moved further than this between two looks is being moved by somebody.
const RESTLESS_RAD: f64 = 0.05;
/// A goal this near to the horn is at the horn: a count of the encoder's own, and one of rounding.
const PLACE_COUNTS: f64 = 2.5;
/// How often a joint that moves, or answers late, is measured again before arming is refused. Each time comes after a
/// silence: together half a second, in which a servo that its own watchdog has just stopped comes to rest.
const MEASURE_TRIES: u8 = 12;

type Found = Vec<(usize, Why)>;

impl Bus {
    /// The servos' answers to this stage, or everybody who refuses.
    pub(super) fn judge(&mut self, arming: &Arming) -> Next {
        let gather = &arming.gather;
        let missing = gather.missing().into_iter().map(|at| (at, Why::Missing));
        let refused = gather
            .refusals()
            .map(|(at, error, address)| (at, Why::Answer { error, address }));
        let silent: Found = missing.chain(refused).collect();
        if !silent.is_empty() {
            return Next::Refuse(silent);
        }
        match arming.stage {
            Stage::Identity => check(self.judge_identity(gather), Stage::Errors),
            Stage::Errors => check(self.judge_errors(gather), Stage::Supply),
            Stage::Supply => check(self.judge_supply(gather), Stage::Settings { written: 0 }),
            Stage::Settings { written } => self.judge_settings(gather, written),
            Stage::Range => check(self.judge_range(gather), Stage::Profile { written: 0 }),
            Stage::Profile { written } => self.judge_profile(gather, written),
            Stage::Measure { tries } => self.judge_measure(gather, tries),
            Stage::Pin { tries } => self.judge_pin(gather, tries),
            Stage::Torque { written } => self.judge_torque(gather, written),
            Stage::Held { tries } => self.judge_held(gather, tries),
        }
    }

    fn judge_identity(&mut self, gather: &Gather) -> Found {
        let mut refused = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            let servo = slot.member.servo();
            let found = slot.table.model.and_then(|row| gather.value(at, row));
            let expected = i64::from(servo.model_number);
            let firmware = slot.table.firmware.and_then(|row| gather.value(at, row));
            slot.firmware = firmware.map(|firmware| firmware as u8);
            let needed = servo.bus_watchdog_from_firmware.unwrap_or(0);
            if let Some(found) = found.filter(|found| *found != expected) {
                refused.push((at, Why::Model { expected, found }));
            } else if let Some(found) = firmware.filter(|own| *own < i64::from(needed)) {
                refused.push((at, Why::Firmware { needed, found }));
            }
        }
        for company in &mut self.companies {
            company.fast.possible = self.settings.fast_reads && company.can_be_fast(&self.slots);
        }
        refused
    }

    fn judge_errors(&mut self, gather: &Gather) -> Found {
        let mut refused = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            let raw = slot
                .table
                .error
                .and_then(|row| gather.value(at, row))
                .unwrap_or(0);
            let bits = faults(slot.member.servo(), raw as u8);
            slot.supply.error_bits = bits;
            if bits != 0 {
                refused.push((at, Why::HardwareError { bits }));
            }
        }
        refused
    }

    fn judge_supply(&mut self, gather: &Gather) -> Found {
        let limit_c = self.settings.hot_c;
        let mut refused = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            for row in [slot.table.voltage, slot.table.temperature].into_iter().flatten() {
                if let Some(answer) = gather.holding(at, row) {
                    slot.take_supply(answer.bytes(), answer.address);
                    // Where no register tells, the answers do.
                    let bits = reported(slot.member.servo(), answer.error).unwrap_or(0);
                    if slot.table.error.is_none() && bits != 0 {
                        slot.supply.error_bits = bits;
                        refused.push((at, Why::HardwareError { bits }));
                        break;
                    }
                }
            }
            match slot.supply.temperature_c {
                Some(temperature_c) if temperature_c >= limit_c => {
                    refused.push((
                        at,
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

    fn judge_settings(&mut self, gather: &Gather, written: u8) -> Next {
        let mut different = Vec::new();
        for (at, slot) in self.slots.iter().enumerate() {
            for setting in self.wanted_settings(slot) {
                let (register, wanted) = (setting.role, setting.wanted);
                if let Some(found) = gather.value(at, setting.row).filter(|found| *found != wanted) {
                    different.push((
                        at,
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
            // Servos without the register have their own delay, which nobody knows.
            if self.slots.iter().all(|slot| slot.table.return_delay.is_some()) {
                let delay = self.settings.return_delay();
                self.line.set_return_delay(delay);
            }
            Next::Stage(Stage::Range)
        } else if written >= WRITE_TRIES {
            Next::Refuse(different)
        } else {
            Next::Stage(Stage::Settings { written: written + 1 })
        }
    }

    fn judge_range(&mut self, gather: &Gather) -> Found {
        let mut refused = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            let value = |row: Option<_>| row.and_then(|row| gather.value(at, row));
            let (Some(found_min), Some(found_max)) =
                (value(slot.table.position_min), value(slot.table.position_max))
            else {
                continue;
            };
            let feetech = matches!(slot.table.protocol, ServoProtocol::Sts | ServoProtocol::Scs);
            if feetech && found_min == 0 && found_max == 0 {
                // Both zero: no limits (users' tables).
                continue;
            }
            let [needed_min, needed_max] = slot.member.range_counts();
            slot.accepts = Some([found_min, found_max]);
            if needed_min < found_min || needed_max > found_max {
                refused.push((
                    at,
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

    fn judge_profile(&self, gather: &Gather, written: u8) -> Next {
        let mut different = Vec::new();
        for (at, slot) in self.slots.iter().enumerate() {
            let Some(speed) = slot.table.speed else { continue };
            let wanted = slot.member.speed_counts(speed);
            if let Some(found) = gather.value(at, speed).filter(|found| *found != wanted) {
                let register = Role::ProfileVelocity;
                different.push((
                    at,
                    Why::Setting {
                        register,
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

    fn judge_measure(&mut self, gather: &Gather, tries: u8) -> Next {
        let mut refused = Vec::new();
        let mut late = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            let answer = gather.holding(at, slot.table.position);
            let Some(reading) = answer.and_then(|answer| slot.fresh_reading(answer)) else {
                late.push((at, Why::Late));
                continue;
            };
            let [min, max] = slot.accepts.unwrap_or(slot.member.servo().position_counts);
            let counts = reading.position_counts;
            if counts < min || counts > max {
                refused.push((at, Why::Outside { counts, min, max }));
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

    fn judge_pin(&mut self, gather: &Gather, tries: u8) -> Next {
        let mut unpinned = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            let goal = gather.value(at, slot.table.goal);
            let answer = gather.holding(at, slot.table.position);
            let reading = answer.and_then(|answer| slot.fresh_reading(answer));
            let (Some(pin), Some(reading), Some(found)) = (slot.pin, reading, goal) else {
                unpinned.push((at, Why::Late));
                continue;
            };
            let goal_rad = slot.member.position_rad(found);
            // The goal must be what was written, or where the horn is: some firmware lets it follow the horn while
            // torque is off. One that is merely near is an older goal whose overwriting was lost, and would be leapt to.
            let near_rad = PLACE_COUNTS * slot.member.servo().rad_per_count();
            let in_place =
                found == pin.position_counts || (reading.position_rad - goal_rad).abs() <= near_rad;
            if (reading.position_rad - pin.position_rad).abs() > RESTLESS_RAD {
                unpinned.push((at, Why::Restless));
            } else if !in_place {
                let (register, wanted) = (Role::GoalPosition, pin.position_counts);
                unpinned.push((
                    at,
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

    fn judge_torque(&mut self, gather: &Gather, written: u8) -> Next {
        let mut off = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            let found = gather.value(at, slot.table.torque).unwrap_or_default();
            slot.supply.torque = Some(found == 1);
            if found != 1 {
                let register = Role::TorqueEnable;
                off.push((
                    at,
                    Why::Setting {
                        register,
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
    fn judge_held(&mut self, gather: &Gather, tries: u8) -> Next {
        let mut away = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            let goal = gather.value(at, slot.table.goal);
            let answer = gather.holding(at, slot.table.position);
            let reading = answer.and_then(|answer| slot.fresh_reading(answer));
            let (Some(goal), Some(reading)) = (goal, reading) else {
                away.push((at, Why::Late));
                continue;
            };
            let goal_rad = slot.member.position_rad(goal);
            if (reading.position_rad - goal_rad).abs() > 2.0 * RESTLESS_RAD {
                away.push((at, Why::Restless));
            } else {
                slot.held_rad = Some(goal_rad);
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

fn check(refused: Found, next: Stage) -> Next {
    if refused.is_empty() {
        Next::Stage(next)
    } else {
        Next::Refuse(refused)
    }
}
