//! Class-compliant MIDI controllers behind the kernel's own sound driver.

use std::time::Duration;

use anyhow::ensure;
use device::transport::Transport;
use firmware_sim::dial_box::Output;
use firmware_sim::hands::{Touch, Turn};
use firmware_sim::midi_box::Glow;
use firmware_sim::{MidiOptions, MidiShown, NanoKontrol2, SerialDevice, XTouchMini};
use serde_json::Value;

use super::boxes::{replug, touch, until_shown};
use super::open::{find_one, opened, until_gone};
use super::{Claim, PATIENCE, edges, monitor, same, told};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::Midi;

pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        name: "midi: a nanoKONTROL2 behind snd-usb-audio says every fader's way and every button, lights its lamps, goes and returns",
        show: nano_kontrol2,
    },
    Claim {
        name: "midi: dialrig monitor knows an X-Touch Mini by its port's name and tells its dials, fader and buttons",
        show: x_touch_mini,
    },
    Claim {
        name: "midi: a fader that moves while the cable comes out, twice, is told in order, nothing lost before the end, nothing invented",
        show: unplugged,
    },
];

/// Ids and words of the real ones.
const NANO_IDS: [u16; 2] = [0x0944, 0x0117];
const NANO_TEXTS: [&str; 3] = ["KORG INC.", "nanoKONTROL2", "SIM00001"];
const X_TOUCH_IDS: [u16; 2] = [0x1397, 0x00B3];
const X_TOUCH_TEXTS: [&str; 3] = ["Behringer", "X-TOUCH MINI", "SIM00002"];

/// The lamp of the first button of a nanoKONTROL2 is lit.
pub(super) const LIT: Output = Output::Midi(MidiShown::Lamp {
    control: 0,
    glow: Glow::On,
});

/// A nanoKONTROL2 whose lamps are the host's.
pub(super) fn nano(watch: &Watch) -> Cable<Midi<NanoKontrol2>> {
    let firmware = NanoKontrol2::with_host_lamps(MidiOptions::default());
    Cable::plug_in(Midi::new(firmware, NANO_IDS, NANO_TEXTS), 1, watch)
}

/// An X-Touch Mini as it comes.
pub(super) fn x_touch(watch: &Watch) -> Cable<Midi<XTouchMini>> {
    let firmware = XTouchMini::new(MidiOptions::default());
    Cable::plug_in(Midi::new(firmware, X_TOUCH_IDS, X_TOUCH_TEXTS), 1, watch)
}

pub(super) fn slide(control: u8, to: f64, over_us: u64) -> Touch {
    Touch::Axis { control, to, over_us }
}

/// Whole messages of three bytes, until `last` came.
fn messages(watch: &Watch, line: &mut dyn Transport, last: [u8; 3]) -> anyhow::Result<Vec<[u8; 3]>> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    let mut bytes = Vec::new();
    // As much as a device's line may hand over at once.
    let mut buffer = [0; 4096];
    while !bytes.ends_with(&last) {
        let count = line.read(&mut buffer)?;
        bytes.extend_from_slice(&buffer[..count]);
        ensure!(watch.now_us() < until_us, "waited for {last:02x?}: {bytes:02x?}");
        watch.pause(Duration::from_millis(1));
    }
    ensure!(bytes.len() % 3 == 0, "not whole messages: {bytes:02x?}");
    Ok(bytes.as_chunks::<3>().0.to_vec())
}

fn nano_kontrol2(watch: &Watch) -> anyhow::Result<()> {
    let cable = nano(watch);
    for _ in 0..2 {
        let mut line = opened(watch, "nanokontrol2")?;
        touch(&cable, &slide(2, 1.0, 300_000))?;
        let way = messages(watch, &mut *line, [0xB0, 2, 127])?;
        ensure!(
            way.iter().all(|message| message[..2] == [0xB0, 2])
                && way.windows(2).all(|pair| pair[0][2] < pair[1][2]),
            "a fader that goes up: {way:02x?}"
        );
        touch(&cable, &slide(2, 0.0, 0))?;
        messages(watch, &mut *line, [0xB0, 2, 0])?;
        // The first S button, as Korg numbers it.
        for down in [true, false] {
            touch(&cable, &Touch::Button { control: 0, down })?;
        }
        let press = messages(watch, &mut *line, [0xB0, 32, 0])?;
        same(&press, &vec![[0xB0, 32, 127], [0xB0, 32, 0]], "a press")?;
        line.write(&[0xB0, 32, 127])?;
        until_shown(watch, &cable, &LIT)?;
        cable.plug(false);
        until_gone(watch, &mut *line)?;
        drop(line);
        replug(&cable)?;
    }
    Ok(())
}

/// The values that were told of an axis, in order.
fn values(records: &[Value], control: u64) -> Vec<u8> {
    told(records, "axis")
        .iter()
        .filter(|record| record["control"] == control)
        .filter_map(|record| record["value"].as_u64()?.try_into().ok())
        .collect()
}

/// The values of a controller in what the kernel took, in order.
fn sent<F: SerialDevice + 'static>(cable: &Cable<Midi<F>>, status: u8, number: u8) -> Vec<u8> {
    let taken = cable.with(|midi, _| midi.taken());
    let of_it = |packet: &&[u8; 4]| packet[1..3] == [status, number];
    taken.iter().filter(of_it).map(|packet| packet[3]).collect()
}

fn x_touch_mini(watch: &Watch) -> anyhow::Result<()> {
    let cable = x_touch(watch);
    let found = find_one(watch, "x-touch-mini")?;
    let mut monitor = monitor(&found.address, None)?;
    touch(
        &cable,
        &Touch::Dial {
            control: 3,
            by: Turn::Counts(40),
            over_us: 400_000,
        },
    )?;
    touch(&cable, &slide(0, 0.5, 200_000))?;
    let stands = |records: &[Value]| {
        (
            values(records, 3).last().copied(),
            values(records, 8).last().copied(),
        )
    };
    monitor.until(PATIENCE, "a dial at 40 and the fader in the middle", |records| {
        stands(records) == (Some(40), Some(64))
    })?;
    for (control, down) in [(0, true), (0, false), (23, true), (23, false)] {
        touch(&cable, &Touch::Button { control, down })?;
    }
    monitor.until(PATIENCE, "four edges", |records| edges(records).len() >= 4)?;
    watch.pause(Duration::from_millis(200));
    monitor.interrupt()?;
    let status = monitor.ended(watch, PATIENCE)?;
    ensure!(status.success(), "{status}: {:?}", monitor.errors());
    let records = monitor.all(PATIENCE)?;
    let wanted = vec![(0, true), (0, false), (23, true), (23, false)];
    same(&edges(&records), &wanted, "the buttons")?;
    let taken = cable.with(|midi, _| midi.taken());
    let of = |number: u8| -> Vec<u8> {
        let of_it = |packet: &&[u8; 4]| packet[1..3] == [0xBA, number];
        taken.iter().filter(of_it).map(|packet| packet[3]).collect()
    };
    same(&values(&records, 3), &of(4), "every message of the dial")?;
    same(&values(&records, 8), &of(9), "every message of the fader")?;
    let moved = values(&records, 3).len() + values(&records, 8).len();
    same(&records.len(), &(moved + 4), "nothing else was told")
}

fn unplugged(watch: &Watch) -> anyhow::Result<()> {
    let cable = nano(watch);
    for way in [1.0, 0.0] {
        let found = find_one(watch, "nanokontrol2")?;
        let mut monitor = monitor(&found.address, None)?;
        sent(&cable, 0xB0, 5);
        touch(&cable, &slide(5, way, 4_000_000))?;
        monitor.until(PATIENCE, "the beginning of its way", |records| {
            values(records, 5).len() > 20
        })?;
        cable.plug(false);
        let status = monitor.ended(watch, PATIENCE)?;
        same(&status.code(), &Some(3), "the exit of a lost device")?;
        let records = monitor.all(PATIENCE)?;
        let (heard, sent) = (values(&records, 5), sent(&cable, 0xB0, 5));
        same(&records.len(), &heard.len(), "nothing else was told")?;
        ensure!(
            sent.starts_with(&heard) && sent.len() <= heard.len() + 64,
            "told {heard:?} of {sent:?}"
        );
        // Moved while the box is off: where the fader is then is not told before it moves again.
        touch(&cable, &slide(5, 0.5, 0))?;
        replug(&cable)?;
    }
    Ok(())
}
