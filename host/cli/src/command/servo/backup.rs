//! `dialrig servo backup`: a copy of the settings, kept in the servo.

use rig::maintenance::Backup;

use super::{LineArgs, failed};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Examples:
  dialrig servo backup --port /dev/ttyUSB0 --baud 1000000 3
  dialrig servo backup --port /dev/ttyUSB0 --baud 1000000 3 --restore";

/// Keeps a copy of a servo's settings in the servo, or brings it back
///
/// Switches torque off on the line. DYNAMIXEL 2.0 from firmware 45 (X330: 46) on; Feetech only keeps.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Its id
    #[arg(value_name = "ID", value_parser = super::id())]
    id: u8,
    /// Bring the copy back; the servo reboots
    #[arg(long)]
    restore: bool,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let way = if args.restore {
        Backup::Restore
    } else {
        Backup::Store
    };
    let mut line = args.line.open()?;
    line.backup(args.id, way).map_err(failed)?;
    let done = if args.restore {
        "has its settings back"
    } else {
        "keeps a copy of its settings"
    };
    console.remark(format_args!("servo {} {done}", args.id));
    Ok(Exit::Done)
}
