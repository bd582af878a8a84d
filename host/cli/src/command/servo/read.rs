//! `dialrig servo read`: registers by name.

use super::{LineArgs, failed, value_record};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::number;
use crate::table::{Side, Table};

const EXAMPLES: &str = "\
Examples:
  dialrig servo read --port /dev/ttyUSB0 --baud 1000000 3
  dialrig servo read --port /dev/ttyUSB0 --baud 1000000 3 present-position --json";

/// One register of a servo, or all
///
/// Registers have the names that the maker gives them; roles, such as present-position, are the same for every make.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Its id
    #[arg(value_name = "ID", value_parser = super::id())]
    id: u8,
    /// A register; all when left out
    #[arg(value_name = "REGISTER")]
    register: Option<String>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    let values = line.read(args.id, args.register.as_deref()).map_err(failed)?;
    if console.json() {
        values
            .iter()
            .try_for_each(|value| console.record(&value_record(args.id, value)))?;
        return Ok(Exit::Done);
    }
    let columns = [
        ("address", Side::Right),
        ("register", Side::Left),
        ("raw", Side::Right),
        ("value", Side::Right),
        ("", Side::Left),
    ];
    let mut table = Table::new(&columns);
    for value in &values {
        let si = value.value.map(number::short).unwrap_or_default();
        table.row(vec![
            value.address.to_string(),
            value.name.clone(),
            value.raw.to_string(),
            si,
            value.unit.clone(),
        ]);
    }
    console.table(&table)?;
    Ok(Exit::Done)
}
