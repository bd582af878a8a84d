//! The simulated USB devices there are, by the names of their profiles.

use crate::script;
use crate::usb_device::UsbDevice;

/// A kind of simulated USB device.
#[derive(Clone, Copy, Debug)]
pub struct UsbKind {
    /// What it is called here: the name of the profile, and more where several devices answer to one.
    pub name: &'static str,
    /// The name of the profile that describes the real one.
    pub profile: &'static str,
    /// What scripts may do to it.
    pub controls: script::Device,
    /// Makes one, plugged in.
    pub make: fn() -> Box<dyn UsbDevice>,
}

const fn boxed(dials: u8, buttons: u8, axes: u8) -> script::Device {
    script::Device::Controls { dials, buttons, axes }
}

const fn pad(keys: u8, rings: u8) -> script::Device {
    script::Device::Pad { keys, rings }
}

/// All of them.
pub const USB_KINDS: &[UsbKind] = &[
    kind("powermate", boxed(1, 1, 0), crate::powermate::powermate),
    kind(
        "spacenavigator",
        boxed(0, 2, 6),
        crate::space_mouse::space_navigator,
    ),
    kind("shuttlepro-v2", boxed(1, 15, 1), crate::shuttle_pro::shuttle_pro),
    kind("hs610", pad(13, 1), crate::hs610::hs610),
    kind("deco-01-v2", pad(8, 0), crate::deco_01_v2::deco_01_v2),
    UsbKind {
        profile: "deco-01-v2",
        ..kind("deco-01-v2-rev-b", pad(8, 0), crate::deco_01_v2::deco_01_v2_rev_b)
    },
    kind("ctl-472", pad(0, 0), crate::ctl_472::ctl_472),
    kind("pth-660", pad(9, 1), crate::pth_660::pth_660),
];

const fn kind(name: &'static str, controls: script::Device, make: fn() -> Box<dyn UsbDevice>) -> UsbKind {
    UsbKind {
        name,
        profile: name,
        controls,
        make,
    }
}

/// The kind of this name.
pub fn usb_kind(name: &str) -> Option<&'static UsbKind> {
    USB_KINDS.iter().find(|kind| kind.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hands::{Pen, Touch, Turn};
    use crate::input_fault::InputFault;
    use crate::usb_device::{HidInterface, Report};
    use std::collections::BTreeMap;

    /// Lengths in bits of the input reports a descriptor describes, read independently of what wrote it.
    fn described_bits(descriptor: &[u8]) -> BTreeMap<u8, u32> {
        let (mut size, mut count, mut id) = (0, 0, 0);
        let mut bits = BTreeMap::new();
        let mut at = 0;
        while let Some(&head) = descriptor.get(at) {
            let length = [0, 1, 2, 4][usize::from(head & 3)];
            let data = &descriptor[at + 1..at + 1 + length];
            let value = data
                .iter()
                .rev()
                .fold(0u32, |sum, &byte| sum << 8 | u32::from(byte));
            match head & 0xFC {
                0x74 => size = value,
                0x94 => count = value,
                0x84 => id = value as u8,
                0x80 => *bits.entry(id).or_insert(0) += size * count,
                _ => {}
            }
            at += 1 + length;
        }
        bits
    }

    fn is_described(interface: &HidInterface, bytes: &[u8]) -> bool {
        let bits = described_bits(&interface.descriptor);
        let (id, length) = if interface.numbered {
            (bytes[0], bytes.len() - 1)
        } else {
            (0, bytes.len())
        };
        bits.get(&id) == Some(&(length as u32 * 8)) && bytes.len() <= usize::from(interface.input_bytes)
    }

    fn everything(controls: script::Device) -> Vec<Touch> {
        let button = |control| [true, false].map(|down| Touch::Button { control, down });
        let mut touches = Vec::new();
        match controls {
            script::Device::Controls { dials, buttons, axes } => {
                touches.extend((0..dials).map(|control| Touch::Dial {
                    control,
                    by: Turn::Turns(-1.5),
                    over_us: 300_000,
                }));
                touches.extend((0..axes).flat_map(|control| {
                    [-1.0, 0.3, 0.0].map(|to| Touch::Axis {
                        control,
                        to,
                        over_us: 20_000,
                    })
                }));
                touches.extend((0..buttons).flat_map(button));
            }
            script::Device::Pad { keys, rings } => {
                let pen = Pen {
                    x: 0.4,
                    y: -0.9,
                    pressure: 0.7,
                    tip: true,
                    buttons: 3,
                    tilt_deg: [12, -30],
                    ..Pen::default()
                };
                let rubber = Pen { eraser: true, ..pen };
                touches.extend([pen, rubber].map(Touch::Pen));
                touches.push(Touch::Away);
                touches.extend((0..keys).flat_map(button));
                let ring = [Some(0.0), Some(1.0), None].map(|at| Touch::Ring { control: 0, at });
                touches.extend(ring.into_iter().filter(|_| rings > 0));
            }
            script::Device::Tablet | script::Device::Any => {}
        }
        touches
    }

    /// What a driver would do to have the device in its full mode.
    fn handshake(device: &mut dyn UsbDevice, at_us: u64) {
        let main = device.facts().main;
        let _ = device.string(at_us, 200);
        let _ = device.set_feature(at_us, main, &[2, 2]);
        let _ = device.output(at_us, main, &[2, 0xB0, 4, 0, 0, 0, 0, 0, 0, 0]);
        let _ = device.string(at_us, 100);
    }

    fn all_reports(kind: &UsbKind, full: bool, every_us: u64) -> Vec<(Report, bool)> {
        let mut device = (kind.make)();
        let mut seen = Vec::new();
        if full {
            handshake(&mut *device, 0);
        }
        // Whatever left the bus is back by now.
        let begin_us = 2_000_000;
        device.arrival(begin_us);
        for interface in 0..device.facts().interfaces.len() {
            device.listen(begin_us, interface as u8, true);
        }
        let mut touches = everything(kind.controls).into_iter();
        for now_us in (begin_us..begin_us + 3_000_000).step_by(every_us as usize) {
            if now_us % 30_000 == 0
                && let Some(touch) = touches.next()
            {
                assert!(device.touch(now_us, &touch), "{}: {touch:?}", kind.name);
            }
            while let Some(report) = device.report(now_us) {
                let interface = &device.facts().interfaces[usize::from(report.interface)];
                let described = is_described(interface, &report.bytes);
                seen.push((report, described));
            }
        }
        seen
    }

    #[test]
    fn every_report_is_one_that_its_descriptor_describes() {
        for kind in USB_KINDS {
            for full in [false, true] {
                let seen = all_reports(kind, full, 10_000);
                assert!(seen.len() >= 2, "{} says only {} reports", kind.name, seen.len());
                for (report, described) in seen {
                    assert!(described, "{} {full}: {:02X?}", kind.name, report);
                }
            }
        }
    }

    #[test]
    fn how_often_a_device_is_looked_at_changes_nothing() {
        for kind in USB_KINDS {
            let bytes = |every_us| -> Vec<Report> {
                let seen = all_reports(kind, true, every_us).into_iter();
                seen.map(|(report, _)| report).collect()
            };
            assert_eq!(bytes(10_000), bytes(500), "{}", kind.name);
        }
    }

    #[test]
    fn the_cable_may_come_out_at_every_request_and_the_device_begins_anew() {
        for kind in USB_KINDS {
            for step in 0..6 {
                let mut device = (kind.make)();
                device.inject(0, InputFault::UnplugAfterRequests(step));
                let main = device.facts().main;
                device.listen(0, main, true);
                for second in 0..3 {
                    handshake(&mut *device, second * 1_000_000);
                }
                let end_us = 10_000_000;
                assert_eq!(device.arrival(end_us), 0, "{} at {step}", kind.name);
                device.plug(end_us, true);
                let back = device.arrival(end_us);
                assert!(back > 1, "{} at {step}", kind.name);
                let fresh = (kind.make)();
                assert_eq!(device.facts(), fresh.facts(), "{} at {step}", kind.name);
            }
        }
    }
}
