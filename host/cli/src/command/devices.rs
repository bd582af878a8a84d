//! `dialrig devices`: everything found, and what is known about it.

mod install;

use std::path::PathBuf;
use std::sync::Arc;
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
  dialrig devices --watch --json
  dialrig devices --ask                     asks at serial ports who is there, and remembers who answered
  sudo dialrig devices --install-rules      lets whoever sits at the machine open every device that is known";

/// How often the list is made anew while watching.
const LOOK_AGAIN: Duration = Duration::from_secs(1);

/// What can be opened, what is known about it, what is missing
///
/// Lists input devices on USB and Bluetooth, serial ports and the devices of the embedded bench: which profile fits or
/// why none does, who has a device already, and what grants the right to open it.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Goes on, telling what comes and goes, until Ctrl-C
    #[arg(long)]
    watch: bool,
    /// Asks at every serial port that says nothing of itself and that nobody has open. The question is a tablet's; other
    /// devices may take it for something else
    #[arg(long, conflicts_with = "install_rules")]
    ask: bool,
    /// Writes the udev rules for all devices that are known, and the module options without which the kernel shows some
    /// of them to nobody; only root may
    #[arg(long, conflicts_with = "watch")]
    install_rules: bool,
    /// Writes the rules here instead, and the module options only where they are asked for
    #[arg(long, value_name = "FILE", requires = "install_rules")]
    rules_file: Option<PathBuf>,
    /// Writes the module options here instead, and the rules only where they are asked for
    #[arg(long, value_name = "FILE", requires = "install_rules")]
    modprobe_file: Option<PathBuf>,
}

#[derive(Serialize)]
struct Record<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    change: Option<&'a str>,
    address: &'a str,
    description: &'a str,
    profiles: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slot: Option<u16>,
    allowed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    remedy: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_by: Option<&'a str>,
}

/// So many profiles are named in one cell.
const NAMED_MAX: usize = 3;

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    if args.install_rules {
        return install::run(args.rules_file.as_deref(), args.modprobe_file.as_deref(), console);
    }
    if args.ask {
        ask(console)?;
    }
    let mut ports = Everything::new()?;
    let mut found = ports.list();
    if args.watch {
        for port in &found {
            tell(console, Some("there"), port)?;
        }
        return watch(console, &mut ports, &mut found);
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
            fitting(port),
            allowed.to_owned(),
        ]);
    }
    console.table(&table)?;
    for port in &found {
        for note in notes(port) {
            console.remark(format_args!("{}: {note}", port.address));
        }
    }
    if found.iter().all(|port| port.address.starts_with("sim:")) {
        console.remark(
            "no input device and no serial port on this machine; pseudo-terminals are not listed, name them by their path",
        );
    }
    Ok(Exit::Done)
}

/// Asks, and tells who could not be asked; who answered is in the list.
fn ask(console: &Console) -> Result<(), Failure> {
    let profiles = setup::profiles()?;
    let folder = rig::shipped::user_folder();
    for asked in rig::lines::ask(&profiles, rig::real_time().as_ref(), folder.as_deref()) {
        match asked.who {
            Ok(Some(profile)) => console.remark(format_args!("{}: {profile} answered", asked.address)),
            Ok(None) => console.remark(format_args!("{}: nobody answered", asked.address)),
            Err(why) => console.remark(format_args!("{}: not asked: {why}", asked.address)),
        }
    }
    Ok(())
}

/// The profiles that fit. A line that does not say what hangs on it fits all of its kind, which would fill the screen:
/// they are counted, and `--json` names them.
fn fitting(port: &Found) -> String {
    match port.matches.as_slice() {
        few if few.len() <= NAMED_MAX => few.join(", "),
        many => format!("any of {}", many.len()),
    }
}

/// Why nothing is taken, and who is in the way.
fn notes(port: &Found) -> impl Iterator<Item = &str> {
    let held = port.held.as_ref().map(|held| held.remedy.as_str());
    // Whoever keeps it from being opened at all was named there.
    let held = held.filter(|remedy| port.allowed.as_ref().err().map(String::as_str) != Some(remedy));
    port.why.as_deref().into_iter().chain(held)
}

/// The machine's ports and the embedded bench's.
struct Everything {
    system: SystemPorts,
    bench: SimPorts,
}

impl Everything {
    fn new() -> Result<Self, Failure> {
        let profiles = setup::profiles()?;
        let equipment = Equipment {
            puppet: Some("marionette".to_owned()),
            ..Equipment::default()
        };
        let clock = rig::real_time();
        let stand = equipment
            .stand(Arc::clone(&clock), &profiles)
            .map_err(|error| Failure::refused(error.to_string()))?;
        // Looking must not change which device is which, so nothing is remembered here.
        Ok(Self {
            system: SystemPorts::knowing(clock, profiles, None)
                .with_lines(rig::shipped::user_folder().as_deref()),
            bench: SimPorts::new(stand),
        })
    }

    fn list(&mut self) -> Vec<Found> {
        let mut found = self.system.list();
        found.extend(self.bench.list());
        found
    }
}

fn watch(console: &Console, ports: &mut Everything, found: &mut Vec<Found>) -> Result<Exit, Failure> {
    let interrupt = Interrupt::listen();
    console.flush()?;
    while !interrupt.came() {
        interrupt.wait(LOOK_AGAIN);
        let now = ports.list();
        for port in now.iter().filter(|port| !found.contains(port)) {
            let known = found.iter().any(|old| old.address == port.address);
            tell(console, Some(if known { "changed" } else { "came" }), port)?;
        }
        for port in found
            .iter()
            .filter(|port| now.iter().all(|new| new.address != port.address))
        {
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
            why: port.why.as_deref(),
            slot: port.plug.as_ref().map(|plug| plug.slot),
            allowed: remedy.is_none(),
            remedy,
            held_by: port.held.as_ref().map(|held| held.driver.as_str()),
        });
    }
    let mut line = format!(
        "{} {}  {}",
        change.unwrap_or_default(),
        port.address,
        port.description
    );
    if !port.matches.is_empty() {
        line = format!("{line}: {}", fitting(port));
    }
    for note in remedy.into_iter().chain(notes(port)) {
        line = format!("{line}; {note}");
    }
    console.line(line)
}
