//! Novation Launch Control XL: 24 knobs with lamps of two colours, eight faders, 24 buttons.
//!
//! Sixteen templates, eight of the user and eight of the factory; factory template n speaks on channel 8 + n, and what
//! they say is otherwise the same. Lamps are set by the number of a place, for a template, and seen when it is chosen.
//! Sources: Novation's programmer's reference for the Launch Control series, as far as the project's own notes have it.

use super::{Heard, MidiBox, MidiOptions, MidiShown, Moment, Panel};
use crate::script::Device;

/// Axes: three rows of eight knobs, then eight faders.
const AXES: u8 = 32;
/// Buttons: focus, control, device mute solo arm, up down left right.
const BUTTONS: u8 = 24;
/// Lamps: knobs, buttons, side buttons, arrows.
const LAMPS: usize = 48;
/// The first of the factory's templates.
const FACTORY: u8 = 8;
/// Controls of the rows, first of each.
const ROWS: [u8; 4] = [13, 29, 49, 77];
/// Notes of the focus and control rows and of the four at the side.
const NOTES: [u8; 20] = [
    41, 42, 43, 44, 57, 58, 59, 60, 73, 74, 75, 76, 89, 90, 91, 92, 105, 106, 107, 108,
];
/// Controls of the arrows.
const ARROWS: [u8; 4] = [104, 105, 106, 107];
/// What its exclusive messages begin with.
const HEAD: [u8; 5] = [0x00, 0x20, 0x29, 0x02, 0x11];

/// The box.
pub type LaunchControlXl = MidiBox<LaunchControlXlPanel>;

impl LaunchControlXl {
    /// One that has just been plugged in, at its first factory template.
    pub fn new(options: MidiOptions) -> Self {
        Self::with_panel(LaunchControlXlPanel::default(), options)
    }
}

/// What is on the box.
#[derive(Clone, Debug)]
pub struct LaunchControlXlPanel {
    template: u8,
    /// By template and lamp: the byte the host sent.
    lamps: [[u8; LAMPS]; 16],
    shares: [f64; AXES as usize],
    told: [Option<u8>; AXES as usize],
}

impl Default for LaunchControlXlPanel {
    fn default() -> Self {
        Self {
            template: FACTORY,
            lamps: [[0; LAMPS]; 16],
            shares: [0.0; AXES as usize],
            told: [None; AXES as usize],
        }
    }
}

impl LaunchControlXlPanel {
    fn value(&self, axis: usize) -> u8 {
        (self.shares[axis] * 127.0).round() as u8
    }

    fn light(&self, index: usize, at: &mut Moment<'_>) {
        let value = self.lamps[usize::from(self.template)][index];
        // Bits 0-1 red, 4-5 green; bits 2 and 3 both set: as usual, bit 3 alone: flashing.
        at.show(MidiShown::Colour {
            index: index as u8,
            red: value & 3,
            green: value >> 4 & 3,
            blinking: value & 0x0C == 0x08,
        });
    }

    fn set_lamp(&mut self, template: u8, index: u8, value: u8, at: &mut Moment<'_>) {
        let (template, index) = (usize::from(template), usize::from(index));
        if template < self.lamps.len() && index < LAMPS {
            self.lamps[template][index] = value;
            if template == usize::from(self.template) {
                self.light(index, at);
            }
        }
    }

    fn choose(&mut self, template: u8, at: &mut Moment<'_>) {
        self.template = template;
        at.show(MidiShown::Layer(template));
        for index in 0..LAMPS {
            self.light(index, at);
        }
    }

    fn hear_sysex(&mut self, bytes: &[u8], at: &mut Moment<'_>) {
        let Some(rest) = bytes.strip_prefix(&HEAD) else {
            return;
        };
        match rest {
            [0x78, template, lamps @ ..] => {
                for pair in lamps.chunks_exact(2) {
                    self.set_lamp(*template, pair[0], pair[1], at);
                }
            }
            [0x77, template @ 0..=15] => self.choose(*template, at),
            _ => {}
        }
    }
}

impl Panel for LaunchControlXlPanel {
    fn controls(&self) -> Device {
        Device::Controls {
            dials: 0,
            buttons: BUTTONS,
            axes: AXES,
        }
    }

    fn hear(&mut self, heard: Heard<'_>, at: &mut Moment<'_>) {
        match heard {
            Heard::Sysex(bytes) => self.hear_sysex(bytes, at),
            // Reset of a template: all lamps dark.
            Heard::Control {
                channel,
                number: 0,
                value: 0,
            } => {
                let template = usize::from(channel - 1);
                self.lamps[template] = [0; LAMPS];
                if channel - 1 == self.template {
                    for index in 0..LAMPS {
                        self.light(index, at);
                    }
                }
            }
            Heard::Control { .. } | Heard::Note { .. } | Heard::Program { .. } => {}
        }
    }

    fn press(&mut self, control: u8, down: bool, at: &mut Moment<'_>) -> bool {
        let value = if down { 127 } else { 0 };
        let place = usize::from(control);
        if let Some(&note) = NOTES.get(place) {
            let status = if down { 0x90 } else { 0x80 };
            at.say(&[status | self.template, note, value]);
        } else if let Some(&number) = ARROWS.get(place - NOTES.len()) {
            at.say(&[0xB0 | self.template, number, value]);
        } else {
            return false;
        }
        true
    }

    fn turn(&mut self, _control: u8, _clicks: i32) -> bool {
        false
    }

    fn slide(&mut self, control: u8, share: f64) -> bool {
        let axis = usize::from(control);
        if axis >= usize::from(AXES) {
            return false;
        }
        // The first look at it is no move.
        let stands = self.value(axis);
        self.told[axis].get_or_insert(stands);
        self.shares[axis] = share;
        true
    }

    fn next_move(&mut self) -> Option<Vec<u8>> {
        let moved = |axis: &usize| self.told[*axis].is_some_and(|told| told != self.value(*axis));
        let axis = (0..usize::from(AXES)).find(moved)?;
        let value = self.value(axis);
        self.told[axis] = Some(value);
        let number = ROWS[axis / 8] + (axis % 8) as u8;
        Some(vec![0xB0 | self.template, number, value])
    }

    fn has_moved(&self) -> bool {
        (0..usize::from(AXES)).any(|axis| self.told[axis].is_some_and(|told| told != self.value(axis)))
    }

    fn lose_power(&mut self) {
        let shares = self.shares;
        *self = Self {
            shares,
            told: self.told,
            ..Self::default()
        };
        for axis in 0..usize::from(AXES) {
            self.told[axis] = Some(self.value(axis));
        }
    }
}
