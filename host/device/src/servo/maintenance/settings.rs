//! Another id, another line speed: where the servo is then, it is looked for.

use super::registers::be_deaf;
use super::{Maintenance, MaintenanceError};
use crate::clock::Clock;
use crate::servo::framing;
use crate::servo::register::{Field, encode_checked};
use device_profiles::{Role, ServoProfile};
use std::time::Duration;

/// A servo takes a new line speed within this time.
const SETTLE: Duration = Duration::from_millis(20);

impl Maintenance {
    /// Gives a servo another id, and asks it there. Refused if somebody answers to the new id.
    pub fn set_id(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        new: u8,
        clock: &dyn Clock,
    ) -> Result<(), MaintenanceError> {
        if new == id {
            return self.ping(id, clock).map(|_| ());
        }
        let row = Field::needed(servo, Role::Id)?;
        if let Some(register) = servo.role(Role::Id) {
            encode_checked(servo, register, new.into())?;
        }
        match self.ping(new, clock) {
            Err(MaintenanceError::Silent { .. }) => {}
            Ok(_) | Err(MaintenanceError::Refused { .. } | MaintenanceError::Unidentified { .. }) => {
                return Err(MaintenanceError::IdTaken { id: new });
            }
            Err(error) => return Err(error),
        }
        self.loosen(servo, id, clock)?;
        let lock = self.unlock(servo, id, clock)?;
        let written = self.put(servo, id, &row, &[new], clock);
        let answers_at = match self.read_role(servo, new, Role::Id, clock) {
            Ok(_) => new,
            Err(MaintenanceError::Silent { .. }) => id,
            Err(error) => return Err(error),
        };
        self.lock_again(servo, answers_at, lock, clock)?;
        written?;
        self.known.retain(|known| known.id != id);
        let found = self
            .read_role(servo, answers_at, Role::Id, clock)?
            .unwrap_or_default();
        if found == i64::from(new) {
            return self.ping(new, clock).map(|_| ());
        }
        Err(MaintenanceError::NotTaken {
            id: answers_at,
            name: servo
                .role(Role::Id)
                .map(|row| row.name.clone())
                .unwrap_or_default(),
            wanted: new.into(),
            found,
        })
    }

    /// Makes a servo speak at another line speed, follows it there and asks it. If it is not there, the line goes
    /// back to the speed before.
    pub fn set_servo_baud(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        baud: u32,
        clock: &dyn Clock,
    ) -> Result<(), MaintenanceError> {
        let row = Field::needed(servo, Role::BaudRate)?;
        let Some(code) = servo.baud_code(baud) else {
            return Err(MaintenanceError::NoSuchBaud {
                model: servo.name.clone(),
                baud,
                known: servo.bauds.clone(),
            });
        };
        let before = self.line.baud();
        if self.read_role(servo, id, Role::BaudRate, clock)? == Some(code.into()) {
            return Ok(());
        }
        self.loosen(servo, id, clock)?;
        let lock = self.unlock(servo, id, clock)?;
        // Once: the answer may come at the new speed.
        let protocol = servo.protocol;
        self.tell(protocol, id, clock, &|out| {
            framing::write(protocol, out, id, row.address, &[code])
        })?;
        be_deaf(servo, &row, 1, clock);
        self.set_baud(baud)?;
        clock.sleep_until(clock.now().after(SETTLE));
        self.hush(clock)?;
        match self.read_role(servo, id, Role::BaudRate, clock) {
            Ok(_) => {
                self.lock_again(servo, id, lock, clock)?;
                self.ping(id, clock).map(|_| ())
            }
            Err(MaintenanceError::Silent { .. }) => self.stayed(servo, id, [before, baud], lock, clock),
            Err(error) => Err(error),
        }
    }

    /// The servo is not at the new speed: back to the old one, to see whether it is there.
    fn stayed(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        [from, to]: [u32; 2],
        lock: Option<i64>,
        clock: &dyn Clock,
    ) -> Result<(), MaintenanceError> {
        self.set_baud(from)?;
        match self.read_role(servo, id, Role::BaudRate, clock) {
            Ok(found) => {
                self.lock_again(servo, id, lock, clock)?;
                Err(MaintenanceError::NotTaken {
                    id,
                    name: servo
                        .role(Role::BaudRate)
                        .map(|row| row.name.clone())
                        .unwrap_or_default(),
                    wanted: servo.baud_code(to).unwrap_or_default().into(),
                    found: found.unwrap_or_default(),
                })
            }
            Err(MaintenanceError::Silent { .. }) => Err(MaintenanceError::Lost { id, from, to }),
            Err(error) => Err(error),
        }
    }
}
