//! One servo: its table, its motor, its own sense of time, and what happens to it without being told.
//!
//! A servo advances on a fixed grid of plant steps, so that it comes to the same state however often it is
//! looked at. Source: the maker's control table pages for the XL330-M288 and XL430-W250.

use super::hardware::Supply;
use super::plant::{MotorFacts, Plant, Printed, STEP_NS, STEP_SECS};
use super::table::{Reg, Table};
use super::trajectory::Plan;
use super::trouble::Trouble;
use super::unit::{Counters, Sag, Unit};
use device_profiles::{Area, ServoProfile};

/// From power or reboot to answering. Ours; the maker gives no time.
const BOOT_NS: u64 = 250_000_000;
/// Unit of Bus Watchdog.
const WATCHDOG_NS: u64 = 20_000_000;
/// What Bus Watchdog holds when it has run out.
const WATCHDOG_TRIPPED: i64 = -1;

/// Constant facts taken from the profile once.
#[derive(Clone, Debug)]
pub(super) struct Facts {
    pub(super) counts_per_turn: f64,
    pub(super) centre: f64,
    pub(super) rad_per_count: f64,
    /// Counts per second for one count of a velocity register.
    pub(super) speed_unit: f64,
    /// Counts per second squared for one count of Profile Acceleration.
    pub(super) acceleration_unit: f64,
    pub(super) bauds: Vec<u32>,
    pub(super) watchdog_from: Option<u8>,
    pub(super) fast_read_from: Option<u8>,
}

/// A servo on the bus.
#[derive(Clone, Debug)]
pub struct Servo {
    pub(super) unit: Unit,
    pub(super) facts: Facts,
    pub(super) table: Table,
    pub(super) plant: Plant,
    pub(super) plan: Plan,
    pub(super) plan_from_ns: u64,
    pub(super) counters: Counters,
    pub(super) registered: Vec<u8>,
    pub(super) backup: Vec<u8>,
    pub(super) stepped_ns: u64,
    pub(super) last_heard_ns: u64,
    pub(super) sag: Option<Sag>,
    pub(super) supply: Supply,
    pub(super) silent: bool,
    alarms: u8,
    pub(super) booting_until_ns: u64,
    booted_ns: u64,
    /// Latched until reboot: Shutdown took the torque away.
    pub(super) shut_down: bool,
    pub(super) forced_temperature_c: Option<f64>,
    pub(super) trouble: Trouble,
    pub(super) strained_steps: u32,
}

impl Servo {
    pub(super) fn new(profile: &ServoProfile, unit: Unit, bus_baud: u32) -> Self {
        let facts = Facts::of(profile);
        let table = Table::new(profile);
        let motor = motor_of(profile, &table, &facts);
        let position = facts.centre + unit.start_rad / facts.rad_per_count;
        let mut servo = Self {
            supply: Supply {
                volts: 0.0,
                cable: true,
                data: true,
                line_drop: 0.0,
            },
            plant: Plant::new(position, facts.centre, facts.rad_per_count, motor, unit.plant),
            facts,
            table,
            plan: Plan::rest(position),
            plan_from_ns: 0,
            counters: Counters::default(),
            registered: Vec::new(),
            backup: Vec::new(),
            stepped_ns: 0,
            last_heard_ns: 0,
            sag: None,
            silent: false,
            alarms: 0,
            booting_until_ns: 0,
            booted_ns: 0,
            shut_down: false,
            forced_temperature_c: None,
            trouble: Trouble::default(),
            strained_steps: 0,
            unit,
        };
        servo.supply.volts = servo.nominal_volts();
        servo.set_stops(servo.unit.stops_rad);
        servo.table.set(Reg::ModelNumber, i64::from(profile.model_number));
        servo.table.set(
            Reg::FirmwareVersion,
            i64::from(servo.unit.firmware.unwrap_or(profile.firmware)),
        );
        servo.table.set(Reg::Id, i64::from(servo.unit.id));
        servo.set_baud(servo.unit.baud.unwrap_or(bus_baud));
        if let Some(delay_us) = servo.unit.return_delay_us {
            servo
                .table
                .set(Reg::ReturnDelayTime, i64::from(delay_us / 2).min(254));
        }
        servo.start_ram(0);
        servo
    }

    fn set_baud(&mut self, baud: u32) {
        if let Some(code) = self.facts.bauds.iter().position(|&known| known == baud) {
            self.table.set(Reg::BaudRate, code as i64);
        }
    }

    /// Everything a fresh start does to RAM and motion; the shaft stays where it is.
    pub(super) fn start_ram(&mut self, at_ns: u64) {
        self.table.start_values(Area::Ram);
        self.registered.clear();
        self.shut_down = false;
        self.strained_steps = 0;
        self.booted_ns = at_ns;
        self.last_heard_ns = at_ns;
        // Turns are lost at power off: the encoder knows one turn only.
        self.plant
            .recount(self.plant.position.rem_euclid(self.facts.counts_per_turn));
        self.rest();
        self.table
            .set(Reg::BackupReady, i64::from(!self.backup.is_empty()));
        self.table.set(Reg::GoalPwm, self.table.get(Reg::PwmLimit));
        self.table
            .set(Reg::GoalCurrent, self.table.get(Reg::CurrentLimit));
        self.table.set(Reg::GoalPosition, self.present_counts());
        if self.table.get(Reg::StartupConfiguration) & 2 == 2 {
            self.restore_ram();
        }
        if self.table.get(Reg::StartupConfiguration) & 1 == 1 {
            self.torque_on(at_ns);
        }
    }

    /// Stops answering and starts over, as after an instruction to reboot or a new supply.
    pub(super) fn reboot(&mut self, at_ns: u64) {
        self.advance(at_ns);
        self.counters.reboots += 1;
        self.table.set(Reg::TorqueEnable, 0);
        self.set_alarms(0);
        self.booting_until_ns = at_ns + BOOT_NS;
        self.start_ram(at_ns);
    }

    /// Plant steps up to `to_ns`, on the grid that began at zero.
    pub(super) fn advance(&mut self, to_ns: u64) {
        while self.stepped_ns + STEP_NS <= to_ns {
            self.stepped_ns += STEP_NS;
            self.step();
        }
    }

    fn step(&mut self) {
        let before = self.plant.velocity;
        if self.torque_is_on() {
            let order = self.order();
            self.plant.drive(order, self.volts());
            let unit = self.facts.rad_per_count;
            let speed = self.plant.velocity.abs() * unit;
            let acceleration = (self.plant.velocity - before).abs() * unit / STEP_SECS;
            self.counters.speed_max_rad_per_s = self.counters.speed_max_rad_per_s.max(speed);
            self.counters.acceleration_max_rad_per_s2 =
                self.counters.acceleration_max_rad_per_s2.max(acceleration);
            self.watch_the_bus();
        } else {
            self.plant.coast(self.sag_per_sec());
        }
        if let Some(celsius) = self.forced_temperature_c {
            self.plant.heat.housing_c = celsius;
        }
        if self.supply.is_on() {
            self.watch_the_hardware();
        }
    }

    fn sag_per_sec(&self) -> f64 {
        let Some(sag) = self.sag else { return 0.0 };
        let to = self.facts.centre + sag.to_rad / self.facts.rad_per_count;
        let reach = sag.rad_per_s.abs() / self.facts.rad_per_count;
        ((to - self.plant.position) / STEP_SECS).clamp(-reach, reach)
    }

    fn watch_the_bus(&mut self) {
        let armed = self.table.get(Reg::BusWatchdog);
        if armed > 0 && self.stepped_ns.saturating_sub(self.last_heard_ns) > armed as u64 * WATCHDOG_NS {
            self.table.set(Reg::BusWatchdog, WATCHDOG_TRIPPED);
            self.counters.watchdog_trips += 1;
            let (state, _) = self.trajectory(self.stepped_ns);
            self.plan = Plan::rest(state.position);
            self.plan_from_ns = self.stepped_ns;
            self.table
                .set(Reg::GoalPosition, self.register_counts(state.position));
            self.table.set(Reg::GoalVelocity, 0);
        }
    }

    pub(super) fn watchdog_has_tripped(&self) -> bool {
        self.table.get(Reg::BusWatchdog) == WATCHDOG_TRIPPED
    }

    /// What is wrong with it, in bits that are the same in every protocol: 0 voltage, 2 heat, 5 overload.
    pub(super) fn alarms(&self) -> u8 {
        self.alarms
    }

    /// Also shown in Hardware Error Status, where the model has it.
    pub(super) fn set_alarms(&mut self, bits: u8) {
        self.alarms = bits;
        self.table.set(Reg::HardwareErrorStatus, i64::from(bits));
    }

    /// Milliseconds since start by the servo's own clock.
    pub(super) fn tick_ms(&self, at_ns: u64) -> i64 {
        let own = at_ns.saturating_sub(self.booted_ns) as f64 * (1.0 + f64::from(self.unit.drift_ppm) * 1e-6);
        (own / 1e6) as i64 % 32_768
    }

    /// Return Delay Time and turnaround in true nanoseconds.
    pub(super) fn delay_ns(&self) -> u64 {
        let own_ns =
            self.table.get(Reg::ReturnDelayTime) as u64 * 2000 + u64::from(self.unit.turnaround_us) * 1000;
        crate::line::shortened(own_ns, self.unit.drift_ppm)
    }

    /// Whether it hears a bus at `baud` at `at_ns`: connected, awake, and within three per cent of its speed.
    pub(super) fn hears(&self, at_ns: u64, baud: u32) -> bool {
        self.supply.is_on()
            && self.supply.data
            && !self.trouble.deaf
            && at_ns >= self.booting_until_ns
            && self.baud().is_some_and(|own| self.understands(own, baud))
    }

    /// Three per cent between two clocks are harmless.
    fn understands(&self, own: u32, baud: u32) -> bool {
        let own = f64::from(own) * (1.0 + f64::from(self.unit.drift_ppm) * 1e-6);
        (own - f64::from(baud)).abs() <= own / 33.0
    }

    fn baud(&self) -> Option<u32> {
        if self.trouble.odd_baud.is_some() {
            return self.trouble.odd_baud;
        }
        self.facts
            .bauds
            .get(self.table.get(Reg::BaudRate) as usize)
            .copied()
    }

    pub(super) fn firmware(&self) -> u8 {
        self.table.get(Reg::FirmwareVersion) as u8
    }
}

impl Facts {
    fn of(profile: &ServoProfile) -> Self {
        let rad_per_count = profile.rad_per_count();
        let unit = |name: &str| {
            profile
                .register(name)
                .and_then(|row| row.unit_per_count)
                .map_or(1.0, |si| si / rad_per_count)
        };
        Self {
            counts_per_turn: profile.counts_per_turn,
            centre: f64::from(profile.centre_counts),
            rad_per_count,
            speed_unit: unit("Present Velocity"),
            acceleration_unit: unit("Profile Acceleration"),
            bauds: profile.bauds.clone(),
            watchdog_from: profile.bus_watchdog_from_firmware,
            fast_read_from: profile.fast_sync_read_from_firmware,
        }
    }
}

/// The motor as its maker prints it. Of a model without such numbers only the speed is known: the factory's
/// velocity limit is near it (61 rpm for the XL430, 103 for the XL330); the rest is that of a small servo.
fn motor_of(profile: &ServoProfile, table: &Table, facts: &Facts) -> MotorFacts {
    let limit = table.get(Reg::VelocityLimit).max(1) as f64;
    MotorFacts::of(match &profile.motor {
        Some(motor) => Printed {
            stall_nm: motor.stall_torque_nm,
            no_load_rad_per_s: motor.no_load_speed_rad_per_s,
            volts: motor.rated_voltage_v,
            stall_a: motor.stall_current_a,
            standby_a: motor.standby_current_a.unwrap_or(0.0),
            inertia_kg_m2: Some(motor.rotor_inertia_kg_m2),
        },
        None => Printed {
            stall_nm: 1.0,
            no_load_rad_per_s: limit * facts.speed_unit * facts.rad_per_count,
            volts: 12.0,
            stall_a: 1.3,
            standby_a: 0.05,
            inertia_kg_m2: None,
        },
    })
}
