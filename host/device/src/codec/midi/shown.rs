//! What a controller shows, and what it should: lamps, rings and displays, each as the messages that set it. Only what
//! differs is sent.
//!
//! Source: `docs/protocols/midi.md` (Control-Surface `VPotRing.hpp`; the manuals of Behringer, Korg, Novation).

use super::template::Template;
use crate::codec::{Feedback, Outgoing, RingStyle};
use device_profiles::{InputProfile, MidiAddress, Output, OutputKind, RingCoding};

/// The X-Touch Mini chooses a ring's way of lighting by the controller this far below its value's.
const STYLE_BELOW: u8 = 8;
/// Novation: flags of a lamp that is written to both buffers, so that it stays (12 "normal").
const STEADY: u8 = 12;

/// One message that sets something, as it should be and as it was sent last.
#[derive(Clone, Debug, Default)]
struct Message {
    wanted: Vec<u8>,
    sent: Vec<u8>,
}

impl Message {
    /// Whether it was sent.
    fn send(&mut self, out: &mut Outgoing) -> bool {
        let differs = !self.wanted.is_empty() && self.wanted != self.sent;
        if differs {
            out.bytes(&self.wanted);
            self.sent.clear();
            self.sent.extend_from_slice(&self.wanted);
        }
        differs
    }
}

/// Where an output's message goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Address {
    Change {
        channel: u8,
        number: u8,
    },
    Note {
        channel: u8,
        number: u8,
    },
    /// Only by system exclusive.
    None,
}

impl Address {
    fn of(midi: Option<&MidiAddress>, n: u16) -> Self {
        let Some(midi) = midi else { return Self::None };
        let channel = midi.channel_of(n).saturating_sub(1);
        match (midi.cc_of(n), midi.note_of(n)) {
            (Some(number), _) => Self::Change { channel, number },
            (None, Some(number)) => Self::Note { channel, number },
            (None, None) => Self::None,
        }
    }

    fn write(self, value: u8, out: &mut Vec<u8>) {
        out.clear();
        match self {
            Self::Change { channel, number } => out.extend([0xB0 | channel, number, value & 0x7F]),
            Self::Note { channel, number } => out.extend([0x90 | channel, number, value & 0x7F]),
            Self::None => {}
        }
    }
}

/// One lamp, ring or display.
#[derive(Debug)]
struct Shown {
    address: Address,
    /// Number that `{n}` of the template stands for.
    number: u8,
    template: Option<Template>,
    /// Dark, lit and blinking, where they are not 0 and 127.
    values: Vec<u8>,
    levels: u32,
    /// Steps of red and green of two-coloured lamps.
    colours: Option<[u16; 2]>,
    coding: RingCoding,
    characters: usize,
    /// What it shows; of some rings also the way of lighting, which goes first.
    messages: [Message; 2],
}

/// Everything a controller can show, but for motors.
#[derive(Debug)]
pub(super) struct Shadow {
    lamps: Vec<Shown>,
    rings: Vec<Shown>,
    labels: Vec<Shown>,
    levels: Vec<Shown>,
}

impl Shadow {
    /// All of a profile, everything dark and blank.
    pub(super) fn new(profile: &InputProfile) -> Self {
        let of = |kind| -> Vec<Shown> {
            let groups = profile.outputs.iter().filter(|output| output.kind == kind);
            groups
                .flat_map(|output| (0..output.count).map(move |n| Shown::new(output, n)))
                .collect()
        };
        let mut shadow = Self {
            lamps: of(OutputKind::Lamp),
            rings: of(OutputKind::Ring),
            labels: of(OutputKind::Label),
            levels: of(OutputKind::Level),
        };
        shadow.lamps.iter_mut().for_each(|lamp| lamp.light(0, None));
        shadow
            .rings
            .iter_mut()
            .for_each(|ring| ring.turn(None, RingStyle::Dot));
        shadow.labels.iter_mut().for_each(|label| label.write(""));
        // Meters are down by themselves.
        let others = shadow
            .levels
            .iter_mut()
            .filter(|it| it.coding != RingCoding::Meter);
        others.for_each(|level| level.rise(0));
        shadow
    }

    /// Notes what is wanted; what the device does not have is left out.
    pub(super) fn want(&mut self, feedback: &Feedback) {
        match feedback {
            Feedback::Lamps(mask) => {
                for (n, lamp) in (0..64).zip(&mut self.lamps) {
                    lamp.light(if mask >> n & 1 == 1 { 255 } else { 0 }, None);
                }
            }
            Feedback::Lamp {
                control,
                level,
                colour,
            } => {
                if let Some(lamp) = self.lamps.get_mut(usize::from(*control)) {
                    lamp.light(*level, *colour);
                }
            }
            Feedback::Level { control, level } => {
                if let Some(shown) = self.levels.get_mut(usize::from(*control)) {
                    shown.rise(*level);
                }
            }
            Feedback::Ring {
                control,
                value,
                style,
            } => {
                if let Some(ring) = self.rings.get_mut(usize::from(*control)) {
                    ring.turn(*value, *style);
                }
            }
            Feedback::Label { control, text } => {
                if let Some(label) = self.labels.get_mut(usize::from(*control)) {
                    label.write(text);
                }
            }
            Feedback::Picture { .. } | Feedback::Motor { .. } | Feedback::Haptic { .. } => {}
        }
    }

    /// A device that is new shows nothing we know of.
    pub(super) fn forget(&mut self) {
        for shown in self.all() {
            shown.messages.iter_mut().for_each(|message| message.sent.clear());
        }
    }

    /// Sends what differs.
    pub(super) fn send(&mut self, out: &mut Outgoing) {
        for shown in self.all() {
            let [before, message] = &mut shown.messages;
            if before.send(out) {
                // Another way of lighting leaves the ring as it was lit before, or dark.
                message.sent.clear();
            }
            message.send(out);
        }
    }

    /// Meters fall by themselves: those that are up are said again.
    pub(super) fn say_meters_again(&mut self, out: &mut Outgoing) {
        for meter in self.levels.iter_mut().filter(|it| it.coding == RingCoding::Meter) {
            let message = &mut meter.messages[1];
            if message.wanted.last().is_some_and(|value| value & 0x0F > 0) {
                message.sent.clear();
                message.send(out);
            }
        }
    }

    fn all(&mut self) -> impl Iterator<Item = &mut Shown> {
        let lamps_and_rings = self.lamps.iter_mut().chain(&mut self.rings);
        lamps_and_rings.chain(&mut self.labels).chain(&mut self.levels)
    }
}

impl Shown {
    fn new(output: &Output, n: u16) -> Self {
        let colours = output.colours.map(|[red, green, _]| [red, green]);
        Self {
            address: Address::of(output.midi.as_ref(), n),
            number: u16::from(output.first).saturating_add(n).min(127) as u8,
            template: output.sysex.as_deref().and_then(Template::parse),
            values: output.values.clone(),
            levels: output.levels.unwrap_or(2).max(2),
            colours,
            coding: output.style.unwrap_or(RingCoding::Plain),
            characters: output.characters.unwrap_or(0).into(),
            messages: Default::default(),
        }
    }

    /// `level` 0 is dark, 255 as bright as it goes.
    fn light(&mut self, level: u8, colour: Option<[u8; 3]>) {
        let value = match self.colours {
            Some(steps) => two_colours(level, colour, steps),
            None => self.brightness(level),
        };
        self.put(value, &[]);
    }

    fn brightness(&self, level: u8) -> u8 {
        if level == 0 {
            return self.values.first().copied().unwrap_or(0);
        }
        if let Some(&lit) = self.values.get(1) {
            return lit;
        }
        let top = self.levels - 1;
        // Something that is not dark is seen, however few the steps.
        let step = (u32::from(level) * top).div_ceil(255).clamp(1, top);
        (step * 127 / top) as u8
    }

    fn turn(&mut self, value: Option<f64>, style: RingStyle) {
        let share = value.map(|share| {
            if share.is_nan() {
                0.0
            } else {
                share.clamp(0.0, 1.0)
            }
        });
        let place = |steps: f64| share.map(|share| 1 + (share * (steps - 1.0)).round() as u8);
        match self.coding {
            RingCoding::VPot => {
                // Lit from 6 − p to 5 + p, a spread is full at 6.
                let spread = style == RingStyle::Spread;
                let at = place(if spread { 6.0 } else { 11.0 });
                self.put(at.map_or(0, |at| v_pot_mode(style) << 4 | at), &[]);
            }
            RingCoding::Thirteen => {
                let address = self.address;
                if let Address::Change { channel, number } = address {
                    let number = number.saturating_sub(STYLE_BELOW);
                    let way = Address::Change { channel, number };
                    way.write(mini_mode(style), &mut self.messages[0].wanted);
                }
                address.write(place(13.0).unwrap_or(0), &mut self.messages[1].wanted);
            }
            RingCoding::Plain | RingCoding::Meter => {
                self.put(share.map_or(0, |share| (share * 127.0).round() as u8), &[]);
            }
        }
    }

    /// `level` 0 to 255 of a meter or a brightness.
    fn rise(&mut self, level: u8) {
        if self.coding == RingCoding::Meter {
            // Channel pressure: the strip above, below it 0 to 12.
            let step = (u16::from(level) * 12).div_ceil(255) as u8;
            let message = &mut self.messages[1].wanted;
            message.clear();
            message.extend([0xD0, (self.number & 7) << 4 | step]);
            return;
        }
        let steps = self.levels - 1;
        self.put(((u32::from(level) * steps + 127) / 255 * 127 / steps) as u8, &[]);
    }

    /// Exactly as many characters as there are; what is not printable ASCII becomes a question mark.
    fn write(&mut self, text: &str) {
        let printable = |c: char| {
            if c.is_ascii_graphic() || c == ' ' {
                c as u8
            } else {
                b'?'
            }
        };
        let filled = text.chars().map(printable).chain(std::iter::repeat(b' '));
        let characters: Vec<u8> = filled.take(self.characters).collect();
        self.put(0, &characters);
    }

    fn put(&mut self, value: u8, text: &[u8]) {
        let message = &mut self.messages[1].wanted;
        match &self.template {
            Some(template) => {
                message.clear();
                template.fill(self.number, value, text, message);
            }
            None => self.address.write(value, message),
        }
    }
}

/// Novation's value: red in bits 0 and 1, green in bits 4 and 5. Without a colour both glow alike, which is amber.
fn two_colours(level: u8, colour: Option<[u8; 3]>, steps: [u16; 2]) -> u8 {
    let [red, green, _] = colour.unwrap_or([255; 3]);
    let step = |part: u8, steps: u16| {
        let top = u32::from(steps.saturating_sub(1).min(3));
        ((u32::from(part) * u32::from(level) * top).div_ceil(255 * 255)) as u8
    };
    step(green, steps[1]) << 4 | step(red, steps[0]) | STEADY
}

/// Bits 4 and 5 of a V-Pot's value.
fn v_pot_mode(style: RingStyle) -> u8 {
    match style {
        RingStyle::Dot => 0,
        RingStyle::Pan => 1,
        RingStyle::Fan => 2,
        RingStyle::Spread => 3,
    }
}

/// The X-Touch Mini's ways of lighting; it has a fifth, "trim".
fn mini_mode(style: RingStyle) -> u8 {
    match style {
        RingStyle::Dot => 0,
        RingStyle::Pan => 1,
        RingStyle::Fan => 2,
        RingStyle::Spread => 3,
    }
}
