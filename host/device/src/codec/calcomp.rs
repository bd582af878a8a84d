//! CalComp DrawingBoard and DrawingSlate: format 23, six bytes of high resolution.
//!
//! Source: `docs/protocols/calcomp.md`. GTCO's tablets send the same bytes to other commands
//! ([`gtco`](super::gtco)).

pub(in crate::codec) mod packet;

use super::dialogue::{Dialogue, Silence, Turn, ask, send};
use super::held::Held;
use super::lines::{Line, Lines};
use super::overdue::Overdue;
use super::phased::{Phased, Pushed};
use super::{Codec, Counters, Feedback, InputEvent, Outgoing, PenSample, Surface, Tool};
use crate::clock::Instant;
use std::time::Duration;

pub use packet::{Code, Meaning};

/// Bytes of every packet.
const PACKET_BYTES: usize = 6;
/// The tablet takes a command at a time; xf86-input-calcomp pauses between them, this is ours.
const COMMAND_MS: u64 = 50;
/// How long an answer may take, xf86-input-calcomp's five tries of some milliseconds made generous.
const ANSWER_LIMIT_MS: u64 = 500;
/// A tablet that has neither answered nor reported for so long is asked again.
const SILENCE: Duration = Duration::from_secs(3);

/// What a profile says of a tablet.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What the bits mean.
    pub meaning: Meaning,
    /// Lines per inch to set.
    pub lines_per_inch: u32,
    /// The area where the tablet does not say itself.
    pub surface: Surface,
    /// Silence after which the tool has left, for tablets that do not say so.
    pub leave_after: Option<Duration>,
}

/// What the tablet is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Question {
    Firmware,
    Product,
    /// The largest coordinates, in a packet.
    Size,
}

/// The host's side of the tablet.
#[derive(Debug)]
pub struct CalComp {
    settings: Settings,
    dialogue: Dialogue<Question>,
    /// When the set-up ended, while nothing has come since the beginning.
    silent_since: Option<Instant>,
    heard: bool,
    known: bool,
    started: bool,
    identity: Option<String>,
    surface: Surface,
    lines: Lines<64>,
    packets: Phased,
    overdue: Overdue,
    held: Held,
    counters: Counters,
}

impl CalComp {
    /// For a tablet that has yet to be set up.
    pub fn new(settings: Settings) -> Self {
        Self {
            dialogue: Dialogue::new(opening(&settings)),
            silent_since: None,
            heard: false,
            known: false,
            started: false,
            identity: None,
            surface: settings.surface,
            lines: Lines::new(),
            packets: Phased::new(PACKET_BYTES),
            overdue: Overdue::default(),
            held: Held::new(settings.leave_after),
            counters: Counters::default(),
            settings,
        }
    }

    /// For a recording that begins when the tablet already reports.
    pub fn listening(settings: Settings) -> Self {
        let mut codec = Self::new(settings);
        codec.dialogue = codec.dialogue.skipped();
        codec.known = true;
        codec.started = true;
        codec.heard = true;
        codec
    }

    fn begin_reports(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        self.started = true;
        emit(if self.known {
            InputEvent::Restarted
        } else {
            InputEvent::Started
        });
        self.known = true;
    }

    fn take_text_byte(&mut self, question: Question, byte: u8) {
        if byte & 0x80 != 0 {
            // The tablet has not stopped sending packets.
            self.lines.reset();
            return;
        }
        match self.lines.push(byte) {
            Some(Line::Whole(line)) if is_text(line) => {
                let text = String::from_utf8_lossy(line).trim().to_owned();
                self.identity = Some(match (&self.identity, question) {
                    (Some(firmware), Question::Product) => format!("{text}, {firmware}"),
                    _ => text,
                });
                self.heard = true;
                self.counters.reports += 1;
                self.dialogue.answered();
            }
            Some(_) => self.counters.rejected += 1,
            None => {}
        }
    }

    fn take_packet_byte(&mut self, byte: u8, emit: &mut dyn FnMut(InputEvent)) {
        let Pushed {
            packet,
            unknown,
            rejected,
        } = self.packets.push(byte);
        self.counters.unknown += u64::from(unknown);
        self.counters.rejected += u64::from(rejected);
        if rejected {
            // What begins in place of something unfinished has a time of its own.
            self.overdue.restart();
        }
        let Some(bytes) = packet else {
            return;
        };
        self.overdue.restart();
        self.heard = true;
        self.counters.reports += 1;
        if self.dialogue.question() == Some(Question::Size) {
            let counts = packet::size(bytes);
            if counts.contains(&0) {
                self.counters.rejected += 1;
            } else {
                self.surface.max_counts = counts;
            }
            self.dialogue.answered();
            return;
        }
        if !self.started {
            self.begin_reports(emit);
        }
        let [_, bottom] = self.surface.max_counts;
        match self.settings.meaning.sample(bytes, bottom, self.held.sample()) {
            Some(sample) => self.held.see(sample, emit),
            None => self.held.leave(emit),
        }
    }
}

/// Printable, and longer than what a packet can leave in front of a byte that looks like a return.
fn is_text(line: &[u8]) -> bool {
    line.len() >= PACKET_BYTES - 1 && line.iter().all(|byte| (b' '..=b'~').contains(byte))
}

/// Quiet, questions, set-up. Commands: xf86-input-calcomp; that questions come before the stream, so that an answer
/// cannot be taken for a packet, is ours.
fn opening(settings: &Settings) -> Vec<Turn<Question>> {
    let command = |text: &str| [send(&format!("\x1b%{text}\r")), Turn::WaitMs(COMMAND_MS)];
    let question = |text: &str, question| {
        ask(
            &format!("\x1b%{text}\r"),
            question,
            ANSWER_LIMIT_MS,
            Silence::GoesOn,
        )
    };
    let mut turns = Vec::new();
    // Line set-up, then prompt mode.
    turns.extend(command("C1N81"));
    turns.extend(command("Q?"));
    turns.push(question("__V", Question::Firmware));
    turns.push(question("__p", Question::Product));
    // Origin at the upper left, format 23, every count, resolution.
    for text in ["L1", "^23", "X1", "Y1"] {
        turns.extend(command(text));
    }
    turns.extend(command(&format!("JR{},0", settings.lines_per_inch)));
    turns.push(question("VS", Question::Size));
    let pressure = matches!(settings.meaning.code, packet::Code::Pressure { .. });
    turns.extend(command(if pressure { "VA1" } else { "VA0" }));
    // Run: absolute, all the time.
    turns.extend(command("IR"));
    turns
}

impl Codec for CalComp {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.packets.reset();
        self.lines.reset();
        self.started = false;
        self.heard = false;
        self.silent_since = None;
        self.identity = None;
        self.dialogue.begin(now, out);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            match self.dialogue.question() {
                Some(question @ (Question::Firmware | Question::Product)) => {
                    self.take_text_byte(question, byte);
                }
                Some(Question::Size) => self.take_packet_byte(byte, emit),
                None if self.dialogue.is_over() => self.take_packet_byte(byte, emit),
                // Left over from before, or an answer that came late.
                None => {}
            }
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if self.overdue.given_up(self.packets.unfinished(), now) {
            self.packets.reset();
            self.counters.rejected += 1;
        }
        if self.dialogue.advance(now, out) {
            if self.heard {
                self.begin_reports(emit);
            } else {
                self.silent_since = Some(now);
            }
        }
        if self.started {
            self.silent_since = None;
        }
        if self.silent_since.is_some_and(|since| now.since(since) >= SILENCE) {
            self.start(now, out);
        }
        self.held.advance(now, emit);
    }

    /// A tablet of this kind shows nothing.
    fn encode(&mut self, _feedback: &Feedback, _out: &mut Outgoing) {}

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        self.held.leave(emit);
    }

    fn started(&self) -> bool {
        self.started
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
