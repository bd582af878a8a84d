//! `dialrig servo reboot`: a servo starts again.

use super::{LineArgs, failed, tell};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Example:
  dialrig servo reboot --port /dev/ttyUSB0 --baud 1000000 3";

/// A servo starts again, which ends a shutdown after a hardware error
///
/// Switches torque off on the line. DYNAMIXEL 1.0 has no such instruction.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Its id
    #[arg(value_name = "ID", value_parser = super::id())]
    id: u8,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    tell(&line.reboot(args.id).map_err(failed)?, console)
}
