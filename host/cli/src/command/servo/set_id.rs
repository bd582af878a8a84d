//! `dialrig servo set-id`: another id for a servo.

use super::{LineArgs, failed, tell};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Example:
  dialrig servo set-id --port /dev/ttyUSB0 --baud 1000000 1 7";

/// Another id for a servo
///
/// Refused if it is in use. Switches torque off on the line; asks the servo under its new id.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Its id
    #[arg(value_name = "ID", value_parser = super::id())]
    id: u8,
    /// Its id to be
    #[arg(value_name = "NEW", value_parser = super::id())]
    new: u8,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    tell(&line.set_id(args.id, args.new).map_err(failed)?, console)
}
