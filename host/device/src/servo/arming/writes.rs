//! What arming writes, and in which order.

use super::Arming;
use crate::clock::Instant;
use crate::servo::bus::{Bus, BusError};
use crate::servo::register::Field;
use crate::servo::slot::Slot;
use device_profiles::{Role, ServoProtocol};
use std::time::Duration;

/// How often a setting is written before the servo is believed to refuse it.
pub(super) const WRITE_TRIES: u8 = 3;
/// Operating Mode of the X series and MX(2.0): position control within one turn (e-manual).
const POSITION_MODE_X: i64 = 3;
/// Control Mode of the XL-320, whose modes are 1 and 2 (e-manual).
const JOINT_MODE_XL320: i64 = 2;
/// Operating mode of STS: position (users' tables).
const POSITION_MODE_STS: i64 = 0;
/// Drive Mode 0: not reversed, velocity-based profile, torque only by Torque Enable.
const PLAIN_DRIVE: i64 = 0;
/// Feetech's lock: 0 lets what is written to the EEPROM stay, 1 does not.
const UNLOCKED: i64 = 0;
/// See [`UNLOCKED`].
const LOCKED: i64 = 1;

/// A setting that must hold while the bus is driven.
#[derive(Debug, Clone, Copy)]
pub(super) struct Setting {
    pub(super) role: Role,
    pub(super) row: Field,
    pub(super) wanted: i64,
}

impl Bus {
    /// The settings that a servo has and must have right.
    pub(super) fn wanted_settings(&self, slot: &Slot) -> Vec<Setting> {
        let table = &slot.table;
        let delay = self.settings.return_delay_counts;
        let wanted = [
            (Role::ReturnDelay, table.return_delay, i64::from(delay)),
            (Role::DriveMode, table.drive_mode, PLAIN_DRIVE),
            (Role::OperatingMode, table.operating_mode, position_mode(slot)),
        ];
        let there = wanted.into_iter().filter_map(|(role, row, wanted)| {
            Some(Setting {
                role,
                row: row?,
                wanted,
            })
        });
        there.collect()
    }

    /// EEPROM is worn by writing and locked while torque is on: only what differs, with torque off there first, and
    /// unlocked for so long where there is a lock. Gives when the servos hear again.
    pub(super) fn write_settings(&mut self, arming: &Arming, now: Instant) -> Result<Instant, BusError> {
        let differs = |(member, slot): (usize, &Slot)| {
            let mut wanted = self.wanted_settings(slot);
            wanted.retain(|setting| arming.gather.value(member, setting.row) != Some(setting.wanted));
            (slot.member.id(), wanted)
        };
        let differing: Vec<(u8, Vec<Setting>)> = self.slots.iter().enumerate().map(differs).collect();
        let settings = |slot: &Slot| {
            let found = differing.iter().find(|(id, _)| *id == slot.member.id());
            found.map_or(&[][..], |(_, settings)| settings.as_slice())
        };
        let changes = |slot: &Slot| !settings(slot).is_empty();
        // Only Feetech's lock is undone by writing; that of the AX lasts until power is cut.
        let lock = |slot: &Slot| {
            let feetech = matches!(slot.table.protocol, ServoProtocol::Sts | ServoProtocol::Scs);
            slot.table.lock.filter(|_| feetech && changes(slot))
        };
        self.line.packet();
        self.append_writes(&|slot| changes(slot).then_some((slot.table.torque, 0)));
        self.append_writes(&|slot| Some((lock(slot)?, UNLOCKED)));
        let most = differing
            .iter()
            .map(|(_, settings)| settings.len())
            .max()
            .unwrap_or(0);
        for at in 0..most {
            self.append_writes(&|slot| {
                settings(slot)
                    .get(at)
                    .map(|setting| (setting.row, setting.wanted))
            });
        }
        self.append_writes(&|slot| Some((lock(slot)?, LOCKED)));
        let deaf = self.slots.iter().filter(|slot| changes(slot)).filter_map(|slot| {
            let bytes: u32 = settings(slot)
                .iter()
                .map(|setting| u32::from(setting.row.size))
                .sum();
            Some(bytes * slot.member.servo().eeprom_deaf_us_per_byte?)
        });
        let deaf = Duration::from_micros(deaf.max().unwrap_or(0).into());
        self.send_unanswered(now)?;
        Ok(now.after(deaf))
    }

    /// No acceleration of its own, the speed limit as speed: a backstop that the limited goals never run into.
    pub(super) fn write_profiles(&mut self, now: Instant) -> Result<(), BusError> {
        self.line.packet();
        self.append_writes(&|slot| Some((slot.table.acceleration?, 0)));
        self.append_writes(&|slot| Some((slot.table.goal_time?, 0)));
        self.append_writes(&|slot| {
            let speed = slot.table.speed?;
            Some((speed, slot.member.speed_counts(speed)))
        });
        self.send_unanswered(now)
    }

    /// Clears a tripped watchdog (goals are refused until then) and sets each goal to the measured position,
    /// back to back, so that a servo has no time to resume an older goal in between.
    pub(super) fn write_pins(&mut self, now: Instant) -> Result<(), BusError> {
        self.line.packet();
        self.append_writes(&|slot| Some((slot.table.watchdog?, 0)));
        self.append_writes(&|slot| Some((slot.table.goal, slot.pin?.position_counts)));
        self.send_unanswered(now)
    }

    pub(super) fn write_torque_on(&mut self, now: Instant) -> Result<(), BusError> {
        let counts = i64::from(self.settings.watchdog_counts());
        self.line.packet();
        self.append_writes(&|slot| Some((slot.table.watchdog?, counts)));
        self.append_writes(&|slot| Some((slot.table.torque, 1)));
        self.send_unanswered(now)
    }
}

/// What the register for the operating mode holds when positions are goals.
fn position_mode(slot: &Slot) -> i64 {
    let row = slot.member.servo().role(Role::OperatingMode);
    let takes = |mode: i64| {
        row.is_some_and(|row| {
            let listed = row.values.is_empty() || row.values.contains(&mode);
            listed && row.max.is_none_or(|max| mode <= max)
        })
    };
    match slot.table.protocol {
        ServoProtocol::Dynamixel2 if takes(POSITION_MODE_X) => POSITION_MODE_X,
        ServoProtocol::Dynamixel2 => JOINT_MODE_XL320,
        _ => POSITION_MODE_STS,
    }
}
