//! Korg nanoKONTROL2: eight sliders, eight knobs, 24 lit buttons in eight strips, eleven of transport.
//!
//! What each control says stands in a scene of 339 bytes in the box, which the host can read and replace; there too
//! stands whether lamps follow the buttons (internal, as the box comes) or the host (external). In native mode the scene
//! does not matter. Where its knobs stand cannot be asked.
//! Source: Korg's "nanoKONTROL2 MIDI Implementation", revision 1.00 of 2010-12-14.

mod scene;

use super::{Glow, Heard, MidiBox, MidiOptions, MidiShown, Moment, Panel};
use crate::script::Device;
use scene::{ButtonSetting, Kind, Scene};

/// Strips.
const STRIPS: u8 = 8;
/// Buttons: S, M and R of eight strips each, then transport.
const BUTTONS: u8 = 35;
/// Axes: sliders, then knobs.
const AXES: u8 = 16;
/// What every exclusive message of Korg's for this box begins with, but for the channel in its second byte.
const HEAD: [u8; 6] = [0x42, 0x40, 0x00, 0x01, 0x13, 0x00];
/// The channel of native mode.
const NATIVE_CHANNEL: u8 = 16;
/// Native mode's numbers of the transport buttons, in the order of the scene: track back and on, cycle, marker set,
/// back and on, rewind, forward, stop, play, record.
const TRANSPORT: [u8; 11] = [58, 59, 46, 60, 61, 62, 43, 44, 42, 41, 45];
/// Transport buttons with a lamp.
const LIT_TRANSPORT: [u8; 6] = [46, 43, 44, 42, 41, 45];
/// The version that the box tells; that of one from 2011, recollected.
const VERSION: [u8; 4] = [3, 0, 1, 0];

/// The box.
pub type NanoKontrol2 = MidiBox<NanoKontrol2Panel>;

impl NanoKontrol2 {
    /// One as it comes: its lamps follow its buttons.
    pub fn new(options: MidiOptions) -> Self {
        Self::with_panel(NanoKontrol2Panel::new(false), options)
    }

    /// One whose owner has given its lamps to the host, with Korg's editor.
    pub fn with_host_lamps(options: MidiOptions) -> Self {
        Self::with_panel(NanoKontrol2Panel::new(true), options)
    }
}

/// What is on the box.
#[derive(Clone, Debug)]
pub struct NanoKontrol2Panel {
    scene: Scene,
    /// The scene as it was last written into the box: what power brings back.
    kept: Scene,
    native: bool,
    /// Buttons that were toggled on.
    on: u64,
    shares: [f64; AXES as usize],
    told: [Option<u8>; AXES as usize],
}

impl NanoKontrol2Panel {
    fn new(host_lamps: bool) -> Self {
        let scene = Scene::factory(host_lamps);
        Self {
            kept: scene.clone(),
            scene,
            native: false,
            on: 0,
            shares: [0.0; AXES as usize],
            told: [None; AXES as usize],
        }
    }

    /// Channel, number and value that an axis says now.
    fn axis(&self, axis: usize) -> Option<(u8, u8, u8)> {
        let share = self.shares[axis];
        if self.native {
            let strip = (axis % usize::from(STRIPS)) as u8;
            let number = if axis < usize::from(STRIPS) {
                strip
            } else {
                16 + strip
            };
            return Some((NATIVE_CHANNEL, number, (share * 127.0).round() as u8));
        }
        let setting = self.scene.axis(axis)?;
        let [from, to] = [setting.min, setting.max].map(f64::from);
        let value = (from + share * (to - from)).round() as u8;
        Some((setting.channel, setting.number, value))
    }

    fn button(&self, control: u8) -> ButtonSetting {
        if !self.native {
            return self.scene.button(control);
        }
        let number = match control {
            0..8 => 32 + control,
            8..16 => 48 + control - 8,
            16..24 => 64 + control - 16,
            _ => TRANSPORT[usize::from(control - 24)],
        };
        ButtonSetting {
            kind: Kind::Control,
            toggles: false,
            channel: NATIVE_CHANNEL,
            number,
            off: 0,
            on: 127,
        }
    }

    /// Which button's lamp the host means by a message; only those with a lamp.
    fn lamp(&self, kind: Kind, channel: u8, number: u8) -> Option<u8> {
        let lit =
            |control: &u8| *control < 24 || LIT_TRANSPORT.contains(&TRANSPORT[usize::from(*control - 24)]);
        (0..BUTTONS).filter(lit).find(|&control| {
            let setting = self.button(control);
            setting.kind == kind && setting.channel == channel && setting.number == number
        })
    }

    /// Native mode goes by halves, the scene's by its own on value: the maker says only the former; the latter is ours.
    fn light(&self, control: u8, value: u8, at: &mut Moment<'_>) {
        if !self.native && !self.scene.host_lamps() {
            return;
        }
        let glow = if value > 64 { Glow::On } else { Glow::Off };
        at.show(MidiShown::Lamp { control, glow });
    }

    fn hear_sysex(&mut self, bytes: &[u8], at: &mut Moment<'_>) {
        let global = self.scene.global_channel();
        match bytes {
            // Who is there, to this channel or to all.
            [0x7E, channel, 0x06, 0x01] if *channel == global || *channel == 0x7F => {
                let mut answer = vec![0xF0, 0x7E, global, 0x06, 0x02, 0x42, 0x13, 0x01, 0, 0];
                answer.extend(VERSION);
                answer.push(0xF7);
                at.say(&answer);
            }
            // Korg's search, with a number to send back.
            [0x42, 0x50, 0x00, echo] => {
                let mut answer = vec![0xF0, 0x42, 0x50, 0x01, global, *echo, 0x13, 0x01, 0, 0];
                answer.extend(VERSION);
                answer.push(0xF7);
                at.say(&answer);
            }
            [maker, format, project @ .., _, _, _]
                if *maker == HEAD[0] && *format == HEAD[1] | global && project.starts_with(&HEAD[2..]) =>
            {
                self.hear_own(&bytes[HEAD.len()..], at);
            }
            _ => {}
        }
    }

    fn own(&self, at: &mut Moment<'_>, rest: &[u8]) {
        let mut message = vec![0xF0];
        message.extend(HEAD);
        message[2] |= self.scene.global_channel();
        message.extend(rest);
        message.push(0xF7);
        at.say(&message);
    }

    fn hear_own(&mut self, rest: &[u8], at: &mut Moment<'_>) {
        match rest {
            // Native mode out and in.
            [0x00, 0x00, mode @ 0..=1] => {
                self.native = *mode == 1;
                at.show(MidiShown::Mode(*mode));
                self.own(at, &[0x40, 0x00, 2 + mode]);
            }
            // The scene, please.
            [0x1F, 0x10, 0x00] => {
                let mut dump = vec![0x7F, 0x7F, 0x02, 0x03, 0x05, 0x40];
                dump.extend(self.scene.packed());
                self.own(at, &dump);
            }
            // Keep it.
            [0x1F, 0x11, 0x00] => {
                self.kept = self.scene.clone();
                self.own(at, &[0x5F, 0x21, 0x00]);
            }
            // Which mode.
            [0x1F, 0x12, 0x00] => self.own(at, &[0x5F, 0x42, u8::from(self.native)]),
            // A scene.
            [0x7F, 0x7F, 0x02, 0x03, 0x05, 0x40, packed @ ..] => {
                let taken = Scene::unpacked(packed);
                let answer = if taken.is_some() { 0x23 } else { 0x24 };
                self.own(at, &[0x5F, answer, 0x00]);
                if let Some(scene) = taken {
                    self.scene = scene;
                    self.on = 0;
                }
            }
            _ => {}
        }
    }
}

impl Panel for NanoKontrol2Panel {
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
            Heard::Control {
                channel,
                number,
                value,
            } => {
                if let Some(control) = self.lamp(Kind::Control, channel, number) {
                    self.light(control, value, at);
                }
            }
            Heard::Note {
                channel,
                key,
                velocity,
            } => {
                if let Some(control) = self.lamp(Kind::Note, channel, key) {
                    self.light(control, velocity, at);
                }
            }
            Heard::Program { .. } => {}
        }
    }

    fn press(&mut self, control: u8, down: bool, at: &mut Moment<'_>) -> bool {
        if control >= BUTTONS {
            return false;
        }
        let setting = self.button(control);
        let bit = 1_u64 << control;
        let lit = if !setting.toggles {
            down
        } else if down {
            self.on ^= bit;
            self.on & bit != 0
        } else {
            // A toggle says nothing when it is let go.
            return true;
        };
        let value = if lit { setting.on } else { setting.off };
        let channel = setting.channel - 1;
        match setting.kind {
            Kind::Nothing => {}
            Kind::Control => at.say(&[0xB0 | channel, setting.number, value]),
            Kind::Note if lit => at.say(&[0x90 | channel, setting.number, value]),
            // A note ends with velocity 64 (the maker's table).
            Kind::Note => at.say(&[0x80 | channel, setting.number, 64]),
        }
        if !self.native && !self.scene.host_lamps() {
            let glow = if lit { Glow::On } else { Glow::Off };
            at.show(MidiShown::Lamp { control, glow });
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
        if self.told[axis].is_none() {
            self.told[axis] = self.axis(axis).map(|(_, _, value)| value);
        }
        self.shares[axis] = share;
        true
    }

    fn next_move(&mut self) -> Option<Vec<u8>> {
        for axis in 0..usize::from(AXES) {
            let Some((channel, number, value)) = self.axis(axis) else {
                continue;
            };
            let told = self.told[axis];
            if told.is_some_and(|told| told != value) {
                self.told[axis] = Some(value);
                return Some(vec![0xB0 | (channel - 1), number, value]);
            }
        }
        None
    }

    fn has_moved(&self) -> bool {
        (0..usize::from(AXES)).any(|axis| {
            let value = self.axis(axis).map(|(_, _, value)| value);
            value.is_some() && self.told[axis].is_some() && self.told[axis] != value
        })
    }

    fn lose_power(&mut self) {
        self.scene = self.kept.clone();
        self.native = false;
        self.on = 0;
        for axis in 0..usize::from(AXES) {
            self.told[axis] = self.axis(axis).map(|(_, _, value)| value);
        }
    }
}
