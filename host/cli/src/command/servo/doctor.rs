//! `dialrig servo doctor`: what is wrong with a bus, what it costs, what to do.

use std::path::PathBuf;

use rig::SystemPorts;
use rig::doctor::{Adapters, Doctor, DoctorError, Finding, UsbRequests, Ward, wards};
use serde::Serialize;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig servo doctor --port /dev/ttyUSB0 --baud 1000000
  dialrig servo doctor --port /dev/ttyUSB0 --port /dev/ttyUSB1 --puppet marionette
  dialrig servo doctor --port /dev/ttyUSB0 --puppet starter --fix

Ends with 1 when something is found. Looking changes nothing; mending switches torque off first.";

/// What a look at one line takes, in steps that the bar shows.
const STEPS: u64 = 4;

/// What is wrong with a bus, what it costs, what to do
///
/// Adapter, cables, ids, speeds, firmware, settings, travel, supply and heat (docs/doctor.md).
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A device path, tcp:HOST:PORT or usb:SERIAL; one for each bus of the puppet, in the profile's order
    #[arg(long = "port", value_name = "PORT", required = true)]
    ports: Vec<String>,
    /// The puppet whose servos are expected there
    #[arg(long, value_name = "NAME")]
    puppet: Option<String>,
    /// Line speed; without it the puppet's, or 57600
    #[arg(long, value_name = "N")]
    baud: Option<u32>,
    /// Mends what is safe to mend (adapter latency, return delay, lock), then looks again
    #[arg(long)]
    fix: bool,
    /// Gives the one factory-fresh servo on the line this joint's id and the bus's speed, then looks
    #[arg(long, value_name = "JOINT", requires = "puppet")]
    adopt: Option<String>,
    /// Where the kernel describes its devices
    #[arg(long, value_name = "DIR", hide = true, default_value = "/sys")]
    sysfs: PathBuf,
}

/// A finding as JSON.
#[derive(Serialize)]
struct Record<'a> {
    finding: &'static str,
    bus: &'a str,
    joint: Option<&'a str>,
    id: Option<u8>,
    what: &'a str,
    costs: &'a str,
    remedy: &'a str,
    fixable: bool,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let profiles = setup::profiles()?;
    let lines = wards(&profiles, args.puppet.as_deref(), &args.ports, args.baud)
        .map_err(|error| Failure::refused(error.to_string()))?;
    let adapters = Adapters::new(&args.sysfs, Box::new(UsbRequests));
    let mut doctor = Doctor::new(
        Box::<SystemPorts>::default(),
        rig::real_time(),
        profiles,
        adapters,
    );
    if let Some(name) = &args.puppet {
        doctor = doctor.of_puppet(name).map_err(failed)?;
    }
    if let Some(joint) = &args.adopt {
        let done = doctor.adopt(&lines, joint).map_err(failed)?;
        console.remark(done);
    }
    let mut findings = look(&mut doctor, &lines, console)?;
    if args.fix && findings.iter().any(|(_, finding)| finding.fix.is_some()) {
        mend(&mut doctor, &lines, &findings, console)?;
        findings = look(&mut doctor, &lines, console)?;
    }
    for (_, finding) in &findings {
        show(finding, console)?;
    }
    if findings.is_empty() {
        console.remark("nothing is wrong");
        return Ok(Exit::Done);
    }
    Ok(Exit::Refused)
}

/// Looks at every line; each finding with the place of its line.
fn look(doctor: &mut Doctor, lines: &[Ward], console: &Console) -> Result<Vec<(usize, Finding)>, Failure> {
    let mut all = Vec::new();
    for (place, ward) in lines.iter().enumerate() {
        let bar = console.progress(STEPS, "doctor");
        let found = doctor.examine(ward, &mut |_| bar.inc(1));
        bar.finish_and_clear();
        all.extend(found.map_err(failed)?.into_iter().map(|finding| (place, finding)));
    }
    Ok(all)
}

/// Shows what can be mended, then mends it.
fn mend(
    doctor: &mut Doctor,
    lines: &[Ward],
    findings: &[(usize, Finding)],
    console: &Console,
) -> Result<(), Failure> {
    for (place, finding) in findings {
        let Some(fix) = finding.fix else { continue };
        console.remark(format_args!(
            "{}: {}; setting {fix}",
            finding.place(),
            finding.what
        ));
        match doctor.mend(&lines[*place], fix) {
            Ok(done) => console.remark(format_args!("  set: {done}")),
            // The next thing to mend may well go: an adapter's refusal says nothing of servos.
            Err(DoctorError::Adapter(error)) => console.remark(format_args!("  not set: {error}")),
            Err(error) => return Err(failed(error)),
        }
    }
    Ok(())
}

fn show(finding: &Finding, console: &Console) -> Result<(), Failure> {
    if console.json() {
        return console.record(&Record {
            finding: finding.kind.name(),
            bus: &finding.bus,
            joint: finding.joint.as_deref(),
            id: finding.id,
            what: &finding.what,
            costs: &finding.costs,
            remedy: &finding.remedy,
            fixable: finding.fix.is_some(),
        });
    }
    console.line(format_args!(
        "{}: {}: {}",
        finding.kind.name(),
        finding.place(),
        finding.what
    ))?;
    console.line(format_args!("  costs: {}", finding.costs))?;
    console.line(format_args!("  do: {}", finding.remedy))
}

// Consumed, so that it can be handed to `map_err` by its name.
#[expect(clippy::needless_pass_by_value, reason = "what `map_err` hands over")]
fn failed(error: DoctorError) -> Failure {
    if error.is_of_device() {
        Failure::device(error.to_string())
    } else {
        Failure::refused(error.to_string())
    }
}
