//! HID report descriptors: bytes to a flat list of fields, as HID 1.11 section 6.2.2 has them.
//!
//! Firmware lies. What cannot be understood is refused with the byte it stands at; what is only large is bounded.
//! Source: "Device Class Definition for Human Interface Devices (HID)" 1.11, sections 5.2-5.10, 6.2.2 and 8.

mod error;
mod field;
mod item;
mod parse;
mod state;
mod unit;

pub use error::{DescriptorError, DescriptorFault};
pub use field::{Collection, Described, Direction, Flags, Usage, UsageRange};
pub use unit::{Unit, UnitKind};

/// Longest descriptor that is read. The specification's length is a 16-bit number.
pub const DESCRIPTOR_BYTES_MAX: usize = 65_535;
/// Longest report; Linux has the same limit (`HID_MAX_BUFFER_SIZE`).
pub const REPORT_BYTES_MAX: u32 = 16_384;
/// Most fields that tell something. The largest real descriptor known has some hundreds; Linux allows 12288 usages.
pub const FIELDS_MAX: usize = 12_288;
/// Deepest nesting of collections, and of Push.
pub const DEPTH_MAX: usize = 64;

/// A report descriptor, understood.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Descriptor {
    /// Every field that is not constant, in the order in which they are described.
    pub fields: Vec<Described>,
    /// Collections in the order in which they are opened.
    pub collections: Vec<Collection>,
    /// Whether reports begin with their id.
    pub numbered: bool,
    /// Bits of each report without its id, as (direction, id, bits); id 0 where they are not numbered.
    pub reports: Vec<(Direction, u8, u32)>,
}

impl Descriptor {
    /// Reads a descriptor.
    ///
    /// # Errors
    /// With the place and the reason, when it breaks the rules in a way that leaves no one meaning.
    pub fn parse(bytes: &[u8]) -> Result<Self, DescriptorError> {
        parse::parse(bytes)
    }

    /// Bytes of a report, its id included where reports are numbered; `None` where there is no such report.
    pub fn report_bytes(&self, direction: Direction, id: u8) -> Option<usize> {
        let bits = |&&(d, i, _): &&(Direction, u8, u32)| d == direction && i == id;
        let (_, _, bits) = self.reports.iter().find(bits)?;
        Some(bits.div_ceil(8) as usize + usize::from(self.numbered))
    }

    /// The collections around a field, the innermost first.
    pub fn around(&self, field: &Described) -> impl Iterator<Item = &Collection> {
        let first = field.collection.and_then(|at| self.collections.get(at));
        std::iter::successors(first, |inner| {
            inner.parent.and_then(|at| self.collections.get(at))
        })
    }

    /// The application a field belongs to: the outermost application collection around it.
    pub fn application(&self, field: &Described) -> Option<Usage> {
        let all = self.around(field).filter(|c| c.is_application());
        all.last().map(|c| c.usage)
    }
}

#[cfg(test)]
mod legal_tests;
#[cfg(test)]
mod tests;
