//! Which control each message is about: two tables and what fine values need to be put together.
//!
//! A table is an array, so that a message costs two look-ups whatever the profile's size.

use super::relative::steps;
use crate::codec::InputEvent;
use device_profiles::{Control, ControlClass, ControlKind, Encoding, InputProfile, MidiAddress};

const CHANNELS: usize = 16;
const NUMBERS: usize = 128;
/// The low seven bits of controller n come as controller n + 32 (MIDI 1.0, "Control Change").
const FINE_OFFSET: u8 = 32;

/// What a message says of a control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Target {
    Dial {
        control: u16,
        encoding: Encoding,
    },
    /// A controller whose coming is itself a step: 96 and 97.
    Step {
        control: u16,
        by: i32,
    },
    /// Seven bits.
    Axis {
        control: u16,
    },
    High {
        control: u16,
    },
    Low {
        control: u16,
    },
    Ring {
        control: u16,
    },
    Button {
        control: u16,
    },
    Touch {
        axis: u16,
    },
}

/// At most two things hang on one message: a pad may be a button and, by its velocity, an axis.
type Slot = [Option<Target>; 2];

/// What came of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// It belongs to a control, or says nothing about any.
    Fine,
    /// It belongs to a control and has a value that control cannot have.
    Impossible,
}

/// The tables of one profile.
#[derive(Debug)]
pub(super) struct Heard {
    changes: Vec<Slot>,
    notes: Vec<Slot>,
    bends: [Option<Target>; CHANNELS],
    /// High bits of each fine axis, once they came.
    high: Vec<Option<u8>>,
    /// An axis whose high bits came and whose low ones may follow.
    waiting: Option<u16>,
    down: Vec<bool>,
    touched: Vec<bool>,
}

impl Heard {
    pub(super) fn new(profile: &InputProfile) -> Self {
        let count = |class| usize::from(profile.count(class));
        let mut heard = Self {
            changes: vec![Slot::default(); CHANNELS * NUMBERS],
            notes: vec![Slot::default(); CHANNELS * NUMBERS],
            bends: [None; CHANNELS],
            high: vec![None; count(ControlClass::Axis)],
            waiting: None,
            down: vec![false; count(ControlClass::Button)],
            touched: vec![false; count(ControlClass::Axis)],
        };
        let mut next = [0u16; 4];
        for control in &profile.controls {
            let class = control.kind.class();
            let first = &mut next[class as usize];
            if let Some(midi) = &control.midi {
                heard.listen(control, midi, *first);
            }
            if let Some(touch) = &control.touch
                && class == ControlClass::Axis
            {
                for n in 0..control.count {
                    let axis = first.saturating_add(n);
                    heard.put(touch, n, Target::Touch { axis });
                }
            }
            *first = first.saturating_add(control.count);
        }
        heard
    }

    fn listen(&mut self, group: &Control, midi: &MidiAddress, first: u16) {
        for n in 0..group.count {
            let control = first.saturating_add(n);
            match (group.kind, group.encoding) {
                (ControlKind::Button, _) => self.put(midi, n, Target::Button { control }),
                (ControlKind::Ring | ControlKind::Strip, _) => self.put(midi, n, Target::Ring { control }),
                (ControlKind::Dial, Some(Encoding::DataIncDec)) => {
                    for (after, by) in [(0, 1), (1, -1)] {
                        let number = midi.cc_of(n).map(|cc| cc.saturating_add(after));
                        put(
                            &mut self.changes,
                            midi.channel_of(n),
                            number,
                            Target::Step { control, by },
                        );
                    }
                }
                (ControlKind::Dial, encoding) => {
                    let encoding = encoding.unwrap_or(Encoding::TwosComplement);
                    self.put(midi, n, Target::Dial { control, encoding });
                }
                (_, Some(Encoding::Absolute14)) if !midi.bend => {
                    self.put(midi, n, Target::High { control });
                    let low = midi.cc_of(n).map(|cc| cc.saturating_add(FINE_OFFSET));
                    put(
                        &mut self.changes,
                        midi.channel_of(n),
                        low,
                        Target::Low { control },
                    );
                }
                _ => self.put(midi, n, Target::Axis { control }),
            }
        }
    }

    fn put(&mut self, midi: &MidiAddress, n: u16, target: Target) {
        let channel = midi.channel_of(n);
        put(&mut self.changes, channel, midi.cc_of(n), target);
        put(&mut self.notes, channel, midi.note_of(n), target);
        if midi.bend
            && let Some(place) = self.bends.get_mut(usize::from(channel.wrapping_sub(1)))
        {
            *place = Some(target);
        }
    }

    /// Says what a channel's message means.
    pub(super) fn take(&mut self, status: u8, data: [u8; 2], emit: &mut dyn FnMut(InputEvent)) -> Outcome {
        let channel = usize::from(status & 0x0F);
        let at = channel * NUMBERS + usize::from(data[0] & 0x7F);
        let (slot, value) = match status & 0xF0 {
            0xB0 => (self.changes.get(at), data[1]),
            0x90 => (self.notes.get(at), data[1]),
            0x80 => (self.notes.get(at), 0),
            0xE0 => {
                self.flush(emit);
                let value = i32::from(data[0]) | i32::from(data[1]) << 7;
                if let Some(Some(Target::Axis { control })) = self.bends.get(channel) {
                    emit(InputEvent::Axis {
                        control: *control,
                        value,
                    });
                }
                return Outcome::Fine;
            }
            _ => {
                self.flush(emit);
                return Outcome::Fine;
            }
        };
        let slot = slot.copied().unwrap_or_default();
        // High bits without low ones behind them mean that those are 0.
        let completes = slot
            .iter()
            .flatten()
            .any(|target| matches!(target, Target::Low { control } if Some(*control) == self.waiting));
        if !completes {
            self.flush(emit);
        }
        let mut outcome = Outcome::Fine;
        for target in slot.into_iter().flatten() {
            if self.tell(target, value, emit) == Outcome::Impossible {
                outcome = Outcome::Impossible;
            }
        }
        outcome
    }

    fn tell(&mut self, target: Target, value: u8, emit: &mut dyn FnMut(InputEvent)) -> Outcome {
        match target {
            Target::Dial { control, encoding } => match steps(encoding, value) {
                None => return Outcome::Impossible,
                Some(0) => {}
                Some(delta_counts) => emit(InputEvent::Dial {
                    control,
                    delta_counts,
                }),
            },
            Target::Step { control, by } => emit(InputEvent::Dial {
                control,
                delta_counts: by,
            }),
            Target::Axis { control } => emit(InputEvent::Axis {
                control,
                value: value.into(),
            }),
            Target::High { control } => {
                if let Some(high) = self.high.get_mut(usize::from(control)) {
                    *high = Some(value);
                    self.waiting = Some(control);
                }
            }
            Target::Low { control } => {
                self.waiting = None;
                // Low bits of a place whose high ones were never said are no place.
                if let Some(&Some(high)) = self.high.get(usize::from(control)) {
                    emit(InputEvent::Axis {
                        control,
                        value: i32::from(high) << 7 | i32::from(value),
                    });
                }
            }
            Target::Ring { control } => emit(InputEvent::Ring {
                control,
                value: Some(value.into()),
            }),
            Target::Button { control } => {
                edge(&mut self.down, control, value > 0, |down| {
                    emit(InputEvent::Button { control, down });
                });
            }
            Target::Touch { axis } => {
                edge(&mut self.touched, axis, value > 0, |down| {
                    emit(InputEvent::AxisTouched { control: axis, down });
                });
            }
        }
        Outcome::Fine
    }

    /// Whether high bits wait for low ones.
    pub(super) fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// The low bits are not coming: they are 0.
    pub(super) fn flush(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        let Some(control) = self.waiting.take() else {
            return;
        };
        if let Some(&Some(high)) = self.high.get(usize::from(control)) {
            emit(InputEvent::Axis {
                control,
                value: i32::from(high) << 7,
            });
        }
    }

    /// Everything held is let go.
    pub(super) fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        self.waiting = None;
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
    }
}

fn put(table: &mut [Slot], channel: u8, number: Option<u8>, target: Target) {
    let Some(number) = number else { return };
    let at = usize::from(channel.wrapping_sub(1)) * NUMBERS + usize::from(number);
    let Some(slot) = table.get_mut(at) else { return };
    if let Some(free) = slot.iter_mut().find(|place| place.is_none()) {
        *free = Some(target);
    }
}

/// A note repeated while it sounds is no second press.
fn edge(held: &mut [bool], control: u16, now: bool, say: impl FnOnce(bool)) {
    if let Some(held) = held.get_mut(usize::from(control))
        && *held != now
    {
        *held = now;
        say(now);
    }
}
