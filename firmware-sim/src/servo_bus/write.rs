//! Reading and writing the table as a host may: who may write what and when.
//!
//! Source: the maker's protocol pages ("Error") and control table pages. Which error comes first when
//! several apply is not documented, so the readings there are are a switch. A Feetech servo has no error for a
//! write: what it does not take it leaves as it was, and a locked one obeys without keeping.

use super::goal::Mode;
use super::heard::Refusal;
use super::reg::{Reg, Regs};
use super::servo::Servo;
use super::table::Table;
use super::unit::{Gaps, Precedence};
use device_profiles::{Area, Register, ServoProtocol};

/// Largest Goal Position in the modes of several turns.
const EXTENDED_MAX: i64 = 1_048_575;
/// Largest Profile Velocity and Acceleration when they are times.
const TIME_MAX: i64 = 32_737;
/// Written to Torque Enable of an STS: the shaft is where the middle is from now on.
pub(super) const CALIBRATE: i64 = 128;

impl Servo {
    /// Appends `length` bytes from `address` as they are at `at_ns`, or says why not.
    pub(super) fn read(
        &mut self,
        at_ns: u64,
        address: u16,
        length: u16,
        out: &mut Vec<u8>,
    ) -> Option<Refusal> {
        let end = usize::from(address) + usize::from(length);
        let bytes = || address..address.saturating_add(length);
        if !self.is_feetech() {
            if end > self.table.memory().len() {
                return Some(Refusal::Access);
            }
            if length == 0 {
                return Some(Refusal::Length);
            }
            let gap = || bytes().any(|at| self.table.row_covering(at).is_none());
            if self.unit.gaps == Gaps::AccessError && gap() {
                return Some(Refusal::Access);
            }
        }
        self.refresh(at_ns);
        out.extend(bytes().map(|at| self.table.byte(at)));
        None
    }

    /// Whether `bytes` may be written at `address` now.
    pub(super) fn check_write(&self, address: u16, bytes: &[u8]) -> Option<Refusal> {
        if self.trouble.refuses_writes {
            return Some(Refusal::Access);
        }
        if self.is_feetech() {
            return None;
        }
        if usize::from(address) + bytes.len() > self.table.memory().len() {
            return Some(Refusal::Access);
        }
        if bytes.is_empty() {
            return Some(Refusal::Length);
        }
        let runs = Runs {
            table: &self.table,
            address,
            bytes,
        };
        let refusals = runs.flat_map(|(at, run)| Rows {
            table: &self.table,
            address: at,
            bytes: run,
        });
        let refusals = refusals.filter_map(|(at, row, value)| self.check_row(at, row, value));
        self.unit.precedence.choose(refusals)
    }

    /// Writes `bytes` at `address`, or nothing.
    pub(super) fn write(&mut self, at_ns: u64, address: u16, bytes: &[u8]) -> Option<Refusal> {
        if let Some(refusal) = self.check_write(address, bytes) {
            self.counters.refused_writes += 1;
            return Some(refusal);
        }
        let (mut written, mut changed) = (Regs::default(), Regs::default());
        let mut done = 0;
        while done < bytes.len() {
            let at = self.table.resolve(address + done as u16);
            let Some((row_address, size)) = self.row_span(at) else {
                done += 1;
                continue;
            };
            let from = usize::from(at - row_address) % size;
            let count = (size - from).min(bytes.len() - done);
            let value = &bytes[done..done + count];
            done += count;
            let Some(has_changed) = self.put(at, value) else {
                continue;
            };
            if let Some(reg) = self.table.known_at(row_address) {
                written.insert(reg);
                if has_changed {
                    changed.insert(reg);
                }
            }
        }
        self.set_off(at_ns, written, changed);
        None
    }

    /// First address and size of the row over `at`.
    fn row_span(&self, at: u16) -> Option<(u16, usize)> {
        let row = self.table.row_covering(at)?;
        Some((row.address, usize::from(row.size)))
    }

    /// Puts `bytes` of one row at `at`; whether that changed it, or none if the servo leaves it as it was.
    fn put(&mut self, at: u16, bytes: &[u8]) -> Option<bool> {
        let row = self.table.row_covering(at)?;
        let (is_eeprom, size) = (row.area == Area::Eeprom, usize::from(row.size));
        let feetech = self.is_feetech();
        if feetech && !Table::is_writable(row) {
            return None;
        }
        if feetech && bytes.len() == size {
            let value = self.table.decode(row, bytes);
            if self.facts.protocol == ServoProtocol::Sts
                && self.table.known_at(at) == Some(Reg::TorqueEnable)
                && value == CALIBRATE
            {
                self.calibrate(self.facts.centre);
                return None;
            }
            if !is_legal(row, value) {
                self.counters.refused_writes += 1;
                return None;
            }
        }
        // An AX or MX that is locked stays so until power is off; rustypot, which tried it, says that a 0 changes nothing.
        let locks = self.table.known_at(at) == Some(Reg::Lock) && !feetech;
        if locks && self.table.get(Reg::Lock) != 0 {
            return None;
        }
        let start = usize::from(at);
        let changes = self.table.memory()[start..start + bytes.len()] != *bytes;
        let keeps = is_eeprom && !(feetech && self.table.get(Reg::Lock) != 0);
        self.table.put(at, bytes, keeps);
        if keeps {
            self.counters.eeprom_writes += 1;
            self.counters.eeprom_changes += u64::from(changes);
            self.eeprom_bytes_written += bytes.len() as u64;
        }
        Some(changes)
    }

    /// Why the value that `bytes` would give the row over `at` is not taken. None of bytes: not enough.
    fn check_row(&self, at: u16, row: Option<&Register>, bytes: Option<&[u8]>) -> Option<Refusal> {
        let Some(row) = row else {
            return Some(Refusal::Access);
        };
        let is_start = (at - row.address).is_multiple_of(u16::from(row.size));
        let locked = row.area == Area::Eeprom && (self.torque_is_on() || self.table.get(Reg::Lock) != 0);
        if !Table::is_writable(row) || locked || !is_start {
            return Some(Refusal::Access);
        }
        let Some(bytes) = bytes else {
            return Some(Refusal::Length);
        };
        self.check_value(row, self.table.decode(row, bytes))
    }

    fn check_value(&self, row: &Register, value: i64) -> Option<Refusal> {
        let reg = self.table.known_at(row.address);
        let is_goal = matches!(
            reg,
            Some(Reg::GoalTorque | Reg::GoalCurrent | Reg::GoalVelocity | Reg::GoalPosition)
        );
        if self.watchdog_has_tripped() && (is_goal || reg == Some(Reg::BusWatchdog) && value != 0) {
            return Some(Refusal::Range);
        }
        let is_time =
            matches!(reg, Some(Reg::ProfileVelocity | Reg::ProfileAcceleration)) && self.is_time_based();
        if !is_legal(row, value) || is_time && value > TIME_MAX {
            return Some(Refusal::Range);
        }
        let limit = |name: &Option<String>| {
            name.as_deref()
                .and_then(|name| self.table.row_named(name))
                .map(|row| self.table.value(row))
        };
        if limit(&row.magnitude_register).is_some_and(|limit| value.abs() > limit) {
            return Some(Refusal::Limit);
        }
        if reg == Some(Reg::GoalPosition) && self.mode() != Mode::Position {
            return (value.abs() > EXTENDED_MAX).then_some(Refusal::Range);
        }
        let below = limit(&row.min_register).is_some_and(|min| value < min);
        let above = limit(&row.max_register).is_some_and(|max| value > max);
        (below || above).then_some(Refusal::Limit)
    }
}

/// Whether `row` takes `value` at all.
fn is_legal(row: &Register, value: i64) -> bool {
    (row.values.is_empty() || row.values.contains(&value))
        && row.min.is_none_or(|min| value >= min)
        && row.max.is_none_or(|max| value <= max)
}

impl Precedence {
    /// Which of several refusals, in the order of their addresses, is told.
    fn choose(self, mut refusals: impl Iterator<Item = Refusal>) -> Option<Refusal> {
        let number = |refusal: &Refusal| super::dynamixel2::packet::error_number(Some(*refusal));
        match self {
            Self::FirstAddress => refusals.next(),
            Self::LowestNumber => refusals.min_by_key(number),
            Self::HighestNumber => refusals.max_by_key(number),
        }
    }
}

/// A write cut where its bytes stop being neighbours, which only indirect data can do.
struct Runs<'a, 'b> {
    table: &'a Table,
    address: u16,
    bytes: &'b [u8],
}

impl<'b> Iterator for Runs<'_, 'b> {
    type Item = (u16, &'b [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.bytes.is_empty() {
            return None;
        }
        let first = self.table.resolve(self.address);
        let neighbours = (0..self.bytes.len() as u16)
            .take_while(|&step| self.table.resolve(self.address + step) == first + step)
            .count();
        let (run, rest) = self.bytes.split_at(neighbours);
        self.address += neighbours as u16;
        self.bytes = rest;
        Some((first, run))
    }
}

/// Neighbouring bytes cut into values: where, of which row, and its bytes if they are all there.
struct Rows<'a, 'b> {
    table: &'a Table,
    address: u16,
    bytes: &'b [u8],
}

impl<'a, 'b> Iterator for Rows<'a, 'b> {
    type Item = (u16, Option<&'a Register>, Option<&'b [u8]>);

    fn next(&mut self) -> Option<Self::Item> {
        if self.bytes.is_empty() {
            return None;
        }
        let (at, row) = (self.address, self.table.row_covering(self.address));
        let size = row.map_or(1, |row| usize::from(row.size));
        let (value, rest) = self.bytes.split_at_checked(size).unwrap_or((&[], &[]));
        self.address = self.address.saturating_add(size as u16);
        self.bytes = rest;
        Some((at, row, (!value.is_empty()).then_some(value)))
    }
}
