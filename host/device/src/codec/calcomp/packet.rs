//! Six bytes taken apart: eighteen bits of y, sixteen of x, five for buttons and one for proximity.

use super::{PenSample, Tool};
use crate::codec::phased::BYTES_MAX;

/// What the five button bits carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// Buttons. With the highest bit, a puck of sixteen: the number of the one pressed, from 0. Without, one bit each.
    Buttons,
    /// Pressure, 0 to 31; from `tip` on the tip is down.
    Pressure {
        /// Where the tip begins.
        tip: u8,
    },
}

/// What the bits of a tablet mean where tablets differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meaning {
    /// What lies on it: [`Tool::Pen`] or [`Tool::Puck`].
    pub tool: Tool,
    /// The bit of the fourth byte that is set while the tool is out of range, 0x40 or 0x20; 0 where none tells.
    pub proximity_bit: u8,
    /// The five bits.
    pub code: Code,
    /// The tablet counts y from the lower edge.
    pub y_up: bool,
}

impl Meaning {
    /// The sample in a packet; `None` while the tool is out of range. `bottom` is the largest y, `held` what came
    /// before.
    pub(in crate::codec) fn sample(
        self,
        bytes: [u8; BYTES_MAX],
        bottom: u32,
        held: Option<PenSample>,
    ) -> Option<PenSample> {
        let [head, .., fourth, _, _, _, _, _] = bytes;
        if fourth & self.proximity_bit != 0 {
            return None;
        }
        let [x, y] = size(bytes);
        let y = if self.y_up { bottom.saturating_sub(y) } else { y };
        let place = PenSample::hovering(self.tool, x, y);
        let code = u32::from(head >> 2 & 0x1F);
        Some(match (self.code, self.tool) {
            (Code::Pressure { tip }, _) => {
                let down = held.is_some_and(|held| held.tip);
                let from = if down { tip.div_ceil(2) } else { tip };
                PenSample {
                    pressure_counts: code,
                    tip: code >= u32::from(from.max(1)),
                    ..place
                }
            }
            (Code::Buttons, Tool::Pen) => PenSample {
                tip: code & 1 == 1,
                buttons: code >> 1,
                ..place
            },
            (Code::Buttons, _) => PenSample {
                buttons: pressed(code),
                ..place
            },
        })
    }
}

/// Buttons of a puck, bit 0 for button 0.
fn pressed(code: u32) -> u32 {
    if code & 0x10 == 0 {
        code
    } else {
        1 << (code & 0x0F)
    }
}

/// The coordinates of a packet, as they came; those of the answer to `VS` are the largest there are.
pub(in crate::codec) fn size(bytes: [u8; BYTES_MAX]) -> [u32; 2] {
    let [b0, b1, b2, b3, b4, b5, ..] = bytes.map(u32::from);
    [(b0 & 3) << 14 | b1 << 7 | b2, (b3 & 0x0F) << 14 | b4 << 7 | b5]
}
