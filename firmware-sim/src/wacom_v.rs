//! A Wacom Intuos or Intuos 2 on a serial line: protocol V, two tools at once, each with an id and a serial number.
//!
//! It begins at 9600 baud and goes to 19200 or, from ROM 2.0, 38400 when told to; it hears only the speed it is at,
//! is deaf while it resets or changes speed, and sends at most what the wire carries and the interval allows:
//! positions of a tool between two packets are merged, changes of buttons and comings and goings never are.
//! Source: `docs/protocols/wacom-v.md` (xf86-input-wacom, `wcmSerial.c`).

mod command;
mod packet;

use crate::hands::{Held, Touch};
use crate::script::Device;
use crate::serial::{Inside, SerialChassis, Wire};
use crate::uart::Parity;
use command::{Command, Parser};
use device_profiles::InputProfile;
use packet::{Pointer, Tool};
use std::collections::VecDeque;

/// Speed of the line after power-up and reset.
pub const BAUD: u32 = 9600;
/// How long `$` leaves the tablet deaf. Ours, within the 250 ms that drivers wait after it.
const RESET_BAUD_NS: u64 = 200_000_000;
/// How long `#` and a change of speed leave it deaf. Ours, within the 75 ms that drivers wait after them.
const RESET_NS: u64 = 60_000_000;
/// Unit of `IT`.
const INTERVAL_NS: u64 = 5_000_000;
/// Tools it can follow at once.
const CHANNELS: usize = 2;

/// The pucks there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PuckKind {
    /// Three buttons and a wheel that clicks.
    #[default]
    Mouse,
    /// Cross hairs and five buttons.
    Lens,
    /// Five buttons, a wheel that springs back (`wheel` is in tenths of its travel), and its turn about itself.
    FourD,
}

impl PuckKind {
    fn id(self) -> u16 {
        match self {
            Self::Mouse => 0x007,
            Self::Lens => 0x096,
            Self::FourD => 0x094,
        }
    }

    fn buttons_mask(self) -> u8 {
        match self {
            Self::Mouse => 0b111,
            Self::Lens | Self::FourD => 0b1_1111,
        }
    }
}

/// What tells one model from another on the wire.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Model {
    /// Answer to `~#` before the version; `GD` Intuos, `XD` Intuos 2.
    pub text: String,
    /// ROM version as in the answer; its first number decides whether 38400 baud is to be had.
    pub version: String,
    /// Largest x and y, at most 65535.
    pub max: [u16; 2],
    /// Lines per inch.
    pub counts_per_inch: u32,
    /// The pen that came with it.
    pub pen_serial: u32,
    /// The puck that came with it.
    pub puck_serial: u32,
    /// What that puck is.
    pub puck: PuckKind,
}

impl Default for Model {
    /// An Intuos of 6 by 8 inches; its size is that of the USB model (Linux, `wacom_wac.c`, 056a:0021).
    fn default() -> Self {
        Self {
            text: "GD-0608-R00".to_owned(),
            version: "1.2-0".to_owned(),
            max: [20_320, 16_240],
            counts_per_inch: 2540,
            pen_serial: 0x0123_4567,
            puck_serial: 0x89AB_CDEF,
            puck: PuckKind::default(),
        }
    }
}

impl From<&InputProfile> for Model {
    fn from(profile: &InputProfile) -> Self {
        let told = profile.wacom.clone().unwrap_or_default();
        let area = profile.area();
        Self {
            text: told.model,
            version: told.version,
            max: area
                .counts
                .map(|counts| u16::try_from(counts).unwrap_or(u16::MAX)),
            counts_per_inch: area.per_inch()[0].round() as u32,
            ..Self::default()
        }
    }
}

impl Model {
    fn goes_to(&self, baud: u32) -> bool {
        let major = self.version.split('.').next().and_then(|text| text.parse().ok());
        baud <= 19_200 || major.is_some_and(|major: u32| major >= 2)
    }
}

/// One thing to say about the tool of one channel.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Report {
    Enter(Tool),
    At(Pointer),
    Leave,
}

/// What commands change.
#[derive(Clone, Copy, Debug, Default)]
struct Settings {
    streaming: bool,
    two_tools: bool,
    introductions: bool,
    interval: u32,
}

/// The tablet, its line, and the hands over it.
pub type WacomV = SerialChassis<Tablet>;

/// What is in the tablet.
#[derive(Clone, Debug)]
pub struct Tablet {
    model: Model,
    deaf_until_ns: u64,
    parser: Parser,
    settings: Settings,
    /// The tools near the surface: a pen in channel 0 or 1, a puck in the other.
    channels: [Option<Pointer>; CHANNELS],
    pending: VecDeque<(u8, Report)>,
    next_packet_ns: u64,
    unknown: u64,
}

impl WacomV {
    /// A tablet switched on a while ago, not yet told to report; its clock is `drift_ppm` millionths fast.
    pub fn new(model: Model, drift_ppm: i32) -> Self {
        let tablet = Tablet {
            model,
            deaf_until_ns: 0,
            parser: Parser::default(),
            settings: Settings::default(),
            channels: [None; CHANNELS],
            pending: VecDeque::new(),
            next_packet_ns: 0,
            unknown: 0,
        };
        Self::around(tablet, BAUD, Parity::None, drift_ppm)
    }

    /// The speed it speaks and hears at now.
    pub fn baud(&self) -> u32 {
        self.wire.baud()
    }

    /// Whether the host has switched reporting on and not off again.
    pub fn is_streaming(&self) -> bool {
        self.inside.settings.streaming
    }

    /// Commands that were not understood.
    pub fn unknown_commands(&self) -> u64 {
        self.inside.unknown
    }
}

impl Inside for Tablet {
    fn hear(&mut self, wire: &mut Wire, byte: u8) {
        if wire.now_ns() < self.deaf_until_ns {
            return;
        }
        if let Some(command) = self.parser.push(byte) {
            self.obey(wire, command);
        }
    }

    fn next_ns(&self, wire: &Wire) -> Option<u64> {
        let reports = self.settings.streaming && !self.pending.is_empty();
        reports.then(|| wire.free_ns().max(self.next_packet_ns))
    }

    fn happen(&mut self, wire: &mut Wire) {
        match self.pending.pop_front() {
            Some((channel, Report::Enter(tool))) => wire.say(&packet::enter(tool, channel)),
            Some((channel, Report::Leave)) => wire.say(&packet::leave(channel)),
            Some((channel, Report::At(pointer))) => {
                for packet in pointer.packets(channel, self.model.puck) {
                    wire.say(&packet);
                }
            }
            None => return,
        }
        let interval_ns = u64::from(self.settings.interval) * INTERVAL_NS;
        self.next_packet_ns = wire.now_ns() + wire.span_ns(interval_ns);
    }

    fn touch(&mut self, _wire: &mut Wire, touch: &Touch) -> bool {
        match touch {
            Touch::Pen(pen) => self.hold(Held::Pen, Pointer::pen(pen, &self.model)),
            Touch::Puck(puck) => self.hold(Held::Puck, Pointer::puck(puck, &self.model)),
            Touch::Away => (0..CHANNELS).for_each(|channel| self.lift(channel)),
            Touch::Lift(held) => {
                if let Some(channel) = self.channel_of(*held) {
                    self.lift(channel);
                }
            }
            _ => return false,
        }
        true
    }

    fn lose_power(&mut self, wire: &mut Wire) {
        self.reset(wire, RESET_BAUD_NS, BAUD);
    }

    fn controls(&self) -> Device {
        Device::Tablet
    }
}

impl Tablet {
    fn obey(&mut self, wire: &mut Wire, command: Command) {
        match command {
            Command::ResetBaud => self.reset(wire, RESET_BAUD_NS, BAUD),
            Command::Reset => {
                let baud = wire.baud();
                self.reset(wire, RESET_NS, baud);
                self.start();
            }
            Command::Identify => {
                let answer = format!("~#{},V{}\r", self.model.text, self.model.version);
                wire.say(answer.as_bytes());
            }
            Command::Resolution => {
                let lines = self.model.counts_per_inch;
                wire.say(format!("~RE203C900,002,02,{lines},{lines}\r").as_bytes());
            }
            Command::Size => {
                let [x, y] = self.model.max;
                wire.say(format!("~C{x},{y}\r").as_bytes());
            }
            Command::Start => {
                wire.begin_script();
                self.start();
            }
            Command::Stop => {
                self.settings.streaming = false;
                self.pending.clear();
            }
            Command::Baud(baud) if self.model.goes_to(baud) => {
                wire.set_baud(baud);
                self.deaf_until_ns = wire.now_ns() + RESET_NS;
                self.next_packet_ns = self.deaf_until_ns;
            }
            Command::TwoTools(on) => self.settings.two_tools = on,
            Command::Introductions(on) => self.settings.introductions = on,
            Command::Interval(units) => self.settings.interval = units,
            Command::Baud(_) | Command::Unknown => self.unknown += 1,
        }
    }

    /// Reports from here on; what is lying there is introduced.
    fn start(&mut self) {
        self.settings.streaming = true;
        self.pending.clear();
        for channel in 0..CHANNELS {
            if let Some(pointer) = self.channels[channel] {
                self.come(channel, pointer);
            }
        }
    }

    fn reset(&mut self, wire: &mut Wire, deaf_ns: u64, baud: u32) {
        self.deaf_until_ns = wire.now_ns() + deaf_ns;
        self.settings = Settings::default();
        self.parser = Parser::default();
        self.pending.clear();
        self.next_packet_ns = self.deaf_until_ns;
        wire.set_baud(baud);
    }

    fn channel_of(&self, held: Held) -> Option<usize> {
        let is_puck = held == Held::Puck;
        self.channels
            .iter()
            .position(|there| there.is_some_and(|p| (p.tool.id == self.model.puck.id()) == is_puck))
    }

    /// A tool is laid down, moved, or another of its kind takes its place. Of two tools the second takes the free
    /// channel.
    fn hold(&mut self, held: Held, pointer: Pointer) {
        let free = || self.channels.iter().position(Option::is_none);
        let Some(channel) = self.channel_of(held).or_else(free) else {
            return;
        };
        match self.channels[channel] {
            Some(before) if before.tool == pointer.tool => {
                self.channels[channel] = Some(pointer);
                if before != pointer || pointer.is_turning() {
                    self.queue(channel, Report::At(pointer));
                }
            }
            Some(_) => {
                self.lift(channel);
                self.channels[channel] = Some(pointer);
                self.come(channel, pointer);
            }
            None => {
                self.channels[channel] = Some(pointer);
                self.come(channel, pointer);
            }
        }
    }

    fn come(&mut self, channel: usize, pointer: Pointer) {
        if self.settings.introductions {
            self.queue(channel, Report::Enter(pointer.tool));
        }
        self.queue(channel, Report::At(pointer));
    }

    fn lift(&mut self, channel: usize) {
        if self.channels[channel].take().is_some() {
            self.queue(channel, Report::Leave);
        }
    }

    /// Adds a report; a place that differs from the last waiting one of its tool in no edge takes its turn. Without
    /// two-tool mode the second tool is not followed.
    fn queue(&mut self, channel: usize, report: Report) {
        if !self.settings.streaming || (channel > 0 && !self.settings.two_tools) {
            return;
        }
        let channel = channel as u8;
        let last = self.pending.iter_mut().rev().find(|(of, _)| *of == channel);
        match (last, report) {
            (Some((_, Report::At(last))), Report::At(next)) if last.has_edges_of(&next) => {
                last.become_later(next);
            }
            _ => self.pending.push_back((channel, report)),
        }
    }
}

#[cfg(test)]
mod tests;
