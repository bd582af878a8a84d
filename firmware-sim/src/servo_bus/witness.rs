//! What a test may know of a servo that no byte on the wire tells.

use super::reg::Reg;
use super::servo::Servo;
use super::unit::Counters;
use device_profiles::Role;

impl Servo {
    /// Its number now.
    pub fn id(&self) -> u8 {
        self.table.get(Reg::Id) as u8
    }

    /// Where the shaft is, radians from the middle of the position range, whatever the registers say.
    pub fn true_position_rad(&self) -> f64 {
        (self.plant.position - self.facts.centre) * self.facts.rad_per_count
    }

    /// How fast the shaft turns.
    pub fn true_velocity_rad_per_s(&self) -> f64 {
        self.plant.velocity * self.facts.rad_per_count
    }

    /// Whether the motor holds.
    pub fn torque_is_on(&self) -> bool {
        self.table.get(Reg::TorqueEnable) == 1
    }

    /// Whether it has power and a cable to the host.
    pub fn is_connected(&self) -> bool {
        self.supply.is_on()
    }

    /// Temperature where its sensor is, degrees Celsius.
    pub fn temperature_c(&self) -> f64 {
        self.plant.heat.housing_c
    }

    /// Temperature of the motor's winding, which no register tells.
    pub fn winding_c(&self) -> f64 {
        self.plant.heat.winding_c
    }

    /// Volts at its terminals.
    pub fn supply_volts(&self) -> f64 {
        self.volts()
    }

    /// What its motor can do.
    #[cfg(test)]
    pub(super) fn motor(&self) -> super::plant::MotorFacts {
        self.plant.motor
    }

    /// What it draws from the supply, amperes.
    pub fn supply_amperes(&self) -> f64 {
        self.plant.supply_a
    }

    /// −1 to 1 of what the motor can pull.
    pub fn effort(&self) -> f64 {
        self.plant.effort
    }

    /// What has happened so far.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// The present value of the register with the maker's name `name`; none if the model lacks it.
    pub fn register(&self, name: &str) -> Option<i64> {
        let row = self.table.row_named(name)?;
        let known = self.table.known_at(row.address);
        Some(
            known
                .and_then(|reg| self.fresh(reg, self.stepped_ns))
                .unwrap_or_else(|| self.table.value(row)),
        )
    }

    /// The present value of the register of that role; none if the model lacks it.
    pub fn register_of(&self, role: Role) -> Option<i64> {
        let row = self.table.row_of(role)?;
        self.register(&row.name)
    }

    /// What is wrong with it, in the bits of its error byte or register.
    pub fn alarm_bits(&self) -> u8 {
        self.alarms()
    }

    /// The file name of its profile.
    pub fn model(&self) -> &str {
        &self.facts.model
    }

    /// What of its memory outlives power, from address 0, to be kept between runs.
    pub fn eeprom(&self) -> &[u8] {
        self.table.kept()
    }

    /// Puts back what `eeprom` gave. False: the length is that of another model, nothing is changed.
    pub fn restore_eeprom(&mut self, bytes: &[u8]) -> bool {
        let fits = bytes.len() == self.table.eeprom_bytes();
        if fits {
            self.table.restore(bytes);
            self.start(self.stepped_ns);
        }
        fits
    }

    /// How often its EEPROM had been written to before this program began.
    pub fn restore_wear(&mut self, eeprom_writes: u64) {
        self.counters.eeprom_writes = eeprom_writes;
    }
}
