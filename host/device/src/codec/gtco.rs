//! GTCO AccuTab, Super L III and kin: two-letter commands after Ctrl-A, and CalComp's six bytes.
//!
//! Source: `docs/protocols/gtco.md`.

use super::calcomp::packet::Meaning;
use super::dialogue::{Dialogue, Silence, Turn, ask, send};
use super::held::Held;
use super::lines::number;
use super::overdue::Overdue;
use super::phased::Phased;
use super::{Codec, Counters, Feedback, InputEvent, Outgoing, Surface};
use crate::clock::Instant;

/// Bytes of every packet.
const PACKET_BYTES: usize = 6;
/// Enters command mode.
const COMMAND_MODE: &str = "\x01";
/// Leaves command mode; digitizing goes on as commanded.
const DIGITIZE: &str = "\x1b";
/// The prompt of command mode: what was sent has been done.
const PROMPT: u8 = b'>';
/// A command that was not understood.
const REFUSED: u8 = b'?';
/// How long a prompt may take; the manual gives no limit.
const ANSWER_LIMIT_MS: u64 = 500;
/// Longest answer kept.
const ANSWER_BYTES_MAX: usize = 64;

/// What a profile says of a tablet.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What the bits mean.
    pub meaning: Meaning,
    /// The area where the tablet does not say itself.
    pub surface: Surface,
}

/// What is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Question {
    /// The first prompt.
    Prompt,
    /// Firmware version.
    Version,
    /// Inches: two digits of height, two of width.
    Size,
    /// A setting; only its prompt matters.
    Setting,
}

/// The host's side of the tablet.
#[derive(Debug)]
pub struct Gtco {
    settings: Settings,
    dialogue: Dialogue<Question>,
    answer: Vec<u8>,
    known: bool,
    identity: Option<String>,
    surface: Surface,
    packets: Phased,
    overdue: Overdue,
    held: Held,
    counters: Counters,
}

impl Gtco {
    /// For a tablet that has yet to be set up.
    pub fn new(settings: Settings) -> Self {
        Self {
            dialogue: Dialogue::new(opening()),
            answer: Vec::with_capacity(ANSWER_BYTES_MAX),
            known: false,
            identity: None,
            surface: settings.surface,
            packets: Phased::new(PACKET_BYTES),
            overdue: Overdue::default(),
            held: Held::default(),
            counters: Counters::default(),
            settings,
        }
    }

    /// For a recording that begins when the tablet already reports.
    pub fn listening(settings: Settings) -> Self {
        let mut codec = Self::new(settings);
        codec.dialogue = codec.dialogue.skipped();
        codec.known = true;
        codec
    }

    fn take_answer_byte(&mut self, question: Question, byte: u8) {
        match byte {
            PROMPT => {
                self.learn(question);
                self.answer.clear();
                self.counters.reports += 1;
                self.dialogue.answered();
            }
            REFUSED => {
                // A prompt follows.
                self.answer.clear();
                self.counters.rejected += 1;
            }
            0x80.. => self.answer.clear(),
            _ if self.answer.len() < ANSWER_BYTES_MAX => self.answer.push(byte),
            _ => {}
        }
    }

    /// The answer stands between the echo of the command and the prompt.
    fn learn(&mut self, question: Question) {
        let command: &[u8] = match question {
            Question::Version => b"VR",
            Question::Size => b"SZ",
            Question::Prompt | Question::Setting => return,
        };
        let text = self.answer.trim_ascii();
        let text = text.strip_prefix(command).unwrap_or(text).trim_ascii();
        if text.is_empty() {
            return;
        }
        if question == Question::Version {
            self.identity = Some(String::from_utf8_lossy(text).into_owned());
            return;
        }
        let inches = text
            .split_at_checked(2)
            .and_then(|(height, width)| Some([number(width)?, number(height)?]))
            .filter(|inches| text.len() == 4 && !inches.contains(&0));
        match inches {
            // The set-up asks for a thousand lines per inch.
            Some(inches) => self.surface.max_counts = inches.map(|inch| inch.unsigned_abs() * 1000),
            None => self.counters.rejected += 1,
        }
    }
}

/// Prompt, questions, then binary, high resolution in inches, all the time.
fn opening() -> Vec<Turn<Question>> {
    let mut turns = vec![ask(
        COMMAND_MODE,
        Question::Prompt,
        ANSWER_LIMIT_MS,
        Silence::StartsOver,
    )];
    for (command, question) in [
        ("VR\r", Question::Version),
        ("SZ\r", Question::Size),
        ("BI\r", Question::Setting),
        ("IN\r", Question::Setting),
        ("HR\r", Question::Setting),
        ("CN\r", Question::Setting),
    ] {
        turns.push(ask(command, question, ANSWER_LIMIT_MS, Silence::GoesOn));
    }
    turns.push(send(DIGITIZE));
    turns
}

impl Codec for Gtco {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.packets.reset();
        self.answer.clear();
        self.dialogue.begin(now, out);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            if let Some(question) = self.dialogue.question() {
                self.take_answer_byte(question, byte);
                continue;
            }
            if !self.dialogue.is_over() {
                continue;
            }
            let pushed = self.packets.push(byte);
            self.counters.unknown += u64::from(pushed.unknown);
            self.counters.rejected += u64::from(pushed.rejected);
            if pushed.rejected {
                // What begins in place of something unfinished has a time of its own.
                self.overdue.restart();
            }
            let Some(bytes) = pushed.packet else {
                continue;
            };
            self.overdue.restart();
            self.counters.reports += 1;
            let [_, bottom] = self.surface.max_counts;
            match self.settings.meaning.sample(bytes, bottom, self.held.sample()) {
                Some(sample) => self.held.see(sample, emit),
                None => self.held.leave(emit),
            }
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if self.overdue.given_up(self.packets.unfinished(), now) {
            self.packets.reset();
            self.counters.rejected += 1;
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
        self.held.leave(emit);
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
