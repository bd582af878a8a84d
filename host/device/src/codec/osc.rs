//! Controllers that speak OSC, as TouchOSC does: an address for each control, one number, or two where a pad has two
//! axes. What is sent back to the same address sets the control; it is not sent to a control that is being moved.
//!
//! Source: `docs/protocols/osc.md` (OSC 1.0; hexler's TouchOSC manual).

mod address;
mod packet;
mod reading;

use super::motors::Motors;
use super::{Codec, Counters, Feedback, InputEvent, Outgoing};
use crate::clock::Instant;
use address::{Addresses, Meaning};
use device_profiles::{ControlClass, InputProfile, OutputKind};
pub use packet::due;
use reading::{Message, Packet};
use rosc::OscType;
use std::collections::BTreeMap;

/// Packets inside packets that are followed.
const DEPTH_MAX: usize = 8;
/// Where a control's profile says no range.
const RANGE: [i32; 2] = [0, 127];

/// The host's side of an OSC controller.
#[derive(Debug)]
pub struct Osc {
    addresses: Addresses,
    ranges: Vec<[i32; 2]>,
    motors: Motors,
    lamps: Shown<u8>,
    labels: Shown<String>,
    down: Vec<bool>,
    touched: Vec<bool>,
    begun: bool,
    started: bool,
    known: bool,
    counters: Counters,
}

/// Values to show by number, and what was sent of them.
#[derive(Debug)]
struct Shown<T> {
    wanted: BTreeMap<u16, T>,
    sent: BTreeMap<u16, T>,
}

impl<T: Clone + PartialEq> Shown<T> {
    fn new() -> Self {
        Self {
            wanted: BTreeMap::new(),
            sent: BTreeMap::new(),
        }
    }

    /// Gives `send` what differs; what it cannot send is not asked for again.
    fn changes(&mut self, mut send: impl FnMut(u16, &T)) {
        for (&number, value) in &self.wanted {
            if self.sent.get(&number) != Some(value) {
                send(number, value);
                self.sent.insert(number, value.clone());
            }
        }
    }
}

impl Osc {
    /// For a controller from which nothing has been heard.
    pub fn new(profile: &InputProfile) -> Self {
        let count = |class| usize::from(profile.count(class));
        let axes = profile.numbered(ControlClass::Axis);
        Self {
            addresses: Addresses::new(profile),
            ranges: axes.map(|(_, control)| control.range.unwrap_or(RANGE)).collect(),
            motors: Motors::new(profile.count(ControlClass::Axis)),
            lamps: Shown::new(),
            labels: Shown::new(),
            down: vec![false; count(ControlClass::Button)],
            touched: vec![false; count(ControlClass::Axis)],
            begun: false,
            started: false,
            known: false,
            counters: Counters::default(),
        }
    }

    /// For a recording that begins when the controller already reports.
    pub fn listening(profile: &InputProfile) -> Self {
        Self {
            begun: true,
            started: true,
            known: true,
            ..Self::new(profile)
        }
    }

    /// Takes a packet; `None` is one that cannot be read.
    fn take(&mut self, packet: Option<Packet<'_>>, depth: usize, emit: &mut dyn FnMut(InputEvent)) {
        match packet {
            Some(Packet::Message(message)) => self.hear(&message, emit),
            // A bundle's parts belong to one moment. One that is for later comes later: the port keeps it.
            Some(Packet::Bundle(parts)) if depth < DEPTH_MAX => {
                for part in parts {
                    self.take(part, depth + 1, emit);
                }
            }
            Some(Packet::Bundle(_)) | None => self.counters.rejected += 1,
        }
    }

    fn hear(&mut self, message: &Message<'_>, emit: &mut dyn FnMut(InputEvent)) {
        let Some(meanings) = self.addresses.of(message.address) else {
            self.counters.unknown += 1;
            return;
        };
        self.counters.reports += 1;
        let mut values = message.numbers();
        for &meaning in meanings {
            let Some(Some(value)) = values.next() else {
                self.counters.rejected += 1;
                return;
            };
            match meaning {
                Meaning::Axis(control) => {
                    let [low, high] = self.ranges.get(usize::from(control)).copied().unwrap_or(RANGE);
                    let counts = (value.clamp(0.0, 1.0) * f64::from(high - low)).round() as i32 + low;
                    self.motors.moved(control, counts, false);
                    emit(InputEvent::Axis {
                        control,
                        value: counts,
                    });
                }
                Meaning::Button(control) => {
                    let now = value >= 0.5;
                    // What a button shows is what it said.
                    self.lamps.sent.insert(control, if now { 255 } else { 0 });
                    edge(&mut self.down, control, now, |down| {
                        emit(InputEvent::Button { control, down });
                    });
                }
                // TouchOSC's encoders say 1 for a step up and 0 for a step down; others say how many.
                Meaning::Dial(control) => {
                    let steps = value.round().clamp(-1e6, 1e6) as i32;
                    emit(InputEvent::Dial {
                        control,
                        delta_counts: if steps == 0 { -1 } else { steps },
                    });
                }
                Meaning::Ring(control) => emit(InputEvent::Ring {
                    control,
                    value: Some((value.clamp(0.0, 1.0) * 127.0).round() as u16),
                }),
                Meaning::Touch(axis) => {
                    let now = value >= 0.5;
                    self.motors.touched(axis, now);
                    edge(&mut self.touched, axis, now, |down| {
                        emit(InputEvent::AxisTouched { control: axis, down });
                    });
                }
            }
        }
    }

    fn send_changes(&mut self, out: &mut Outgoing) {
        let addresses = &self.addresses;
        self.lamps.changes(|n, level| {
            if let Some(address) = addresses.output(OutputKind::Lamp, n) {
                packet::send(address, vec![OscType::Float(f32::from(*level) / 255.0)], out);
            }
        });
        self.labels.changes(|n, text| {
            if let Some(address) = addresses.output(OutputKind::Label, n) {
                packet::send(address, vec![OscType::String(text.clone())], out);
            }
        });
    }
}

fn edge(held: &mut [bool], control: u16, now: bool, say: impl FnOnce(bool)) {
    if let Some(held) = held.get_mut(usize::from(control))
        && *held != now
    {
        *held = now;
        say(now);
    }
}

impl Codec for Osc {
    fn start(&mut self, _now: Instant, _out: &mut Outgoing) {
        self.begun = true;
        self.started = false;
        self.motors.forget();
        self.lamps.sent.clear();
        self.labels.sent.clear();
    }

    /// One call is one packet.
    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        self.take(reading::packet(bytes), 0, emit);
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if !self.begun {
            return;
        }
        if !self.started {
            self.started = true;
            emit(if self.known {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
            self.known = true;
            self.send_changes(out);
        }
        let (addresses, ranges) = (&self.addresses, &self.ranges);
        self.motors.due(now, |axis, value| {
            let [low, high] = ranges.get(usize::from(axis)).copied().unwrap_or(RANGE);
            if let Some(address) = addresses.output(OutputKind::Motor, axis) {
                let share = f64::from(value - low) / f64::from((high - low).max(1));
                packet::send(address, vec![OscType::Float(share as f32)], out);
            }
        });
    }

    fn encode(&mut self, feedback: &Feedback, out: &mut Outgoing) {
        match feedback {
            Feedback::Lamps(mask) => {
                for n in 0..self.addresses.count(OutputKind::Lamp).min(64) {
                    self.lamps
                        .wanted
                        .insert(n, if mask >> n & 1 == 1 { 255 } else { 0 });
                }
            }
            Feedback::Lamp { control, level, .. } => {
                self.lamps.wanted.insert(*control, *level);
            }
            Feedback::Label { control, text } => {
                self.labels.wanted.insert(*control, text.clone());
            }
            Feedback::Motor { control, value } => self.motors.want(*control, *value),
            Feedback::Level { .. }
            | Feedback::Ring { .. }
            | Feedback::Picture { .. }
            | Feedback::Haptic { .. } => {}
        }
        if self.started {
            self.send_changes(out);
        }
    }

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        for (control, down) in (0..).zip(&mut self.down) {
            if std::mem::take(down) {
                emit(InputEvent::Button { control, down: false });
            }
        }
        for (control, touched) in (0..).zip(&mut self.touched) {
            if std::mem::take(touched) {
                emit(InputEvent::AxisTouched { control, down: false });
            }
        }
        self.motors.forget();
    }

    fn started(&self) -> bool {
        self.started
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

#[cfg(test)]
mod tests;
