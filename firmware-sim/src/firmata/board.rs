//! The board under the protocol: pins, what each can do, and what is wired to them.
//!
//! Twenty pins as on an Arduino Uno: 0 and 1 are the serial line itself, 2 to 13 digital, 14 to 19 analog A0 to A5.
//! Source: Arduino Uno pin table; `firmata/arduino`, `Boards.h` for which pins have PWM.

use crate::travel::Travel;

/// Pins there are.
pub(super) const PINS: u8 = 20;
/// First of the analog pins.
const ANALOG_FIRST: u8 = 14;
/// Channels of the converter.
pub(super) const CHANNELS: u8 = 6;
/// Encoders the feature can hold (firmata/protocol, encoder.md).
pub(super) const ENCODERS: usize = 5;
/// Ten bits of converter.
const COUNTS_MAX: f64 = 1023.0;
/// Pins that a timer drives.
const PWM: [u8; 6] = [3, 5, 6, 9, 10, 11];

/// Pin modes (firmata/protocol, protocol.md, "Supported Modes").
pub(super) mod mode {
    pub(in super::super) const INPUT: u8 = 0x00;
    pub(in super::super) const OUTPUT: u8 = 0x01;
    pub(in super::super) const ANALOG: u8 = 0x02;
    pub(in super::super) const PWM: u8 = 0x03;
    pub(in super::super) const ENCODER: u8 = 0x09;
    pub(in super::super) const PULL_UP: u8 = 0x0B;
}

/// An incremental encoder between two pins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Encoder {
    pub(super) pins: [u8; 2],
    pub(super) position: i32,
}

/// Pins and what hangs on them.
#[derive(Clone, Debug)]
pub(super) struct Board {
    pub(super) modes: [u8; PINS as usize],
    pub(super) written: [u16; PINS as usize],
    /// Pins that a pressed button pulls to ground.
    grounded: u32,
    pub(super) pots: [Travel; CHANNELS as usize],
    pub(super) encoders: [Option<Encoder>; ENCODERS],
}

impl Board {
    pub(super) fn new() -> Self {
        let mut board = Self {
            modes: [mode::OUTPUT; PINS as usize],
            written: [0; PINS as usize],
            grounded: 0,
            pots: [Travel::default(); CHANNELS as usize],
            encoders: [None; ENCODERS],
        };
        board.forget();
        board
    }

    /// As after power-up: analog pins listen, the others are outputs at 0 (`StandardFirmata`, `systemResetCallback`).
    /// Hands stay where they are.
    pub(super) fn forget(&mut self) {
        for pin in 0..PINS {
            self.modes[usize::from(pin)] = if pin >= ANALOG_FIRST {
                mode::ANALOG
            } else {
                mode::OUTPUT
            };
        }
        self.written = [0; PINS as usize];
        self.encoders = [None; ENCODERS];
    }

    /// Modes and resolutions of a pin; none where it belongs to the serial line or is not there.
    pub(super) fn abilities(pin: u8) -> Vec<(u8, u8)> {
        if !(2..PINS).contains(&pin) {
            return Vec::new();
        }
        let mut able = vec![(mode::INPUT, 1), (mode::PULL_UP, 1), (mode::OUTPUT, 1)];
        if pin >= ANALOG_FIRST {
            able.push((mode::ANALOG, 10));
        }
        if PWM.contains(&pin) {
            able.push((mode::PWM, 8));
        }
        able.push((mode::ENCODER, 28));
        able
    }

    pub(super) fn can(pin: u8, wanted: u8) -> bool {
        Self::abilities(pin).iter().any(|&(mode, _)| mode == wanted)
    }

    /// Channel of an analog pin.
    pub(super) fn channel(pin: u8) -> Option<u8> {
        pin.checked_sub(ANALOG_FIRST).filter(|&n| n < CHANNELS)
    }

    /// Whether channel `n` is read by the converter.
    pub(super) fn converts(&self, channel: u8) -> bool {
        self.modes[usize::from(ANALOG_FIRST + channel)] == mode::ANALOG
    }

    pub(super) fn reading(&self, channel: u8, at_ns: u64) -> u16 {
        (self.pots[usize::from(channel)].at(at_ns) * COUNTS_MAX).round() as u16
    }

    pub(super) fn press(&mut self, pin: u8, down: bool) {
        let bit = 1u32.checked_shl(pin.into()).unwrap_or(0);
        self.grounded = if down {
            self.grounded | bit
        } else {
            self.grounded & !bit
        };
    }

    /// Turns the encoder wired to `pins`; one that nobody has attached turns unheard, one attached the other way
    /// round counts backwards.
    pub(super) fn turn(&mut self, pins: [u8; 2], counts: i32) {
        for encoder in self.encoders.iter_mut().flatten() {
            let way = match encoder.pins {
                [a, b] if [a, b] == pins => counts,
                [a, b] if [b, a] == pins => -counts,
                _ => 0,
            };
            encoder.position = encoder.position.wrapping_add(way);
        }
    }

    /// The eight pins of a port as inputs see them; pins that are no inputs read 0. Without a pull-up an open input
    /// reads 0 (ours: it floats).
    pub(super) fn port(&self, port: u8) -> u8 {
        (0..8).fold(0, |value, bit| {
            let pin = port * 8 + bit;
            let high =
                pin < PINS && self.modes[usize::from(pin)] == mode::PULL_UP && self.grounded >> pin & 1 == 0;
            value | u8::from(high) << bit
        })
    }

    /// Lit outputs, bit n for pin n.
    pub(super) fn lit(&self) -> u32 {
        (0..PINS)
            .filter(|&pin| {
                let drives = matches!(self.modes[usize::from(pin)], mode::OUTPUT | mode::PWM);
                drives && self.written[usize::from(pin)] > 0
            })
            .fold(0, |lit, pin| lit | 1 << pin)
    }
}
