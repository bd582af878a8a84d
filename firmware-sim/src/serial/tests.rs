//! The chassis under every device that stands on it: faults strike messages, and looking changes nothing.

use super::*;
use crate::hands::{Puck, Turn};
use device_profiles::Profiles;

/// One of each.
const KINDS: [&str; 10] = [
    "sgi-dialbox",
    "graphire-serial",
    "intuos-serial",
    "summasketch",
    "deej",
    "firmata",
    "x-touch-mini",
    "x-touch-mini-mc",
    "nanokontrol2",
    "launch-control-xl",
];

fn device(kind: &str) -> Box<dyn SerialDevice> {
    let profiles = Profiles::builtin();
    let profile = profiles.input(kind).expect("it is shipped");
    crate::serial_device(profile).expect("it is simulated")
}

/// What a host of this device says to have it report, in pieces with time between them.
fn beginning(kind: &str) -> Vec<Vec<u8>> {
    match kind {
        "sgi-dialbox" => vec![
            vec![0x20],
            vec![0x50, 0, 0xFF, 0x71, 255, 255, 255, 255, 0x73, 255, 255, 255, 255],
        ],
        "graphire-serial" | "intuos-serial" => vec![b"ST\r".to_vec()],
        "summasketch" => vec![b"          \0".to_vec(), b"0bzb@I".to_vec()],
        "firmata" => vec![vec![0xC0, 1, 0xC1, 1]],
        _ => Vec::new(),
    }
}

/// A hand that makes it say something: the nth of two.
fn move_of(controls: Device, nth: u8) -> Touch {
    let share = f64::from(nth + 1) / 4.0;
    match controls {
        Device::Controls { axes: 1.., .. } => Touch::Axis {
            control: 0,
            to: share,
            over_us: 0,
        },
        Device::Controls { .. } => Touch::Dial {
            control: 0,
            by: Turn::Counts(3 + i32::from(nth)),
            over_us: 0,
        },
        _ => Touch::Puck(Puck {
            x: share,
            ..Puck::default()
        }),
    }
}

struct Bench {
    device: Box<dyn SerialDevice>,
    now_us: u64,
    look_us: u64,
}

impl Bench {
    fn started(kind: &str, look_us: u64) -> Self {
        let mut bench = Self {
            device: device(kind),
            now_us: 0,
            look_us,
        };
        bench.device.port_opened(0);
        bench.pass(3_000_000);
        for piece in beginning(kind) {
            bench.device.receive(bench.now_us, &piece);
            bench.pass(500_000);
        }
        bench
    }

    fn pass(&mut self, span_us: u64) -> Vec<u8> {
        let (end_us, mut out) = (self.now_us + span_us, Vec::new());
        while self.now_us < end_us {
            self.now_us = end_us.min(self.now_us + self.look_us);
            self.device.transmit(self.now_us, &mut out);
        }
        out
    }

    fn moved(&mut self, nth: u8) -> Vec<u8> {
        let touch = move_of(self.device.controls(), nth);
        assert!(self.device.touch(self.now_us, &touch));
        self.pass(200_000)
    }
}

#[test]
fn how_often_a_device_is_looked_at_changes_nothing() {
    for kind in KINDS {
        let said = |look_us| {
            let mut bench = Bench::started(kind, look_us);
            let mut out = bench.moved(0);
            bench.device.inject(
                bench.now_us,
                InputFault::Flood {
                    hz: 8000,
                    for_us: 50_000,
                },
            );
            out.extend(bench.moved(1));
            bench.device.touch(bench.now_us, &Touch::PowerCycle);
            out.extend(bench.pass(2_500_000));
            out
        };
        assert_eq!(said(10_000), said(300), "{kind}");
    }
}

#[test]
fn a_dropped_message_is_missing_and_the_next_is_whole() {
    for kind in KINDS {
        let (mut whole, mut struck) = (Bench::started(kind, 1_000), Bench::started(kind, 1_000));
        assert!(struck.device.inject(struck.now_us, InputFault::Drop(1)), "{kind}");
        let (a, b) = (whole.moved(0), struck.moved(0));
        let lost = a.len() - b.len();
        let is_without = |at: usize| a[..at] == b[..at] && a[at + lost..] == b[at..];
        assert!(
            lost > 0 && (0..=b.len()).any(is_without),
            "{kind}: {a:02x?} {b:02x?}"
        );
        assert_eq!(whole.moved(1), struck.moved(1), "{kind}");
    }
}

#[test]
fn short_long_wrong_and_interleaved_messages_are_what_they_are_called() {
    let said = |fault: &str| {
        let mut bench = Bench::started("sgi-dialbox", 1_000);
        let fault = InputFault::parse(fault).expect("reads");
        assert!(bench.device.inject(bench.now_us, fault));
        [bench.moved(0), bench.moved(1)].concat()
    };
    assert_eq!(said("short"), [0x30, 0x30, 0, 7]);
    let long = said("long");
    assert_eq!((long.len(), &long[..4]), (3 + 8 + 3, &[0x30, 0, 3, 0xA5][..]));
    assert_eq!(said("wrong"), [0xEE, 0, 3, 0x30, 0, 7]);
    assert_eq!(said("interleaved"), [0x30, 0, 7, 0x30, 0, 3]);
    let garbage = said("garbage");
    assert_eq!(
        (garbage.len(), &garbage[12..]),
        (18, &[0x30, 0, 3, 0x30, 0, 7][..])
    );
}

#[test]
fn a_flood_fills_the_line_and_ends() {
    let mut bench = Bench::started("sgi-dialbox", 1_000);
    bench.moved(0);
    let flood = InputFault::parse("flood 8000Hz for 0.5s").expect("reads");
    bench.device.inject(bench.now_us, flood);
    // 960 bytes a second, in threes.
    let flooded = bench.pass(500_000);
    assert!((470..=480).contains(&flooded.len()), "{}", flooded.len());
    assert!(flooded.chunks_exact(3).all(|report| report == [0x30, 0, 3]));
    bench.pass(10_000);
    assert!(bench.pass(500_000).is_empty());
}

#[test]
fn a_cable_is_pulled_by_whoever_holds_it() {
    let mut bench = Bench::started("deej", 1_000);
    assert!(!bench.device.inject(0, InputFault::UnplugAfterRequests(2)));
}
