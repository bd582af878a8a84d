//! What is wrong with one servo: how it differs, for a while, from what its maker meant it to be.

use super::fault::ServoFault;
use super::reg::Reg;
use super::servo::Servo;
use device_profiles::Role;

/// What is wrong between a servo and its wire.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Trouble {
    pub(super) deaf: bool,
    pub(super) refuses_writes: bool,
    pub(super) no_fast_read: bool,
    /// The speed it speaks at, if it is none that its register can hold.
    pub(super) odd_baud: Option<u32>,
}

impl Servo {
    /// `fault` begins; what is remembered of before, for its end.
    pub(super) fn suffer(&mut self, at_ns: u64, fault: ServoFault) -> i64 {
        self.advance(at_ns);
        match fault {
            ServoFault::Stuck => self.plant.stuck = true,
            ServoFault::Silent => self.silent = true,
            ServoFault::Deaf => self.trouble.deaf = true,
            ServoFault::Hot(celsius) => self.set_temperature(at_ns, Some(celsius)),
            ServoFault::HardwareError(bits) => self.raise(at_ns, bits),
            ServoFault::Load(share) => self.plant.load.share = share,
            ServoFault::Pull(nm) => self.plant.load.pull_nm = nm,
            ServoFault::Carries { kg, metres } => self.plant.load.carry(kg, metres),
            ServoFault::Backlash(degrees) => self.plant.backlash_rad = degrees.to_radians(),
            ServoFault::Jitter(counts) => self.plant.jitter_counts = counts,
            ServoFault::Reboot => self.reboot(at_ns),
            ServoFault::Id(id) => return self.exchange(Reg::Id, i64::from(id)),
            ServoFault::Firmware(version) => return self.exchange(Reg::FirmwareVersion, i64::from(version)),
            ServoFault::Baud(baud) => return self.speak_at(baud),
            ServoFault::Lock(on) => return self.leave(Role::Lock, i64::from(on)),
            ServoFault::Has(role, value) => return self.leave(role, value),
            ServoFault::RefusesWrites => self.trouble.refuses_writes = true,
            ServoFault::NoFastRead => self.trouble.no_fast_read = true,
            ServoFault::Drift(ppm) => {
                return i64::from(std::mem::replace(&mut self.unit.drift_ppm, ppm));
            }
            // These strike its bytes on their way (`fault_run`).
            ServoFault::Drop(_) | ServoFault::Late(_) | ServoFault::Flips(_) | ServoFault::Babbles => {}
        }
        0
    }

    /// `fault` is over; `before` is what `suffer` gave.
    pub(super) fn recover(&mut self, at_ns: u64, fault: ServoFault, before: i64) {
        self.advance(at_ns);
        match fault {
            ServoFault::Stuck => self.plant.stuck = false,
            ServoFault::Silent => self.silent = false,
            ServoFault::Deaf => self.trouble.deaf = false,
            ServoFault::Hot(_) => self.set_temperature(at_ns, None),
            ServoFault::Load(_) => self.plant.load.share = 0.0,
            ServoFault::Pull(_) => self.plant.load.pull_nm = 0.0,
            ServoFault::Carries { .. } => self.plant.load.carry(0.0, 0.0),
            ServoFault::Backlash(_) => self.plant.backlash_rad = 0.0,
            ServoFault::Jitter(_) => self.plant.jitter_counts = 0.0,
            ServoFault::Id(_) => {
                self.exchange(Reg::Id, before);
            }
            ServoFault::Firmware(_) => {
                self.exchange(Reg::FirmwareVersion, before);
            }
            ServoFault::Baud(_) => {
                self.trouble.odd_baud = None;
                self.exchange(Reg::BaudRate, before);
            }
            ServoFault::Lock(_) => {
                self.leave(Role::Lock, before);
            }
            ServoFault::Has(role, _) => {
                self.leave(role, before);
            }
            ServoFault::RefusesWrites => self.trouble.refuses_writes = false,
            ServoFault::NoFastRead => self.trouble.no_fast_read = false,
            ServoFault::Drift(_) => self.unit.drift_ppm = before as i32,
            ServoFault::Reboot
            | ServoFault::HardwareError(_)
            | ServoFault::Drop(_)
            | ServoFault::Late(_)
            | ServoFault::Flips(_)
            | ServoFault::Babbles => {}
        }
    }

    /// Stores `value` in `reg`; what was there.
    fn exchange(&mut self, reg: Reg, value: i64) -> i64 {
        let before = self.table.get(reg);
        self.table.set(reg, value);
        self.table.keep_register(reg);
        before
    }

    fn speak_at(&mut self, baud: u32) -> i64 {
        let before = self.table.get(Reg::BaudRate);
        let code = self.facts.bauds.iter().find(|&&(_, known)| known == baud);
        match code.map(|&(code, _)| code) {
            Some(code) => {
                self.exchange(Reg::BaudRate, code);
            }
            None => self.trouble.odd_baud = Some(baud),
        }
        before
    }

    /// Somebody has left `value` in the register of that role; what was there. Nothing where the model lacks it.
    fn leave(&mut self, role: Role, value: i64) -> i64 {
        let Some(row) = self.table.row_of(role) else {
            return 0;
        };
        let (before, address) = (self.table.value(row), row.address);
        self.table.set_at(address, value);
        self.table.keep_at(address);
        before
    }
}
