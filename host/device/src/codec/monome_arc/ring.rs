//! One ring: what it is to show, drawn over 64 lamps of sixteen levels, and what it has been sent.

use crate::codec::{Outgoing, RingStyle};

/// Lamps of a ring, the first at the top, clockwise.
pub(super) const LAMPS: usize = 64;
/// The brightest of the sixteen levels.
const LEVEL_MAX: f64 = 15.0;
/// Draws a whole ring: 64 levels in 32 bytes.
const MAP: u8 = 0x92;

/// A ring and its shadow.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    number: u8,
    wanted: [u8; LAMPS],
    /// What the device has; `None` before anything was sent.
    shown: Option<[u8; LAMPS]>,
}

impl Ring {
    pub(super) fn new(number: u8) -> Self {
        Self {
            number,
            wanted: [0; LAMPS],
            shown: None,
        }
    }

    /// The device has forgotten what it showed.
    pub(super) fn forget(&mut self) {
        self.shown = None;
    }

    pub(super) fn want(&mut self, value: Option<f64>, style: RingStyle) {
        self.wanted = draw(value, style);
    }

    /// Sends the ring, if it is not what the device shows.
    pub(super) fn send(&mut self, out: &mut Outgoing) {
        if self.shown == Some(self.wanted) {
            return;
        }
        self.shown = Some(self.wanted);
        let mut message = [0; 2 + LAMPS / 2];
        let (head, pairs) = message.split_at_mut(2);
        head.copy_from_slice(&[MAP, self.number]);
        for (byte, pair) in pairs.iter_mut().zip(self.wanted.chunks_exact(2)) {
            // libmonome puts the lamp of even number into the high half; monome's text leaves it open.
            if let [even, odd] = pair {
                *byte = even << 4 | odd;
            }
        }
        out.bytes(&message);
    }
}

/// Levels of all lamps. Ends between two lamps light the second one partly.
pub(super) fn draw(value: Option<f64>, style: RingStyle) -> [u8; LAMPS] {
    let mut levels = [0; LAMPS];
    let Some(value) = value.filter(|value| value.is_finite()) else {
        return levels;
    };
    let value = value.clamp(0.0, 1.0);
    let lamps = LAMPS as f64;
    if style == RingStyle::Dot {
        let lamp = (value * (lamps - 1.0)).round() as usize;
        if let Some(level) = levels.get_mut(lamp) {
            *level = LEVEL_MAX as u8;
        }
        return levels;
    }
    let end = value * lamps;
    let half = lamps / 2.0;
    let [from, to] = match style {
        RingStyle::Dot | RingStyle::Fan => [0.0, end],
        RingStyle::Pan => [end.min(half), end.max(half)],
        RingStyle::Spread => [half - end / 2.0, half + end / 2.0],
    };
    for (index, level) in levels.iter_mut().enumerate() {
        let lamp = index as f64;
        let lit = (to.min(lamp + 1.0) - from.max(lamp)).max(0.0);
        *level = (lit * LEVEL_MAX).round() as u8;
    }
    levels
}
