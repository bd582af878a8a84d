//! Many devices, much load, cables that do not stay in, and users without rights.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anyhow::{Context, ensure};
use device::discovery::Access;
use firmware_sim::InputFault;
use firmware_sim::hands::{Touch, Turn};

use super::open::{
    answered, drained, find, find_one, open, opened, plugged, reports, touch, until_gone, until_open, with,
};
use super::{Claim, PATIENCE, same};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::Hid;
use crate::kernel::host;

pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        name: "load: a wheel that turns through five unpluggings is heard in order, nothing twice, nothing invented",
        show: unplug_under_load,
    },
    Claim {
        name: "load: a cable that comes out inside every step of a handshake ends it, and the next one works",
        show: unplug_in_handshake,
    },
    Claim {
        name: "load: ten equal devices are ten, each with its own place, each heard by itself",
        show: ten_equal,
    },
    Claim {
        name: "load: eight thousand reports a second are taken in or counted, in bounded memory",
        show: flood,
    },
    Claim {
        name: "load: a user without rights sees the device, is refused, and is told which rule grants it",
        show: no_rights,
    },
];

pub(super) fn turn(clicks: i32, over_us: u64) -> Touch {
    Touch::Dial {
        control: 0,
        by: Turn::Counts(clicks),
        over_us,
    }
}

/// Does something while a hand turns, a click at a time.
pub(super) fn while_turning<T>(
    watch: &Watch,
    cable: &Cable<Hid>,
    act: impl FnOnce() -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    /// A hundred clicks a second: a node holds what comes in more than half a second.
    const CLICK_EVERY: Duration = Duration::from_millis(10);
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let hand = scope.spawn(|| {
            while !done.load(Ordering::SeqCst) {
                touch(cable, &turn(1, 0))?;
                watch.pause(CLICK_EVERY);
            }
            anyhow::Ok(())
        });
        let acted = act();
        done.store(true, Ordering::SeqCst);
        let turned = hand.join().map_err(|_| anyhow::anyhow!("the hand panicked"))?;
        turned.and(acted)
    })
}

fn unplug_under_load(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("shuttlepro-v2", 1, watch)?;
    for _ in 0..5 {
        let mut line = opened(watch, "shuttlepro-v2")?;
        until_open(watch, &cable)?;
        let seen = while_turning(watch, &cable, || {
            let mut seen = reports(watch, &mut *line, 15)?;
            cable.plug(false);
            seen.extend(until_gone(watch, &mut *line)?);
            Ok(seen)
        })?;
        ensure!(seen.len() >= 15, "only {} reports", seen.len());
        // To the last one: what a node still holds when its device goes is read.
        let taken = cable.with(|hid, _| hid.taken());
        same(&seen, &taken, "reports against what the kernel took")?;
        cable.plug(true);
    }
    Ok(())
}

fn unplug_in_handshake(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("hs610", 1, watch)?;
    for step in 0..3 {
        let mut line = opened(watch, "hs610")?;
        with(&cable, |device, now_us| {
            device.inject(now_us, InputFault::UnplugAfterRequests(step));
        });
        for index in [202, 201, 200] {
            // Refused, gone or answered: whichever, it must come back.
            let asked = answered(watch, || line.read_string(index));
            drop(asked);
        }
        until_gone(watch, &mut *line)?;
        with(&cable, |device, now_us| device.plug(now_us, true));
    }
    let mut line = opened(watch, "hs610")?;
    until_open(watch, &cable)?;
    answered(watch, || line.read_string(200))?;
    touch(
        &cable,
        &Touch::Button {
            control: 0,
            down: true,
        },
    )?;
    let seen = reports(watch, &mut *line, 1)?;
    same(
        &seen[0][..5],
        &[8, 0xE0, 1, 1, 1][..],
        "a key after the handshake that went through",
    )
}

fn ten_equal(watch: &Watch) -> anyhow::Result<()> {
    // A virtual hub has fewer ports than that: the rest come by uhid, as from another one.
    let cables: Vec<_> = (1..=7)
        .map(|n| plugged("shuttlepro-v2", n, watch))
        .collect::<Result<_, _>>()?;
    let by_uhid: Vec<_> = (0..3)
        .map(|_| host::Running::start(&["sim", "dial-box", "--kind", "shuttlepro-v2", "--uhid"]))
        .collect::<Result<_, _>>()?;
    let found = find(watch, "shuttlepro-v2", 10)?;
    let mut places: Vec<_> = found.iter().filter_map(|found| found.place.clone()).collect();
    places.sort();
    places.dedup();
    ensure!(places.len() >= 7, "places of ten equal devices: {places:?}");
    let mut lines = found.iter().map(open).collect::<Result<Vec<_>, _>>()?;
    for cable in &cables {
        until_open(watch, cable)?;
    }
    for (n, cable) in cables.iter().enumerate() {
        touch(cable, &turn(n as i32 + 1, 0))?;
    }
    let mut heard = Vec::new();
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    // A little longer than until each was heard: nobody may be heard twice, or by another's line.
    let mut all_us = None;
    while all_us.is_none_or(|all_us| watch.now_us() < all_us + 300_000) && watch.now_us() < until_us {
        for line in &mut lines {
            let mut buffer = [0; 64];
            while line.read(&mut buffer)? > 0 {
                heard.push(buffer[1].wrapping_sub(0xFD));
            }
        }
        if all_us.is_none() && heard.len() >= cables.len() {
            all_us = Some(watch.now_us());
        }
        watch.pause(Duration::from_millis(5));
    }
    heard.sort_unstable();
    same(&heard, &vec![1, 2, 3, 4, 5, 6, 7], "one turn of each")?;
    drop(by_uhid);
    Ok(())
}

fn flood(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("powermate", 1, watch)?;
    let mut line = opened(watch, "powermate")?;
    until_open(watch, &cable)?;
    let before_kib = resident_kib()?;
    with(&cable, |device, now_us| {
        device.inject(
            now_us,
            InputFault::Flood {
                hz: 8000,
                for_us: 200_000,
            },
        );
    });
    // Nobody reads meanwhile.
    watch.pause(Duration::from_millis(1500));
    let came = drained(watch, &mut *line)?.len() as u64;
    let taken = cable.with(|hid, _| hid.taken()).len() as u64;
    ensure!(came + line.dropped() <= taken, "{came} came of {taken}");
    ensure!(came > 64, "only {came} came of {taken}");
    let grown_kib = resident_kib()?.saturating_sub(before_kib);
    ensure!(grown_kib < 8192, "memory grew by {grown_kib} KiB");
    touch(
        &cable,
        &Touch::Button {
            control: 0,
            down: true,
        },
    )?;
    let seen = reports(watch, &mut *line, 1)?;
    same(&seen[0][0], &1, "a press after the flood")
}

fn resident_kib() -> anyhow::Result<u64> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"));
    let word = line.and_then(|line| line.split_whitespace().nth(1));
    Ok(word.context("VmRSS")?.parse()?)
}

fn no_rights(watch: &Watch) -> anyhow::Result<()> {
    let _cable = plugged("powermate", 1, watch)?;
    let found = find_one(watch, "powermate")?;
    same(&found.access, &Access::Allowed, "what root may")?;
    let told = host::devices(true)?;
    let record = told.iter().find(|record| host::address(record) == found.address);
    let record = record.with_context(|| format!("{} among {told:?}", found.address))?;
    ensure!(
        host::is_of(record, "powermate"),
        "it is known all the same: {record}"
    );
    same(&record["allowed"].as_bool(), &Some(false), "what he may")?;
    let remedy = record["remedy"].as_str().unwrap_or_default();
    ensure!(
        remedy.contains("--install-rules"),
        "it should name the rule: {record}"
    );
    let said = host::run(&["monitor", &found.address, "--json"], true)?;
    same(&said.status.code(), &Some(1), &format!("the exit of {said:?}"))?;
    for word in ["permission denied", "--install-rules"] {
        ensure!(said.err.contains(word), "monitor should say \"{word}\": {said:?}");
    }
    Ok(())
}
