//! What arming writes, and in which order.

use super::Arming;
use super::judge::value;
use crate::clock::Instant;
use crate::servo::bus::{Bus, BusError};
use crate::servo::framing::dynamixel2;
use crate::servo::gather::Gathered;
use crate::servo::register::Field;

/// How often a setting is written before the servo is believed to refuse it.
pub(super) const WRITE_TRIES: u8 = 3;
/// Operating Mode 3: position control within one turn.
const POSITION_MODE: u8 = 3;
/// Drive Mode 0: not reversed, velocity-based profile, torque only by Torque Enable.
const PLAIN_DRIVE: u8 = 0;

impl Bus {
    pub(super) fn wanted_settings(&self) -> [(&'static str, Field, u8); 3] {
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
    pub(super) fn write_settings(&mut self, arming: &Arming, now: Instant) -> Result<(), BusError> {
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

    /// Profile Acceleration 0 (none), Profile Velocity the speed limit: a backstop that the limited goals
    /// never run into.
    pub(super) fn write_profiles(&mut self, now: Instant) -> Result<(), BusError> {
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

    /// Clears a tripped watchdog (goals are refused until then) and sets each goal to the measured position,
    /// back to back, so that a servo has no time to resume an older goal in between.
    pub(super) fn write_pins(&mut self, now: Instant) -> Result<(), BusError> {
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

    pub(super) fn write_torque_on(&mut self, now: Instant) -> Result<(), BusError> {
        let [watchdog, torque] = [self.table.watchdog.address, self.table.torque.address];
        let counts = self.settings.watchdog_counts();
        let out = self.line.packet();
        let ids = || self.slots.iter().map(|slot| slot.member.id());
        let _ = dynamixel2::sync_write(out, watchdog, ids().map(|id| (id, [counts])));
        let _ = dynamixel2::sync_write(out, torque, ids().map(|id| (id, [1])));
        self.send_unanswered(now)
    }
}
