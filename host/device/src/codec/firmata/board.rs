//! What the board has said of its pins, and the commands that make them what the profile wants.

use super::Settings;
use super::message::{ENCODERS, SYSEX, SYSEX_END};
use crate::codec::Outgoing;

/// Modes of a pin.
const INPUT: u8 = 0x00;
const OUTPUT: u8 = 0x01;
const ANALOG: u8 = 0x02;
const DIMMED: u8 = 0x03;
const ENCODER: u8 = 0x09;
const PULL_UP: u8 = 0x0B;
/// Bits of a converter that does not say.
const ANALOG_BITS: u8 = 10;
/// In place of a channel: the pin has none.
const NO_CHANNEL: u8 = 0x7F;
/// Ends the modes of a pin.
const PIN_END: u8 = 0x7F;
/// Everything as after switching on.
const RESET: u8 = 0xFF;

/// Pins and channels; empty where the board does not say. What it says again goes where it went before.
#[derive(Clone, Debug, Default)]
pub(super) struct Board {
    /// Modes with their resolution, of one pin after another.
    modes: Vec<[u8; 2]>,
    /// By pin: where its modes end.
    ends: Vec<usize>,
    /// By pin: analog channel.
    channels: Vec<u8>,
}

impl Board {
    pub(super) fn learn_capabilities(&mut self, rest: &[u8]) {
        self.modes.clear();
        self.ends.clear();
        // Every pin ends with the mark; what is behind the last is none.
        for pin in rest.split_inclusive(|&byte| byte == PIN_END) {
            let Some((&PIN_END, modes)) = pin.split_last() else {
                return;
            };
            let pairs = modes.chunks_exact(2);
            self.modes
                .extend(pairs.filter_map(|pair| <[u8; 2]>::try_from(pair).ok()));
            self.ends.push(self.modes.len());
        }
    }

    pub(super) fn learn_mapping(&mut self, rest: &[u8]) {
        self.channels.clear();
        self.channels.extend_from_slice(rest);
    }

    pub(super) fn channel_of(&self, pin: u8) -> Option<u8> {
        let channel = *self.channels.get(usize::from(pin))?;
        (channel != NO_CHANNEL).then_some(channel)
    }

    fn pin_of(&self, channel: u8) -> Option<u8> {
        let pin = self.channels.iter().position(|&on| on == channel)?;
        u8::try_from(pin).ok()
    }

    /// Whether a pin can be used so; a board that has not said can do everything.
    pub(super) fn can(&self, pin: u8, mode: u8) -> bool {
        self.ends.is_empty() || self.resolution(pin, mode).is_some()
    }

    fn resolution(&self, pin: u8, mode: u8) -> Option<u8> {
        let pin = usize::from(pin);
        let end = *self.ends.get(pin)?;
        let start = pin.checked_sub(1).and_then(|before| self.ends.get(before));
        let modes = self.modes.get(start.copied().unwrap_or(0)..end)?;
        modes.iter().find(|[of, _]| *of == mode).map(|[_, bits]| *bits)
    }

    /// A converter's value on a scale of `max`.
    pub(super) fn scaled(&self, channel: u8, raw: u32, max: i32) -> i32 {
        let bits = self
            .pin_of(channel)
            .and_then(|pin| self.resolution(pin, ANALOG))
            .filter(|bits| (1..=28).contains(bits))
            .unwrap_or(ANALOG_BITS);
        let full = (1_i64 << bits) - 1;
        let raw = i64::from(raw).min(full);
        ((raw * i64::from(max) + full / 2) / full) as i32
    }

    /// Sends what makes the pins report. Returns how many of them the board cannot use so.
    pub(super) fn set_up(&self, settings: &Settings, out: &mut Outgoing) -> u64 {
        out.bytes(&[RESET]);
        let [low, high] = sevens(settings.interval_ms);
        out.bytes(&[SYSEX, 0x7A, low, high, SYSEX_END]);
        self.set_up_analog(settings, out)
            + self.set_up_switches(settings, out)
            + self.set_up_encoders(settings, out)
    }

    fn set_up_analog(&self, settings: &Settings, out: &mut Outgoing) -> u64 {
        let mut missing = 0;
        for &channel in &settings.analog {
            let pin = self.pin_of(channel);
            let cannot = match pin {
                Some(pin) => !self.can(pin, ANALOG),
                None => !self.channels.is_empty(),
            };
            if cannot || channel > 15 {
                missing += 1;
                continue;
            }
            if let Some(pin) = pin {
                out.bytes(&[0xF4, pin, ANALOG]);
            }
            out.bytes(&[0xC0 | channel, 1]);
        }
        missing
    }

    fn set_up_switches(&self, settings: &Settings, out: &mut Outgoing) -> u64 {
        let mut missing = 0;
        let mut ports = 0_u16;
        for switch in &settings.digital {
            if switch.pin >= 128 || !self.can(switch.pin, INPUT) {
                missing += 1;
                continue;
            }
            let pull_up = switch.pull_up && self.can(switch.pin, PULL_UP);
            out.bytes(&[0xF4, switch.pin, if pull_up { PULL_UP } else { INPUT }]);
            ports |= 1 << (switch.pin / 8);
        }
        for port in (0..16).filter(|port| ports >> port & 1 == 1) {
            out.bytes(&[0xD0 | port, 1]);
        }
        missing
    }

    fn set_up_encoders(&self, settings: &Settings, out: &mut Outgoing) -> u64 {
        let mut missing = 0;
        let mut any = false;
        for (number, &[a, b]) in (0_u8..).zip(&settings.encoders) {
            if !self.can(a, ENCODER) || !self.can(b, ENCODER) {
                missing += 1;
                continue;
            }
            out.bytes(&[SYSEX, ENCODERS, 0x00, number, a & 0x7F, b & 0x7F, SYSEX_END]);
            any = true;
        }
        if any {
            out.bytes(&[SYSEX, ENCODERS, 0x04, 1, SYSEX_END]);
        }
        missing
    }

    /// Makes a lamp's pin an output. True: it can be dimmed.
    pub(super) fn set_up_lamp(&self, pin: u8, dimmed: bool, out: &mut Outgoing) -> bool {
        let dims = dimmed && self.can(pin, DIMMED);
        out.bytes(&[0xF4, pin & 0x7F, if dims { DIMMED } else { OUTPUT }]);
        dims
    }
}

/// The lower and the upper seven bits.
pub(super) fn sevens(value: u16) -> [u8; 2] {
    [(value & 0x7F) as u8, (value >> 7 & 0x7F) as u8]
}
