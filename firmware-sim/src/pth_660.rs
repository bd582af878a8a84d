//! The Wacom Intuos Pro M PTH-660 on its cable: pen with lean and number, eight keys, a ring with a button inside.
//!
//! Pen (report 0x10) and pad (0x11) come from interface 0; interface 1 is for fingers, which these hands have none of.
//! Feature report 2 is the mode, said back; readers that never set it get the same reports, and so they do here.
//! Source: `docs/simulators.md`, "PTH-660" (OpenTabletDriver, Linux selftests' descriptor of firmware 1.45).

use crate::hands::{Pen, Touch};
use crate::usb_device::pad::{Doing, Pad, place, pressure};
use crate::usb_device::{
    Chassis, Descriptor, HidInterface, Inside, Moment, Report, Stall, UsbDevice, UsbFacts,
};

/// Counts of the surface.
pub const MAX: [u32; 2] = [44_800, 29_600];
const PRESSURE_MAX: u16 = 8191;
/// Eight keys, and the button in the middle of the ring.
const KEYS: u8 = 9;
const RING_STEPS: u8 = 72;
const INTERVAL_US: u64 = 5_000;
/// Longest report its descriptor names; no report that hands make is so long.
const LONGEST_BYTES: u16 = 192;
/// Number and kind of the pen that came with it: a number of ours, and the kind of a Pro Pen 2 (its other end: +8).
const PEN_SERIAL: u32 = 0x2A00_0001;
const PEN_KIND: u16 = 0x0842;
/// Distance said while the pen hovers, of 63.
const HOVER: u8 = 20;

/// A PTH-660, plugged in.
pub fn pth_660() -> Box<dyn UsbDevice> {
    Box::new(Chassis::new(Pth660 {
        mode: 0,
        pad: Pad::new(KEYS, RING_STEPS),
        keys: 0,
        ring: None,
    }))
}

#[derive(Debug)]
struct Pth660 {
    mode: u8,
    pad: Pad,
    /// What the pad's report says: keys and ring are one.
    keys: u16,
    ring: Option<u8>,
}

fn pen_report(pen: &Pen, there: bool) -> Vec<u8> {
    let mut bytes = vec![0; 27];
    let [x, y] = place(pen, MAX).map(u32::to_le_bytes);
    let contact = if pen.eraser { 1 << 3 } else { 1 };
    let touching = if pen.tip { contact } else { 0 };
    let switches = touching | (pen.buttons & 3) << 1 | u8::from(pen.eraser) << 4;
    let pressed = if there { pressure(pen, PRESSURE_MAX) } else { 0 };
    let [right, up] = pen.tilt_deg;
    let serial = if pen.serial == 0 { PEN_SERIAL } else { pen.serial };
    bytes[0] = 0x10;
    // In range (bit 5) and trustworthy (bit 6) come and go together.
    bytes[1] = if there { 0x60 | switches } else { 0 };
    bytes[2..5].copy_from_slice(&x[..3]);
    bytes[5..8].copy_from_slice(&y[..3]);
    bytes[8..10].copy_from_slice(&pressed.to_le_bytes());
    bytes[10] = right as u8;
    // Towards the hand.
    bytes[11] = up.saturating_neg().min(63) as u8;
    bytes[16] = if pen.tip { 0 } else { HOVER };
    bytes[17..21].copy_from_slice(&serial.to_le_bytes());
    let kind = PEN_KIND + if pen.eraser { 8 } else { 0 };
    bytes[25..].copy_from_slice(&kind.to_le_bytes());
    bytes
}

impl Pth660 {
    fn pad_report(&self) -> Vec<u8> {
        let [keys, more] = self.keys.to_le_bytes();
        let ring = self.ring.map_or(0, |step| 0x80 | step);
        vec![0x11, keys, 0, more & 1, ring, 0, 0, 0, 0]
    }
}

fn pen_and_pad() -> Descriptor {
    let cm = |descriptor: Descriptor, hundredths_mm| descriptor.unit(0x11, -3, [0, hundredths_mm]);
    let descriptor = Descriptor::application(0xFF0D, 0x01)
        .report(0x10)
        .physical(0x20)
        .inputs(&[0x42, 0x44, 0x5A, 0x45, 0x3C, 0x32, 0x36], 1, [0, 1])
        .padding(1);
    let descriptor = cm(descriptor, 22_400).inputs(&[0x0130], 24, [0, MAX[0] as i32]);
    cm(descriptor, 14_800)
        .inputs(&[0x0131], 24, [0, MAX[1] as i32])
        .unit(0, 0, [0, 0])
        .inputs(&[0x30], 16, [0, i32::from(PRESSURE_MAX)])
        .unit(0x14, 0, [-64, 63])
        .inputs(&[0x3D, 0x3E], 8, [-64, 63])
        .unit(0x14, 0, [-180, 179])
        .inputs(&[0x41], 16, [-900, 899])
        .unit(0, 0, [0, 0])
        .inputs(&[0x0D03], 16, [0, 2047])
        .inputs(&[0x0132], 8, [0, 63])
        .inputs(&[0x5B, 0x5C], 32, [i32::MIN, i32::MAX])
        .inputs(&[0x77], 16, [0, 4095])
        .end()
        .report(0x11)
        .physical(0x39)
        .bits(0x0910, 0x0917)
        .bits(0x0940, 0x0947)
        .bits(0x0995, 0x0995)
        .padding(7)
        .inputs(&[0x0138], 7, [0, i32::from(RING_STEPS) - 1])
        .bits(0x0139, 0x0139)
        .padding(32)
        .end()
        .report(2)
        .feature_bytes(0x01, 1)
        .report(0xC0)
        .input_bytes(0x02, LONGEST_BYTES - 1)
        .end()
}

impl Inside for Pth660 {
    fn facts(&self) -> UsbFacts {
        let fingers = Descriptor::application(0xFF00, 0x01)
            .report(0x21)
            .input_bytes(0x01, 43)
            .end();
        let interface = |descriptor: Descriptor, usage, input_bytes, feature_bytes| HidInterface {
            descriptor: descriptor.build(),
            usage,
            input_bytes,
            output_bytes: 0,
            feature_bytes,
            numbered: true,
            poll_ms: 4,
        };
        UsbFacts {
            vendor: 0x056A,
            product: 0x0357,
            release_bcd: 0x0110,
            manufacturer: "Wacom Co.,Ltd.",
            name: "Intuos Pro M",
            serial: Some("0SIM000660"),
            interfaces: vec![
                interface(pen_and_pad(), [0xFF0D, 0x01], LONGEST_BYTES, 2),
                interface(fingers, [0xFF00, 0x01], 44, 0),
            ],
            main: 0,
        }
    }

    fn interval_us(&self) -> u64 {
        INTERVAL_US
    }

    fn lose_power(&mut self) {
        self.mode = 0;
    }

    fn begin_anew(&mut self) {
        self.pad.begin_anew();
    }

    fn touch(&mut self, _at: &mut Moment<'_>, touch: &Touch) -> bool {
        self.pad.touch(touch)
    }

    fn has_report(&self) -> bool {
        self.pad.has_report()
    }

    fn take_report(&mut self) -> Option<Report> {
        let bytes = match self.pad.take()? {
            Doing::Pen(pen) => pen_report(&pen, true),
            Doing::Left(pen) => pen_report(&pen, false),
            Doing::Keys(keys) => {
                self.keys = keys;
                self.pad_report()
            }
            Doing::Ring(ring) => {
                self.ring = ring;
                self.pad_report()
            }
        };
        Some(Report { interface: 0, bytes })
    }

    fn same_again(&self) -> Option<Report> {
        let bytes = self
            .pad
            .pen
            .map_or_else(|| self.pad_report(), |pen| pen_report(&pen, true));
        Some(Report { interface: 0, bytes })
    }

    fn set_feature(&mut self, _at: &mut Moment<'_>, interface: u8, bytes: &[u8]) -> Result<(), Stall> {
        let (0, &[2, mode]) = (interface, bytes) else {
            return Err(Stall);
        };
        self.mode = mode;
        Ok(())
    }

    fn feature(&mut self, interface: u8, id: u8) -> Result<Vec<u8>, Stall> {
        if (interface, id) == (0, 2) {
            Ok(vec![2, self.mode])
        } else {
            Err(Stall)
        }
    }
}

#[cfg(test)]
mod tests;
