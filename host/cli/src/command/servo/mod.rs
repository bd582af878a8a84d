//! `dialrig servo`: looking after servos. Nothing here can move one.

mod backup;
mod calibrate;
mod clear;
mod doctor;
mod factory_reset;
mod monitor;
mod ping;
mod read;
mod reboot;
mod release;
mod scan;
mod set_baud;
mod set_id;
mod teach;
mod typed;
mod write;

use clap::{Subcommand, ValueEnum};
use rig::SystemPorts;
use rig::maintenance::{FoundServo, RegisterValue, ServoLine, ServoLineError, ServoProtocol};
use serde::Serialize;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig servo scan --port /dev/ttyUSB0
  dialrig servo read --port /dev/ttyUSB0 --baud 1000000 3 'Present Position'
  dialrig servo write --port /dev/ttyUSB0 --baud 1000000 3 'Return Delay Time' 0
  dialrig servo set-id --port /dev/ttyUSB0 --protocol sts 1 7
  dialrig servo release --port /dev/ttyUSB0 --baud 1000000";

/// Servos: who is there, their registers, ids and speeds, letting go
///
/// Nothing here can move one: what writes switches torque off first.
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
    Write(write::Args),
    Monitor(monitor::Args),
    SetId(set_id::Args),
    SetBaud(set_baud::Args),
    Reboot(reboot::Args),
    FactoryReset(factory_reset::Args),
    Clear(clear::Args),
    Backup(backup::Args),
    Release(release::Args),
    Doctor(doctor::Args),
    Calibrate(calibrate::Args),
    Teach(teach::Args),
}

/// Where the line is.
#[derive(Debug, clap::Args)]
struct LineArgs {
    /// A device path, tcp:HOST:PORT or usb:SERIAL
    #[arg(long, value_name = "PORT")]
    port: String,
    /// Line speed [default: 57600, as Dynamixels of protocol 2.0 leave the factory; with another --protocol 1000000]
    #[arg(long, value_name = "N")]
    baud: Option<u32>,
    /// What the servos speak; without it everything is tried
    #[arg(long, value_enum)]
    protocol: Option<Protocol>,
}

/// What servos speak, as it is typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Protocol {
    /// DYNAMIXEL protocol 1.0: AX, MX
    Dxl1,
    /// DYNAMIXEL protocol 2.0: X, MX(2.0), XL-320
    Dxl2,
    /// Feetech with magnetic encoders: STS, SMS, HLS
    Sts,
    /// Feetech with potentiometers: SCS
    Scs,
}

impl From<Protocol> for ServoProtocol {
    fn from(protocol: Protocol) -> Self {
        match protocol {
            Protocol::Dxl1 => Self::Dynamixel1,
            Protocol::Dxl2 => Self::Dynamixel2,
            Protocol::Sts => Self::Sts,
            Protocol::Scs => Self::Scs,
        }
    }
}

/// The same word in records.
fn word(protocol: ServoProtocol) -> &'static str {
    match protocol {
        ServoProtocol::Dynamixel1 => "dxl1",
        ServoProtocol::Dynamixel2 => "dxl2",
        ServoProtocol::Sts => "sts",
        ServoProtocol::Scs => "scs",
    }
}

impl LineArgs {
    fn baud(&self) -> u32 {
        self.baud.unwrap_or(match self.protocol {
            None | Some(Protocol::Dxl2) => 57_600,
            Some(Protocol::Dxl1 | Protocol::Sts | Protocol::Scs) => 1_000_000,
        })
    }

    fn open(&self) -> Result<ServoLine, Failure> {
        let profiles = setup::profiles()?;
        let protocol = self.protocol.map(ServoProtocol::from);
        let clock = rig::real_time();
        ServoLine::open(
            &mut SystemPorts::default(),
            &self.port,
            self.baud(),
            protocol,
            clock,
            profiles,
        )
        .map_err(|error| Failure::refused(error.to_string()))
    }
}

/// An id that some servo can have; protocol 2.0 ends at 252.
fn id() -> clap::builder::RangedI64ValueParser<u8> {
    clap::value_parser!(u8).range(0..=253)
}

/// A line or servo that does not do what it should is a device's fault; nothing here has given it torque.
// Consumed, so that it can be handed to `map_err` by its name.
#[expect(clippy::needless_pass_by_value, reason = "what `map_err` hands over")]
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
    protocol: &'static str,
    baud: u32,
    model_number: u16,
    model: Option<&'a str>,
    firmware: u8,
    fresh: bool,
}

fn record(found: &FoundServo) -> FoundRecord<'_> {
    FoundRecord {
        id: found.id,
        protocol: word(found.protocol),
        baud: found.baud,
        model_number: found.model_number,
        model: found.model.as_deref(),
        firmware: found.firmware,
        fresh: found.fresh,
    }
}

/// Tells where a servo is now.
fn tell(found: &FoundServo, console: &Console) -> Result<Exit, Failure> {
    if console.json() {
        console.record(&record(found))?;
    } else {
        let model = model_of(found);
        console.line(format_args!(
            "servo {}: {model} ({}), firmware {}, {} baud",
            found.id, found.protocol, found.firmware, found.baud
        ))?;
    }
    Ok(Exit::Done)
}

fn model_of(found: &FoundServo) -> String {
    match &found.model {
        Some(model) => model.clone(),
        None => format!("model number {}", found.model_number),
    }
}

#[derive(Serialize)]
struct ValueRecord<'a> {
    id: u8,
    register: &'a str,
    address: u16,
    raw: i64,
    value: Option<f64>,
    unit: &'a str,
}

fn value_record(id: u8, value: &RegisterValue) -> ValueRecord<'_> {
    ValueRecord {
        id,
        register: &value.name,
        address: value.address,
        raw: value.raw,
        value: value.value,
        unit: &value.unit,
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    match &args.command {
        Command::Scan(args) => scan::run(args, console),
        Command::Ping(args) => ping::run(args, console),
        Command::Read(args) => read::run(args, console),
        Command::Write(args) => write::run(args, console),
        Command::Monitor(args) => monitor::run(args, console),
        Command::SetId(args) => set_id::run(args, console),
        Command::SetBaud(args) => set_baud::run(args, console),
        Command::Reboot(args) => reboot::run(args, console),
        Command::FactoryReset(args) => factory_reset::run(args, console),
        Command::Clear(args) => clear::run(args, console),
        Command::Backup(args) => backup::run(args, console),
        Command::Release(args) => release::run(args, console),
        Command::Doctor(args) => doctor::run(args, console),
        Command::Calibrate(args) => calibrate::run(args, console),
        Command::Teach(args) => teach::run(args, console),
    }
}
