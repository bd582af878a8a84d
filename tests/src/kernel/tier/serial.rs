//! Serial devices: a dial box on CDC-ACM, a servo bus behind an FTDI adapter.

use std::time::Duration;

use anyhow::{Context, ensure};
use device::transport::{Transport, open, ports};
use device_profiles::Profiles;
use firmware_sim::dial_box::Options;
use firmware_sim::hands::{Hands, Touch, Turn};
use firmware_sim::servo_bus::{BusOptions, Unit};
use firmware_sim::{ServoBus, SgiDialBox};

use super::{Claim, PATIENCE, edges, monitor, same, turned};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::{Acm, Ftdi};
use crate::kernel::host::{self, Running};

pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        name: "serial: a dial box on CDC-ACM is listed with its maker's words and heard to the count",
        show: dial_box,
    },
    Claim {
        name: "serial: a dial box unplugged while it turns is named gone, and heard again when it is back",
        show: dial_box_unplugged,
    },
];

/// Of the servo bus: these wait more than they work.
pub(super) const BUS_CLAIMS: &[Claim] = &[
    Claim {
        name: "serial: a servo bus behind an FTDI adapter is scanned at a million baud",
        show: servo_bus,
    },
    Claim {
        name: "serial: dialrig servo doctor finds the adapter's latency timer at 16 ms and sets it to 1 ms in the chip",
        show: doctor,
    },
    Claim {
        name: "serial: the adapter's latency timer is set through the kernel, and answers come whole at every setting",
        show: latency_timer,
    },
];

/// Words of a dial box on USB.
pub(super) const BOX: [&str; 3] = ["Dialrig Bench", "SGI dial box on USB", "BOX0001"];
const ADAPTER: [&str; 3] = ["FTDI", "FT232R USB UART", "BENCH001"];

/// Where the kernel has put a device whose serial number is known. The other devices are left alone: to list them all
/// would ask some for strings, and what they are asked is counted in the other lane.
pub(super) fn port(watch: &Watch, serial: &str) -> anyhow::Result<String> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    loop {
        let all = ports::list();
        if let Some(found) = ports::of_usb_serial(&all, serial) {
            return Ok(found.path.clone());
        }
        ensure!(watch.now_us() < until_us, "no port of {serial} among {all:?}");
        watch.pause(Duration::from_millis(50));
    }
}

fn turn(dial_box: &Cable<Acm<SgiDialBox>>, control: u8, counts: i32, over_us: u64) {
    dial_box.with(|acm, now_us| {
        let by = Turn::Counts(counts);
        acm.firmware()
            .touch(now_us, &Touch::Dial { control, by, over_us })
    });
}

/// Turns dial 7 a count at a time until a monitor hears it: what is turned before the box was told to report is lost.
fn heard(watch: &Watch, dial_box: &Cable<Acm<SgiDialBox>>, monitor: &Running) -> anyhow::Result<()> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    loop {
        turn(dial_box, 7, 1, 0);
        let first = |records: &[serde_json::Value]| turned(records, 7) > 0;
        let seen = monitor.until(Duration::from_millis(100), "a first event", first);
        if seen.is_ok() || watch.now_us() > until_us {
            return seen.map(drop);
        }
    }
}

fn dial_box(watch: &Watch) -> anyhow::Result<()> {
    let cable = Cable::plug_in(Acm::new(SgiDialBox::new(Options::default()), BOX), 9, watch);
    let port = port(watch, BOX[2])?;
    let all = host::devices(false)?;
    let listed = all.iter().find(|record| host::address(record) == port);
    let words = listed.and_then(|record| record["description"].as_str());
    ensure!(
        words.is_some_and(|words| BOX.iter().all(|word| words.contains(word))),
        "{port} is to be listed with {BOX:?}: {all:?}"
    );
    let monitor = monitor(&port, Some("sgi-dialbox"))?;
    heard(watch, &cable, &monitor)?;
    turn(&cable, 0, 200, 700_000);
    turn(&cable, 3, -77, 300_000);
    for down in [true, false] {
        cable.with(|acm, now_us| acm.firmware().touch(now_us, &Touch::Button { control: 31, down }));
        watch.pause(Duration::from_millis(30));
    }
    let done = |records: &[serde_json::Value]| {
        turned(records, 0) == 200 && turned(records, 3) == -77 && edges(records).len() == 2
    };
    let records = monitor.until(PATIENCE, "200 and -77 counts and a key", done)?;
    same(&edges(&records), &vec![(31, true), (31, false)], "the key")?;
    // And nothing after it that nobody did.
    watch.pause(Duration::from_millis(300));
    let records = monitor.until(PATIENCE, "nothing", |_| true)?;
    same(
        &(turned(&records, 0), turned(&records, 3)),
        &(200, -77),
        "the dials",
    )
}

fn dial_box_unplugged(watch: &Watch) -> anyhow::Result<()> {
    let cable = Cable::plug_in(Acm::new(SgiDialBox::new(Options::default()), BOX), 9, watch);
    for _ in 0..2 {
        let port = port(watch, BOX[2])?;
        let mut monitor = monitor(&port, Some("sgi-dialbox"))?;
        heard(watch, &cable, &monitor)?;
        turn(&cable, 0, 100_000, 100_000_000);
        monitor.until(PATIENCE, "turning", |records| turned(records, 0) > 20)?;
        cable.plug(false);
        let status = monitor.ended(watch, PATIENCE)?;
        same(&status.code(), &Some(3), "the exit of a lost device")?;
        let records = monitor.all(PATIENCE)?;
        ensure!(
            records.iter().all(|record| record["delta"].as_i64() > Some(0)),
            "only turns to the right were made: {records:?}"
        );
        let words = monitor.errors().join("\n");
        ensure!(
            words.contains("gone"),
            "it should say that the device is gone: {words}"
        );
        ensure!(!words.contains("panicked"), "{words}");
        cable.with(|acm, now_us| acm.firmware().touch(now_us, &Touch::PowerCycle));
        cable.plug(true);
    }
    Ok(())
}

/// So many servos behind an adapter.
fn bus(count: u8) -> anyhow::Result<ServoBus> {
    let profiles = Profiles::builtin();
    let mut bus = ServoBus::new(BusOptions {
        baud: 1_000_000,
        ..BusOptions::default()
    });
    let model = profiles.servo("XL430-W250")?;
    for id in 1..=count {
        bus.add(model, Unit::new(id)).context("a servo")?;
    }
    Ok(bus)
}

/// Tries again for a while: servos answer within milliseconds or count as absent, and an emulated processor beside other
/// work does not always have them.
fn at_length<T>(watch: &Watch, mut attempt: impl FnMut() -> anyhow::Result<T>) -> anyhow::Result<T> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    loop {
        let done = attempt();
        if done.is_ok() || watch.now_us() > until_us {
            return done;
        }
    }
}

fn servo_bus(watch: &Watch) -> anyhow::Result<()> {
    let cable = Cable::plug_in(Ftdi::new(bus(6)?, ADAPTER), 9, watch);
    let port = port(watch, ADAPTER[2])?;
    let line = ["--port", &port, "--baud", "1000000", "--json"];
    let scan = [&["servo", "scan"], &line[..], &["--protocol", "dxl2"]].concat();
    at_length(watch, || {
        let said = host::run(&scan, false)?;
        ensure!(said.status.success(), "{said:?}");
        let ids: Vec<u64> = said
            .out
            .lines()
            .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
            .filter_map(|record| record["id"].as_u64())
            .collect();
        same(&ids, &vec![1, 2, 3, 4, 5, 6], &format!("servos in {}", said.out))
    })?;
    same(&cable.with(|ftdi, _| ftdi.baud()), &1_000_000, "the line's speed")?;
    let read = [&["servo", "read"], &line[..], &["1", "Present Position"]].concat();
    at_length(watch, || {
        let said = host::run(&read, false)?;
        ensure!(said.status.success(), "{said:?}");
        Ok(())
    })
}

/// Where the kernel shows the timer of the adapter behind a port.
fn timer_file(port: &str) -> String {
    let name = port.trim_start_matches("/dev/");
    format!("/sys/bus/usb-serial/devices/{name}/latency_timer")
}

fn latency_timer(watch: &Watch) -> anyhow::Result<()> {
    let cable = Cable::plug_in(Ftdi::new(bus(6)?, ADAPTER), 9, watch);
    let port = port(watch, ADAPTER[2])?;
    let file = timer_file(&port);
    let kernel = || std::fs::read_to_string(&file).map(|text| text.trim().to_owned());
    same(&kernel()?.as_str(), &"16", "the kernel's timer")?;
    for (ms, set_by) in [(1, "1"), (7, "7"), (16, "16")] {
        std::fs::write(&file, set_by)?;
        let set = cable.with(|ftdi, _| ftdi.latency_ms());
        same(&set, &ms, "the chip's timer after the kernel has set it")?;
        same(&kernel()?.as_str(), &set_by, "and what the kernel reads")?;
        let mut line = open(&port.parse()?, 1_000_000)?;
        answered_pings(watch, &mut *line)?;
    }
    Ok(())
}

fn doctor(watch: &Watch) -> anyhow::Result<()> {
    let cable = Cable::plug_in(Ftdi::new(bus(1)?, ADAPTER), 9, watch);
    let port = port(watch, ADAPTER[2])?;
    let look = [
        "servo", "doctor", "--port", &port, "--baud", "1000000", "--json", "--fix",
    ];
    at_length(watch, || {
        // As the chip comes.
        std::fs::write(timer_file(&port), "16")?;
        let said = host::run(&look, false)?;
        // What is mended is named before, with what it was; what is found after is a record.
        let named = said.err.lines().find(|line| line.contains("16 ms"));
        let named = named.with_context(|| format!("the timer at 16 ms is to be named: {said:?}"))?;
        ensure!(named.contains("latency timer"), "{named}");
        ensure!(
            !said.out.contains("adapter-latency"),
            "after mending it is found no more: {said:?}"
        );
        let timer = cable.with(|ftdi, _| ftdi.latency_ms());
        same(&timer, &1, &format!("the chip's timer after {said:?}"))
    })
}

/// Some pings of servo 1, each answered in full. How long they take says nothing here: an emulated processor adds more
/// than the timer does.
fn answered_pings(watch: &Watch, line: &mut dyn Transport) -> anyhow::Result<()> {
    /// Ping of id 1 and the length of its status (DYNAMIXEL protocol 2.0).
    const PING: [u8; 10] = [0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E];
    const STATUS_BYTES: usize = 14;
    for _ in 0..5 {
        let began_us = watch.now_us();
        line.write(&PING)?;
        let mut count = 0;
        while count < STATUS_BYTES {
            count += line.read(&mut [0; 64])?;
            watch.pause(Duration::from_micros(300));
            ensure!(
                watch.now_us() < began_us + PATIENCE.as_micros() as u64,
                "{count} bytes of a status came"
            );
        }
        same(&count, &STATUS_BYTES, "the bytes of a status")?;
    }
    Ok(())
}
