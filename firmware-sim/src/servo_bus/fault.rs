//! Faults by name: what may go wrong on a bus, when, and the text a person writes for it.
//!
//! `parse` reads the text, `words` are its words, `text` writes it back; what a fault does while it lasts is in
//! `fault_run`. Source of the words: `docs/simulator.md`, "Faults".

mod parse;
mod text;
pub(super) mod words;

use device_profiles::Role;
#[cfg(test)]
pub(super) use parse::words_of_faults;

/// Something that goes wrong. Numbers of servos are their ids on the bus when the fault begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FaultKind {
    /// With the servo of this id.
    Servo(u8, ServoFault),
    /// With every servo of the bus.
    Everyone(ServoFault),
    /// With the wire, the supply or the adapter.
    Bus(BusFault),
}

/// What goes wrong with one servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ServoFault {
    /// `stuck`: the horn is jammed; the motor pulls in vain.
    Stuck,
    /// `silent`: it hears and obeys, but does not answer.
    Silent,
    /// `deaf`: it hears nothing; torque stays as it is.
    Deaf,
    /// `hot [C]`: the motor is at this temperature.
    Hot(f64),
    /// `error BITS`: these bits of its hardware error register are raised.
    HardwareError(u8),
    /// `load SHARE`: a steady pull of −1 to 1 of what the motor has.
    Load(f64),
    /// `load XNm`: a steady pull in newton metres.
    Pull(f64),
    /// `carries Xkg at Ym`: a link with this mass so far from the axis, level at the middle of the range.
    Carries {
        /// Mass in kilograms.
        kg: f64,
        /// Distance from the axis in metres.
        metres: f64,
    },
    /// `backlash DEG`: play between motor and horn, degrees from end to end.
    Backlash(f64),
    /// `jitter COUNTS`: its encoder is off by up to this much.
    Jitter(f64),
    /// `reboot`: it starts over by itself.
    Reboot,
    /// `id K`: it has this number.
    Id(u8),
    /// `baud B`: it speaks at another speed.
    Baud(u32),
    /// `refuses writes`: every write is answered with an error.
    RefusesWrites,
    /// `firmware F`: it has this firmware version.
    Firmware(u8),
    /// `without fast read`: its firmware does not know the fast reads.
    NoFastRead,
    /// `locked`: its EEPROM lock is on; `unlocked`: it is off.
    Lock(bool),
    /// `has ROLE V`: somebody left this value in the register of that role.
    Has(Role, i64),
    /// `drop P%`: this share of its answers is lost, in parts per million.
    Drop(u32),
    /// `late D`: its answers begin this much later, in microseconds.
    Late(u64),
    /// `flips P%`: this share of the bytes it sends has a bit turned, in parts per million.
    Flips(u32),
    /// `babbles`: it puts bytes on the line that nobody asked for, after every instruction to anybody.
    Babbles,
    /// `drift PPM`: its clock is this many millionths fast.
    Drift(i32),
}

/// What goes wrong with all that is between servos and host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BusFault {
    /// `cable cut [after K]`: only the first K servos of the chain keep power and data; none without `after`.
    CableCut(usize),
    /// `data cut [after K]`: the same for the data line alone; servos keep their power.
    DataCut(usize),
    /// `drop P%`: this share of answers is lost, in parts per million.
    Drop(u32),
    /// `late D`: answers begin this much later, in microseconds.
    Late(u64),
    /// `noise [P%]`: this share of bytes has a bit turned, in parts per million.
    Noise(u32),
    /// `brownout [V]`, `supply V`: the supply has this many volts.
    Supply(f64),
    /// `cable Xohm`: resistance of the supply line from one servo to the next.
    Resistance(f64),
    /// `stall`: the adapter hands over nothing.
    Stall,
    /// `host stall`: the host neither sends nor receives; what it writes leaves when the stall is over.
    HostStall,
    /// `echo`: the adapter hears itself.
    Echo,
    /// `adapter latency D`: the adapter hands over at 62 bytes or after this long, in microseconds.
    AdapterLatency(u64),
}

/// A fault with its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// What goes wrong.
    pub kind: FaultKind,
    /// Microseconds after it is brought in; none: at once.
    pub at_us: Option<u64>,
    /// Microseconds until it is over; none: it stays.
    pub for_us: Option<u64>,
    /// Microseconds from one beginning to the next; none: it comes once.
    pub every_us: Option<u64>,
    /// It is over after it has happened to one answer or byte.
    pub once: bool,
}

/// A text that names no fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {message}")]
pub struct FaultError {
    /// Column in characters, from 1.
    pub column: u32,
    /// What was expected, what was found, and the word that may have been meant.
    pub message: String,
}

impl From<FaultKind> for Fault {
    /// At once and to stay.
    fn from(kind: FaultKind) -> Self {
        Self {
            kind,
            at_us: None,
            for_us: None,
            every_us: None,
            once: false,
        }
    }
}

impl FaultKind {
    /// Whether it is done in a moment; such a fault has no end.
    pub(super) fn is_momentary(&self) -> bool {
        matches!(
            self,
            Self::Servo(_, ServoFault::Reboot | ServoFault::HardwareError(_))
                | Self::Everyone(ServoFault::Reboot | ServoFault::HardwareError(_))
        )
    }
}
