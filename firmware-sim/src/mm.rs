//! A Summagraphics MM tablet (MM1201, MM961, SummaSketch): one letter a command, five bytes a packet, odd parity.
//!
//! After power-up it knows no speed: it finds the host's from spaces, and is deaf for a while after the first byte
//! behind them. It then streams; drivers put it into prompt mode to be able to talk to it.
//! Source: `docs/protocols/mm.md` (xf86-input-summa, `src/xf86Summa.c`; the MM1201 manual as quoted on
//! classic-computer lists).

mod command;
mod packet;

use crate::hands::Touch;
use crate::script::Device;
use crate::serial::{Inside, SerialChassis, Wire};
use crate::uart::Parity;
use command::{Command, Parser};
use device_profiles::{InputProfile, MmFraming};
use packet::{Manner, Pointer};
use std::collections::VecDeque;

/// Speed that drivers use.
pub const BAUD: u32 = 9600;
/// Spaces from which it finds the speed; drivers send ten.
const SPACES_TO_WAKE: u32 = 4;
/// How long it is deaf after waking and after a reset. Ours, within the 400 ms that the driver waits because "200 ms
/// isn't enough".
const WAKE_NS: u64 = 300_000_000;
/// Time between two reports of a tool that lies still, where the increment is 0. Ours.
const REPEAT_NS: u64 = 10_000_000;
/// Lines per inch after power-up, the driver's default. Ours.
const DEFAULT_COUNTS_PER_INCH: u16 = 500;

/// How a model writes its reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Packets of five or, relative, three bytes.
    #[default]
    Binary,
    /// MM1103: `XXXX,YYYY,F` and a line feed.
    Mm1103,
    /// Bit Pad Two: `XXXX,YYYY,F`, return, line feed; F is 9 where there is nothing.
    BitPadTwo,
}

impl Form {
    /// How it begins: one that writes text has switches for its speed and is asked nothing, the others wait for spaces.
    fn asleep(self) -> Option<u32> {
        (self == Self::Binary).then_some(0)
    }
}

/// What tells one model from another on the wire.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Answer to `z?`, ended by a return.
    pub text: String,
    /// The active area.
    pub inches: [f64; 2],
    /// How it writes.
    pub form: Form,
    /// Lines per inch after power-up.
    pub counts_per_inch: u16,
}

impl Default for Model {
    /// Twelve inches square, with the text that the mailing-list posts quote; its version is ours.
    fn default() -> Self {
        Self {
            text: "MM2 12x12 Tablet by Summagraphics Firmware Version 1.00".to_owned(),
            inches: [12.0, 12.0],
            form: Form::Binary,
            counts_per_inch: DEFAULT_COUNTS_PER_INCH,
        }
    }
}

impl Model {
    /// The tablet that `profile` describes; none for those with a third axis, which are not simulated.
    pub fn of_profile(profile: &InputProfile) -> Option<Self> {
        let form = match profile.mm?.framing {
            MmFraming::Absolute | MmFraming::Relative => Form::Binary,
            // The one that does not say when its cursor leaves.
            MmFraming::Ascii if profile.leave_after_ms.is_some() => Form::Mm1103,
            MmFraming::Ascii => Form::BitPadTwo,
            MmFraming::Flair => return None,
        };
        let area = profile.area();
        let counts_per_inch = match form {
            Form::Binary => DEFAULT_COUNTS_PER_INCH,
            Form::Mm1103 | Form::BitPadTwo => area.per_inch()[0].round() as u16,
        };
        Some(Self {
            inches: area.mm().map(|mm| mm / 25.4),
            form,
            counts_per_inch,
            ..Self::default()
        })
    }
}

/// What commands change.
#[derive(Clone, Copy, Debug)]
struct Settings {
    streaming: bool,
    increment: u8,
    manner: Manner,
}

/// The tablet, its line, and the hand over it.
pub type SummagraphicsMm = SerialChassis<Tablet>;

/// What is in the tablet.
#[derive(Clone, Debug)]
pub struct Tablet {
    model: Model,
    deaf_until_ns: u64,
    /// Spaces heard since power-up; none once it is awake.
    asleep: Option<u32>,
    parser: Parser,
    settings: Settings,
    pointer: Option<Pointer>,
    /// Where the tool was that left last, and whether that was told.
    left: Option<Pointer>,
    told: [u16; 2],
    pending: VecDeque<Pointer>,
    next_report_ns: u64,
    unknown: u64,
}

impl SummagraphicsMm {
    /// A tablet just switched on, which has not yet found the host's speed; its clock is `drift_ppm` millionths fast.
    pub fn new(model: Model, drift_ppm: i32) -> Self {
        let tablet = Tablet {
            settings: defaults(&model),
            asleep: model.form.asleep(),
            model,
            deaf_until_ns: 0,
            parser: Parser::default(),
            pointer: None,
            left: None,
            told: [0; 2],
            pending: VecDeque::new(),
            next_report_ns: 0,
            unknown: 0,
        };
        Self::around(tablet, BAUD, Parity::Odd, drift_ppm)
    }

    /// Whether it has found the host's speed.
    pub fn is_awake(&self) -> bool {
        self.inside.asleep.is_none()
    }

    /// Commands that were not understood.
    pub fn unknown_commands(&self) -> u64 {
        self.inside.unknown
    }
}

impl Inside for Tablet {
    fn hear(&mut self, wire: &mut Wire, byte: u8) {
        if let Some(spaces) = self.asleep {
            self.asleep = match byte {
                b' ' => Some(spaces + 1),
                _ if spaces >= SPACES_TO_WAKE => {
                    self.reset(wire.now_ns());
                    None
                }
                _ => Some(0),
            };
            return;
        }
        if wire.now_ns() < self.deaf_until_ns {
            return;
        }
        if let Some(command) = self.parser.push(byte) {
            self.obey(wire, command);
        }
    }

    /// When the next report is due: a change as soon as the line is free, a still tool after its time.
    fn next_ns(&self, wire: &Wire) -> Option<u64> {
        if !self.settings.streaming || self.asleep.is_some() {
            return None;
        }
        let free_ns = wire.free_ns().max(self.deaf_until_ns);
        if !self.pending.is_empty() {
            return Some(free_ns);
        }
        let repeats = self.settings.increment == 0 && self.pointer.is_some();
        repeats.then(|| free_ns.max(self.next_report_ns))
    }

    fn happen(&mut self, wire: &mut Wire) {
        if let Some(pointer) = self.pending.pop_front().or(self.pointer) {
            self.report(wire, &pointer);
        }
    }

    fn touch(&mut self, _wire: &mut Wire, touch: &Touch) -> bool {
        let next = match touch {
            Touch::Pen(pen) => Some(Pointer::pen(pen)),
            Touch::Puck(puck) => Some(Pointer::puck(puck)),
            Touch::Away | Touch::Lift(_) => None,
            _ => return false,
        };
        let before = self.pointer;
        self.pointer = next;
        match next {
            None => {
                if let Some(left) = before.map(Pointer::leaving) {
                    self.left = Some(left);
                    self.queue(left);
                }
            }
            Some(next) => {
                if before.is_none_or(|before| self.is_worth_telling(&before, &next)) {
                    self.queue(next);
                }
            }
        }
        true
    }

    fn lose_power(&mut self, wire: &mut Wire) {
        self.reset(wire.now_ns());
        self.asleep = self.model.form.asleep();
    }

    fn port_opened(&mut self, wire: &mut Wire) {
        if self.asleep.is_none() {
            wire.begin_script();
        }
    }

    fn host_writes(&mut self, wire: &mut Wire) {
        if self.asleep.is_some() {
            wire.find_speed();
        }
    }

    fn controls(&self) -> Device {
        Device::Tablet
    }
}

impl Tablet {
    fn report(&mut self, wire: &mut Wire, pointer: &Pointer) {
        let mut bytes = Vec::with_capacity(16);
        let manner = self.settings.manner;
        manner.report(pointer, self.told, &mut bytes);
        self.told = manner.counts(pointer);
        wire.say(&bytes);
        self.next_report_ns = wire.now_ns() + wire.span_ns(REPEAT_NS);
    }

    fn obey(&mut self, wire: &mut Wire, command: Command) {
        let settings = &mut self.settings;
        match command {
            Command::Reset => self.reset(wire.now_ns()),
            Command::PromptMode => {
                settings.streaming = false;
                self.pending.clear();
                wire.begin_script();
            }
            Command::Stream => {
                settings.streaming = true;
                wire.begin_script();
                self.pending.clear();
                self.pending.extend(self.pointer);
            }
            Command::Prompt => {
                let nothing = self.left.unwrap_or(Pointer::pen(&crate::hands::Pen::default()));
                let pointer = self.pointer.unwrap_or(nothing.leaving());
                self.report(wire, &pointer);
            }
            Command::Absolute(on) => settings.manner.absolute = on,
            Command::UpperOrigin => settings.manner.upper_origin = true,
            Command::Binary => settings.manner.form = Form::Binary,
            Command::TabletId(id) => settings.manner.tablet_id = id,
            Command::Increment(counts) => settings.increment = counts,
            Command::Resolution(counts_per_inch) => settings.manner.counts_per_inch = counts_per_inch,
            Command::Identify => wire.say(format!("{}\r", self.model.text).as_bytes()),
            Command::Configuration => {
                let mut bytes = Vec::with_capacity(5);
                settings.manner.configuration(&mut bytes);
                wire.say(&bytes);
            }
            Command::Nothing => {}
            Command::Unknown => self.unknown += 1,
        }
    }

    fn reset(&mut self, at_ns: u64) {
        self.deaf_until_ns = at_ns + WAKE_NS;
        self.settings = defaults(&self.model);
        self.parser = Parser::default();
        self.told = [0; 2];
        self.pending.clear();
        self.pending.extend(self.pointer);
    }

    /// An edge always is; a move where it is as long as the increment, measured from the place told last.
    fn is_worth_telling(&self, before: &Pointer, next: &Pointer) -> bool {
        let at = self.settings.manner.counts(next);
        let far = [0, 1].map(|axis| at[axis].abs_diff(self.told[axis]));
        !before.has_edges_of(next)
            || far
                .iter()
                .any(|&way| way >= u16::from(self.settings.increment).max(1))
    }

    /// Adds a report; one that differs from the last waiting only in place takes its turn.
    fn queue(&mut self, pointer: Pointer) {
        if !self.settings.streaming || self.asleep.is_some() {
            return;
        }
        match self.pending.back_mut() {
            Some(last) if last.has_edges_of(&pointer) => *last = pointer,
            _ => self.pending.push_back(pointer),
        }
    }
}

fn defaults(model: &Model) -> Settings {
    Settings {
        streaming: true,
        increment: 0,
        manner: Manner {
            inches: model.inches,
            counts_per_inch: model.counts_per_inch,
            upper_origin: false,
            absolute: true,
            tablet_id: false,
            form: model.form,
        },
    }
}

#[cfg(test)]
mod tests;
