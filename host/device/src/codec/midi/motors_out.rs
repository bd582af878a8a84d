//! Which message moves which fader, or sets the value that an encoder keeps.
//!
//! Source: `docs/protocols/midi.md`, "Motors".

use crate::codec::Outgoing;
use device_profiles::{ControlClass, InputProfile, OutputKind};

/// The message of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// Pitch bend of this channel (0 to 15), fourteen bits.
    Bend(u8),
    /// Control change, seven bits; fourteen where `fine`, high bits first.
    Change { channel: u8, number: u8, fine: bool },
}

/// The ways of all axes.
#[derive(Debug, Default)]
pub(super) struct MotorsOut {
    ways: Vec<Option<Way>>,
}

impl MotorsOut {
    /// Motors belong to the group of controls that they are `of`, one beside each.
    pub(super) fn new(profile: &InputProfile) -> Self {
        let mut ways = vec![None; usize::from(profile.count(ControlClass::Axis))];
        for output in profile.outputs.iter().filter(|o| o.kind == OutputKind::Motor) {
            let mut axes = profile.numbered(ControlClass::Axis);
            let group = |name: &str| output.of.as_deref().is_none_or(|of| of == name);
            let Some((first, control)) = axes.find(|(_, control)| group(&control.name)) else {
                continue;
            };
            // What moves it is what it says, unless the output has messages of its own.
            let Some(midi) = output.midi.as_ref().or(control.midi.as_ref()) else {
                continue;
            };
            let fine = output.levels.is_some_and(|levels| levels > 128);
            for n in 0..output.count {
                let channel = midi.channel_of(n).saturating_sub(1);
                let way = match midi.cc_of(n) {
                    _ if midi.bend => Some(Way::Bend(channel)),
                    Some(number) => Some(Way::Change {
                        channel,
                        number,
                        fine,
                    }),
                    None => None,
                };
                if let Some(place) = ways.get_mut(usize::from(first.saturating_add(n))) {
                    *place = way;
                }
            }
        }
        Self { ways }
    }

    pub(super) fn has(&self, axis: u16) -> bool {
        matches!(self.ways.get(usize::from(axis)), Some(Some(_)))
    }

    /// Whether it runs back to where the host last put it when it is let go, as motor faders do (Mackie), so that it
    /// must be told where it was taken.
    pub(super) fn forgets(&self, axis: u16) -> bool {
        matches!(self.ways.get(usize::from(axis)), Some(Some(Way::Bend(_))))
    }

    /// Sends `value`, counts of the axis, kept within what the message holds.
    pub(super) fn send(&self, axis: u16, value: i32, out: &mut Outgoing) {
        let Some(&Some(way)) = self.ways.get(usize::from(axis)) else {
            return;
        };
        let fourteen = value.clamp(0, 0x3FFF) as u16;
        let (high, low) = ((fourteen >> 7) as u8, fourteen as u8 & 0x7F);
        match way {
            Way::Bend(channel) => out.bytes(&[0xE0 | channel, low, high]),
            Way::Change {
                channel,
                number,
                fine: true,
            } => out.bytes(&[
                0xB0 | channel,
                number,
                high,
                0xB0 | channel,
                number.saturating_add(32) & 0x7F,
                low,
            ]),
            Way::Change {
                channel,
                number,
                fine: false,
            } => out.bytes(&[0xB0 | channel, number, value.clamp(0, 127) as u8]),
        }
    }
}
