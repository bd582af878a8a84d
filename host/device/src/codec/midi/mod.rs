//! Controllers that speak MIDI: dials in every relative encoding, faders of 7 and 14 bits, motor faders with touch,
//! pads, lamps, rings and displays. What a message means and what shows what is data: `control` and `output` of the
//! profile.
//!
//! Source: `docs/protocols/midi.md`.

mod heard;
mod motors_out;
pub mod parser;
mod relative;
mod shown;
mod template;
mod woken;

use super::motors::Motors;
use super::{Codec, Counters, Feedback, InputEvent, Outgoing};
use crate::clock::Instant;
use device_profiles::{ControlClass, InputProfile};
use heard::{Heard, Outcome};
use motors_out::MotorsOut;
use parser::{Message, Parser};
use shown::Shadow;
use std::time::Duration;
use woken::Waking;

/// Low bits come right behind the high ones: 1 ms on a wire of 31250 baud. Behind that pause they are 0 (ours).
const FINE_LIMIT: Duration = Duration::from_millis(20);

/// Meters fall by a step in some 300 ms: said again so often, they stay (ours).
const METERS_AGAIN: Duration = Duration::from_millis(200);

/// The host's side of a controller.
#[derive(Debug)]
pub struct Midi {
    parser: Parser,
    heard: Heard,
    shadow: Shadow,
    motors: Motors,
    motors_out: MotorsOut,
    waking: Waking,
    /// Whether `Started` has been said.
    known: bool,
    /// When high bits were first seen without their low ones.
    fine_since: Option<Instant>,
    /// When meters were said again last.
    meters_at: Instant,
    counters: Counters,
}

impl Midi {
    /// For a controller that has yet to be opened.
    pub fn new(profile: &InputProfile) -> Self {
        Self {
            parser: Parser::default(),
            heard: Heard::new(profile),
            shadow: Shadow::new(profile),
            motors: Motors::new(profile.count(ControlClass::Axis)),
            motors_out: MotorsOut::new(profile),
            waking: Waking::new(profile),
            known: false,
            fine_since: None,
            meters_at: Instant::ZERO,
            counters: Counters::default(),
        }
    }

    /// For a recording that begins when the controller already reports.
    pub fn listening(profile: &InputProfile) -> Self {
        let mut codec = Self::new(profile);
        codec.waking.skip();
        codec.known = true;
        codec
    }
}

/// Bookkeeping of one event that leaves.
fn notice(motors: &mut Motors, ways: &MotorsOut, event: InputEvent) {
    match event {
        InputEvent::Axis { control, value } => motors.moved(control, value, ways.forgets(control)),
        InputEvent::AxisTouched { control, down } => motors.touched(control, down),
        _ => {}
    }
}

impl Codec for Midi {
    fn start(&mut self, now: Instant, _out: &mut Outgoing) {
        self.parser.reset();
        self.fine_since = None;
        self.shadow.forget();
        self.motors.forget();
        self.waking.begin(now);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            match self.parser.push(byte) {
                None | Some(Message::RealTime) => {}
                Some(Message::Channel { status, data }) => {
                    self.counters.reports += 1;
                    let (motors, ways) = (&mut self.motors, &self.motors_out);
                    let outcome = self.heard.take(status, data, &mut |event| {
                        notice(motors, ways, event);
                        emit(event);
                    });
                    self.counters.rejected += u64::from(outcome == Outcome::Impossible);
                }
                Some(Message::Exclusive(bytes)) => {
                    self.counters.reports += 1;
                    self.waking.answered(bytes);
                }
                Some(Message::System) => self.counters.reports += 1,
                Some(Message::Unknown) => self.counters.unknown += 1,
                Some(Message::Rejected) => self.counters.rejected += 1,
            }
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if self.heard.is_waiting() {
            let since = *self.fine_since.get_or_insert(now);
            if now.since(since) >= FINE_LIMIT {
                let (motors, ways) = (&mut self.motors, &self.motors_out);
                self.heard.flush(&mut |event| {
                    notice(motors, ways, event);
                    emit(event);
                });
            }
        }
        if !self.heard.is_waiting() {
            self.fine_since = None;
        }
        let woken = self.waking.advance(now, out);
        self.counters.rejected += u64::from(self.waking.take_missed());
        if woken {
            emit(if self.known {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
            self.known = true;
            self.shadow.send(out);
        }
        if self.waking.is_done() {
            let motors_out = &self.motors_out;
            self.motors
                .due(now, |axis, value| motors_out.send(axis, value, out));
            if now.since(self.meters_at) >= METERS_AGAIN {
                self.meters_at = now;
                self.shadow.say_meters_again(out);
            }
        }
    }

    fn encode(&mut self, feedback: &Feedback, out: &mut Outgoing) {
        if let Feedback::Motor { control, value } = feedback {
            if self.motors_out.has(*control) {
                self.motors.want(*control, *value);
            }
            return;
        }
        self.shadow.want(feedback);
        if self.waking.is_done() {
            self.shadow.send(out);
        }
    }

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        self.heard.let_go(emit);
        self.motors.forget();
    }

    fn started(&self) -> bool {
        self.waking.is_done()
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn identity(&self) -> Option<&str> {
        self.waking.identity()
    }
}

#[cfg(test)]
mod tests;
