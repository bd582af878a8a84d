//! Registers by name: read, and written with all the rules that keep a servo from being harmed or misled.
//!
//! Torque off first; EEPROM only where it differs; the lock opened and closed again; read back. Sources of the lock's
//! rules: users' notes on Feetech (0 lets EEPROM writes persist), the AX-12A page (1 locks until power off).

use super::{Maintenance, MaintenanceError, is_feetech};
use crate::clock::Clock;
use crate::servo::framing;
use crate::servo::register::{Field, RegisterError, encode_checked};
use device_profiles::{Register, Role, ServoProfile, ServoProtocol};
use std::time::Duration;

impl Maintenance {
    /// One register by its name in the servo's profile, in counts.
    pub fn read_register(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        name: &str,
        clock: &dyn Clock,
    ) -> Result<i64, MaintenanceError> {
        let field = Field::named(servo, name)?;
        self.read_field(servo, id, &field, clock)
    }

    /// The register for a purpose, if the servo has one.
    pub(super) fn read_role(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        role: Role,
        clock: &dyn Clock,
    ) -> Result<Option<i64>, MaintenanceError> {
        match Field::for_role(servo, role) {
            Some(field) => self.read_field(servo, id, &field, clock).map(Some),
            None => Ok(None),
        }
    }

    fn read_field(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        field: &Field,
        clock: &dyn Clock,
    ) -> Result<i64, MaintenanceError> {
        let bytes = u16::from(field.size);
        let data = self.read_from(servo.protocol, id, field.address, bytes, clock)?;
        field.get(&data, field.address).ok_or_else(|| self.silent(id))
    }

    /// Writes one register by name, in counts, and reads it back. Torque is switched off first. An EEPROM register
    /// that holds the value already is not written. A new id or line speed is verified where the servo is then; the
    /// line stays at the new speed.
    pub fn write_register(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        name: &str,
        raw: i64,
        clock: &dyn Clock,
    ) -> Result<(), MaintenanceError> {
        let row = row_named(servo, name)?;
        refuse_motion(row, raw)?;
        match row.role {
            Some(Role::Id) => {
                encode_checked(servo, row, raw)?;
                let new = u8::try_from(raw).unwrap_or(u8::MAX);
                return self.set_id(servo, id, new, clock);
            }
            Some(Role::BaudRate) => {
                encode_checked(servo, row, raw)?;
                let code = u8::try_from(raw).ok();
                if let Some(baud) = code.and_then(|code| servo.baud_of_code(code)) {
                    return self.set_servo_baud(servo, id, baud, clock);
                }
            }
            _ => {}
        }
        let word = encode_checked(servo, row, raw)?;
        let field = Field::of(servo, row);
        if field.eeprom && self.read_field(servo, id, &field, clock)? == raw {
            return Ok(());
        }
        self.loosen(servo, id, clock)?;
        let lock = if field.eeprom {
            self.unlock(servo, id, clock)?
        } else {
            None
        };
        let written = self.put(servo, id, &field, word.as_ref(), clock);
        self.lock_again(servo, id, lock, clock)?;
        written?;
        let found = self.read_field(servo, id, &field, clock)?;
        if found == raw {
            Ok(())
        } else {
            Err(MaintenanceError::NotTaken {
                id,
                name: name.to_owned(),
                wanted: raw,
                found,
            })
        }
    }

    /// Sends one write. A servo that answers no writes (Status Return Level) is silent without being absent: whoever
    /// writes reads back.
    pub(super) fn put(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        field: &Field,
        bytes: &[u8],
        clock: &dyn Clock,
    ) -> Result<(), MaintenanceError> {
        let protocol = servo.protocol;
        let written = self.ask(protocol, id, 0, clock, &|out| {
            framing::write(protocol, out, id, field.address, bytes)
        });
        be_deaf(servo, field, bytes.len(), clock);
        match written {
            Ok(_) | Err(MaintenanceError::Silent { .. }) => Ok(()),
            Err(error) => Err(error),
        }
    }

    /// Switches torque off on the line, and makes sure of this servo.
    pub fn loosen(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        clock: &dyn Clock,
    ) -> Result<(), MaintenanceError> {
        if !self.released {
            self.release(clock)?;
        }
        let Some(field) = Field::for_role(servo, Role::TorqueEnable) else {
            return Ok(());
        };
        if self.read_field(servo, id, &field, clock)? == 0 {
            return Ok(());
        }
        self.put(servo, id, &field, field.word(0).as_ref(), clock)?;
        match self.read_field(servo, id, &field, clock)? {
            0 => Ok(()),
            _ => Err(MaintenanceError::TorqueOn { id }),
        }
    }

    /// Opens the EEPROM. What the lock held, if it was closed and must be closed again.
    pub(super) fn unlock(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        clock: &dyn Clock,
    ) -> Result<Option<i64>, MaintenanceError> {
        let Some(field) = Field::for_role(servo, Role::Lock) else {
            return Ok(None);
        };
        let held = self.read_field(servo, id, &field, clock)?;
        match (held, servo.protocol) {
            (0, _) => Ok(None),
            (_, protocol) if is_feetech(protocol) => {
                self.put(servo, id, &field, field.word(0).as_ref(), clock)?;
                match self.read_field(servo, id, &field, clock)? {
                    0 => Ok(Some(held)),
                    _ => Err(MaintenanceError::Locked { id }),
                }
            }
            (_, ServoProtocol::Dynamixel1) => Err(MaintenanceError::Locked { id }),
            _ => Ok(None),
        }
    }

    /// Closes what [`Maintenance::unlock`] has opened.
    pub(super) fn lock_again(
        &mut self,
        servo: &ServoProfile,
        id: u8,
        held: Option<i64>,
        clock: &dyn Clock,
    ) -> Result<(), MaintenanceError> {
        match (held, Field::for_role(servo, Role::Lock)) {
            (Some(held), Some(field)) => self.put(servo, id, &field, field.word(held).as_ref(), clock),
            _ => Ok(()),
        }
    }
}

/// Waits while a servo hears nothing after a write to its EEPROM.
pub(super) fn be_deaf(servo: &ServoProfile, field: &Field, bytes: usize, clock: &dyn Clock) {
    if field.eeprom
        && let Some(deaf_us) = servo.eeprom_deaf_us_per_byte
    {
        // Half as long again: the reports give it as 6 ms, give or take one.
        let deaf = Duration::from_micros(u64::from(deaf_us)) * bytes as u32 * 3 / 2;
        clock.sleep_until(clock.now().after(deaf));
    }
}

pub(super) fn row_named<'a>(servo: &'a ServoProfile, name: &str) -> Result<&'a Register, RegisterError> {
    Field::named(servo, name)?;
    servo.register(name).ok_or_else(|| RegisterError::Unknown {
        model: servo.name.clone(),
        name: name.to_owned(),
        known: String::new(),
    })
}

/// Goals, torque, and what may stand for them.
fn refuse_motion(row: &Register, raw: i64) -> Result<(), MaintenanceError> {
    let goal = matches!(
        row.role,
        Some(Role::GoalPosition | Role::GoalVelocity | Role::GoalTime | Role::GoalTorque)
    );
    let named_so = row.name.starts_with("Goal ") || row.name.starts_with("Indirect ");
    let torque = row.role == Some(Role::TorqueEnable) && raw != 0;
    if goal || named_so || torque {
        return Err(MaintenanceError::Goal {
            name: row.name.clone(),
        });
    }
    Ok(())
}
