//! From items to fields.

use super::field::{Collection, Described, Direction, Flags, Usage, UsageRange};
use super::item::{Item, Kind, items};
use super::state::{Globals, Locals};
use super::{
    DEPTH_MAX, DESCRIPTOR_BYTES_MAX, Descriptor, DescriptorError, DescriptorFault, FIELDS_MAX,
    REPORT_BYTES_MAX,
};

/// Widest field; Linux has the same limit. Wider than 64 bits tells no number and is passed over as a whole.
const WIDTH_MAX: u32 = 256;
/// Push and Pop, among the global tags.
const PUSH: u8 = 10;
const POP: u8 = 11;

#[derive(Default)]
struct Parser {
    out: Descriptor,
    globals: Globals,
    pushed: Vec<Globals>,
    locals: Locals,
    open: Vec<usize>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<Descriptor, DescriptorError> {
    if bytes.len() > DESCRIPTOR_BYTES_MAX {
        return Err(DescriptorError {
            at: DESCRIPTOR_BYTES_MAX,
            fault: DescriptorFault::TooLong {
                most: DESCRIPTOR_BYTES_MAX,
                found: bytes.len(),
            },
        });
    }
    let mut parser = Parser::default();
    for item in items(bytes) {
        let item = item?;
        parser
            .take(item)
            .map_err(|fault| DescriptorError { at: item.at, fault })?;
    }
    if !parser.open.is_empty() {
        return Err(DescriptorError {
            at: bytes.len(),
            fault: DescriptorFault::OpenCollections {
                open: parser.open.len(),
            },
        });
    }
    Ok(parser.out)
}

impl Parser {
    fn take(&mut self, item: Item<'_>) -> Result<(), DescriptorFault> {
        match item.kind {
            Kind::Other => Ok(()),
            Kind::Local => self.locals.take(item),
            Kind::Global => self.global(item),
            Kind::Main => {
                let done = self.main(item);
                self.locals = Locals::default();
                done
            }
        }
    }

    fn global(&mut self, item: Item<'_>) -> Result<(), DescriptorFault> {
        match item.tag {
            PUSH if self.pushed.len() >= DEPTH_MAX => Err(DescriptorFault::TooDeep {
                what: "pushes",
                most: DEPTH_MAX,
            }),
            PUSH => {
                self.pushed.push(self.globals);
                Ok(())
            }
            POP => {
                self.globals = self.pushed.pop().ok_or(DescriptorFault::PopWithoutPush)?;
                Ok(())
            }
            _ => {
                let before = self.globals.report;
                self.globals.take(item)?;
                if before == 0 && self.globals.report != 0 && !self.out.numbered {
                    if !self.out.reports.is_empty() {
                        return Err(DescriptorFault::LateReportId);
                    }
                    self.out.numbered = true;
                }
                Ok(())
            }
        }
    }

    fn main(&mut self, item: Item<'_>) -> Result<(), DescriptorFault> {
        let flags = Flags(item.unsigned());
        match item.tag {
            8 => self.fields(Direction::Input, flags),
            9 => self.fields(Direction::Output, flags),
            11 => self.fields(Direction::Feature, flags),
            10 => self.begin(item),
            12 => match self.open.pop() {
                Some(_) => Ok(()),
                None => Err(DescriptorFault::EndWithoutCollection),
            },
            // Reserved. Firmware leaves a zero behind its last item, which is one of these; systems pass them over.
            _ => Ok(()),
        }
    }

    fn begin(&mut self, item: Item<'_>) -> Result<(), DescriptorFault> {
        if self.open.len() >= DEPTH_MAX {
            return Err(DescriptorFault::TooDeep {
                what: "collections",
                most: DEPTH_MAX,
            });
        }
        let usages = self.locals.usages(&self.globals);
        let usage = usages.first().and_then(|range| range.nth(0));
        self.out.collections.push(Collection {
            kind: item.unsigned() as u8,
            usage: usage.unwrap_or_default(),
            parent: self.open.last().copied(),
        });
        self.open.push(self.out.collections.len() - 1);
        Ok(())
    }

    fn fields(&mut self, direction: Direction, flags: Flags) -> Result<(), DescriptorFault> {
        let (width, count) = (self.globals.size, self.globals.count);
        if width > WIDTH_MAX {
            return Err(DescriptorFault::ReportSize {
                most: WIDTH_MAX,
                found: width,
            });
        }
        let bit = self.grow(direction, u64::from(width) * u64::from(count))?;
        if flags.constant() || width == 0 || width > 64 || count == 0 {
            return Ok(());
        }
        let logical = self.globals.logical();
        if logical[0] > logical[1] {
            return Err(DescriptorFault::Falls {
                what: "the logical range",
                from: logical[0],
                to: logical[1],
            });
        }
        let usages = self.locals.usages(&self.globals);
        let field = Described {
            direction,
            report: self.globals.report,
            bit,
            width,
            count,
            usages: Vec::new(),
            flags,
            logical,
            physical: self.globals.physical(),
            unit: self.globals.unit(),
            collection: self.open.last().copied(),
        };
        if !flags.variable() {
            return self.push(Described { usages, ..field });
        }
        if usages.is_empty() {
            // Vendors describe blobs so: nothing that a control could be made of.
            return Ok(());
        }
        for n in 0..count {
            let usage = nth_usage(&usages, n);
            self.push(Described {
                bit: bit + n * width,
                count: 1,
                usages: vec![UsageRange {
                    page: usage.page,
                    ids: [usage.id; 2],
                }],
                ..field.clone()
            })?;
        }
        Ok(())
    }

    fn push(&mut self, field: Described) -> Result<(), DescriptorFault> {
        if self.out.fields.len() >= FIELDS_MAX {
            return Err(DescriptorFault::TooManyFields { most: FIELDS_MAX });
        }
        self.out.fields.push(field);
        Ok(())
    }

    /// Makes the report longer and gives the first new bit.
    fn grow(&mut self, direction: Direction, by: u64) -> Result<u32, DescriptorFault> {
        let id = self.globals.report;
        let reports = &mut self.out.reports;
        let known = reports.iter().position(|&(d, i, _)| (d, i) == (direction, id));
        let at = known.unwrap_or_else(|| {
            reports.push((direction, id, 0));
            reports.len() - 1
        });
        let Some((_, _, bits)) = reports.get_mut(at) else {
            return Ok(0);
        };
        let before = *bits;
        let after = u64::from(before) + by;
        if after > u64::from(REPORT_BYTES_MAX) * 8 {
            return Err(DescriptorFault::ReportLength {
                bits: after,
                most: REPORT_BYTES_MAX,
            });
        }
        *bits = after as u32;
        Ok(before)
    }
}

/// The usage of the `n`-th field; the last one is that of all that follow.
fn nth_usage(usages: &[UsageRange], mut n: u32) -> Usage {
    let mut last = Usage::default();
    for range in usages {
        if let Some(usage) = range.nth(n) {
            return usage;
        }
        n = n.saturating_sub(range.count());
        last = Usage::new(range.page, range.ids[1]);
    }
    last
}
