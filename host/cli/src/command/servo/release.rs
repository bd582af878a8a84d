//! `dialrig servo release`: torque off.

use super::{LineArgs, failed};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Example:
  dialrig servo release --port /dev/ttyUSB0 --baud 1000000";

/// Torque off on every servo of the line
///
/// Asks those that answer whether it is.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    let baud = args.line.baud();
    // Everybody at once first; then those whose makers keep torque where a broadcast would harm others.
    line.release().map_err(failed)?;
    let found = line.scan(&[baud], &mut |_| {}).map_err(failed)?;
    line.release().map_err(failed)?;
    if found.is_empty() {
        let message = format!("no servo answered at {baud} baud, so nobody says whether torque is off");
        return Err(Failure::Device { message, safe: false });
    }
    for servo in &found {
        if !line.is_released(servo.id).map_err(failed)? {
            return Err(Failure::torque_unknown());
        }
    }
    console.remark(format_args!("torque is off on {} servos", found.len()));
    Ok(Exit::Done)
}
