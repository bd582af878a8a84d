//! What the Linux kernel tells of a port: `class/tty/NAME/device` leads to the interface, above it the USB device.

use super::{Adapter, UsbPlace};
use std::path::Path;

/// The kernel's name for the timer's file in a port's folder (`ftdi_sio`).
const TIMER: &str = "latency_timer";
/// How many folders above the port the USB device may be: port, interface, device.
const LEVELS_MAX: usize = 4;

/// The adapter of port `tty`, if it hangs on USB.
pub(super) fn adapter(sysfs: &Path, tty: &str) -> Option<Adapter> {
    let port = std::fs::canonicalize(sysfs.join("class/tty").join(tty).join("device")).ok()?;
    let device = port
        .ancestors()
        .take(LEVELS_MAX)
        .find(|folder| folder.join("idVendor").is_file())?;
    let interface = port
        .ancestors()
        .take(LEVELS_MAX)
        .find_map(|folder| hexadecimal(&folder.join("bInterfaceNumber")));
    let place = (|| {
        Some(UsbPlace {
            bus: decimal(&device.join("busnum"))?,
            address: decimal(&device.join("devnum"))?,
            interface: interface.unwrap_or(0).try_into().ok()?,
        })
    })();
    let timer = port.join(TIMER);
    Some(Adapter {
        tty: tty.to_owned(),
        vendor: hexadecimal(&device.join("idVendor"))?,
        product: hexadecimal(&device.join("idProduct"))?,
        serial: text(&device.join("serial")).unwrap_or_default(),
        place,
        timer: timer.is_file().then_some(timer),
    })
}

/// The timer in milliseconds.
pub(super) fn read_timer(file: &Path) -> Option<u8> {
    decimal(file)
}

fn text(file: &Path) -> Option<String> {
    std::fs::read_to_string(file)
        .ok()
        .map(|text| text.trim().to_owned())
}

fn decimal(file: &Path) -> Option<u8> {
    text(file)?.parse().ok()
}

fn hexadecimal(file: &Path) -> Option<u16> {
    u16::from_str_radix(&text(file)?, 16).ok()
}
