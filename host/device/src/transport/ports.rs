//! Which serial ports there are. Pseudo-terminals are not listed: they must be named.

use rustix::fs::Access;
use serialport::SerialPortType;

/// One serial port of this machine.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Found {
    /// Where it is opened.
    pub path: String,
    /// What is known of it if it hangs on USB.
    pub usb: Option<Usb>,
    /// Whether this user may open it; whether somebody else has it open is known only by trying.
    pub allowed: bool,
}

/// What a USB serial port says about itself; texts are empty where it says nothing.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Usb {
    /// The maker's number.
    pub vendor: u16,
    /// The maker's number for the product.
    pub product: u16,
    /// Distinguishes two of a kind, where the maker took the trouble.
    pub serial: String,
    /// The maker's name.
    pub manufacturer: String,
    /// The product's name.
    pub name: String,
}

/// What grants the right to open a port that is not [`Found::allowed`].
pub const PERMISSION_HINT: &str = super::error::SERIAL_HINT;

/// All serial ports, by path. A machine that cannot list them has none.
pub fn list() -> Vec<Found> {
    // The library panics where the system does not show its devices at all, as in some containers.
    if cfg!(target_os = "linux") && !std::path::Path::new("/sys/class/tty").is_dir() {
        return Vec::new();
    }
    let mut found: Vec<_> = serialport::available_ports()
        .unwrap_or_else(|error| {
            tracing::warn!(%error, "serial ports cannot be listed");
            Vec::new()
        })
        .into_iter()
        .map(|port| Found {
            usb: usb(port.port_type),
            allowed: may_open(&port.port_name),
            path: port.port_name,
        })
        .collect();
    found.sort();
    found
}

fn usb(kind: SerialPortType) -> Option<Usb> {
    let SerialPortType::UsbPort(usb) = kind else {
        return None;
    };
    Some(Usb {
        vendor: usb.vid,
        product: usb.pid,
        serial: usb.serial_number.unwrap_or_default(),
        manufacturer: usb.manufacturer.unwrap_or_default(),
        name: usb.product.unwrap_or_default(),
    })
}

fn may_open(path: &str) -> bool {
    rustix::fs::access(path, Access::READ_OK | Access::WRITE_OK).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn listing_needs_no_ports() {
        assert!(list().is_sorted());
    }
}
