//! What an order does to one servo, and what it answers.
//!
//! Source: the maker's protocol pages, "Instruction Details"; Feetech's published libraries.

use super::heard::{Class, Order, Refusal, Scope};
use super::reg::Reg;
use super::servo::Servo;
use super::{dynamixel2, summed};
use device_profiles::{Area, ServoProtocol};

/// First firmware in which a broadcast Factory Reset of everything is ignored.
const GUARDED_RESET_FROM: u8 = 42;
/// First firmware of an STS that knows Calibrate.
const CALIBRATES_FROM: (i64, i64) = (3, 10);
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

/// Whether it was refused, and what follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Done {
    pub(super) refusal: Option<Refusal>,
    pub(super) after: After,
}

impl From<Option<Refusal>> for Done {
    fn from(refusal: Option<Refusal>) -> Self {
        Self {
            refusal,
            after: After::Nothing,
        }
    }
}

impl From<Refusal> for Done {
    fn from(refusal: Refusal) -> Self {
        Some(refusal).into()
    }
}

/// Obeyed, and starts over.
const REBOOTS: Done = Done {
    refusal: None,
    after: After::Reboot,
};

impl Servo {
    /// Carries out `order`; parameters of the answer go to `answer`.
    pub(super) fn execute(
        &mut self,
        at_ns: u64,
        order: Order<'_>,
        broadcast: bool,
        answer: &mut Vec<u8>,
    ) -> Done {
        match order {
            Order::Ping => {
                if self.facts.protocol == ServoProtocol::Dynamixel2 {
                    answer.extend_from_slice(&(self.table.get(Reg::ModelNumber) as u16).to_le_bytes());
                    answer.push(self.firmware());
                }
                None.into()
            }
            Order::Read { address, length } => self.read(at_ns, address, length, answer).into(),
            Order::Write { address, bytes } => self.write(at_ns, address, bytes).into(),
            Order::Register { address, bytes } => self.register_write(address, bytes).into(),
            Order::Action => self.act(at_ns).into(),
            Order::FactoryReset(scope) => self.factory_reset(scope, broadcast),
            Order::Reboot => REBOOTS,
            Order::ClearTurns => self.clear_turns().into(),
            Order::Backup => self.back_up().into(),
            Order::Restore => self.restore_backup(),
            Order::Calibrate(_) if !self.calibrates() => Refusal::Instruction.into(),
            Order::Calibrate(counts) => {
                self.calibrate(counts.into());
                None.into()
            }
            Order::Malformed => Refusal::Length.into(),
            Order::Refused => Refusal::Range.into(),
            Order::Unknown => Refusal::Instruction.into(),
        }
    }

    /// Whether it answers `order` at its Status Return Level. Feetech's level 0 still answers reads, and what it
    /// does not know, and a reboot, it never answers.
    pub(super) fn answers(&self, order: &Order<'_>) -> bool {
        let level = self.table.get(Reg::StatusReturnLevel);
        match (order, order.class()) {
            (Order::Calibrate(_), _) if !self.calibrates() => false,
            (Order::Malformed | Order::Refused | Order::Unknown | Order::Reboot, _) if self.is_feetech() => {
                false
            }
            (_, Class::Ping) => true,
            (_, Class::Read) => self.is_feetech() || level >= 1,
            (_, Class::Other) => level >= if self.is_feetech() { 1 } else { 2 },
        }
    }

    /// Whether its firmware knows the instruction that names the present position.
    fn calibrates(&self) -> bool {
        (i64::from(self.firmware()), self.table.get(Reg::FirmwareMinor)) >= CALIBRATES_FROM
    }

    /// Whether it answers reads among others at its Status Return Level.
    pub(super) fn answers_group_reads(&self) -> bool {
        self.answers(&Order::Read {
            address: 0,
            length: 0,
        })
    }

    /// The error byte of an answer.
    pub(super) fn error_byte(&self, refusal: Option<Refusal>) -> u8 {
        match self.facts.protocol {
            ServoProtocol::Dynamixel2 => {
                let alert = if self.alarms() == 0 {
                    0
                } else {
                    dynamixel2::packet::ALERT
                };
                dynamixel2::packet::error_number(refusal) | alert
            }
            ServoProtocol::Dynamixel1 => summed::packet::error_bits(refusal, self.alarms()),
            // They tell of the servo only: a write that did nothing is answered like one that did.
            ServoProtocol::Sts | ServoProtocol::Scs => self.alarms(),
        }
    }

    fn register_write(&mut self, address: u16, bytes: &[u8]) -> Option<Refusal> {
        let refusal = self.check_write(address, bytes);
        if refusal.is_none() {
            self.registered = Some((address, bytes.to_vec()));
            self.table.set(Reg::RegisteredInstruction, 1);
        } else {
            self.counters.refused_writes += 1;
        }
        refusal
    }

    fn act(&mut self, at_ns: u64) -> Option<Refusal> {
        self.table.set(Reg::RegisteredInstruction, 0);
        match self.registered.take() {
            Some((address, bytes)) => self.write(at_ns, address, &bytes),
            None => Some(Refusal::Instruction),
        }
    }

    fn factory_reset(&mut self, scope: Scope, broadcast: bool) -> Done {
        let is_guarded =
            self.facts.protocol == ServoProtocol::Dynamixel2 && self.firmware() >= GUARDED_RESET_FROM;
        if broadcast && scope == Scope::All && is_guarded {
            return None.into();
        }
        let kept = [Reg::ModelNumber, Reg::FirmwareVersion, Reg::Id, Reg::BaudRate]
            .map(|reg| (reg, self.table.get(reg)));
        self.table.start_values(Area::Eeprom);
        for (reg, value) in kept {
            let keeps = match reg {
                Reg::Id => scope != Scope::All,
                Reg::BaudRate => scope == Scope::KeepIdAndBaud,
                _ => true,
            };
            if keeps {
                self.table.set(reg, value);
            }
        }
        self.counters.eeprom_writes += 1;
        self.table.keep();
        REBOOTS
    }

    fn clear_turns(&mut self) -> Option<Refusal> {
        if self.fresh(Reg::Moving, self.stepped_ns) == Some(1) {
            return Some(Refusal::Fail);
        }
        self.forget_turns();
        self.table.set(Reg::GoalPosition, self.present_counts());
        None
    }

    /// Documented for the DYNAMIXEL firmware that also reads fast (45 in X430, 46 in X330), and of Feetech.
    fn back_up(&mut self) -> Option<Refusal> {
        if !self.is_feetech() {
            if !self.reads_fast() {
                return Some(Refusal::Instruction);
            }
            if self.torque_is_on() {
                return Some(Refusal::Fail);
            }
        }
        self.backup = self.table.memory().to_vec();
        self.table.set(Reg::BackupReady, 1);
        None
    }

    fn restore_backup(&mut self) -> Done {
        if !self.reads_fast() {
            return Refusal::Instruction.into();
        }
        if self.torque_is_on() || self.backup.is_empty() {
            return Refusal::Fail.into();
        }
        let eeprom = self.table.eeprom_bytes();
        self.table.restore(&self.backup[..eeprom]);
        self.counters.eeprom_writes += 1;
        REBOOTS
    }

    /// Startup Configuration bit 1: RAM settings come back from the backup.
    pub(super) fn restore_ram(&mut self) {
        if self.backup.is_empty() {
            return;
        }
        for &reg in KEPT_IN_RAM {
            let Some(row) = self.table.row(reg) else { continue };
            let at = usize::from(row.address);
            let value = self
                .table
                .decode(row, &self.backup[at..at + usize::from(row.size)]);
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
