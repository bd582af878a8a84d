//! Reports of every layout: one of a hand that moves, so that each makes an event.

use anyhow::Context;
use device::codec::Codec;
use device::codec::hid::HidCodec;
use device_profiles::{InputProfile, Kind, Profiles};

/// Key under which the measured profile is put among the others.
pub(super) const MEASURED: &str = "measured";

/// A layout, a profile that uses it, and a report; the byte of that number counts up.
pub(super) struct Layout {
    pub(super) name: &'static str,
    profile: &'static str,
    report: &'static str,
    bytes: usize,
    moving: usize,
}

const fn layout(
    name: &'static str,
    profile: &'static str,
    report: &'static str,
    bytes: usize,
    moving: usize,
) -> Layout {
    Layout {
        name,
        profile,
        report,
        bytes,
        moving,
    }
}

/// The nine layouts of tablets, and boxes of each kind. Reports are those of `device::codec::hid::known`, filled up with
/// zeros to their length.
pub(super) const LAYOUTS: [Layout; 12] = [
    layout("intuos-bpt", "bamboo-pen", "02 e1 80 39 ee 0b 8d 03 20", 9, 2),
    layout("wacom-touch-64", "bamboo-touch", "02 01 02 80 12 34 56 78", 64, 4),
    layout(
        "intuos-v2",
        "pth-660",
        "10 61 10 20 00 30 40 00 80 01 05 fb",
        192,
        2,
    ),
    layout("graphire", "graphire3", "02 91 d0 13 f9 10 40 00", 8, 2),
    layout("intuos-4", "intuos4-4x6", "02 e0 0f 1d 11 0c 40 2d e0 65", 10, 3),
    layout(
        "uclogic-v2",
        "hs610",
        "08 81 f9 51 2c 3a ff 1f 00 00 fa 00",
        12,
        2,
    ),
    layout("uclogic-v1", "h420", "07 81 f9 11 2c 0a ff 01", 8, 2),
    layout("xp-pen", "star-g640s", "02 a1 65 29 e7 1e 80 1f 00 00", 10, 2),
    layout("gtco-usb-1000", "gtco-usb-1000", "02 00 10 00 20 20", 6, 1),
    layout("dial", "powermate", "00 01 00 80 00 00", 6, 3),
    layout("six-axis", "spacenavigator", "01 00 00 e2 ff 00 00", 7, 1),
    layout("shuttle", "shuttlepro-v2", "00 00 00 00 00", 5, 1),
];

/// A pen as Microsoft's sample descriptor has it: report 7, switches, x, y, pressure.
const PEN_DESCRIPTOR: &[u8] = &[
    0x05, 0x0D, 0x09, 0x02, 0xA1, 0x01, 0x85, 0x07, 0x09, 0x20, 0xA1, 0x00, 0x09, 0x42, 0x09, 0x44, 0x09,
    0x3C, 0x09, 0x45, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x04, 0x81, 0x02, 0x95, 0x01, 0x81, 0x03,
    0x09, 0x32, 0x81, 0x02, 0x95, 0x02, 0x81, 0x03, 0x05, 0x01, 0x09, 0x30, 0x75, 0x10, 0x95, 0x01, 0x55,
    0x0D, 0x65, 0x13, 0x35, 0x00, 0x46, 0x3A, 0x20, 0x26, 0xF8, 0x52, 0x81, 0x02, 0x09, 0x31, 0x46, 0x2C,
    0x18, 0x26, 0x6C, 0x3E, 0x81, 0x02, 0x05, 0x0D, 0x09, 0x30, 0x26, 0xFF, 0x00, 0x81, 0x02, 0xC0, 0xC0,
];

impl Layout {
    /// As many different reports as a byte counts.
    pub(super) fn reports(&self) -> Vec<Vec<u8>> {
        let mut report: Vec<u8> = self
            .report
            .split_whitespace()
            .filter_map(|byte| u8::from_str_radix(byte, 16).ok())
            .collect();
        report.resize(self.bytes, 0);
        let with = |count: u8| {
            let mut report = report.clone();
            if let Some(byte) = report.get_mut(self.moving) {
                *byte = count;
            }
            report
        };
        (0..=u8::MAX).map(with).collect()
    }

    /// Its profile without a handshake, among all others.
    pub(super) fn profiles(&self) -> anyhow::Result<Profiles> {
        let mut all = Profiles::builtin();
        let profile = InputProfile {
            key: MEASURED.to_owned(),
            init: Vec::new(),
            ..all.input(self.profile).context(self.name)?.clone()
        };
        all.add(Kind::Input(Box::new(profile)));
        Ok(all)
    }

    /// Its codec.
    pub(super) fn codec(&self) -> anyhow::Result<Box<dyn Codec>> {
        let all = self.profiles()?;
        Ok(Box::new(HidCodec::new(all.input(MEASURED)?)?))
    }
}

/// The codec of the pen that describes itself.
pub(super) fn described() -> anyhow::Result<Box<dyn Codec>> {
    Ok(Box::new(HidCodec::generic(PEN_DESCRIPTOR)?))
}

/// Its reports.
pub(super) fn described_reports() -> Vec<Vec<u8>> {
    let report = |x| vec![7, 0x21, x, 0x10, 0x20, 0x30, 0x80, 0];
    (0..=u8::MAX).map(report).collect()
}
