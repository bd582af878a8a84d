//! `dialrig servo read`: registers by name.

use rig::maintenance::RegisterValue;
use serde::Serialize;

use super::{LineArgs, failed};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::number;
use crate::table::{Side, Table};

const EXAMPLES: &str = "\
Examples:
  dialrig servo read --port /dev/ttyUSB0 --baud 1000000 3
  dialrig servo read --port /dev/ttyUSB0 --baud 1000000 3 'Present Position' --json";

/// One register of a servo, or all
///
/// Registers have the names that the manual gives them.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Its id
    #[arg(value_name = "ID", value_parser = clap::value_parser!(u8).range(0..=252))]
    id: u8,
    /// A register; all when left out
    #[arg(value_name = "REGISTER")]
    register: Option<String>,
}

#[derive(Serialize)]
struct Record<'a> {
    id: u8,
    register: &'a str,
    address: u16,
    raw: i64,
    value: Option<f64>,
    unit: &'a str,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    let values = line.read(args.id, args.register.as_deref()).map_err(failed)?;
    if console.json() {
        for RegisterValue {
            name,
            address,
            raw,
            value,
            unit,
        } in &values
        {
            let record = Record {
                id: args.id,
                register: name,
                address: *address,
                raw: *raw,
                value: *value,
                unit,
            };
            console.record(&record)?;
        }
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
