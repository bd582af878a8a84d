//! `dialrig servo clear`: turns are forgotten.

use super::{LineArgs, failed};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Example:
  dialrig servo clear --port /dev/ttyUSB0 --baud 1000000 3";

/// Forgets the turns a servo has counted
///
/// Refused while it moves. Switches torque off on the line.
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
    line.clear(args.id).map_err(failed)?;
    console.remark(format_args!("servo {} counts from this turn", args.id));
    Ok(Exit::Done)
}
