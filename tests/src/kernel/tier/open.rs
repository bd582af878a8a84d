//! The host's own way to an input device: what is plugged in, which profile it is, a line to it.

use std::sync::{Arc, LazyLock};
use std::time::Duration;

use anyhow::{Context, bail, ensure};
use device::clock::{Clock, MonotonicClock};
use device::discovery::{self, Found, Places, Strings, Verdict};
use device::transport::Transport;
use device_profiles::Profiles;
use firmware_sim::hands::Touch;
use firmware_sim::{UsbDevice, usb_kind};

use super::{PATIENCE, same};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::Hid;

/// A simulated device of this kind, with its cable in.
pub(super) fn plugged(kind: &str, device: u32, watch: &Watch) -> anyhow::Result<Cable<Hid>> {
    let kind = usb_kind(kind).context("no such kind")?;
    Ok(Cable::plug_in(Hid::new((kind.make)()), device, watch))
}

/// Waits until the kernel asks it for reports: opening a node takes a moment to get there.
pub(super) fn until_open(watch: &Watch, cable: &Cable<Hid>) -> anyhow::Result<()> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    while !cable.with(|hid, _| hid.is_open()) {
        ensure!(
            watch.now_us() < until_us,
            "it was opened, and the kernel never asked it"
        );
        watch.pause(Duration::from_millis(2));
    }
    Ok(())
}

/// Lays a hand on it.
pub(super) fn touch(cable: &Cable<Hid>, touch: &Touch) -> anyhow::Result<()> {
    let done = cable.with(|hid, now_us| hid.device().touch(now_us, touch));
    ensure!(done, "no such control: {touch:?}");
    Ok(())
}

/// The device itself.
pub(super) fn with<T>(cable: &Cable<Hid>, act: impl FnOnce(&mut dyn UsbDevice, u64) -> T) -> T {
    cable.with(|hid, now_us| act(hid.device(), now_us))
}

/// Everything the host finds now that is this profile and nothing else.
pub(super) fn all_of(profile: &str) -> Vec<Found> {
    // Reading eighty profiles is a second's work for an emulated processor.
    static PROFILES: LazyLock<Profiles> = LazyLock::new(Profiles::builtin);
    let mut strings = Strings::new();
    let mut all = discovery::list(&Places::default());
    all.retain(|found| {
        let mut ask = |index| strings.get(found, index);
        matches!(discovery::judge(found, &PROFILES, &mut ask), Verdict::One(one) if one.key == profile)
    });
    all
}

/// What the host finds of a profile, once there are `count`.
pub(super) fn find(watch: &Watch, profile: &str, count: usize) -> anyhow::Result<Vec<Found>> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    loop {
        let these = all_of(profile);
        if these.len() == count {
            return Ok(these);
        }
        if watch.now_us() > until_us {
            let all = discovery::list(&Places::default());
            bail!("{} of {count} {profile} among {all:#?}", these.len());
        }
        // Looking is work too, and the device is still coming.
        watch.pause(Duration::from_millis(80));
    }
}

/// The only one of this profile.
pub(super) fn find_one(watch: &Watch, profile: &str) -> anyhow::Result<Found> {
    find(watch, profile, 1)?.pop().context("found and lost")
}

/// A line to it. The node may be older than the right to open it.
pub(super) fn open(found: &Found) -> anyhow::Result<Box<dyn Transport>> {
    let clock: Arc<dyn Clock> = Arc::new(MonotonicClock::new());
    Ok(discovery::open(
        &Places::default(),
        &found.address.parse()?,
        None,
        &clock,
    )?)
}

/// Opens the only one of this profile.
pub(super) fn opened(watch: &Watch, profile: &str) -> anyhow::Result<Box<dyn Transport>> {
    open(&find_one(watch, profile)?)
}

/// A question that may be answered later: asks until it is.
pub(super) fn answered<T>(
    watch: &Watch,
    mut ask: impl FnMut() -> Result<Option<T>, device::transport::TransportError>,
) -> anyhow::Result<T> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    loop {
        if let Some(answer) = ask()? {
            return Ok(answer);
        }
        ensure!(watch.now_us() < until_us, "no answer");
        watch.pause(Duration::from_millis(2));
    }
}

/// Reports as they come, until as many came as wanted; a device that is gone before ends it.
pub(super) fn reports(watch: &Watch, line: &mut dyn Transport, count: usize) -> anyhow::Result<Vec<Vec<u8>>> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    let mut seen = Vec::new();
    let mut buffer = [0; 256];
    while seen.len() < count {
        match line.read(&mut buffer) {
            Ok(0) => watch.pause(Duration::from_millis(1)),
            Ok(length) => {
                ensure!(line.arrived().is_some(), "a report without the time it arrived");
                seen.push(buffer[..length].to_vec());
            }
            Err(error) if error.is_gone() => break,
            Err(error) => bail!(error),
        }
        ensure!(
            watch.now_us() < until_us,
            "{} of {count} reports came: {seen:02x?}",
            seen.len()
        );
    }
    Ok(seen)
}

/// So long nothing must come before it is said that nothing does.
const SILENCE_US: u64 = 300_000;

/// Every report that still comes, until none has for a while; for devices of which some reports may be lost.
pub(super) fn drained(watch: &Watch, line: &mut dyn Transport) -> anyhow::Result<Vec<Vec<u8>>> {
    let mut seen = Vec::new();
    let mut buffer = [0; 256];
    let mut last_us = watch.now_us();
    while watch.now_us() < last_us + 3 * SILENCE_US {
        match line.read(&mut buffer)? {
            0 => watch.pause(Duration::from_millis(2)),
            length => {
                seen.push(buffer[..length].to_vec());
                last_us = watch.now_us();
            }
        }
    }
    Ok(seen)
}

/// Everything the host gets besides `seen`, until it has as much as the kernel took and nothing more comes; all of it
/// must be what the kernel took, in its order.
pub(super) fn settled(
    watch: &Watch,
    cable: &Cable<Hid>,
    line: &mut dyn Transport,
    mut seen: Vec<Vec<u8>>,
) -> anyhow::Result<Vec<Vec<u8>>> {
    let mut taken = Vec::new();
    let mut buffer = [0; 256];
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    let mut last_us = watch.now_us();
    loop {
        let now_us = watch.now_us();
        let new = cable.with(|hid, _| hid.taken());
        let length = line.read(&mut buffer)?;
        if !new.is_empty() || length > 0 {
            last_us = now_us;
        }
        taken.extend(new);
        if length > 0 {
            seen.push(buffer[..length].to_vec());
            continue;
        }
        let is_still = now_us > last_us + SILENCE_US;
        if now_us > until_us || is_still && seen.len() >= taken.len() {
            same(&seen, &taken, "reports against what the kernel took")?;
            return Ok(seen);
        }
        watch.pause(Duration::from_millis(2));
    }
}

/// Reports that come within a time nobody does anything in.
pub(super) fn quiet(watch: &Watch, line: &mut dyn Transport, span: Duration) -> anyhow::Result<()> {
    watch.pause(span);
    let mut buffer = [0; 256];
    let length = line.read(&mut buffer)?;
    ensure!(
        length == 0,
        "nobody did anything, and {:02x?} came",
        &buffer[..length]
    );
    Ok(())
}

/// Waits until the line says that its device is gone; what still came before.
pub(super) fn until_gone(watch: &Watch, line: &mut dyn Transport) -> anyhow::Result<Vec<Vec<u8>>> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    let mut seen = Vec::new();
    let mut buffer = [0; 256];
    loop {
        match line.read(&mut buffer) {
            Ok(0) => watch.pause(Duration::from_millis(1)),
            Ok(length) => seen.push(buffer[..length].to_vec()),
            Err(error) if error.is_gone() => return Ok(seen),
            Err(error) => bail!("another error than being gone: {error}"),
        }
        ensure!(watch.now_us() < until_us, "unplugged, and never said to be gone");
    }
}
