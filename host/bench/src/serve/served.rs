//! A device that can be served, and what the loop must know of it.

use device_profiles::InputProfile;
use firmware_sim::dial_box::Output;
use firmware_sim::script::ScriptError;
use firmware_sim::{Firmware, Script, SerialDevice, ServoBus};

use super::ServeError;
use super::eeprom::Eeprom;
use super::late::{LateFault, LateFaults};

/// A simulated device ready to be served.
pub enum Served {
    /// An input device, and the faults that are still to come.
    Input(Box<dyn SerialDevice>, LateFaults),
    /// Servos, at a line speed, with memories that are kept if a folder is given.
    Bus(Box<ServoBus>, u32, Option<Eeprom>),
}

impl Served {
    /// The input device a profile describes, switched on; none where nothing of its format is simulated. A board that
    /// restarts when its port opens begins by booting: who opens a pseudo-terminal later is not seen.
    pub fn input(profile: &InputProfile) -> Option<Self> {
        let mut device = firmware_sim::serial_device(profile)?;
        device.port_opened(0);
        Some(Self::Input(device, LateFaults::default()))
    }

    /// Reads a script for this device; a bus has none.
    pub fn script(&self, text: &str) -> Result<Script, Vec<ScriptError>> {
        match self {
            Self::Input(device, _) => Script::parse(device.controls(), text),
            Self::Bus(..) => Ok(Script::default()),
        }
    }

    pub(super) fn firmware(&mut self) -> &mut dyn Firmware {
        match self {
            Self::Input(device, _) => &mut **device,
            Self::Bus(bus, ..) => &mut **bus,
        }
    }

    /// Brings a fault in when its time has come; a bus has faults of its own.
    pub fn fault(&mut self, fault: LateFault) {
        if let Self::Input(_, late) = self {
            late.add(fault);
        }
    }

    pub(super) fn strike(&mut self, now_us: u64) {
        if let Self::Input(device, late) = self {
            while let Some(fault) = late.take(device.reporting_since_us(), now_us) {
                device.inject(now_us, fault);
            }
        }
    }

    /// Plays a script; a bus has no hands on it and plays nothing.
    pub fn play(&mut self, script: &Script) {
        if let Self::Input(device, _) = self {
            device.play(script);
        }
    }

    /// The device's own line speed.
    pub fn baud(&self) -> u32 {
        match self {
            Self::Input(device, _) => device.line().0,
            Self::Bus(_, baud, _) => *baud,
        }
    }

    /// When there is something to hand over: of a bus, whole answers, for a host that is woken for every byte of
    /// one has little time left; of the slow lines, each byte.
    pub(super) fn wakes_us(&self, now_us: u64) -> Option<u64> {
        match self {
            Self::Input(device, _) => device.next_byte_us(),
            Self::Bus(bus, ..) => {
                let next_us = bus.next_byte_us()?;
                let answer_us = bus.statuses().last().map(|answer| answer.last_us + 1);
                answer_us.filter(|&end_us| end_us > now_us).or(Some(next_us))
            }
        }
    }

    /// Takes what the host has made the device show, with the time since reporting began.
    pub(super) fn drain_outputs(&mut self, take: &mut dyn FnMut(u64, &Output)) {
        if let Self::Input(device, _) = self {
            let since_us = device.reporting_since_us().unwrap_or(u64::MAX);
            device.take_outputs(&mut |at_us, output| take(at_us.saturating_sub(since_us), &output));
        }
    }

    pub(super) fn keep(&mut self) -> Result<(), ServeError> {
        match self {
            Self::Bus(bus, _, Some(eeprom)) => eeprom.keep(bus),
            _ => Ok(()),
        }
    }
}
