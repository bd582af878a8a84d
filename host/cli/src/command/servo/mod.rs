//! `dialrig servo`: looking after servos. Nothing here can move one.

mod calibrate;
mod doctor;
mod monitor;
mod ping;
mod read;
mod release;
mod scan;

use clap::Subcommand;
use rig::SystemPorts;
use rig::maintenance::{FoundServo, ServoLine, ServoLineError};
use serde::Serialize;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig servo scan --port /dev/ttyUSB0
  dialrig servo read --port /dev/ttyUSB0 --baud 1000000 3 'Present Position'
  dialrig servo release --port /dev/ttyUSB0 --baud 1000000";

/// Servos: who is there, their registers, letting go
///
/// Nothing here can move one.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

/// What can be done with a servo line.
#[derive(Debug, Subcommand)]
enum Command {
    Scan(scan::Args),
    Ping(ping::Args),
    Read(read::Args),
    Monitor(monitor::Args),
    Release(release::Args),
    Doctor(doctor::Args),
    Calibrate(calibrate::Args),
}

/// Where the line is.
#[derive(Debug, clap::Args)]
struct LineArgs {
    /// A device path, tcp:HOST:PORT or usb:SERIAL
    #[arg(long, value_name = "PORT")]
    port: String,
    /// Line speed; servos come from the factory at 57600
    #[arg(long, value_name = "N", default_value_t = 57_600)]
    baud: u32,
}

impl LineArgs {
    fn open(&self) -> Result<ServoLine, Failure> {
        let profiles = setup::profiles()?;
        ServoLine::open(
            &mut SystemPorts,
            &self.port,
            self.baud,
            rig::real_time(),
            profiles,
        )
        .map_err(|error| Failure::refused(error.to_string()))
    }
}

/// A line or servo that does not do what it should is a device's fault; nothing here has given it torque.
// Consumed, so that it can be handed to `map_err` by its name.
#[expect(clippy::needless_pass_by_value)]
fn failed(error: ServoLineError) -> Failure {
    if error.is_of_device() {
        Failure::device(error.to_string())
    } else {
        Failure::refused(error.to_string())
    }
}

#[derive(Serialize)]
struct FoundRecord<'a> {
    id: u8,
    baud: u32,
    model_number: u16,
    model: Option<&'a str>,
    firmware: u8,
}

fn record(found: &FoundServo) -> FoundRecord<'_> {
    FoundRecord {
        id: found.id,
        baud: found.baud,
        model_number: found.model_number,
        model: found.model.as_deref(),
        firmware: found.firmware,
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    match &args.command {
        Command::Scan(args) => scan::run(args, console),
        Command::Ping(args) => ping::run(args, console),
        Command::Read(args) => read::run(args, console),
        Command::Monitor(args) => monitor::run(args, console),
        Command::Release(args) => release::run(args, console),
        Command::Doctor(args) => doctor::run(args, console),
        Command::Calibrate(args) => calibrate::run(args, console),
    }
}
