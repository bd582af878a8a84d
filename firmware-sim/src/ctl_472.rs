//! The One by Wacom CTL-472: a mouse until feature report 2 says 2, a pen tablet from then on.
//!
//! Reports of the tablet (id 2, ten bytes) say how far each may be believed: in range, position valid, pressure and
//! buttons valid. A pen comes and goes in that order, and the last reports bear no position at all.
//! Source: `docs/simulators.md`, "CTL-472" (input-wacom `wacom_bpt_pen`, recordings of its relatives).

use crate::hands::{Pen, Touch};
use crate::usb_device::pad::{Doing, Pad, place, pressure};
use crate::usb_device::{
    Chassis, Descriptor, HidInterface, Inside, Moment, Report, Stall, UsbDevice, UsbFacts,
};
use std::collections::VecDeque;

/// Counts of the surface.
pub const MAX: [u32; 2] = [15_200, 9_500];
const PRESSURE_MAX: u16 = 2047;
/// The family's rate while a pen is used.
const INTERVAL_US: u64 = 8_000;

const IN_RANGE: u8 = 0x80;
const PLACE_VALID: u8 = 0x40;
const READY: u8 = 0x20;
/// Set in every recorded frame with a button, the eraser, or without [`READY`]; nobody knows its name.
const UNNAMED: u8 = 0x10;
/// Distance said with the point down, and hovering: it falls as the pen moves away.
const DISTANCE: [u8; 2] = [0x20, 0x10];
/// Pen counts a mouse count stands for, before the tablet is one. Ours.
const MOUSE_COUNTS: i32 = 40;

/// A CTL-472, plugged in.
pub fn ctl_472() -> Box<dyn UsbDevice> {
    Box::new(Chassis::new(Ctl472 {
        mode: 0,
        pad: Pad::new(0, 0),
        near: false,
        owed: VecDeque::new(),
        mouse_at: None,
    }))
}

#[derive(Debug)]
struct Ctl472 {
    /// Feature report 2: 2 is the tablet.
    mode: u8,
    pad: Pad,
    /// The host has been told that a pen is there.
    near: bool,
    /// The rest of a coming or going, which takes several reports.
    owed: VecDeque<Vec<u8>>,
    mouse_at: Option<[u32; 2]>,
}

fn frame(state: u8, pen: &Pen, pressed: u16) -> Vec<u8> {
    let [x, y] = place(pen, MAX).map(|counts| (counts as u16).to_le_bytes());
    let [low, high] = pressed.to_le_bytes();
    let distance = DISTANCE[usize::from(!pen.tip)];
    vec![2, state, x[0], x[1], y[0], y[1], low, high, distance, 0]
}

fn empty(state: u8) -> Vec<u8> {
    vec![2, state, 0, 0, 0, 0, 0, 0, 0, 0]
}

/// A frame of a pen that is near enough for everything to be valid.
fn full_frame(pen: &Pen) -> Vec<u8> {
    let switches = u8::from(pen.tip) | (pen.buttons & 3) << 1 | u8::from(pen.eraser) << 3;
    let unnamed = if switches & !1 == 0 { 0 } else { UNNAMED };
    let state = IN_RANGE | PLACE_VALID | READY | unnamed | switches;
    frame(state, pen, pressure(pen, PRESSURE_MAX))
}

impl Ctl472 {
    fn is_tablet(&self) -> bool {
        self.mode == 2
    }

    /// The next report of a tablet; further ones may be owed after it.
    fn tablet_report(&mut self, doing: &Doing) -> Option<Vec<u8>> {
        match doing {
            Doing::Pen(pen) => {
                let full = full_frame(pen);
                if self.near {
                    return Some(full);
                }
                self.near = true;
                self.owed.push_back(full);
                Some(frame(IN_RANGE | PLACE_VALID | UNNAMED, pen, 0))
            }
            Doing::Left(pen) => {
                self.near = false;
                self.owed.extend([empty(IN_RANGE), empty(0)]);
                Some(frame(IN_RANGE | PLACE_VALID | UNNAMED, pen, 0))
            }
            Doing::Keys(_) | Doing::Ring(_) => None,
        }
    }

    fn mouse_report(&mut self, doing: &Doing) -> Option<Vec<u8>> {
        let Doing::Pen(pen) = doing else {
            self.mouse_at = None;
            return None;
        };
        let at = place(pen, MAX);
        let before = self.mouse_at.replace(at).unwrap_or(at);
        let way = |axis: usize| {
            let counts = at[axis] as i32 - before[axis] as i32;
            (counts / MOUSE_COUNTS).clamp(-127, 127) as u8
        };
        let buttons = u8::from(pen.tip) | (pen.buttons & 3) << 1;
        Some(vec![1, buttons, way(0), way(1)])
    }
}

impl Inside for Ctl472 {
    fn facts(&self) -> UsbFacts {
        let descriptor = Descriptor::application(0x01, 0x02)
            .report(1)
            .physical(0x01)
            .page(0x09)
            .bits(1, 3)
            .padding(5)
            .page(0x01)
            .relative(&[0x30, 0x31], 8, [-127, 127])
            .end()
            .end()
            .and_application(0xFF0D, 0x01)
            .report(2)
            .input_bytes(0x01, 9)
            .feature_bytes(0x02, 1)
            .end();
        UsbFacts {
            vendor: 0x056A,
            product: 0x037A,
            release_bcd: 0x0100,
            manufacturer: "Wacom Co.,Ltd.",
            name: "CTL-472",
            serial: None,
            interfaces: vec![HidInterface {
                descriptor: descriptor.build(),
                usage: [0x01, 0x02],
                input_bytes: 10,
                output_bytes: 0,
                feature_bytes: 2,
                numbered: true,
                poll_ms: 4,
            }],
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
        self.owed.clear();
        self.near = false;
        self.mouse_at = None;
        self.pad.begin_anew();
    }

    fn is_reporting(&self) -> bool {
        self.is_tablet()
    }

    fn touch(&mut self, _at: &mut Moment<'_>, touch: &Touch) -> bool {
        self.pad.touch(touch)
    }

    fn has_report(&self) -> bool {
        !self.owed.is_empty() || self.pad.has_report()
    }

    fn take_report(&mut self) -> Option<Report> {
        let bytes = if let Some(owed) = self.owed.pop_front() {
            owed
        } else {
            let doing = self.pad.take()?;
            if self.is_tablet() {
                self.tablet_report(&doing)?
            } else {
                self.mouse_report(&doing)?
            }
        };
        Some(Report { interface: 0, bytes })
    }

    fn same_again(&self) -> Option<Report> {
        let bytes = match self.pad.pen {
            _ if !self.is_tablet() => vec![1, 0, 0, 0],
            Some(pen) => full_frame(&pen),
            None => empty(0),
        };
        Some(Report { interface: 0, bytes })
    }

    fn set_feature(&mut self, _at: &mut Moment<'_>, _interface: u8, bytes: &[u8]) -> Result<(), Stall> {
        let &[2, mode] = bytes else { return Err(Stall) };
        self.mode = mode;
        self.begin_anew();
        Ok(())
    }

    fn feature(&mut self, _interface: u8, id: u8) -> Result<Vec<u8>, Stall> {
        if id == 2 {
            Ok(vec![2, self.mode])
        } else {
            Err(Stall)
        }
    }
}

#[cfg(test)]
mod tests;
