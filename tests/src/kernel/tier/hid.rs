//! Input devices one at a time: found, made to report, heard exactly, shown to.

use std::time::Duration;

use anyhow::ensure;
use device::discovery::Found;
use firmware_sim::hands::{Pen, Touch, Turn};
use firmware_sim::usb_device::Shown;

use super::open::{
    all_of, answered, find_one, open, opened, plugged, quiet, reports, settled, touch, until_gone,
    until_open, with,
};
use super::{Claim, PATIENCE, same};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::Hid;
use crate::kernel::host::Running;

pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        name: "hid: a PowerMate is known by its descriptor; turns and presses come exactly once, its lamp is lit",
        show: knob,
    },
    Claim {
        name: "hid: a SpaceNavigator says six axes in two reports, its buttons and its lamp work",
        show: cap,
    },
    Claim {
        name: "hid: a ShuttlePRO's wheel wraps and its fifteen buttons are told apart",
        show: shuttle,
    },
    Claim {
        name: "hid: an HS610 is known by a string through rusb and becomes a tablet by another; unset memory is seen as such",
        show: hs610,
    },
    Claim {
        name: "hid: a Deco 01 V2 revision B leaves after its handshake and is found again as its sibling",
        show: deco,
    },
    Claim {
        name: "hid: a CTL-472 becomes a tablet by a feature report, which it says back",
        show: ctl_472,
    },
    Claim {
        name: "hid: a PTH-660's pen, keys and ring come from one of its two interfaces",
        show: pth_660,
    },
    Claim {
        name: "hid: dialrig sim --uhid plays a script on a device of the kernel's own, says what it was shown, goes and returns",
        show: by_uhid,
    },
];

fn dial(control: u8, counts: i32) -> Touch {
    Touch::Dial {
        control,
        by: Turn::Counts(counts),
        over_us: 0,
    }
}

fn button(control: u8, down: bool) -> Touch {
    Touch::Button { control, down }
}

/// Does one thing at a time, so that every report is one doing; what the host got of it must be what the kernel took.
fn play(
    watch: &Watch,
    cable: &Cable<Hid>,
    line: &mut dyn device::transport::Transport,
    touches: &[(Touch, usize)],
) -> anyhow::Result<Vec<Vec<u8>>> {
    let mut seen = Vec::new();
    for (doing, count) in touches {
        touch(cable, doing)?;
        seen.extend(reports(watch, line, *count)?);
    }
    quiet(watch, line, Duration::from_millis(120))?;
    same(
        &seen,
        &cable.with(|hid, _| hid.taken()),
        "reports against what the kernel took",
    )?;
    Ok(seen)
}

/// Waits until the device was made to show something.
fn shown(watch: &Watch, cable: &Cable<Hid>, wanted: &[Shown]) -> anyhow::Result<()> {
    let mut seen = Vec::new();
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    while seen.len() < wanted.len() {
        let new = with(cable, |device, _| device.drain_shown());
        seen.extend(new.into_iter().map(|(_, shown)| shown));
        ensure!(watch.now_us() < until_us, "shown {seen:?}, wanted {wanted:?}");
        watch.pause(Duration::from_millis(2));
    }
    same(&seen, &wanted.to_vec(), "what it was made to show")
}

fn knob(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("powermate", 1, watch)?;
    let found = find_one(watch, "powermate")?;
    same(
        &found.title.contains("PowerMate"),
        &true,
        &format!("its name in {found:?}"),
    )?;
    let mut line = open(&found)?;
    until_open(watch, &cable)?;
    let descriptor = with(&cable, |device, _| {
        device.facts().interfaces[0].descriptor.clone()
    });
    same(&line.report_descriptor()?, &descriptor, "the report descriptor")?;
    let seen = play(
        watch,
        &cable,
        &mut *line,
        &[
            (dial(0, 20), 3),
            (button(0, true), 1),
            (dial(0, -3), 1),
            (button(0, false), 1),
        ],
    )?;
    let told: Vec<(u8, i8)> = seen.iter().map(|bytes| (bytes[0], bytes[1] as i8)).collect();
    same(
        &told,
        &vec![(0, 7), (0, 7), (0, 6), (1, 0), (1, -3), (0, 0)],
        "turns and presses",
    )?;
    line.write(&[0, 0x80])?;
    answered(watch, || line.write_feature(&[0, 0x41, 1, 1, 0, 0x20, 0, 0, 0]))?;
    shown(watch, &cable, &[Shown::Level(0x80), Shown::Level(0x20)])
}

fn cap(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("spacenavigator", 1, watch)?;
    let mut line = opened(watch, "spacenavigator")?;
    until_open(watch, &cable)?;
    let push = |control, to| Touch::Axis {
        control,
        to,
        over_us: 0,
    };
    touch(&cable, &push(2, -1.0))?;
    touch(&cable, &push(3, 0.5))?;
    let moved = reports(watch, &mut *line, 6)?;
    for pair in moved.windows(2) {
        ensure!(
            pair[0][0] != pair[1][0],
            "shifts and turns take turns: {moved:02x?}"
        );
    }
    // The last of them, when both pushes were surely in.
    let shift = moved.iter().rfind(|bytes| bytes[0] == 1);
    let turn = moved.iter().rfind(|bytes| bytes[0] == 2);
    same(
        &shift.map(|bytes| bytes[5..].to_vec()),
        &Some(vec![0xA2, 0xFE]),
        "z",
    )?;
    same(
        &turn.map(|bytes| bytes[1..3].to_vec()),
        &Some(vec![0xAF, 0x00]),
        "rx",
    )?;
    touch(&cable, &push(2, 0.0))?;
    touch(&cable, &push(3, 0.0))?;
    settled(watch, &cable, &mut *line, moved)?;
    let seen = play(
        watch,
        &cable,
        &mut *line,
        &[(button(1, true), 1), (button(1, false), 1)],
    )?;
    same(&seen, &vec![vec![3, 2, 0], vec![3, 0, 0]], "a button")?;
    line.write(&[4, 1])?;
    line.write(&[4, 0])?;
    shown(watch, &cable, &[Shown::Lamp(true), Shown::Lamp(false)])
}

fn shuttle(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("shuttlepro-v2", 1, watch)?;
    let mut line = opened(watch, "shuttlepro-v2")?;
    until_open(watch, &cable)?;
    let wheel = (0..8).map(|_| (dial(0, 1), 1));
    let buttons = (0..15).flat_map(|control| [(button(control, true), 1), (button(control, false), 1)]);
    let seen = play(
        watch,
        &cable,
        &mut *line,
        &wheel.chain(buttons).collect::<Vec<_>>(),
    )?;
    let counter: Vec<u8> = seen[..8].iter().map(|bytes| bytes[1]).collect();
    same(
        &counter,
        &vec![0xFE, 0xFF, 0, 1, 2, 3, 4, 5],
        "the wheel's counter",
    )?;
    for (control, pair) in seen[8..].chunks(2).enumerate() {
        let down = u16::from_le_bytes([pair[0][3], pair[0][4]]);
        same(&down, &(1 << control), &format!("button {control}"))?;
        same(&pair[1][3..], &[0, 0][..], &format!("button {control} up"))?;
    }
    Ok(())
}

fn pen(x: f64, y: f64) -> Touch {
    Touch::Pen(Pen {
        x,
        y,
        tip: true,
        pressure: 0.5,
        tilt_deg: [10, -20],
        ..Pen::default()
    })
}

fn hs610(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("hs610", 1, watch)?;
    // Its vendor and product are many devices'; only the string tells.
    let mut line = opened(watch, "hs610")?;
    until_open(watch, &cable)?;
    let unset = answered(watch, || line.read_string(123))?;
    same(
        &(unset.len(), unset[1]),
        &(200, 0x0E),
        "memory nobody set, with its head",
    )?;
    let parameters = answered(watch, || line.read_string(200))?;
    same(
        &parameters[..8],
        &[0x13, 3, 0x70, 0xC6, 0, 6, 0x7C, 0][..],
        "string 200",
    )?;
    touch(&cable, &pen(0.0, 0.0))?;
    let drawn = reports(watch, &mut *line, 20)?;
    touch(&cable, &Touch::Away)?;
    ensure!(
        drawn
            .iter()
            .all(|bytes| bytes[..2] == [8, 0x81] && bytes.len() == 12),
        "pen reports: {drawn:02x?}"
    );
    settled(watch, &cable, &mut *line, drawn)?;
    let ring = |at| (Touch::Ring { control: 0, at }, 1);
    let seen = play(
        watch,
        &cable,
        &mut *line,
        &[
            (button(11, true), 1),
            (button(11, false), 1),
            ring(Some(0.5)),
            ring(None),
        ],
    )?;
    let told: Vec<_> = seen.iter().map(|bytes| (bytes[1], bytes[4], bytes[5])).collect();
    same(
        &told,
        &vec![(0xE0, 0, 8), (0xE0, 0, 0), (0xF0, 0, 7), (0xF0, 0, 0)],
        "keys and ring",
    )
}

fn deco(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("deco-01-v2-rev-b", 1, watch)?;
    let before = find_one(watch, "deco-01-v2")?;
    same(&before.product, &Some(0x0905), "the product before")?;
    let mut line = open(&before)?;
    line.write(&[2, 0xB0, 4, 0, 0, 0, 0, 0, 0, 0])?;
    // The answer may be lost with the device; what it said must not be another.
    if let Ok(parameters) = answered(watch, || line.read_string(100)) {
        same(&parameters[..4], &[0x0C, 3, 0x38, 0x63][..], "string 100")?;
    }
    until_gone(watch, &mut *line)?;
    drop(line);
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    let after = loop {
        let found = all_of("deco-01-v2");
        let sibling = |found: &&Found| (found.product, found.interface) == (Some(0x1227), Some(2));
        if let Some(sibling) = found.iter().find(sibling) {
            break sibling.clone();
        }
        ensure!(watch.now_us() < until_us, "no sibling among {found:?}");
        watch.pause(Duration::from_millis(50));
    };
    let mut line = open(&after)?;
    until_open(watch, &cable)?;
    let seen = play(
        watch,
        &cable,
        &mut *line,
        &[(pen(1.0, -1.0), 1), (Touch::Away, 1), (button(7, true), 1)],
    )?;
    let told: Vec<_> = seen.iter().map(|bytes| (bytes[0], bytes[1])).collect();
    same(&told, &vec![(2, 0xA1), (2, 0xC0), (2, 0xF0)], "pen, leave, key")?;
    same(
        &seen[0][2..6],
        &[0x38, 0x63, 0x03, 0x3E][..],
        "the corner's counts",
    )
}

fn ctl_472(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("ctl-472", 1, watch)?;
    let mut line = opened(watch, "ctl-472")?;
    until_open(watch, &cable)?;
    answered(watch, || line.write_feature(&[2, 2]))?;
    let mut buffer = [0; 8];
    let length = answered(watch, || line.read_feature(2, &mut buffer))?;
    same(&(length, buffer[1]), &(2, 2), "the mode")?;
    let seen = play(
        watch,
        &cable,
        &mut *line,
        &[(pen(-1.0, 1.0), 2), (pen(1.0, -1.0), 1), (Touch::Away, 3)],
    )?;
    let states: Vec<u8> = seen.iter().map(|bytes| bytes[1]).collect();
    same(
        &states,
        &vec![0xD0, 0xE1, 0xE1, 0xD0, 0x80, 0x00],
        "coming, drawing, going",
    )?;
    same(
        &seen[2][2..6],
        &[0x60, 0x3B, 0x1C, 0x25][..],
        "the corner's counts",
    )
}

fn pth_660(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("pth-660", 1, watch)?;
    let found = find_one(watch, "pth-660")?;
    same(
        &(found.interface, found.serial.as_str()),
        &(Some(0), "0SIM000660"),
        "interface and number",
    )?;
    let mut line = open(&found)?;
    until_open(watch, &cable)?;
    let ring = |at| (Touch::Ring { control: 0, at }, 1);
    let seen = play(
        watch,
        &cable,
        &mut *line,
        &[
            (pen(0.0, 0.0), 1),
            (button(8, true), 1),
            ring(Some(0.25)),
            ring(None),
            (Touch::Away, 1),
        ],
    )?;
    let told: Vec<_> = seen.iter().map(|bytes| (bytes[0], bytes.len())).collect();
    same(
        &told,
        &vec![(0x10, 27), (0x11, 9), (0x11, 9), (0x11, 9), (0x10, 27)],
        "pen and pad",
    )?;
    same(
        &(seen[2][3], seen[2][4]),
        &(1, 0x80 + 18),
        "the ring's key and place",
    )
}

fn by_uhid(watch: &Watch) -> anyhow::Result<()> {
    let script = "/tmp/turn.txt";
    std::fs::write(
        script,
        "at 0.3 dial 0 +30 over 0.3\nat 0.8 button 0 down\nat 0.9 button 0 up\n",
    )?;
    for _ in 0..2 {
        let simulated = Running::start(&[
            "sim",
            "dial-box",
            "--kind",
            "powermate",
            "--uhid",
            "--script",
            script,
            "--json",
        ])?;
        let mut line = opened(watch, "powermate")?;
        let mut seen = Vec::new();
        let sum = |seen: &[Vec<u8>]| seen.iter().map(|bytes| i32::from(bytes[1] as i8)).sum::<i32>();
        let presses = |seen: &[Vec<u8>]| seen.iter().filter(|bytes| bytes[0] == 1).count();
        while sum(&seen) < 30 || presses(&seen) < 1 || seen.last().is_some_and(|last| last[0] == 1) {
            seen.extend(reports(watch, &mut *line, 1)?);
        }
        quiet(watch, &mut *line, Duration::from_millis(300))?;
        same(
            &(sum(&seen), presses(&seen)),
            &(30, 1),
            "the script's turn and press",
        )?;
        line.write(&[0, 0x42])?;
        simulated.shown("level", 0x42, PATIENCE)?;
        drop(simulated);
        until_gone(watch, &mut *line)?;
    }
    Ok(())
}
