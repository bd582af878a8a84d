//! USB string descriptors by index, as raw bytes.
//!
//! Some tablets change their mode when a certain string is read, and tell their ranges in it. The request goes to the
//! device as a whole, beside whatever driver holds its interfaces. Source: USB 2.0, 9.4.3 and 9.6.7.

use super::TransportError;
use super::adapter::UsbPlace;
use rusb::{Context, DeviceHandle, UsbContext};
use std::io;
use std::path::Path;
use std::time::Duration;

/// Standard request "get descriptor".
const GET_DESCRIPTOR: u8 = 6;
/// Descriptor type "string", in the high byte of the value.
const STRING: u16 = 3 << 8;
/// English (United States), the language that every such tablet answers.
const LANGUAGE: u16 = 0x0409;
/// Longest descriptor: its length is one byte.
const DESCRIPTOR_BYTES_MAX: usize = 255;
/// Longest wait; a device answers within a few frames or never.
const LIMIT: Duration = Duration::from_millis(500);
/// What grants the right to open a USB device as a whole.
const USB_HINT: &str = super::hid::HID_HINT;

/// Reads one string of the device at `place`, head and all; errors bear `address`.
pub fn read_usb_string(address: &str, place: UsbPlace, index: u8) -> Result<Vec<u8>, TransportError> {
    UsbStrings::open(address, place)?.read(address, index)
}

/// An open USB device.
pub(super) struct UsbStrings {
    handle: DeviceHandle<Context>,
}

impl UsbStrings {
    /// Opens the device at `place`; errors bear `address`.
    pub(super) fn open(address: &str, place: UsbPlace) -> Result<Self, TransportError> {
        let sort = |error| sorted(address, error);
        // Without this folder libusb does not start, and says only "other error".
        if cfg!(target_os = "linux") && !Path::new("/sys/bus/usb").is_dir() {
            return Err(TransportError::NotFound {
                address: address.to_owned(),
            });
        }
        let context = Context::new().map_err(sort)?;
        let devices = context.devices().map_err(sort)?;
        let device = devices
            .iter()
            .find(|d| d.bus_number() == place.bus && d.address() == place.address)
            .ok_or_else(|| sort(rusb::Error::NoDevice))?;
        let handle = device.open().map_err(sort)?;
        Ok(Self { handle })
    }

    /// The whole descriptor with its head, as the device gave it: unlike libusb's own reading nothing is judged.
    pub(super) fn read(&self, address: &str, index: u8) -> Result<Vec<u8>, TransportError> {
        let kind = rusb::request_type(
            rusb::Direction::In,
            rusb::RequestType::Standard,
            rusb::Recipient::Device,
        );
        let mut answer = vec![0; DESCRIPTOR_BYTES_MAX];
        let value = STRING | u16::from(index);
        let count = self
            .handle
            .read_control(kind, GET_DESCRIPTOR, value, LANGUAGE, &mut answer, LIMIT)
            .map_err(|error| sorted(address, error))?;
        answer.truncate(count);
        Ok(answer)
    }
}

/// libusb's error by what a person can do about it.
fn sorted(address: &str, error: rusb::Error) -> TransportError {
    let address = address.to_owned();
    match error {
        rusb::Error::Access => TransportError::Forbidden {
            address,
            hint: USB_HINT,
        },
        rusb::Error::Busy => TransportError::Busy { address },
        rusb::Error::NoDevice => TransportError::Gone { address },
        rusb::Error::NotFound => TransportError::NotFound { address },
        other => TransportError::Io {
            address,
            source: io::Error::other(format!("USB string: {other}")),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_where_nothing_hangs_is_an_error_and_no_panic() {
        let place = UsbPlace {
            bus: 250,
            address: 250,
            interface: 0,
        };
        let error = UsbStrings::open("/dev/hidraw99", place)
            .err()
            .expect("nothing hangs there");
        assert!(
            matches!(
                error,
                TransportError::NotFound { .. } | TransportError::Gone { .. } | TransportError::Io { .. }
            ),
            "{error}"
        );
    }

    #[test]
    fn errors_say_what_a_person_can_do() {
        for (error, want) in [
            (rusb::Error::Access, "--install-rules"),
            (rusb::Error::NoDevice, "plug it in again"),
            (rusb::Error::Busy, "another program"),
            (rusb::Error::Pipe, "USB string"),
        ] {
            let said = sorted("/dev/hidraw0", error).to_string();
            assert!(said.contains(want), "{said}");
        }
    }
}
