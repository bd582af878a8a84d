//! A board that speaks Firmata: pots on its analog pins, buttons from its digital pins to ground, encoders where the
//! host attaches them, lamps on its outputs.
//!
//! Opening the port restarts the board: boot loader first, then it says its version and firmware unasked, then it
//! waits to be told what to report. Analog values go out every sampling interval, digital ports when they change.
//! Source: `docs/protocols/firmata.md` (firmata/protocol at 7908873e, protocol.md and encoder.md).

mod board;
mod message;

use crate::dial_box::Output;
use crate::hands::Touch;
use crate::script::Device;
use crate::serial::{Inside, SerialChassis, Wire};
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
pub type Firmata = SerialChassis<Sketch>;

/// The sketch on the board.
#[derive(Clone, Debug)]
pub struct Sketch {
    options: Options,
    next_sample_ns: u64,
    next_loop_ns: u64,
    parser: Parser,
    board: Board,
    reporting: Reporting,
    lit: u32,
    unknown: u64,
}

impl Firmata {
    /// A board that is on and has said its version to nobody.
    pub fn new(options: Options) -> Self {
        let drift_ppm = options.drift_ppm;
        let sketch = Sketch {
            next_sample_ns: 0,
            next_loop_ns: 0,
            parser: Parser::default(),
            board: Board::new(),
            reporting: Reporting::default(),
            lit: 0,
            unknown: 0,
            options,
        };
        Self::around(sketch, BAUD, Parity::None, drift_ppm)
    }

    /// Messages that were not understood.
    pub fn unknown_messages(&self) -> u64 {
        self.inside.unknown
    }
}

impl Inside for Sketch {
    /// The boot loader takes what comes for its own language.
    fn hear(&mut self, wire: &mut Wire, byte: u8) {
        if let Some(message) = self.parser.push(byte) {
            self.obey(wire, message);
        }
    }

    fn next_ns(&self, wire: &Wire) -> Option<u64> {
        if wire.is_booting() {
            return None;
        }
        let sample = self.samples().then_some(self.next_sample_ns);
        let ports = self.watches_ports().then_some(self.next_loop_ns);
        sample.into_iter().chain(ports).min()
    }

    fn happen(&mut self, wire: &mut Wire) {
        let now_ns = wire.now_ns();
        if self.samples() && self.next_sample_ns <= now_ns {
            self.sample(wire);
        } else if self.watches_ports() && self.next_loop_ns <= now_ns {
            self.next_loop_ns = now_ns + LOOP_NS;
            for port in 0..PORTS {
                self.tell_port(wire, port, false);
            }
        }
    }

    fn touch(&mut self, wire: &mut Wire, touch: &Touch) -> bool {
        match *touch {
            Touch::Axis { control, to, over_us } => {
                let channel = self.options.pots.get(usize::from(control)).copied();
                let Some(pot) = channel.and_then(|n| self.board.pots.get_mut(usize::from(n))) else {
                    return false;
                };
                pot.go(wire.now_ns(), to, over_us * 1000);
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
            _ => return false,
        }
        true
    }

    fn lose_power(&mut self, wire: &mut Wire) {
        self.restart(wire);
    }

    fn booted(&mut self, wire: &mut Wire) {
        say_version(wire);
        self.say_firmware(wire);
    }

    fn port_opened(&mut self, wire: &mut Wire) {
        if self.options.restarts_when_opened {
            self.restart(wire);
        }
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

impl Sketch {
    fn samples(&self) -> bool {
        self.reporting.channels != 0 || self.reporting.encoders
    }

    fn watches_ports(&self) -> bool {
        self.reporting.ports != 0
    }

    fn say_firmware(&mut self, wire: &mut Wire) {
        let mut data = VERSION.to_vec();
        data.extend(
            self.options
                .name
                .bytes()
                .flat_map(|byte| [byte & 0x7F, byte >> 7]),
        );
        sysex(wire, 0x79, &data);
    }

    /// What is due every sampling interval.
    fn sample(&mut self, wire: &mut Wire) {
        let interval_ns = u64::from(self.reporting.interval_ms.max(1)) * 1_000_000;
        self.next_sample_ns = wire.now_ns() + wire.span_ns(interval_ns);
        for channel in 0..CHANNELS {
            if self.reporting.channels >> channel & 1 == 1 && self.board.converts(channel) {
                self.tell_channel(wire, channel);
            }
        }
        if self.reporting.encoders {
            self.tell_encoders(wire, 0..board::ENCODERS);
        }
    }

    fn tell_channel(&mut self, wire: &mut Wire, channel: u8) {
        let value = self.board.reading(channel, wire.now_ns());
        wire.say(&[0xE0 | channel, (value & 0x7F) as u8, (value >> 7) as u8]);
    }

    /// Says a port that is reported, if it has changed or `anyway`.
    fn tell_port(&mut self, wire: &mut Wire, port: u8, anyway: bool) {
        let value = self.board.port(port);
        let told = &mut self.reporting.told[usize::from(port)];
        if self.reporting.ports >> port & 1 == 1 && (anyway || *told != Some(value)) {
            *told = Some(value);
            wire.say(&[0x90 | port, value & 0x7F, value >> 7]);
        }
    }

    fn tell_encoders(&mut self, wire: &mut Wire, which: std::ops::Range<usize>) {
        let mut data = Vec::new();
        for number in which {
            if let Some(encoder) = self.board.encoders.get(number).copied().flatten() {
                let away = encoder.position.unsigned_abs();
                data.push(u8::from(encoder.position < 0) << 6 | number as u8);
                data.extend((0..4).map(|seven| (away >> (7 * seven)) as u8 & 0x7F));
            }
        }
        if !data.is_empty() {
            sysex(wire, 0x61, &data);
        }
    }

    fn obey(&mut self, wire: &mut Wire, message: Message) {
        match message {
            Message::Version => say_version(wire),
            Message::Reset => {
                self.board.forget();
                self.reporting = Reporting::default();
            }
            Message::ReportAnalog { channel, on } if channel < CHANNELS => {
                let bit = 1 << channel;
                self.reporting.channels = with_bit(self.reporting.channels, bit, on);
                if on {
                    self.begin_reporting(wire);
                    // Since 2.4.0 the value is told at once.
                    self.tell_channel(wire, channel);
                }
            }
            Message::ReportDigital { port, on } if port < PORTS => {
                self.reporting.ports = with_bit(self.reporting.ports, 1 << port, on);
                if on {
                    self.begin_reporting(wire);
                    self.tell_port(wire, port, true);
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
            Message::Sysex { command, data } => self.obey_sysex(wire, command, &data),
            _ => self.unknown += 1,
        }
        let lit = self.board.lit();
        if lit != self.lit {
            self.lit = lit;
            wire.show(Output::Lamps(lit));
        }
    }

    fn begin_reporting(&mut self, wire: &mut Wire) {
        if self.next_sample_ns < wire.now_ns() {
            self.next_sample_ns = wire.now_ns() + u64::from(self.reporting.interval_ms) * 1_000_000;
        }
        self.next_loop_ns = self.next_loop_ns.max(wire.now_ns());
        wire.begin_script();
    }

    fn write_port(&mut self, port: u8, pins: u8) {
        for bit in 0..8 {
            let pin = port * 8 + bit;
            if pin < PINS && self.board.modes[usize::from(pin)] == mode::OUTPUT {
                self.board.written[usize::from(pin)] = u16::from(pins >> bit & 1);
            }
        }
    }

    fn obey_sysex(&mut self, wire: &mut Wire, command: u8, data: &[u8]) {
        match (command, data) {
            (0x79, []) => self.say_firmware(wire),
            (0x69, []) => {
                let map: Vec<u8> = (0..PINS).map(|pin| Board::channel(pin).unwrap_or(127)).collect();
                sysex(wire, 0x6A, &map);
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
                sysex(wire, 0x6C, &able);
            }
            (0x6D, &[pin]) if pin < PINS => {
                let state = self.board.written[usize::from(pin)];
                let mode = self.board.modes[usize::from(pin)];
                sysex(
                    wire,
                    0x6E,
                    &[pin, mode, (state & 0x7F) as u8, (state >> 7) as u8 & 0x7F],
                );
            }
            (0x6F, &[pin, low, ref more @ ..]) if Board::can(pin, mode::PWM) => {
                let high = more.first().copied().unwrap_or(0);
                self.board.written[usize::from(pin)] = u16::from(low) | u16::from(high) << 7;
            }
            (0x7A, &[low, high]) => self.reporting.interval_ms = u16::from(low) | u16::from(high) << 7,
            (0x61, _) => self.obey_encoder(wire, data),
            _ => self.unknown += 1,
        }
    }

    fn obey_encoder(&mut self, wire: &mut Wire, data: &[u8]) {
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
            [1, n] if there(n) => self.tell_encoders(wire, usize::from(n)..usize::from(n) + 1),
            [2] => self.tell_encoders(wire, 0..board::ENCODERS),
            [3, n] if there(n) => {
                if let Some(encoder) = &mut self.board.encoders[usize::from(n)] {
                    encoder.position = 0;
                }
            }
            [4, on] => {
                self.reporting.encoders = on != 0;
                if on != 0 {
                    self.begin_reporting(wire);
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

    fn restart(&mut self, wire: &mut Wire) {
        self.parser = Parser::default();
        self.reporting = Reporting::default();
        self.board.forget();
        if self.lit != 0 {
            self.lit = 0;
            wire.show(Output::Lamps(0));
        }
        wire.boot(wire.span_ns(BOOT_NS));
    }
}

fn say_version(wire: &mut Wire) {
    let [major, minor] = VERSION;
    wire.say(&[0xF9, major, minor]);
}

fn sysex(wire: &mut Wire, command: u8, data: &[u8]) {
    let mut bytes = vec![0xF0, command];
    bytes.extend_from_slice(data);
    bytes.push(0xF7);
    wire.say(&bytes);
}

fn with_bit(mask: u16, bit: u16, on: bool) -> u16 {
    if on { mask | bit } else { mask & !bit }
}

#[cfg(test)]
mod tests;
