//! `dialrig servo scan`: everybody on a line.

use rig::maintenance::HeardServos;

use super::{LineArgs, failed, record};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::table::{Side, Table};

const EXAMPLES: &str = "\
Examples:
  dialrig servo scan --port /dev/ttyUSB0            every line speed, about a second each
  dialrig servo scan --port /dev/ttyUSB0 --only     the given speed alone";

/// Everybody on the line, at one or all line speeds
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Only at --baud, not at every speed known
    #[arg(long)]
    only: bool,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    let bauds = if args.only {
        vec![args.line.baud]
    } else {
        line.known_bauds()
    };
    let bar = console.progress(bauds.len() as u64, "scan");
    let found = line.scan(&bauds, &mut |heard: &HeardServos| {
        bar.inc(1);
        if heard.garbled {
            console.remark(format_args!(
                "at {} baud: answers that make no packet; two servos may have the same id, or the line is noisy",
                heard.baud
            ));
        }
    });
    bar.finish_and_clear();
    let found = found.map_err(failed)?;
    if console.json() {
        found
            .iter()
            .try_for_each(|servo| console.record(&record(servo)))?;
    } else if !found.is_empty() {
        let mut table = Table::new(&[
            ("id", Side::Right),
            ("baud", Side::Right),
            ("model", Side::Left),
            ("firmware", Side::Right),
        ]);
        for servo in &found {
            let model = servo
                .model
                .clone()
                .unwrap_or_else(|| format!("number {}", servo.model_number));
            table.row(vec![
                servo.id.to_string(),
                servo.baud.to_string(),
                model,
                servo.firmware.to_string(),
            ]);
        }
        console.table(&table)?;
    }
    if found.is_empty() {
        return Err(Failure::refused("no servo answered").with_hint("check power, cable and adapter"));
    }
    Ok(Exit::Done)
}
