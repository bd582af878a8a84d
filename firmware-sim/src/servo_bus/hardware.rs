//! What a servo's own protection watches: supply, heat, strain; and the shutdown it orders.
//!
//! Source: the maker's control table pages, "Hardware Error Status", "Shutdown".

use super::reg::Reg;
use super::servo::Servo;
use device_profiles::{HardwareFault, ServoProfile};

/// How long full effort lasts before it counts as overload. Ours; the maker says "a certain time".
const OVERLOAD_STEPS: u32 = 1000;
/// Share of what the motor has at its present supply that counts as full effort.
const OVERLOAD_EFFORT: f64 = 0.98;
/// Volts lost in the cable at full effort. Ours.
const CABLE_DROP_VOLTS: f64 = 0.4;
/// Volts below which the controller itself stops. Ours.
const BROWN_OUT_VOLTS: f64 = 3.0;

/// The bits of this model's alarms and of its Shutdown register.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlarmBits {
    voltage: u8,
    heat: u8,
    overload: u8,
}

impl AlarmBits {
    pub(super) fn of(profile: &ServoProfile) -> Self {
        Self {
            voltage: profile.fault_mask(HardwareFault::InputVoltage),
            heat: profile.fault_mask(HardwareFault::Overheating),
            overload: profile.fault_mask(HardwareFault::Overload),
        }
    }
}

/// Where a servo's power comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Supply {
    pub(super) volts: f64,
    /// The cable carries power and data.
    pub(super) cable: bool,
    /// The data line reaches it.
    pub(super) data: bool,
    /// Volts that the supply line takes on the way here.
    pub(super) line_drop: f64,
}

impl Supply {
    pub(super) fn is_on(self) -> bool {
        self.cable && self.volts - self.line_drop >= BROWN_OUT_VOLTS
    }
}

impl Servo {
    /// The supply changes; below what the controller needs, the servo is off, and comes back by a reboot.
    pub(super) fn set_supply(&mut self, at_ns: u64, supply: Supply) {
        self.advance(at_ns);
        let was_on = self.supply.is_on();
        self.supply = supply;
        match (was_on, supply.is_on()) {
            (true, false) => self.torque_off(),
            (false, true) => self.reboot(at_ns),
            _ => {}
        }
    }

    /// The supply line takes this many volts on its way here.
    pub(super) fn set_line_drop(&mut self, at_ns: u64, line_drop: f64) {
        self.set_supply(
            at_ns,
            Supply {
                line_drop,
                ..self.supply
            },
        );
    }

    /// What it draws from the supply.
    pub(super) fn drawn_amperes(&self) -> f64 {
        if self.supply.is_on() {
            self.plant.supply_a
        } else {
            0.0
        }
    }

    /// What the supply has when nothing is wrong with it.
    pub(super) fn nominal_volts(&self) -> f64 {
        let rated = self.unit.supply_volts.or(self.facts.rated_volts);
        rated.unwrap_or_else(|| self.middle_volts())
    }

    fn middle_volts(&self) -> f64 {
        let init = |reg| self.table.row(reg).and_then(|row| row.init).unwrap_or(0) as f64 / 10.0;
        f64::midpoint(init(Reg::MinVoltageLimit), init(Reg::MaxVoltageLimit))
    }

    pub(super) fn set_temperature(&mut self, at_ns: u64, celsius: Option<f64>) {
        self.advance(at_ns);
        self.forced_temperature_c = celsius;
    }

    /// Once a plant step: measures, latches, shuts down.
    pub(super) fn watch_the_hardware(&mut self) {
        let strained = self.torque_is_on() && self.plant.strain >= OVERLOAD_EFFORT;
        self.strained_steps = if strained { self.strained_steps + 1 } else { 0 };
        let tenths = self.voltage_tenths();
        let bad_voltage =
            tenths < self.table.get(Reg::MinVoltageLimit) || tenths > self.table.get(Reg::MaxVoltageLimit);
        let hot = self.plant.heat.housing_c > self.table.get(Reg::TemperatureLimit) as f64;
        let bit = |holds: bool, bit: u8| if holds { bit } else { 0 };
        let bits = self.facts.alarm_bits;
        let now = bit(bad_voltage, bits.voltage)
            | bit(hot, bits.heat)
            | bit(self.strained_steps >= OVERLOAD_STEPS, bits.overload);
        let shutdown = self.table.get(Reg::Shutdown) as u8;
        let old = self.alarms();
        // What Shutdown names is latched until a reboot; the rest passes with its cause.
        let latched = old & shutdown;
        let status = latched | now;
        if status != old {
            self.set_alarms(status);
        }
        if status & shutdown != 0 && !self.shut_down {
            self.shut_down = true;
            self.counters.shutdowns += 1;
            self.torque_off();
        }
    }

    /// Volts at the servo in tenths, as Present Input Voltage has them.
    pub(super) fn voltage_tenths(&self) -> i64 {
        (self.volts() * 10.0).round() as i64
    }

    /// Volts at the servo. A supply line of known resistance takes its own share; else every servo has a short cable.
    pub(super) fn volts(&self) -> f64 {
        let cable = if self.supply.line_drop > 0.0 {
            self.supply.line_drop
        } else {
            CABLE_DROP_VOLTS * self.plant.effort.abs()
        };
        (self.supply.volts - cable).max(0.0)
    }

    /// The error bits set by a test rather than by the plant.
    pub(super) fn raise(&mut self, at_ns: u64, bits: u8) {
        self.advance(at_ns);
        let status = self.alarms() | bits;
        self.set_alarms(status);
        if status & self.table.get(Reg::Shutdown) as u8 != 0 && !self.shut_down {
            self.shut_down = true;
            self.counters.shutdowns += 1;
            self.torque_off();
        }
    }
}
