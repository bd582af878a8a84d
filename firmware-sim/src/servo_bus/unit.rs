//! What is said about one copy of a servo when it is put on the bus, and what is counted of its life.

use super::plant::PlantKind;
use device_profiles::{Role, ServoProfile};

/// What a read of bytes that no register covers gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gaps {
    /// Zeros: hosts do read across gaps in practice.
    #[default]
    Zeros,
    /// Error 7, as the word "undefined" in the maker's table of errors may be read.
    AccessError,
}

/// Which error is told when a write deserves several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precedence {
    /// That of the register with the lowest address.
    #[default]
    FirstAddress,
    /// The one with the lowest number.
    LowestNumber,
    /// The one with the highest number.
    HighestNumber,
}

/// How this copy of a servo differs from the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Number on the bus: 0 to 252 with protocol 2.0, to 253 with the others.
    pub id: u8,
    /// Line speed in baud; none: the bus's own.
    pub baud: Option<u32>,
    /// Firmware version; none: the profile's.
    pub firmware: Option<u8>,
    /// Its part after the point, where the model has one (Feetech). The newest that is reported: 10.
    pub firmware_minor: u8,
    /// Where the shaft is, radians from the middle of the position range.
    pub start_rad: f64,
    /// Return Delay Time in microseconds; none: the factory's 500.
    pub return_delay_us: Option<u32>,
    /// Time from hearing an instruction to being able to answer, beside Return Delay Time. Real ones take
    /// 20 to 50 us; 0 makes the wire the only limit.
    pub turnaround_us: u32,
    /// The servo's clock is this many millionths fast.
    pub drift_ppm: i32,
    /// Supply in volts; none: what the motor is made for, or in the middle of what the model allows.
    pub supply_volts: Option<f64>,
    /// What reads of undefined bytes give.
    pub gaps: Gaps,
    /// What its shaft is moved by.
    pub plant: PlantKind,
    /// Where the horn meets an end either way, radians from the middle of the position range; none: it turns freely.
    pub stops_rad: Option<[f64; 2]>,
    /// Which of several errors is told.
    pub precedence: Precedence,
}

impl Unit {
    /// An ideal copy with number `id`, at the bus's speed.
    pub fn new(id: u8) -> Self {
        Self {
            id,
            baud: None,
            firmware: None,
            firmware_minor: 10,
            start_rad: 0.0,
            return_delay_us: None,
            turnaround_us: 0,
            drift_ppm: 0,
            supply_volts: None,
            gaps: Gaps::default(),
            plant: PlantKind::default(),
            stops_rad: None,
            precedence: Precedence::default(),
        }
    }

    /// As it comes out of its box: an XL430 with number 1 at 57600 baud, others as their tables say.
    pub fn factory(profile: &ServoProfile) -> Self {
        let init = |role| profile.role(role).and_then(|row| row.init);
        let code = init(Role::BaudRate).and_then(|code| u8::try_from(code).ok());
        Self {
            baud: code.and_then(|code| profile.baud_of_code(code)),
            ..Self::new(init(Role::Id).map_or(1, |id| id as u8))
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
    /// Writes of an EEPROM register that were kept: each wears it.
    pub eeprom_writes: u64,
    /// Those of them that changed its value.
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
