//! `dialrig servo write`: a register by name.

use super::{LineArgs, failed, value_record};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::number;

const EXAMPLES: &str = "\
Examples:
  dialrig servo write --port /dev/ttyUSB0 --baud 1000000 3 'Return Delay Time' 0
  dialrig servo write --port /dev/ttyUSB0 --baud 1000000 3 max-position 1.2 --si";

/// One register of a servo
///
/// Switches torque off on the line first, and reads back what was written. What can move a servo is refused: goals and
/// torque go through the player. An EEPROM register that holds the value already is not written; Feetech's lock is
/// opened and closed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Its id
    #[arg(value_name = "ID", value_parser = super::id())]
    id: u8,
    /// A register, by its maker's name or its role
    #[arg(value_name = "REGISTER")]
    register: String,
    /// The value, in counts
    #[arg(value_name = "VALUE", allow_negative_numbers = true)]
    value: f64,
    /// The value is in the register's unit (`servo read` shows it)
    #[arg(long)]
    si: bool,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    let written = if args.si {
        line.write_si(args.id, &args.register, args.value)
    } else {
        line.write(args.id, &args.register, counts(args.value)?)
    };
    let value = written.map_err(failed)?;
    if console.json() {
        console.record(&value_record(args.id, &value))?;
    } else {
        let si = value.value.map(number::short).unwrap_or_default();
        let text = format!(
            "servo {}: {} is {} ({si} {})",
            args.id, value.name, value.raw, value.unit
        );
        console.line(text.trim_end_matches(" ( )"))?;
    }
    Ok(Exit::Done)
}

/// A whole number of counts.
fn counts(value: f64) -> Result<i64, Failure> {
    if value.fract() == 0.0 && value.abs() <= f64::from(u32::MAX) {
        Ok(value as i64)
    } else {
        Err(Failure::refused(format!("{value} is no whole number of counts"))
            .with_hint("give --si for a value in the register's unit"))
    }
}
