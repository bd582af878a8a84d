//! The SGI dial and button box (SN-921 and kin): 8 dials, 32 buttons, 32 lamps on a 9600 baud line.
//!
//! The box answers each `20` with one `20`, says nothing else until told to report, and sends one report
//! per free slot of its line, so that turning faster than the wire makes larger steps, not a queue.
//! Source: `docs/protocols/sgi-dial-box.md` (VRPN, freeglut and a 2013 USB adapter read the real box; no
//! recording of one was found, so this box satisfies all three).

mod command;
mod dials;

use crate::firmware::Firmware;
use crate::hands::{Hands, Schedule, Touch, noise};
use crate::line::Line;
use crate::midi_box::MidiShown;
use crate::script::Script;
use crate::uart::Parity;
use command::{Command, Parser};
use device_profiles::InputProfile;
use dials::{DIALS, Dials};
use std::collections::VecDeque;

/// Speed of the line.
pub const BAUD: u32 = 9600;
/// From power to the announcing `20`. Ours; a real adapter waits 1 s after power-up before it speaks.
const BOOT_NS: u64 = 500_000_000;
/// Initialise, and its answer.
const INITIALISE: u8 = 0x20;

/// How this box differs from the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Has a display, so takes `61` texts. Without one, `61` is an unknown byte like any other.
    pub labels: bool,
    /// Counts in one turn: readers of the real box say 200 (VRPN) or 256 (freeglut).
    pub counts_per_turn: u32,
    /// The box's clock is this many millionths fast.
    pub drift_ppm: i32,
    /// Whether the first `71` and `73` after a dial mask are lost, as VRPN found ("the first time is not
    /// always understood").
    pub loses_first_button_setup: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            labels: false,
            counts_per_turn: 256,
            drift_ppm: 0,
            loses_first_button_setup: false,
        }
    }
}

impl From<&InputProfile> for Options {
    fn from(profile: &InputProfile) -> Self {
        Self {
            labels: profile.label_characters() > 0,
            counts_per_turn: profile.counts_per_turn() as u32,
            ..Self::default()
        }
    }
}

/// What the host made the box show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// Lit lamps, bit n for lamp n.
    Lamps(u32),
    /// The eight characters at a control: 0–7 dials, 8–19 function keys 1–12.
    Label {
        /// Which control.
        control: u8,
        /// Eight ASCII characters, padded with spaces.
        text: String,
    },
    /// What only a box that speaks MIDI has: rings, colours, lamps that blink, modes, layers.
    Midi(MidiShown),
}

/// The box, its line, and the hands on it.
#[derive(Clone, Debug)]
pub struct SgiDialBox {
    options: Options,
    line: Line,
    reached_ns: u64,
    booting_until_ns: Option<u64>,
    parser: Parser,
    dials: Dials,
    buttons_down: u32,
    buttons_enabled: u32,
    buttons_reported: u32,
    button_setups_to_lose: u8,
    lamps: u32,
    filter: u16,
    /// Answers and button edges in their order, waiting for the line.
    urgent: VecDeque<u8>,
    schedule: Schedule,
    outputs: Vec<(u64, Output)>,
    unknown: u64,
}

impl SgiDialBox {
    /// A box that has been on for a while and has not been spoken to: it is silent.
    pub fn new(options: Options) -> Self {
        Self {
            options,
            line: Line::new(BAUD, options.drift_ppm),
            reached_ns: 0,
            booting_until_ns: None,
            parser: Parser::new(options.labels),
            dials: Dials::default(),
            buttons_down: 0,
            buttons_enabled: 0,
            buttons_reported: 0,
            button_setups_to_lose: 0,
            lamps: 0,
            filter: 0,
            urgent: VecDeque::new(),
            schedule: Schedule::default(),
            outputs: Vec::new(),
            unknown: 0,
        }
    }

    /// Turns dial `control` by `counts` evenly over `over_us`. False: there is no such dial.
    pub fn turn(&mut self, now_us: u64, control: u8, counts: i32, over_us: u64) -> bool {
        let now_ns = self.catch_up(now_us);
        let turned = self.dials.turn(now_ns, control, counts, over_us * 1000);
        self.advance(now_ns);
        turned
    }

    /// Presses or releases button `control`. False: there is no such button.
    pub fn press(&mut self, now_us: u64, control: u8, down: bool) -> bool {
        let now_ns = self.catch_up(now_us);
        let pressed = self.press_now(control, down);
        self.advance(now_ns);
        pressed
    }

    /// Takes the power away and gives it back: masks, counts, lamps and labels are lost, and the box
    /// announces itself with a `20` nobody asked for.
    pub fn power_cycle(&mut self, now_us: u64) {
        let now_ns = self.catch_up(now_us);
        self.lose_power(now_ns);
    }

    /// Plays `script` as well, its times counted from the first switching on of reports.
    pub fn play(&mut self, script: &Script) {
        self.schedule.add(
            script
                .actions
                .iter()
                .map(|action| (action.at_us, action.touch.clone())),
        );
    }

    /// Whether every scripted touch has been made.
    pub fn script_is_done(&self) -> bool {
        self.schedule.is_done()
    }

    /// Takes what the host has sent to lamps and labels, each with its time in microseconds.
    pub fn drain_outputs(&mut self) -> impl Iterator<Item = (u64, Output)> + '_ {
        self.outputs.drain(..)
    }

    /// The lamps now lit, bit n for lamp n.
    pub fn lamps(&self) -> u32 {
        self.lamps
    }

    /// Bytes that were no command.
    pub fn unknown_bytes(&self) -> u64 {
        self.unknown
    }

    /// The argument of the last `53`; its meaning is not known and it changes nothing here.
    pub fn filter(&self) -> u16 {
        self.filter
    }

    fn catch_up(&mut self, now_us: u64) -> u64 {
        let now_ns = (now_us * 1000).max(self.reached_ns);
        self.advance(now_ns);
        now_ns
    }

    /// Lets everything happen, in its order, that happens up to `to_ns`.
    fn advance(&mut self, to_ns: u64) {
        loop {
            let slot = self
                .has_something_to_say()
                .then(|| self.line.device_free_ns().max(self.reached_ns));
            let events = [
                self.booting_until_ns,
                self.line.next_arrival_ns(),
                self.schedule.next_ns(),
                self.dials.next_step_ns(),
                slot,
            ];
            let Some(at_ns) = events.into_iter().flatten().min().filter(|&at| at <= to_ns) else {
                break;
            };
            let at_ns = at_ns.max(self.reached_ns);
            self.reached_ns = at_ns;
            self.happen(at_ns);
        }
        self.reached_ns = self.reached_ns.max(to_ns);
    }

    /// One moment: power, then the host's byte, then hands, then the line.
    fn happen(&mut self, at_ns: u64) {
        if self.booting_until_ns.is_some_and(|until| until <= at_ns) {
            self.booting_until_ns = None;
            self.urgent.push_back(INITIALISE);
        } else if let Some((at, byte)) = self.line.arrival(at_ns) {
            if self.booting_until_ns.is_none() {
                self.hear(at, byte);
            }
        } else if self.schedule.next_ns().is_some_and(|due| due <= at_ns) {
            if let Some(touch) = self.schedule.pop() {
                self.touch_now(at_ns, &touch);
            }
        } else if self.dials.next_step_ns().is_some_and(|due| due <= at_ns) {
            self.dials.step(at_ns);
        } else if self.line.device_free_ns() <= at_ns {
            self.say(at_ns);
        }
    }

    fn has_something_to_say(&self) -> bool {
        self.booting_until_ns.is_none() && (!self.urgent.is_empty() || self.dials.has_report())
    }

    fn say(&mut self, at_ns: u64) {
        if let Some(byte) = self.urgent.pop_front() {
            self.line.device_sends(at_ns, &[byte]);
        } else if let Some(report) = self.dials.report() {
            self.line.device_sends(at_ns, &report);
        }
    }

    fn hear(&mut self, at_ns: u64, byte: u8) {
        let Some(command) = self.parser.push(byte) else {
            return;
        };
        match command {
            Command::Initialise => {
                self.forget();
                self.urgent.push_back(INITIALISE);
            }
            Command::Dials { mask, mode } => {
                self.dials.report_by_themselves(mask, mode);
                // "Enabling the dials disables the buttons" (VRPN).
                self.buttons_enabled = 0;
                self.buttons_reported = 0;
                self.button_setups_to_lose = if self.options.loses_first_button_setup {
                    2
                } else {
                    0
                };
                if mask & DIALS_MASK != 0 {
                    self.schedule.begin(at_ns);
                }
            }
            Command::EnableButtons(mask) => {
                if !self.loses_button_setup() {
                    self.buttons_enabled = mask;
                }
            }
            Command::ReportButtons(mask) => {
                if !self.loses_button_setup() {
                    self.buttons_reported = mask;
                    if mask != 0 {
                        self.schedule.begin(at_ns);
                    }
                }
            }
            Command::Lamps(mask) => {
                self.lamps = mask;
                self.outputs.push((at_ns / 1000, Output::Lamps(mask)));
            }
            Command::Label { control, text } => {
                self.outputs.push((at_ns / 1000, Output::Label { control, text }));
            }
            Command::Filter(argument) => self.filter = argument,
            Command::Unknown => self.unknown += 1,
        }
    }

    fn loses_button_setup(&mut self) -> bool {
        let lost = self.button_setups_to_lose > 0;
        self.button_setups_to_lose = self.button_setups_to_lose.saturating_sub(1);
        lost
    }

    /// Back to the silent state with counts at zero; lamps stay, hands stay where they are.
    fn forget(&mut self) {
        self.urgent.clear();
        self.dials.forget();
        self.buttons_enabled = 0;
        self.buttons_reported = 0;
        self.button_setups_to_lose = 0;
    }

    fn lose_power(&mut self, now_ns: u64) {
        self.forget();
        self.lamps = 0;
        self.filter = 0;
        self.parser = Parser::new(self.options.labels);
        self.line.device_stops(now_ns);
        self.booting_until_ns = Some(now_ns + BOOT_NS);
    }

    fn press_now(&mut self, control: u8, down: bool) -> bool {
        if control >= 32 {
            return false;
        }
        let bit = 1u32 << control;
        let was_down = self.buttons_down & bit != 0;
        self.buttons_down = if down {
            self.buttons_down | bit
        } else {
            self.buttons_down & !bit
        };
        let heard = self.buttons_enabled & self.buttons_reported & bit != 0;
        if was_down != down && heard && self.booting_until_ns.is_none() {
            self.urgent.push_back(button_code(control, down));
        }
        true
    }

    fn touch_now(&mut self, at_ns: u64, touch: &Touch) -> bool {
        match *touch {
            Touch::Dial { control, by, over_us } => self.dials.turn(
                at_ns,
                control,
                by.counts(self.options.counts_per_turn),
                over_us * 1000,
            ),
            Touch::Button { control, down } => self.press_now(control, down),
            Touch::PowerCycle => {
                self.lose_power(at_ns);
                true
            }
            Touch::Noise(bytes) => {
                self.line.device_sends(at_ns, &noise(bytes));
                true
            }
            Touch::Axis { .. }
            | Touch::Ring { .. }
            | Touch::Pen(_)
            | Touch::Puck(_)
            | Touch::Away
            | Touch::Lift(_) => false,
        }
    }
}

/// The dials there are, as a mask.
const DIALS_MASK: u16 = (1 << DIALS) - 1;

/// D8–DF are buttons 0–7 pressed, D0–D7 8–15, C8–CF 16–23, C0–C7 24–31; released 0x20 higher.
fn button_code(control: u8, down: bool) -> u8 {
    let pressed = 0xD8 - 8 * (control / 8) + control % 8;
    if down { pressed } else { pressed + 0x20 }
}

impl Firmware for SgiDialBox {
    fn receive(&mut self, now_us: u64, bytes: &[u8]) {
        let now_ns = self.catch_up(now_us);
        self.line.host_sends(now_ns, bytes);
    }

    fn transmit(&mut self, now_us: u64, out: &mut Vec<u8>) {
        let now_ns = self.catch_up(now_us);
        self.line.deliver(now_ns, out);
    }

    fn set_line_baud(&mut self, now_us: u64, baud: u32) {
        self.catch_up(now_us);
        self.line.set_host_baud(baud);
    }

    fn set_line_parity(&mut self, now_us: u64, parity: Parity) {
        self.catch_up(now_us);
        self.line.set_host_parity(parity);
    }

    fn next_byte_us(&self) -> Option<u64> {
        self.line.next_delivery_ns().map(|ns| ns.div_ceil(1000))
    }
}

impl Hands for SgiDialBox {
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
