//! The Huion HS610: a pen tablet that becomes one when its string 200 is read.
//!
//! Before that it is a pointer of lower resolution (report 0x0A of interface 1). Afterwards everything comes as report
//! 0x08 of interface 0: the pen every 4 ms for as long as it is in reach, keys and ring as they change, and nothing at
//! all when the pen leaves. Strings it does not know are answered with memory that nobody set.
//! Source: `docs/simulators.md`, "HS610" (DIGImend tablets and kernel drivers).

use crate::hands::{Pen, Touch};
use crate::usb_device::pad::{Doing, Pad, counts, place, pressure};
use crate::usb_device::{
    Chassis, Descriptor, HidInterface, Inside, Moment, Report, Stall, UsbDevice, UsbFacts, string_descriptor,
};

/// Counts of the surface in full mode.
pub const MAX: [u32; 2] = [50_800, 31_750];
/// Counts of either side before the handshake.
const DEFAULT_MAX: u32 = 32_767;
const PRESSURE_MAX: u16 = 8191;
/// Twelve keys, and the button in the middle of the ring behind them.
const KEYS: u8 = 13;
const RING_STEPS: u8 = 12;
const INTERVAL_US: u64 = 4_000;

/// String 200 as the device sent it: length, type, counts of both sides, pressure, lines per inch, and what is thought
/// to be the number of keys.
const PARAMETERS: [u8; 19] = [
    0x13, 0x03, 0x70, 0xC6, 0x00, 0x06, 0x7C, 0x00, 0xFF, 0x1F, 0xD8, 0x13, 0x03, 0x0D, 0x10, 0x01, 0x04,
    0x3C, 0x3E,
];
/// What answers to unknown strings begin with; the type, the second byte, is not a string's.
const UNSET_MEMORY: [u8; 8] = [0xC8, 0x0E, 0x00, 0x20, 0x65, 0x01, 0x00, 0x08];
const UNSET_BYTES: usize = 200;

/// An HS610, plugged in.
pub fn hs610() -> Box<dyn UsbDevice> {
    Box::new(Chassis::new(Hs610 {
        full: false,
        pad: Pad::new(KEYS, RING_STEPS),
        stale: [0; 2],
    }))
}

#[derive(Debug)]
struct Hs610 {
    /// String 200 has been read.
    full: bool,
    pad: Pad,
    /// The last pen report's tilt: reports of keys and ring never overwrite it.
    stale: [u8; 2],
}

/// Side buttons and tip as both modes have them.
fn switches(pen: &Pen) -> u8 {
    u8::from(pen.tip) | (pen.buttons & 3) << 1
}

/// Lean as the device says it: to the right, and away from the hand.
fn tilt(pen: &Pen) -> [u8; 2] {
    pen.tilt_deg.map(|degrees| degrees as u8)
}

impl Hs610 {
    fn full_report(&mut self, doing: &Doing) -> Option<Vec<u8>> {
        let mut bytes = [0; 12];
        bytes[0] = 0x08;
        match doing {
            Doing::Pen(pen) => {
                let [x, y] = place(pen, MAX).map(u32::to_le_bytes);
                bytes[1] = 0x80 | switches(pen);
                bytes[2..4].copy_from_slice(&x[..2]);
                bytes[4..6].copy_from_slice(&y[..2]);
                bytes[6..8].copy_from_slice(&pressure(pen, PRESSURE_MAX).to_le_bytes());
                (bytes[8], bytes[9]) = (x[2], y[2]);
                self.stale = tilt(pen);
            }
            // Out of reach it simply falls silent.
            Doing::Left(_) => return None,
            Doing::Keys(keys) => {
                bytes[1..4].copy_from_slice(&[0xE0, 1, 1]);
                bytes[4..6].copy_from_slice(&keys.to_le_bytes());
            }
            Doing::Ring(at) => {
                bytes[1..4].copy_from_slice(&[0xF0, 1, 1]);
                bytes[5] = at.map_or(0, |step| step + 1);
            }
        }
        bytes[10..].copy_from_slice(&self.stale);
        Some(bytes.to_vec())
    }

    /// The pointer it is before the handshake; its keys and ring are dead.
    fn default_report(doing: &Doing) -> Option<Vec<u8>> {
        let (pen, reach) = match doing {
            Doing::Pen(pen) => (pen, 0xC0 | switches(pen)),
            Doing::Left(pen) => (pen, 0x80),
            Doing::Keys(_) | Doing::Ring(_) => return None,
        };
        let mut bytes = vec![0x0A, reach];
        bytes.extend((counts(pen.x, DEFAULT_MAX) as u16).to_le_bytes());
        bytes.extend((counts(-pen.y, DEFAULT_MAX) as u16).to_le_bytes());
        bytes.extend(pressure(pen, PRESSURE_MAX).to_le_bytes());
        bytes.extend(tilt(pen));
        Some(bytes)
    }

    fn report(&mut self, doing: &Doing) -> Option<Report> {
        let (interface, bytes) = if self.full {
            (0, self.full_report(doing))
        } else {
            (1, Self::default_report(doing))
        };
        bytes.map(|bytes| Report { interface, bytes })
    }
}

impl Inside for Hs610 {
    fn facts(&self) -> UsbFacts {
        // As the real one: interface 0 is a vendor's page and tells nothing of what is in its reports.
        let vendor = Descriptor::application(0xFF00, 0x01)
            .report(8)
            .input_bytes(0x01, 11)
            .end();
        let wide = [0, DEFAULT_MAX as i32];
        let pen = Descriptor::application(0x0D, 0x02)
            .report(0x0A)
            .physical(0x20)
            .inputs(&[0x42, 0x44, 0x5A], 1, [0, 1])
            .padding(3)
            .inputs(&[0x32], 1, [0, 1])
            .padding(1)
            .page(0x01)
            .unit(0x13, -3, [0, 10_000])
            .inputs(&[0x30], 16, wide)
            .unit(0x13, -3, [0, 6_250])
            .inputs(&[0x31], 16, wide)
            .unit(0, 0, [0, 0])
            .page(0x0D)
            .inputs(&[0x30], 16, [0, i32::from(PRESSURE_MAX)])
            .inputs(&[0x3D, 0x3E], 8, [-127, 127])
            .end()
            .end();
        let interface = |descriptor: Descriptor, usage, input_bytes| HidInterface {
            descriptor: descriptor.build(),
            usage,
            input_bytes,
            output_bytes: 0,
            feature_bytes: 0,
            numbered: true,
            poll_ms: 2,
        };
        UsbFacts {
            vendor: 0x256C,
            product: 0x006D,
            release_bcd: 0x0100,
            manufacturer: "HUION",
            name: "Huion Tablet",
            serial: None,
            interfaces: vec![
                interface(vendor, [0xFF00, 0x01], 12),
                interface(pen, [0x0D, 0x02], 10),
            ],
            main: 0,
        }
    }

    fn interval_us(&self) -> u64 {
        INTERVAL_US
    }

    fn lose_power(&mut self) {
        self.full = false;
        self.stale = [0; 2];
    }

    fn begin_anew(&mut self) {
        self.pad.begin_anew();
    }

    fn is_reporting(&self) -> bool {
        self.full
    }

    fn touch(&mut self, _at: &mut Moment<'_>, touch: &Touch) -> bool {
        self.pad.touch(touch)
    }

    fn has_report(&self) -> bool {
        // A pen in reach is told of again and again: without that, nobody could know when it has left.
        self.pad.has_report() || self.full && self.pad.pen.is_some()
    }

    fn take_report(&mut self) -> Option<Report> {
        while let Some(doing) = self.pad.take() {
            let report = self.report(&doing);
            if report.is_some() {
                return report;
            }
        }
        let pen = self.pad.pen.filter(|_| self.full)?;
        self.report(&Doing::Pen(pen))
    }

    fn same_again(&self) -> Option<Report> {
        let doing = self.pad.pen.map_or(Doing::Keys(0), Doing::Pen);
        let mut copy = Self {
            full: self.full,
            pad: Pad::new(0, 0),
            stale: self.stale,
        };
        copy.report(&doing)
    }

    fn string(&mut self, _at: &mut Moment<'_>, index: u8) -> Result<Vec<u8>, Stall> {
        Ok(match index {
            200 => {
                self.full = true;
                self.pad.begin_anew();
                PARAMETERS.to_vec()
            }
            201 => string_descriptor("HUION_T194_190307"),
            202 => string_descriptor("HUION Animation Technology Co.,ltd"),
            _ => {
                let mut chance = fastrand::Rng::with_seed(u64::from(index));
                let mut memory = UNSET_MEMORY.to_vec();
                memory.resize_with(UNSET_BYTES, || chance.u8(..));
                memory
            }
        })
    }
}

#[cfg(test)]
mod tests;
