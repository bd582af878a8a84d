//! How people name a line: a path, `tcp:HOST:PORT`, `usb:SERIAL`, `osc:PORT`, `midi:NAME`, `sim:NAME`.

use super::osc::OscPlace;
use super::{Transport, TransportError, ports, serial, tcp};
use std::fmt;
use std::str::FromStr;

/// A parsed address; printing it gives back what was typed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Address {
    /// A serial port or pseudo-terminal by its path.
    Path(String),
    /// A byte stream over TCP. IPv6 addresses stand in square brackets.
    Tcp {
        /// Name or number of the machine.
        host: String,
        /// From 1.
        port: u16,
    },
    /// A USB serial port, by the serial number of its adapter or device.
    Usb(String),
    /// A network controller, heard by UDP.
    Osc(OscPlace),
    /// A MIDI port of the system's library, by the beginning of its name.
    Midi(String),
    /// A simulated device on the embedded bench, which this crate does not have.
    Sim(String),
}

impl FromStr for Address {
    type Err = TransportError;

    fn from_str(text: &str) -> Result<Self, TransportError> {
        let wrong = || TransportError::Address {
            address: text.to_owned(),
        };
        if let Some(rest) = text.strip_prefix("tcp:") {
            let (host, port) = rest.rsplit_once(':').ok_or_else(wrong)?;
            let host = host
                .strip_prefix('[')
                .and_then(|h| h.strip_suffix(']'))
                .unwrap_or(host);
            let port = port.parse().ok().filter(|&p| p > 0).ok_or_else(wrong)?;
            return if host.is_empty() {
                Err(wrong())
            } else {
                Ok(Self::Tcp {
                    host: host.to_owned(),
                    port,
                })
            };
        }
        if let Some(place) = text.strip_prefix("osc:") {
            return OscPlace::parse(place).map(Self::Osc).ok_or_else(wrong);
        }
        let (made, name): (fn(String) -> Self, &str) = if let Some(serial) = text.strip_prefix("usb:") {
            (Self::Usb, serial)
        } else if let Some(name) = text.strip_prefix("midi:") {
            (Self::Midi, name)
        } else if let Some(name) = text.strip_prefix("sim:") {
            (Self::Sim, name)
        } else if text.contains('/') {
            (Self::Path, text)
        } else {
            return Err(wrong());
        };
        if name.is_empty() {
            Err(wrong())
        } else {
            Ok(made(name.to_owned()))
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Path(path) => f.write_str(path),
            Self::Tcp { host, port } if host.contains(':') => write!(f, "tcp:[{host}]:{port}"),
            Self::Tcp { host, port } => write!(f, "tcp:{host}:{port}"),
            Self::Usb(serial) => write!(f, "usb:{serial}"),
            Self::Osc(place) => write!(f, "osc:{place}"),
            Self::Midi(name) => write!(f, "midi:{name}"),
            Self::Sim(name) => write!(f, "sim:{name}"),
        }
    }
}

/// Opens a line for bytes. `sim:` answers [`TransportError::NotFound`], and so do `osc:` and `midi:`, which are for input
/// devices only ([`crate::discovery::open`]).
pub fn open(address: &Address, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
    match address {
        Address::Path(path) => Ok(Box::new(serial::open(path, baud)?)),
        Address::Tcp { host, port } => Ok(Box::new(tcp::connect(host, *port)?)),
        Address::Usb(wanted) => {
            // The path may be another each time it is plugged in, so it is looked up each time it is opened.
            let ports = ports::list();
            let found = ports::of_usb_serial(&ports, wanted);
            let found = found.ok_or_else(|| TransportError::NotFound {
                address: address.to_string(),
            })?;
            Ok(Box::new(serial::open(&found.path, baud)?))
        }
        Address::Osc(_) | Address::Midi(_) | Address::Sim(_) => Err(TransportError::NotFound {
            address: address.to_string(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_print_as_they_were_typed() {
        let tcp = |host: &str, port| Address::Tcp {
            host: host.to_owned(),
            port,
        };
        let rows = [
            ("/dev/ttyUSB0", Address::Path("/dev/ttyUSB0".to_owned())),
            ("./bus", Address::Path("./bus".to_owned())),
            ("tcp:localhost:4000", tcp("localhost", 4000)),
            ("tcp:[::1]:4000", tcp("::1", 4000)),
            ("usb:FT4THVJ6", Address::Usb("FT4THVJ6".to_owned())),
            (
                "osc:8000-9000",
                Address::Osc(OscPlace {
                    listen: 8000,
                    send: Some(9000),
                    on: None,
                }),
            ),
            ("midi:X-TOUCH MINI", Address::Midi("X-TOUCH MINI".to_owned())),
            ("sim:dial-box", Address::Sim("dial-box".to_owned())),
        ];
        for (text, want) in rows {
            assert_eq!(text.parse::<Address>().unwrap(), want, "{text}");
            assert_eq!(want.to_string(), text);
        }
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        for text in [
            "",
            "COM3",
            "tcp:",
            "tcp:host",
            "tcp:host:0",
            "tcp:host:70000",
            "tcp::1",
            "usb:",
            "sim:",
            "osc:",
            "osc:0",
            "midi:",
        ] {
            let error = text.parse::<Address>().unwrap_err().to_string();
            assert!(
                error.starts_with(&format!("\"{text}\" is not an address")),
                "{error}"
            );
        }
    }

    #[test]
    fn what_does_not_exist_is_not_found() {
        for text in ["/dev/no-such-port", "usb:no-such-serial", "sim:anything"] {
            let error = open(&text.parse().unwrap(), 9600)
                .err()
                .expect("nothing is there");
            assert!(
                matches!(error, TransportError::NotFound { .. }),
                "{text}: {error}"
            );
        }
    }
}
