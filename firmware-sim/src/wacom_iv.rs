//! A Wacom tablet with serial protocol IV at 9600 baud: commands in ASCII, packets of 7 or 9 bytes.
//!
//! It hears only its own speed, is deaf while it resets, answers `~#` at once and `~R`, `~C` at the
//! carriage return, and sends at most what the wire carries and the interval allows: positions between two
//! packets are merged, changes of buttons and nearness never are.
//! Source: `docs/protocols/wacom-iv.md` (Linux `wacom_serial4.c`, xf86-input-wacom `wcmSerial.c`).

mod command;
mod packet;

use crate::firmware::Firmware;
use crate::hands::{Hands, Schedule, Touch, noise};
use crate::line::{Line, shortened};
use crate::script::Script;
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
#[derive(Clone, Debug)]
pub struct WacomIv {
    model: Model,
    drift_ppm: i32,
    line: Line,
    reached_ns: u64,
    deaf_until_ns: u64,
    parser: Parser,
    settings: Settings,
    pointer: Option<Pointer>,
    pending: VecDeque<Pointer>,
    next_packet_ns: u64,
    schedule: Schedule,
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
        Self {
            settings: Settings {
                scale: Scale::of(&model),
                ..Settings::default()
            },
            model,
            drift_ppm,
            line: Line::new(BAUD, drift_ppm),
            reached_ns: 0,
            deaf_until_ns: 0,
            parser: Parser::default(),
            pointer: None,
            pending: VecDeque::new(),
            next_packet_ns: 0,
            schedule: Schedule::default(),
            unknown: 0,
        }
    }

    /// Plays `script` as well, its times counted from the first `ST`.
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
            } else if let Some(pointer) = self.pending.pop_front() {
                self.report(&pointer);
            }
        }
        self.reached_ns = self.reached_ns.max(to_ns);
    }

    fn report(&mut self, pointer: &Pointer) {
        let at_ns = self.reached_ns;
        let (packet, len) = packet::packet(pointer, &self.settings.scale, self.settings.tilt);
        self.line.device_sends(at_ns, &packet[..len]);
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
            Command::ResetBaud => self.reset(at_ns + RESET_BAUD_NS, false),
            // A reset tablet streams, which is why drivers follow it with `SP`.
            Command::Reset => self.reset(at_ns + RESET_NS, true),
            Command::Identify => {
                let answer = format!("~#{},V{}\r", self.model.text, self.model.version);
                self.answer(at_ns, &answer);
            }
            Command::Resolution => {
                let [x, y] = self.model.resolution;
                self.answer(at_ns, &format!("~RE202C900,002,02,{x},{y}\r"));
            }
            Command::Size if !self.model.answers_size => self.unknown += 1,
            Command::Size => {
                let [x, y] = self.model.max;
                self.answer(at_ns, &format!("~C{x},{y}\r"));
            }
            Command::Start => {
                self.schedule.begin(at_ns);
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

    fn answer(&mut self, at_ns: u64, text: &str) {
        self.line.device_sends(at_ns, text.as_bytes());
    }

    fn touch_now(&mut self, touch: &Touch) -> bool {
        let next = match touch {
            Touch::Pen(pen) => Some(Pointer::pen(pen, self.model.eraser_bit)),
            Touch::Puck(puck) => Some(Pointer::puck(puck, self.model.wheel)),
            Touch::Away | Touch::Lift(_) => None,
            Touch::PowerCycle => {
                self.line.device_stops(self.reached_ns);
                self.reset(self.reached_ns + RESET_BAUD_NS, false);
                return true;
            }
            Touch::Noise(bytes) => {
                self.line.device_sends(self.reached_ns, &noise(*bytes));
                return true;
            }
            Touch::Dial { .. } | Touch::Button { .. } | Touch::Axis { .. } | Touch::Ring { .. } => {
                return false;
            }
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

impl Firmware for WacomIv {
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

impl Hands for WacomIv {
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

#[cfg(test)]
mod tests;
