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
use crate::firmware::Firmware;
use crate::hands::{Hands, Schedule, Touch, noise};
use crate::line::Line;
use crate::script::{Device, Script};
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
    at_us: u64,
    urgent: &'a mut VecDeque<Vec<u8>>,
    shown: &'a mut Vec<(u64, MidiShown)>,
}

impl Moment<'_> {
    /// Says a message after those that wait already; none of them is left out.
    fn say(&mut self, message: &[u8]) {
        self.urgent.push_back(message.to_vec());
    }

    fn show(&mut self, what: MidiShown) {
        self.shown.push((self.at_us, what));
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
#[derive(Clone, Debug)]
pub struct MidiBox<P> {
    panel: P,
    options: MidiOptions,
    line: Line,
    parser: Parser,
    speaker: Speaker,
    reached_ns: u64,
    booting_until_ns: Option<u64>,
    sense_at_ns: Option<u64>,
    urgent: VecDeque<Vec<u8>>,
    schedule: Schedule,
    turns: Ramps,
    slides: Ramps,
    /// Where each axis stands, in steps of its way; what slides move.
    stands: [i32; 32],
    shown: Vec<(u64, MidiShown)>,
}

impl<P: Panel> MidiBox<P> {
    fn with_panel(panel: P, options: MidiOptions) -> Self {
        Self {
            panel,
            options,
            line: Line::new(options.cable.baud(), 0),
            parser: Parser::default(),
            speaker: Speaker::new(options.running_status),
            reached_ns: 0,
            booting_until_ns: None,
            sense_at_ns: options.active_sensing.then_some(SENSING_NS),
            urgent: VecDeque::new(),
            schedule: Schedule::default(),
            turns: Ramps::default(),
            slides: Ramps::default(),
            stands: [0; 32],
            shown: Vec::new(),
        }
    }

    /// Takes what the host has had shown, each with its time in microseconds.
    pub fn drain_shown(&mut self) -> impl Iterator<Item = (u64, MidiShown)> + '_ {
        self.shown.drain(..)
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

    fn catch_up(&mut self, now_us: u64) -> u64 {
        let now_ns = (now_us * 1000).max(self.reached_ns);
        self.advance(now_ns);
        now_ns
    }

    fn next_step_ns(&self) -> Option<u64> {
        let steps = [self.turns.next_us(), self.slides.next_us()];
        steps.into_iter().flatten().min().map(|us| us * 1000)
    }

    /// Lets everything happen, in its order, that happens up to `to_ns`.
    fn advance(&mut self, to_ns: u64) {
        loop {
            let line_free_ns = self.has_something_to_say().then(|| self.line.device_free_ns());
            let events = [
                self.booting_until_ns,
                self.line.next_arrival_ns(),
                self.schedule.next_ns(),
                self.next_step_ns(),
                line_free_ns,
                self.sense_at_ns,
            ];
            let Some(at_ns) = events.into_iter().flatten().min().filter(|&at| at <= to_ns) else {
                break;
            };
            self.reached_ns = at_ns.max(self.reached_ns);
            self.happen(self.reached_ns);
        }
        self.reached_ns = self.reached_ns.max(to_ns);
    }

    /// One moment: power, then the host's byte, then hands, then the line.
    fn happen(&mut self, at_ns: u64) {
        if self.booting_until_ns.is_some_and(|until| until <= at_ns) {
            self.booting_until_ns = None;
        } else if let Some((_, byte)) = self.line.arrival(at_ns) {
            if self.booting_until_ns.is_none() {
                self.hear(at_ns, byte);
            }
        } else if self.schedule.next_ns().is_some_and(|due| due <= at_ns) {
            if let Some(touch) = self.schedule.pop() {
                self.touch_now(at_ns, &touch);
            }
        } else if self.next_step_ns().is_some_and(|due| due <= at_ns) {
            self.step(at_ns / 1000);
        } else if self.sense_at_ns.is_some_and(|due| due <= at_ns) {
            self.sense_at_ns = Some(at_ns + SENSING_NS);
            if self.booting_until_ns.is_none() {
                self.line.device_sends(at_ns, &[SENSE]);
            }
        } else {
            self.say(at_ns);
        }
    }

    fn has_something_to_say(&self) -> bool {
        self.booting_until_ns.is_none() && (!self.urgent.is_empty() || self.panel.has_moved())
    }

    fn say(&mut self, at_ns: u64) {
        let next = self.urgent.pop_front().or_else(|| self.panel.next_move());
        if let Some(message) = next {
            self.line.device_sends(at_ns, self.speaker.speak(&message));
        }
    }

    fn hear(&mut self, at_ns: u64, byte: u8) {
        let mut at = Moment {
            at_us: at_ns / 1000,
            urgent: &mut self.urgent,
            shown: &mut self.shown,
        };
        if let Some(heard) = self.parser.push(byte) {
            self.panel.hear(heard, &mut at);
        }
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

    fn touch_now(&mut self, at_ns: u64, touch: &Touch) -> bool {
        let at_us = at_ns / 1000;
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
                let mut at = Moment {
                    at_us,
                    urgent: &mut self.urgent,
                    shown: &mut self.shown,
                };
                self.panel.press(control, down, &mut at)
            }
            Touch::PowerCycle => {
                self.panel.lose_power();
                self.parser = Parser::default();
                self.speaker = Speaker::new(self.options.running_status);
                self.urgent.clear();
                self.line.device_stops(at_ns);
                self.booting_until_ns = Some(at_ns + BOOT_NS);
                true
            }
            Touch::Noise(bytes) => {
                self.line.device_sends(at_ns, &noise(bytes));
                true
            }
            Touch::Pen(_) | Touch::Puck(_) | Touch::Away | Touch::Lift(_) | Touch::Ring { .. } => false,
        }
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

impl<P: Panel> Firmware for MidiBox<P> {
    fn receive(&mut self, now_us: u64, bytes: &[u8]) {
        let now_ns = self.catch_up(now_us);
        // A host that has something to say has the port open.
        self.schedule.begin(now_ns);
        self.line.host_sends(now_ns, bytes);
    }

    fn transmit(&mut self, now_us: u64, out: &mut Vec<u8>) {
        let now_ns = self.catch_up(now_us);
        self.line.deliver(now_ns, out);
    }

    /// A MIDI cable has one speed.
    fn set_line_baud(&mut self, now_us: u64, _baud: u32) {
        self.catch_up(now_us);
    }

    fn port_opened(&mut self, now_us: u64) {
        let now_ns = self.catch_up(now_us);
        self.schedule.begin(now_ns);
    }

    fn next_byte_us(&self) -> Option<u64> {
        self.line.next_delivery_ns().map(|ns| ns.div_ceil(1000))
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

impl<P: Panel> SerialDevice for MidiBox<P> {
    /// Times count from the moment the host opened the port: such a box reports by itself.
    fn play(&mut self, script: &Script) {
        let actions = script.actions.iter();
        self.schedule
            .add(actions.map(|action| (action.at_us, action.touch.clone())));
    }

    fn script_is_done(&self) -> bool {
        self.schedule.is_done() && self.next_step_ns().is_none()
    }

    fn drain_outputs(&mut self, take: &mut dyn FnMut(u64, Output)) {
        for (at_us, shown) in self.drain_shown() {
            take(at_us, Output::Midi(shown));
        }
    }

    fn line(&self) -> (u32, Parity) {
        (self.options.cable.baud(), Parity::None)
    }

    fn controls(&self) -> Device {
        self.panel.controls()
    }
}

impl<P: Panel> Hands for MidiBox<P> {
    fn touch(&mut self, now_us: u64, touch: &Touch) -> bool {
        let now_ns = self.catch_up(now_us);
        let touched = self.touch_now(now_ns, touch);
        self.advance(now_ns);
        touched
    }

    fn reporting_since_us(&self) -> Option<u64> {
        self.schedule.since_us()
    }
}

#[cfg(test)]
mod tests;
