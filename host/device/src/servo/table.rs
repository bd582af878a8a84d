//! The registers that arming and the cycle use, found by name once for a whole bus.
//!
//! Sync instructions name one address for all servos, so all members must have these rows in the same places;
//! that is so for the X series (source: their control tables).

use super::member::Member;
use super::register::{Field, RegisterError};

/// Neighbouring rows that are read or written at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) address: u16,
    pub(super) bytes: u16,
}

impl Block {
    /// From the first row to the end of the last.
    fn spanning(rows: &[Field]) -> Self {
        let address = rows.iter().map(|row| row.address).min().unwrap_or_default();
        let end = rows.iter().map(Field::end).max().unwrap_or_default();
        Self {
            address,
            bytes: end - address,
        }
    }
}

/// Where everything is.
///
/// The four blocks that are read during play beside the positions have four different lengths, and none has
/// that of `status`: so a late answer to one can never be taken for an answer to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Table {
    pub(super) model: Field,
    pub(super) firmware: Field,
    pub(super) identity: Block,
    pub(super) return_delay: Field,
    pub(super) drive_mode: Field,
    pub(super) operating_mode: Field,
    pub(super) settings: Block,
    pub(super) position_max: Field,
    pub(super) position_min: Field,
    pub(super) range: Block,
    pub(super) torque: Field,
    /// 2 bytes: Torque Enable and LED.
    pub(super) torque_block: Block,
    pub(super) error: Field,
    /// 3 bytes: Status Return Level, Registered Instruction, Hardware Error Status.
    pub(super) error_block: Block,
    /// 1 byte.
    pub(super) watchdog: Field,
    pub(super) watchdog_block: Block,
    pub(super) profile_acceleration: Field,
    pub(super) profile_velocity: Field,
    pub(super) profile: Block,
    pub(super) goal: Field,
    /// From Goal Position to Present Position.
    pub(super) goal_and_status: Block,
    /// From Realtime Tick to Present Position.
    pub(super) status: Block,
    /// 4 bytes: Present Input Voltage, Present Temperature, Backup Ready.
    pub(super) supply: Block,
}

impl Table {
    /// The table of one member's servo.
    pub(super) fn of(member: &Member) -> Result<Self, RegisterError> {
        let row = |name| Field::named(member.servo(), name);
        let fields = member.fields();
        let [model, firmware] = [row("Model Number")?, row("Firmware Version")?];
        let [return_delay, drive_mode, operating_mode] = [
            row("Return Delay Time")?,
            row("Drive Mode")?,
            row("Operating Mode")?,
        ];
        let [position_max, position_min] = [row("Max Position Limit")?, row("Min Position Limit")?];
        let [torque, error, watchdog] = [
            row("Torque Enable")?,
            row("Hardware Error Status")?,
            row("Bus Watchdog")?,
        ];
        let [profile_acceleration, goal] = [row("Profile Acceleration")?, row("Goal Position")?];
        let profile_velocity = fields.profile_velocity;
        Ok(Self {
            model,
            firmware,
            identity: Block::spanning(&[model, firmware]),
            return_delay,
            drive_mode,
            operating_mode,
            settings: Block::spanning(&[return_delay, drive_mode, operating_mode]),
            position_max,
            position_min,
            range: Block::spanning(&[position_max, position_min]),
            torque,
            torque_block: Block::spanning(&[torque, row("LED")?]),
            error,
            error_block: Block::spanning(&[error, row("Status Return Level")?]),
            watchdog,
            watchdog_block: Block::spanning(&[watchdog]),
            profile_acceleration,
            profile_velocity,
            profile: Block::spanning(&[profile_acceleration, profile_velocity]),
            goal,
            goal_and_status: Block::spanning(&[goal, fields.position]),
            status: Block::spanning(&[fields.tick, fields.load, fields.velocity, fields.position]),
            supply: Block::spanning(&[fields.voltage, fields.temperature, row("Backup Ready")?]),
        })
    }

    /// Whether two models can be driven by the same sync instructions: addresses and sizes agree.
    pub(super) fn same_places(&self, other: &Self) -> bool {
        let rows = |table: &Self| {
            [
                table.model,
                table.firmware,
                table.return_delay,
                table.drive_mode,
                table.operating_mode,
                table.position_max,
                table.position_min,
                table.torque,
                table.error,
                table.watchdog,
                table.profile_acceleration,
                table.profile_velocity,
                table.goal,
            ]
            .map(|row| (row.address, row.size))
        };
        rows(self) == rows(other) && self.status == other.status && self.supply == other.supply
    }
}
