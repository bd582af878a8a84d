//! Summagraphics MM and its kin: binary reports of five, three or seven bytes, and the ASCII of the MM1103 and the
//! Bit Pad Two.
//!
//! Source: `docs/protocols/mm.md`.

mod report;

use super::dialogue::{Dialogue, Silence, Turn, ask, send};
use super::held::Held;
use super::lines::{Line, Lines};
use super::overdue::Overdue;
use super::phased::Phased;
use super::{Codec, Counters, Feedback, InputEvent, Outgoing, PenSample, Surface, Tool};
use crate::clock::Instant;
use report::{Configuration, Report};
use std::time::Duration;

/// How reports come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Framing {
    /// Five bytes: places.
    Absolute,
    /// Three bytes: moves.
    Relative,
    /// Seven bytes: places with a third axis (AceCad Flair).
    Flair,
    /// Lines of text: x, y and a digit. Such a tablet is not asked for anything.
    Ascii,
}

/// What the button code of a puck means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buttons {
    /// The number of the button pressed; of two, their codes merged.
    Number,
    /// A bit for each.
    Mask,
}

/// What a profile says of a tablet.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How reports come.
    pub framing: Framing,
    /// What lies on it: [`Tool::Pen`] or [`Tool::Puck`]; only the Flair says itself.
    pub tool: Tool,
    /// What a puck's button code means.
    pub buttons: Buttons,
    /// Lines per inch to set; those without a code of their own become 500.
    pub lines_per_inch: u32,
    /// Counts of movement from one report to the next, 0 to 95; 0 reports all the time.
    pub increment: u8,
    /// The tablet counts y from the lower edge.
    pub y_up: bool,
    /// The area where the tablet does not say itself.
    pub surface: Surface,
    /// Silence after which the tool has left, for tablets that do not say so.
    pub leave_after: Option<Duration>,
}

/// The host's side of the tablet.
#[derive(Debug)]
pub struct Mm {
    settings: Settings,
    dialogue: Dialogue<Question>,
    started: bool,
    known: bool,
    identity: Option<String>,
    surface: Surface,
    lines: Lines<80>,
    configuration: Configuration,
    packets: Phased,
    overdue: Overdue,
    held: Held,
    /// Buttons of a tablet that tells only moves.
    down: u32,
    counters: Counters,
}

/// What the tablet is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Question {
    /// `z?`: the firmware's text.
    Firmware,
    /// `a`: the largest coordinates.
    Configuration,
}

impl Mm {
    /// For a tablet that has yet to be woken.
    pub fn new(settings: Settings) -> Self {
        let bytes = match settings.framing {
            Framing::Relative => 3,
            Framing::Flair => 7,
            Framing::Absolute | Framing::Ascii => 5,
        };
        Self {
            dialogue: Dialogue::new(opening(&settings)),
            started: false,
            known: false,
            identity: None,
            surface: settings.surface,
            lines: Lines::new(),
            configuration: Configuration::new(if bytes == 7 { 7 } else { 5 }),
            packets: Phased::new(bytes),
            overdue: Overdue::default(),
            held: Held::new(settings.leave_after),
            down: 0,
            counters: Counters::default(),
            settings,
        }
    }

    /// For a recording that begins when the tablet already reports, set up as [`Codec::start`] does.
    pub fn listening(settings: Settings) -> Self {
        let mut codec = Self::new(settings);
        codec.dialogue = codec.dialogue.skipped();
        codec.started = true;
        codec.known = true;
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

    fn take_answer_byte(&mut self, question: Question, byte: u8) {
        match question {
            Question::Firmware => match self.lines.push(byte) {
                Some(Line::Whole(line)) if line.is_ascii() => {
                    self.identity = Some(String::from_utf8_lossy(line).trim().to_owned());
                    self.counters.reports += 1;
                    self.dialogue.answered();
                }
                Some(_) => self.counters.rejected += 1,
                None => {}
            },
            Question::Configuration => {
                if let Some(counts) = self.configuration.push(byte) {
                    if counts.contains(&0) {
                        self.counters.rejected += 1;
                    } else {
                        self.surface.max_counts = counts;
                        self.counters.reports += 1;
                    }
                    self.dialogue.answered();
                }
            }
        }
    }

    fn take_line_byte(&mut self, byte: u8, emit: &mut dyn FnMut(InputEvent)) {
        let report = match self.lines.push(byte) {
            None => return,
            Some(Line::Overlong) => None,
            Some(Line::Whole(line)) => report::line(line),
        };
        match report {
            Some(report) => {
                if !self.started {
                    self.begin_reports(emit);
                }
                self.tell(report, emit);
            }
            None => self.counters.rejected += 1,
        }
    }

    fn take_packet_byte(&mut self, byte: u8, emit: &mut dyn FnMut(InputEvent)) {
        let pushed = self.packets.push(byte);
        self.counters.unknown += u64::from(pushed.unknown);
        self.counters.rejected += u64::from(pushed.rejected);
        let Some(bytes) = pushed.packet else {
            return;
        };
        self.overdue.restart();
        match self.settings.framing {
            Framing::Relative => self.move_by(report::relative(bytes), emit),
            Framing::Flair => self.tell(report::flair(bytes), emit),
            Framing::Absolute | Framing::Ascii => self.tell(report::absolute(bytes), emit),
        }
    }

    fn tell(&mut self, report: Report, emit: &mut dyn FnMut(InputEvent)) {
        self.counters.reports += 1;
        if !report.in_range {
            self.held.leave(emit);
            return;
        }
        let tool = report.tool.unwrap_or(self.settings.tool);
        let [_, bottom] = self.surface.max_counts;
        let y_counts = if self.settings.y_up {
            bottom.saturating_sub(report.y)
        } else {
            report.y
        };
        let pen = tool == Tool::Pen;
        let sample = PenSample {
            pressure_counts: if pen { report.pressure } else { 0 },
            tip: pen && report.code & 1 == 1,
            buttons: if pen {
                report.code >> 1
            } else {
                self.buttons(report.code)
            },
            ..PenSample::hovering(tool, report.x, y_counts)
        };
        self.held.see(sample, emit);
    }

    fn move_by(&mut self, report: report::Move, emit: &mut dyn FnMut(InputEvent)) {
        self.counters.reports += 1;
        if !report.in_range {
            self.press(0, emit);
            return;
        }
        let down = match self.settings.tool {
            Tool::Pen => report.code,
            _ => self.buttons(report.code),
        };
        if report.dx != 0 || report.dy != 0 {
            let dy = if self.settings.y_up { -report.dy } else { report.dy };
            emit(InputEvent::Moved {
                dx: report.dx,
                dy,
                wheel: 0,
            });
        }
        self.press(down, emit);
    }

    fn press(&mut self, down: u32, emit: &mut dyn FnMut(InputEvent)) {
        let changed = self.down ^ down;
        self.down = down;
        for control in (0..16_u16).filter(|control| changed >> control & 1 == 1) {
            emit(InputEvent::Button {
                control,
                down: down >> control & 1 == 1,
            });
        }
    }

    /// Buttons of a puck. Where codes are numbers, 5 to 7 can only be button 4 with another; 3 is taken for button
    /// 3, though 1 and 2 together send it too.
    fn buttons(&self, code: u32) -> u32 {
        match (self.settings.buttons, code) {
            (Buttons::Mask, code) => code,
            (Buttons::Number, 0) => 0,
            (Buttons::Number, 5..=7) if self.settings.framing != Framing::Ascii => 1 << 3 | 1 << (code - 5),
            (Buttons::Number, number) => 1 << (number - 1).min(31),
        }
    }
}

/// Wake, quiet, questions, set-up. Order and times: xf86-input-summa.
fn opening(settings: &Settings) -> Vec<Turn<Question>> {
    if settings.framing == Framing::Ascii {
        return Vec::new();
    }
    let mut set_up = vec![b'0', b'b', b'z', b'b', b'@'];
    set_up.extend([b'I', b' ' + settings.increment.min(95)]);
    set_up.push(if settings.framing == Framing::Relative {
        b'E'
    } else {
        b'F'
    });
    set_up.push(b'P');
    let resolution = resolution_code(settings.lines_per_inch);
    vec![
        // Ten spaces let it find the speed; 200 ms after them is too short for a Genius EasyPen.
        Turn::Send(b"          \0".to_vec()),
        Turn::WaitMs(400),
        // Prompt mode, and time for what is still under way.
        send("B"),
        Turn::WaitMs(50),
        ask("z?", Question::Firmware, 1_000, Silence::GoesOn),
        Turn::Ask {
            send: vec![resolution, b'a'],
            question: Question::Configuration,
            limit_ms: 1_000,
            silence: Silence::StartsOver,
        },
        Turn::Send(set_up),
    ]
}

/// The letter that sets so many lines per inch.
fn resolution_code(lines_per_inch: u32) -> u8 {
    match lines_per_inch {
        1 => b'l',
        2 => b'n',
        4 => b'p',
        100 => b'd',
        200 => b'e',
        254 => b'f',
        400 => b'g',
        508 => b'i',
        1000 => b'j',
        1016 => b'q',
        2000 => b's',
        2032 => b'u',
        2540 => b'v',
        _ => b'h',
    }
}

impl Codec for Mm {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.packets.reset();
        self.lines.reset();
        self.configuration.reset();
        self.started = false;
        self.dialogue.begin(now, out);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            if self.settings.framing == Framing::Ascii {
                self.take_line_byte(byte, emit);
            } else if let Some(question) = self.dialogue.question() {
                self.take_answer_byte(question, byte);
            } else if self.dialogue.is_over() {
                self.take_packet_byte(byte, emit);
            }
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if self.overdue.given_up(self.packets.unfinished(), now) {
            self.packets.reset();
            self.counters.rejected += 1;
        }
        if self.dialogue.advance(now, out) && self.settings.framing != Framing::Ascii {
            self.begin_reports(emit);
        }
        self.held.advance(now, emit);
    }

    /// A tablet of this kind shows nothing.
    fn encode(&mut self, _feedback: &Feedback, _out: &mut Outgoing) {}

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        self.press(0, emit);
        self.held.leave(emit);
    }

    fn started(&self) -> bool {
        self.started
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn surface(&self) -> Option<Surface> {
        (self.settings.framing != Framing::Relative).then_some(self.surface)
    }

    fn identity(&self) -> Option<&str> {
        self.identity.as_deref()
    }
}

#[cfg(test)]
mod tests;
