//! A Wacom tablet with serial protocol IV at 9600 baud: commands in ASCII, packets of 7 or 9 bytes.
//!
//! It hears only its own speed, is deaf while it resets, answers `~#` at once and `~R`, `~C` at the
//! carriage return, and sends at most what the wire carries and the interval allows: positions between two
//! packets are merged, changes of buttons and nearness never are.
//! Source: `docs/protocols/wacom-iv.md` (Linux `wacom_serial4.c`, xf86-input-wacom `wcmSerial.c`).

mod command;
mod packet;

use crate::hands::Touch;
use crate::script::Device;
use crate::serial::{Inside, SerialChassis, Wire};
use crate::uart::Parity;
use command::{Command, Parser};
use device_profiles::InputProfile;
use packet::{Pointer, Scale};
use std::collections::VecDeque;

/// Speed of the line.
pub const BAUD: u32 = 9600;
/// How long `$` leaves the tablet deaf. Ours, within the 250 ms that drivers wait after it.
const RESET_BAUD_NS: u64 = 200_000_000;
/// How long `#` leaves the tablet deaf. Ours, within the 75 ms that drivers wait after it.
const RESET_NS: u64 = 60_000_000;
/// Unit of `IT`.
const INTERVAL_NS: u64 = 5_000_000;

/// What tells one model from another on the wire.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Model {
    /// Answer to `~#` before the version; its first two letters say the family.
    pub text: String,
    /// ROM version as in the answer.
    pub version: String,
    /// Lines per inch, x and y.
    pub resolution: [u32; 2],
    /// Largest x and y.
    pub max: [u32; 2],
    /// Largest pressure: 511 (nine bits), 255 (eight) or less (seven).
    pub pressure_max: u16,
    /// The button bit an eraser sets.
    pub eraser_bit: u8,
    /// Takes `FM1` and then reports tilt.
    pub tilt: bool,
    /// Answers `~C`; a Graphire does not.
    pub answers_size: bool,
    /// Its puck has a wheel.
    pub wheel: bool,
}

impl From<&InputProfile> for Model {
    fn from(profile: &InputProfile) -> Self {
        let wacom = profile.wacom.clone().unwrap_or_default();
        let area = profile.area();
        Self {
            text: wacom.model,
            version: wacom.version,
            resolution: area.counts_per_inch.unwrap_or_default(),
            max: area.counts,
            pressure_max: u16::try_from(area.pressure).unwrap_or(u16::MAX),
            eraser_bit: wacom.eraser_bit.min(3),
            tilt: area.tilt(),
            answers_size: wacom.answers_size,
            wheel: profile.tools.iter().any(|tool| tool.wheel == Some(true)),
        }
    }
}

/// The tablet, its line, and the hand over it.
pub type WacomIv = SerialChassis<Tablet>;

/// What is in the tablet.
#[derive(Clone, Debug)]
pub struct Tablet {
    model: Model,
    deaf_until_ns: u64,
    parser: Parser,
    settings: Settings,
    pointer: Option<Pointer>,
    pending: VecDeque<Pointer>,
    next_packet_ns: u64,
    unknown: u64,
}

/// What commands change.
#[derive(Clone, Debug, Default)]
struct Settings {
    streaming: bool,
    tilt: bool,
    scale: Scale,
    interval: u32,
    suppress_counts: u32,
}

impl WacomIv {
    /// A tablet switched on a while ago, not yet told to report; its clock is `drift_ppm` millionths fast.
    pub fn new(model: Model, drift_ppm: i32) -> Self {
        let tablet = Tablet {
            settings: Settings {
                scale: Scale::of(&model),
                ..Settings::default()
            },
            model,
            deaf_until_ns: 0,
            parser: Parser::default(),
            pointer: None,
            pending: VecDeque::new(),
            next_packet_ns: 0,
            unknown: 0,
        };
        Self::around(tablet, BAUD, Parity::None, drift_ppm)
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
        let Some(pointer) = self.pending.pop_front() else {
            return;
        };
        let (packet, len) = packet::packet(&pointer, &self.settings.scale, self.settings.tilt);
        wire.say(&packet[..len]);
        let interval_ns = u64::from(self.settings.interval) * INTERVAL_NS;
        self.next_packet_ns = wire.now_ns() + wire.span_ns(interval_ns);
    }

    fn touch(&mut self, _wire: &mut Wire, touch: &Touch) -> bool {
        let next = match touch {
            Touch::Pen(pen) => Some(Pointer::pen(pen, self.model.eraser_bit)),
            Touch::Puck(puck) => Some(Pointer::puck(puck, self.model.wheel)),
            Touch::Away | Touch::Lift(_) => None,
            _ => return false,
        };
        let before = self.pointer;
        self.pointer = next;
        if let Some(left) = before.filter(|before| next.is_none_or(|next| next.stylus != before.stylus)) {
            self.queue(left.leaving());
        }
        if let Some(next) = next {
            let still = before.is_some_and(|before| {
                before.is_near(&next, &self.settings.scale, self.settings.suppress_counts)
            });
            if !still {
                self.queue(next);
            }
        }
        true
    }

    fn lose_power(&mut self, wire: &mut Wire) {
        self.reset(wire.now_ns() + RESET_BAUD_NS, false);
    }

    fn controls(&self) -> Device {
        Device::Tablet
    }
}

impl Tablet {
    fn obey(&mut self, wire: &mut Wire, command: Command) {
        let now_ns = wire.now_ns();
        match command {
            Command::ResetBaud => self.reset(now_ns + RESET_BAUD_NS, false),
            // A reset tablet streams, which is why drivers follow it with `SP`.
            Command::Reset => self.reset(now_ns + RESET_NS, true),
            Command::Identify => {
                let answer = format!("~#{},V{}\r", self.model.text, self.model.version);
                wire.say(answer.as_bytes());
            }
            Command::Resolution => {
                let [x, y] = self.model.resolution;
                wire.say(format!("~RE202C900,002,02,{x},{y}\r").as_bytes());
            }
            Command::Size if !self.model.answers_size => self.unknown += 1,
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
            Command::UpperOrigin(on) => self.settings.scale.upper_origin = on,
            Command::Pressure(on) => self.settings.scale.pressure = on,
            Command::Tilt(on) => self.settings.tilt = on && self.model.tilt,
            Command::Interval(units) => self.settings.interval = units,
            Command::Suppress(counts) => self.settings.suppress_counts = counts,
            Command::Accepted => {}
            Command::Unknown => self.unknown += 1,
        }
    }

    fn start(&mut self) {
        self.settings.streaming = true;
        self.pending.clear();
        self.pending.extend(self.pointer);
    }

    fn reset(&mut self, deaf_until_ns: u64, streaming: bool) {
        self.deaf_until_ns = deaf_until_ns;
        self.settings = Settings {
            scale: Scale::of(&self.model),
            ..Settings::default()
        };
        self.parser = Parser::default();
        self.pending.clear();
        self.next_packet_ns = deaf_until_ns;
        if streaming {
            self.start();
        }
    }

    /// Adds a report; one that differs from the last waiting only in place, pressure or wheel takes its place.
    fn queue(&mut self, pointer: Pointer) {
        if !self.settings.streaming {
            return;
        }
        match self.pending.back_mut() {
            Some(last) if last.has_edges_of(&pointer) => last.become_later(pointer),
            _ => self.pending.push_back(pointer),
        }
    }
}

#[cfg(test)]
mod tests;
