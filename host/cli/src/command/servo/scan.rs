//! `dialrig servo scan`: everybody on a line.

use rig::maintenance::HeardServos;

use super::{LineArgs, failed, model_of, record};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::table::{Side, Table};

const EXAMPLES: &str = "\
Examples:
  dialrig servo scan --port /dev/ttyUSB0                     every line speed, about two seconds each
  dialrig servo scan --port /dev/ttyUSB0 --protocol sts      every speed that Feetech's STS have
  dialrig servo scan --port /dev/ttyUSB0 --baud 1000000 --only     that speed alone";

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
        vec![args.line.baud()]
    } else {
        line.known_bauds()
    };
    let bar = console.progress(bauds.len() as u64, "scan");
    let mut garbled = Vec::new();
    let found = line.scan(&bauds, &mut |heard: &HeardServos| {
        bar.inc(1);
        if heard.garbled {
            garbled.push(heard.baud);
        }
    });
    bar.finish_and_clear();
    let found = found.map_err(failed)?;
    let mut twice = Vec::new();
    for baud in garbled {
        let ids = line.twice_used_ids(baud, &found).map_err(failed)?;
        console.remark(explain(baud, &ids));
        twice.extend(ids);
    }
    if console.json() {
        found
            .iter()
            .try_for_each(|servo| console.record(&record(servo)))?;
    } else if !found.is_empty() {
        let mut table = Table::new(&[
            ("id", Side::Right),
            ("baud", Side::Right),
            ("protocol", Side::Left),
            ("model", Side::Left),
            ("firmware", Side::Right),
            ("", Side::Left),
        ]);
        for servo in &found {
            let fresh = if servo.fresh { "as from the factory" } else { "" };
            table.row(vec![
                servo.id.to_string(),
                servo.baud.to_string(),
                servo.protocol.to_string(),
                model_of(servo),
                servo.firmware.to_string(),
                fresh.to_owned(),
            ]);
        }
        console.table(&table)?;
    }
    if !twice.is_empty() {
        return Ok(Exit::Refused);
    }
    if found.is_empty() {
        return Err(Failure::refused("no servo answered").with_hint("check power, cable and adapter"));
    }
    Ok(Exit::Done)
}

/// What garbage at a line speed means.
fn explain(baud: u32, ids: &[u8]) -> String {
    if ids.is_empty() {
        return format!(
            "at {baud} baud: bytes that make no packet; the line is noisy, or a servo has another speed"
        );
    }
    let ids: Vec<String> = ids.iter().map(u8::to_string).collect();
    format!(
        "at {baud} baud: two servos answer at once to id {}; unplug one of them and give the other a free id with \
         `dialrig servo set-id`",
        ids.join(" and to id ")
    )
}
