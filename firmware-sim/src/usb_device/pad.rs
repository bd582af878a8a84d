//! The hand over a USB tablet: pen, keys and ring, and what of it waits to be reported.

use super::Waiting;
use crate::hands::{Held, Pen, Touch};

/// One thing to report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Doing {
    /// The pen is in reach, so.
    Pen(Pen),
    /// It was lifted out of reach from there.
    Left(Pen),
    /// Keys that are down, bit 0 is key 0.
    Keys(u16),
    /// Where the finger is on the ring, in the device's steps from 0; none: lifted.
    Ring(Option<u8>),
}

/// What hands hold, and what of it the host has not been told.
#[derive(Clone, Debug)]
pub(crate) struct Pad {
    key_count: u8,
    ring_steps: u8,
    /// The pen in reach.
    pub(crate) pen: Option<Pen>,
    keys: u16,
    ring: Option<u8>,
    waiting: Waiting<Doing>,
}

impl Pad {
    /// A tablet with so many keys, and a ring of so many steps (0: none).
    pub(crate) fn new(key_count: u8, ring_steps: u8) -> Self {
        Self {
            key_count,
            ring_steps,
            pen: None,
            keys: 0,
            ring: None,
            waiting: Waiting::default(),
        }
    }

    /// Does what a hand does; false: the tablet has no such control.
    pub(crate) fn touch(&mut self, touch: &Touch) -> bool {
        match *touch {
            Touch::Pen(pen) => self.hold(Some(pen)),
            Touch::Away | Touch::Lift(Held::Pen) => self.hold(None),
            Touch::Button { control, down } if control < self.key_count => {
                let bit = 1 << control;
                let keys = if down { self.keys | bit } else { self.keys & !bit };
                if keys != self.keys {
                    self.keys = keys;
                    self.push(Doing::Keys(keys));
                }
            }
            Touch::Ring { control: 0, at } if self.ring_steps > 0 => {
                let last = self.ring_steps - 1;
                let step =
                    |share: f64| ((share.clamp(0.0, 1.0) * f64::from(self.ring_steps)) as u8).min(last);
                let at = at.map(step);
                if at != self.ring {
                    self.ring = at;
                    self.push(Doing::Ring(at));
                }
            }
            _ => return false,
        }
        true
    }

    fn hold(&mut self, pen: Option<Pen>) {
        let before = std::mem::replace(&mut self.pen, pen);
        // One pen becomes another, or turns round, only out of reach.
        let other = |old: &Pen| pen.is_none_or(|new| (new.eraser, new.serial) != (old.eraser, old.serial));
        if let Some(old) = before.filter(other) {
            self.push(Doing::Left(old));
        }
        if let Some(pen) = pen {
            self.push(Doing::Pen(pen));
        }
    }

    /// Places and pressures merge while they wait, and so do places on the ring; edges stay.
    fn push(&mut self, doing: Doing) {
        let edges = |pen: &Pen| (pen.tip, pen.buttons, pen.eraser, pen.serial);
        self.waiting.push(doing, |last, new| {
            let joins = match (&*last, new) {
                (Doing::Pen(a), Doing::Pen(b)) => edges(a) == edges(b),
                (Doing::Ring(Some(_)), Doing::Ring(Some(_))) => true,
                _ => false,
            };
            if joins {
                *last = *new;
            }
            joins
        });
    }

    /// What waited is forgotten; what is held is reported again.
    pub(crate) fn begin_anew(&mut self) {
        self.waiting.clear();
        if let Some(pen) = self.pen {
            self.push(Doing::Pen(pen));
        }
    }

    pub(crate) fn has_report(&self) -> bool {
        !self.waiting.is_empty()
    }

    pub(crate) fn take(&mut self) -> Option<Doing> {
        self.waiting.pop()
    }
}

/// Counts of a place from −1 to 1 on an axis of `max` counts that begins at −1.
pub(crate) fn counts(place: f64, max: u32) -> u32 {
    (f64::midpoint(place.clamp(-1.0, 1.0), 1.0) * f64::from(max)).round() as u32
}

/// Counts of the pen's place on a tablet of `max` counts whose corner 0, 0 is at the upper left.
pub(crate) fn place(pen: &Pen, max: [u32; 2]) -> [u32; 2] {
    [counts(pen.x, max[0]), counts(-pen.y, max[1])]
}

/// Counts of a pen's pressure, none without its point down.
pub(crate) fn pressure(pen: &Pen, max: u16) -> u16 {
    (pen.pressure.clamp(0.0, 1.0) * f64::from(max)).round() as u16
}

/// The place of counts, the other way round; for tests against recorded frames.
#[cfg(test)]
pub(crate) fn pen_at(counts: [u32; 2], max: [u32; 2]) -> Pen {
    let [x, y] = [0, 1].map(|axis| f64::from(counts[axis]) / f64::from(max[axis]) * 2.0 - 1.0);
    Pen {
        x,
        y: -y,
        ..Pen::default()
    }
}
