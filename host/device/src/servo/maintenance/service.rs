//! Instructions that no register stands for: reboot, factory reset, clear, backup.

use super::find::Found;
use super::{Maintenance, MaintenanceError, is_feetech};
use crate::clock::Clock;
use crate::servo::framing::{self, Backup, FramingError, Keep};
use device_profiles::{Role, ServoProfile, ServoProtocol};
use std::time::Duration;

/// A Dynamixel is back after a reboot within this time.
const REBOOT: Duration = Duration::from_millis(600);
/// A Feetech within this one (about 800 ms by users' notes).
const REBOOT_OF_FEETECH: Duration = Duration::from_millis(1200);
/// A factory reset writes the whole EEPROM, blinks and reboots.
const RESET: Duration = Duration::from_secs(2);

impl Maintenance {
    /// Restarts one servo, which on Dynamixel ends a shutdown after a hardware error, and waits until it is back.
    pub fn reboot(&mut self, id: u8, clock: &dyn Clock) -> Result<(), MaintenanceError> {
        let protocol = self.protocol_of(id, clock)?;
        if !self.released {
            self.release(clock)?;
        }
        self.tell(protocol, id, clock, &|out| framing::reboot(protocol, out, id))?;
        let back = if is_feetech(protocol) {
            REBOOT_OF_FEETECH
        } else {
            REBOOT
        };
        clock.sleep_until(clock.now().after(back));
        self.ping(id, clock).map(|_| ())
    }

    /// Back to factory settings. What the protocol cannot keep cannot be asked for. Says where the servo is then; the
    /// line is at its speed.
    pub fn factory_reset(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        keep: Keep,
        clock: &dyn Clock,
    ) -> Result<Found, MaintenanceError> {
        let protocol = servo.protocol;
        framing::factory_reset(protocol, &mut Vec::new(), id, keep)?;
        self.loosen(servo, id, clock)?;
        let lock = self.unlock(servo, id, clock)?;
        self.tell(protocol, id, clock, &|out| {
            framing::factory_reset(protocol, out, id, keep)
        })?;
        self.known.retain(|known| known.id != id);
        clock.sleep_until(clock.now().after(RESET));
        let factory = |role| servo.role(role).and_then(|row| row.init);
        let factory_id = factory(Role::Id)
            .and_then(|id| u8::try_from(id).ok())
            .unwrap_or(1);
        let factory_baud = factory(Role::BaudRate)
            .and_then(|code| u8::try_from(code).ok())
            .and_then(|code| servo.baud_of_code(code));
        let new_id = if keep == Keep::Nothing { factory_id } else { id };
        if keep != Keep::IdAndBaud
            && let Some(baud) = factory_baud
        {
            let before = self.line.baud();
            self.set_baud(baud)?;
            match self.ping(new_id, clock) {
                Err(MaintenanceError::Silent { .. }) => self.set_baud(before)?,
                found => return found,
            }
        }
        let found = self.ping(new_id, clock)?;
        self.lock_again(servo, new_id, lock, clock)?;
        Ok(found)
    }

    /// Forgets the turns counted. Refused while the servo moves.
    pub fn clear(&mut self, id: u8, clock: &dyn Clock) -> Result<(), MaintenanceError> {
        let protocol = self.protocol_of(id, clock)?;
        if !self.released {
            self.release(clock)?;
        }
        self.tell(protocol, id, clock, &|out| framing::clear(protocol, out, id))?;
        self.ping(id, clock).map(|_| ())
    }

    /// Keeps a copy of the settings, or brings it back, after which the servo reboots.
    pub fn backup(&mut self, id: u8, way: Backup, clock: &dyn Clock) -> Result<(), MaintenanceError> {
        let protocol = self.protocol_of(id, clock)?;
        if !self.released {
            self.release(clock)?;
        }
        self.tell(protocol, id, clock, &|out| {
            framing::backup(protocol, out, id, way)
        })?;
        if way == Backup::Restore {
            clock.sleep_until(clock.now().after(REBOOT));
        }
        self.ping(id, clock).map(|_| ())
    }

    /// Sends an instruction once. Feetech's answer some of them and not others.
    pub(super) fn tell(
        &mut self,
        protocol: ServoProtocol,
        id: u8,
        clock: &dyn Clock,
        build: &dyn Fn(&mut Vec<u8>) -> Result<(), FramingError>,
    ) -> Result<(), MaintenanceError> {
        match self.ask_once(protocol, id, 0, clock, build)? {
            Some(answer) => answer.map(|_| ()),
            None => Ok(()),
        }
    }
}
