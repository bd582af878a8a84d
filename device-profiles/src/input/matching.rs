//! What tells a device from all others.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One way of being recognised. All that is given must hold; a device is the profile's when any of its matches
/// holds. Where several fit, one with a vendor and product, or with the serial number's text, goes before one without.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Match {
    /// Where it is plugged in.
    pub bus: Bus,
    /// Vendor id of USB or Bluetooth; on a serial line, of the adapter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vendor: Option<u16>,
    /// Product id.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub product: Option<u16>,
    /// The interface, where a device has several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interface: Option<u8>,
    /// Usage page and usage of the interface's first top-level collection.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub usage: Option<[u16; 2]>,
    /// Longest input report, with its id where it has one: any of these; empty: whatever.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub input_report_bytes: Vec<u16>,
    /// Longest output report: any of these.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub output_report_bytes: Vec<u16>,
    /// Longest feature report: any of these.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub feature_report_bytes: Vec<u16>,
    /// What the maker's name begins with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maker_text: Option<String>,
    /// What the product's name begins with; of MIDI, the port's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub product_text: Option<String>,
    /// What the USB serial number begins with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub serial_text: Option<String>,
    /// UDP port on which it is heard; of `network`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub port: Option<u16>,
    /// What is asked over a serial line, and what the answer begins with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identify: Option<Identify>,
    /// USB strings by index, and what each begins with.
    #[serde(default, with = "by_index", skip_serializing_if = "BTreeMap::is_empty")]
    pub strings: BTreeMap<u8, String>,
    /// USB strings by index, and what each must not begin with.
    #[serde(default, with = "by_index", skip_serializing_if = "BTreeMap::is_empty")]
    pub not_strings: BTreeMap<u8, Vec<String>>,
}

/// Where devices are plugged in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Bus {
    /// USB.
    Usb,
    /// Bluetooth.
    Bluetooth,
    /// A serial port, of whatever kind.
    Serial,
    /// A MIDI port.
    Midi,
    /// UDP.
    Network,
}

impl Bus {
    /// The word as the files have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Usb => "usb",
            Self::Bluetooth => "bluetooth",
            Self::Serial => "serial",
            Self::Midi => "midi",
            Self::Network => "network",
        }
    }
}

/// A question on a serial line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identify {
    /// What is sent, as text.
    pub ask: String,
    /// What the answer begins with, after an echo of the question.
    pub prefix: String,
}

impl Match {
    /// `vendor:product` in hexadecimal, where both are given.
    pub fn id(&self) -> Option<String> {
        Some(format!("{:04x}:{:04x}", self.vendor?, self.product?))
    }

    /// Whether it says nothing by which a program could tell the device: then a person has to name the profile.
    pub fn by_hand_only(&self) -> bool {
        self.vendor.is_none()
            && self.usage.is_none()
            && self.identify.is_none()
            && self.port.is_none()
            && self.product_text.is_none()
            && self.serial_text.is_none()
    }

    /// Whether there may be a device that both fit.
    pub fn overlaps(&self, other: &Self) -> bool {
        if self.bus != other.bus || self.by_hand_only() || other.by_hand_only() {
            return false;
        }
        // The one with ids or a serial number goes before: it is known without asking.
        let known = |m: &Self| m.id().is_some() || m.serial_text.is_some();
        if known(self) != known(other) {
            return false;
        }
        let told_apart = differ(self.vendor, other.vendor)
            || differ(self.product, other.product)
            || differ(self.interface, other.interface)
            || differ(self.usage, other.usage)
            || differ(self.port, other.port)
            || disjoint(&self.input_report_bytes, &other.input_report_bytes)
            || disjoint(&self.output_report_bytes, &other.output_report_bytes)
            || disjoint(&self.feature_report_bytes, &other.feature_report_bytes)
            || texts_differ(self.maker_text.as_ref(), other.maker_text.as_ref())
            || texts_differ(self.product_text.as_ref(), other.product_text.as_ref())
            || texts_differ(self.serial_text.as_ref(), other.serial_text.as_ref())
            || texts_differ(
                self.identify.as_ref().map(|i| &i.prefix),
                other.identify.as_ref().map(|i| &i.prefix),
            )
            || self
                .strings
                .iter()
                .any(|(index, text)| texts_differ(Some(text), other.strings.get(index)))
            || self.excludes(other)
            || other.excludes(self);
        !told_apart
    }

    /// Whether a text that the other asks for is one that this must not have.
    fn excludes(&self, other: &Self) -> bool {
        self.not_strings.iter().any(|(index, texts)| {
            let asked = other.strings.get(index);
            asked.is_some_and(|asked| texts.iter().any(|text| asked.starts_with(text.as_str())))
        })
    }
}

fn differ<T: PartialEq>(a: Option<T>, b: Option<T>) -> bool {
    matches!((a, b), (Some(a), Some(b)) if a != b)
}

fn disjoint(a: &[u16], b: &[u16]) -> bool {
    !a.is_empty() && !b.is_empty() && !a.iter().any(|length| b.contains(length))
}

/// Beginnings of one text are compatible when one begins with the other.
fn texts_differ(a: Option<&String>, b: Option<&String>) -> bool {
    matches!((a, b), (Some(a), Some(b)) if !a.starts_with(b.as_str()) && !b.starts_with(a.as_str()))
}

/// TOML knows only words as keys.
mod by_index {
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};
    use std::collections::BTreeMap;

    pub(super) fn serialize<S: Serializer, T: Serialize>(
        map: &BTreeMap<u8, T>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        to.collect_map(map.iter().map(|(index, value)| (index.to_string(), value)))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
        from: D,
    ) -> Result<BTreeMap<u8, T>, D::Error> {
        let words = BTreeMap::<String, T>::deserialize(from)?;
        let index = |word: String| {
            word.parse().map_err(|_| {
                D::Error::custom(format!(
                    "expected the index of a USB string, 1 to 255, found {word:?}"
                ))
            })
        };
        words
            .into_iter()
            .map(|(word, value)| Ok((index(word)?, value)))
            .collect()
    }
}
