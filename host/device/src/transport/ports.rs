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

/// The port of the USB adapter or device with this serial number, wherever it is plugged in at the moment. An
/// adapter with several ports has its first. Where devices of different kinds share a number none of them is
/// taken; two of one kind that share it look like one adapter with two ports.
pub fn of_usb_serial<'a>(ports: &'a [Found], serial: &str) -> Option<&'a Found> {
    let same = |port: &&Found| port.usb.as_ref().is_some_and(|usb| usb.serial == serial);
    let mut found: Vec<&Found> = ports.iter().filter(same).collect();
    found.sort_by_key(|port| by_number(&port.path));
    let first = *found.first()?;
    let alike = found.iter().all(|port| port.usb == first.usb);
    (alike || found.len() == 1).then_some(first)
}

/// Ports in the order of their numbers: `ttyUSB10` behind `ttyUSB9`.
fn by_number(path: &str) -> (&str, u32) {
    let name = path.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let number = path.get(name.len()..).unwrap_or_default();
    (name, number.parse().unwrap_or(0))
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

    fn adapter(path: &str, serial: &str, name: &str) -> Found {
        Found {
            path: path.to_owned(),
            usb: Some(Usb {
                vendor: 0x0403,
                product: 0x6014,
                serial: serial.to_owned(),
                manufacturer: "FTDI".to_owned(),
                name: name.to_owned(),
            }),
            allowed: true,
        }
    }

    #[test]
    fn an_adapter_is_found_again_by_its_number_wherever_it_is_plugged_in() {
        let mut ports = vec![
            adapter("/dev/ttyUSB10", "FT1", "U2D2"),
            adapter("/dev/ttyUSB9", "FT1", "U2D2"),
            adapter("/dev/ttyUSB0", "FT2", "U2D2"),
            Found {
                path: "/dev/ttyS0".to_owned(),
                usb: None,
                allowed: true,
            },
        ];
        let path = |ports: &[Found], serial: &str| of_usb_serial(ports, serial).map(|port| port.path.clone());
        assert_eq!(path(&ports, "FT2").as_deref(), Some("/dev/ttyUSB0"));
        assert_eq!(
            path(&ports, "FT1").as_deref(),
            Some("/dev/ttyUSB9"),
            "its first port"
        );
        assert_eq!(path(&ports, "FT3"), None);
        ports[2].path = "/dev/ttyUSB4".to_owned();
        assert_eq!(path(&ports, "FT2").as_deref(), Some("/dev/ttyUSB4"));
        ports.push(adapter(
            "/dev/ttyACM0",
            "FT2",
            "another device of the same number",
        ));
        assert_eq!(path(&ports, "FT2"), None, "which of them is not known");
    }

    #[test]
    fn listing_needs_no_ports() {
        assert!(list().is_sorted());
    }
}
