//! `dialrig devices`: everything found, and what is known about it.

use std::time::Duration;

use bench::SimPorts;
use bench::world::Equipment;
use rig::{Found, Ports, SystemPorts};
use serde::Serialize;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::setup;
use crate::table::{Side, Table};

const EXAMPLES: &str = "\
Examples:
  dialrig devices
  dialrig devices --watch --json";

/// How often the list is made anew while watching.
const LOOK_AGAIN: Duration = Duration::from_secs(1);

/// What can be opened, what is known about it, what is missing
///
/// Lists serial ports, whether they may be opened, and the devices of the embedded bench.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Goes on, telling what comes and goes, until Ctrl-C
    #[arg(long)]
    watch: bool,
}

#[derive(Serialize)]
struct Record<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    change: Option<&'a str>,
    address: &'a str,
    description: &'a str,
    profiles: &'a [String],
    allowed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    remedy: Option<&'a str>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut found = list()?;
    if args.watch {
        for port in &found {
            tell(console, Some("there"), port)?;
        }
        return watch(console, &mut found);
    }
    if console.json() {
        found.iter().try_for_each(|port| tell(console, None, port))?;
        return Ok(Exit::Done);
    }
    let left = |heading| (heading, Side::Left);
    let mut table = Table::new(&[
        left("address"),
        left("what"),
        left("profiles"),
        left("may be opened"),
    ]);
    for port in &found {
        let allowed = port.allowed.as_ref().err().map_or("yes", String::as_str);
        table.row(vec![
            port.address.clone(),
            port.description.clone(),
            port.matches.join(", "),
            allowed.to_owned(),
        ]);
    }
    console.table(&table)?;
    if found.iter().all(|port| port.address.starts_with("sim:")) {
        console.remark(
            "no serial port on this machine; pseudo-terminals are not listed, name them by their path",
        );
    }
    Ok(Exit::Done)
}

/// The machine's ports and the embedded bench's.
fn list() -> Result<Vec<Found>, Failure> {
    let profiles = setup::profiles()?;
    let equipment = Equipment {
        puppet: Some("marionette".to_owned()),
        ..Equipment::default()
    };
    let stand = equipment
        .stand(rig::real_time(), &profiles)
        .map_err(|error| Failure::refused(error.to_string()))?;
    let mut found = SystemPorts.list();
    found.extend(SimPorts::new(stand).list());
    Ok(found)
}

fn watch(console: &Console, found: &mut Vec<Found>) -> Result<Exit, Failure> {
    let interrupt = Interrupt::listen();
    console.flush()?;
    while !interrupt.came() {
        interrupt.wait(LOOK_AGAIN);
        let now = list()?;
        for port in now.iter().filter(|port| !found.contains(port)) {
            tell(console, Some("came"), port)?;
        }
        for port in found.iter().filter(|port| !now.contains(port)) {
            tell(console, Some("gone"), port)?;
        }
        console.flush()?;
        *found = now;
    }
    Ok(Exit::Done)
}

fn tell(console: &Console, change: Option<&str>, port: &Found) -> Result<(), Failure> {
    let remedy = port.allowed.as_ref().err().map(String::as_str);
    if console.json() {
        return console.record(&Record {
            change,
            address: &port.address,
            description: &port.description,
            profiles: &port.matches,
            allowed: remedy.is_none(),
            remedy,
        });
    }
    let note = remedy.map(|remedy| format!("; {remedy}")).unwrap_or_default();
    console.line(format_args!(
        "{} {}  {}{note}",
        change.unwrap_or_default(),
        port.address,
        port.description
    ))
}
