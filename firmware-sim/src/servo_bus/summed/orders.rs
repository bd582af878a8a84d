//! What the parameters of an instruction with a sum mean, to a DYNAMIXEL and to a Feetech servo.
//!
//! Source: the maker's protocol 1.0 page; for Feetech its published libraries (`INST.h`, `SCSerial`), where
//! 0B takes the count that the present position is to read from then on, and 2048 where it is missing.

use super::packet::instruction;
use crate::servo_bus::heard::{Order, Scope};
use device_profiles::ServoProtocol;

/// The middle of a Feetech encoder: what Calibrate means without a parameter.
const MIDDLE: u16 = 2048;

/// What `code` with `params` asks of a servo that speaks `protocol`.
pub(in crate::servo_bus) fn order(protocol: ServoProtocol, code: u8, params: &[u8]) -> Order<'_> {
    let is_feetech = matches!(protocol, ServoProtocol::Sts | ServoProtocol::Scs);
    match (code, params) {
        (instruction::PING, _) => Order::Ping,
        (instruction::READ, &[address, length]) => Order::Read {
            address: address.into(),
            length: length.into(),
        },
        (instruction::WRITE, &[address, ref bytes @ ..]) => Order::Write {
            address: address.into(),
            bytes,
        },
        (instruction::REG_WRITE, &[address, ref bytes @ ..]) => Order::Register {
            address: address.into(),
            bytes,
        },
        (instruction::ACTION, _) => Order::Action,
        (instruction::FACTORY_RESET, _) if is_feetech => Order::FactoryReset(Scope::KeepId),
        (instruction::FACTORY_RESET, _) => Order::FactoryReset(Scope::All),
        (instruction::REBOOT, _) if is_feetech => Order::Reboot,
        (instruction::BACKUP, _) if is_feetech => Order::Backup,
        (instruction::RESET_TURNS, _) if is_feetech => Order::ClearTurns,
        (instruction::CALIBRATE, _) if protocol == ServoProtocol::Sts => match params {
            &[low, high, ..] => Order::Calibrate(u16::from_le_bytes([low, high])),
            _ => Order::Calibrate(MIDDLE),
        },
        (instruction::READ | instruction::WRITE | instruction::REG_WRITE, _) => Order::Malformed,
        _ => Order::Unknown,
    }
}
