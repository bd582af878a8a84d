//! Wacom's serial protocol V: Intuos and Intuos2, two tools at once, each with its number.
//!
//! Source: `docs/protocols/wacom-v.md`.

mod packet;
mod tool;

use super::dialogue::{Dialogue, Silence, Turn, ask, send};
use super::lines::{Line, Lines};
use super::overdue::Overdue;
use super::phased::Phased;
use super::wacom_iv::answer::{self, Answer, Question};
use super::{Codec, Counters, Feedback, InputEvent, Outgoing, Surface};
use crate::clock::Instant;
use packet::Packet;
use tool::Channel;

/// Bytes of every packet.
const PACKET_BYTES: usize = 9;
/// Speeds at which the tablet may stand, in the order inputattach tries them for protocol IV.
const RESET_BAUDS: [u32; 3] = [38_400, 19_200, 9_600];
/// How long the tablet may take to answer (Linux, `wacom_serial4.c`).
const ANSWER_LIMIT_MS: u64 = 1_000;
/// Multi mode, tool numbers, as fast as possible.
const SET_UP: &str = "MT1\rID1\rIT0\r";
/// Pressure has ten bits.
pub const PRESSURE_MAX: u32 = 1023;
/// Steps of the 4D mouse's rotation in a turn.
pub const TWIST_STEPS_PER_TURN: f64 = 1800.0;
/// Number of the axis that an airbrush's wheel is, 0 to 1023.
pub const AIRBRUSH_WHEEL: u16 = 0;
/// Number of the axis that a 4D mouse's thumb wheel is, −1023 to 1023.
pub const THROTTLE: u16 = 1;

/// What a profile says of a tablet.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The two letters a model number begins with: `GD` or `XD`.
    pub prefix: String,
    /// Speed to report at: 9600, 19200 or 38400; what the ROM cannot do is lowered.
    pub baud: u32,
    /// The area where the tablet does not say itself.
    pub surface: Surface,
    /// Pressure from which the tip is down; it is up again below half of it. Packets have no bit for it.
    pub tip_pressure: u32,
}

/// The host's side of the tablet.
#[derive(Debug)]
pub struct WacomV {
    settings: Settings,
    dialogue: Dialogue<Question>,
    known: bool,
    identity: Option<String>,
    surface: Surface,
    lines: Lines<64>,
    packets: Phased,
    overdue: Overdue,
    channels: [Channel; 2],
    counters: Counters,
}

impl WacomV {
    /// For a tablet that has yet to be asked.
    pub fn new(settings: Settings) -> Self {
        let surface = Surface {
            pressure_max: PRESSURE_MAX,
            twist_steps_per_turn: Some(TWIST_STEPS_PER_TURN),
            ..settings.surface
        };
        let channel = Channel::new(settings.tip_pressure);
        Self {
            dialogue: Dialogue::new(opening()),
            known: false,
            identity: None,
            surface,
            lines: Lines::new(),
            packets: Phased::new(PACKET_BYTES),
            overdue: Overdue::default(),
            channels: [channel.clone(), channel],
            counters: Counters::default(),
            settings,
        }
    }

    /// For a recording that begins when the tablet already reports, set up as [`Codec::start`] does.
    pub fn listening(settings: Settings) -> Self {
        let mut codec = Self::new(settings);
        codec.dialogue = codec.dialogue.skipped();
        codec.known = true;
        codec
    }

    /// A byte while questions are open: part of an answer, or left over from before.
    fn take_answer_byte(&mut self, byte: u8) {
        let Some(question) = self.dialogue.question() else {
            return;
        };
        if byte & 0x80 != 0 {
            return;
        }
        if byte == b'~' {
            // Answers begin so; what stood before is the end of something else.
            self.lines.reset();
        }
        let answer = match self.lines.push(byte) {
            Some(Line::Whole(line)) => answer::read(question, &String::from_utf8_lossy(line)),
            Some(Line::Overlong) => None,
            None => return,
        };
        self.take_answer(answer);
    }

    fn take_answer(&mut self, answer: Option<Answer>) {
        match answer {
            Some(answer) => {
                self.counters.reports += 1;
                self.dialogue.answered();
                self.learn(answer);
            }
            None => self.counters.rejected += 1,
        }
    }

    fn learn(&mut self, answer: Answer) {
        match answer {
            Answer::Identity(identity) => {
                if !identity.model.starts_with(&self.settings.prefix) {
                    // Another model than the profile's: its own numbers still hold where it gives them.
                    self.counters.rejected += 1;
                }
                self.dialogue.then(set_up(self.settings.baud, identity.version));
                self.identity = Some(identity.text);
            }
            Answer::Size(counts) => self.surface.max_counts = counts.map(Into::into),
            Answer::Resolution(lines) => self.surface.counts_per_inch = lines.map(Into::into),
        }
    }

    fn take_packet(&mut self, bytes: [u8; PACKET_BYTES], emit: &mut dyn FnMut(InputEvent)) {
        let (channel, packet) = packet::read(bytes);
        if matches!(packet, Packet::Unknown) {
            self.counters.rejected += 1;
            return;
        }
        self.counters.reports += 1;
        if let Some(channel) = self.channels.get_mut(channel) {
            channel.take(packet, emit);
        }
    }
}

/// From power-up to the last question; the set-up follows from the answers.
fn opening() -> Vec<Turn<Question>> {
    let mut turns = Vec::new();
    for baud in RESET_BAUDS {
        turns.extend([
            Turn::Baud(baud),
            send("\r$"),
            Turn::WaitMs(250),
            send("\r#"),
            Turn::WaitMs(75),
        ]);
    }
    turns.extend([
        send("SP\r"),
        Turn::WaitMs(30),
        ask("~#", Question::Identity, ANSWER_LIMIT_MS, Silence::StartsOver),
        ask("~C\r", Question::Size, ANSWER_LIMIT_MS, Silence::GoesOn),
        ask("~R\r", Question::Resolution, ANSWER_LIMIT_MS, Silence::GoesOn),
    ]);
    turns
}

/// At 9600 baud, the set-up's bytes take 14 ms: the tablet is told of a speed when it has heard them.
const SET_UP_MS: u64 = 20;
/// The tablet takes 75 ms to change its speed (xf86-input-wacom), from when it has heard the command: 5 ms more, and
/// some to spare.
const SPEED_MS: u64 = 90;

/// What follows from the answers; 38400 baud came with ROM 2.0 (xf86-input-wacom).
fn set_up(baud: u32, version: Option<(u32, u32)>) -> Vec<Turn<Question>> {
    let old = version.is_none_or(|version| version < (2, 0));
    let (command, baud) = match baud {
        38_400.. if !old => ("BA38\r", 38_400),
        19_200.. => ("BA19\r", 19_200),
        _ => ("", 9_600),
    };
    let mut turns = vec![send(SET_UP)];
    if !command.is_empty() {
        turns.extend([
            Turn::WaitMs(SET_UP_MS),
            send(command),
            Turn::WaitMs(SPEED_MS),
            Turn::Baud(baud),
        ]);
    }
    turns.push(send("ST\r"));
    turns
}

impl Codec for WacomV {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.packets.reset();
        self.lines.reset();
        self.dialogue.begin(now, out);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            if !self.dialogue.is_over() {
                self.take_answer_byte(byte);
                continue;
            }
            let pushed = self.packets.push(byte);
            self.counters.unknown += u64::from(pushed.unknown);
            self.counters.rejected += u64::from(pushed.rejected);
            if pushed.rejected || pushed.packet.is_some() {
                // What begins in place of something unfinished has a time of its own.
                self.overdue.restart();
            }
            if let Some(bytes) = pushed.packet {
                self.take_packet(bytes, emit);
            }
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if self.overdue.given_up(self.packets.unfinished(), now) {
            self.packets.reset();
            self.counters.rejected += 1;
        }
        if let Some(question) = self.dialogue.expired(now)
            && self.lines.unfinished()
        {
            // An answer may end in silence instead of a return.
            let answer = answer::read(question, &String::from_utf8_lossy(self.lines.so_far()));
            self.lines.reset();
            self.take_answer(answer);
        }
        if self.dialogue.advance(now, out) {
            emit(if self.known {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
            self.known = true;
        }
    }

    /// A tablet of this kind shows nothing.
    fn encode(&mut self, _feedback: &Feedback, _out: &mut Outgoing) {}

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        for channel in &mut self.channels {
            channel.leave(emit);
        }
    }

    fn started(&self) -> bool {
        self.dialogue.is_over()
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn surface(&self) -> Option<Surface> {
        Some(self.surface)
    }

    fn identity(&self) -> Option<&str> {
        self.identity.as_deref()
    }
}

#[cfg(test)]
mod tests;
