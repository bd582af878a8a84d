//! One servo: its table, its motor, its own sense of time, and what happens to it without being told.
//!
//! A servo advances on a fixed grid of plant steps, so that it comes to the same state however often it is
//! looked at. Source: the makers' control table pages, through the profile.

use super::hardware::{AlarmBits, Supply};
use super::heard::Framing;
use super::plant::{MotorFacts, Plant, Printed, STEP_NS, STEP_SECS};
use super::reg::Reg;
use super::table::Table;
use super::trajectory::Plan;
use super::trouble::Trouble;
use super::unit::{Counters, Sag, Unit};
use device_profiles::{Role, ServoProfile, ServoProtocol};

/// From power or reboot to answering. Ours; ROBOTIS gives no time.
const BOOT_NS: u64 = 250_000_000;
/// The same of a Feetech servo. Source: `docs/protocols/feetech.md`, "Instructions".
const FEETECH_BOOT_NS: u64 = 800_000_000;
/// Unit of Bus Watchdog.
const WATCHDOG_NS: u64 = 20_000_000;
/// What Bus Watchdog holds when it has run out.
const WATCHDOG_TRIPPED: i64 = -1;

/// Constant facts taken from the profile once.
#[derive(Clone, Debug)]
pub(super) struct Facts {
    pub(super) model: String,
    pub(super) protocol: ServoProtocol,
    pub(super) counts_per_turn: f64,
    pub(super) centre: f64,
    pub(super) rad_per_count: f64,
    /// Ends of what the encoder sees, where that is less than a turn.
    pub(super) partial: Option<[f64; 2]>,
    /// Counts per second for one count of a velocity register.
    pub(super) speed_unit: f64,
    /// Counts per second squared for one count of the acceleration register.
    pub(super) acceleration_unit: f64,
    /// Top speed without load, counts per second.
    pub(super) speed_max: f64,
    /// Line speed for each value of the register.
    pub(super) bauds: Vec<(i64, u32)>,
    pub(super) watchdog_from: Option<u8>,
    pub(super) fast_read_from: Option<u8>,
    pub(super) sync_read: bool,
    pub(super) bulk_read: bool,
    pub(super) broadcast_ping: bool,
    pub(super) eeprom_deaf_ns_per_byte: u64,
    pub(super) alarm_bits: AlarmBits,
    /// What the motor is made for.
    pub(super) rated_volts: Option<f64>,
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
    pub(super) registered: Option<(u16, Vec<u8>)>,
    pub(super) backup: Vec<u8>,
    pub(super) stepped_ns: u64,
    pub(super) last_heard_ns: u64,
    pub(super) sag: Option<Sag>,
    pub(super) supply: Supply,
    pub(super) silent: bool,
    alarms: u8,
    /// Bytes of EEPROM written by the instruction in hand.
    pub(super) eeprom_bytes_written: u64,
    /// Still busy with its EEPROM.
    deaf_until_ns: u64,
    /// Where relative moves have led to, counts.
    pub(super) step_goal: f64,
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
        let firmware = unit.firmware.unwrap_or(profile.firmware);
        let profile = &*profile.at_firmware(firmware);
        let facts = Facts::of(profile);
        let table = Table::new(profile);
        let motor = motor_of(profile, &facts);
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
            registered: None,
            eeprom_bytes_written: 0,
            deaf_until_ns: 0,
            step_goal: position,
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
        servo.table.set(Reg::FirmwareVersion, i64::from(firmware));
        servo
            .table
            .set(Reg::FirmwareMinor, i64::from(servo.unit.firmware_minor));
        servo.table.set(Reg::Id, i64::from(servo.unit.id));
        servo.set_baud(servo.unit.baud.unwrap_or(bus_baud));
        if let Some(delay_us) = servo.unit.return_delay_us {
            servo
                .table
                .set(Reg::ReturnDelayTime, i64::from(delay_us / 2).min(254));
        }
        servo.table.keep();
        servo.start(0);
        servo
    }

    fn set_baud(&mut self, baud: u32) {
        let code = self.facts.bauds.iter().find(|&&(_, known)| known == baud);
        if let Some(&(code, _)) = code {
            self.table.set(Reg::BaudRate, code);
        }
    }

    /// Everything a fresh start does to memory and motion; the shaft stays where it is.
    pub(super) fn start(&mut self, at_ns: u64) {
        self.table.wake();
        self.registered = None;
        self.set_alarms(0);
        self.shut_down = false;
        self.strained_steps = 0;
        self.booted_ns = at_ns;
        self.last_heard_ns = at_ns;
        // Turns are lost at power off: the encoder knows one turn only.
        self.forget_turns();
        self.table
            .set(Reg::BackupReady, i64::from(!self.backup.is_empty()));
        self.table.set(Reg::GoalTorque, self.table.get(Reg::TorqueLimit));
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

    /// Counts on from within one turn.
    pub(super) fn forget_turns(&mut self) {
        self.plant
            .recount(self.plant.position.rem_euclid(self.facts.counts_per_turn));
        self.rest();
    }

    /// Stops answering and starts over, as after an instruction to reboot or a new supply.
    pub(super) fn reboot(&mut self, at_ns: u64) {
        self.advance(at_ns);
        self.counters.reboots += 1;
        self.table.set(Reg::TorqueEnable, 0);
        let boot_ns = if self.is_feetech() {
            FEETECH_BOOT_NS
        } else {
            BOOT_NS
        };
        self.booting_until_ns = at_ns + boot_ns;
        self.start(at_ns);
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

    /// What is wrong with it, in the model's own bits.
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

    /// Whether it hears what began at `began_ns` on a bus at `baud`: connected, awake from the first byte on, and
    /// within three per cent of its speed.
    pub(super) fn hears(&self, began_ns: u64, baud: u32) -> bool {
        self.supply.is_on()
            && self.supply.data
            && !self.trouble.deaf
            && began_ns >= self.booting_until_ns.max(self.deaf_until_ns)
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
        let code = self.table.get(Reg::BaudRate);
        let found = self.facts.bauds.iter().find(|&&(known, _)| known == code);
        found.map(|&(_, baud)| baud)
    }

    /// Its instruction was answered at `at_ns`; if that wrote to the EEPROM it may now be busy with it.
    pub(super) fn finish_instruction(&mut self, at_ns: u64) {
        let busy_ns = self.facts.eeprom_deaf_ns_per_byte * std::mem::take(&mut self.eeprom_bytes_written);
        if busy_ns > 0 {
            self.deaf_until_ns = at_ns + busy_ns;
        }
    }

    pub(super) fn framing(&self) -> Framing {
        match self.facts.protocol {
            ServoProtocol::Dynamixel2 => Framing::Dynamixel2,
            ServoProtocol::Dynamixel1 | ServoProtocol::Sts | ServoProtocol::Scs => Framing::Summed,
        }
    }

    pub(super) fn is_feetech(&self) -> bool {
        matches!(self.facts.protocol, ServoProtocol::Sts | ServoProtocol::Scs)
    }

    pub(super) fn firmware(&self) -> u8 {
        self.table.get(Reg::FirmwareVersion) as u8
    }
}

impl Facts {
    fn of(profile: &ServoProfile) -> Self {
        let rad_per_count = profile.rad_per_count();
        let unit = |role: Role| {
            let per_count = profile.role(role).and_then(|row| row.unit_per_count);
            per_count.map_or(1.0, |si| si / rad_per_count)
        };
        let speed_unit = unit(Role::PresentVelocity);
        let acceleration = profile.move_acceleration().and_then(|row| row.unit_per_count);
        let [low, high] = profile.position_counts.map(|count| count as f64);
        let codes = (0..=u8::MAX).filter_map(|code| Some((i64::from(code), profile.baud_of_code(code)?)));
        Self {
            model: profile.key.clone(),
            protocol: profile.protocol,
            counts_per_turn: profile.counts_per_turn,
            centre: f64::from(profile.centre_counts),
            rad_per_count,
            partial: (high - low + 2.0 < profile.counts_per_turn).then_some([low, high]),
            speed_unit,
            acceleration_unit: acceleration.map_or(1.0, |si| si / rad_per_count),
            speed_max: speed_max_rad_per_s(profile, speed_unit * rad_per_count) / rad_per_count,
            bauds: codes.collect(),
            watchdog_from: profile.bus_watchdog_from_firmware,
            fast_read_from: profile.fast_sync_read_from_firmware,
            sync_read: profile.sync_read,
            bulk_read: profile.bulk_read,
            broadcast_ping: profile.broadcast_ping,
            eeprom_deaf_ns_per_byte: u64::from(profile.eeprom_deaf_us_per_byte.unwrap_or(0)) * 1000,
            alarm_bits: AlarmBits::of(profile),
            rated_volts: profile.motor.as_ref().map(|motor| motor.rated_voltage_v),
        }
    }
}

/// The motor as its maker prints it. Of a model without such numbers only the speed is known; the rest is that of a
/// small servo.
fn motor_of(profile: &ServoProfile, facts: &Facts) -> MotorFacts {
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
            no_load_rad_per_s: facts.speed_max * facts.rad_per_count,
            volts: 12.0,
            stall_a: 1.3,
            standby_a: 0.05,
            inertia_kg_m2: None,
        },
    })
}

/// Speed without load: the factory's Velocity Limit is near it where there is one (61 rpm for the XL430, 103 for
/// the XL330), else the motor's.
fn speed_max_rad_per_s(profile: &ServoProfile, unit: f64) -> f64 {
    let limit = profile.role(Role::VelocityLimit).and_then(|row| row.init);
    match (limit, &profile.motor) {
        (Some(counts), _) if counts > 0 => counts as f64 * unit,
        (_, Some(motor)) => motor.no_load_speed_rad_per_s,
        (_, None) => std::f64::consts::TAU,
    }
}
