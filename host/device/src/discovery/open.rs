//! Opening an input device by its address: with its line's manners, and so that every piece has the time it arrived.

use super::{Places, sysfs};
use crate::clock::Clock;
use crate::codec;
use crate::transport::{self, Address, Transport, TransportError, hid, midi_raw, osc, ports, stamped_serial};
use device_profiles::Line;
use std::path::Path;
use std::sync::Arc;

/// Opens any address but `sim:`. `line` is the serial line's, where there is one.
pub fn open(
    places: &Places,
    address: &Address,
    line: Option<&Line>,
    clock: &Arc<dyn Clock>,
) -> Result<Box<dyn Transport>, TransportError> {
    let clock = Arc::clone(clock);
    let serial = |path: &str, clock| -> Result<Box<dyn Transport>, TransportError> {
        match line {
            Some(line) => Ok(Box::new(stamped_serial::open(path, line, clock)?)),
            None => Err(TransportError::Unsupported {
                what: "serial line in its profile; expected [line] with baud",
            }),
        }
    };
    match address {
        Address::Path(path) if is_hid(path) => {
            let found = sysfs::hid(&places.sys, &places.dev);
            let usb = found.iter().find(|f| f.address == *path).and_then(|f| f.usb);
            Ok(Box::new(hid::open(path, usb, clock)?))
        }
        Address::Path(path) if midi_raw::is_node(path) => Ok(Box::new(midi_raw::open(path, clock)?)),
        Address::Midi(name) => midi_port(name, clock),
        Address::Osc(place) => Ok(Box::new(osc::open(*place, codec::osc_due, clock)?)),
        Address::Path(path) => serial(path, clock),
        Address::Usb(wanted) => {
            let ports = ports::list();
            let found = ports::of_usb_serial(&ports, wanted).ok_or_else(|| TransportError::NotFound {
                address: address.to_string(),
            })?;
            serial(&found.path, clock)
        }
        other => transport::open(other, line.map_or(0, |line| line.baud)),
    }
}

#[cfg(feature = "midir")]
fn midi_port(name: &str, clock: Arc<dyn Clock>) -> Result<Box<dyn Transport>, TransportError> {
    Ok(Box::new(transport::midi_ports::open(name, clock)?))
}

#[cfg(not(feature = "midir"))]
fn midi_port(_name: &str, _clock: Arc<dyn Clock>) -> Result<Box<dyn Transport>, TransportError> {
    Err(TransportError::Unsupported {
        what: "MIDI library in this program; build it with the feature midir, or on Linux name the node below /dev/snd",
    })
}

/// Whether a path is a HID device's node, by its name.
fn is_hid(path: &str) -> bool {
    let name = Path::new(path).file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| name.starts_with("hidraw"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::VirtualClock;

    #[test]
    fn what_is_not_there_is_said_cleanly() {
        let clock: Arc<dyn Clock> = Arc::new(VirtualClock::new());
        let open = |text: &str| {
            let address = text.parse().expect("an address");
            open(&Places::default(), &address, None, &clock)
                .err()
                .expect("nothing is there")
        };
        for text in [
            "/dev/hidraw99",
            "/dev/snd/midiC9D9",
            "usb:no-such-serial",
            "sim:pad",
        ] {
            assert!(matches!(open(text), TransportError::NotFound { .. }), "{text}");
        }
        assert!(open("/dev/ttyS99").to_string().contains("expected [line]"));
    }
}
