//! Items: the words of a descriptor. Short ones have a head of one byte and 0, 1, 2 or 4 bytes; long ones say their
//! length. Source: HID 1.11, 6.2.2.2 and 6.2.2.3.

use super::{DescriptorError, DescriptorFault};

/// The head of a long item.
const LONG: u8 = 0xFE;

/// One item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Item<'a> {
    /// Offset of its head.
    pub(super) at: usize,
    pub(super) kind: Kind,
    /// Upper four bits of the head.
    pub(super) tag: u8,
    pub(super) data: &'a [u8],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Main,
    Global,
    Local,
    /// Reserved types, and long items, of which HID defines none: passed over.
    Other,
}

impl Item<'_> {
    /// The data as an unsigned number.
    pub(super) fn unsigned(&self) -> u32 {
        self.data
            .iter()
            .rev()
            .fold(0, |sum, &byte| sum << 8 | u32::from(byte))
    }

    /// The data as a number with a sign, by its own length.
    pub(super) fn signed(&self) -> i32 {
        match *self.data {
            [low] => i32::from(low as i8),
            [low, high] => i32::from(i16::from_le_bytes([low, high])),
            _ => self.unsigned() as i32,
        }
    }
}

/// All items in order; after an error there are none.
pub(super) fn items(bytes: &[u8]) -> impl Iterator<Item = Result<Item<'_>, DescriptorError>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = bytes.get(at..)?;
        let &head = rest.first()?;
        let (start, length) = match (head, rest) {
            (LONG, [_, length, _, ..]) => (3, usize::from(*length)),
            (LONG, _) => (3, 0),
            _ => (1, [0, 1, 2, 4][usize::from(head & 3)]),
        };
        let item = rest.get(start..start + length).map(|data| Item {
            at,
            kind: match head >> 2 & 3 {
                _ if head == LONG => Kind::Other,
                0 => Kind::Main,
                1 => Kind::Global,
                2 => Kind::Local,
                _ => Kind::Other,
            },
            tag: head >> 4,
            data,
        });
        let here = at;
        at = item.map_or(bytes.len(), |_| at + start + length);
        Some(item.ok_or(DescriptorError {
            at: here,
            fault: DescriptorFault::CutOff {
                needed: start + length,
                left: rest.len(),
            },
        }))
    })
}
