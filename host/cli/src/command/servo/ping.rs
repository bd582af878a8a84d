//! `dialrig servo ping`: who a servo is.

use super::{LineArgs, failed, tell};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Example:
  dialrig servo ping --port /dev/ttyUSB0 --baud 1000000 1 2 3";

/// Who a servo is
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Their ids
    #[arg(required = true, value_name = "ID", value_parser = super::id())]
    ids: Vec<u8>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    for &id in &args.ids {
        let servo = line.ping(id).map_err(failed)?;
        tell(&servo, console)?;
    }
    Ok(Exit::Done)
}
