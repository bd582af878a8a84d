//! Looking: who answers, at which speed, how soon, and what their registers say. Nothing is written.

use super::facts::{Expected, Joint, Patient, Seen, Stray, lower_quartile};
use crate::clock::Clock;
use crate::servo::maintenance::{Found, Maintenance, MaintenanceError};
use device_profiles::{Role, ServoProfile, ServoProtocol};
use std::collections::BTreeSet;
use std::time::Duration;

/// Questions in all, shared among the servos: one lost answer in a hundred is then seen all but surely.
const PINGS: usize = 400;
/// Questions to one servo, at least and at most.
const PINGS_OF_ONE: std::ops::RangeInclusive<usize> = 12..=100;
/// Lost answers after which nobody needs to ask on: each costs a silence.
const LOST_ENOUGH: u32 = 12;
/// Moments at which the supply is read, and the time between them.
const VOLTAGE_ROUNDS: usize = 4;
const VOLTAGE_EVERY: Duration = Duration::from_millis(120);
/// Bytes without sense that come when one id is asked and make it two servos talking at once: more than a spark or
/// two, less than one answer each to two of the three tries.
const GARBLED_BYTES_MIN: u64 = 10;
/// The same in packets that were recognised as such, and damaged.
const GARBLED_PACKETS_MIN: u64 = 2;

/// Speeds that people set servos to.
const USUAL_BAUDS: [u32; 5] = [115_200, 1_000_000, 2_000_000, 3_000_000, 4_000_000];

/// What a judgement needs, in the order in which it is read.
const ROLES: [Role; 18] = [
    Role::ReturnDelay,
    Role::StatusReturnLevel,
    Role::OperatingMode,
    Role::DriveMode,
    Role::Phase,
    Role::HomingOffset,
    Role::MinPosition,
    Role::MaxPosition,
    Role::TemperatureLimit,
    Role::MinVoltage,
    Role::MaxVoltage,
    Role::Lock,
    Role::TorqueEnable,
    Role::HardwareError,
    Role::PresentPosition,
    Role::PresentVoltage,
    Role::PresentTemperature,
    Role::BaudRate,
];

/// Where the line is.
#[derive(Debug, Clone, PartialEq)]
pub struct About {
    /// The bus, as messages call it.
    pub bus: String,
    /// The port, for commands in remedies.
    pub port: String,
    /// The line's speed.
    pub baud: u32,
    /// The adapter's latency timer, where one could be read.
    pub timer_ms: Option<u8>,
}

/// Looks at everything on a line. Takes two to ten seconds; `tell` hears what is being done.
pub fn examine(
    line: &mut Maintenance,
    about: &About,
    expected: &Expected,
    clock: &dyn Clock,
    tell: &mut dyn FnMut(&str),
) -> Result<Seen, MaintenanceError> {
    let mut look = Look {
        line,
        clock,
        expected,
        seen: Seen {
            bus: about.bus.clone(),
            port: about.port.clone(),
            baud: about.baud,
            patients: Vec::new(),
            strays: Vec::new(),
            garbled_ids: Vec::new(),
            echo: false,
            asked: 0,
            lost: 0,
            damaged: 0,
            held_back_secs: None,
            timer_ms: about.timer_ms,
        },
    };
    tell("asking everybody who they are");
    look.find()?;
    tell("reading settings");
    look.read_registers()?;
    tell("timing answers");
    look.time_answers()?;
    tell("watching the supply");
    look.watch_supply()?;
    look.seen.echo = look.line.heard().echoes > 0;
    Ok(look.seen)
}

struct Look<'a> {
    line: &'a mut Maintenance,
    clock: &'a dyn Clock,
    expected: &'a Expected,
    seen: Seen,
}

impl Look<'_> {
    /// Everybody at the line's speed; then, if somebody is wanting, at other speeds.
    fn find(&mut self) -> Result<(), MaintenanceError> {
        let baud = self.seen.baud;
        let mut garbled = false;
        let found = self
            .line
            .scan(&[baud], self.clock, &mut |heard| garbled |= heard.garbled)?;
        for found in found {
            self.admit(found);
        }
        let wanting: Vec<u8> = self.expected.joints.iter().map(|joint| joint.id).collect();
        for id in wanting {
            if self.seen.patient(id).is_none() {
                self.ask_for(id)?;
            }
        }
        if self.expected.joints.is_empty() && garbled {
            let found: Vec<u8> = self.seen.patients.iter().map(|patient| patient.id).collect();
            self.seen.garbled_ids = self.line.garbled_ids(&found, self.clock)?;
        }
        self.seen.patients.sort_by_key(|patient| patient.id);
        let bauds = self.other_bauds();
        let strays = self.line.scan(&bauds, self.clock, &mut |_| {})?;
        self.seen.strays = strays
            .into_iter()
            .map(|found| Stray {
                baud: found.baud,
                id: found.id,
                model_number: found.model_number,
            })
            .collect();
        Ok(())
    }

    /// One that the scan has not heard: its answer may be garbled, by itself or by another of its number.
    fn ask_for(&mut self, id: u8) -> Result<(), MaintenanceError> {
        let before = self.line.heard();
        match self.line.ping(id, self.clock) {
            Ok(found) => self.admit(found),
            Err(MaintenanceError::Silent { .. }) => {
                let heard = self.line.heard();
                let senseless = heard.stray_bytes - before.stray_bytes;
                if senseless >= GARBLED_BYTES_MIN || heard.damaged >= before.damaged + GARBLED_PACKETS_MIN {
                    self.seen.garbled_ids.push(id);
                }
            }
            Err(MaintenanceError::Refused { .. }) => {}
            Err(error) => return Err(error),
        }
        Ok(())
    }

    fn admit(&mut self, found: Found) {
        let profile = self
            .expected
            .model(found.model_number)
            .map(|model| model.at_firmware(found.firmware).into_owned());
        self.seen.patients.push(Patient {
            id: found.id,
            model_number: found.model_number,
            firmware: found.firmware,
            profile,
            registers: Vec::new(),
            volts: Vec::new(),
            asked: 0,
            lost: 0,
        });
    }

    /// Where else somebody may be: nowhere if nobody is wanting, at every speed that those who are can have, and at
    /// the factories' and the usual speeds where it is not known who should be there.
    fn other_bauds(&self) -> Vec<u32> {
        let is_wanting = |joint: &&Joint| {
            self.seen.patient(joint.id).is_none() && !self.seen.garbled_ids.contains(&joint.id)
        };
        let wanting = self.expected.joints.iter().filter(is_wanting);
        let mut bauds: BTreeSet<u32> = wanting
            .flat_map(|joint| joint.model.bauds.iter().copied())
            .collect();
        if self.expected.joints.is_empty() {
            bauds.extend(self.expected.models.iter().filter_map(factory_baud));
            if self.seen.patients.is_empty() {
                bauds.extend(USUAL_BAUDS);
            }
        }
        bauds.remove(&self.seen.baud);
        bauds.into_iter().collect()
    }

    fn read_registers(&mut self) -> Result<(), MaintenanceError> {
        for place in 0..self.seen.patients.len() {
            let Some(model) = self.seen.patients[place].profile.clone() else {
                continue;
            };
            for role in ROLES {
                if let Some(value) = self.read(&model, self.seen.patients[place].id, role)? {
                    self.seen.patients[place].registers.push((role, value));
                }
            }
        }
        Ok(())
    }

    /// One register, if the servo has it and tells it.
    fn read(&mut self, model: &ServoProfile, id: u8, role: Role) -> Result<Option<i64>, MaintenanceError> {
        let Some(row) = model.role(role) else {
            return Ok(None);
        };
        match self.line.read_register(model, id, &row.name, self.clock) {
            Ok(value) => Ok(Some(value)),
            Err(MaintenanceError::Silent { .. } | MaintenanceError::Refused { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Asks everybody in turn where it is: who answers how soon, and how often not at all.
    fn time_answers(&mut self) -> Result<(), MaintenanceError> {
        let count = self.seen.patients.len().max(1);
        let rounds = (PINGS / count).clamp(*PINGS_OF_ONE.start(), *PINGS_OF_ONE.end());
        let damaged_before = self.line.heard().damaged;
        let mut held_back = Vec::new();
        for _ in 0..rounds {
            for place in 0..self.seen.patients.len() {
                let id = self.seen.patients[place].id;
                let before = self.line.heard();
                let asked_at = self.clock.now();
                let Some(model) = self.seen.patients[place].profile.clone() else {
                    continue;
                };
                self.read(&model, id, Role::PresentPosition)?;
                let took = self.clock.now().since(asked_at);
                let after = self.line.heard();
                // What comes late was not lost: a host that was held up is no fault of the line.
                let missed = after.timeouts - before.timeouts;
                let lost = missed.saturating_sub(after.late - before.late) as u32;
                let patient = &mut self.seen.patients[place];
                patient.asked += 1 + lost;
                patient.lost += lost;
                self.seen.asked += 1 + lost;
                self.seen.lost += lost;
                if missed == 0 {
                    held_back.push(took.as_secs_f64() - self.needed_secs(place));
                }
            }
            if self.seen.lost >= LOST_ENOUGH {
                break;
            }
        }
        self.seen.damaged = (self.line.heard().damaged - damaged_before) as u32;
        self.seen.held_back_secs = lower_quartile(held_back);
        Ok(())
    }

    /// What a question and its answer need: their bytes, and the servo's return delay.
    fn needed_secs(&self, place: usize) -> f64 {
        let patient = &self.seen.patients[place];
        let Some(model) = &patient.profile else {
            return 0.0;
        };
        // Instruction and status without data: 14 and 11 bytes in protocol 2.0, 8 and 6 in the others.
        let overhead = match model.protocol {
            ServoProtocol::Dynamixel2 => 25,
            _ => 14,
        };
        let bytes = overhead + model.role(Role::PresentPosition).map_or(0, |row| row.size);
        let delay_secs = patient.get_si(Role::ReturnDelay).unwrap_or(0.0);
        f64::from(bytes) * 10.0 / f64::from(self.seen.baud.max(1)) + delay_secs
    }

    fn watch_supply(&mut self) -> Result<(), MaintenanceError> {
        for round in 0..VOLTAGE_ROUNDS {
            if round > 0 {
                self.clock.sleep_until(self.clock.now().after(VOLTAGE_EVERY));
            }
            for place in 0..self.seen.patients.len() {
                let id = self.seen.patients[place].id;
                let Some(model) = self.seen.patients[place].profile.clone() else {
                    continue;
                };
                let per_count = model
                    .role(Role::PresentVoltage)
                    .and_then(|row| row.unit_per_count);
                if let (Some(raw), Some(per_count)) =
                    (self.read(&model, id, Role::PresentVoltage)?, per_count)
                {
                    self.seen.patients[place].volts.push(raw as f64 * per_count);
                }
            }
        }
        Ok(())
    }
}

/// The speed at which a model leaves the factory.
fn factory_baud(model: &ServoProfile) -> Option<u32> {
    let code = model.role(Role::BaudRate)?.init?;
    model.baud_of_code(u8::try_from(code).ok()?)
}
