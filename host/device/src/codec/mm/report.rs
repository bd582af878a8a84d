//! Reports and the configuration answer taken apart.

use crate::codec::Tool;
use crate::codec::lines::number;
use crate::codec::phased::BYTES_MAX;

/// Set while the tool is out of range.
const OUT_OF_RANGE: u8 = 0x40;
/// Set where a move is positive.
const X_POSITIVE: u8 = 0x10;
const Y_POSITIVE: u8 = 0x08;
/// A line's digit while the tool is out of range (Bit Pad Two).
const OUT_OF_RANGE_DIGIT: u32 = 9;

/// Where a tool is and what is pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Report {
    pub(super) in_range: bool,
    pub(super) x: u32,
    pub(super) y: u32,
    /// As it came: number or mask.
    pub(super) code: u32,
    pub(super) pressure: u32,
    /// Where the report tells it.
    pub(super) tool: Option<Tool>,
}

/// How far a tool has moved and what is pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Move {
    pub(super) in_range: bool,
    pub(super) dx: i32,
    pub(super) dy: i32,
    pub(super) code: u32,
}

/// Five bytes. The signs are always positive here and not looked at, as in xf86-input-summa.
pub(super) fn absolute(bytes: [u8; BYTES_MAX]) -> Report {
    let [head, x_low, x_high, y_low, y_high, ..] = bytes;
    Report {
        in_range: head & OUT_OF_RANGE == 0,
        x: u32::from(x_high) << 7 | u32::from(x_low),
        y: u32::from(y_high) << 7 | u32::from(y_low),
        code: u32::from(head & 7),
        pressure: 0,
        tool: None,
    }
}

/// Seven bytes: five as before, then nine bits of the third axis, the kind of tool and a fourth button.
pub(super) fn flair(bytes: [u8; BYTES_MAX]) -> Report {
    let [.., high, rest, _, _] = bytes;
    let five = absolute(bytes);
    Report {
        pressure: u32::from(high) << 2 | u32::from(rest & 1) << 1 | u32::from(rest >> 4 & 1),
        code: five.code | u32::from(rest & 2) << 2,
        tool: match rest >> 2 & 3 {
            0 | 2 => Some(Tool::Puck),
            1 => Some(Tool::Pen),
            _ => None,
        },
        ..five
    }
}

/// Three bytes.
pub(super) fn relative(bytes: [u8; BYTES_MAX]) -> Move {
    let [head, x, y, ..] = bytes;
    let signed = |bit: u8, size: u8| {
        let size = i32::from(size);
        if head & bit == 0 { -size } else { size }
    };
    Move {
        in_range: head & OUT_OF_RANGE == 0,
        dx: signed(X_POSITIVE, x),
        dy: signed(Y_POSITIVE, y),
        code: u32::from(head & 7),
    }
}

/// `1234,5678,1`, with or without spaces around the numbers.
pub(super) fn line(text: &[u8]) -> Option<Report> {
    let mut parts = text.split(|&byte| byte == b',').map(<[u8]>::trim_ascii);
    let mut next = || number(parts.next()?).and_then(|value| u32::try_from(value).ok());
    let (x, y, code) = (next()?, next()?, next()?);
    if parts.next().is_some() || code > OUT_OF_RANGE_DIGIT {
        return None;
    }
    Some(Report {
        in_range: code != OUT_OF_RANGE_DIGIT,
        x,
        y,
        code,
        pressure: 0,
        tool: None,
    })
}

/// Puts the answer to `a` together: as long as a report and laid out like one. Nobody says whether its first byte
/// has bit 7, so it need not; a byte that has is the first.
#[derive(Clone, Debug)]
pub(super) struct Configuration {
    bytes: [u8; 7],
    have: usize,
    want: usize,
}

impl Configuration {
    pub(super) fn new(want: usize) -> Self {
        Self {
            bytes: [0; 7],
            have: 0,
            want: want.min(7),
        }
    }

    pub(super) fn reset(&mut self) {
        self.have = 0;
    }

    /// Takes a byte; gives the largest x and y.
    pub(super) fn push(&mut self, byte: u8) -> Option<[u32; 2]> {
        if byte & 0x80 != 0 {
            self.have = 0;
        } else if self.have == 0 && matches!(byte, b'\r' | b'\n') {
            // The end of the answer before.
            return None;
        }
        *self.bytes.get_mut(self.have)? = byte;
        self.have += 1;
        if self.have < self.want {
            return None;
        }
        self.have = 0;
        let [_, x_low, x_high, y_low, y_high, ..] = self.bytes.map(u32::from);
        Some([x_high << 7 | x_low, y_high << 7 | y_low])
    }
}
