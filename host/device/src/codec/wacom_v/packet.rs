//! Nine bytes taken apart. The first says what they are, and which of two tools they are about.

use super::PACKET_BYTES;

/// What a packet says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packet {
    /// A tool comes into range.
    Enter {
        /// Twelve bits: the kind of tool.
        kind: u16,
        /// The tool's own number.
        serial: u32,
    },
    /// The tool leaves.
    Leave,
    /// A pen, its eraser, or an airbrush's first packet.
    Pen {
        place: Place,
        pressure: u16,
        /// Bit 0 is button 1.
        buttons: u8,
        tilt: [i16; 2],
    },
    /// An airbrush's second packet.
    Airbrush {
        place: Place,
        wheel: u16,
        tilt: [i16; 2],
    },
    /// A mouse or lens cursor; what the rest means depends on the tool.
    Cursor { place: Place, throttle: i16, last: u8 },
    /// A 4D mouse's second packet.
    Rotation {
        place: Place,
        /// 0 to 1799.
        turn: u16,
    },
    /// Nothing known.
    Unknown,
}

/// Where a tool is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) x: u16,
    pub(super) y: u16,
    /// False: the tool has just left, and the place means nothing.
    pub(super) in_range: bool,
}

/// Channel and meaning.
pub(super) fn read(bytes: [u8; PACKET_BYTES]) -> (usize, Packet) {
    let [b0, b1, b2, b3, b4, b5, b6, b7, b8] = bytes;
    let [w1, w2, w3, w4, w5, w6, w7] = [b1, b2, b3, b4, b5, b6, b7].map(u16::from);
    let place = Place {
        x: w1 << 9 | w2 << 2 | w3 >> 5 & 3,
        y: (w3 & 0x1F) << 11 | w4 << 4 | w5 >> 3 & 0x0F,
        in_range: b0 & 0x40 != 0,
    };
    // Pressure, wheel and throttle share their place.
    let ten_bits = (w5 & 7) << 7 | w6;
    let tilt = [lean(b7), lean(b8)];
    let packet = match b0 {
        _ if b0 & 0xFC == 0xC0 => Packet::Enter {
            kind: w1 << 5 | w2 >> 2 & 0x1F,
            serial: serial([b2, b3, b4, b5, b6, b7]),
        },
        _ if b0 & 0xFE == 0x80 => Packet::Leave,
        _ if b0 & 0xB8 == 0xA0 => Packet::Pen {
            place,
            pressure: ten_bits,
            buttons: b0 >> 1 & 3,
            tilt,
        },
        _ if b0 & 0xBE == 0xB4 => Packet::Airbrush {
            place,
            wheel: ten_bits,
            tilt,
        },
        _ if b0 & 0xBE == 0xA8 || b0 & 0xBE == 0xB0 => Packet::Cursor {
            place,
            throttle: if b8 & 8 == 0 {
                ten_bits as i16
            } else {
                -(ten_bits as i16)
            },
            last: b8,
        },
        _ if b0 & 0xBE == 0xAA => Packet::Rotation {
            place,
            turn: (w6 & 0x0F) << 7 | w7,
        },
        _ => Packet::Unknown,
    };
    (usize::from(b0 & 1), packet)
}

/// Thirty-two bits over six bytes of seven.
fn serial([b2, b3, b4, b5, b6, b7]: [u8; 6]) -> u32 {
    let [b2, b3, b4, b5, b6, b7] = [b2, b3, b4, b5, b6, b7].map(u32::from);
    (b2 & 3) << 30 | b3 << 23 | b4 << 16 | b5 << 9 | b6 << 2 | b7 >> 5 & 3
}

/// Seven bits, two's complement.
fn lean(byte: u8) -> i16 {
    i16::from((byte << 1) as i8 >> 1)
}
