//! Simulated devices for other programs, in real time: on a pseudo-terminal or a TCP port.
//!
//! *Knows* when a byte is due and how to wake up just then. *Must not know* what a byte means, nor print
//! anything: whoever serves gets [`Event`]s.
//! *Start reading* at [`run`].

mod bus;
mod eeprom;
mod late;
mod line;
mod orders;
mod pace;
mod served;
mod uhid;

pub use bus::{BusPlan, Habits, ServoSpec, ServoSpecError};
pub use eeprom::Eeprom;
pub use late::LateFault;
pub use line::{Place, ServeLine};
pub use served::Served;
pub use uhid::{NODE as UHID_NODE, UsbAudience, UsbServed};

// What a served device is told with and tells, for programs that must not know the firmware itself.
pub use firmware_sim::dial_box::Output;
pub use firmware_sim::midi_box::{Glow, MidiShown};
pub use firmware_sim::script::ScriptError;
pub use firmware_sim::servo_bus::{Absent, BadCrc, Gaps, InnerHeader, PlantKind, Precedence, WireTime};
pub use firmware_sim::usb_device::Shown as UsbShown;
pub use firmware_sim::{Fault, Script};

use std::io;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use device::clock::Clock;
use device::transport::TransportError;
use device_profiles::{InputKind, Profiles};
use pace::Pace;

/// Something that a served device did or that was done to it. Times are microseconds since serving began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event<'a> {
    /// The host put bytes on the line.
    HostWrote(u64, &'a [u8]),
    /// Bytes were handed to the host.
    DeviceWrote(u64, &'a [u8]),
    /// The device was told to show something. The time counts from the moment reporting began, as in scripts.
    Output(u64, &'a Output),
    /// The host set its line to another speed, baud.
    Baud(u64, u32),
    /// An order given while it ran was carried out; what there is to say to it.
    Obeyed(u64, &'a str),
    /// An order given while it ran was refused, and why.
    Refused(u64, &'a str),
}

/// A device could not be served on.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The line failed.
    #[error(transparent)]
    Line(#[from] TransportError),
    /// A servo's memory could not be kept or brought back.
    #[error("{path}: {why}", path = .path.display())]
    Eeprom {
        /// The file.
        path: PathBuf,
        /// What was wrong and what to do.
        why: String,
    },
}

impl ServeError {
    fn io(path: PathBuf, error: &io::Error) -> Self {
        Self::Eeprom {
            path,
            why: error.to_string(),
        }
    }
}

/// How many bytes are taken from the host at once: a terminal's buffer.
const READ_BYTES: usize = 4096;
/// How often servos' memories are looked at for changes worth keeping, microseconds.
const KEEP_US: u64 = 1_000_000;

/// The input devices that are simulated, by what `--kind` calls them: those on a line, and those on USB; tablets, or
/// everything else.
pub fn kinds(tablets: bool) -> (Vec<String>, Vec<String>) {
    let profiles = Profiles::builtin();
    let is_meant = |key: &str| {
        let known = profiles.input(key).ok();
        known.is_some_and(|profile| (profile.kind == InputKind::Tablet) == tablets)
    };
    let serial = profiles.inputs().filter(|profile| {
        is_meant(&profile.key)
            && firmware_sim::usb_kind(&profile.key).is_none()
            && firmware_sim::serial_device(profile).is_some()
    });
    let serial = serial.map(|profile| profile.key.clone()).collect();
    let usb = firmware_sim::USB_KINDS
        .iter()
        .filter(|kind| is_meant(kind.profile));
    (serial, usb.map(|kind| kind.name.to_owned()).collect())
}

/// Serves `device` on `line` until `stop` is set. `orders` is asked for what somebody at the keyboard wants of it now.
/// Does not print; `told` hears what happens.
pub fn run(
    device: &mut Served,
    line: &mut ServeLine,
    clock: &dyn Clock,
    stop: &AtomicBool,
    orders: &mut dyn FnMut() -> Option<String>,
    told: &mut dyn FnMut(Event<'_>),
) -> Result<(), ServeError> {
    let began = clock.now();
    let mut pace = Pace::new();
    let mut buffer = vec![0; READ_BYTES];
    let mut due = Vec::new();
    let mut keep_us = KEEP_US;
    while !stop.load(Ordering::Relaxed) {
        let now_us = clock.now().since(began).as_micros() as u64;
        if let Some(baud) = line.new_baud() {
            device.firmware().set_line_baud(now_us, baud);
            told(Event::Baud(now_us, baud));
        }
        device.strike(now_us);
        let count = line.read(&mut buffer)?;
        if let Some(bytes) = buffer.get(..count).filter(|bytes| !bytes.is_empty()) {
            device.firmware().receive(now_us, bytes);
            pace.host_wrote(now_us, count, line.baud());
            told(Event::HostWrote(now_us, bytes));
        }
        due.clear();
        device.firmware().transmit(now_us, &mut due);
        if !due.is_empty() {
            line.write(&due)?;
            told(Event::DeviceWrote(now_us, &due));
        }
        while let Some(order) = orders() {
            let done = match orders::Cable::of(&order).filter(|_| matches!(device, Served::Input(..))) {
                Some(cable) => cable.move_it(line, device, now_us),
                None => device.order(now_us, &order),
            };
            match done {
                Ok(said) => told(Event::Obeyed(now_us, &said)),
                Err(why) => told(Event::Refused(now_us, &why)),
            }
        }
        device.drain_outputs(&mut |at_us, output| told(Event::Output(at_us, output)));
        if now_us >= keep_us {
            keep_us = now_us + KEEP_US;
            device.keep()?;
        }
        pace.rest(line, clock, began, device.wakes_us(now_us));
    }
    device.keep()
}

#[cfg(test)]
mod tests;
