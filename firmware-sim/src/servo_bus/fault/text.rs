//! From a fault to the text that `parse` reads back.

use super::{BusFault, Fault, FaultKind, ServoFault};
use std::fmt;

fn percent(ppm: u32) -> f64 {
    f64::from(ppm) / 1e4
}

impl fmt::Display for ServoFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Stuck => write!(f, "stuck"),
            Self::Silent => write!(f, "silent"),
            Self::Deaf => write!(f, "deaf"),
            Self::Hot(celsius) => write!(f, "hot {celsius}"),
            Self::HardwareError(bits) => write!(f, "error {bits}"),
            Self::Load(share) => write!(f, "load {share}"),
            Self::Pull(nm) => write!(f, "load {nm}Nm"),
            Self::Carries { kg, metres } => write!(f, "carries {kg}kg at {metres}m"),
            Self::Backlash(degrees) => write!(f, "backlash {degrees}deg"),
            Self::Jitter(counts) => write!(f, "jitter {counts}"),
            Self::Reboot => write!(f, "reboot"),
            Self::Id(id) => write!(f, "id {id}"),
            Self::Baud(baud) => write!(f, "baud {baud}"),
            Self::RefusesWrites => write!(f, "refuses writes"),
            Self::Firmware(version) => write!(f, "firmware {version}"),
            Self::NoFastRead => write!(f, "without fast read"),
            Self::Lock(true) => write!(f, "locked"),
            Self::Lock(false) => write!(f, "unlocked"),
            Self::Has(role, value) => write!(f, "has {role} {value}"),
            Self::Drop(ppm) => write!(f, "drop {}%", percent(ppm)),
            Self::Late(us) => write!(f, "late {us}us"),
            Self::Flips(ppm) => write!(f, "flips {}%", percent(ppm)),
            Self::Babbles => write!(f, "babbles"),
            Self::Drift(ppm) => write!(f, "drift {ppm}ppm"),
        }
    }
}

impl fmt::Display for BusFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::CableCut(after) => write!(f, "cable cut after {after}"),
            Self::DataCut(after) => write!(f, "data cut after {after}"),
            Self::Drop(ppm) => write!(f, "drop {}%", percent(ppm)),
            Self::Late(us) => write!(f, "late {us}us"),
            Self::Noise(ppm) => write!(f, "noise {}%", percent(ppm)),
            Self::Supply(volts) => write!(f, "supply {volts}"),
            Self::Resistance(ohms) => write!(f, "cable {ohms}ohm"),
            Self::Stall => write!(f, "stall"),
            Self::HostStall => write!(f, "host stall"),
            Self::Echo => write!(f, "echo"),
            Self::AdapterLatency(us) => write!(f, "adapter latency {us}us"),
        }
    }
}

impl fmt::Display for FaultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Servo(id, fault) => write!(f, "servo {id} {fault}"),
            Self::Everyone(fault) => write!(f, "every servo {fault}"),
            Self::Bus(fault) => fault.fmt(f),
        }
    }
}

impl fmt::Display for Fault {
    /// The text that `parse` reads back.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.kind.fmt(f)?;
        let times = [("at", self.at_us), ("for", self.for_us), ("every", self.every_us)];
        for (word, time_us) in times {
            if let Some(us) = time_us {
                write!(f, " {word} {us}us")?;
            }
        }
        if self.once { write!(f, " once") } else { Ok(()) }
    }
}
