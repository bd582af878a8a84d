//! What the parameters of a protocol 2.0 instruction mean.
//!
//! Source: the maker's protocol 2.0 page, "Instruction Details".

use super::packet::instruction;
use crate::servo_bus::heard::{Order, Scope};

/// Guards against clearing by accident: `01` and "DXL\"" in the maker's page.
const CLEAR_TURNS: [u8; 5] = [0x01, 0x44, 0x58, 0x4C, 0x22];
/// Follows the choice in Control Table Backup: "CTRL".
const BACKUP_WORD: [u8; 4] = [0x43, 0x54, 0x52, 0x4C];

/// What `code` with `params` asks of the one servo it was sent to.
pub(in crate::servo_bus) fn order(code: u8, params: &[u8]) -> Order<'_> {
    match (code, params) {
        (instruction::PING, _) => Order::Ping,
        (instruction::READ, &[a, b, c, d]) => Order::Read {
            address: u16::from_le_bytes([a, b]),
            length: u16::from_le_bytes([c, d]),
        },
        (instruction::WRITE, &[a, b, ref bytes @ ..]) => Order::Write {
            address: u16::from_le_bytes([a, b]),
            bytes,
        },
        (instruction::REG_WRITE, &[a, b, ref bytes @ ..]) => Order::Register {
            address: u16::from_le_bytes([a, b]),
            bytes,
        },
        (instruction::ACTION, []) => Order::Action,
        (instruction::FACTORY_RESET, &[scope]) => match scope {
            0xFF => Order::FactoryReset(Scope::All),
            0x01 => Order::FactoryReset(Scope::KeepId),
            0x02 => Order::FactoryReset(Scope::KeepIdAndBaud),
            _ => Order::Refused,
        },
        (instruction::REBOOT, []) => Order::Reboot,
        (instruction::CLEAR, _) if params == CLEAR_TURNS => Order::ClearTurns,
        (instruction::CLEAR, _) => Order::Refused,
        (instruction::BACKUP, &[choice, ref word @ ..]) => match choice {
            1 if word == BACKUP_WORD => Order::Backup,
            2 if word == BACKUP_WORD => Order::Restore,
            _ => Order::Refused,
        },
        (
            instruction::READ
            | instruction::WRITE
            | instruction::REG_WRITE
            | instruction::ACTION
            | instruction::FACTORY_RESET
            | instruction::REBOOT
            | instruction::BACKUP,
            _,
        ) => Order::Malformed,
        _ => Order::Unknown,
    }
}
