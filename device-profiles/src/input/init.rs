//! What a device is told after opening, so that it speaks in its full form.

use super::HexBytes;
use serde::{Deserialize, Serialize};

/// One step, with what should come back. Exactly one of `string`, `feature`, `read_feature`, `output` and
/// `wait_ms` is given.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InitStep {
    /// Reads the USB string of this index; the reading itself is what switches the device.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub string: Option<u8>,
    /// Sends this feature report, its id first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feature: Option<HexBytes>,
    /// Asks for the feature report of this id.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub read_feature: Option<u8>,
    /// Sends this output report, its id first (0 where the device has none), filled up with zeros to the
    /// device's length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub output: Option<HexBytes>,
    /// Does nothing for so long, milliseconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wait_ms: Option<u32>,
    /// What the answer begins with: text of a string, bytes in hexadecimal of a feature report.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expect: Option<String>,
    /// The device may leave the bus here and return with this vendor and product id.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expect_sibling: Option<[u16; 2]>,
    /// The answer tells the device's ranges, laid out so; what it says takes the place of `[surface]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range_from: Option<RangeFrom>,
    /// A failure of this step is no failure: it is for some of the devices only.
    #[serde(default, skip_serializing_if = "super::is_default")]
    pub optional: bool,
}

/// Layouts of answers that tell ranges. Offsets count from the start of the string descriptor, whose first two
/// bytes are its length and 3. Source: DIGImend digimend-kernel-drivers `hid-uclogic-params.c` at f3c7c7f1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RangeFrom {
    /// x and y maximum u16 at 2 and 4, pressure maximum u16 at 8, lines per inch u16 at 10.
    #[serde(rename = "uclogic-v1")]
    UclogicV1,
    /// x and y maximum u24 at 2 and 5, pressure maximum u16 at 8, lines per inch u16 at 10; 18 bytes at least.
    #[serde(rename = "uclogic-v2")]
    UclogicV2,
    /// As `uclogic-v1`, and the number of pad keys at 6.
    #[serde(rename = "ugee-v2")]
    UgeeV2,
}

/// What a step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitAction<'a> {
    /// Reads a USB string.
    String(u8),
    /// Sends a feature report.
    Feature(&'a [u8]),
    /// Reads a feature report.
    ReadFeature(u8),
    /// Sends an output report.
    Output(&'a [u8]),
    /// Waits, milliseconds.
    Wait(u32),
}

impl InitStep {
    /// What the step does; `None` where nothing or several things are given, which the profile's check refuses.
    pub fn action(&self) -> Option<InitAction<'_>> {
        let mut given = [
            self.string.map(InitAction::String),
            self.feature.as_ref().map(|f| InitAction::Feature(&f.0)),
            self.read_feature.map(InitAction::ReadFeature),
            self.output.as_ref().map(|o| InitAction::Output(&o.0)),
            self.wait_ms.map(InitAction::Wait),
        ]
        .into_iter()
        .flatten();
        let first = given.next();
        first.filter(|_| given.next().is_none())
    }
}
