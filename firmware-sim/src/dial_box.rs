//! The SGI dial and button box (SN-921 and kin): 8 dials, 32 buttons, 32 lamps on a 9600 baud line.
//!
//! The box answers each `20` with one `20`, says nothing else until told to report, and sends one report
//! per free slot of its line, so that turning faster than the wire makes larger steps, not a queue.
//! Source: `docs/protocols/sgi-dial-box.md` (VRPN, freeglut and a 2013 USB adapter read the real box; no
//! recording of one was found, so this box satisfies all three).

mod command;
mod dials;

use crate::hands::{Hands, Touch, Turn};
use crate::midi_box::MidiShown;
use crate::script::Device;
use crate::serial::{Inside, SerialChassis, Wire};
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
pub type SgiDialBox = SerialChassis<Panel>;

/// What is in the box.
#[derive(Clone, Debug)]
pub struct Panel {
    options: Options,
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
    unknown: u64,
}

impl SgiDialBox {
    /// A box that has been on for a while and has not been spoken to: it is silent.
    pub fn new(options: Options) -> Self {
        let panel = Panel {
            options,
            parser: Parser::new(options.labels),
            dials: Dials::default(),
            buttons_down: 0,
            buttons_enabled: 0,
            buttons_reported: 0,
            button_setups_to_lose: 0,
            lamps: 0,
            filter: 0,
            urgent: VecDeque::new(),
            unknown: 0,
        };
        Self::around(panel, BAUD, Parity::None, options.drift_ppm)
    }

    /// Turns dial `control` by `counts` evenly over `over_us`. False: there is no such dial.
    pub fn turn(&mut self, now_us: u64, control: u8, counts: i32, over_us: u64) -> bool {
        let by = Turn::Counts(counts);
        self.touch(now_us, &Touch::Dial { control, by, over_us })
    }

    /// Presses or releases button `control`. False: there is no such button.
    pub fn press(&mut self, now_us: u64, control: u8, down: bool) -> bool {
        self.touch(now_us, &Touch::Button { control, down })
    }

    /// Takes the power away and gives it back: masks, counts, lamps and labels are lost, and the box
    /// announces itself with a `20` nobody asked for.
    pub fn power_cycle(&mut self, now_us: u64) {
        self.touch(now_us, &Touch::PowerCycle);
    }

    /// The lamps now lit, bit n for lamp n.
    pub fn lamps(&self) -> u32 {
        self.inside.lamps
    }

    /// Bytes that were no command.
    pub fn unknown_bytes(&self) -> u64 {
        self.inside.unknown
    }

    /// The argument of the last `53`; its meaning is not known and it changes nothing here.
    pub fn filter(&self) -> u16 {
        self.inside.filter
    }
}

impl Inside for Panel {
    fn hear(&mut self, wire: &mut Wire, byte: u8) {
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
                    wire.begin_script();
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
                        wire.begin_script();
                    }
                }
            }
            Command::Lamps(mask) => {
                self.lamps = mask;
                wire.show(Output::Lamps(mask));
            }
            Command::Label { control, text } => wire.show(Output::Label { control, text }),
            Command::Filter(argument) => self.filter = argument,
            Command::Unknown => self.unknown += 1,
        }
    }

    fn next_ns(&self, wire: &Wire) -> Option<u64> {
        let speaks = !wire.is_booting() && (!self.urgent.is_empty() || self.dials.has_report());
        let slot = speaks.then(|| wire.free_ns());
        slot.into_iter().chain(self.dials.next_step_ns()).min()
    }

    /// Dials turn on before the line has its turn.
    fn happen(&mut self, wire: &mut Wire) {
        let now_ns = wire.now_ns();
        if self.dials.next_step_ns().is_some_and(|due| due <= now_ns) {
            self.dials.step(now_ns);
        } else if let Some(byte) = self.urgent.pop_front() {
            wire.say(&[byte]);
        } else if let Some(report) = self.dials.report() {
            wire.say(&report);
        }
    }

    fn touch(&mut self, wire: &mut Wire, touch: &Touch) -> bool {
        match *touch {
            Touch::Dial { control, by, over_us } => self.dials.turn(
                wire.now_ns(),
                control,
                by.counts(self.options.counts_per_turn),
                over_us * 1000,
            ),
            Touch::Button { control, down } => self.press_now(wire, control, down),
            _ => false,
        }
    }

    fn lose_power(&mut self, wire: &mut Wire) {
        self.forget();
        self.lamps = 0;
        self.filter = 0;
        self.parser = Parser::new(self.options.labels);
        wire.boot(BOOT_NS);
    }

    fn booted(&mut self, _wire: &mut Wire) {
        self.urgent.push_back(INITIALISE);
    }

    fn controls(&self) -> Device {
        Device::DIAL_BOX
    }
}

impl Panel {
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

    fn press_now(&mut self, wire: &Wire, control: u8, down: bool) -> bool {
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
        if was_down != down && heard && !wire.is_booting() {
            self.urgent.push_back(button_code(control, down));
        }
        true
    }
}

/// The dials there are, as a mask.
const DIALS_MASK: u16 = (1 << DIALS) - 1;

/// D8–DF are buttons 0–7 pressed, D0–D7 8–15, C8–CF 16–23, C0–C7 24–31; released 0x20 higher.
fn button_code(control: u8, down: bool) -> u8 {
    let pressed = 0xD8 - 8 * (control / 8) + control % 8;
    if down { pressed } else { pressed + 0x20 }
}

#[cfg(test)]
mod tests;
