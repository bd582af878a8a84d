//! Firmata 2: potentiometers, switches, encoders and lamps on a microcontroller whose pins the host configures.
//!
//! Source: `docs/protocols/firmata.md`.

mod board;
mod message;
mod shown;

use super::dialogue::{Dialogue, Silence, Turn};
use super::{Codec, Counters, Feedback, InputEvent, Outgoing};
use crate::clock::Instant;
use board::Board;
use message::{Message, Messages};
use shown::Shown;

/// How long an answer may take; a thousand bytes of capabilities need 174 ms at 57600 baud.
const ANSWER_LIMIT_MS: u64 = 1_000;
/// The protocol's own interval of reports, milliseconds.
pub const INTERVAL_MS: u16 = 19;

/// What a profile says of a board and what is on its pins. Controls are numbered in the order given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Analog channels: axes.
    pub analog: Vec<u8>,
    /// The value that axes are scaled to, whatever the board's converter has.
    pub analog_max: i32,
    /// Switches: buttons.
    pub digital: Vec<Switch>,
    /// Pins A and B of encoders, at most five: dials.
    pub encoders: Vec<[u8; 2]>,
    /// Lamps.
    pub lamps: Vec<Lamp>,
    /// Milliseconds from one report to the next.
    pub interval_ms: u16,
    /// Milliseconds that a board which was reset by opening its port may need to speak.
    pub boot_wait_ms: u64,
}

/// A switch on a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switch {
    /// The pin.
    pub pin: u8,
    /// Between pin and ground, with the board's own pull-up: pressed reads low.
    pub pull_up: bool,
}

/// A lamp on a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lamp {
    /// The pin.
    pub pin: u8,
    /// It can be dimmed.
    pub dimmed: bool,
}

/// What the board is asked, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Question {
    /// Nothing: a board that was reset announces itself.
    Boot,
    Version,
    Firmware,
    Capabilities,
    AnalogMapping,
}

/// The host's side of the board.
#[derive(Debug)]
pub struct Firmata {
    settings: Settings,
    dialogue: Dialogue<Question>,
    known: bool,
    /// The board has announced itself although it was running.
    surprised: bool,
    identity: Option<String>,
    messages: Messages,
    board: Board,
    axes: Vec<Option<i32>>,
    down: Vec<bool>,
    positions: Vec<Option<i32>>,
    shown: Shown,
    counters: Counters,
}

impl Firmata {
    /// For a board that has yet to be asked.
    pub fn new(settings: Settings) -> Self {
        Self {
            dialogue: Dialogue::new(opening(settings.boot_wait_ms)),
            known: false,
            surprised: false,
            identity: None,
            messages: Messages::default(),
            board: Board::default(),
            axes: vec![None; settings.analog.len()],
            down: vec![false; settings.digital.len()],
            positions: vec![None; settings.encoders.len()],
            shown: Shown::new(&settings.lamps),
            counters: Counters::default(),
            settings,
        }
    }

    /// For a recording that begins when the board already reports.
    pub fn listening(settings: Settings) -> Self {
        let mut codec = Self::new(settings);
        codec.dialogue = codec.dialogue.skipped();
        codec.known = true;
        codec
    }

    fn take(&mut self, message: Message, emit: &mut dyn FnMut(InputEvent)) {
        let well = match message {
            Message::Version { major: 2, .. } => {
                match self.dialogue.question() {
                    Some(Question::Boot | Question::Version) => self.dialogue.answered(),
                    _ => self.surprised |= self.dialogue.is_over(),
                }
                true
            }
            // Another generation of the protocol, or no Firmata at all.
            Message::Version { .. } => false,
            Message::Analog { channel, value } => self.turned(channel, value, emit),
            Message::Digital { port, levels } => self.switched(port, levels, emit),
            Message::Sysex => self.take_sysex(emit),
        };
        if well {
            self.counters.reports += 1;
        } else {
            self.counters.rejected += 1;
        }
    }

    fn take_sysex(&mut self, emit: &mut dyn FnMut(InputEvent)) -> bool {
        let Some((&command, rest)) = self.messages.sysex().split_first() else {
            return false;
        };
        let answers = match command {
            message::FIRMWARE => {
                let name = self.identity.take().unwrap_or_default();
                self.identity = message::firmware_name(rest, name);
                Question::Firmware
            }
            message::CAPABILITIES => {
                self.board.learn_capabilities(rest);
                Question::Capabilities
            }
            message::ANALOG_MAPPING => {
                self.board.learn_mapping(rest);
                Question::AnalogMapping
            }
            message::ENCODERS => return self.stepped(emit),
            message::EXTENDED_ANALOG => {
                let told =
                    message::extended_analog(rest).map(|(pin, value)| (self.board.channel_of(pin), value));
                return match told {
                    Some((Some(channel), value)) => self.turned(channel, value, emit),
                    Some((None, _)) => true,
                    None => false,
                };
            }
            // Text for people, states of pins, and what other features send.
            _ => return true,
        };
        if self.dialogue.question() == Some(answers) {
            self.dialogue.answered();
        }
        true
    }

    fn turned(&mut self, channel: u8, raw: u32, emit: &mut dyn FnMut(InputEvent)) -> bool {
        let value = self.board.scaled(channel, raw, self.settings.analog_max);
        let running = self.dialogue.is_over();
        let channels = (0..).zip(&self.settings.analog).zip(&mut self.axes);
        for ((control, _), told) in channels.filter(|((_, on), _)| **on == channel && running) {
            if told.replace(value) != Some(value) {
                emit(InputEvent::Axis { control, value });
            }
        }
        true
    }

    fn switched(&mut self, port: u8, levels: u8, emit: &mut dyn FnMut(InputEvent)) -> bool {
        let running = self.dialogue.is_over();
        let switches = (0..).zip(&self.settings.digital).zip(&mut self.down);
        for ((control, switch), down) in switches.filter(|((_, on), _)| on.pin / 8 == port && running) {
            let high = levels >> (switch.pin % 8) & 1 == 1;
            let pressed = high != switch.pull_up;
            if *down != pressed {
                *down = pressed;
                emit(InputEvent::Button {
                    control,
                    down: pressed,
                });
            }
        }
        true
    }

    /// Positions of some or all encoders, five bytes each.
    fn stepped(&mut self, emit: &mut dyn FnMut(InputEvent)) -> bool {
        let Some((_, rest)) = self.messages.sysex().split_first() else {
            return false;
        };
        for group in rest.chunks(5) {
            let Some((encoder, position)) = message::encoder(group) else {
                return false;
            };
            let Some(before) = self.positions.get_mut(usize::from(encoder)) else {
                return false;
            };
            let delta_counts = before.map_or(0, |before| position - before);
            *before = Some(position);
            if delta_counts != 0 {
                emit(InputEvent::Dial {
                    control: encoder.into(),
                    delta_counts,
                });
            }
        }
        true
    }
}

/// Questions; the set-up depends on the answers.
fn opening(boot_wait_ms: u64) -> Vec<Turn<Question>> {
    let ask = |send: &[u8], question, limit_ms, silence| Turn::Ask {
        send: send.to_vec(),
        question,
        limit_ms,
        silence,
    };
    let sysex = |command| [message::SYSEX, command, message::SYSEX_END];
    let goes_on = Silence::GoesOn;
    vec![
        ask(&[], Question::Boot, boot_wait_ms, goes_on),
        ask(
            &[message::VERSION],
            Question::Version,
            ANSWER_LIMIT_MS,
            Silence::StartsOver,
        ),
        ask(
            &sysex(message::FIRMWARE),
            Question::Firmware,
            ANSWER_LIMIT_MS,
            goes_on,
        ),
        ask(
            &sysex(message::CAPABILITIES_QUERY),
            Question::Capabilities,
            ANSWER_LIMIT_MS,
            goes_on,
        ),
        ask(
            &sysex(message::ANALOG_MAPPING_QUERY),
            Question::AnalogMapping,
            ANSWER_LIMIT_MS,
            goes_on,
        ),
    ]
}

impl Codec for Firmata {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.messages.reset();
        self.board = Board::default();
        self.surprised = false;
        self.axes.fill(None);
        self.positions.fill(None);
        self.dialogue.begin(now, out);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            let pushed = self.messages.push(byte);
            self.counters.unknown += u64::from(pushed.unknown);
            self.counters.rejected += u64::from(pushed.rejected);
            if let Some(message) = pushed.message {
                self.take(message, emit);
            }
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if std::mem::take(&mut self.surprised) {
            self.let_go(emit);
            self.start(now, out);
        }
        if self.dialogue.advance(now, out) {
            self.counters.rejected += self.board.set_up(&self.settings, out);
            self.shown.send_everything(&self.board, out);
            emit(if self.known {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
            self.known = true;
        }
    }

    fn encode(&mut self, feedback: &Feedback, out: &mut Outgoing) {
        self.shown.want(feedback);
        if self.dialogue.is_over() {
            self.shown.send_changes(out);
        }
    }

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        for (control, down) in (0..).zip(&mut self.down) {
            if std::mem::take(down) {
                emit(InputEvent::Button { control, down: false });
            }
        }
    }

    fn started(&self) -> bool {
        self.dialogue.is_over()
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn identity(&self) -> Option<&str> {
        self.identity.as_deref()
    }
}

#[cfg(test)]
mod tests;
