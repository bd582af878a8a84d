//! What is plugged in, and which profile it is.
//!
//! Knows: what the system tells of devices without opening them ([`Found`]), how that is held against the profiles
//! ([`judge`]), which drivers get in the way ([`holder`]), which rule grants the right to open ([`rules`]), and, where a person wants
//! it, who is at a serial line ([`ask`]). Must not
//! know: what anybody does with a device, and any one device's facts: those are in the profiles.
//!
//! Start at [`list`], then [`judge`].

mod asking;
mod drivers;
mod found;
mod matching;
mod midi;
mod nodeless;
mod open;
mod rules;
mod strings;
mod sysfs;

pub use asking::ask;
pub use drivers::{Holder, holder};
pub use found::{Access, Found};
pub use matching::{Verdict, judge};
pub use nodeless::{MODPROBE_FILE, module_options, remedy as nodeless_remedy};
pub use open::open;
pub use rules::{RULES_FILE, rules};
pub use strings::Strings;

use crate::transport::ports;
use device_profiles::Bus;
use std::path::{Path, PathBuf};

/// Where the system describes its devices.
#[derive(Clone, Debug)]
pub struct Places {
    /// The kernel's description of devices, `/sys`.
    pub sys: PathBuf,
    /// Device nodes, `/dev`.
    pub dev: PathBuf,
    /// Processes, `/proc`.
    pub proc: PathBuf,
}

impl Default for Places {
    fn default() -> Self {
        Self {
            sys: "/sys".into(),
            dev: "/dev".into(),
            proc: "/proc".into(),
        }
    }
}

/// All HID devices, MIDI nodes and serial ports, in the order of their addresses; also HID devices that the kernel
/// gives no node to, by the address of their interface. Nothing is opened.
pub fn list(places: &Places) -> Vec<Found> {
    let mut found = sysfs::hid(&places.sys, &places.dev);
    found.extend(nodeless::devices(places, &found));
    found.extend(midi::nodes(places));
    found.extend(midi::library_ports());
    found.extend(ports::list().into_iter().map(|port| serial(port, &places.sys)));
    found.sort_by(|a, b| a.address.cmp(&b.address));
    found
}

fn serial(port: ports::Found, sys: &Path) -> Found {
    let mut found = Found::new(&port.path, Bus::Serial);
    found.access = if port.allowed {
        Access::Allowed
    } else {
        Access::Forbidden
    };
    sysfs::above_serial(sys, &mut found);
    if let Some(usb) = port.usb {
        found.vendor = Some(usb.vendor);
        found.product = Some(usb.product);
        found.serial = usb.serial;
        found.maker = usb.manufacturer;
        found.title = usb.name;
    }
    found
}

#[cfg(test)]
mod tests;
