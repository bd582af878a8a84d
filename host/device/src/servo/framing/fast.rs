//! The single packet in which several servos answer a fast read, one block after another.
//!
//! Source: ROBOTIS e-manual, "Fast Sync Read" and "Fast Bulk Read": behind the head, each servo puts
//! `error id data CRC`, nothing is stuffed, and each CRC covers the packet from its first byte to there, the CRCs
//! before it included. So every block can be checked when it is complete, and one that is damaged does not spoil
//! those behind it: the CRC received in it is where the next one's goes on from. An id is only believed together
//! with a right CRC behind it.

use super::dynamixel2::{crc, crc_behind};

/// Bytes of a block around its data: error, id, CRC.
pub(super) const BLOCK_OVERHEAD_BYTES: usize = 4;
/// Bytes before the first block: header, id, length, instruction.
pub(super) const HEAD_BYTES: usize = 8;
/// Bytes of a block's CRC.
const CRC_BYTES: usize = 2;

/// What to do with the bytes at the front.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// Wait for more.
    Short,
    /// Drop so many bytes that belong to no good block.
    Skip(usize),
    /// A good block of so many bytes, behind `lead` bytes that are dropped; whose it is, by place in the list.
    Block {
        lead: usize,
        bytes: usize,
        index: usize,
        damaged: Option<usize>,
    },
    /// Nothing more will be found.
    End { damaged: Option<usize> },
}

/// How far such a packet has been read.
#[derive(Debug, Clone)]
pub(super) struct FastRun {
    next: usize,
    /// Bytes of the packet from the front on, by its length field.
    left: usize,
    /// The checksum of all before the next block.
    before: u16,
    lost: Option<Lost>,
}

/// A block was not what it should be.
#[derive(Debug, Clone, Copy)]
struct Lost {
    /// What the next block goes on from if nothing but the CRC was hit.
    crc_alone: u16,
}

impl FastRun {
    /// Behind the head of a packet with this length field.
    pub(super) fn new(head: &[u8], length: usize) -> Self {
        Self {
            next: 0,
            left: length.saturating_sub(1),
            before: crc(head),
            lost: None,
        }
    }

    /// Looks at the bytes at the front. `list`: id and data bytes of each servo asked. `ended`: no more will come.
    pub(super) fn step(&mut self, bytes: &[u8], list: &[(u8, u16)], ended: bool) -> Step {
        if self.next >= list.len() {
            return Step::End { damaged: None };
        }
        // What is beyond the packet's length is not its own, so that the size of the pieces makes no difference.
        let ended = ended || bytes.len() >= self.left;
        let bytes = bytes.get(..self.left).unwrap_or(bytes);
        if self.lost.is_some() {
            self.search(bytes, list, ended)
        } else {
            self.in_place(bytes, list, ended)
        }
    }

    fn in_place(&mut self, bytes: &[u8], list: &[(u8, u16)], ended: bool) -> Step {
        for (index, &(id, data)) in list.iter().enumerate().skip(self.next) {
            let size = usize::from(data) + BLOCK_OVERHEAD_BYTES;
            let Some(block) = bytes.get(..size) else {
                let may_be_his = index == self.next || bytes.get(1) == Some(&id);
                if may_be_his && !ended {
                    return Step::Short;
                }
                continue;
            };
            if let Some(before) = behind_block(self.before, block, id) {
                return self.found(before, index, 0, size, None);
            }
        }
        let due = list.get(self.next).map_or(0, |&(_, data)| usize::from(data));
        let whole = bytes.get(..due + 2);
        match whole {
            None if bytes.is_empty() => Step::End { damaged: None },
            None => Step::End {
                damaged: Some(self.next),
            },
            Some(covered) => {
                let sum = crc_behind(self.before, covered);
                self.lost = Some(Lost {
                    crc_alone: crc_behind(sum, &sum.to_le_bytes()),
                });
                self.search(bytes, list, ended)
            }
        }
    }

    /// Bytes were changed, lost or put in: tries the damaged block again further on, and each later one behind what
    /// may be the CRC before it.
    fn search(&mut self, bytes: &[u8], list: &[(u8, u16)], ended: bool) -> Step {
        let Some(lost) = self.lost else {
            return Step::Short;
        };
        let damaged = Some(self.next);
        let field = match bytes {
            &[low, high, ..] => u16::from_le_bytes([low, high]),
            _ if ended => return Step::End { damaged },
            _ => return Step::Short,
        };
        let behind_field = crc_behind(field, &field.to_le_bytes());
        let mut short = false;
        for (index, &(id, data)) in list.iter().enumerate().skip(self.next) {
            let size = usize::from(data) + BLOCK_OVERHEAD_BYTES;
            let (lead, starts) = if index == self.next {
                (1, [Some(self.before), None])
            } else {
                (CRC_BYTES, [Some(behind_field), Some(lost.crc_alone)])
            };
            let Some(block) = bytes.get(lead..lead + size) else {
                short = true;
                continue;
            };
            let found = starts
                .into_iter()
                .flatten()
                .find_map(|start| behind_block(start, block, id));
            if let Some(before) = found {
                let damaged = damaged.filter(|&at| at != index);
                return self.found(before, index, lead, size, damaged);
            }
        }
        if short && !ended {
            return Step::Short;
        }
        self.left = self.left.saturating_sub(1);
        Step::Skip(1)
    }

    fn found(
        &mut self,
        before: u16,
        index: usize,
        lead: usize,
        bytes: usize,
        damaged: Option<usize>,
    ) -> Step {
        self.before = before;
        self.next = index + 1;
        self.left = self.left.saturating_sub(lead + bytes);
        self.lost = None;
        Step::Block {
            lead,
            bytes,
            index,
            damaged,
        }
    }
}

/// The checksum of all up to and with this block, if it is the servo's and its CRC is right.
fn behind_block(before: u16, block: &[u8], id: u8) -> Option<u16> {
    let (covered, field) = block.split_at_checked(block.len().checked_sub(CRC_BYTES)?)?;
    let sum = crc_behind(before, covered);
    let good = covered.get(1) == Some(&id) && field == sum.to_le_bytes();
    good.then(|| crc_behind(sum, field))
}
