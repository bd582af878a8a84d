//! Legal descriptors, written by chance, with reports that fit them: what the decoder is tested against.
//!
//! Written from HID 1.11 alone; it shares no code with the reader.

use proptest::prelude::*;

/// One variable of a report.
#[derive(Clone, Debug)]
pub(super) struct Made {
    pub(super) usage: (u16, u16),
    pub(super) width: u32,
    pub(super) low: i64,
    pub(super) high: i64,
    pub(super) relative: bool,
    pub(super) null: bool,
    /// Constant bits before it.
    pub(super) padding: u32,
    pub(super) spelling: Spelling,
}

/// The ways of saying the same.
#[derive(Clone, Copy, Debug)]
pub(super) enum Spelling {
    Short,
    /// A usage of four bytes, from another page.
    Long,
    /// A range of one.
    Range,
    /// First of a delimited set.
    Delimited,
    /// Globals pushed and popped around it.
    Pushed,
}

pub(super) fn spelling() -> impl Strategy<Value = Spelling> {
    prop_oneof![
        Just(Spelling::Short),
        Just(Spelling::Long),
        Just(Spelling::Range),
        Just(Spelling::Delimited),
        Just(Spelling::Pushed),
    ]
}

/// A number of 2 to 32 bits with any range that fits.
pub(super) fn number(usage: (u16, u16), relative: bool) -> impl Strategy<Value = Made> {
    let ranges = (2_u32..=32, any::<bool>(), any::<[u32; 2]>());
    (ranges, any::<bool>(), 0_u32..20, spelling()).prop_map(
        move |((width, signed, ends), null, padding, spelling)| {
            let (least, most) = if signed {
                (-(1_i64 << (width - 1)), (1_i64 << (width - 1)) - 1)
            } else {
                (0, (1_i64 << width) - 1)
            };
            // Items hold 32 bits: an unsigned maximum beyond a signed one's is legal over a minimum of 0.
            let place = |by: u32| least + i64::from(by) % (most - least + 1);
            let [mut low, mut high] = ends.map(place);
            if low > high {
                (low, high) = (high, low);
            }
            if low > i64::from(i32::MAX) {
                low = 0;
            }
            if low == high {
                (low, high) = (least, most);
            }
            Made {
                usage,
                width,
                low,
                high,
                relative,
                null: null && !relative,
                padding,
                spelling,
            }
        },
    )
}

/// A switch.
pub(super) fn switch(usage: (u16, u16)) -> impl Strategy<Value = Made> {
    (0_u32..9, spelling()).prop_map(move |(padding, spelling)| Made {
        usage,
        width: 1,
        low: 0,
        high: 1,
        relative: false,
        null: false,
        padding,
        spelling,
    })
}

impl Made {
    /// A value in the range.
    pub(super) fn value(&self, chance: u32) -> i64 {
        self.low + i64::from(chance) % (self.high - self.low + 1)
    }
}

/// Descriptor bytes.
#[derive(Clone, Debug, Default)]
pub(super) struct Writer {
    pub(super) bytes: Vec<u8>,
    page: Option<u16>,
}

impl Writer {
    /// An item with as few bytes as its number needs, 0 bytes never.
    pub(super) fn item(&mut self, tag_and_type: u8, value: u32) {
        let bytes = value.to_le_bytes();
        let length = match value {
            0..=0xFF => 1,
            0x100..=0xFFFF => 2,
            _ => 4,
        };
        self.push(tag_and_type, &bytes[..length]);
    }

    fn push(&mut self, tag_and_type: u8, data: &[u8]) {
        let code = [0, 1, 2, 0, 3][data.len()];
        self.bytes.push(tag_and_type | code);
        self.bytes.extend(data);
    }

    /// A number with a sign, in as few bytes as keep it.
    fn signed(&mut self, tag_and_type: u8, value: i64) {
        let bytes = value.to_le_bytes();
        let length = match value {
            -0x80..=0x7F => 1,
            -0x8000..=0x7FFF => 2,
            _ => 4,
        };
        self.push(tag_and_type, &bytes[..length]);
    }

    pub(super) fn begin(&mut self, usage: (u16, u16), kind: u32) {
        self.page(usage.0);
        self.item(0x08, usage.1.into());
        self.item(0xA0, kind);
    }

    pub(super) fn end(&mut self) {
        self.bytes.push(0xC0);
    }

    pub(super) fn report(&mut self, id: Option<u8>) {
        if let Some(id) = id {
            self.item(0x84, id.into());
        }
    }

    fn page(&mut self, page: u16) {
        if self.page != Some(page) {
            self.item(0x04, page.into());
            self.page = Some(page);
        }
    }

    pub(super) fn padding(&mut self, bits: u32) {
        if bits > 0 {
            self.item(0x74, bits);
            self.item(0x94, 1);
            self.item(0x80, 0x03);
        }
    }

    pub(super) fn field(&mut self, made: &Made) {
        self.padding(made.padding);
        let (page, id) = made.usage;
        if matches!(made.spelling, Spelling::Pushed) {
            self.bytes.push(0xA4);
        }
        match made.spelling {
            Spelling::Short | Spelling::Pushed => {
                self.page(page);
                self.item(0x08, id.into());
            }
            Spelling::Long => {
                self.page(0x0C);
                let long = u32::from(page) << 16 | u32::from(id);
                self.push(0x08, &long.to_le_bytes());
            }
            Spelling::Range => {
                self.page(page);
                self.item(0x28, id.into());
                self.item(0x18, id.into());
            }
            Spelling::Delimited => {
                self.page(page);
                self.item(0xA8, 1);
                self.item(0x08, id.into());
                self.item(0x08, 0x7F);
                self.item(0xA8, 0);
            }
        }
        self.signed(0x14, made.low);
        if made.low < 0 {
            self.signed(0x24, made.high);
        } else {
            self.item(0x24, made.high as u32);
        }
        self.item(0x74, made.width);
        self.item(0x94, 1);
        let flags = 0x02 | u32::from(made.relative) << 2 | u32::from(made.null) << 6;
        self.item(0x80, flags);
        if matches!(made.spelling, Spelling::Pushed) {
            self.bytes.push(0xB4);
            // What is in force again is not tracked here: it is said anew.
            self.page = None;
        }
    }
}

/// A report's bits, lowest first.
#[derive(Clone, Debug, Default)]
pub(super) struct Bits(Vec<bool>);

impl Bits {
    pub(super) fn put(&mut self, value: i64, width: u32) {
        self.0.extend((0..width).map(|bit| value >> bit.min(63) & 1 == 1));
    }

    /// Padding is whatever it is.
    pub(super) fn fields(made: &[Made], values: &[i64], noise: bool) -> Self {
        let mut bits = Self::default();
        for (made, &value) in made.iter().zip(values) {
            bits.put(if noise { -1 } else { 0 }, made.padding);
            bits.put(value, made.width);
        }
        bits
    }

    pub(super) fn bytes(&self, id: Option<u8>) -> Vec<u8> {
        let byte = |bits: &[bool]| {
            (0..)
                .zip(bits)
                .fold(0, |sum, (at, &bit)| sum | u8::from(bit) << at)
        };
        id.into_iter().chain(self.0.chunks(8).map(byte)).collect()
    }
}
