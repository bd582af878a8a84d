//! `dialrig servo monitor`: what servos say about themselves, again and again.

use std::time::Duration;

use rig::maintenance::Role;
use serde_json::{Map, json};

use super::{LineArgs, failed};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::number;

const EXAMPLES: &str = "\
Example:
  dialrig servo monitor --port /dev/ttyUSB0 --baud 1000000 1 2 3";

/// What is read; a servo without one of them leaves it out.
const REGISTERS: [(&str, Role); 8] = [
    ("torque", Role::TorqueEnable),
    ("position", Role::PresentPosition),
    ("velocity", Role::PresentVelocity),
    ("current", Role::PresentCurrent),
    ("load", Role::PresentLoad),
    ("voltage", Role::PresentVoltage),
    ("temperature", Role::PresentTemperature),
    ("error", Role::HardwareError),
];

/// Torque, position, velocity, current, load, voltage, temperature and errors, again and again
///
/// Until Ctrl-C.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Their ids
    #[arg(required = true, value_name = "ID", value_parser = super::id())]
    ids: Vec<u8>,
    /// Seconds between readings
    #[arg(long, value_name = "SECS", default_value_t = 0.5, value_parser = number::secs)]
    every: f64,
    /// Ends after so many readings
    #[arg(long, value_name = "N")]
    count: Option<u64>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut line = args.line.open()?;
    let interrupt = Interrupt::listen();
    let mut readings = 0;
    while !interrupt.came() && args.count.is_none_or(|count| readings < count) {
        if readings > 0 {
            interrupt.wait(Duration::from_secs_f64(args.every));
        }
        for &id in &args.ids {
            let mut record = Map::new();
            record.insert("id".into(), json!(id));
            let mut words = Vec::new();
            let roles = REGISTERS.map(|(_, role)| role);
            for value in line.read_roles(id, &roles).map_err(failed)? {
                let Some((name, _)) = REGISTERS.iter().find(|(_, role)| value.role == Some(*role)) else {
                    continue;
                };
                let shown = value.value.unwrap_or(value.raw as f64);
                record.insert((*name).into(), json!(shown));
                words.push(
                    format!("{name} {} {}", number::short(shown), value.unit)
                        .trim_end()
                        .to_owned(),
                );
            }
            if console.json() {
                console.record(&record)?;
            } else {
                console.line(format_args!("servo {id}: {}", words.join(", ")))?;
            }
        }
        console.flush()?;
        readings += 1;
    }
    Ok(Exit::Done)
}
