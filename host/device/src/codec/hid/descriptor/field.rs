//! What a descriptor says of its reports: fields, usages, collections.

use super::Unit;

/// A usage: what something is for, by page and id.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Usage {
    /// Usage page.
    pub page: u16,
    /// Usage id on the page.
    pub id: u16,
}

impl Usage {
    /// A usage.
    pub const fn new(page: u16, id: u16) -> Self {
        Self { page, id }
    }
}

/// Usages of one page that follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UsageRange {
    /// Their page.
    pub page: u16,
    /// First and last id.
    pub ids: [u16; 2],
}

impl UsageRange {
    /// How many.
    pub fn count(&self) -> u32 {
        u32::from(self.ids[1]).saturating_sub(u32::from(self.ids[0])) + 1
    }

    /// The `n`-th, from 0.
    pub fn nth(&self, n: u32) -> Option<Usage> {
        let id = u32::from(self.ids[0]) + n;
        (id <= u32::from(self.ids[1])).then(|| Usage::new(self.page, id as u16))
    }
}

/// Which way a report goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direction {
    /// Device to host.
    Input,
    /// Host to device.
    Output,
    /// Set and asked.
    Feature,
}

/// The bits of a main item. Source: HID 1.11, 6.2.2.5.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flags(pub u32);

impl Flags {
    /// Padding.
    pub fn constant(self) -> bool {
        self.0 & 1 != 0
    }

    /// One field for each usage; otherwise an array of which are on.
    pub fn variable(self) -> bool {
        self.0 & 2 != 0
    }

    /// Differences.
    pub fn relative(self) -> bool {
        self.0 & 4 != 0
    }

    /// Goes on at the other end.
    pub fn wraps(self) -> bool {
        self.0 & 8 != 0
    }

    /// Values outside the logical range mean "nothing".
    pub fn null_state(self) -> bool {
        self.0 & 0x40 != 0
    }
}

/// A field, or an array of equal ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Described {
    /// Which way its report goes.
    pub direction: Direction,
    /// Its report, 0 where they are not numbered.
    pub report: u8,
    /// First bit, counted from after the id.
    pub bit: u32,
    /// Bits of one element.
    pub width: u32,
    /// Elements: 1 for a variable, any number for an array.
    pub count: u32,
    /// What it is for: one usage of a variable, all choices of an array.
    pub usages: Vec<UsageRange>,
    /// How it is to be read.
    pub flags: Flags,
    /// Smallest and largest value. Negative minimum: two's complement.
    pub logical: [i64; 2],
    /// The same two in [`unit`](Self::unit).
    pub physical: [i64; 2],
    /// What the physical range is in.
    pub unit: Unit,
    /// Index of the collection it stands in.
    pub collection: Option<usize>,
}

impl Described {
    /// What a variable is for.
    pub fn usage(&self) -> Usage {
        let first = self.usages.first().and_then(|range| range.nth(0));
        first.unwrap_or_default()
    }

    /// Logical counts in one of the physical unit; `None` where the ranges do not say.
    pub fn counts_per_unit(&self) -> Option<f64> {
        let span = |[low, high]: [i64; 2]| high as f64 - low as f64;
        let physical = span(self.physical) * self.unit.factor();
        let counts = span(self.logical) / physical;
        (counts.is_finite() && counts > 0.0).then_some(counts)
    }
}

/// A collection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Collection {
    /// 0 physical, 1 application, 2 logical, 3 report, and so on.
    pub kind: u8,
    /// What it is for.
    pub usage: Usage,
    /// Index of the collection around it.
    pub parent: Option<usize>,
}

impl Collection {
    /// An application collection.
    pub fn is_application(&self) -> bool {
        self.kind == 1
    }
}
