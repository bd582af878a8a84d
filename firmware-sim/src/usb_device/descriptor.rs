//! Writing HID report descriptors: items by name instead of by number.
//!
//! Source: USB Device Class Definition for Human Interface Devices 1.11, section 6.2.2 (short items).

/// A report descriptor being written. Every item's data takes as few bytes as hold it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Descriptor {
    bytes: Vec<u8>,
}

/// Constant bits, which carry nothing.
const CONSTANT: u32 = 0x03;
/// Fields that each name one of the usages.
const ARRAY: u32 = 0x00;
/// One field, absolute.
const ABSOLUTE: u32 = 0x02;
/// One field, relative.
const RELATIVE: u32 = 0x06;

impl Descriptor {
    /// A descriptor that begins with an application collection of this usage.
    pub(crate) fn application(page: u16, usage: u16) -> Self {
        Self::default().and_application(page, usage)
    }

    /// A further application collection; the one before must have been ended.
    pub(crate) fn and_application(self, page: u16, usage: u16) -> Self {
        self.item(0x04, u32::from(page))
            .item(0x08, u32::from(usage))
            .item(0xA0, 1)
    }

    /// A physical collection of this usage.
    pub(crate) fn physical(self, usage: u16) -> Self {
        self.item(0x08, u32::from(usage)).item(0xA0, 0)
    }

    /// Ends the innermost collection.
    pub(crate) fn end(mut self) -> Self {
        self.bytes.push(0xC0);
        self
    }

    /// What follows is in report `id`.
    pub(crate) fn report(self, id: u8) -> Self {
        self.item(0x84, u32::from(id))
    }

    /// What follows has usages of `page`.
    pub(crate) fn page(self, page: u16) -> Self {
        self.item(0x04, u32::from(page))
    }

    /// One absolute input field per usage, each of `bits`, from `range`.
    pub(crate) fn inputs(self, usages: &[u16], bits: u8, range: [i32; 2]) -> Self {
        self.usages(usages)
            .fields(bits, usages.len() as u32, range)
            .item(0x80, ABSOLUTE)
    }

    /// As [`Descriptor::inputs`], relative.
    pub(crate) fn relative(self, usages: &[u16], bits: u8, range: [i32; 2]) -> Self {
        self.usages(usages)
            .fields(bits, usages.len() as u32, range)
            .item(0x80, RELATIVE)
    }

    /// One input bit per usage from `first` to `last`.
    pub(crate) fn bits(self, first: u16, last: u16) -> Self {
        self.item(0x18, u32::from(first))
            .item(0x28, u32::from(last))
            .fields(1, u32::from(last - first) + 1, [0, 1])
            .item(0x80, ABSOLUTE)
    }

    /// `count` input bytes, each the usage of a key that is down or 0.
    pub(crate) fn keys(self, count: u32) -> Self {
        self.item(0x18, 0)
            .item(0x28, 0xFF)
            .fields(8, count, [0, 255])
            .item(0x80, ARRAY)
    }

    /// Input bits that carry nothing.
    pub(crate) fn padding(self, bits: u16) -> Self {
        self.item(0x74, 1)
            .item(0x94, u32::from(bits))
            .item(0x80, CONSTANT)
    }

    /// `bytes` bytes of input with one usage.
    pub(crate) fn input_bytes(self, usage: u16, bytes: u16) -> Self {
        self.usages(&[usage])
            .fields(8, u32::from(bytes), [0, 255])
            .item(0x80, ABSOLUTE)
    }

    /// `bytes` bytes of output with one usage.
    pub(crate) fn output_bytes(self, usage: u16, bytes: u16) -> Self {
        self.usages(&[usage])
            .fields(8, u32::from(bytes), [0, 255])
            .item(0x90, ABSOLUTE)
    }

    /// `bytes` bytes of feature with one usage.
    pub(crate) fn feature_bytes(self, usage: u16, bytes: u16) -> Self {
        self.usages(&[usage])
            .fields(8, u32::from(bytes), [0, 255])
            .item(0xB0, ABSOLUTE)
    }

    /// What follows is measured in `unit` times ten to `exponent`, over `physical`.
    pub(crate) fn unit(self, unit: u32, exponent: i8, physical: [i32; 2]) -> Self {
        let [low, high] = physical;
        // The exponent is a four-bit two's complement (HID 1.11, 6.2.2.7).
        self.item(0x64, unit)
            .item(0x54, u32::from(exponent as u8 & 0x0F))
            .signed(0x34, low)
            .signed(0x44, high)
    }

    /// The finished bytes.
    pub(crate) fn build(self) -> Vec<u8> {
        self.bytes
    }

    fn usages(mut self, usages: &[u16]) -> Self {
        for &usage in usages {
            self = self.item(0x08, u32::from(usage));
        }
        self
    }

    fn fields(self, bits: u8, count: u32, range: [i32; 2]) -> Self {
        let [low, high] = range;
        self.signed(0x14, low)
            .signed(0x24, high)
            .item(0x74, u32::from(bits))
            .item(0x94, count)
    }

    fn item(self, tag: u8, value: u32) -> Self {
        let bytes = value.to_le_bytes();
        match value {
            0..=0xFF => self.put(tag | 1, &bytes[..1]),
            0x100..=0xFFFF => self.put(tag | 2, &bytes[..2]),
            _ => self.put(tag | 3, &bytes),
        }
    }

    /// An item whose data is signed: what does not fit without its sign bit takes more bytes.
    fn signed(self, tag: u8, value: i32) -> Self {
        let bytes = value.to_le_bytes();
        match value {
            -0x80..=0x7F => self.put(tag | 1, &bytes[..1]),
            -0x8000..=0x7FFF => self.put(tag | 2, &bytes[..2]),
            _ => self.put(tag | 3, &bytes),
        }
    }

    fn put(mut self, head: u8, data: &[u8]) -> Self {
        self.bytes.push(head);
        self.bytes.extend_from_slice(data);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_as_short_as_their_values() {
        let bytes = Descriptor::application(1, 2)
            .report(7)
            .inputs(&[0x30], 16, [0, 40_000])
            .relative(&[0x38], 8, [-127, 127])
            .padding(3)
            .end()
            .build();
        let want = [
            0x05, 1, 0x09, 2, 0xA1, 1, 0x85, 7, 0x09, 0x30, 0x15, 0, 0x27, 0x40, 0x9C, 0, 0, 0x75, 16, 0x95,
            1, 0x81, 2, 0x09, 0x38, 0x15, 0x81, 0x25, 0x7F, 0x75, 8, 0x95, 1, 0x81, 6, 0x75, 1, 0x95, 3,
            0x81, 3, 0xC0,
        ];
        assert_eq!(bytes, want);
    }
}
