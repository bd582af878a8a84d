//! What items set for those that follow: globals stay, locals end with the next main item.

use super::item::Item;
use super::{DescriptorFault, Unit, Usage, UsageRange};

/// Most usages in one main item; Linux has the same limit.
const USAGES_MAX: usize = 12_288;

/// Global items. Source: HID 1.11, 6.2.2.7.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Globals {
    page: u16,
    logical: [Option<Written>; 2],
    physical: [Option<Written>; 2],
    unit: u32,
    exponent: i32,
    pub(super) size: u32,
    pub(super) count: u32,
    pub(super) report: u8,
}

/// A number whose sign is decided only when both ends of its range are known.
#[derive(Clone, Copy, Debug)]
struct Written {
    signed: i32,
    unsigned: u32,
}

impl Globals {
    /// Takes an item; Push and Pop are the parser's.
    pub(super) fn take(&mut self, item: Item<'_>) -> Result<(), DescriptorFault> {
        let written = Some(Written {
            signed: item.signed(),
            unsigned: item.unsigned(),
        });
        match item.tag {
            0 => self.page = item.unsigned() as u16,
            1 => self.logical[0] = written,
            2 => self.logical[1] = written,
            3 => self.physical[0] = written,
            4 => self.physical[1] = written,
            5 => self.exponent = item.signed(),
            6 => self.unit = item.unsigned(),
            7 => self.size = item.unsigned(),
            8 => {
                let found = item.unsigned();
                self.report = u8::try_from(found)
                    .ok()
                    .filter(|&id| id > 0)
                    .ok_or(DescriptorFault::ReportId { found })?;
            }
            9 => self.count = item.unsigned(),
            // Reserved.
            _ => {}
        }
        Ok(())
    }

    pub(super) fn logical(&self) -> [i64; 2] {
        range(self.logical)
    }

    /// Without a physical range, or with two zeros, it is the logical one.
    pub(super) fn physical(&self) -> [i64; 2] {
        match range(self.physical) {
            [0, 0] => self.logical(),
            range => range,
        }
    }

    pub(super) fn unit(&self) -> Unit {
        Unit::new(self.unit, self.exponent)
    }

    pub(super) fn usage(&self, id: u32, long: bool) -> Usage {
        if long {
            Usage::new((id >> 16) as u16, id as u16)
        } else {
            Usage::new(self.page, id as u16)
        }
    }
}

/// The minimum has a sign; the maximum only below a negative minimum. So a maximum of one byte FF is 255 over 0.
fn range([low, high]: [Option<Written>; 2]) -> [i64; 2] {
    let low = low.map_or(0, |low| i64::from(low.signed));
    let high = high.map_or(0, |high| {
        if low < 0 {
            i64::from(high.signed)
        } else {
            i64::from(high.unsigned)
        }
    });
    [low, high]
}

/// Local items. Source: HID 1.11, 6.2.2.8. Usages are kept as written: their page is that in force at the main item.
#[derive(Clone, Debug, Default)]
pub(super) struct Locals {
    usages: Vec<(RawUsage, RawUsage)>,
    from: Option<RawUsage>,
    to: Option<RawUsage>,
    delimiter: Delimiter,
    listed: usize,
}

#[derive(Clone, Copy, Debug)]
struct RawUsage {
    id: u32,
    long: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Delimiter {
    #[default]
    Closed,
    /// The first usage of a set of equal ones is still to come.
    Open,
    /// It has come; the others are other names for the same thing.
    Served,
}

impl Locals {
    pub(super) fn take(&mut self, item: Item<'_>) -> Result<(), DescriptorFault> {
        let raw = RawUsage {
            id: item.unsigned(),
            long: item.data.len() == 4,
        };
        match item.tag {
            0 => self.add(raw, raw)?,
            1 => self.from = Some(raw),
            2 => self.to = Some(raw),
            10 => self.delimit(item.unsigned() != 0)?,
            // Designators and strings say nothing about reports.
            _ => {}
        }
        if let (Some(from), Some(to)) = (self.from, self.to) {
            (self.from, self.to) = (None, None);
            self.add(from, to)?;
        }
        Ok(())
    }

    fn add(&mut self, from: RawUsage, to: RawUsage) -> Result<(), DescriptorFault> {
        // Only a minimum of four bytes makes the maximum's upper half a page.
        let to_id = if from.long && !to.long {
            from.id & 0xFFFF_0000 | to.id
        } else {
            to.id
        };
        if to_id < from.id {
            return Err(DescriptorFault::Falls {
                what: "the usage range",
                from: from.id.into(),
                to: to_id.into(),
            });
        }
        // A range stays on its page.
        let to_id = to_id.min(from.id | 0xFFFF);
        match self.delimiter {
            Delimiter::Served => return Ok(()),
            Delimiter::Open => self.delimiter = Delimiter::Served,
            Delimiter::Closed => {}
        }
        self.listed += 1;
        if self.listed > USAGES_MAX {
            return Err(DescriptorFault::TooManyFields { most: USAGES_MAX });
        }
        let long = from.long;
        self.usages.push((from, RawUsage { id: to_id, long }));
        Ok(())
    }

    fn delimit(&mut self, open: bool) -> Result<(), DescriptorFault> {
        match (open, self.delimiter) {
            (true, Delimiter::Closed) => self.delimiter = Delimiter::Open,
            (false, Delimiter::Open | Delimiter::Served) => self.delimiter = Delimiter::Closed,
            (true, _) => return Err(DescriptorFault::Delimiter { found: "opened" }),
            (false, _) => return Err(DescriptorFault::Delimiter { found: "closed" }),
        }
        Ok(())
    }

    /// All usages so far, with the pages now in force.
    pub(super) fn usages(&self, globals: &Globals) -> Vec<UsageRange> {
        let range = |(from, to): &(RawUsage, RawUsage)| {
            let first = globals.usage(from.id, from.long);
            UsageRange {
                page: first.page,
                ids: [first.id, to.id.max(first.id.into()) as u16],
            }
        };
        self.usages.iter().map(range).collect()
    }
}
