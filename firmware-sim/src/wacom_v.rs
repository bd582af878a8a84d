//! A Wacom Intuos or Intuos 2 on a serial line: protocol V, two tools at once, each with an id and a serial number.
//!
//! It begins at 9600 baud and goes to 19200 or, from ROM 2.0, 38400 when told to; it hears only the speed it is at,
//! is deaf while it resets or changes speed, and sends at most what the wire carries and the interval allows:
//! positions of a tool between two packets are merged, changes of buttons and comings and goings never are.
//! Source: `docs/protocols/wacom-v.md` (xf86-input-wacom, `wcmSerial.c`).

mod command;
mod packet;

use crate::firmware::Firmware;
use crate::hands::{Hands, Held, Schedule, Touch, noise};
use crate::line::{Line, shortened};
use crate::script::{Device, Script};
use crate::serial_kinds::SerialDevice;
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
#[derive(Clone, Debug)]
pub struct WacomV {
    model: Model,
    drift_ppm: i32,
    line: Line,
    reached_ns: u64,
    deaf_until_ns: u64,
    parser: Parser,
    settings: Settings,
    /// The tools near the surface: a pen in channel 0 or 1, a puck in the other.
    channels: [Option<Pointer>; CHANNELS],
    pending: VecDeque<(u8, Report)>,
    next_packet_ns: u64,
    schedule: Schedule,
    unknown: u64,
}

impl WacomV {
    /// A tablet switched on a while ago, not yet told to report; its clock is `drift_ppm` millionths fast.
    pub fn new(model: Model, drift_ppm: i32) -> Self {
        Self {
            model,
            drift_ppm,
            line: Line::new(BAUD, drift_ppm),
            reached_ns: 0,
            deaf_until_ns: 0,
            parser: Parser::default(),
            settings: Settings::default(),
            channels: [None; CHANNELS],
            pending: VecDeque::new(),
            next_packet_ns: 0,
            schedule: Schedule::default(),
            unknown: 0,
        }
    }

    /// The speed it speaks and hears at now.
    pub fn baud(&self) -> u32 {
        self.line.device_baud()
    }

    /// Whether the host has switched reporting on and not off again.
    pub fn is_streaming(&self) -> bool {
        self.settings.streaming
    }

    /// Commands that were not understood.
    pub fn unknown_commands(&self) -> u64 {
        self.unknown
    }

    fn catch_up(&mut self, now_us: u64) -> u64 {
        let now_ns = (now_us * 1000).max(self.reached_ns);
        self.advance(now_ns);
        now_ns
    }

    /// Lets everything happen, in its order, that happens up to `to_ns`.
    fn advance(&mut self, to_ns: u64) {
        loop {
            let slot = (self.settings.streaming && !self.pending.is_empty()).then(|| {
                self.line
                    .device_free_ns()
                    .max(self.next_packet_ns)
                    .max(self.reached_ns)
            });
            let events = [self.line.next_arrival_ns(), self.schedule.next_ns(), slot];
            let Some(at_ns) = events.into_iter().flatten().min().filter(|&at| at <= to_ns) else {
                break;
            };
            self.reached_ns = self.reached_ns.max(at_ns);
            if let Some((at, byte)) = self.line.arrival(self.reached_ns) {
                self.hear(at, byte);
            } else if self.schedule.next_ns().is_some_and(|due| due <= self.reached_ns) {
                if let Some(touch) = self.schedule.pop() {
                    self.touch_now(&touch);
                }
            } else if let Some((channel, report)) = self.pending.pop_front() {
                self.say(channel, report);
            }
        }
        self.reached_ns = self.reached_ns.max(to_ns);
    }

    fn say(&mut self, channel: u8, report: Report) {
        let at_ns = self.reached_ns;
        match report {
            Report::Enter(tool) => self.line.device_sends(at_ns, &packet::enter(tool, channel)),
            Report::Leave => self.line.device_sends(at_ns, &packet::leave(channel)),
            Report::At(pointer) => {
                for packet in pointer.packets(channel, self.model.puck) {
                    self.line.device_sends(at_ns, &packet);
                }
            }
        }
        let interval_ns = u64::from(self.settings.interval) * INTERVAL_NS;
        self.next_packet_ns = at_ns + shortened(interval_ns, self.drift_ppm);
    }

    fn hear(&mut self, at_ns: u64, byte: u8) {
        if at_ns < self.deaf_until_ns {
            return;
        }
        let Some(command) = self.parser.push(byte) else {
            return;
        };
        match command {
            Command::ResetBaud => self.reset(at_ns + RESET_BAUD_NS, BAUD),
            Command::Reset => {
                let baud = self.line.device_baud();
                self.reset(at_ns + RESET_NS, baud);
                self.start();
            }
            Command::Identify => {
                let answer = format!("~#{},V{}\r", self.model.text, self.model.version);
                self.line.device_sends(at_ns, answer.as_bytes());
            }
            Command::Resolution => {
                let lines = self.model.counts_per_inch;
                let answer = format!("~RE203C900,002,02,{lines},{lines}\r");
                self.line.device_sends(at_ns, answer.as_bytes());
            }
            Command::Size => {
                let [x, y] = self.model.max;
                self.line.device_sends(at_ns, format!("~C{x},{y}\r").as_bytes());
            }
            Command::Start => {
                self.schedule.begin(at_ns);
                self.start();
            }
            Command::Stop => {
                self.settings.streaming = false;
                self.pending.clear();
            }
            Command::Baud(baud) if self.model.goes_to(baud) => {
                self.line.set_device_baud(baud);
                self.deaf_until_ns = at_ns + RESET_NS;
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

    fn reset(&mut self, deaf_until_ns: u64, baud: u32) {
        self.deaf_until_ns = deaf_until_ns;
        self.settings = Settings::default();
        self.parser = Parser::default();
        self.pending.clear();
        self.next_packet_ns = deaf_until_ns;
        self.line.set_device_baud(baud);
    }

    fn touch_now(&mut self, touch: &Touch) -> bool {
        match touch {
            Touch::Pen(pen) => self.hold(Held::Pen, Pointer::pen(pen, &self.model)),
            Touch::Puck(puck) => self.hold(Held::Puck, Pointer::puck(puck, &self.model)),
            Touch::Away => (0..CHANNELS).for_each(|channel| self.lift(channel)),
            Touch::Lift(held) => {
                if let Some(channel) = self.channel_of(*held) {
                    self.lift(channel);
                }
            }
            Touch::PowerCycle => {
                self.line.device_stops(self.reached_ns);
                self.reset(self.reached_ns + RESET_BAUD_NS, BAUD);
            }
            Touch::Noise(bytes) => self.line.device_sends(self.reached_ns, &noise(*bytes)),
            Touch::Dial { .. } | Touch::Button { .. } | Touch::Axis { .. } | Touch::Ring { .. } => {
                return false;
            }
        }
        true
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

impl Firmware for WacomV {
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

impl Hands for WacomV {
    fn touch(&mut self, now_us: u64, touch: &Touch) -> bool {
        let now_ns = self.catch_up(now_us);
        let touched = self.touch_now(touch);
        self.advance(now_ns);
        touched
    }

    fn reporting_since_us(&self) -> Option<u64> {
        self.schedule.since_us()
    }
}

impl SerialDevice for WacomV {
    fn play(&mut self, script: &Script) {
        self.schedule.play(script);
    }

    fn script_is_done(&self) -> bool {
        self.schedule.is_done()
    }

    fn line(&self) -> (u32, Parity) {
        (BAUD, Parity::None)
    }

    fn controls(&self) -> Device {
        Device::Tablet
    }
}

#[cfg(test)]
mod tests;
