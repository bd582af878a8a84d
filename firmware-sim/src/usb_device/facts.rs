//! What a device says of itself when it is enumerated.

/// Device descriptor, strings and interfaces, as far as a host can tell them apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsbFacts {
    /// `idVendor`.
    pub vendor: u16,
    /// `idProduct`.
    pub product: u16,
    /// `bcdDevice`.
    pub release_bcd: u16,
    /// String 1.
    pub manufacturer: &'static str,
    /// String 2.
    pub name: &'static str,
    /// String 3; none: the device has no serial number, which is the rule among input devices.
    pub serial: Option<&'static str>,
    /// Interfaces by number.
    pub interfaces: Vec<HidInterface>,
    /// The interface that reports what the device is bought for, once it is in its full mode.
    pub main: u8,
}

/// One HID interface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HidInterface {
    /// The report descriptor.
    pub descriptor: Vec<u8>,
    /// Usage page and usage of its first application collection.
    pub usage: [u16; 2],
    /// Longest input report with its id; 0: none.
    pub input_bytes: u16,
    /// Longest output report with its id; 0: none. There is an endpoint for them.
    pub output_bytes: u16,
    /// Longest feature report with its id; 0: none.
    pub feature_bytes: u16,
    /// Reports begin with an id.
    pub numbered: bool,
    /// `bInterval`: how often the host asks, milliseconds.
    pub poll_ms: u8,
}

/// A USB string descriptor: its head and UTF-16, little-endian. Longer texts are cut at what a length byte can say.
pub fn string_descriptor(text: &str) -> Vec<u8> {
    let mut bytes = vec![0, 3];
    for unit in text.encode_utf16().take(126) {
        bytes.extend(unit.to_le_bytes());
    }
    bytes[0] = bytes.len() as u8;
    bytes
}

impl UsbFacts {
    /// The strings that every device answers by the same rule: languages, maker, product, serial number.
    pub(crate) fn usual_string(&self, index: u8) -> Option<Vec<u8>> {
        match index {
            // American English is the only language here, as in all devices at hand.
            0 => Some(vec![4, 3, 0x09, 0x04]),
            1 => Some(string_descriptor(self.manufacturer)),
            2 => Some(string_descriptor(self.name)),
            3 => self.serial.map(string_descriptor),
            _ => None,
        }
    }

    /// The interface of this number.
    pub fn interface(&self, number: u8) -> Option<&HidInterface> {
        self.interfaces.get(usize::from(number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_bear_their_length_and_type() {
        // `HK On` as a real device sends it (input-device facts, string 123 of an H640P).
        let want = [0x0C, 3, 0x48, 0, 0x4B, 0, 0x20, 0, 0x4F, 0, 0x6E, 0];
        assert_eq!(string_descriptor("HK On"), want);
        assert_eq!(string_descriptor(&"x".repeat(300)).len(), 254);
    }
}
