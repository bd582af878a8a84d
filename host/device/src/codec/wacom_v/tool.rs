//! One of the two channels: which tool is on it, and what its packets mean.

use super::packet::{Packet, Place};
use super::{AIRBRUSH_WHEEL, THROTTLE};
use crate::codec::held::Held;
use crate::codec::{InputEvent, PenSample, Tool};

/// The kinds of tool whose packets differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Pen,
    Eraser,
    Mouse2D,
    Mouse4D,
    Lens,
    /// Its coming was not heard, or its code is not known: its packets tell pens from cursors, no more.
    Unheard,
}

impl Kind {
    /// By the lowest eleven bits, as xf86-input-wacom tells them apart. It takes all other codes for erasers; their
    /// known codes end in A, and so must the unknown ones here.
    fn of(code: u16) -> Self {
        match code & 0x7FF {
            0x007 => Self::Mouse2D,
            0x094 => Self::Mouse4D,
            0x096 => Self::Lens,
            0x012 | 0x022 | 0x032 | 0x042 | 0x052 | 0x112 => Self::Pen,
            code if code & 0x0F == 0x0A => Self::Eraser,
            _ => Self::Unheard,
        }
    }
}

/// The tool that has come on a channel.
#[derive(Clone, Copy, Debug)]
struct Identified {
    kind: Kind,
    code: Option<u16>,
    serial: Option<u32>,
}

const UNHEARD: Identified = Identified {
    kind: Kind::Unheard,
    code: None,
    serial: None,
};

/// What is known of one channel.
#[derive(Clone, Debug)]
pub(super) struct Channel {
    tip_pressure: u32,
    identified: Identified,
    held: Held,
    twist: Option<i16>,
    wheel: Option<u16>,
    throttle: i16,
}

impl Channel {
    pub(super) fn new(tip_pressure: u32) -> Self {
        Self {
            tip_pressure: tip_pressure.max(1),
            identified: UNHEARD,
            held: Held::default(),
            twist: None,
            wheel: None,
            throttle: 0,
        }
    }

    pub(super) fn take(&mut self, packet: Packet, emit: &mut dyn FnMut(InputEvent)) {
        match packet {
            Packet::Enter { kind, serial } => {
                // Its leaving may have been lost.
                self.leave(emit);
                self.identified = Identified {
                    kind: Kind::of(kind),
                    code: Some(kind),
                    serial: Some(serial),
                };
            }
            Packet::Pen { place, .. }
            | Packet::Airbrush { place, .. }
            | Packet::Cursor { place, .. }
            | Packet::Rotation { place, .. }
                if !place.in_range =>
            {
                self.leave(emit);
            }
            Packet::Leave => self.leave(emit),
            Packet::Pen {
                place,
                pressure,
                buttons,
                tilt,
            } => {
                let sample = PenSample {
                    pressure_counts: pressure.into(),
                    buttons: buttons.into(),
                    tip: self.tip(pressure.into()),
                    tilt: Some(tilt),
                    ..self.at(self.pen(), place)
                };
                self.held.see(sample, emit);
            }
            Packet::Airbrush { place, wheel, tilt } => self.spray(place, wheel, tilt, emit),
            Packet::Cursor {
                place,
                throttle,
                last,
            } => self.slide(place, throttle, last, emit),
            Packet::Rotation { place, turn } => {
                let turn = turn as i16;
                // Wrapped where xf86-input-wacom wraps, but 1799 and 0 stay apart.
                self.twist = Some(if turn < 900 { -turn } else { 1800 - turn });
                let sample = self.like_held(self.cursor(), place);
                self.held.see(
                    PenSample {
                        twist: self.twist,
                        ..sample
                    },
                    emit,
                );
            }
            Packet::Unknown => {}
        }
    }

    /// The tool is gone, its spring-loaded wheel at rest.
    pub(super) fn leave(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        if self.throttle != 0 {
            self.throttle = 0;
            emit(axis(THROTTLE, 0));
        }
        self.held.leave(emit);
        self.identified = UNHEARD;
        self.twist = None;
        self.wheel = None;
    }

    fn spray(&mut self, place: Place, wheel: u16, tilt: [i16; 2], emit: &mut dyn FnMut(InputEvent)) {
        let sample = PenSample {
            tilt: Some(tilt),
            ..self.like_held(self.pen(), place)
        };
        self.held.see(sample, emit);
        if self.wheel.replace(wheel) != Some(wheel) {
            emit(axis(AIRBRUSH_WHEEL, wheel.into()));
        }
    }

    fn slide(&mut self, place: Place, throttle: i16, last: u8, emit: &mut dyn FnMut(InputEvent)) {
        let (buttons, wheel) = match self.identified.kind {
            Kind::Mouse4D => ((last & 0x70) >> 1 | last & 7, 0),
            Kind::Lens => (last, 0),
            Kind::Mouse2D => (last >> 2 & 7, i16::from(last >> 1 & 1) - i16::from(last & 1)),
            // Which bits are buttons is not known.
            Kind::Pen | Kind::Eraser | Kind::Unheard => (0, 0),
        };
        let sample = PenSample {
            buttons: buttons.into(),
            wheel,
            twist: self.twist,
            ..self.at(self.cursor(), place)
        };
        self.held.see(sample, emit);
        if self.identified.kind == Kind::Mouse4D && self.throttle != throttle {
            self.throttle = throttle;
            emit(axis(THROTTLE, throttle.into()));
        }
    }

    fn pen(&self) -> Tool {
        match self.identified.kind {
            Kind::Eraser => Tool::Eraser,
            _ => Tool::Pen,
        }
    }

    fn cursor(&self) -> Tool {
        match self.identified.kind {
            Kind::Mouse2D | Kind::Mouse4D => Tool::Mouse,
            _ => Tool::Puck,
        }
    }

    /// With hysteresis: pressure trembles.
    fn tip(&self, pressure: u32) -> bool {
        if self.held.sample().is_some_and(|held| held.tip) {
            pressure >= self.tip_pressure.div_ceil(2)
        } else {
            pressure >= self.tip_pressure
        }
    }

    fn at(&self, tool: Tool, place: Place) -> PenSample {
        PenSample {
            tool_serial: self.identified.serial.map(Into::into),
            tool_type: self.identified.code.map(Into::into),
            ..PenSample::hovering(tool, place.x.into(), place.y.into())
        }
    }

    /// Like the last sample, at another place: for packets that say only a part.
    fn like_held(&self, tool: Tool, place: Place) -> PenSample {
        let new = self.at(tool, place);
        match self.held.sample() {
            Some(held) if held.tool == tool && held.tool_serial == new.tool_serial => PenSample {
                x_counts: new.x_counts,
                y_counts: new.y_counts,
                wheel: 0,
                ..held
            },
            _ => new,
        }
    }
}

fn axis(control: u16, value: i32) -> InputEvent {
    InputEvent::Axis { control, value }
}
