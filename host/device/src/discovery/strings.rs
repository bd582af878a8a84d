//! USB strings that tell devices with equal ids apart, each read once a plugging.

use super::Found;
use crate::codec::usb_text;
use crate::transport::adapter::UsbPlace;
use crate::transport::read_usb_string;
use std::collections::BTreeMap;

/// What was read, by where a device hangs at the moment.
#[derive(Default)]
pub struct Strings {
    read: BTreeMap<(u8, u8), BTreeMap<u8, Result<String, String>>>,
}

impl Strings {
    /// Nothing read yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// A string of a device; an error in words. May take half a second where a device does not answer.
    pub fn get(&mut self, found: &Found, index: u8) -> Result<String, String> {
        let place = found.usb.ok_or("it does not hang on USB")?;
        let of_device = self.read.entry(key(place)).or_default();
        if let Some(known) = of_device.get(&index) {
            return known.clone();
        }
        let raw = read_usb_string(&found.address, place, index).map_err(|error| error.to_string());
        let text = raw.and_then(|raw| usb_text::text(&raw).map_err(|error| error.to_string()));
        // A right that is missing may be granted a moment later; what the device says does not change.
        if text.is_ok() || found.access == super::Access::Allowed {
            of_device.insert(index, text.clone());
        }
        text
    }

    /// Forgets devices that are not there any more: their places will be given to others.
    pub fn keep(&mut self, found: &[Found]) {
        self.read
            .retain(|place, _| found.iter().any(|f| f.usb.is_some_and(|usb| key(usb) == *place)));
    }
}

fn key(place: UsbPlace) -> (u8, u8) {
    (place.bus, place.address)
}
