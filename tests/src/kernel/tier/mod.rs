//! What is shown on the real kernel, one function a claim. Each plugs in what it needs and pulls it out again.

mod hid;
mod many;
mod open;
mod serial;

use std::sync::Arc;
use std::time::Duration;

use anyhow::ensure;
use device::clock::{Clock, MonotonicClock};
use device::discovery::Places;
use serde_json::Value;

use super::cable::Watch;
use super::host::Running;

/// Longest wait for anything: a software-emulated machine beside other work is slow.
const PATIENCE: Duration = Duration::from_secs(12);

/// One claim and what shows it.
pub struct Claim {
    /// In words.
    pub name: &'static str,
    /// Shows it or says why not.
    pub show: fn(&Watch) -> anyhow::Result<()>,
}

/// All of them, in the order they are shown.
pub const CLAIMS: &[&[Claim]] = &[hid::CLAIMS, many::CLAIMS, serial::CLAIMS];

/// Opens a device as the host does and says what came of it.
pub fn try_open(address: &str) -> String {
    let clock: Arc<dyn Clock> = Arc::new(MonotonicClock::new());
    let address = match address.parse() {
        Ok(address) => address,
        Err(error) => return format!("{error}"),
    };
    match device::discovery::open(&Places::default(), &address, None, &clock) {
        Ok(_) => "opened".to_owned(),
        Err(error) => error.to_string(),
    }
}

/// A monitor of `address`, listening.
fn monitor(address: &str, profile: &str) -> anyhow::Result<Running> {
    Running::start(&["monitor", address, "--profile", profile, "--json"])
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
