//! The XP-Pen Deco 01 V2: a keyboard and a coarse pen until output report `02 B0 04` makes it a tablet.
//!
//! Before: keys come as a keyboard's (report 6, interface 0), the pen on a 0–32767 scale (report 7, interface 1).
//! After: both as report 2 of interface 2. Revision B, when its string 100 is read after that, leaves the bus and comes
//! back with another product id, a tablet from the start.
//! Source: `docs/simulators.md`, "Deco 01 V2" (DIGImend tablets and kernel drivers, OpenTabletDriver).

use crate::hands::{Pen, Touch};
use crate::usb_device::pad::{Doing, Pad, counts, place, pressure};
use crate::usb_device::{
    Chassis, Descriptor, HidInterface, Inside, Moment, Report, Stall, UsbDevice, UsbFacts, string_descriptor,
};

/// Counts of the surface in full mode.
pub const MAX: [u32; 2] = [25_400, 15_875];
const DEFAULT_MAX: u32 = 32_767;
const PRESSURE_MAX: u16 = 8191;
const KEYS: u8 = 8;
const INTERVAL_US: u64 = 4_000;

/// String 100 as the device sent it: length, type, counts of both sides with the number of keys between, pressure,
/// lines per inch.
const PARAMETERS: [u8; 12] = [
    0x0C, 0x03, 0x38, 0x63, 0x03, 0x3E, 0x08, 0x00, 0xFF, 0x1F, 0xEC, 0x09,
];
/// What makes it a tablet; seven bytes of nothing follow.
const INIT: [u8; 3] = [0x02, 0xB0, 0x04];
/// Product ids before and after revision B has left the bus.
const PRODUCTS: [u16; 2] = [0x0905, 0x1227];
/// What keys are before the handshake: modifiers and usage of a keyboard. The first was recorded; the rest are ours.
const SHORTCUTS: [[u8; 2]; KEYS as usize] = [
    [1, 0x57],
    [1, 0x56],
    [1, 0x1D],
    [1, 0x06],
    [1, 0x19],
    [0, 0x2C],
    [0, 0x05],
    [0, 0x08],
];

/// A Deco 01 V2 that keeps its id, plugged in.
pub fn deco_01_v2() -> Box<dyn UsbDevice> {
    Box::new(Chassis::new(Deco::new(false)))
}

/// Revision B, which comes back as another product.
pub fn deco_01_v2_rev_b() -> Box<dyn UsbDevice> {
    Box::new(Chassis::new(Deco::new(true)))
}

#[derive(Debug)]
struct Deco {
    rev_b: bool,
    full: bool,
    moved: bool,
    pad: Pad,
}

fn switches(pen: &Pen) -> u8 {
    u8::from(pen.tip) | (pen.buttons & 3) << 1 | u8::from(pen.eraser) << 3
}

/// Lean to the right, and towards the hand.
fn tilt(pen: &Pen) -> [u8; 2] {
    let [right, up] = pen.tilt_deg;
    [right as u8, up.saturating_neg() as u8]
}

/// Both modes lay the pen out alike: switches, place, pressure, lean.
fn pen_bytes(id: u8, switches: u8, at: [u32; 2], pen: &Pen) -> Vec<u8> {
    let [x, y] = at.map(u32::to_le_bytes);
    let [low, high] = pressure(pen, PRESSURE_MAX).to_le_bytes();
    let [right, down] = tilt(pen);
    vec![id, switches, x[0], x[1], y[0], y[1], low, high, right, down]
}

impl Deco {
    fn new(rev_b: bool) -> Self {
        Self {
            rev_b,
            full: false,
            moved: false,
            pad: Pad::new(KEYS, 0),
        }
    }

    fn full_report(doing: &Doing) -> Option<Report> {
        let bytes = match doing {
            Doing::Pen(pen) | Doing::Left(pen) => {
                let state = if matches!(doing, Doing::Pen(_)) {
                    0xA0 | switches(pen)
                } else {
                    0xC0
                };
                let at = place(pen, MAX);
                let mut bytes = pen_bytes(2, state, at, pen);
                bytes.extend(at.map(|counts| counts.to_le_bytes()[2]));
                bytes
            }
            Doing::Keys(keys) => {
                let [low, high] = keys.to_le_bytes();
                vec![2, 0xF0, low, high, 0, 0, 0, 0, 0, 0, 0, 0]
            }
            Doing::Ring(_) => return None,
        };
        Some(Report { interface: 2, bytes })
    }

    fn default_report(doing: &Doing) -> Option<Report> {
        let wide = |pen: &Pen| [counts(pen.x, DEFAULT_MAX), counts(-pen.y, DEFAULT_MAX)];
        let (interface, bytes) = match doing {
            Doing::Pen(pen) => (1, pen_bytes(7, 0xA0 | switches(pen), wide(pen), pen)),
            Doing::Left(pen) => (1, pen_bytes(7, 0xC0, wide(pen), pen)),
            Doing::Keys(keys) => {
                let mut bytes = vec![6, 0, 0, 0, 0, 0, 0, 0];
                let down = (0..KEYS).filter(|key| keys >> key & 1 == 1);
                for (place, key) in (2..).zip(down.take(6)) {
                    let [modifiers, usage] = SHORTCUTS[usize::from(key)];
                    bytes[1] |= modifiers;
                    bytes[place] = usage;
                }
                (0, bytes)
            }
            Doing::Ring(_) => return None,
        };
        Some(Report { interface, bytes })
    }

    fn report(&self, doing: &Doing) -> Option<Report> {
        if self.full {
            Self::full_report(doing)
        } else {
            Self::default_report(doing)
        }
    }
}

fn keyboard() -> Descriptor {
    Descriptor::application(0x01, 0x06)
        .report(6)
        .page(0x07)
        .bits(0xE0, 0xE7)
        .keys(6)
        .end()
}

fn coarse_pen() -> Descriptor {
    let wide = [0, DEFAULT_MAX as i32];
    Descriptor::application(0x0D, 0x02)
        .report(7)
        .physical(0x20)
        .inputs(&[0x42, 0x44, 0x5A, 0x45], 1, [0, 1])
        .padding(1)
        .inputs(&[0x32], 1, [0, 1])
        .padding(2)
        .page(0x01)
        .unit(0x13, -3, [0, 10_000])
        .inputs(&[0x30], 16, wide)
        .unit(0x13, -3, [0, 6_250])
        .inputs(&[0x31], 16, wide)
        .unit(0, 0, [0, 0])
        .page(0x0D)
        .inputs(&[0x30], 16, [0, i32::from(PRESSURE_MAX)])
        .inputs(&[0x3D, 0x3E], 8, [-60, 60])
        .end()
        .end()
}

fn vendor() -> Descriptor {
    Descriptor::application(0xFF0A, 0x01)
        .report(2)
        .input_bytes(0x01, 11)
        .output_bytes(0x02, 9)
        .end()
}

impl Inside for Deco {
    fn facts(&self) -> UsbFacts {
        let interface = |descriptor: Descriptor, usage, input_bytes, output_bytes| HidInterface {
            descriptor: descriptor.build(),
            usage,
            input_bytes,
            output_bytes,
            feature_bytes: 0,
            numbered: true,
            poll_ms: 2,
        };
        UsbFacts {
            vendor: 0x28BD,
            product: PRODUCTS[usize::from(self.moved)],
            release_bcd: 0x0000,
            manufacturer: "UGTABLET",
            name: "DECO 01",
            serial: None,
            interfaces: vec![
                interface(keyboard(), [0x01, 0x06], 8, 0),
                interface(coarse_pen(), [0x0D, 0x02], 10, 0),
                interface(vendor(), [0xFF0A, 0x01], 12, 10),
            ],
            main: 2,
        }
    }

    fn interval_us(&self) -> u64 {
        INTERVAL_US
    }

    fn lose_power(&mut self) {
        self.full = false;
        self.moved = false;
    }

    fn begin_anew(&mut self) {
        self.pad.begin_anew();
    }

    fn is_reporting(&self) -> bool {
        // What revision B says before it has moved is soon somebody else's.
        self.full && (self.moved || !self.rev_b)
    }

    fn touch(&mut self, _at: &mut Moment<'_>, touch: &Touch) -> bool {
        self.pad.touch(touch)
    }

    fn has_report(&self) -> bool {
        self.pad.has_report()
    }

    fn take_report(&mut self) -> Option<Report> {
        let doing = self.pad.take()?;
        self.report(&doing)
    }

    fn same_again(&self) -> Option<Report> {
        let doing = self.pad.pen.map_or(Doing::Keys(0), Doing::Pen);
        self.report(&doing)
    }

    fn output(&mut self, _at: &mut Moment<'_>, interface: u8, bytes: &[u8]) -> Result<(), Stall> {
        if interface != 2 || !bytes.starts_with(&INIT) {
            return Err(Stall);
        }
        self.full = true;
        self.pad.begin_anew();
        Ok(())
    }

    fn string(&mut self, at: &mut Moment<'_>, index: u8) -> Result<Vec<u8>, Stall> {
        match index {
            4 => Ok(string_descriptor("UG901_BPU1002")),
            // The date is ours: none of the two that other ranges are known by.
            5 => Ok(string_descriptor("21-03-04_release001")),
            100 => {
                if self.rev_b && self.full && !self.moved {
                    self.moved = true;
                    at.leave();
                }
                Ok(PARAMETERS.to_vec())
            }
            _ => Err(Stall),
        }
    }
}

#[cfg(test)]
mod tests;
