//! Legal descriptors by chance, with all the ways of saying things, against what was meant.
//!
//! The writer says a global only where it differs from what stands, so that what stays, what is pushed and what is
//! popped matters. Written from HID 1.11 alone; it shares no code with the reader.

use super::{Descriptor, Direction};
use proptest::prelude::*;
use std::collections::BTreeMap;

const DIRECTIONS: [(Direction, u8); 3] = [
    (Direction::Input, 0x80),
    (Direction::Output, 0x90),
    (Direction::Feature, 0xB0),
];
/// Tags with the type "global".
const PAGE: u8 = 0x04;
const LOGICAL: [u8; 2] = [0x14, 0x24];
const PHYSICAL: [u8; 2] = [0x34, 0x44];
const EXPONENT: u8 = 0x54;
const UNIT: u8 = 0x64;
const SIZE: u8 = 0x74;
const REPORT: u8 = 0x84;
const COUNT: u8 = 0x94;

/// One thing to be described.
#[derive(Clone, Debug)]
enum Op {
    Field(Meant),
    /// Padding of so many bits.
    Constant {
        direction: usize,
        report: usize,
        bits: u32,
    },
    Open {
        usage: (u16, u16),
        kind: u8,
    },
    Close,
    Push,
    Pop,
    /// A long item of so many bytes.
    Long(u8),
    /// A designator, a string or a reserved global: they mean nothing here.
    Idle(u8),
}

/// What a field is to mean.
#[derive(Clone, Debug)]
struct Meant {
    direction: usize,
    report: usize,
    width: u32,
    count: u32,
    page: u16,
    first: u16,
    spelling: Spelling,
    flags: u32,
    signed: bool,
    ends: [u32; 2],
    physical: Option<[i16; 2]>,
    unit: u32,
    exponent: u8,
}

#[derive(Clone, Copy, Debug)]
enum Spelling {
    /// One usage after the other.
    Singly,
    /// A range, its end first or last.
    Range { end_first: bool },
    /// Four bytes each, while another page is in force.
    Extended,
    /// A range of four bytes.
    ExtendedRange,
    /// Only the first; the others are named like it.
    Short,
    /// Each the first of a delimited set.
    Delimited,
}

/// What the reader must find.
type Row = (
    Direction,
    u8,
    u32,
    u32,
    u32,
    Vec<(u16, u16, u16)>,
    u32,
    [i64; 2],
    [i64; 2],
    (u32, i8),
    Vec<(u16, u16)>,
);

fn meant() -> impl Strategy<Value = Meant> {
    let place = (0_usize..3, 0_usize..3, 1_u32..=32, 1_u32..5);
    let usage = (1_u16..0xFF00, 1_u16..0x0FF0, spelling());
    let flags = prop::bits::u32::masked(0x1FE);
    let range = (
        any::<bool>(),
        any::<[u32; 2]>(),
        prop::option::of(any::<[i16; 2]>()),
    );
    let unit = (
        prop_oneof![Just(0), Just(0x11), Just(0x13), Just(0x14), any::<u32>()],
        0_u8..16,
    );
    (place, usage, flags, range, unit).prop_map(
        |(
            (direction, report, width, count),
            (page, first, spelling),
            flags,
            (signed, ends, physical),
            (unit, exponent),
        )| Meant {
            direction,
            report,
            width,
            count,
            page,
            first,
            spelling,
            flags,
            signed,
            ends,
            physical,
            unit,
            exponent,
        },
    )
}

fn spelling() -> impl Strategy<Value = Spelling> {
    prop_oneof![
        Just(Spelling::Singly),
        any::<bool>().prop_map(|end_first| Spelling::Range { end_first }),
        Just(Spelling::Extended),
        Just(Spelling::ExtendedRange),
        Just(Spelling::Short),
        Just(Spelling::Delimited),
    ]
}

fn op() -> impl Strategy<Value = Op> {
    prop_oneof![
        8 => meant().prop_map(Op::Field),
        2 => (0_usize..3, 0_usize..3, 1_u32..40).prop_map(|(direction, report, bits)| Op::Constant { direction, report, bits }),
        2 => ((1_u16..0xFF00, 1_u16..0x100), 0_u8..7).prop_map(|(usage, kind)| Op::Open { usage, kind }),
        2 => Just(Op::Close),
        1 => Just(Op::Push),
        1 => Just(Op::Pop),
        1 => any::<u8>().prop_map(Op::Long),
        1 => prop_oneof![Just(0x38), Just(0x48), Just(0x58), Just(0x78), Just(0x88), Just(0x98), Just(0xC4), Just(0x0C)].prop_map(Op::Idle),
    ]
}

/// Bytes as they grow, and what they mean so far.
#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    globals: BTreeMap<u8, i64>,
    pushed: Vec<BTreeMap<u8, i64>>,
    bits: BTreeMap<(Direction, u8), u32>,
    open: Vec<(u16, u16)>,
    /// Ids of reports; without any, reports are not numbered.
    ids: Option<[u8; 3]>,
    /// Items with more bytes than they need.
    wide: bool,
    rows: Vec<Row>,
}

impl Writer {
    fn item(&mut self, head: u8, value: u32, most: usize) {
        let bytes = value.to_le_bytes();
        let needed = bytes.iter().rposition(|&byte| byte != 0).map_or(0, |at| at + 1);
        self.data(head, &bytes, if self.wide { most } else { needed.min(most) });
    }

    /// With a sign: the highest bit written is it.
    fn signed(&mut self, head: u8, value: i64) {
        let length = match value {
            _ if self.wide => 4,
            0 => 0,
            -0x80..=0x7F => 1,
            -0x8000..=0x7FFF => 2,
            _ => 4,
        };
        self.data(head, &value.to_le_bytes(), length);
    }

    fn data(&mut self, head: u8, bytes: &[u8], length: usize) {
        let (code, length) = [(0, 0), (1, 1), (2, 2), (3, 4), (3, 4)][length];
        self.bytes.push(head | code);
        self.bytes.extend(&bytes[..length]);
    }

    /// Whether a global has to be said.
    fn differs(&mut self, tag: u8, value: i64) -> bool {
        self.globals.insert(tag, value) != Some(value)
    }

    fn global(&mut self, tag: u8, value: u32) {
        if self.differs(tag, value.into()) {
            self.item(tag, value, 4);
        }
    }

    fn range(&mut self, tags: [u8; 2], [low, high]: [i64; 2]) {
        if self.differs(tags[0], low) {
            self.signed(tags[0], low);
        }
        // A maximum is read with the minimum's sign: said anew, it is the same in any reading.
        self.globals.insert(tags[1], high);
        if low < 0 {
            self.signed(tags[1], high);
        } else {
            self.item(tags[1], high as u32, 4);
        }
    }

    fn report(&mut self, which: usize) -> u8 {
        let id = self.ids.map_or(0, |ids| ids[which]);
        if id > 0 {
            self.global(REPORT, id.into());
        }
        id
    }

    fn take(&mut self, op: &Op) {
        match op {
            Op::Field(meant) => self.field(meant),
            Op::Constant {
                direction,
                report,
                bits,
            } => {
                let id = self.report(*report);
                self.global(SIZE, *bits);
                self.global(COUNT, 1);
                let (direction, head) = DIRECTIONS[*direction];
                self.item(head, 0x03, 4);
                *self.bits.entry((direction, id)).or_default() += bits;
            }
            Op::Open { usage, kind } => {
                self.global(PAGE, usage.0.into());
                self.item(0x08, usage.1.into(), 2);
                self.item(0xA0, u32::from(*kind), 1);
                self.open.push(*usage);
            }
            Op::Close if self.open.pop().is_some() => self.bytes.push(0xC0),
            Op::Push => {
                self.pushed.push(self.globals.clone());
                self.bytes.push(0xA4);
            }
            Op::Pop => {
                if let Some(globals) = self.pushed.pop() {
                    self.globals = globals;
                    self.bytes.push(0xB4);
                }
            }
            Op::Long(length) => {
                self.bytes.extend([0xFE, *length, 0xF1]);
                self.bytes.extend(std::iter::repeat_n(0xC0, usize::from(*length)));
            }
            Op::Idle(head) => self.item(*head, 0x05, 1),
            Op::Close => {}
        }
    }

    fn field(&mut self, meant: &Meant) {
        let id = self.report(meant.report);
        let logical = meant.logical();
        let physical = meant.physical();
        self.range(LOGICAL, logical);
        self.range(PHYSICAL, physical);
        self.global(UNIT, meant.unit);
        self.global(EXPONENT, meant.exponent.into());
        self.global(SIZE, meant.width);
        self.global(COUNT, meant.count);
        let usages = self.usages(meant);
        let (direction, head) = DIRECTIONS[meant.direction];
        self.item(head, meant.flags, 2);
        let first = *self.bits.entry((direction, id)).or_default();
        *self.bits.entry((direction, id)).or_default() += meant.width * meant.count;
        let told = if physical == [0, 0] { logical } else { physical };
        // Four bits with a sign.
        let exponent = if meant.exponent > 7 {
            meant.exponent as i8 - 16
        } else {
            meant.exponent as i8
        };
        let around: Vec<_> = self.open.iter().rev().copied().collect();
        let mut row = |bit, count, usages| {
            self.rows.push((
                direction,
                id,
                bit,
                meant.width,
                count,
                usages,
                meant.flags,
                logical,
                told,
                (meant.unit, exponent),
                around.clone(),
            ));
        };
        if meant.flags & 2 == 0 {
            row(first, meant.count, usages);
            return;
        }
        let each: Vec<(u16, u16)> = usages
            .iter()
            .flat_map(|&(page, from, to)| (from..=to).map(move |id| (page, id)))
            .collect();
        for n in 0..meant.count {
            let (page, id) = *each.get(n as usize).or(each.last()).expect("there is one");
            row(first + n * meant.width, 1, vec![(page, id, id)]);
        }
    }

    /// Writes the usages and says which they are.
    fn usages(&mut self, meant: &Meant) -> Vec<(u16, u16, u16)> {
        let (page, first, last) = (meant.page, meant.first, meant.first + meant.count as u16 - 1);
        let long = |id: u16| u32::from(page) << 16 | u32::from(id);
        let singly = || (first..=last).map(|id| (page, id, id)).collect();
        if matches!(meant.spelling, Spelling::Extended | Spelling::ExtendedRange) {
            self.global(PAGE, u32::from(page ^ 1).max(1));
        } else if matches!(meant.spelling, Spelling::Singly) {
            // The page in force is the one at the main item, also where it is said behind the usages.
            for id in first..=last {
                self.item(0x08, id.into(), 2);
            }
            self.global(PAGE, page.into());
            return singly();
        } else {
            self.global(PAGE, page.into());
        }
        match meant.spelling {
            Spelling::Singly => {}
            Spelling::Range { end_first } => {
                let mut ends = [(0x18, first), (0x28, last)];
                if end_first {
                    ends.reverse();
                }
                for (head, id) in ends {
                    self.item(head, id.into(), 2);
                }
                return vec![(page, first, last)];
            }
            Spelling::Extended => {
                for id in first..=last {
                    self.data(0x08, &long(id).to_le_bytes(), 4);
                }
            }
            Spelling::ExtendedRange => {
                self.data(0x18, &long(first).to_le_bytes(), 4);
                self.data(0x28, &long(last).to_le_bytes(), 4);
                return vec![(page, first, last)];
            }
            Spelling::Short => {
                self.item(0x08, first.into(), 2);
                return vec![(page, first, first)];
            }
            Spelling::Delimited => {
                for id in first..=last {
                    self.item(0xA8, 1, 1);
                    self.item(0x08, id.into(), 2);
                    self.item(0x08, 0x7F, 2);
                    self.item(0xA8, 0, 1);
                }
            }
        }
        singly()
    }
}

impl Meant {
    /// A range that fits the field.
    fn logical(&self) -> [i64; 2] {
        let most = (1_i64 << self.width) - 1;
        let least = if self.signed {
            -(1_i64 << (self.width - 1))
        } else {
            0
        };
        let place = |by: u32| least + i64::from(by) % (most + 1);
        let [a, b] = self.ends.map(place);
        let [low, high] = [a.min(b), a.max(b)];
        // What is written without a sign must not be a minimum that reads as below zero.
        if low > i64::from(i32::MAX) {
            [0, high]
        } else {
            [low, high]
        }
    }

    fn physical(&self) -> [i64; 2] {
        let [a, b] = self.physical.unwrap_or_default().map(i64::from);
        [a.min(b), a.max(b)]
    }
}

proptest! {
    #[test]
    fn what_was_meant_is_read(
        ops in prop::collection::vec(op(), 1..40),
        ids in prop::option::of(Just([1_u8, 7, 255])),
        wide in any::<bool>(),
    ) {
        let mut writer = Writer { ids, wide, ..Writer::default() };
        for op in &ops {
            writer.take(op);
        }
        while writer.open.pop().is_some() {
            writer.bytes.push(0xC0);
        }
        let read = Descriptor::parse(&writer.bytes).expect("legal");
        let rows: Vec<Row> = read.fields.iter().map(|f| {
            let usages = f.usages.iter().map(|range| (range.page, range.ids[0], range.ids[1])).collect();
            let around = read.around(f).map(|collection| (collection.usage.page, collection.usage.id)).collect();
            (
                f.direction, f.report, f.bit, f.width, f.count, usages, f.flags.0, f.logical, f.physical,
                (f.unit.code, f.unit.exponent), around,
            )
        }).collect();
        prop_assert_eq!(rows, writer.rows);
        let mut bits: Vec<_> = read.reports.clone();
        bits.sort_unstable();
        let want: Vec<_> = writer.bits.iter().map(|(&(direction, id), &bits)| (direction, id, bits)).collect();
        prop_assert_eq!(bits, want);
        let used = writer.bits.keys().any(|&(_, id)| id > 0);
        prop_assert_eq!(read.numbered, used);
    }
}
