//! Packets of seven bytes, nine with tilt, out of a stream. Only a packet's first byte has bit 7.

use super::answer::Identity;
use device_profiles::InputProfile;

/// What the bits of a packet mean on this tablet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Format {
    pub(super) tilt: bool,
    pub(super) pressure_max: u16,
    /// Pressure bits beyond the seven of the last byte.
    extra_bits: u32,
}

impl Format {
    /// The profile's, as far as the tablet's ROM goes: on the Digitizer II eight bits of pressure came with
    /// 1.2, tilt with 1.4.
    pub(super) fn new(profile: &InputProfile, identity: Option<&Identity>) -> Self {
        let version = identity.and_then(|i| i.version);
        let older_than = |than| version.is_some_and(|v| v < than);
        let old_digitizer = profile.answer_prefix() == "UD" && older_than((1, 2));
        let pressure_max = if old_digitizer {
            120
        } else {
            u16::try_from(profile.area().pressure).unwrap_or(u16::MAX)
        };
        let extra_bits = match pressure_max {
            0..=127 => 0,
            128..=255 => 1,
            _ => 2,
        };
        Self {
            tilt: profile.area().tilt() && !older_than((1, 4)),
            pressure_max,
            extra_bits,
        }
    }

    fn bytes(self) -> usize {
        if self.tilt { 9 } else { 7 }
    }
}

/// A packet taken apart, before anybody knows which end of the pen it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Raw {
    pub(super) in_range: bool,
    pub(super) stylus: bool,
    pub(super) x: u16,
    pub(super) y: u16,
    /// Bit 0 is the tip or the puck's first button.
    pub(super) buttons: u8,
    pub(super) pressure: u16,
    pub(super) wheel: i8,
    pub(super) tilt: Option<[i8; 2]>,
}

/// What one byte brought about: at most the packet it cut short and the one it completes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pushed {
    pub(super) packets: [Option<Raw>; 2],
    pub(super) unknown: bool,
    pub(super) rejected: bool,
}

/// Puts packets together.
#[derive(Debug)]
pub(super) struct Packets {
    format: Format,
    bytes: [u8; 9],
    have: usize,
}

impl Packets {
    pub(super) fn new(format: Format) -> Self {
        Self {
            format,
            bytes: [0; 9],
            have: 0,
        }
    }

    pub(super) fn format(&self) -> Format {
        self.format
    }

    pub(super) fn reset(&mut self) {
        self.have = 0;
    }

    pub(super) fn unfinished(&self) -> bool {
        self.have > 0
    }

    pub(super) fn push(&mut self, byte: u8) -> Pushed {
        let mut pushed = Pushed::default();
        if byte & 0x80 != 0 {
            // A whole packet without its tilt is still a packet: not every tool has one.
            if self.have == 7 {
                pushed.packets[0] = Some(self.take());
            }
            pushed.rejected = self.have != 0;
            self.have = 0;
        } else if self.have == 0 {
            pushed.unknown = true;
            return pushed;
        }
        if let Some(place) = self.bytes.get_mut(self.have) {
            *place = byte;
            self.have += 1;
        }
        if self.have >= self.format.bytes() {
            pushed.packets[1] = Some(self.take());
        }
        pushed
    }

    fn take(&mut self) -> Raw {
        let [b0, b1, b2, b3, b4, b5, b6, b7, b8] = self.bytes;
        let tilt = (self.have == 9).then(|| [lean(b7), lean(b8)]);
        self.have = 0;
        let coordinate = |top: u8, middle: u8, low: u8| {
            u16::from(top & 3) << 14 | u16::from(middle & 0x7F) << 7 | u16::from(low & 0x7F)
        };
        let clicks = (b6 >> 4 & 3) as i8;
        Raw {
            in_range: b0 & 0x40 != 0,
            stylus: b0 & 0x20 != 0,
            x: coordinate(b0, b1, b2),
            y: coordinate(b3, b4, b5),
            buttons: b3 >> 3 & 0x0F,
            pressure: self.pressure(b0, b3, b6),
            wheel: if b6 & 0x40 == 0 { clicks } else { -clicks },
            tilt,
        }
    }

    /// The last byte holds the high seven bits with their sign turned; the rest is scattered.
    fn pressure(&self, b0: u8, b3: u8, b6: u8) -> u16 {
        let high = u16::from((b6 ^ 0x40) & 0x7F);
        let (mid, low) = (u16::from(b3 >> 2 & 1), u16::from(b0 >> 2 & 1));
        let pressure = match self.format.extra_bits {
            0 => high,
            1 => high << 1 | mid,
            _ => high << 2 | mid << 1 | low,
        };
        pressure.min(self.format.pressure_max)
    }
}

/// Seven bits, two's complement.
fn lean(byte: u8) -> i8 {
    (byte << 1) as i8 >> 1
}
