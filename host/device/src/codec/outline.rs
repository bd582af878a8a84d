//! The outline of a HID report descriptor: what its collections are for and how long its reports are.
//!
//! Enough to know a device by and to fill up what is sent to it. It takes descriptors as they come: one that lies or
//! is cut short gives what stands before the fault, since a device may be known by its ids all the same. What each
//! bit means is read elsewhere. Source: HID 1.11, 5.2 to 6.2.2.

use std::collections::BTreeMap;

/// Which way a report goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ReportKind {
    /// Device to host.
    Input,
    /// Host to device.
    Output,
    /// Set and asked.
    Feature,
}

/// No report is longer (`HID_MAX_BUFFER_SIZE` of Linux); a descriptor that says so lies.
const BYTES_MAX: u64 = 16_384;

/// What a descriptor says in outline.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outline {
    /// Usage page and usage of every top-level collection, in order.
    pub usages: Vec<[u16; 2]>,
    /// Whether reports begin with an id.
    pub numbered: bool,
    bits: BTreeMap<(ReportKind, u8), u64>,
}

#[derive(Clone, Copy, Default)]
struct Globals {
    page: u16,
    size: u32,
    count: u32,
    id: u8,
}

impl Outline {
    /// Reads a descriptor.
    pub fn of(descriptor: &[u8]) -> Self {
        let mut outline = Self::default();
        let mut globals = Globals::default();
        let mut pushed = Vec::new();
        let mut usage: Option<u32> = None;
        let mut depth = 0_u32;
        let mut rest = descriptor;
        while let Some((head, data, behind)) = item(rest) {
            rest = behind;
            let value = data
                .iter()
                .rev()
                .fold(0_u32, |sum, &byte| sum << 8 | u32::from(byte));
            match head & 0xFC {
                0x04 => globals.page = value as u16,
                0x74 => globals.size = value,
                0x94 => globals.count = value,
                0x84 => {
                    globals.id = value as u8;
                    outline.numbered = true;
                }
                // As deep as HID devices go, and a little more.
                0xA4 if pushed.len() < 64 => pushed.push(globals),
                0xB4 => globals = pushed.pop().unwrap_or(globals),
                0x08 => {
                    // A usage of four bytes brings its own page.
                    let page = if data.len() == 4 {
                        value >> 16
                    } else {
                        globals.page.into()
                    };
                    usage.get_or_insert(page << 16 | (value & 0xFFFF));
                }
                0xA0 => {
                    if depth == 0
                        && let Some(usage) = usage
                    {
                        outline.usages.push([(usage >> 16) as u16, usage as u16]);
                    }
                    depth += 1;
                }
                0xC0 => depth = depth.saturating_sub(1),
                0x80 => outline.grow(ReportKind::Input, globals),
                0x90 => outline.grow(ReportKind::Output, globals),
                0xB0 => outline.grow(ReportKind::Feature, globals),
                _ => {}
            }
            // Local items hold up to the next main item.
            if head & 0x0C == 0 {
                usage = None;
            }
        }
        outline
    }

    fn grow(&mut self, kind: ReportKind, globals: Globals) {
        let bits = self.bits.entry((kind, globals.id)).or_default();
        let more = u64::from(globals.size) * u64::from(globals.count);
        *bits = (*bits + more).min(BYTES_MAX * 8);
    }

    /// Bytes of one report, with its id where reports have one; `None` for one that is not there.
    pub fn bytes(&self, kind: ReportKind, id: u8) -> Option<u16> {
        let bits = self.bits.get(&(kind, id))?;
        Some(bits.div_ceil(8) as u16 + u16::from(self.numbered))
    }

    /// Bytes of the longest report of a kind; 0 without any.
    pub fn longest(&self, kind: ReportKind) -> u16 {
        let ids = self.bits.keys().filter(|(of, _)| *of == kind);
        ids.filter_map(|&(of, id)| self.bytes(of, id)).max().unwrap_or(0)
    }
}

/// The first item: its head, its data, what comes behind. `None` at the end or where it is cut off.
fn item(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (&head, rest) = bytes.split_first()?;
    if head == 0xFE {
        // A long item: its length, its tag, its data. None is defined, so none matters.
        let (&length, rest) = rest.split_first()?;
        let rest = rest.get(1 + usize::from(length)..)?;
        return Some((head, &[], rest));
    }
    let length = [0, 1, 2, 4][usize::from(head & 3)];
    Some((head, rest.get(..length)?, rest.get(length..)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pen of 8 bytes in report 7, a vendor page with 10 bytes out in report 2 and a feature.
    const PEN_AND_VENDOR: &[u8] = &[
        0x05, 0x0D, 0x09, 0x02, 0xA1, 0x01, 0x85, 0x07, 0x09, 0x20, 0xA1, 0x00, 0x75, 0x08, 0x95, 0x07, 0x81,
        0x02, 0xC0, 0xC0, 0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x85, 0x02, 0x75, 0x08, 0x95, 0x09, 0x91,
        0x02, 0x95, 0x01, 0xB1, 0x02, 0xC0,
    ];

    #[test]
    fn usages_and_lengths_are_read() {
        let outline = Outline::of(PEN_AND_VENDOR);
        assert_eq!(outline.usages, [[0x0D, 2], [0xFF00, 1]]);
        assert!(outline.numbered);
        let longest =
            [ReportKind::Input, ReportKind::Output, ReportKind::Feature].map(|k| outline.longest(k));
        assert_eq!(longest, [8, 10, 2]);
        assert_eq!(outline.bytes(ReportKind::Output, 2), Some(10));
        assert_eq!(outline.bytes(ReportKind::Output, 7), None);
    }

    #[test]
    fn without_ids_nothing_is_added() {
        // Six bytes of input, as a knob has them.
        let outline = Outline::of(&[
            0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x75, 0x08, 0x95, 0x06, 0x81, 0x02, 0xC0,
        ]);
        assert!(!outline.numbered);
        assert_eq!(outline.longest(ReportKind::Input), 6);
        assert_eq!(outline.longest(ReportKind::Output), 0);
    }

    #[test]
    fn nothing_that_is_cut_or_lies_breaks_it() {
        for end in 0..PEN_AND_VENDOR.len() {
            Outline::of(&PEN_AND_VENDOR[..end]);
        }
        // 4 294 967 295 times as many bits, again and again.
        let lie = [
            0x77, 0xFF, 0xFF, 0xFF, 0xFF, 0x97, 0xFF, 0xFF, 0xFF, 0xFF, 0x81, 2, 0x81, 2,
        ];
        assert_eq!(Outline::of(&lie).longest(ReportKind::Input), BYTES_MAX as u16);
        Outline::of(&[0xA4; 10_000]);
        Outline::of(&[0xB4; 100]);
        Outline::of(&[0xFE, 0xFF]);
    }
}
