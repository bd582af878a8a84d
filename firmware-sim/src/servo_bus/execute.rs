//! What an instruction does to one servo, and what it answers.
//!
//! Source: the maker's protocol 2.0 page, "Instruction Details".

use super::packet::{error, instruction};
use super::servo::Servo;
use super::table::{Reg, load};
use device_profiles::Area;

/// Guards against clearing by accident: `01` and "DXL\"" in the maker's page.
const CLEAR_TURNS: [u8; 5] = [0x01, 0x44, 0x58, 0x4C, 0x22];
/// Follows the choice in Control Table Backup: "CTRL".
const BACKUP_WORD: [u8; 4] = [0x43, 0x54, 0x52, 0x4C];
/// First firmware in which a broadcast Factory Reset of everything is ignored.
const GUARDED_RESET_FROM: u8 = 42;
/// RAM that Startup Configuration bit 1 brings back from a backup.
const KEPT_IN_RAM: &[Reg] = &[
    Reg::StatusReturnLevel,
    Reg::VelocityIGain,
    Reg::VelocityPGain,
    Reg::PositionDGain,
    Reg::PositionIGain,
    Reg::PositionPGain,
    Reg::FeedforwardSecond,
    Reg::FeedforwardFirst,
    Reg::ProfileAcceleration,
    Reg::ProfileVelocity,
];

/// What is left to do when the answer has been sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum After {
    Nothing,
    Reboot,
}

/// An error number or 0, and what follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Done {
    pub(super) error: u8,
    pub(super) after: After,
}

impl From<u8> for Done {
    fn from(error: u8) -> Self {
        Self {
            error,
            after: After::Nothing,
        }
    }
}

impl Servo {
    /// Carries out `code` with `params`; parameters of the answer go to `answer`.
    pub(super) fn execute(
        &mut self,
        at_ns: u64,
        code: u8,
        params: &[u8],
        broadcast: bool,
        answer: &mut Vec<u8>,
    ) -> Done {
        match (code, params) {
            (instruction::PING, _) => {
                answer.extend_from_slice(&(self.table.get(Reg::ModelNumber) as u16).to_le_bytes());
                answer.push(self.firmware());
                0.into()
            }
            (instruction::READ, &[a, b, c, d]) => self
                .read(
                    at_ns,
                    u16::from_le_bytes([a, b]),
                    u16::from_le_bytes([c, d]),
                    answer,
                )
                .into(),
            (instruction::WRITE, &[a, b, ref bytes @ ..]) => {
                self.write(at_ns, u16::from_le_bytes([a, b]), bytes).into()
            }
            (instruction::REG_WRITE, &[a, b, ref bytes @ ..]) => self
                .register_write(u16::from_le_bytes([a, b]), bytes, params)
                .into(),
            (instruction::ACTION, []) => self.act(at_ns).into(),
            (instruction::FACTORY_RESET, &[scope]) => self.factory_reset(scope, broadcast),
            (instruction::REBOOT, []) => Done {
                error: 0,
                after: After::Reboot,
            },
            (instruction::CLEAR, _) => self.clear_turns(params).into(),
            (instruction::BACKUP, &[choice, ref word @ ..]) => self.back_up(choice, word),
            (
                instruction::READ
                | instruction::WRITE
                | instruction::REG_WRITE
                | instruction::ACTION
                | instruction::FACTORY_RESET
                | instruction::REBOOT
                | instruction::BACKUP,
                _,
            ) => error::DATA_LENGTH.into(),
            _ => error::INSTRUCTION.into(),
        }
    }

    /// Whether it answers `code` at its Status Return Level.
    pub(super) fn answers(&self, code: u8) -> bool {
        match code {
            instruction::PING => true,
            instruction::READ
            | instruction::SYNC_READ
            | instruction::BULK_READ
            | instruction::FAST_SYNC_READ
            | instruction::FAST_BULK_READ => self.table.get(Reg::StatusReturnLevel) >= 1,
            _ => self.table.get(Reg::StatusReturnLevel) >= 2,
        }
    }

    fn register_write(&mut self, address: u16, bytes: &[u8], params: &[u8]) -> u8 {
        let error = self.check_write(address, bytes);
        if error == 0 {
            self.registered.clear();
            self.registered.extend_from_slice(params);
            self.table.set(Reg::RegisteredInstruction, 1);
        } else {
            self.counters.refused_writes += 1;
        }
        error
    }

    fn act(&mut self, at_ns: u64) -> u8 {
        let registered = std::mem::take(&mut self.registered);
        self.table.set(Reg::RegisteredInstruction, 0);
        match registered.as_slice() {
            &[a, b, ref bytes @ ..] => self.write(at_ns, u16::from_le_bytes([a, b]), bytes),
            _ => error::INSTRUCTION,
        }
    }

    fn factory_reset(&mut self, scope: u8, broadcast: bool) -> Done {
        let (keeps_id, keeps_baud) = match scope {
            0xFF => (false, false),
            0x01 => (true, false),
            0x02 => (true, true),
            _ => return error::DATA_RANGE.into(),
        };
        if broadcast && !keeps_id && self.firmware() >= GUARDED_RESET_FROM {
            return 0.into();
        }
        let kept = [Reg::ModelNumber, Reg::FirmwareVersion, Reg::Id, Reg::BaudRate]
            .map(|reg| (reg, self.table.get(reg)));
        self.table.start_values(Area::Eeprom);
        for (reg, value) in kept {
            let keeps = match reg {
                Reg::Id => keeps_id,
                Reg::BaudRate => keeps_baud,
                _ => true,
            };
            if keeps {
                self.table.set(reg, value);
            }
        }
        Done {
            error: 0,
            after: After::Reboot,
        }
    }

    fn clear_turns(&mut self, params: &[u8]) -> u8 {
        if params != CLEAR_TURNS {
            return error::DATA_RANGE;
        }
        if self.fresh(Reg::Moving, self.stepped_ns) == Some(1) {
            return error::RESULT_FAIL;
        }
        self.plant
            .recount(self.plant.position.rem_euclid(self.facts.counts_per_turn));
        self.rest();
        self.table.set(Reg::GoalPosition, self.present_counts());
        0
    }

    /// Documented for the firmware versions that also read fast: 45 in X430, 46 in X330.
    fn back_up(&mut self, choice: u8, word: &[u8]) -> Done {
        if !self.reads_fast() {
            return error::INSTRUCTION.into();
        }
        if word != BACKUP_WORD {
            return error::DATA_RANGE.into();
        }
        if self.torque_is_on() {
            return error::RESULT_FAIL.into();
        }
        match choice {
            1 => {
                self.backup = self.table.memory().to_vec();
                self.table.set(Reg::BackupReady, 1);
                0.into()
            }
            2 if self.backup.is_empty() => error::RESULT_FAIL.into(),
            2 => {
                let eeprom = self.table.eeprom_bytes();
                self.table.memory_mut()[..eeprom].copy_from_slice(&self.backup[..eeprom]);
                Done {
                    error: 0,
                    after: After::Reboot,
                }
            }
            _ => error::DATA_RANGE.into(),
        }
    }

    /// Startup Configuration bit 1: RAM settings come back from the backup.
    pub(super) fn restore_ram(&mut self) {
        if self.backup.is_empty() {
            return;
        }
        for &reg in KEPT_IN_RAM {
            let Some(row) = self.table.row(reg) else { continue };
            let at = usize::from(row.address);
            let value = load(&self.backup[at..at + usize::from(row.size)], row.signed);
            self.table.set(reg, value);
        }
    }

    /// Whether its firmware knows the fast reads.
    pub(super) fn reads_fast(&self) -> bool {
        !self.trouble.no_fast_read
            && self
                .facts
                .fast_read_from
                .is_some_and(|from| self.firmware() >= from)
    }
}
