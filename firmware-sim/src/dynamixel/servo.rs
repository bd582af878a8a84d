//! One servo: its table, its motor, its own sense of time, and what happens to it without being told.
//!
//! A servo advances on a fixed grid of plant steps, so that it comes to the same state however often it is
//! looked at. Source: the maker's control table pages for the XL330-M288 and XL430-W250.

use super::plant::{Plant, STEP_NS};
use super::table::{Reg, Table};
use super::trajectory::{Plan, Shape, State};
use device_profiles::{Area, ServoProfile};

/// From power or reboot to answering. Ours; the maker gives no time.
const BOOT_NS: u64 = 250_000_000;
/// How long full effort lasts before it counts as overload. Ours; the maker says "a certain time".
const OVERLOAD_STEPS: u32 = 1000;
/// Share of what the motor has that counts as full effort.
const OVERLOAD_EFFORT: f64 = 0.98;
/// Volts lost in the cable at full effort. Ours.
const CABLE_DROP_VOLTS: f64 = 0.4;
/// Volts below which the controller itself stops. Ours.
const BROWN_OUT_VOLTS: f64 = 3.0;
/// Unit of Bus Watchdog.
const WATCHDOG_NS: u64 = 20_000_000;
/// What Bus Watchdog holds when it has run out.
const WATCHDOG_TRIPPED: i64 = -1;

/// Bits of Hardware Error Status and Shutdown.
pub(super) mod hardware {
    pub(crate) const VOLTAGE: u8 = 1 << 0;
    pub(crate) const OVERHEATING: u8 = 1 << 2;
    pub(crate) const OVERLOAD: u8 = 1 << 5;
}

/// Values of Operating Mode.
pub(super) mod mode {
    pub(crate) const CURRENT: i64 = 0;
    pub(crate) const VELOCITY: i64 = 1;
    pub(crate) const POSITION: i64 = 3;
    pub(crate) const PWM: i64 = 16;
}

/// What a read of bytes that no register covers gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gaps {
    /// Zeros: hosts do read across gaps in practice.
    #[default]
    Zeros,
    /// Error 7, as the word "undefined" in the maker's table of errors may be read.
    AccessError,
}

/// How this copy of a servo differs from the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Number on the bus, 0 to 252.
    pub id: u8,
    /// Line speed in baud; none: the bus's own.
    pub baud: Option<u32>,
    /// Firmware version; none: the profile's.
    pub firmware: Option<u8>,
    /// Where the shaft is, radians from the middle of the position range.
    pub start_rad: f64,
    /// Return Delay Time in microseconds; none: the factory's 500.
    pub return_delay_us: Option<u32>,
    /// Time from hearing an instruction to being able to answer, beside Return Delay Time. Real ones take
    /// 20 to 50 us; 0 makes the wire the only limit.
    pub turnaround_us: u32,
    /// The servo's clock is this many millionths fast.
    pub drift_ppm: i32,
    /// Supply in volts; none: in the middle of what the model allows.
    pub supply_volts: Option<f64>,
    /// What reads of undefined bytes give.
    pub gaps: Gaps,
}

impl Unit {
    /// An ideal copy with number `id`, at the bus's speed.
    pub fn new(id: u8) -> Self {
        Self {
            id,
            baud: None,
            firmware: None,
            start_rad: 0.0,
            return_delay_us: None,
            turnaround_us: 0,
            drift_ppm: 0,
            supply_volts: None,
            gaps: Gaps::default(),
        }
    }

    /// As it comes out of its box: number 1 at 57600 baud.
    pub fn factory() -> Self {
        Self {
            baud: Some(57_600),
            ..Self::new(1)
        }
    }
}

/// Gravity on a horn without torque: it sinks at a speed until it hangs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sag {
    /// Where it hangs, radians from the middle of the position range.
    pub to_rad: f64,
    /// How fast it gets there.
    pub rad_per_s: f64,
}

/// What has happened to a servo since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counters {
    /// Instructions for this servo, alone or among others.
    pub instructions: u64,
    /// Goal registers written.
    pub goal_writes: u64,
    /// Writes refused with an error.
    pub refused_writes: u64,
    /// Bytes written to EEPROM registers that changed their value.
    pub eeprom_changes: u64,
    /// Times torque went from off to on.
    pub torque_ons: u64,
    /// Times the servo switched its own torque off.
    pub shutdowns: u64,
    /// Times Bus Watchdog ran out.
    pub watchdog_trips: u64,
    /// Reboots, by instruction or by power.
    pub reboots: u64,
    /// Highest true speed while torque was on, radians per second.
    pub speed_max_rad_per_s: f64,
    /// Highest true acceleration while torque was on, radians per second squared, over one plant step.
    pub acceleration_max_rad_per_s2: f64,
}

/// Where a servo's power comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Supply {
    pub(super) volts: f64,
    /// The cable carries power and data.
    pub(super) cable: bool,
}

impl Supply {
    pub(super) fn is_on(self) -> bool {
        self.cable && self.volts >= BROWN_OUT_VOLTS
    }
}

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
    pub(super) booting_until_ns: u64,
    booted_ns: u64,
    /// Latched until reboot: Shutdown took the torque away.
    pub(super) shut_down: bool,
    forced_temperature_c: Option<f64>,
    strained_steps: u32,
}

impl Servo {
    pub(super) fn new(profile: &ServoProfile, unit: Unit, bus_baud: u32) -> Self {
        let facts = Facts::of(profile);
        let table = Table::new(profile);
        // The no-load speed is near the factory's Velocity Limit (61 rpm for the XL430, 103 for the XL330).
        let speed_max = table.get(Reg::VelocityLimit).max(1) as f64 * facts.speed_unit;
        let position = facts.centre + unit.start_rad / facts.rad_per_count;
        let mut servo = Self {
            supply: Supply {
                volts: 0.0,
                cable: true,
            },
            facts,
            table,
            plant: Plant::new(position, speed_max),
            plan: Plan::rest(position),
            plan_from_ns: 0,
            counters: Counters::default(),
            registered: Vec::new(),
            backup: Vec::new(),
            stepped_ns: 0,
            last_heard_ns: 0,
            sag: None,
            silent: false,
            booting_until_ns: 0,
            booted_ns: 0,
            shut_down: false,
            forced_temperature_c: None,
            strained_steps: 0,
            unit,
        };
        servo.supply.volts = servo.nominal_volts();
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
        self.table.set(Reg::HardwareErrorStatus, 0);
        self.booting_until_ns = at_ns + BOOT_NS;
        self.start_ram(at_ns);
    }

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

    /// What the supply has when nothing is wrong with it.
    pub(super) fn nominal_volts(&self) -> f64 {
        self.unit.supply_volts.unwrap_or_else(|| self.middle_volts())
    }

    fn middle_volts(&self) -> f64 {
        let init = |reg| self.table.row(reg).and_then(|row| row.init).unwrap_or(0) as f64 / 10.0;
        f64::midpoint(init(Reg::MinVoltageLimit), init(Reg::MaxVoltageLimit))
    }

    pub(super) fn set_temperature(&mut self, at_ns: u64, celsius: Option<f64>) {
        self.advance(at_ns);
        self.forced_temperature_c = celsius;
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
            let (state, _) = self.trajectory(self.stepped_ns);
            self.plant.follow(state.position);
            let unit = self.facts.rad_per_count;
            let speed = self.plant.velocity.abs() * unit;
            let acceleration = (self.plant.velocity - before).abs() * unit / super::plant::STEP_SECS;
            self.counters.speed_max_rad_per_s = self.counters.speed_max_rad_per_s.max(speed);
            self.counters.acceleration_max_rad_per_s2 =
                self.counters.acceleration_max_rad_per_s2.max(acceleration);
            self.watch_the_bus();
        } else {
            self.plant.coast(self.sag_per_sec());
        }
        if let Some(celsius) = self.forced_temperature_c {
            self.plant.temperature_c = celsius;
        }
        if self.supply.is_on() {
            self.watch_the_hardware();
        }
    }

    fn sag_per_sec(&self) -> f64 {
        let Some(sag) = self.sag else { return 0.0 };
        let to = self.facts.centre + sag.to_rad / self.facts.rad_per_count;
        let reach = sag.rad_per_s.abs() / self.facts.rad_per_count;
        ((to - self.plant.position) / super::plant::STEP_SECS).clamp(-reach, reach)
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

    fn watch_the_hardware(&mut self) {
        let strained = self.torque_is_on() && self.plant.effort.abs() >= OVERLOAD_EFFORT;
        self.strained_steps = if strained { self.strained_steps + 1 } else { 0 };
        let tenths = self.voltage_tenths();
        let bad_voltage =
            tenths < self.table.get(Reg::MinVoltageLimit) || tenths > self.table.get(Reg::MaxVoltageLimit);
        let hot = self.plant.temperature_c > self.table.get(Reg::TemperatureLimit) as f64;
        let bit = |holds: bool, bit: u8| if holds { bit } else { 0 };
        let now = bit(bad_voltage, hardware::VOLTAGE)
            | bit(hot, hardware::OVERHEATING)
            | bit(self.strained_steps >= OVERLOAD_STEPS, hardware::OVERLOAD);
        let shutdown = self.table.get(Reg::Shutdown) as u8;
        let old = self.table.get(Reg::HardwareErrorStatus) as u8;
        // What Shutdown names is latched until a reboot; the rest passes with its cause.
        let latched = old & shutdown;
        let status = latched | now;
        if status != old {
            self.table.set(Reg::HardwareErrorStatus, i64::from(status));
        }
        if status & shutdown != 0 && !self.shut_down {
            self.shut_down = true;
            self.counters.shutdowns += 1;
            self.torque_off();
        }
    }

    /// Volts at the servo in tenths, as Present Input Voltage has them.
    pub(super) fn voltage_tenths(&self) -> i64 {
        ((self.supply.volts - CABLE_DROP_VOLTS * self.plant.effort.abs()) * 10.0).round() as i64
    }

    /// The error bits set by a test rather than by the plant.
    pub(super) fn raise(&mut self, at_ns: u64, bits: u8) {
        self.advance(at_ns);
        let status = self.table.get(Reg::HardwareErrorStatus) as u8 | bits;
        self.table.set(Reg::HardwareErrorStatus, i64::from(status));
        if status & self.table.get(Reg::Shutdown) as u8 != 0 && !self.shut_down {
            self.shut_down = true;
            self.counters.shutdowns += 1;
            self.torque_off();
        }
    }

    /// Where the profile generator is at `at_ns`, and whether it is still under way.
    pub(super) fn trajectory(&self, at_ns: u64) -> (State, bool) {
        self.plan
            .at(at_ns.saturating_sub(self.plan_from_ns) as f64 * 1e-9)
    }

    pub(super) fn rest(&mut self) {
        self.plant.settle();
        self.plan = Plan::rest(self.plant.position);
        self.plan_from_ns = self.stepped_ns;
    }

    pub(super) fn torque_on(&mut self, at_ns: u64) {
        if self.torque_is_on() {
            return;
        }
        self.rest();
        self.counters.torque_ons += 1;
        self.table.set(Reg::TorqueEnable, 1);
        self.last_heard_ns = at_ns;
        self.pursue(at_ns);
    }

    pub(super) fn torque_off(&mut self) {
        self.table.set(Reg::TorqueEnable, 0);
        self.rest();
    }

    /// Plans the way to the goal registers as the operating mode understands them.
    pub(super) fn pursue(&mut self, at_ns: u64) {
        if !self.torque_is_on() {
            return;
        }
        let (from, _) = self.trajectory(at_ns);
        let speed_max = self
            .table
            .row(Reg::VelocityLimit)
            .and_then(|row| row.init)
            .unwrap_or(0) as f64;
        let share = |goal: Reg, limit: Reg| {
            let limit = self.table.row(limit).and_then(|row| row.init).unwrap_or(1).max(1);
            self.table.get(goal) as f64 / limit as f64 * speed_max
        };
        let velocity = match self.table.get(Reg::OperatingMode) {
            mode::VELOCITY => Some(self.table.get(Reg::GoalVelocity) as f64),
            mode::CURRENT => Some(share(Reg::GoalCurrent, Reg::CurrentLimit)),
            mode::PWM => Some(share(Reg::GoalPwm, Reg::PwmLimit)),
            _ => None,
        };
        self.plan = match velocity {
            Some(counts) => {
                let acceleration = match self.shape() {
                    Shape::Speed { acceleration, .. } => acceleration,
                    Shape::Step | Shape::Time { .. } => 0.0,
                };
                let sign = if self.is_reversed() { -1.0 } else { 1.0 };
                Plan::at_speed(sign * counts * self.facts.speed_unit, from, acceleration)
            }
            None => Plan::to(
                self.shaft_counts(self.table.get(Reg::GoalPosition)),
                from,
                self.shape(),
            ),
        };
        self.plan_from_ns = at_ns;
    }

    /// What Profile Velocity and Profile Acceleration ask for.
    fn shape(&self) -> Shape {
        let velocity = self.table.get(Reg::ProfileVelocity) as f64;
        let acceleration = self.table.get(Reg::ProfileAcceleration) as f64;
        if velocity <= 0.0 {
            Shape::Step
        } else if self.is_time_based() {
            let total = velocity / 1000.0;
            Shape::Time {
                total,
                acceleration: (acceleration / 1000.0).min(total / 2.0),
            }
        } else {
            Shape::Speed {
                velocity: velocity * self.facts.speed_unit,
                acceleration: acceleration * self.facts.acceleration_unit,
            }
        }
    }

    pub(super) fn is_reversed(&self) -> bool {
        self.table.get(Reg::DriveMode) & 1 != 0
    }

    pub(super) fn is_time_based(&self) -> bool {
        self.table.get(Reg::DriveMode) & 4 != 0
    }

    pub(super) fn watchdog_has_tripped(&self) -> bool {
        self.table.get(Reg::BusWatchdog) == WATCHDOG_TRIPPED
    }

    /// Homing Offset as it takes effect: ignored beyond a quarter turn in position mode.
    fn offset(&self) -> f64 {
        let offset = self.table.get(Reg::HomingOffset) as f64;
        let single_turn = self.table.get(Reg::OperatingMode) == mode::POSITION;
        if single_turn && offset.abs() > self.facts.counts_per_turn / 4.0 {
            0.0
        } else {
            offset
        }
    }

    /// The register value for shaft position `shaft`: reversed first, then offset.
    pub(super) fn register_counts(&self, shaft: f64) -> i64 {
        let turned = if self.is_reversed() {
            self.facts.counts_per_turn - shaft
        } else {
            shaft
        };
        (turned + self.offset()).round() as i64
    }

    /// The inverse of `register_counts`.
    fn shaft_counts(&self, register: i64) -> f64 {
        let turned = register as f64 - self.offset();
        if self.is_reversed() {
            self.facts.counts_per_turn - turned
        } else {
            turned
        }
    }

    /// Present Position.
    pub(super) fn present_counts(&self) -> i64 {
        self.register_counts(self.plant.position)
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
            && at_ns >= self.booting_until_ns
            && self.baud().is_some_and(|own| own.abs_diff(baud) <= own / 33)
    }

    fn baud(&self) -> Option<u32> {
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
            counts_per_turn: f64::from(profile.counts_per_turn),
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

/// What a test may know that no byte on the wire tells.
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

    /// Motor temperature in degrees Celsius.
    pub fn temperature_c(&self) -> f64 {
        self.plant.temperature_c
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

    /// The EEPROM as bytes from address 0, to be kept between runs.
    pub fn eeprom(&self) -> &[u8] {
        &self.table.memory()[..self.table.eeprom_bytes()]
    }

    /// Puts back what `eeprom` gave. False: the length is that of another model, nothing is changed.
    pub fn restore_eeprom(&mut self, bytes: &[u8]) -> bool {
        let fits = bytes.len() == self.table.eeprom_bytes();
        if fits {
            self.table.memory_mut()[..bytes.len()].copy_from_slice(bytes);
            self.start_ram(self.stepped_ns);
        }
        fits
    }
}
