//! What is shown on the real kernel, one function a claim. Each plugs in what it needs and pulls it out again.

mod boxes;
mod feedback;
mod hid;
mod many;
mod midi;
mod monitor;
mod nodeless;
mod open;
mod rig;
mod serial;

use std::time::Duration;

use anyhow::ensure;
use serde_json::Value;

use super::cable::Watch;
use super::host::Running;

/// Longest wait for anything. A software-emulated machine beside other work is slow; every wait ends with what it waits
/// for, so this costs nothing where all is well.
const PATIENCE: Duration = Duration::from_mins(1);

/// One claim and what shows it.
pub struct Claim {
    /// In words.
    pub name: &'static str,
    /// Shows it or says why not.
    pub show: fn(&Watch) -> anyhow::Result<()>,
}

/// All of them: those of a lane are shown one after another, beside those of the other lane. Nothing in one lane may
/// have to do with the devices of the other.
pub const LANES: [&[&[Claim]]; 2] = [
    &[
        hid::CLAIMS,
        monitor::CLAIMS,
        nodeless::CLAIMS,
        many::CLAIMS,
        midi::CLAIMS,
        feedback::CLAIMS,
        rig::CLAIMS,
    ],
    &[serial::CLAIMS, serial::BUS_CLAIMS, feedback::SERIAL_CLAIMS],
];

/// A monitor of `address`, which the device has answered. Without a profile it must find out by itself what it is.
fn monitor(address: &str, profile: Option<&str>) -> anyhow::Result<Running> {
    let mut arguments = vec!["monitor", address, "--json"];
    arguments.extend(profile.into_iter().flat_map(|name| ["--profile", name]));
    let monitor = Running::start(&arguments)?;
    monitor.says("the device answers", PATIENCE)?;
    Ok(monitor)
}

/// The values of one kind of event, in order.
fn told<'a>(records: &'a [Value], event: &str) -> Vec<&'a Value> {
    records.iter().filter(|record| record["event"] == event).collect()
}

/// The sum of a dial's deltas.
fn turned(records: &[Value], control: u64) -> i64 {
    told(records, "dial")
        .iter()
        .filter(|record| record["control"] == control)
        .filter_map(|record| record["delta"].as_i64())
        .sum()
}

/// The edges of buttons, in order.
fn edges(records: &[Value]) -> Vec<(u64, bool)> {
    told(records, "button")
        .iter()
        .filter_map(|record| Some((record["control"].as_u64()?, record["value"].as_bool()?)))
        .collect()
}

fn same<T: PartialEq + std::fmt::Debug + ?Sized>(got: &T, want: &T, what: &str) -> anyhow::Result<()> {
    ensure!(got == want, "{what}: got {got:?}, wanted {want:?}");
    Ok(())
}
