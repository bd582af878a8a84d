//! Behringer X-Touch Mini: eight endless dials that push, under rings of 13 lamps; sixteen lit buttons, two layer
//! buttons, a fader.
//!
//! Two worlds: in standard mode its dials have values of their own, 0 to 127, and draw their rings themselves; in MC
//! mode (Mackie control) they tell clicks and the host draws the rings.
//! Sources: the maker's RX and MIDI tables, a MIDI-OX log of one with factory settings, Mackie's V-Pot values as in
//! tttapa/Control-Surface. What only one of them has, or none, is marked where it stands.

mod ring;

use super::{Glow, Heard, MidiBox, MidiOptions, MidiShown, Moment, Panel};
use crate::script::Device;
use ring::{Style, v_pot_lamps, value_lamps};

/// Dials.
const DIALS: u8 = 8;
/// Buttons: eight pushes, sixteen of the rows, two layers.
const BUTTONS: u8 = 26;
/// The first of the row buttons, and of the layers.
const ROWS: u8 = 8;
const LAYERS: u8 = 24;
/// The factory's global channel, standard mode's.
const GLOBAL: u8 = 11;
/// MC mode's buttons by place: upper row, then lower (log; maker's table).
const MC_NOTES: [u8; 16] = [89, 90, 40, 41, 42, 43, 44, 45, 87, 88, 91, 92, 86, 93, 94, 95];
/// MC mode's layer buttons.
const MC_LAYERS: [u8; 2] = [84, 85];
/// A dial's largest step in one message: six bits and a sign.
const CLICKS_MAX: i32 = 63;

/// The box.
pub type XTouchMini = MidiBox<XTouchMiniPanel>;

impl XTouchMini {
    /// One that has just been plugged in, in standard mode, layer A.
    pub fn new(options: MidiOptions) -> Self {
        Self::with_panel(XTouchMiniPanel::default(), options)
    }

    /// One whose MC button was held while it was plugged in.
    pub fn in_mc_mode(options: MidiOptions) -> Self {
        let panel = XTouchMiniPanel {
            mc: true,
            comes_in_mc: true,
            ..XTouchMiniPanel::default()
        };
        Self::with_panel(panel, options)
    }
}

/// One of the two layers of standard mode.
#[derive(Clone, Copy, Debug, Default)]
struct Layer {
    values: [i32; DIALS as usize],
    told: [i32; DIALS as usize],
    styles: [Style; DIALS as usize],
    fader_told: Option<u8>,
}

/// What is on the box.
#[derive(Clone, Debug, Default)]
pub struct XTouchMiniPanel {
    mc: bool,
    /// The mode that power brings.
    comes_in_mc: bool,
    layer: usize,
    layers: [Layer; 2],
    /// MC mode: clicks not yet told.
    clicks: [i32; DIALS as usize],
    /// The dial after the one last told: they take turns on the line.
    next: usize,
    fader: f64,
    fader_told_mc: Option<u16>,
}

impl XTouchMiniPanel {
    fn draw(&self, dial: usize, at: &mut Moment<'_>) {
        let layer = &self.layers[self.layer];
        at.show(MidiShown::Ring {
            control: dial as u8,
            lamps: value_lamps(layer.values[dial], layer.styles[dial]),
            blinking: false,
        });
    }

    fn draw_all(&self, at: &mut Moment<'_>) {
        for dial in 0..usize::from(DIALS) {
            self.draw(dial, at);
        }
    }

    fn set_layer(&mut self, layer: usize, at: &mut Moment<'_>) {
        self.layer = layer;
        at.show(MidiShown::Layer(layer as u8));
        self.draw_all(at);
    }

    fn set_mode(&mut self, mc: bool, at: &mut Moment<'_>) {
        self.mc = mc;
        self.clicks = [0; DIALS as usize];
        // Where the fader stands is not told by itself.
        self.fader_told_mc = Some(self.fader_14());
        let told = self.fader_7();
        self.layers
            .iter_mut()
            .for_each(|layer| layer.fader_told = Some(told));
        at.show(MidiShown::Mode(u8::from(mc)));
    }

    fn fader_7(&self) -> u8 {
        (self.fader * 127.0).round() as u8
    }

    /// Pitch bend's fourteen bits; the fader itself has some ten of them (a log of its bigger sister steps by 64).
    fn fader_14(&self) -> u16 {
        let steps = (self.fader * 255.0).round() as u16;
        if steps == 255 { 16_383 } else { steps << 6 }
    }

    fn hear_standard(&mut self, number: u8, value: u8, at: &mut Moment<'_>) {
        match number {
            1..=8 => {
                let dial = usize::from(number - 1);
                if let Some(style) = Style::of(value) {
                    self.layers[self.layer].styles[dial] = style;
                    self.draw(dial, at);
                }
            }
            9..=16 => {
                if let Some((lamps, blinking)) = ring::remote_lamps(value) {
                    at.show(MidiShown::Ring {
                        control: number - 9,
                        lamps,
                        blinking,
                    });
                }
            }
            _ => {}
        }
    }

    fn hear_note(&self, channel: u8, key: u8, velocity: u8, at: &mut Moment<'_>) {
        let (place, glow) = if self.mc {
            let glow = match velocity {
                0 => Glow::Off,
                1 => Glow::Blinking,
                _ => Glow::On,
            };
            let place = MC_NOTES.iter().position(|&note| note == key);
            (place.filter(|_| channel == 1), Some(glow))
        } else {
            let glow = match velocity {
                0 => Some(Glow::Off),
                1 => Some(Glow::On),
                2 => Some(Glow::Blinking),
                _ => None,
            };
            let place = (key < 16).then_some(usize::from(key));
            (place.filter(|_| channel == GLOBAL), glow)
        };
        if let (Some(place), Some(glow)) = (place, glow) {
            at.show(MidiShown::Lamp {
                control: ROWS + place as u8,
                glow,
            });
        }
    }

    /// Layer A has notes 0 to 23. That layer B goes on with 24 is recollected; the log only says that they differ.
    fn press_standard(&mut self, control: u8, down: bool, at: &mut Moment<'_>) {
        if control >= LAYERS {
            if down {
                self.set_layer(usize::from(control - LAYERS), at);
            }
            return;
        }
        let note = control + 24 * self.layer as u8;
        let channel = GLOBAL - 1;
        let message = if down {
            [0x90 | channel, note, 127]
        } else {
            [0x80 | channel, note, 0]
        };
        at.say(&message);
    }

    fn press_mc(control: u8, down: bool, at: &mut Moment<'_>) {
        let note = match control {
            0..ROWS => 32 + control,
            ROWS..LAYERS => MC_NOTES[usize::from(control - ROWS)],
            _ => MC_LAYERS[usize::from(control - LAYERS)],
        };
        at.say(&[0x90, note, if down { 127 } else { 0 }]);
    }

    /// The next dial, going round, that has something to tell.
    fn next_dial(&self, tells: impl Fn(usize) -> bool) -> Option<usize> {
        let dials = usize::from(DIALS);
        (0..dials)
            .map(|step| (self.next + step) % dials)
            .find(|&dial| tells(dial))
    }

    fn next_standard(&mut self) -> Option<Vec<u8>> {
        let layer = self.layers[self.layer];
        let channel = GLOBAL - 1;
        if let Some(dial) = self.next_dial(|dial| layer.values[dial] != layer.told[dial]) {
            self.next = (dial + 1) % usize::from(DIALS);
            self.layers[self.layer].told[dial] = layer.values[dial];
            let first = [1, 11][self.layer];
            return Some(vec![0xB0 | channel, first + dial as u8, layer.values[dial] as u8]);
        }
        let value = self.fader_7();
        let told = self.layers[self.layer].fader_told.replace(value);
        (told.is_some_and(|told| told != value)).then(|| vec![0xB0 | channel, [9, 10][self.layer], value])
    }

    fn next_mc(&mut self) -> Option<Vec<u8>> {
        if let Some(dial) = self.next_dial(|dial| self.clicks[dial] != 0) {
            self.next = (dial + 1) % usize::from(DIALS);
            let step = self.clicks[dial].clamp(-CLICKS_MAX, CLICKS_MAX);
            self.clicks[dial] -= step;
            let sign = if step < 0 { 64 } else { 0 };
            return Some(vec![0xB0, 16 + dial as u8, sign + step.unsigned_abs() as u8]);
        }
        let value = self.fader_14();
        let told = self.fader_told_mc.replace(value);
        (told.is_some_and(|told| told != value)).then(|| vec![0xE8, (value & 0x7F) as u8, (value >> 7) as u8])
    }
}

impl Panel for XTouchMiniPanel {
    fn controls(&self) -> Device {
        Device::Controls {
            dials: DIALS,
            buttons: BUTTONS,
            axes: 1,
        }
    }

    fn hear(&mut self, heard: Heard<'_>, at: &mut Moment<'_>) {
        match heard {
            Heard::Control {
                channel: GLOBAL,
                number: 127,
                value: value @ 0..=1,
            } => self.set_mode(value == 1, at),
            Heard::Program {
                channel: GLOBAL,
                program: program @ 0..=1,
            } if !self.mc => self.set_layer(usize::from(program), at),
            Heard::Control {
                channel: GLOBAL,
                number,
                value,
            } if !self.mc => self.hear_standard(number, value, at),
            Heard::Control {
                channel: 1,
                number: number @ 48..=55,
                value,
            } if self.mc => at.show(MidiShown::Ring {
                control: number - 48,
                lamps: v_pot_lamps(value),
                blinking: false,
            }),
            Heard::Note {
                channel,
                key,
                velocity,
            } => self.hear_note(channel, key, velocity, at),
            Heard::Control { .. } | Heard::Program { .. } | Heard::Sysex(_) => {}
        }
    }

    fn press(&mut self, control: u8, down: bool, at: &mut Moment<'_>) -> bool {
        if control >= BUTTONS {
            return false;
        }
        if self.mc {
            Self::press_mc(control, down, at);
        } else {
            self.press_standard(control, down, at);
        }
        true
    }

    fn turn(&mut self, control: u8, clicks: i32) -> bool {
        if control >= DIALS {
            return false;
        }
        let dial = usize::from(control);
        if self.mc {
            self.clicks[dial] += clicks;
        } else {
            let value = &mut self.layers[self.layer].values[dial];
            *value = value.saturating_add(clicks).clamp(0, 127);
        }
        true
    }

    fn slide(&mut self, control: u8, share: f64) -> bool {
        if control > 0 {
            return false;
        }
        // The first look at the fader is no move.
        let (seven, fourteen) = (self.fader_7(), self.fader_14());
        self.fader_told_mc.get_or_insert(fourteen);
        for layer in &mut self.layers {
            layer.fader_told.get_or_insert(seven);
        }
        self.fader = share;
        true
    }

    fn next_move(&mut self) -> Option<Vec<u8>> {
        if self.mc {
            self.next_mc()
        } else {
            self.next_standard()
        }
    }

    fn has_moved(&self) -> bool {
        if self.mc {
            let fader = self.fader_told_mc.is_some_and(|told| told != self.fader_14());
            fader || self.clicks.iter().any(|&clicks| clicks != 0)
        } else {
            let layer = &self.layers[self.layer];
            let fader = layer.fader_told.is_some_and(|told| told != self.fader_7());
            fader || layer.values != layer.told
        }
    }

    fn lose_power(&mut self) {
        *self = Self {
            mc: self.comes_in_mc,
            comes_in_mc: self.comes_in_mc,
            fader: self.fader,
            ..Self::default()
        };
        let fourteen = self.fader_14();
        self.fader_told_mc = Some(fourteen);
        let seven = self.fader_7();
        self.layers
            .iter_mut()
            .for_each(|layer| layer.fader_told = Some(seven));
    }
}
