//! Protocol IV packets: a pointer's state to seven bytes, nine with tilt.
//!
//! Source: `docs/protocols/wacom-iv.md`. Only the first byte has bit 7. Pressure is spread: its high seven
//! bits in the last byte with the sign bit turned, the rest in bit 2 of bytes 3 and 0.

use super::Model;
use crate::hands::{Pen, Puck};

/// A tool near the surface, as the antenna sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pointer {
    pub(super) stylus: bool,
    near: bool,
    x: f64,
    y: f64,
    pressure: f64,
    buttons: u8,
    wheel: i32,
    tilt_deg: [i8; 2],
}

impl Pointer {
    /// Bit 0 is the point, bits 1 and 2 the side buttons; the eraser end sets `eraser_bit`.
    pub(super) fn pen(pen: &Pen, eraser_bit: u8) -> Self {
        let eraser = u8::from(pen.eraser) << eraser_bit;
        Self {
            stylus: true,
            near: true,
            x: pen.x,
            y: pen.y,
            pressure: pen.pressure,
            buttons: u8::from(pen.tip) | pen.buttons << 1 | eraser,
            wheel: 0,
            tilt_deg: pen.tilt_deg,
        }
    }

    /// A puck whose model lacks the wheel reports no clicks.
    pub(super) fn puck(puck: &Puck, has_wheel: bool) -> Self {
        Self {
            stylus: false,
            near: true,
            x: puck.x,
            y: puck.y,
            pressure: 0.0,
            buttons: puck.buttons,
            wheel: if has_wheel { puck.wheel } else { 0 },
            tilt_deg: [0; 2],
        }
    }

    /// The last report of a tool: out of reach, nothing pressed, where it was.
    pub(super) fn leaving(self) -> Self {
        Self {
            near: false,
            buttons: 0,
            pressure: 0.0,
            wheel: 0,
            tilt_deg: [0; 2],
            ..self
        }
    }

    /// Whether both would report the same tool, nearness and buttons.
    pub(super) fn has_edges_of(&self, other: &Self) -> bool {
        (self.stylus, self.near, self.buttons) == (other.stylus, other.near, other.buttons)
    }

    /// Takes the place of this report, keeping the wheel clicks it had.
    pub(super) fn become_later(&mut self, later: Self) {
        *self = Self {
            wheel: self.wheel + later.wheel,
            ..later
        };
    }

    /// Whether going from here to `next` is not worth a report: no edge, no wheel, no other pressure or
    /// tilt, and neither axis moved by more than `suppress_counts`.
    pub(super) fn is_near(&self, next: &Self, scale: &Scale, suppress_counts: u32) -> bool {
        let (from, to) = (scale.counts(self), scale.counts(next));
        self.has_edges_of(next)
            && next.wheel == 0
            && scale.pressure_counts(self) == scale.pressure_counts(next)
            && self.tilt_deg == next.tilt_deg
            && from[0].abs_diff(to[0]) <= suppress_counts
            && from[1].abs_diff(to[1]) <= suppress_counts
    }
}

/// From −1…1 and 0…1 to counts.
#[derive(Clone, Debug, Default)]
pub(super) struct Scale {
    max: [u32; 2],
    pressure_max: u16,
    /// `OC1`: y counts from the top edge.
    pub(super) upper_origin: bool,
    /// `ZF1`: pressure is reported.
    pub(super) pressure: bool,
}

impl Scale {
    pub(super) fn of(model: &Model) -> Self {
        Self {
            max: model.max,
            pressure_max: model.pressure_max,
            // A PenPartner (CT) is never told, and its driver reads it as it reads the others.
            upper_origin: model.text.starts_with("CT"),
            pressure: false,
        }
    }

    fn counts(&self, pointer: &Pointer) -> [u32; 2] {
        let axis =
            |at: f64, max: u32| (f64::midpoint(at.clamp(-1.0, 1.0), 1.0) * f64::from(max)).round() as u32;
        let up = if self.upper_origin { -pointer.y } else { pointer.y };
        [axis(pointer.x, self.max[0]), axis(up, self.max[1])]
    }

    fn pressure_counts(&self, pointer: &Pointer) -> u16 {
        let pressure = if self.pressure {
            pointer.pressure.clamp(0.0, 1.0)
        } else {
            0.0
        };
        (pressure * f64::from(self.pressure_max)).round() as u16
    }

    /// Pressure bits beyond the seven of the last byte.
    fn extra_bits(&self) -> u32 {
        match self.pressure_max {
            0..=127 => 0,
            128..=255 => 1,
            _ => 2,
        }
    }
}

/// Writes the packet and how many of its bytes count.
pub(super) fn packet(pointer: &Pointer, scale: &Scale, tilt: bool) -> ([u8; 9], usize) {
    let [x, y] = scale.counts(pointer);
    let buttons = pointer.buttons & 0x0F;
    let mut bytes = [0; 9];
    bytes[0] = 0x80
        | u8::from(pointer.near) << 6
        | u8::from(pointer.stylus) << 5
        | u8::from(buttons != 0) << 3
        | (x >> 14 & 3) as u8;
    bytes[1] = (x >> 7 & 0x7F) as u8;
    bytes[2] = (x & 0x7F) as u8;
    bytes[3] = buttons << 3 | (y >> 14 & 3) as u8;
    bytes[4] = (y >> 7 & 0x7F) as u8;
    bytes[5] = (y & 0x7F) as u8;
    if pointer.stylus {
        let extra = scale.extra_bits();
        let pressure = scale.pressure_counts(pointer);
        bytes[6] = (pressure >> extra) as u8 & 0x7F ^ 0x40;
        // With nine bits byte 3 has bit 1 and byte 0 bit 0; with eight byte 3 has bit 0.
        match extra {
            0 => {}
            1 => bytes[3] |= (pressure as u8 & 1) << 2,
            _ => {
                bytes[3] |= (pressure as u8 >> 1 & 1) << 2;
                bytes[0] |= (pressure as u8 & 1) << 2;
            }
        }
    } else {
        // Two bits of clicks and a sign; a faster wheel loses clicks.
        let clicks = pointer.wheel.clamp(-3, 3);
        bytes[6] = (clicks.unsigned_abs() as u8) << 4 | u8::from(clicks < 0) << 6;
    }
    let lean = |degrees: i16| degrees.clamp(-64, 63) as u8 & 0x7F;
    let [right, up] = pointer.tilt_deg.map(i16::from);
    bytes[7] = lean(right);
    // It counts the lean towards the user.
    bytes[8] = lean(-up);
    (bytes, if tilt { 9 } else { 7 })
}
