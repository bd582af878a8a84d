//! The monome arc: encoders under rings of 64 lamps that the host draws.
//!
//! Source: `docs/protocols/monome-arc.md`.

mod ring;

use super::dialogue::{Dialogue, Silence, Turn};
use super::overdue::Overdue;
use super::{Codec, Counters, Feedback, InputEvent, Outgoing};
use crate::clock::Instant;
use ring::Ring;

/// The most encoders a section byte of this host's shadow allows; arcs have two or four.
const RINGS_MAX: u8 = 8;
/// How long the device may take to answer (libmonome waits a quarter as long for each question).
const ANSWER_LIMIT_MS: u64 = 1_000;
/// What are you, who are you, which firmware: one byte each.
const QUESTIONS: [u8; 3] = [0x00, 0x01, 0x0F];

/// Bytes after the header of what comes in; `None` for what is not known. Source: libmonome, `src/proto/mext.h`.
fn payload_bytes(header: u8) -> Option<usize> {
    Some(match header {
        // A section; size and address of a grid; a grid's keys; an encoder turned.
        0x00 | 0x03 | 0x04 | 0x20 | 0x21 | 0x50 => 2,
        // Name; place of a grid; firmware.
        0x01 => 32,
        0x02 => 3,
        0x0F => 8,
        // An encoder let go, pressed; tilt sensors.
        0x51 | 0x52 | 0x80 => 1,
        0x81 => 7,
        _ => return None,
    })
}

/// What a profile says of an arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Number of encoders and rings, at most eight.
    pub rings: u8,
}

/// The host's side of the arc.
#[derive(Debug)]
pub struct MonomeArc {
    dialogue: Dialogue<()>,
    known: bool,
    started: bool,
    identity: Option<String>,
    bytes: [u8; 33],
    have: usize,
    overdue: Overdue,
    down: u32,
    rings: Vec<Ring>,
    counters: Counters,
}

impl MonomeArc {
    /// For a device that has yet to be asked.
    pub fn new(settings: Settings) -> Self {
        let rings = settings.rings.min(RINGS_MAX);
        Self {
            dialogue: Dialogue::new(vec![Turn::Ask {
                send: QUESTIONS.to_vec(),
                question: (),
                limit_ms: ANSWER_LIMIT_MS,
                silence: Silence::StartsOver,
            }]),
            known: false,
            started: false,
            identity: None,
            bytes: [0; 33],
            have: 0,
            overdue: Overdue::default(),
            down: 0,
            rings: (0..rings).map(Ring::new).collect(),
            counters: Counters::default(),
        }
    }

    /// For a recording that begins when the device has already answered.
    pub fn listening(settings: Settings) -> Self {
        let mut codec = Self::new(settings);
        codec.dialogue = codec.dialogue.skipped();
        codec.known = true;
        codec.started = true;
        codec
    }

    fn push(&mut self, byte: u8, emit: &mut dyn FnMut(InputEvent)) {
        if self.have == 0 && payload_bytes(byte).is_none() {
            self.counters.unknown += 1;
            return;
        }
        if let Some(place) = self.bytes.get_mut(self.have) {
            *place = byte;
            self.have += 1;
        }
        let [header, ..] = self.bytes;
        if self.have > payload_bytes(header).unwrap_or(0) {
            self.have = 0;
            self.overdue.restart();
            self.take(header, emit);
        }
    }

    fn take(&mut self, header: u8, emit: &mut dyn FnMut(InputEvent)) {
        let [_, control, value, ..] = self.bytes;
        if matches!(header, 0x50..=0x52) && usize::from(control) >= self.rings.len() {
            self.counters.rejected += 1;
            return;
        }
        self.counters.reports += 1;
        match header {
            0x01 => {
                let text = self.bytes.get(1..).unwrap_or_default();
                let text = text.split(|&byte| byte == 0).next().unwrap_or_default();
                self.identity = Some(String::from_utf8_lossy(text).trim().to_owned());
                self.dialogue.answered();
            }
            0x00..=0x0F => self.dialogue.answered(),
            0x50 => {
                let delta_counts = i32::from(value as i8);
                if delta_counts != 0 {
                    emit(InputEvent::Dial {
                        control: control.into(),
                        delta_counts,
                    });
                }
            }
            0x51 | 0x52 => self.press(control, header == 0x52, emit),
            // A grid's keys and tilt: no arc has them.
            _ => {}
        }
    }

    fn press(&mut self, control: u8, down: bool, emit: &mut dyn FnMut(InputEvent)) {
        let bit = 1 << control;
        if (self.down & bit != 0) == down {
            return;
        }
        self.down ^= bit;
        emit(InputEvent::Button {
            control: control.into(),
            down,
        });
    }
}

impl Codec for MonomeArc {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.have = 0;
        self.started = false;
        self.dialogue.begin(now, out);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            self.push(byte, emit);
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if self.overdue.given_up(self.have > 0, now) {
            self.have = 0;
            self.counters.rejected += 1;
        }
        if self.dialogue.advance(now, out) {
            self.started = true;
            emit(if self.known {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
            self.known = true;
            for ring in &mut self.rings {
                ring.forget();
                ring.send(out);
            }
        }
    }

    fn encode(&mut self, feedback: &Feedback, out: &mut Outgoing) {
        let Feedback::Ring {
            control,
            value,
            style,
        } = feedback
        else {
            return;
        };
        if let Some(ring) = self.rings.get_mut(usize::from(*control)) {
            ring.want(*value, *style);
            if self.started {
                ring.send(out);
            }
        }
    }

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        for control in 0..RINGS_MAX {
            if self.down >> control & 1 == 1 {
                self.press(control, false, emit);
            }
        }
    }

    fn started(&self) -> bool {
        self.started
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
