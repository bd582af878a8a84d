//! What an MM tablet says of a tool: packets of five or three bytes, or a line of text.
//!
//! Source: `docs/protocols/mm.md` (xf86-input-summa, `src/xf86Summa.c`).

use super::Form;
use crate::hands::{Pen, Puck};

/// Coordinates have fourteen bits.
pub(super) const COUNTS_MAX: u16 = 0x3FFF;
/// A relative packet has seven bits for each axis.
const STEP_MAX: i32 = 127;

const PHASE: u8 = 0x80;
const AWAY: u8 = 0x40;
const TABLET_ID: u8 = 0x20;
const X_POSITIVE: u8 = 0x10;
const Y_POSITIVE: u8 = 0x08;

/// A tool near the surface, as the antenna sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pointer {
    x: f64,
    y: f64,
    /// The three bits F, a code that pressing two buttons garbles.
    pub(super) code: u8,
    pub(super) near: bool,
}

impl Pointer {
    /// The point is 1, the side buttons 2 and 4.
    pub(super) fn pen(pen: &Pen) -> Self {
        Self {
            x: pen.x,
            y: pen.y,
            code: u8::from(pen.tip) | (pen.buttons & 3) << 1,
            near: true,
        }
    }

    /// Buttons 1 to 4 are codes 1 to 4; what is pressed together is ORed, so that 1 and 2 look like 3.
    pub(super) fn puck(puck: &Puck) -> Self {
        let pressed = (1..=4u8).filter(|button| puck.buttons >> (button - 1) & 1 == 1);
        Self {
            x: puck.x,
            y: puck.y,
            code: pressed.fold(0, |code, button| code | button),
            near: true,
        }
    }

    /// The last report of a tool: out of reach, nothing pressed, where it was.
    pub(super) fn leaving(self) -> Self {
        Self {
            code: 0,
            near: false,
            ..self
        }
    }

    /// Whether both would report the same nearness and buttons.
    pub(super) fn has_edges_of(&self, other: &Self) -> bool {
        (self.near, self.code) == (other.near, other.code)
    }
}

/// From −1…1 to counts, and how to write them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Manner {
    pub(super) inches: [f64; 2],
    pub(super) counts_per_inch: u16,
    pub(super) upper_origin: bool,
    pub(super) absolute: bool,
    pub(super) tablet_id: bool,
    pub(super) form: Form,
}

impl Manner {
    /// Largest x and y.
    pub(super) fn max(&self) -> [u16; 2] {
        let per_inch = f64::from(self.counts_per_inch);
        self.inches
            .map(|inches| (inches * per_inch).round().min(f64::from(COUNTS_MAX)) as u16)
    }

    pub(super) fn counts(&self, pointer: &Pointer) -> [u16; 2] {
        let axis =
            |at: f64, max: u16| (f64::midpoint(at.clamp(-1.0, 1.0), 1.0) * f64::from(max)).round() as u16;
        let up = if self.upper_origin { -pointer.y } else { pointer.y };
        let max = self.max();
        [axis(pointer.x, max[0]), axis(up, max[1])]
    }

    /// Writes one report; `told` is the place of the one before, which only relative packets look at.
    pub(super) fn report(&self, pointer: &Pointer, told: [u16; 2], out: &mut Vec<u8>) {
        let at = self.counts(pointer);
        match self.form {
            Form::Binary if self.absolute => self.absolute_packet(pointer, at, out),
            Form::Binary => self.relative_packets(pointer, at, told, out),
            Form::Mm1103 => {
                out.extend(format!("{:04},{:04},{:1}\n", at[0], at[1], pointer.code).bytes());
            }
            Form::BitPadTwo => {
                let flag = if pointer.near { pointer.code } else { 9 };
                out.extend(format!("{:04},{:04},{flag}\r\n", at[0], at[1]).bytes());
            }
        }
    }

    fn header(&self, pointer: &Pointer) -> u8 {
        let away = if pointer.near { 0 } else { AWAY };
        let id = if self.tablet_id { TABLET_ID } else { 0 };
        PHASE | away | id | pointer.code & 7
    }

    fn absolute_packet(&self, pointer: &Pointer, at: [u16; 2], out: &mut Vec<u8>) {
        out.push(self.header(pointer) | X_POSITIVE | Y_POSITIVE);
        for counts in at {
            out.extend([(counts & 0x7F) as u8, (counts >> 7) as u8 & 0x7F]);
        }
    }

    /// A long way takes several packets.
    fn relative_packets(&self, pointer: &Pointer, at: [u16; 2], told: [u16; 2], out: &mut Vec<u8>) {
        let mut left = [0, 1].map(|axis| i32::from(at[axis]) - i32::from(told[axis]));
        loop {
            let step = left.map(|way| way.clamp(-STEP_MAX, STEP_MAX));
            let sign = |way: i32, bit: u8| if way < 0 { 0 } else { bit };
            out.push(self.header(pointer) | sign(step[0], X_POSITIVE) | sign(step[1], Y_POSITIVE));
            out.extend(step.map(|way| way.unsigned_abs() as u8));
            left = [left[0] - step[0], left[1] - step[1]];
            if left == [0, 0] {
                return;
            }
        }
    }

    /// The answer to `a`: a packet whose place is the far corner.
    pub(super) fn configuration(&self, out: &mut Vec<u8>) {
        let corner = Pointer {
            x: 0.0,
            y: 0.0,
            code: 0,
            near: true,
        };
        self.absolute_packet(&corner, self.max(), out);
    }
}
