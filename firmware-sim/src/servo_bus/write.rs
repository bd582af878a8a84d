//! Reading and writing the table as a host may: who may write what and when, and what a write sets off.
//!
//! Source: the maker's protocol page ("Error") and control table pages. Which error comes first when
//! several apply is not documented; here bytes are judged in the order of their addresses: access, then
//! length, then value.

use super::goal::mode;
use super::packet::error;
use super::servo::Servo;
use super::table::{Reg, Table, load};
use super::unit::Gaps;
use device_profiles::{Area, Register};

/// Largest Goal Position in the modes of several turns.
const EXTENDED_MAX: i64 = 1_048_575;
/// Largest Profile Velocity and Acceleration when they are times.
const TIME_MAX: i64 = 32_737;

impl Servo {
    /// Appends `length` bytes from `address` as they are at `at_ns`; an error number or 0.
    pub(super) fn read(&mut self, at_ns: u64, address: u16, length: u16, out: &mut Vec<u8>) -> u8 {
        let end = usize::from(address) + usize::from(length);
        if end > self.table.memory().len() {
            return error::ACCESS;
        }
        if length == 0 {
            return error::DATA_LENGTH;
        }
        let bytes = || address..address + length;
        if self.unit.gaps == Gaps::AccessError && bytes().any(|at| self.table.row_covering(at).is_none()) {
            return error::ACCESS;
        }
        self.refresh(at_ns);
        out.extend(bytes().map(|at| self.table.byte(at)));
        0
    }

    /// Whether `bytes` may be written at `address` now: an error number or 0.
    pub(super) fn check_write(&self, address: u16, bytes: &[u8]) -> u8 {
        if self.trouble.refuses_writes {
            return error::ACCESS;
        }
        if usize::from(address) + bytes.len() > self.table.memory().len() {
            return error::ACCESS;
        }
        if bytes.is_empty() {
            return error::DATA_LENGTH;
        }
        let verdicts = Runs {
            table: &self.table,
            address,
            bytes,
        }
        .map(|(at, run)| self.check_run(at, run));
        verdicts.into_iter().find(|&error| error != 0).unwrap_or(0)
    }

    /// Writes `bytes` at `address`, or nothing; an error number or 0.
    pub(super) fn write(&mut self, at_ns: u64, address: u16, bytes: &[u8]) -> u8 {
        let error = self.check_write(address, bytes);
        if error != 0 {
            self.counters.refused_writes += 1;
            return error;
        }
        let mut done = 0;
        while let Some((at, run)) = (Runs {
            table: &self.table,
            address: address + done,
            bytes: &bytes[usize::from(done)..],
        })
        .next()
        {
            let len = run.len() as u16;
            self.apply_run(at_ns, at, run);
            done += len;
        }
        0
    }

    fn check_run(&self, address: u16, bytes: &[u8]) -> u8 {
        let mut at = 0;
        while at < bytes.len() {
            let here = address + at as u16;
            let Some(row) = self.table.row_covering(here) else {
                return error::ACCESS;
            };
            let size = usize::from(row.size);
            let aligned = (here - row.address).is_multiple_of(u16::from(row.size));
            let locked = row.area == Area::Eeprom && self.torque_is_on();
            if !Table::is_writable(row) || locked || !aligned {
                return error::ACCESS;
            }
            let Some(value) = bytes.get(at..at + size) else {
                return error::DATA_LENGTH;
            };
            let error = self.check_value(row, load(value, row.signed));
            if error != 0 {
                return error;
            }
            at += size;
        }
        0
    }

    fn check_value(&self, row: &Register, value: i64) -> u8 {
        let reg = self.table.known_at(row.address);
        let is_goal = matches!(
            reg,
            Some(Reg::GoalPwm | Reg::GoalCurrent | Reg::GoalVelocity | Reg::GoalPosition)
        );
        if self.watchdog_has_tripped() && (is_goal || reg == Some(Reg::BusWatchdog) && value != 0) {
            return error::DATA_RANGE;
        }
        if !row.values.is_empty() && !row.values.contains(&value)
            || row.min.is_some_and(|min| value < min)
            || row.max.is_some_and(|max| value > max)
        {
            return error::DATA_RANGE;
        }
        let is_time =
            matches!(reg, Some(Reg::ProfileVelocity | Reg::ProfileAcceleration)) && self.is_time_based();
        if is_time && value > TIME_MAX {
            return error::DATA_RANGE;
        }
        let limit = |name: &Option<String>| {
            name.as_deref()
                .and_then(|name| self.table.row_named(name))
                .map(|row| self.table.value(row))
        };
        if limit(&row.magnitude_register).is_some_and(|limit| value.abs() > limit) {
            return error::DATA_LIMIT;
        }
        if reg == Some(Reg::GoalPosition) && self.table.get(Reg::OperatingMode) != mode::POSITION {
            return if value.abs() > EXTENDED_MAX {
                error::DATA_RANGE
            } else {
                0
            };
        }
        let below = limit(&row.min_register).is_some_and(|min| value < min);
        let above = limit(&row.max_register).is_some_and(|max| value > max);
        if below || above { error::DATA_LIMIT } else { 0 }
    }

    fn apply_run(&mut self, at_ns: u64, address: u16, bytes: &[u8]) {
        let mut at = 0;
        while at < bytes.len() {
            let here = address + at as u16;
            let Some((size, eeprom, row_address)) = self
                .table
                .row_covering(here)
                .map(|row| (usize::from(row.size), row.area == Area::Eeprom, row.address))
            else {
                return;
            };
            let start = usize::from(here);
            let value = &bytes[at..(at + size).min(bytes.len())];
            let memory = &mut self.table.memory_mut()[start..start + value.len()];
            let changed = memory != value;
            memory.copy_from_slice(value);
            self.counters.eeprom_changes += u64::from(eeprom && changed);
            if let Some(reg) = self.table.known_at(row_address) {
                self.set_off(at_ns, reg, changed);
            }
            at += size;
        }
    }

    /// What writing `reg` does beside storing a value.
    fn set_off(&mut self, at_ns: u64, reg: Reg, changed: bool) {
        match reg {
            Reg::TorqueEnable => {
                let on = self.table.get(Reg::TorqueEnable) == 1;
                // The value is stored already; a change of state wants the state before it.
                if on && changed {
                    self.table.set(Reg::TorqueEnable, 0);
                    if !self.shut_down {
                        self.torque_on(at_ns);
                    }
                } else if !on {
                    self.torque_off();
                }
            }
            Reg::OperatingMode if changed => self.change_mode(),
            Reg::GoalPosition | Reg::GoalVelocity | Reg::GoalPwm | Reg::GoalCurrent => {
                self.counters.goal_writes += 1;
                let by_goal = self.table.get(Reg::DriveMode) & 8 != 0;
                if by_goal && !self.torque_is_on() && !self.shut_down {
                    self.torque_on(at_ns);
                } else if self.goal_of_mode() == reg {
                    self.pursue(at_ns);
                }
            }
            Reg::BusWatchdog => {
                self.last_heard_ns = at_ns;
                if self.facts.watchdog_from.is_none_or(|from| self.firmware() < from) {
                    self.table.set(Reg::BusWatchdog, 0);
                }
            }
            _ => {}
        }
    }

    fn goal_of_mode(&self) -> Reg {
        match self.table.get(Reg::OperatingMode) {
            mode::VELOCITY => Reg::GoalVelocity,
            mode::CURRENT => Reg::GoalCurrent,
            mode::PWM => Reg::GoalPwm,
            _ => Reg::GoalPosition,
        }
    }

    /// A new operating mode: gains as at start, no profile, goals at their limits, turns forgotten.
    fn change_mode(&mut self) {
        for reg in [
            Reg::VelocityIGain,
            Reg::VelocityPGain,
            Reg::PositionDGain,
            Reg::PositionIGain,
            Reg::PositionPGain,
            Reg::FeedforwardSecond,
            Reg::FeedforwardFirst,
        ] {
            let init = self.table.row(reg).and_then(|row| row.init).unwrap_or(0);
            self.table.set(reg, init);
        }
        self.table.set(Reg::ProfileVelocity, 0);
        self.table.set(Reg::ProfileAcceleration, 0);
        self.table.set(Reg::GoalPwm, self.table.get(Reg::PwmLimit));
        self.table
            .set(Reg::GoalCurrent, self.table.get(Reg::CurrentLimit));
        self.table.set(Reg::GoalVelocity, 0);
        self.plant
            .recount(self.plant.position.rem_euclid(self.facts.counts_per_turn));
        self.rest();
        self.table.set(Reg::GoalPosition, self.present_counts());
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
