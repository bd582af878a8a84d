//! The 339 bytes that say what each control says, and their dress of seven bits. Korg's table 1 and note 2.

/// Bytes of a scene.
const BYTES: usize = 339;
/// The same in groups of seven bits.
const PACKED_BYTES: usize = 388;
/// Bytes of a strip's settings, and where the first begins.
const STRIP_BYTES: usize = 31;
const STRIPS_AT: usize = 3;
/// Transport's channel; its buttons follow, six bytes each.
const TRANSPORT_AT: usize = 251;
/// In place of a channel: the global one.
const FOLLOWS_GLOBAL: u8 = 16;

/// What a button says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// It does nothing.
    Nothing,
    /// A control change.
    Control,
    /// A note.
    Note,
}

/// One button's settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ButtonSetting {
    pub(super) kind: Kind,
    /// Each press turns it over.
    pub(super) toggles: bool,
    /// From 1.
    pub(super) channel: u8,
    pub(super) number: u8,
    pub(super) off: u8,
    pub(super) on: u8,
}

/// One slider's or knob's settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct AxisSetting {
    /// From 1.
    pub(super) channel: u8,
    pub(super) number: u8,
    pub(super) min: u8,
    pub(super) max: u8,
}

/// A scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Scene([u8; BYTES]);

impl Scene {
    /// As the box comes, lamps apart: channel 1, control changes 0–7 sliders, 16–23 knobs, 32–39 S, 48–55 M, 64–71 R
    /// and the transport's, all momentary.
    pub(super) fn factory(host_lamps: bool) -> Self {
        let mut bytes = [0; BYTES];
        bytes[2] = u8::from(host_lamps);
        for strip in 0..8_u8 {
            let at = STRIPS_AT + STRIP_BYTES * usize::from(strip);
            bytes[at] = FOLLOWS_GLOBAL;
            for (axis, number) in [(at + 1, strip), (at + 7, 16 + strip)] {
                bytes[axis..axis + 5].copy_from_slice(&[1, 0, number, 0, 127]);
            }
            for (button, number) in [
                (at + 13, 32 + strip),
                (at + 19, 48 + strip),
                (at + 25, 64 + strip),
            ] {
                bytes[button..button + 5].copy_from_slice(&[1, 0, number, 0, 127]);
            }
        }
        bytes[TRANSPORT_AT] = FOLLOWS_GLOBAL;
        for (nth, number) in (0..).zip(super::TRANSPORT) {
            let at = TRANSPORT_AT + 1 + 6 * nth;
            bytes[at..at + 5].copy_from_slice(&[1, 0, number, 0, 127]);
        }
        Self(bytes)
    }

    /// From 0.
    pub(super) fn global_channel(&self) -> u8 {
        self.0[0] & 0x0F
    }

    /// Whether lamps are the host's.
    pub(super) fn host_lamps(&self) -> bool {
        self.0[2] == 1
    }

    fn channel(&self, at: usize) -> u8 {
        let channel = self.0[at];
        1 + if channel < FOLLOWS_GLOBAL {
            channel
        } else {
            self.global_channel()
        }
    }

    /// Sliders are 0 to 7, knobs 8 to 15; none for what is switched off.
    pub(super) fn axis(&self, axis: usize) -> Option<AxisSetting> {
        let strip = STRIPS_AT + STRIP_BYTES * (axis % 8);
        let at = strip + if axis < 8 { 1 } else { 7 };
        let [enabled, _, number, min, max] = self.five(at);
        (enabled == 1).then(|| AxisSetting {
            channel: self.channel(strip),
            number,
            min,
            max,
        })
    }

    /// S of the eight strips, then M, R, and transport.
    pub(super) fn button(&self, control: u8) -> ButtonSetting {
        let control = usize::from(control);
        let (channel_at, at) = if control < 24 {
            let strip = STRIPS_AT + STRIP_BYTES * (control % 8);
            (strip, strip + 13 + 6 * (control / 8))
        } else {
            (TRANSPORT_AT, TRANSPORT_AT + 1 + 6 * (control - 24))
        };
        let [kind, behaviour, number, off, on] = self.five(at);
        ButtonSetting {
            kind: match kind {
                1 => Kind::Control,
                2 => Kind::Note,
                _ => Kind::Nothing,
            },
            toggles: behaviour == 1,
            channel: self.channel(channel_at),
            number,
            off,
            on,
        }
    }

    fn five(&self, at: usize) -> [u8; 5] {
        let mut five = [0; 5];
        five.copy_from_slice(&self.0[at..at + 5]);
        five.map(|byte| byte & 0x7F)
    }

    /// Seven bytes become eight: first their top bits, the first byte's lowest.
    pub(super) fn packed(&self) -> Vec<u8> {
        let mut packed = Vec::with_capacity(PACKED_BYTES);
        for seven in self.0.chunks(7) {
            let tops = (0..)
                .zip(seven)
                .fold(0, |tops, (n, byte)| tops | (byte >> 7) << n);
            packed.push(tops);
            packed.extend(seven.iter().map(|byte| byte & 0x7F));
        }
        packed
    }

    /// None if it is not as long as a scene.
    pub(super) fn unpacked(packed: &[u8]) -> Option<Self> {
        if packed.len() != PACKED_BYTES {
            return None;
        }
        let mut bytes = Vec::with_capacity(BYTES);
        for eight in packed.chunks(8) {
            let (&tops, seven) = eight.split_first()?;
            bytes.extend((0..).zip(seven).map(|(n, byte)| byte | (tops >> n & 1) << 7));
        }
        bytes.try_into().ok().map(Self)
    }
}
