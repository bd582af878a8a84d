//! FTDI's vendor requests for the latency timer, over libusb.
//!
//! They reach the chip beside the kernel's driver: requests to the device as a whole need no claim on its interface,
//! only the right to open `/dev/bus/usb/...`. Source: `drivers/usb/serial/ftdi_sio.h` of Linux, "Set/Get Latency
//! Timer" (requests 9 and 10, the timer in the low byte of the value, the port in the index).

use super::{FTDI, UsbPlace};
use rusb::{DeviceHandle, GlobalContext};
use std::time::Duration;

/// Request number that sets the timer.
const SET_LATENCY: u8 = 9;
/// Request number that asks for it.
const GET_LATENCY: u8 = 10;
/// Longest wait for the chip; it answers in the next USB frame.
const LIMIT: Duration = Duration::from_millis(500);
/// Products with several ports, which the index of a request tells apart from 1 on; on others it is 0.
const SEVERAL_PORTS: [u16; 2] = [0x6010, 0x6011];

/// Requests to an FTDI chip. Errors are in words.
pub trait ControlRequests: Send {
    /// The timer in milliseconds.
    fn latency_ms(&mut self, place: UsbPlace, product: u16) -> Result<u8, String>;

    /// Sets the timer.
    fn set_latency_ms(&mut self, place: UsbPlace, product: u16, ms: u8) -> Result<(), String>;
}

/// The system's USB.
#[derive(Clone, Copy, Debug, Default)]
pub struct UsbRequests;

impl ControlRequests for UsbRequests {
    fn latency_ms(&mut self, place: UsbPlace, product: u16) -> Result<u8, String> {
        let mut answer = [0];
        let kind = request_type(rusb::Direction::In);
        let count = open(place, product)?
            .read_control(kind, GET_LATENCY, 0, index(place, product), &mut answer, LIMIT)
            .map_err(|error| error.to_string())?;
        if count == answer.len() {
            Ok(answer[0])
        } else {
            Err(format!("expected one byte, {count} came"))
        }
    }

    fn set_latency_ms(&mut self, place: UsbPlace, product: u16, ms: u8) -> Result<(), String> {
        let kind = request_type(rusb::Direction::Out);
        open(place, product)?
            .write_control(kind, SET_LATENCY, ms.into(), index(place, product), &[], LIMIT)
            .map_err(|error| error.to_string())?;
        Ok(())
    }
}

fn request_type(direction: rusb::Direction) -> u8 {
    rusb::request_type(direction, rusb::RequestType::Vendor, rusb::Recipient::Device)
}

/// The index of a request: which port of the chip is meant.
pub(super) fn index(place: UsbPlace, product: u16) -> u16 {
    if SEVERAL_PORTS.contains(&product) {
        u16::from(place.interface) + 1
    } else {
        0
    }
}

fn open(place: UsbPlace, product: u16) -> Result<DeviceHandle<GlobalContext>, String> {
    let devices = rusb::devices().map_err(|error| error.to_string())?;
    for device in devices.iter() {
        let about = device.device_descriptor().map_err(|error| error.to_string())?;
        let is_there = device.bus_number() == place.bus && device.address() == place.address;
        // Numbers are given anew at every plugging: what hangs there now must still be the same make.
        if is_there && about.vendor_id() == FTDI && about.product_id() == product {
            return device.open().map_err(|error| error.to_string());
        }
    }
    Err(format!(
        "no FTDI chip at USB bus {}, address {}",
        place.bus, place.address
    ))
}
