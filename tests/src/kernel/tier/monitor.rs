//! HID devices heard by the unmodified command: what `dialrig monitor` and `dialrig devices` print of them.

use std::process::{Child, Command};
use std::time::Duration;

use anyhow::{Context, ensure};
use firmware_sim::InputFault;
use firmware_sim::hands::{Pen, Touch};
use serde_json::Value;

use super::many::{turn, while_turning};
use super::open::{find_one, plugged, touch, until_open, with};
use super::{Claim, PATIENCE, edges, monitor, same, told};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::Hid;
use crate::kernel::host::{self, Running};

pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        name: "monitor: a PowerMate named by its node alone is told turn by turn and press by press",
        show: knob,
    },
    Claim {
        name: "monitor: a CTL-472 is switched to its own reports, and every stroke is told sample by sample",
        show: strokes,
    },
    Claim {
        name: "monitor: nonsense, short, long and foreign reports among a CTL-472's own are passed over or counted, and add no event",
        show: spoilt,
    },
    Claim {
        name: "monitor: a six-axis cap of unknown ids is told by its report descriptor",
        show: unknown,
    },
    Claim {
        name: "monitor: beside two busy programs, a knob that turns through three unpluggings is told in order, nothing lost, nothing invented",
        show: under_load,
    },
    Claim {
        name: "devices: --watch tells what comes, with its profile, and what goes",
        show: watching,
    },
];

fn button(down: bool) -> Touch {
    Touch::Button { control: 0, down }
}

/// A monitor of the only device of that profile, told nothing but its node.
fn listening(watch: &Watch, cable: &Cable<Hid>, profile: &str) -> anyhow::Result<Running> {
    let found = find_one(watch, profile)?;
    let monitor = monitor(&found.address, None)?;
    until_open(watch, cable)?;
    Ok(monitor)
}

/// The steps of a dial that were told, in order.
fn steps(records: &[Value]) -> Vec<i64> {
    let dials = told(records, "dial");
    dials
        .iter()
        .filter_map(|record| record["delta"].as_i64())
        .collect()
}

/// The steps in a PowerMate's reports: the second byte, signed.
fn sent(taken: &[Vec<u8>]) -> Vec<i64> {
    let steps = taken.iter().map(|report| i64::from(report[1] as i8));
    steps.filter(|step| *step != 0).collect()
}

/// Ends a monitor as Ctrl-C does; everything it told, and what it said besides.
fn finished(watch: &Watch, mut monitor: Running) -> anyhow::Result<(Vec<Value>, Vec<String>)> {
    // Whatever was invented had time to be told.
    watch.pause(Duration::from_millis(200));
    monitor.interrupt()?;
    let status = monitor.ended(watch, PATIENCE)?;
    ensure!(status.success(), "{status}: {:?}", monitor.errors());
    let records = monitor.all(PATIENCE)?;
    Ok((records, monitor.errors()))
}

fn knob(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("powermate", 1, watch)?;
    let monitor = listening(watch, &cable, "powermate")?;
    touch(&cable, &turn(90, 500_000))?;
    monitor.until(PATIENCE, "90 to the right", |records| {
        steps(records).iter().sum::<i64>() == 90
    })?;
    touch(&cable, &button(true))?;
    monitor.until(PATIENCE, "a press", |records| edges(records) == [(0, true)])?;
    touch(&cable, &turn(-13, 0))?;
    monitor.until(PATIENCE, "13 back", |records| {
        steps(records).iter().sum::<i64>() == 77
    })?;
    touch(&cable, &button(false))?;
    monitor.until(PATIENCE, "the release", |records| edges(records).len() == 2)?;
    let records = finished(watch, monitor)?.0;
    let taken = cable.with(|hid, _| hid.taken());
    same(&steps(&records), &sent(&taken), "every step, in order")?;
    same(&edges(&records), &vec![(0, true), (0, false)], "the button")?;
    same(
        &records.len(),
        &(steps(&records).len() + 2),
        "nothing else was told",
    )
}

/// Where the pen of a CTL-472 was, in counts, by its own reports: those with the tip down.
fn drawn(taken: &[Vec<u8>]) -> Vec<[u64; 2]> {
    let word = |report: &[u8], at: usize| u64::from(u16::from_le_bytes([report[at], report[at + 1]]));
    let down = taken.iter().filter(|report| report[1] & 1 == 1);
    let mut places: Vec<_> = down.map(|report| [word(report, 2), word(report, 4)]).collect();
    places.dedup();
    places
}

/// A pen that draws, and the counts it is then at: 15,200 by 9,500, y downwards.
fn pen(x: f64, y: f64) -> (Touch, [u64; 2]) {
    let pen = Pen {
        x,
        y,
        tip: true,
        pressure: 0.5,
        ..Pen::default()
    };
    let counts = [(x + 1.0) * 7_600.0, (1.0 - y) * 4_750.0].map(|place| place.round() as u64);
    (Touch::Pen(pen), counts)
}

/// Waits until the pen is told there.
fn until_at(monitor: &Running, counts: [u64; 2]) -> anyhow::Result<()> {
    let there = |records: &[Value]| samples(records).last() == Some(&counts);
    monitor
        .until(PATIENCE, &format!("a sample at {counts:?}"), there)
        .map(drop)
}

fn strokes(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("ctl-472", 1, watch)?;
    let monitor = listening(watch, &cable, "ctl-472")?;
    let mut wanted = Vec::new();
    for stroke in 0..2 {
        for place in 0..25 {
            let (drawing, counts) = pen(f64::from(place) / 12.5 - 1.0, f64::from(stroke) - 0.5);
            touch(&cable, &drawing)?;
            wanted.push(counts);
            // One step of the hand at a time.
            until_at(&monitor, counts)?;
        }
        touch(&cable, &Touch::Away)?;
        let away = |records: &[Value]| flags(records, "in_range").len() == 2 * (stroke as usize + 1);
        monitor.until(PATIENCE, "the pen away", away)?;
    }
    let records = finished(watch, monitor)?.0;
    let taken = cable.with(|hid, _| hid.taken());
    same(
        &drawn(&taken),
        &wanted,
        "the places of the pen in what the kernel took",
    )?;
    let mut told = samples(&records);
    told.dedup();
    same(&told, &wanted, "the places of the pen, in order")?;
    for event in ["in_range", "tip"] {
        same(&flags(&records, event), &vec![true, false, true, false], event)?;
    }
    Ok(())
}

fn spoilt(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("ctl-472", 1, watch)?;
    let monitor = listening(watch, &cable, "ctl-472")?;
    let (drawing, first) = pen(-1.0, 0.0);
    touch(&cable, &drawing)?;
    until_at(&monitor, first)?;
    let mut places = vec![first];
    let mut taken = until_taken(watch, &cable)?;
    let faults = [
        InputFault::Garbage,
        InputFault::Short,
        InputFault::Wrong,
        InputFault::Long,
    ];
    for (n, fault) in (1..).zip(faults) {
        with(&cable, |device, now_us| device.inject(now_us, fault));
        // The first of the two is struck; the second is as it should be.
        for place in [n, n + 10] {
            let (drawing, counts) = pen(f64::from(place) / 20.0, 0.0);
            taken += cable.with(|hid, _| hid.taken()).len();
            touch(&cable, &drawing)?;
            places.push(counts);
            taken += until_taken(watch, &cable)?;
            if place > 10 {
                until_at(&monitor, counts)?;
            }
        }
    }
    touch(&cable, &Touch::Away)?;
    let away = |records: &[Value]| flags(records, "in_range").len() == 2;
    monitor.until(PATIENCE, "the pen away", away)?;
    let (records, said) = finished(watch, monitor)?;
    for event in ["in_range", "tip"] {
        same(&flags(&records, event), &vec![true, false], event)?;
    }
    // What was told was drawn, in its order.
    let mut told = samples(&records);
    told.dedup();
    let mut drawn = places.iter();
    ensure!(
        told.iter().all(|told| drawn.any(|place| place == told)),
        "told {told:?} of {places:?}"
    );
    // The kernel keeps some of them to itself; of what it hands on, each is a report, unknown or rejected.
    taken += cable.with(|hid, _| hid.taken()).len();
    let totals = said.iter().find(|line| line.contains(" rejected"));
    let totals = totals.with_context(|| format!("totals in {said:?}"))?;
    let of = |word: &str| {
        let part = totals.split(", ").find(|part| part.contains(word));
        part.and_then(|part| part.split(' ').next()?.parse::<usize>().ok())
    };
    let heard = of("reports").context("reports")? + of("rejected").context("rejected")?;
    ensure!((8..=taken).contains(&heard), "{totals}; the kernel took {taken}");
    Ok(())
}

/// Waits until the kernel has taken something since this was last asked; how many reports.
fn until_taken(watch: &Watch, cable: &Cable<Hid>) -> anyhow::Result<usize> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    loop {
        let taken = cable.with(|hid, _| hid.taken()).len();
        if taken > 0 {
            return Ok(taken);
        }
        ensure!(watch.now_us() < until_us, "the kernel took nothing");
        watch.pause(Duration::from_millis(1));
    }
}

fn samples(records: &[Value]) -> Vec<[u64; 2]> {
    let samples = told(records, "sample");
    let place = |record: &&Value| Some([record["x"].as_u64()?, record["y"].as_u64()?]);
    samples.iter().filter_map(place).collect()
}

fn flags(records: &[Value], event: &str) -> Vec<bool> {
    let changes = told(records, event);
    changes
        .iter()
        .filter_map(|record| record["value"].as_bool())
        .collect()
}

fn unknown(watch: &Watch) -> anyhow::Result<()> {
    const IDS: [u16; 2] = [0x1209, 0x0002];
    let kind = firmware_sim::usb_kind("spacenavigator").context("no such kind")?;
    let cable = Cable::plug_in(Hid::new((kind.make)()).called(IDS), 1, watch);
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    let address = loop {
        let all = host::devices(false)?;
        let it = all.iter().find(|record| {
            let words = record["description"].as_str().unwrap_or_default();
            words.contains("1209:0002")
        });
        if let Some(record) = it {
            let why = record["why"].as_str().unwrap_or_default();
            ensure!(why.contains("its own description"), "{record}");
            same(&record["profiles"], &Value::Array(Vec::new()), "its profiles")?;
            break host::address(record).to_owned();
        }
        ensure!(watch.now_us() < until_us, "it is not among {all:?}");
    };
    let monitor = monitor(&address, None)?;
    until_open(watch, &cable)?;
    let push = |to| Touch::Axis {
        control: 2,
        to,
        over_us: 0,
    };
    let value = |records: &[Value], of: u64| -> Vec<i64> {
        let axes = told(records, "axis");
        let its = axes.iter().filter(|record| record["control"] == of);
        its.filter_map(|record| record["value"].as_i64()).collect()
    };
    touch(&cable, &push(-1.0))?;
    monitor.until(PATIENCE, "the third axis at its end", |records| {
        value(records, 2).last() == Some(&-350)
    })?;
    touch(&cable, &push(0.0))?;
    monitor.until(PATIENCE, "and back", |records| {
        value(records, 2).last() == Some(&0)
    })?;
    touch(&cable, &button(true))?;
    touch(&cable, &button(false))?;
    monitor.until(PATIENCE, "a press", |records| {
        edges(records) == [(0, true), (0, false)]
    })?;
    let records = finished(watch, monitor)?.0;
    for axis in [0, 1, 3, 4, 5] {
        let values = value(&records, axis);
        ensure!(
            values.iter().all(|value| *value == 0),
            "axis {axis} was not touched: {values:?}"
        );
    }
    Ok(())
}

/// A program that does nothing as fast as it can, until it is dropped.
struct Busy(Child);

impl Busy {
    fn start() -> anyhow::Result<Self> {
        Ok(Self(
            Command::new("sh").args(["-c", "while :; do :; done"]).spawn()?,
        ))
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        // One that has ended already cannot be ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn under_load(watch: &Watch) -> anyhow::Result<()> {
    let _busy = [Busy::start()?, Busy::start()?];
    let cable = plugged("powermate", 1, watch)?;
    for _ in 0..3 {
        let mut monitor = listening(watch, &cable, "powermate")?;
        touch(&cable, &button(true))?;
        while_turning(watch, &cable, || {
            monitor.until(PATIENCE, "a press and twenty steps", |records| {
                steps(records).len() >= 20 && !edges(records).is_empty()
            })?;
            cable.plug(false);
            let status = monitor.ended(watch, PATIENCE)?;
            same(&status.code(), &Some(3), "the exit of a lost device")
        })?;
        let records = monitor.all(PATIENCE)?;
        let heard = steps(&records);
        // To the last one: what a node still holds when its device goes is read.
        let taken = cable.with(|hid, _| hid.taken());
        same(&heard, &sent(&taken), "every step, in order")?;
        // A button that is held when the cable comes out is let go.
        same(&edges(&records), &vec![(0, true), (0, false)], "the button")?;
        same(&records.len(), &(heard.len() + 2), "nothing else was told")?;
        touch(&cable, &button(false))?;
        cable.plug(true);
    }
    Ok(())
}

fn watching(watch: &Watch) -> anyhow::Result<()> {
    let watching = Running::start(&["devices", "--watch", "--json"])?;
    watching.until(PATIENCE, "a first look", |records| !records.is_empty())?;
    let mut address = String::new();
    for _ in 0..2 {
        let before = watching.until(PATIENCE, "nothing", |_| true)?.len();
        let cable = plugged("shuttlepro-v2", 1, watch)?;
        watching.until(PATIENCE, "a ShuttlePRO that has come", |records| {
            let mut new = records[before..].iter();
            let came = new.find(|record| {
                record["change"] != "gone"
                    && record["allowed"] == true
                    && host::is_of(record, "shuttlepro-v2")
            });
            if let Some(record) = came {
                host::address(record).clone_into(&mut address);
            }
            came.is_some()
        })?;
        ensure!(
            address.starts_with("/dev/hidraw"),
            "where it is opened: {address}"
        );
        drop(cable);
        watching.until(PATIENCE, "its going", |records| {
            let mut new = records[before..].iter();
            new.any(|record| record["change"] == "gone" && host::address(record) == address)
        })?;
    }
    Ok(())
}
