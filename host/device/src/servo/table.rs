//! The registers of one model that arming and the cycle use, found by their roles once.

use super::block::{Block, is_covered};
use super::register::{Field, RegisterError};
use super::settings::Readings;
use device_profiles::{Role, ServoProfile, ServoProtocol, WordOrder};

/// Longest block that is read each cycle: from Realtime Tick to Present Position of the X series.
const STATUS_BYTES_MAX: u16 = 16;

/// Where everything is. What a model lacks is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Table {
    pub(super) protocol: ServoProtocol,
    pub(super) order: WordOrder,
    pub(super) model: Option<Field>,
    pub(super) firmware: Option<Field>,
    pub(super) return_delay: Option<Field>,
    pub(super) drive_mode: Option<Field>,
    pub(super) operating_mode: Option<Field>,
    pub(super) lock: Option<Field>,
    pub(super) position_max: Option<Field>,
    pub(super) position_min: Option<Field>,
    pub(super) torque: Field,
    pub(super) error: Option<Field>,
    pub(super) watchdog: Option<Field>,
    /// The acceleration of a move to a goal.
    pub(super) acceleration: Option<Field>,
    /// The speed of a move to a goal.
    pub(super) speed: Option<Field>,
    /// The time of a move to a goal, where it goes before its speed.
    pub(super) goal_time: Option<Field>,
    pub(super) goal: Field,
    pub(super) position: Field,
    pub(super) tick: Option<Field>,
    pub(super) velocity: Option<Field>,
    pub(super) load: Option<Field>,
    pub(super) load_is_current: bool,
    pub(super) voltage: Option<Field>,
    pub(super) temperature: Option<Field>,
    /// Read each cycle.
    pub(super) status: Block,
}

impl Table {
    /// The table of a model, of which `readings` are wanted each cycle.
    pub(super) fn of(servo: &ServoProfile, readings: Readings) -> Result<Self, RegisterError> {
        let row = |role| Field::for_role(servo, role);
        let current = row(Role::PresentCurrent);
        let position = Field::needed(servo, Role::PresentPosition)?;
        let mut table = Self {
            protocol: servo.protocol,
            order: servo.word_order(),
            model: row(Role::ModelNumber),
            firmware: row(Role::FirmwareVersion),
            return_delay: row(Role::ReturnDelay),
            drive_mode: row(Role::DriveMode),
            operating_mode: row(Role::OperatingMode),
            lock: row(Role::Lock),
            position_max: row(Role::MaxPosition),
            position_min: row(Role::MinPosition),
            torque: Field::needed(servo, Role::TorqueEnable)?,
            error: row(Role::HardwareError),
            watchdog: row(Role::BusWatchdog),
            acceleration: servo.move_acceleration().map(|row| Field::of(servo, row)),
            speed: servo.move_velocity().map(|row| Field::of(servo, row)),
            goal_time: row(Role::GoalTime),
            goal: Field::needed(servo, Role::GoalPosition)?,
            position,
            tick: row(Role::RealtimeTick),
            velocity: row(Role::PresentVelocity),
            // A servo that has both has the inferred one next to its position.
            load_is_current: row(Role::PresentLoad).is_none(),
            load: row(Role::PresentLoad).or(current),
            voltage: row(Role::PresentVoltage),
            temperature: row(Role::PresentTemperature),
            status: Block::spanning(servo, &[position]),
        };
        if readings == Readings::Motion {
            table.status = table.widest_status(servo);
        }
        Ok(table)
    }

    /// Whatever tells of motion or supply and lies near enough to the position to be read with it.
    fn widest_status(&self, servo: &ServoProfile) -> Block {
        let mut rows = vec![self.position];
        let wished = [
            self.velocity,
            self.load,
            self.tick,
            self.voltage,
            self.temperature,
        ];
        for row in wished.into_iter().flatten() {
            let block = Block::spanning(servo, &rows);
            let begin = row.address.min(block.address);
            let end = row.end().max(block.address + block.bytes);
            if end - begin <= STATUS_BYTES_MAX && is_covered(servo, begin, end) {
                rows.push(row);
            }
        }
        Block::spanning(servo, &rows).around(self.position)
    }

    /// A row, if it is read each cycle.
    pub(super) fn in_status(&self, row: Option<Field>) -> Option<Field> {
        row.filter(|row| self.status.holds(*row))
    }

    /// Whether the two can answer one sync read: all that is read lies in the same places.
    pub(super) fn reads_like(&self, other: &Self) -> bool {
        let places = |table: &Self| {
            let rows = [
                Some(table.torque),
                table.error,
                table.watchdog,
                table.voltage,
                table.temperature,
            ];
            rows.map(|row| row.map(|row| (row.address, row.size)))
        };
        let same_line = (self.protocol, self.order) == (other.protocol, other.order);
        same_line && self.status == other.status && places(self) == places(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::Profiles;

    #[test]
    fn every_model_can_be_driven_and_read_without_gaps() {
        for servo in Profiles::builtin().servos() {
            for readings in [Readings::Position, Readings::Motion] {
                let table = Table::of(servo, readings).expect("goal, torque and position");
                let lengths: Vec<u16> = table.status.lengths().collect();
                assert!(
                    lengths.len() >= 6,
                    "{}: late answers need lengths of their own",
                    servo.name
                );
                assert_eq!(lengths.first(), Some(&table.status.bytes));
                for bytes in lengths {
                    let begin = table.status.address_for(bytes);
                    let end = begin + bytes;
                    assert!(is_covered(servo, begin, end), "{}: {begin} to {end}", servo.name);
                    let [first, last] = [table.position.address, table.position.end()];
                    assert!(begin <= first && last <= end, "{}: {begin} to {end}", servo.name);
                }
                assert!(table.status.holds(table.position));
            }
            let motion = Table::of(servo, Readings::Motion).expect("as before");
            assert!(motion.in_status(motion.velocity).is_some(), "{}", servo.name);
            assert!(motion.in_status(motion.load).is_some(), "{}", servo.name);
        }
    }
}
