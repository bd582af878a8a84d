//! `dialrig servo set-baud`: another line speed for a servo.

use super::{LineArgs, failed, tell};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Example:
  dialrig servo set-baud --port /dev/ttyUSB0 --baud 57600 1 1000000";

/// Another line speed for a servo
///
/// Switches torque off on the line; asks the servo at its new speed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Its id
    #[arg(value_name = "ID", value_parser = super::id())]
    id: u8,
    /// Its line speed to be
    #[arg(value_name = "BAUD")]
    new: u32,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    tell(&line.set_baud(args.id, args.new).map_err(failed)?, console)
}
