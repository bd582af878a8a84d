//! A board that speaks Firmata: pots on its analog pins, buttons from its digital pins to ground, encoders where the
//! host attaches them, lamps on its outputs.
//!
//! Opening the port restarts the board: boot loader first, then it says its version and firmware unasked, then it
//! waits to be told what to report. Analog values go out every sampling interval, digital ports when they change.
//! Source: `docs/protocols/firmata.md` (firmata/protocol at 7908873e, protocol.md and encoder.md).

mod board;
mod message;

use crate::dial_box::Output;
use crate::firmware::Firmware;
use crate::hands::{Hands, Schedule, Touch, noise};
use crate::line::{Line, shortened};
use crate::script::{Device, Script};
use crate::serial_kinds::SerialDevice;
use crate::uart::Parity;
use board::{Board, CHANNELS, Encoder, PINS, mode};
use device_profiles::{ControlClass, ControlKind, InputProfile, Quirk};
use message::{Message, Parser};

/// Speed of the line.
pub const BAUD: u32 = 57_600;
/// Boot loader and start of the sketch. Ours; people say about two seconds.
const BOOT_NS: u64 = 1_800_000_000;
/// Milliseconds between analog reports, unless the host says otherwise (protocol.md).
const INTERVAL_MS: u16 = 19;
/// How often the sketch's loop looks at its digital pins. Ours: a loop of an Uno takes well under a millisecond.
const LOOP_NS: u64 = 500_000;
/// Ports of eight pins.
const PORTS: u8 = PINS.div_ceil(8);
/// The protocol the board says it speaks.
const VERSION: [u8; 2] = [2, 5];

/// How this board differs from the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// What it calls its firmware.
    pub name: String,
    /// Opening the port restarts it, as most boards do.
    pub restarts_when_opened: bool,
    /// The analog channels of the potentiometers, 0 (A0) to 5, in the order of their numbers.
    pub pots: Vec<u8>,
    /// The pins of the buttons.
    pub buttons: Vec<u8>,
    /// The two pins of each encoder.
    pub encoders: Vec<[u8; 2]>,
    /// Counts in one turn of an encoder, four to each of its clicks.
    pub counts_per_turn: u32,
    /// The board's clock is this many millionths fast.
    pub drift_ppm: i32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            name: "ConfigurableFirmata".to_owned(),
            restarts_when_opened: true,
            pots: vec![0, 1, 2, 3, 4, 5],
            buttons: vec![7, 8, 12, 13],
            encoders: vec![[2, 3]],
            counts_per_turn: 96,
            drift_ppm: 0,
        }
    }
}

impl From<&InputProfile> for Options {
    fn from(profile: &InputProfile) -> Self {
        let pins = |wanted: &dyn Fn(ControlKind) -> bool| -> Vec<u8> {
            let groups = profile.controls.iter().filter(|group| wanted(group.kind));
            groups.flat_map(|group| group.pins.iter().copied()).collect()
        };
        let encoders = pins(&|kind| kind == ControlKind::Dial);
        Self {
            restarts_when_opened: profile.quirks.contains(&Quirk::RestartsOnOpen),
            pots: pins(&|kind| kind.class() == ControlClass::Axis),
            buttons: pins(&|kind| kind == ControlKind::Button),
            encoders: encoders.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect(),
            counts_per_turn: profile.counts_per_turn().round() as u32,
            ..Self::default()
        }
    }
}

/// What the host has switched on.
#[derive(Clone, Copy, Debug)]
struct Reporting {
    channels: u16,
    ports: u16,
    encoders: bool,
    interval_ms: u16,
    told: [Option<u8>; PORTS as usize],
}

impl Default for Reporting {
    fn default() -> Self {
        Self {
            channels: 0,
            ports: 0,
            encoders: false,
            interval_ms: INTERVAL_MS,
            told: [None; PORTS as usize],
        }
    }
}

/// The board, its line, and the hands on it.
#[derive(Clone, Debug)]
pub struct Firmata {
    options: Options,
    line: Line,
    reached_ns: u64,
    /// While the boot loader runs.
    booting_until_ns: Option<u64>,
    next_sample_ns: u64,
    next_loop_ns: u64,
    parser: Parser,
    board: Board,
    reporting: Reporting,
    schedule: Schedule,
    outputs: Vec<(u64, Output)>,
    lit: u32,
    unknown: u64,
}

impl Firmata {
    /// A board that is on and has said its version to nobody.
    pub fn new(options: Options) -> Self {
        Self {
            line: Line::new(BAUD, options.drift_ppm),
            reached_ns: 0,
            booting_until_ns: None,
            next_sample_ns: 0,
            next_loop_ns: 0,
            parser: Parser::default(),
            board: Board::new(),
            reporting: Reporting::default(),
            schedule: Schedule::default(),
            outputs: Vec::new(),
            lit: 0,
            unknown: 0,
            options,
        }
    }

    /// Messages that were not understood.
    pub fn unknown_messages(&self) -> u64 {
        self.unknown
    }

    fn catch_up(&mut self, now_us: u64) -> u64 {
        let now_ns = (now_us * 1000).max(self.reached_ns);
        self.advance(now_ns);
        now_ns
    }

    fn advance(&mut self, to_ns: u64) {
        loop {
            let runs = self.booting_until_ns.is_none();
            let events = [
                self.booting_until_ns,
                self.line.next_arrival_ns(),
                self.schedule.next_ns(),
                (runs && self.samples()).then_some(self.next_sample_ns),
                (runs && self.watches_ports()).then_some(self.next_loop_ns),
            ];
            let Some(at_ns) = events.into_iter().flatten().min().filter(|&at| at <= to_ns) else {
                break;
            };
            self.reached_ns = self.reached_ns.max(at_ns);
            self.happen(runs);
        }
        self.reached_ns = self.reached_ns.max(to_ns);
    }

    fn happen(&mut self, runs: bool) {
        let at_ns = self.reached_ns;
        if self.booting_until_ns.is_some_and(|until| until <= at_ns) {
            self.booting_until_ns = None;
            self.say_version();
            self.say_firmware();
        } else if let Some((_, byte)) = self.line.arrival(at_ns) {
            // The boot loader takes what comes for its own language.
            if runs && let Some(message) = self.parser.push(byte) {
                self.obey(message);
            }
        } else if self.schedule.next_ns().is_some_and(|due| due <= at_ns) {
            if let Some(touch) = self.schedule.pop() {
                self.touch_now(&touch);
            }
        } else if runs && self.samples() && self.next_sample_ns <= at_ns {
            self.sample();
        } else if runs && self.watches_ports() && self.next_loop_ns <= at_ns {
            self.next_loop_ns = at_ns + LOOP_NS;
            for port in 0..PORTS {
                self.tell_port(port, false);
            }
        }
    }

    fn samples(&self) -> bool {
        self.reporting.channels != 0 || self.reporting.encoders
    }

    fn watches_ports(&self) -> bool {
        self.reporting.ports != 0
    }

    fn send(&mut self, bytes: &[u8]) {
        self.line.device_sends(self.reached_ns, bytes);
    }

    fn sysex(&mut self, command: u8, data: &[u8]) {
        let mut bytes = vec![0xF0, command];
        bytes.extend_from_slice(data);
        bytes.push(0xF7);
        self.send(&bytes);
    }

    fn say_version(&mut self) {
        let [major, minor] = VERSION;
        self.send(&[0xF9, major, minor]);
    }

    fn say_firmware(&mut self) {
        let mut data = VERSION.to_vec();
        data.extend(
            self.options
                .name
                .bytes()
                .flat_map(|byte| [byte & 0x7F, byte >> 7]),
        );
        self.sysex(0x79, &data);
    }

    /// What is due every sampling interval.
    fn sample(&mut self) {
        let interval_ns = u64::from(self.reporting.interval_ms.max(1)) * 1_000_000;
        self.next_sample_ns = self.reached_ns + shortened(interval_ns, self.options.drift_ppm);
        for channel in 0..CHANNELS {
            if self.reporting.channels >> channel & 1 == 1 && self.board.converts(channel) {
                self.tell_channel(channel);
            }
        }
        if self.reporting.encoders {
            self.tell_encoders(0..board::ENCODERS);
        }
    }

    fn tell_channel(&mut self, channel: u8) {
        let value = self.board.reading(channel, self.reached_ns);
        self.send(&[0xE0 | channel, (value & 0x7F) as u8, (value >> 7) as u8]);
    }

    /// Says a port that is reported, if it has changed or `anyway`.
    fn tell_port(&mut self, port: u8, anyway: bool) {
        let value = self.board.port(port);
        let told = &mut self.reporting.told[usize::from(port)];
        if self.reporting.ports >> port & 1 == 1 && (anyway || *told != Some(value)) {
            *told = Some(value);
            self.send(&[0x90 | port, value & 0x7F, value >> 7]);
        }
    }

    fn tell_encoders(&mut self, which: std::ops::Range<usize>) {
        let mut data = Vec::new();
        for number in which {
            if let Some(encoder) = self.board.encoders.get(number).copied().flatten() {
                let away = encoder.position.unsigned_abs();
                data.push(u8::from(encoder.position < 0) << 6 | number as u8);
                data.extend((0..4).map(|seven| (away >> (7 * seven)) as u8 & 0x7F));
            }
        }
        if !data.is_empty() {
            self.sysex(0x61, &data);
        }
    }

    fn obey(&mut self, message: Message) {
        match message {
            Message::Version => self.say_version(),
            Message::Reset => {
                self.board.forget();
                self.reporting = Reporting::default();
            }
            Message::ReportAnalog { channel, on } if channel < CHANNELS => {
                let bit = 1 << channel;
                self.reporting.channels = with_bit(self.reporting.channels, bit, on);
                if on {
                    self.begin_reporting();
                    // Since 2.4.0 the value is told at once.
                    self.tell_channel(channel);
                }
            }
            Message::ReportDigital { port, on } if port < PORTS => {
                self.reporting.ports = with_bit(self.reporting.ports, 1 << port, on);
                if on {
                    self.begin_reporting();
                    self.tell_port(port, true);
                }
            }
            Message::PinMode { pin, mode } if Board::can(pin, mode) => {
                self.board.modes[usize::from(pin)] = mode;
                self.board.written[usize::from(pin)] = 0;
            }
            Message::SetPin { pin, on } if Board::can(pin, mode::OUTPUT) => {
                self.board.written[usize::from(pin)] = u16::from(on);
            }
            Message::Digital { port, pins } if port < PORTS => self.write_port(port, pins),
            Message::Analog { channel, value } if Board::can(channel, mode::PWM) => {
                self.board.written[usize::from(channel)] = value;
            }
            Message::Sysex { command, data } => self.obey_sysex(command, &data),
            _ => self.unknown += 1,
        }
        let lit = self.board.lit();
        if lit != self.lit {
            self.lit = lit;
            self.outputs.push((self.reached_ns / 1000, Output::Lamps(lit)));
        }
    }

    fn begin_reporting(&mut self) {
        if self.next_sample_ns < self.reached_ns {
            self.next_sample_ns = self.reached_ns + u64::from(self.reporting.interval_ms) * 1_000_000;
        }
        self.next_loop_ns = self.next_loop_ns.max(self.reached_ns);
        self.schedule.begin(self.reached_ns);
    }

    fn write_port(&mut self, port: u8, pins: u8) {
        for bit in 0..8 {
            let pin = port * 8 + bit;
            if pin < PINS && self.board.modes[usize::from(pin)] == mode::OUTPUT {
                self.board.written[usize::from(pin)] = u16::from(pins >> bit & 1);
            }
        }
    }

    fn obey_sysex(&mut self, command: u8, data: &[u8]) {
        match (command, data) {
            (0x79, []) => self.say_firmware(),
            (0x69, []) => {
                let map: Vec<u8> = (0..PINS).map(|pin| Board::channel(pin).unwrap_or(127)).collect();
                self.sysex(0x6A, &map);
            }
            (0x6B, []) => {
                let mut able = Vec::new();
                for pin in 0..PINS {
                    able.extend(
                        Board::abilities(pin)
                            .into_iter()
                            .flat_map(|(mode, bits)| [mode, bits]),
                    );
                    able.push(0x7F);
                }
                self.sysex(0x6C, &able);
            }
            (0x6D, &[pin]) if pin < PINS => {
                let state = self.board.written[usize::from(pin)];
                let mode = self.board.modes[usize::from(pin)];
                self.sysex(
                    0x6E,
                    &[pin, mode, (state & 0x7F) as u8, (state >> 7) as u8 & 0x7F],
                );
            }
            (0x6F, &[pin, low, ref more @ ..]) if Board::can(pin, mode::PWM) => {
                let high = more.first().copied().unwrap_or(0);
                self.board.written[usize::from(pin)] = u16::from(low) | u16::from(high) << 7;
            }
            (0x7A, &[low, high]) => self.reporting.interval_ms = u16::from(low) | u16::from(high) << 7,
            (0x61, _) => self.obey_encoder(data),
            _ => self.unknown += 1,
        }
    }

    fn obey_encoder(&mut self, data: &[u8]) {
        let there = |n: u8| usize::from(n) < board::ENCODERS;
        match *data {
            [0, n, a, b] if there(n) && [a, b].iter().all(|&pin| Board::can(pin, mode::ENCODER)) => {
                for pin in [a, b] {
                    self.board.modes[usize::from(pin)] = mode::ENCODER;
                }
                self.board.encoders[usize::from(n)] = Some(Encoder {
                    pins: [a, b],
                    position: 0,
                });
            }
            [1, n] if there(n) => self.tell_encoders(usize::from(n)..usize::from(n) + 1),
            [2] => self.tell_encoders(0..board::ENCODERS),
            [3, n] if there(n) => {
                if let Some(encoder) = &mut self.board.encoders[usize::from(n)] {
                    encoder.position = 0;
                }
            }
            [4, on] => {
                self.reporting.encoders = on != 0;
                if on != 0 {
                    self.begin_reporting();
                }
            }
            [5, n] if there(n) => {
                if let Some(encoder) = self.board.encoders[usize::from(n)].take() {
                    for pin in encoder.pins {
                        self.board.modes[usize::from(pin)] = mode::INPUT;
                    }
                }
            }
            _ => self.unknown += 1,
        }
    }

    fn restart(&mut self) {
        self.line.device_stops(self.reached_ns);
        self.parser = Parser::default();
        self.reporting = Reporting::default();
        self.board.forget();
        if self.lit != 0 {
            self.lit = 0;
            self.outputs.push((self.reached_ns / 1000, Output::Lamps(0)));
        }
        self.booting_until_ns = Some(self.reached_ns + shortened(BOOT_NS, self.options.drift_ppm));
    }

    fn touch_now(&mut self, touch: &Touch) -> bool {
        match *touch {
            Touch::Axis { control, to, over_us } => {
                let channel = self.options.pots.get(usize::from(control)).copied();
                let Some(pot) = channel.and_then(|n| self.board.pots.get_mut(usize::from(n))) else {
                    return false;
                };
                pot.go(self.reached_ns, to, over_us * 1000);
            }
            Touch::Button { control, down } => {
                let Some(&pin) = self.options.buttons.get(usize::from(control)) else {
                    return false;
                };
                self.board.press(pin, down);
            }
            // A turn is made at once: what the host sees of it is the difference at the next sampling.
            Touch::Dial { control, by, .. } => {
                let Some(&pins) = self.options.encoders.get(usize::from(control)) else {
                    return false;
                };
                self.board.turn(pins, by.counts(self.options.counts_per_turn));
            }
            Touch::PowerCycle => self.restart(),
            Touch::Noise(bytes) => self.send(&noise(bytes)),
            _ => return false,
        }
        true
    }
}

fn with_bit(mask: u16, bit: u16, on: bool) -> u16 {
    if on { mask | bit } else { mask & !bit }
}

impl Firmware for Firmata {
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

    fn port_opened(&mut self, now_us: u64) {
        self.catch_up(now_us);
        if self.options.restarts_when_opened {
            self.restart();
        }
    }

    fn next_byte_us(&self) -> Option<u64> {
        self.line.next_delivery_ns().map(|ns| ns.div_ceil(1000))
    }
}

impl Hands for Firmata {
    fn touch(&mut self, now_us: u64, touch: &Touch) -> bool {
        self.catch_up(now_us);
        self.touch_now(touch)
    }

    fn reporting_since_us(&self) -> Option<u64> {
        self.schedule.since_us()
    }
}

impl SerialDevice for Firmata {
    fn play(&mut self, script: &Script) {
        self.schedule.play(script);
    }

    fn script_is_done(&self) -> bool {
        self.schedule.is_done()
    }

    fn drain_outputs(&mut self, take: &mut dyn FnMut(u64, Output)) {
        for (at_us, output) in self.outputs.drain(..) {
            take(at_us, output);
        }
    }

    fn line(&self) -> (u32, Parity) {
        (BAUD, Parity::None)
    }

    fn controls(&self) -> Device {
        let count = |wired: usize| u8::try_from(wired).unwrap_or(u8::MAX);
        Device::Controls {
            dials: count(self.options.encoders.len()),
            buttons: count(self.options.buttons.len()),
            axes: count(self.options.pots.len()),
        }
    }
}

#[cfg(test)]
mod tests;
