//! One thing that is plugged in, as the system describes it.

use crate::codec::outline::Outline;
use crate::transport::adapter::UsbPlace;
use device_profiles::Bus;

/// Whether this user may open it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// He may; whether somebody else has it open is known only by trying.
    Allowed,
    /// The system would refuse.
    Forbidden,
    /// The node is not there yet: the system is still making it.
    NotYet,
    /// The kernel makes no node for it ([`super::nodeless_remedy`]); what it is is known by its ids alone.
    Nodeless,
}

/// A device's interface, or a port.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Where it is opened.
    pub address: String,
    /// Where it is plugged in.
    pub bus: Bus,
    /// Vendor id of USB or Bluetooth; on a serial line, of the adapter.
    pub vendor: Option<u16>,
    /// Product id.
    pub product: Option<u16>,
    /// Which interface of the device.
    pub interface: Option<u8>,
    /// The maker's name; empty where it is not said.
    pub maker: String,
    /// The product's name, or the port's.
    pub title: String,
    /// Tells two of a kind apart, where the maker took the trouble.
    pub serial: String,
    /// Where it hangs, the same every time it is plugged in there: `1-2.3` for the third port of the hub in the second
    /// port of bus 1.
    pub place: Option<String>,
    /// Where it hangs at the moment; given anew every time.
    pub usb: Option<UsbPlace>,
    /// Its reports in outline; empty for what has none.
    pub outline: Outline,
    /// The kernel's driver that has it.
    pub driver: Option<String>,
    /// Whether it may be opened.
    pub access: Access,
}

impl Found {
    /// Something of which nothing is known but where it is.
    pub fn new(address: &str, bus: Bus) -> Self {
        Self {
            address: address.to_owned(),
            bus,
            vendor: None,
            product: None,
            interface: None,
            maker: String::new(),
            title: String::new(),
            serial: String::new(),
            place: None,
            usb: None,
            outline: Outline::default(),
            driver: None,
            access: Access::Allowed,
        }
    }

    /// `vendor:product` in hexadecimal, where both are known.
    pub fn id(&self) -> Option<String> {
        Some(format!("{:04x}:{:04x}", self.vendor?, self.product?))
    }

    /// What is known about it, for people.
    pub fn description(&self) -> String {
        let name = match (self.maker.trim(), self.title.trim()) {
            ("", "") => match self.bus {
                Bus::Serial => "serial port".to_owned(),
                Bus::Midi => "MIDI port".to_owned(),
                _ => "HID device".to_owned(),
            },
            (maker, title) if title.starts_with(maker) => title.to_owned(),
            (maker, title) => format!("{maker} {title}").trim().to_owned(),
        };
        let mut facts: Vec<String> = self.id().into_iter().collect();
        if !self.serial.is_empty() {
            facts.push(self.serial.clone());
        }
        if let Some(interface) = self.interface {
            facts.push(format!("interface {interface}"));
        }
        if let Some(place) = &self.place {
            facts.push(format!("at {place}"));
        }
        if facts.is_empty() {
            name
        } else {
            format!("{name} ({})", facts.join(", "))
        }
    }
}
