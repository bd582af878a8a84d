//! A device that can be served, and what the loop must know of it.

use device_profiles::InputProfile;
use firmware_sim::dial_box::Output;
use firmware_sim::hands::Hands;
use firmware_sim::script::{self, ScriptError};
use firmware_sim::wacom_iv::Model;
use firmware_sim::{Firmware, Script, SerialDevice, ServoBus, SgiDialBox, WacomIv};

use super::ServeError;
use super::eeprom::Eeprom;

/// A simulated device ready to be served.
pub enum Served {
    /// Dials and keys.
    DialBox(Box<SgiDialBox>),
    /// Pen and puck.
    Tablet(Box<WacomIv>),
    /// Any other input device on a serial line.
    Serial(Box<dyn SerialDevice>),
    /// Servos, at a line speed, with memories that are kept if a folder is given.
    Bus(Box<ServoBus>, u32, Option<Eeprom>),
}

impl Served {
    /// The input device a profile describes, switched on; none where nothing of its format is simulated. A board that
    /// restarts when its port opens begins by booting: who opens a pseudo-terminal later is not seen.
    pub fn input(profile: &InputProfile) -> Option<Self> {
        Some(match profile.format.as_str() {
            "sgi-dial-box" => Self::DialBox(Box::new(SgiDialBox::new(profile.into()))),
            "wacom-iv" => Self::Tablet(Box::new(WacomIv::new(Model::from(profile), 0))),
            _ => {
                let mut device = firmware_sim::serial_device(profile)?;
                device.port_opened(0);
                Self::Serial(device)
            }
        })
    }

    /// Reads a script for this device; a bus has none.
    pub fn script(&self, text: &str) -> Result<Script, Vec<ScriptError>> {
        match self {
            Self::DialBox(_) => Script::parse(script::Device::DIAL_BOX, text),
            Self::Tablet(_) => Script::parse(script::Device::Tablet, text),
            Self::Serial(device) => Script::parse(device.controls(), text),
            Self::Bus(..) => Ok(Script::default()),
        }
    }

    pub(super) fn firmware(&mut self) -> &mut dyn Firmware {
        match self {
            Self::DialBox(dial_box) => &mut **dial_box,
            Self::Tablet(tablet) => &mut **tablet,
            Self::Serial(device) => &mut **device,
            Self::Bus(bus, ..) => &mut **bus,
        }
    }

    /// Plays a script; a bus has no hands on it and plays nothing.
    pub fn play(&mut self, script: &Script) {
        match self {
            Self::DialBox(dial_box) => dial_box.play(script),
            Self::Tablet(tablet) => tablet.play(script),
            Self::Serial(device) => device.play(script),
            Self::Bus(..) => {}
        }
    }

    /// The device's own line speed.
    pub fn baud(&self) -> u32 {
        match self {
            Self::DialBox(_) => firmware_sim::dial_box::BAUD,
            Self::Tablet(_) => firmware_sim::wacom_iv::BAUD,
            Self::Serial(device) => device.line().0,
            Self::Bus(_, baud, _) => *baud,
        }
    }

    /// When there is something to hand over: of a bus, whole answers, for a host that is woken for every byte of
    /// one has little time left; of the slow lines, each byte.
    pub(super) fn wakes_us(&self, now_us: u64) -> Option<u64> {
        match self {
            Self::DialBox(dial_box) => dial_box.next_byte_us(),
            Self::Tablet(tablet) => tablet.next_byte_us(),
            Self::Serial(device) => device.next_byte_us(),
            Self::Bus(bus, ..) => {
                let next_us = bus.next_byte_us()?;
                let answer_us = bus.statuses().last().map(|answer| answer.last_us + 1);
                answer_us.filter(|&end_us| end_us > now_us).or(Some(next_us))
            }
        }
    }

    /// Takes what the host has made the device show, with the time since reporting began.
    pub(super) fn drain_outputs(&mut self, take: &mut dyn FnMut(u64, &Output)) {
        match self {
            Self::DialBox(dial_box) => {
                let since_us = dial_box.reporting_since_us().unwrap_or(u64::MAX);
                for (at_us, output) in dial_box.drain_outputs() {
                    take(at_us.saturating_sub(since_us), &output);
                }
            }
            Self::Serial(device) => {
                let since_us = device.reporting_since_us().unwrap_or(u64::MAX);
                device.drain_outputs(&mut |at_us, output| take(at_us.saturating_sub(since_us), &output));
            }
            Self::Tablet(_) | Self::Bus(..) => {}
        }
    }

    pub(super) fn keep(&mut self) -> Result<(), ServeError> {
        match self {
            Self::Bus(bus, _, Some(eeprom)) => eeprom.keep(bus),
            _ => Ok(()),
        }
    }
}
