//! Lamps: what they are to show, and what the board has been told.

use super::Lamp;
use super::board::{Board, sevens};
use super::message::{EXTENDED_ANALOG, SYSEX, SYSEX_END};
use crate::codec::{Feedback, Outgoing};

/// Lamps and their shadow.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    lamps: Vec<Lamp>,
    /// Whether the board can dim it, by lamp.
    dims: Vec<bool>,
    wanted: Vec<u8>,
    sent: Vec<Option<u8>>,
}

impl Shown {
    pub(super) fn new(lamps: &[Lamp]) -> Self {
        Self {
            lamps: lamps.to_vec(),
            dims: lamps.iter().map(|lamp| lamp.dimmed).collect(),
            wanted: vec![0; lamps.len()],
            sent: vec![None; lamps.len()],
        }
    }

    pub(super) fn want(&mut self, feedback: &Feedback) {
        match feedback {
            Feedback::Lamps(lit) => {
                for (lamp, level) in self.wanted.iter_mut().enumerate() {
                    let on = u32::try_from(lamp).ok().and_then(|lamp| lit.checked_shr(lamp));
                    *level = if on.is_some_and(|on| on & 1 == 1) { 255 } else { 0 };
                }
            }
            Feedback::Lamp { control, level, .. } => {
                if let Some(wanted) = self.wanted.get_mut(usize::from(*control)) {
                    *wanted = *level;
                }
            }
            _ => {}
        }
    }

    /// The board has forgotten everything.
    pub(super) fn send_everything(&mut self, board: &Board, out: &mut Outgoing) {
        for (lamp, dims) in self.lamps.iter().zip(&mut self.dims) {
            *dims = board.set_up_lamp(lamp.pin, lamp.dimmed, out);
        }
        self.sent.fill(None);
        self.send_changes(out);
    }

    pub(super) fn send_changes(&mut self, out: &mut Outgoing) {
        let lamps = self.lamps.iter().zip(&self.dims).zip(&self.wanted);
        for (((lamp, dims), &level), sent) in lamps.zip(&mut self.sent) {
            if sent.replace(level) == Some(level) {
                continue;
            }
            let pin = lamp.pin & 0x7F;
            let [low, high] = sevens(level.into());
            if !dims {
                out.bytes(&[0xF5, pin, u8::from(level > 0)]);
            } else if pin < 16 {
                out.bytes(&[0xE0 | pin, low, high]);
            } else {
                out.bytes(&[SYSEX, EXTENDED_ANALOG, pin, low, high, SYSEX_END]);
            }
        }
    }
}
