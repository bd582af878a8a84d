//! Protocol V packets: nine bytes, of which only the first has bit 7.
//!
//! Source: `docs/protocols/wacom-v.md` (xf86-input-wacom at df3c6139, `src/wcmSerial.c`).

use super::{Model, PuckKind};
use crate::hands::{Pen, Puck};

/// Bytes of a packet.
pub(super) const PACKET: usize = 9;
/// Pressure has ten bits.
pub(super) const PRESSURE_MAX: u16 = 1023;
/// A point that touches presses, however lightly; an eighth is ours. The format has no bit for the point.
const TOUCH_MIN: f64 = 0.125;
/// The tenths of its travel that a 4D mouse's wheel can be pushed, and what the format makes of a tenth.
const WHEEL_TENTHS: i32 = 10;
const COUNTS_PER_TENTH: i32 = 102;

/// The eraser end's id beside the pen's.
pub(super) const PEN_ID: u16 = 0x822;
pub(super) const ERASER_ID: u16 = 0x82A;

/// Who is lying there: what an introduction says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tool {
    pub(super) id: u16,
    pub(super) serial: u32,
}

/// A tool near the surface, as the antenna sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pointer {
    pub(super) tool: Tool,
    x_counts: u16,
    y_counts: u16,
    buttons: u8,
    wheel: i32,
    /// Of a pen: pressure in counts and tilt in steps.
    pen: Option<(u16, [i8; 2])>,
}

impl Pointer {
    pub(super) fn pen(pen: &Pen, model: &Model) -> Self {
        let [x_counts, y_counts] = counts(pen.x, pen.y, model);
        let press = if pen.tip {
            pen.pressure.clamp(TOUCH_MIN, 1.0)
        } else {
            pen.pressure.clamp(0.0, 1.0)
        };
        Self {
            tool: Tool {
                id: if pen.eraser { ERASER_ID } else { PEN_ID },
                serial: if pen.serial == 0 {
                    model.pen_serial
                } else {
                    pen.serial
                },
            },
            x_counts,
            y_counts,
            buttons: pen.buttons & 3,
            wheel: 0,
            pen: Some((
                (press * f64::from(PRESSURE_MAX)).round() as u16,
                // It counts the lean towards the user.
                [i16::from(pen.tilt_deg[0]), -i16::from(pen.tilt_deg[1])]
                    .map(|lean| lean.clamp(-64, 63) as i8),
            )),
        }
    }

    pub(super) fn puck(puck: &Puck, model: &Model) -> Self {
        let [x_counts, y_counts] = counts(puck.x, puck.y, model);
        Self {
            tool: Tool {
                id: model.puck.id(),
                serial: if puck.serial == 0 {
                    model.puck_serial
                } else {
                    puck.serial
                },
            },
            x_counts,
            y_counts,
            buttons: puck.buttons & model.puck.buttons_mask(),
            wheel: puck.wheel,
            pen: None,
        }
    }

    /// Whether both would report the same tool and buttons.
    pub(super) fn has_edges_of(&self, other: &Self) -> bool {
        (self.tool, self.buttons) == (other.tool, other.buttons)
    }

    /// Whether its wheel moves, which is told each time.
    pub(super) fn is_turning(&self) -> bool {
        self.wheel != 0
    }

    /// Takes the place of this report, keeping the wheel clicks it had; a wheel that springs back has none.
    pub(super) fn become_later(&mut self, later: Self) {
        let clicked = if later.tool.id == PuckKind::FourD.id() {
            0
        } else {
            self.wheel
        };
        *self = Self {
            wheel: clicked + later.wheel,
            ..later
        };
    }

    /// The packets that say all of this; the clicks of a 2D mouse's wheel take one packet each.
    pub(super) fn packets(&self, channel: u8, puck: PuckKind) -> Vec<[u8; PACKET]> {
        let Some((pressure, tilt)) = self.pen else {
            return self.puck_packets(channel, puck);
        };
        let mut packet = self.place(0xE0 | self.buttons << 1 | channel);
        packet[5] |= (pressure >> 7) as u8 & 7;
        packet[6] = (pressure & 0x7F) as u8;
        packet[7] = tilt[0] as u8 & 0x7F;
        packet[8] = tilt[1] as u8 & 0x7F;
        vec![packet]
    }

    fn puck_packets(&self, channel: u8, puck: PuckKind) -> Vec<[u8; PACKET]> {
        match puck {
            PuckKind::Lens => {
                let mut packet = self.place(0xF0 | channel);
                packet[8] = self.buttons;
                vec![packet]
            }
            PuckKind::Mouse => {
                let mut packet = self.place(0xF0 | channel);
                packet[8] = self.buttons << 2;
                let click = if self.wheel < 0 { 1 } else { 2 };
                let mut clicks = vec![packet; (self.wheel.unsigned_abs() as usize).max(1)];
                for packet in clicks.iter_mut().take(self.wheel.unsigned_abs() as usize) {
                    packet[8] |= click;
                }
                clicks
            }
            PuckKind::FourD => {
                let mut first = self.place(0xE8 | channel);
                let push = self.wheel.clamp(-WHEEL_TENTHS, WHEEL_TENTHS) * COUNTS_PER_TENTH;
                first[5] |= (push.unsigned_abs() >> 7) as u8 & 7;
                first[6] = (push.unsigned_abs() & 0x7F) as u8;
                // Buttons 1 to 3 in bits 0 to 2, 4 to 6 in bits 4 to 6; bit 3 is the wheel's sign.
                first[8] = self.buttons & 7 | (self.buttons & 0x38) << 1 | u8::from(push < 0) << 3;
                // The second packet is its turn about itself: 0, it looks away from the hand.
                vec![first, self.place(0xEA | channel)]
            }
        }
    }

    fn place(&self, header: u8) -> [u8; PACKET] {
        let (x, y) = (self.x_counts, self.y_counts);
        let mut packet = [0; PACKET];
        packet[0] = header;
        packet[1] = (x >> 9) as u8 & 0x7F;
        packet[2] = (x >> 2) as u8 & 0x7F;
        packet[3] = (x as u8 & 3) << 5 | (y >> 11) as u8 & 0x1F;
        packet[4] = (y >> 4) as u8 & 0x7F;
        packet[5] = (y as u8 & 0x0F) << 3;
        packet
    }
}

/// From −1…1, y up, to counts from the upper left corner.
fn counts(x: f64, y: f64, model: &Model) -> [u16; 2] {
    let axis = |at: f64, max: u16| (f64::midpoint(at.clamp(-1.0, 1.0), 1.0) * f64::from(max)).round() as u16;
    [axis(x, model.max[0]), axis(-y, model.max[1])]
}

/// Introduces a tool: twelve bits of id, thirty-two of serial number.
pub(super) fn enter(tool: Tool, channel: u8) -> [u8; PACKET] {
    let (id, serial) = (tool.id, tool.serial);
    [
        0xC0 | channel,
        (id >> 5) as u8 & 0x7F,
        (id as u8 & 0x1F) << 2 | (serial >> 30) as u8,
        (serial >> 23) as u8 & 0x7F,
        (serial >> 16) as u8 & 0x7F,
        (serial >> 9) as u8 & 0x7F,
        (serial >> 2) as u8 & 0x7F,
        (serial as u8 & 3) << 5,
        0,
    ]
}

/// A tool has gone out of reach.
pub(super) fn leave(channel: u8) -> [u8; PACKET] {
    let mut packet = [0; PACKET];
    packet[0] = 0x80 | channel;
    packet
}
