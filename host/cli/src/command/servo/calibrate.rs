//! `dialrig servo calibrate`: a hand moves every joint through its travel; zeros, signs, ranges and homing follow.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::Duration;

use rig::SystemPorts;
use rig::calibration::{Backup, CalibrationError, Calibrator, Proposal, Reading, Zero};
use rig::ward::wards;
use serde::Serialize;

use super::typed::Typed;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::table::{Side, Table};
use crate::{number, setup};

const EXAMPLES: &str = "\
Examples:
  dialrig servo calibrate --port /dev/ttyUSB0 --puppet starter
  dialrig servo calibrate --port /dev/ttyUSB0 --puppet so101 --joint elbow_flex
  dialrig servo calibrate --port /dev/ttyUSB0 --puppet starter --yes --secs 20
  dialrig servo calibrate --port /dev/ttyUSB0 --restore ~/.config/dialrig/profiles/replaced/starter-1.json

Torque is off throughout: hold the puppet. Put every joint at its zero, then move each the positive way to its end,
and to its other end. What is replaced is kept in a file that --restore takes back (docs/calibration.md).";

/// How often joints are read while they are moved.
const EVERY: Duration = Duration::from_millis(30);
/// Readings between two pictures of the sweep.
const SHOWN_EVERY: u32 = 5;

/// Zeros, signs, ranges and homing from a sweep by hand
///
/// Refuses a travel in which a servo's count jumps, and says how to get the jump out of it.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a switch of the command line"
)]
pub(crate) struct Args {
    /// A device path, tcp:HOST:PORT or usb:SERIAL; one for each bus of the puppet, in the profile's order
    #[arg(long = "port", value_name = "PORT", required = true)]
    ports: Vec<String>,
    /// The puppet
    #[arg(long, value_name = "NAME", required_unless_present = "restore")]
    puppet: Option<String>,
    /// This joint alone
    #[arg(long, value_name = "J")]
    joint: Option<String>,
    /// Line speed; without it the puppet's
    #[arg(long, value_name = "N")]
    baud: Option<u32>,
    /// Zero in the middle: the middle of the travel is that of the profile's range; signs stay
    #[arg(long)]
    middle: bool,
    /// Signs stay as the profile has them, whichever way joints are moved first
    #[arg(long)]
    keep_signs: bool,
    /// Asks nothing: the zero is where joints stand at first, the sweep ends after --secs
    #[arg(long, requires = "secs")]
    yes: bool,
    /// How long the sweep takes with --yes
    #[arg(long, value_name = "SECS", value_parser = number::secs)]
    secs: Option<f64>,
    /// Only shows what would be set
    #[arg(long)]
    dry_run: bool,
    /// Puts back what an earlier calibration replaced
    #[arg(long, value_name = "FILE", conflicts_with_all = ["joint", "yes", "secs", "dry_run", "middle"])]
    restore: Option<PathBuf>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let backup = args
        .restore
        .as_deref()
        .map(Backup::read)
        .transpose()
        .map_err(failed)?;
    let named = args
        .puppet
        .clone()
        .or_else(|| backup.as_ref().map(|backup| backup.puppet.clone()));
    let puppet = named.ok_or_else(|| Failure::refused("name the puppet with --puppet"))?;
    let profiles = setup::profiles()?;
    let lines = wards(&profiles, Some(&puppet), &args.ports, args.baud)
        .map_err(|error| Failure::refused(error.to_string()))?;
    let folder = rig::shipped::user_profiles_folder()
        .ok_or_else(|| Failure::refused("there is no folder for profiles: set HOME or XDG_CONFIG_HOME"))?;
    let only = args.joint.as_deref();
    console.remark("torque goes off: hold the puppet");
    let mut calibrator = Calibrator::begin(
        &mut SystemPorts::default(),
        rig::real_time(),
        &profiles,
        &puppet,
        &lines,
        only,
    )
    .map_err(failed)?;
    if let Some(backup) = &backup {
        for done in calibrator.restore(backup).map_err(failed)? {
            console.remark(format_args!("set {done}"));
        }
        console.remark(format_args!("{} is as it was", backup.profile.display()));
        return Ok(Exit::Done);
    }
    let person = Person {
        interrupt: Interrupt::listen(),
        typed: Typed::listen(),
    };
    if !sweep(args, &mut calibrator, console, &person)? {
        return Ok(Exit::Done);
    }
    let reading = Reading {
        zero: if args.middle { Zero::Middle } else { Zero::Marked },
        keep_signs: args.keep_signs,
    };
    let proposals = calibrator.propose(reading);
    show(&proposals, console)?;
    let refused = proposals.iter().any(|proposal| proposal.plan.is_err());
    if refused || args.dry_run {
        return Ok(if refused { Exit::Refused } else { Exit::Done });
    }
    if !args.yes && !confirmed(console, &person)? {
        console.remark("nothing was written");
        return Ok(Exit::Done);
    }
    let written = calibrator.write(&proposals, &folder).map_err(failed)?;
    for setting in &written.settings {
        console.remark(format_args!("set {setting}"));
    }
    console.remark(format_args!("wrote {}", written.profile.display()));
    console.remark(format_args!(
        "what was there before: {}",
        written.backup.display()
    ));
    Ok(Exit::Done)
}

/// Reads joints until the sweep is over. False: it was broken off.
fn sweep(
    args: &Args,
    calibrator: &mut Calibrator,
    console: &Console,
    person: &Person,
) -> Result<bool, Failure> {
    if let (true, Some(secs)) = (args.yes, args.secs) {
        calibrator.sample().map_err(failed)?;
        calibrator.mark_zero();
        let clock = rig::real_time();
        let began = clock.now();
        let over = || clock.now().since(began).as_secs_f64() >= secs;
        return watch(calibrator, console, person, &over);
    }
    let pressed = || person.typed.next().is_some();
    if !args.middle {
        console.remark("put every joint at its zero, then press Enter");
        if !watch(calibrator, console, person, &pressed)? {
            return Ok(false);
        }
    }
    calibrator.sample().map_err(failed)?;
    calibrator.mark_zero();
    console.remark(
        "move each joint the positive way to its end, then to its other end; press Enter when all are done",
    );
    watch(calibrator, console, person, &pressed)
}

/// Samples and shows until `over`. False: interrupted.
fn watch(
    calibrator: &mut Calibrator,
    console: &Console,
    person: &Person,
    over: &dyn Fn() -> bool,
) -> Result<bool, Failure> {
    let live = std::io::stderr().is_terminal() && !console.json();
    let mut shown = 0;
    let mut round = 0;
    while !over() {
        if person.interrupt.came() {
            return Ok(false);
        }
        calibrator.sample().map_err(failed)?;
        if live && round % SHOWN_EVERY == 0 {
            shown = picture(calibrator, console, shown);
        }
        round += 1;
        person.interrupt.wait(EVERY);
    }
    Ok(true)
}

/// The sweep so far, over the picture before; gives how many lines it has.
fn picture(calibrator: &Calibrator, console: &Console, lines_before: usize) -> usize {
    let mut table = Table::new(&[
        ("joint", Side::Left),
        ("counts", Side::Right),
        ("moved", Side::Right),
        ("", Side::Left),
    ]);
    for seen in calibrator.sweeps() {
        let now = seen
            .now_counts
            .map_or_else(|| "-".to_owned(), |counts| format!("{counts:.0}"));
        let note = match (seen.jumps, seen.lost) {
            (0, 0) => String::new(),
            (0, lost) => format!("{lost} readings lost"),
            (jumps, _) => format!("the count jumped {jumps} times"),
        };
        table.row(vec![
            seen.joint,
            now,
            format!("{:.0}°", seen.span_rad.to_degrees()),
            note,
        ]);
    }
    let lines: Vec<String> = table.lines().collect();
    if lines_before > 0 {
        // Up to where the last picture began.
        console.remark(format_args!("\x1b[{}A\r", lines_before + 1));
    }
    for line in &lines {
        console.remark(format_args!("\x1b[2K{line}"));
    }
    lines.len()
}

fn show(proposals: &[Proposal], console: &Console) -> Result<(), Failure> {
    if console.json() {
        return proposals
            .iter()
            .try_for_each(|proposal| console.record(&record(proposal)));
    }
    for proposal in proposals {
        let joint = &proposal.joint;
        match &proposal.plan {
            Err(refusal) => console.line(format_args!("{joint}: not possible: {refusal}"))?,
            Ok(plan) => {
                let (zero, sign, range) = proposal.before;
                console.line(format_args!(
                    "{joint}: zero {zero} -> {}, sign {sign} -> {}, range {} -> {}",
                    plan.zero_counts,
                    plan.sign,
                    degrees(range),
                    degrees(plan.range_rad)
                ))?;
                if let Some(offset) = plan.homing_offset {
                    console.line(format_args!("  homing offset of the servo: {offset}"))?;
                }
                if let Some([low, high]) = plan.limits {
                    console.line(format_args!("  limits of the servo: {low} to {high}"))?;
                }
            }
        }
    }
    Ok(())
}

fn degrees([from, to]: [f64; 2]) -> String {
    format!("{:.0}°..{:.0}°", from.to_degrees(), to.to_degrees())
}

/// A proposal as JSON.
#[derive(Serialize)]
struct Record<'a> {
    joint: &'a str,
    refused: Option<String>,
    zero_counts: Option<i32>,
    sign: Option<i8>,
    range_rad: Option<[f64; 2]>,
    travel_rad: Option<[f64; 2]>,
    homing_offset: Option<i64>,
    limits: Option<[i64; 2]>,
}

fn record(proposal: &Proposal) -> Record<'_> {
    let plan = proposal.plan.as_ref().ok();
    Record {
        joint: &proposal.joint,
        refused: proposal.plan.as_ref().err().map(ToString::to_string),
        zero_counts: plan.map(|plan| plan.zero_counts),
        sign: plan.map(|plan| plan.sign),
        range_rad: plan.map(|plan| plan.range_rad),
        travel_rad: plan.map(|plan| plan.travel_rad),
        homing_offset: plan.and_then(|plan| plan.homing_offset),
        limits: plan.and_then(|plan| plan.limits),
    }
}

/// Whoever sits at the terminal.
struct Person {
    interrupt: Interrupt,
    typed: Typed,
}

fn confirmed(console: &Console, person: &Person) -> Result<bool, Failure> {
    console
        .remark("write this to the servos and the profile? Enter writes, Ctrl-C leaves everything as it is");
    console.flush()?;
    while !person.interrupt.came() {
        if person.typed.next().is_some() {
            return Ok(true);
        }
        person.interrupt.wait(EVERY);
    }
    Ok(false)
}

// Consumed, so that it can be handed to `map_err` by its name.
#[expect(clippy::needless_pass_by_value, reason = "what `map_err` hands over")]
fn failed(error: CalibrationError) -> Failure {
    if error.is_of_device() {
        Failure::device(error.to_string())
    } else {
        Failure::refused(error.to_string())
    }
}
