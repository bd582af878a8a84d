//! The 3Dconnexion SpaceNavigator: a cap on springs that is pushed and twisted six ways, and two buttons.
//!
//! Shifts (report 1) and turns (report 2) come apart and take turns every 8 ms for as long as the cap is away from its
//! rest, and once more each when it is back: a resting cap says zero and then nothing. Output report 4 is its lamp.
//! Source: `docs/simulators.md`, "SpaceMouse" (VRPN `vrpn_3DConnexion.C`, PySpaceMouse, spacenavd).

use crate::hands::Touch;
use crate::usb_device::{
    Chassis, Descriptor, HidInterface, Inside, Moment, Ramps, Report, Shown, Stall, UsbDevice, UsbFacts,
};
use std::collections::VecDeque;

/// Counts from rest to the stop of every axis.
pub const TRAVEL_COUNTS: i32 = 350;
/// Between two reports while the cap is moved.
const INTERVAL_US: u64 = 8_000;
const BUTTONS: u8 = 2;

/// A SpaceNavigator, plugged in.
pub fn space_navigator() -> Box<dyn UsbDevice> {
    Box::new(Chassis::new(SpaceNavigator::default()))
}

#[derive(Debug, Default)]
struct SpaceNavigator {
    /// x, y, z, then the turns about them, counts, in the order the device sends them.
    axes: [i32; 6],
    /// Reports 1 and 2 still owed for the cap, as they were last told.
    told: [[i32; 3]; 2],
    /// Which of the two is next.
    next: usize,
    buttons: u8,
    edges: VecDeque<u8>,
    ramps: Ramps,
}

impl SpaceNavigator {
    fn half(&self, report: usize) -> [i32; 3] {
        let from = 3 * report;
        [self.axes[from], self.axes[from + 1], self.axes[from + 2]]
    }

    fn is_owed(&self, report: usize) -> bool {
        // Both halves are sent while either is away from rest, as readers of the real one see them alternate.
        self.axes != [0; 6] || self.told[report] != [0; 3]
    }

    fn bytes(&self, report: usize) -> Vec<u8> {
        let mut bytes = vec![report as u8 + 1];
        for counts in self.half(report) {
            bytes.extend((counts as i16).to_le_bytes());
        }
        bytes
    }

    fn press(&mut self, control: u8, down: bool) -> bool {
        if control >= BUTTONS {
            return false;
        }
        let bit = 1 << control;
        let now = if down {
            self.buttons | bit
        } else {
            self.buttons & !bit
        };
        if now != self.buttons {
            self.buttons = now;
            self.edges.push_back(now);
        }
        true
    }
}

impl Inside for SpaceNavigator {
    fn facts(&self) -> UsbFacts {
        let travel = [-TRAVEL_COUNTS, TRAVEL_COUNTS];
        // A multi-axis controller (1/8): two physical collections for the cap, buttons, and a lamp.
        let descriptor = Descriptor::application(0x01, 0x08)
            .physical(0x00)
            .report(1)
            .inputs(&[0x30, 0x31, 0x32], 16, travel)
            .end()
            .physical(0x00)
            .report(2)
            .inputs(&[0x33, 0x34, 0x35], 16, travel)
            .end()
            .report(3)
            .page(0x09)
            .bits(1, u16::from(BUTTONS))
            .padding(14)
            .report(4)
            .page(0x08)
            .output_bytes(0x4B, 1)
            .end();
        UsbFacts {
            vendor: 0x046D,
            product: 0xC626,
            release_bcd: 0x0431,
            manufacturer: "3Dconnexion",
            name: "SpaceNavigator",
            serial: None,
            interfaces: vec![HidInterface {
                descriptor: descriptor.build(),
                usage: [0x01, 0x08],
                input_bytes: 7,
                output_bytes: 2,
                feature_bytes: 0,
                numbered: true,
                poll_ms: 8,
            }],
            main: 0,
        }
    }

    fn interval_us(&self) -> u64 {
        INTERVAL_US
    }

    fn lose_power(&mut self) {}

    fn begin_anew(&mut self) {
        self.edges.clear();
        self.told = [[0; 3]; 2];
        self.next = 0;
    }

    fn touch(&mut self, at: &mut Moment<'_>, touch: &Touch) -> bool {
        match *touch {
            Touch::Axis { control, to, over_us } if control < 6 => {
                let target = (to.clamp(-1.0, 1.0) * f64::from(TRAVEL_COUNTS)).round() as i32;
                self.ramps.stop(control);
                let axis = &mut self.axes[usize::from(control)];
                if over_us == 0 {
                    *axis = target;
                } else {
                    self.ramps.begin(at.now_us, control, target - *axis, over_us);
                }
                true
            }
            Touch::Button { control, down } => self.press(control, down),
            _ => false,
        }
    }

    fn next_step_us(&self) -> Option<u64> {
        self.ramps.next_us()
    }

    fn step(&mut self, at_us: u64) {
        let axes = &mut self.axes;
        self.ramps
            .step(at_us, |control, by| axes[usize::from(control)] += by);
    }

    fn has_report(&self) -> bool {
        !self.edges.is_empty() || self.is_owed(0) || self.is_owed(1)
    }

    fn take_report(&mut self) -> Option<Report> {
        let bytes = if let Some(buttons) = self.edges.pop_front() {
            vec![3, buttons, 0]
        } else {
            let report = if self.is_owed(self.next) {
                self.next
            } else {
                1 - self.next
            };
            self.next = 1 - report;
            self.told[report] = self.half(report);
            self.bytes(report)
        };
        Some(Report { interface: 0, bytes })
    }

    fn same_again(&self) -> Option<Report> {
        let bytes = self.bytes(self.next);
        Some(Report { interface: 0, bytes })
    }

    fn output(&mut self, at: &mut Moment<'_>, _interface: u8, bytes: &[u8]) -> Result<(), Stall> {
        let &[4, lamp] = bytes else { return Err(Stall) };
        at.show(Shown::Lamp(lamp & 1 == 1));
        Ok(())
    }
}

#[cfg(test)]
mod tests;
