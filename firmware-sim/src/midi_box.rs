//! Boxes of knobs, faders and buttons that speak MIDI.
//!
//! Knows: MIDI's bytes (running status, real-time bytes in between, sysex), the cable, hands, and what all boxes have
//! in common: what moved since the last message is in the next one, buttons are never passed over. What each box says
//! and shows is in its own file, written from its maker's document. Start at [`MidiBox`], then
//! `x_touch_mini`.

mod launch_control_xl;
mod nano_kontrol2;
mod wire;
mod x_touch_mini;

use crate::dial_box::Output;
use crate::hands::{Hands, Touch};
use crate::script::Device;
use crate::serial::{Inside, SerialChassis, Wire};
use crate::serial_kinds::SerialDevice;
use crate::uart::Parity;
use crate::usb_device::Ramps;
use std::collections::VecDeque;
use wire::{Parser, Speaker};

pub use launch_control_xl::LaunchControlXl;
pub use nano_kontrol2::NanoKontrol2;
pub use wire::{Cable, Heard};
pub use x_touch_mini::XTouchMini;

/// A box says nothing for so long after it got power. Ours: the host sees the port anew well before that.
const BOOT_NS: u64 = 500_000_000;
/// Active sensing comes at least this often (MIDI 1.0: 300 ms at most; ours leaves some room).
const SENSING_NS: u64 = 270_000_000;
/// Active sensing.
const SENSE: u8 = 0xFE;
/// Steps of the way from one end of an axis to the other, for moves that take time; finer than any box here is.
const WAY_STEPS: i32 = 16_384;

/// How a box is connected and what of MIDI's liberties it takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MidiOptions {
    /// The cable.
    pub cable: Cable,
    /// Leaves out status bytes that repeat.
    pub running_status: bool,
    /// Says now and then that it is still there.
    pub active_sensing: bool,
}

impl Default for MidiOptions {
    fn default() -> Self {
        Self {
            cable: Cable::Usb,
            running_status: false,
            active_sensing: false,
        }
    }
}

/// How a lamp is lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glow {
    /// Dark.
    Off,
    /// Lit.
    On,
    /// On and off by itself.
    Blinking,
}

/// What the host made the box show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MidiShown {
    /// A lamp in a button, numbered as the buttons are.
    Lamp {
        /// Which button's.
        control: u8,
        /// How.
        glow: Glow,
    },
    /// A lamp of two colours.
    Colour {
        /// Which one, as the maker numbers them.
        index: u8,
        /// 0 to 3.
        red: u8,
        /// 0 to 3.
        green: u8,
        /// On and off by itself.
        blinking: bool,
    },
    /// The lamps around a dial: bit 0 is the leftmost.
    Ring {
        /// Which dial's.
        control: u8,
        /// Lit lamps.
        lamps: u16,
        /// On and off by themselves.
        blinking: bool,
    },
    /// Another mode: 0 as the maker's table has it first.
    Mode(u8),
    /// Another layer or template.
    Layer(u8),
}

/// A moment in a box's life: what it wants said at once, and shown.
#[derive(Debug)]
pub struct Moment<'a> {
    wire: &'a mut Wire,
    urgent: &'a mut VecDeque<Vec<u8>>,
}

impl Moment<'_> {
    /// Says a message after those that wait already; none of them is left out.
    fn say(&mut self, message: &[u8]) {
        self.urgent.push_back(message.to_vec());
    }

    fn show(&mut self, what: MidiShown) {
        self.wire.show(Output::Midi(what));
    }
}

/// What differs from box to box.
pub trait Panel: Send {
    /// How many dials, buttons and axes there are.
    fn controls(&self) -> Device;

    /// A whole message from the host.
    fn hear(&mut self, heard: Heard<'_>, at: &mut Moment<'_>);

    /// A button goes down or up. False: there is no such button.
    fn press(&mut self, control: u8, down: bool, at: &mut Moment<'_>) -> bool;

    /// A dial has clicked so many times. False: there is no such dial.
    fn turn(&mut self, control: u8, clicks: i32) -> bool;

    /// Clicks of a dial in a turn.
    fn clicks_per_turn(&self) -> u32 {
        24
    }

    /// An axis stands at `share` of its way, 0 to 1. False: there is no such axis.
    fn slide(&mut self, control: u8, share: f64) -> bool;

    /// Takes the next message of what has been turned or slid since it was last told.
    fn next_move(&mut self) -> Option<Vec<u8>>;

    /// Whether there is one.
    fn has_moved(&self) -> bool;

    /// Power was lost and is back: modes, layers and lamps are as they come. Hands stay where they are.
    fn lose_power(&mut self);
}

/// A box, its cable, and the hands on it.
pub type MidiBox<P> = SerialChassis<Desk<P>>;

/// What all boxes have in common, around what is on this one.
#[derive(Clone, Debug)]
pub struct Desk<P> {
    panel: P,
    options: MidiOptions,
    parser: Parser,
    speaker: Speaker,
    sense_at_ns: Option<u64>,
    urgent: VecDeque<Vec<u8>>,
    turns: Ramps,
    slides: Ramps,
    /// Where each axis stands, in steps of its way; what slides move.
    stands: [i32; 32],
}

impl<P: Panel> MidiBox<P> {
    fn with_panel(panel: P, options: MidiOptions) -> Self {
        let desk = Desk {
            panel,
            options,
            parser: Parser::default(),
            speaker: Speaker::new(options.running_status),
            sense_at_ns: options.active_sensing.then_some(SENSING_NS),
            urgent: VecDeque::new(),
            turns: Ramps::default(),
            slides: Ramps::default(),
            stands: [0; 32],
        };
        Self::around(desk, options.cable.baud(), Parity::None, 0)
    }

    /// Takes what the host has had shown, each with its time in microseconds.
    pub fn drain_shown(&mut self) -> impl Iterator<Item = (u64, MidiShown)> + '_ {
        self.drain_outputs().filter_map(|(at_us, output)| match output {
            Output::Midi(shown) => Some((at_us, shown)),
            _ => None,
        })
    }

    /// Turns dial `control` by `clicks` evenly over `over_us`. False: there is no such dial.
    pub fn turn(&mut self, now_us: u64, control: u8, clicks: i32, over_us: u64) -> bool {
        let by = crate::hands::Turn::Counts(clicks);
        self.touch(now_us, &Touch::Dial { control, by, over_us })
    }

    /// Slides axis `control` to `to` of its way, 0 to 1, evenly over `over_us`. False: there is no such axis.
    pub fn slide(&mut self, now_us: u64, control: u8, to: f64, over_us: u64) -> bool {
        self.touch(now_us, &Touch::Axis { control, to, over_us })
    }

    /// Presses or releases button `control`. False: there is no such button.
    pub fn press(&mut self, now_us: u64, control: u8, down: bool) -> bool {
        self.touch(now_us, &Touch::Button { control, down })
    }
}

impl<P: Panel> Inside for Desk<P> {
    fn hear(&mut self, wire: &mut Wire, byte: u8) {
        let urgent = &mut self.urgent;
        if let Some(heard) = self.parser.push(byte) {
            self.panel.hear(heard, &mut Moment { wire, urgent });
        }
    }

    fn next_ns(&self, wire: &Wire) -> Option<u64> {
        let speaks = !wire.is_booting() && (!self.urgent.is_empty() || self.panel.has_moved());
        let line_free_ns = speaks.then(|| wire.free_ns());
        let events = [self.next_step_ns(), self.sense_at_ns, line_free_ns];
        events.into_iter().flatten().min()
    }

    /// Hands that are moving, then a sign of life, then what there is to say.
    fn happen(&mut self, wire: &mut Wire) {
        let now_ns = wire.now_ns();
        let due = |event: Option<u64>| event.is_some_and(|at_ns| at_ns <= now_ns);
        if due(self.next_step_ns()) {
            self.step(now_ns / 1000);
        } else if due(self.sense_at_ns) {
            self.sense_at_ns = Some(now_ns + SENSING_NS);
            if !wire.is_booting() {
                wire.say(&[SENSE]);
            }
        } else if let Some(message) = self.urgent.pop_front().or_else(|| self.panel.next_move()) {
            wire.say(self.speaker.speak(&message));
        }
    }

    fn touch(&mut self, wire: &mut Wire, touch: &Touch) -> bool {
        let at_us = wire.now_ns() / 1000;
        match *touch {
            Touch::Dial { control, by, over_us } => {
                // Turning by nothing asks whether the dial is there.
                let there = self.panel.turn(control, 0);
                if there {
                    let clicks = by.counts(self.panel.clicks_per_turn());
                    self.turns.begin(at_us, control, clicks, over_us);
                    self.step(at_us);
                }
                there
            }
            Touch::Axis { control, to, over_us } => self.begin_slide(at_us, control, to, over_us),
            Touch::Button { control, down } => {
                let urgent = &mut self.urgent;
                self.panel.press(control, down, &mut Moment { wire, urgent })
            }
            _ => false,
        }
    }

    fn lose_power(&mut self, wire: &mut Wire) {
        self.panel.lose_power();
        self.parser = Parser::default();
        self.speaker = Speaker::new(self.options.running_status);
        self.urgent.clear();
        wire.boot(BOOT_NS);
    }

    /// A host that has something to say has the port open.
    fn host_writes(&mut self, wire: &mut Wire) {
        wire.begin_script();
    }

    fn port_opened(&mut self, wire: &mut Wire) {
        wire.begin_script();
    }

    fn is_moving(&self) -> bool {
        self.next_step_ns().is_some()
    }

    fn has_one_speed(&self) -> bool {
        true
    }

    fn controls(&self) -> Device {
        self.panel.controls()
    }
}

impl<P: Panel> Desk<P> {
    fn next_step_ns(&self) -> Option<u64> {
        let steps = [self.turns.next_us(), self.slides.next_us()];
        steps.into_iter().flatten().min().map(|us| us * 1000)
    }

    fn step(&mut self, at_us: u64) {
        let panel = &mut self.panel;
        self.turns.step(at_us, |control, clicks| {
            panel.turn(control, clicks);
        });
        let stands = &mut self.stands;
        self.slides.step(at_us, |control, steps| {
            if let Some(stand) = stands.get_mut(usize::from(control)) {
                *stand = (*stand + steps).clamp(0, WAY_STEPS);
                panel.slide(control, f64::from(*stand) / f64::from(WAY_STEPS));
            }
        });
    }

    fn begin_slide(&mut self, at_us: u64, control: u8, to: f64, over_us: u64) -> bool {
        let Some(stand) = self.stands.get(usize::from(control)).copied() else {
            return false;
        };
        let there = self.panel.slide(control, f64::from(stand) / f64::from(WAY_STEPS));
        if there {
            self.slides.stop(control);
            let target = (to.clamp(0.0, 1.0) * f64::from(WAY_STEPS)).round() as i32;
            self.slides.begin(at_us, control, target - stand, over_us);
            self.step(at_us);
        }
        there
    }
}

/// The box of the profile of this name, on USB; none where it is not simulated. What its owner must have set up for
/// the profile to be right is set up.
pub(crate) fn of_profile(key: &str) -> Option<Box<dyn SerialDevice>> {
    let options = MidiOptions::default();
    Some(match key {
        "x-touch-mini" => Box::new(XTouchMini::new(options)),
        "x-touch-mini-mc" => Box::new(XTouchMini::in_mc_mode(options)),
        "nanokontrol2" => Box::new(NanoKontrol2::with_host_lamps(options)),
        "launch-control-xl" => Box::new(LaunchControlXl::new(options)),
        _ => return None,
    })
}

#[cfg(test)]
mod tests;
