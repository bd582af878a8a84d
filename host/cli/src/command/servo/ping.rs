//! `dialrig servo ping`: who a servo is.

use super::{LineArgs, failed, record};
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
    #[arg(required = true, value_name = "ID", value_parser = clap::value_parser!(u8).range(0..=252))]
    ids: Vec<u8>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    for &id in &args.ids {
        let servo = line.ping(id).map_err(failed)?;
        if console.json() {
            console.record(&record(&servo))?;
        } else {
            let model = servo
                .model
                .clone()
                .unwrap_or_else(|| format!("model number {}", servo.model_number));
            console.line(format_args!("servo {id}: {model}, firmware {}", servo.firmware))?;
        }
    }
    Ok(Exit::Done)
}
