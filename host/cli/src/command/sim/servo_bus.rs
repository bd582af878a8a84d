//! `dialrig sim servo-bus`: simulated servos on one line.

use std::path::PathBuf;

use bench::serve::{BusPlan, Fault, ServoSpec, WireTime};
use clap::ValueEnum;

use super::{PlaceArgs, Trace, serve};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig sim servo-bus --servo XL430-W250:1-6,XL330-M288:10 --pty /tmp/bus --baud 1000000
  dialrig sim servo-bus --servo XL430-W250:1 --tcp 127.0.0.1:7000 --fault 'servo 1 stuck at 2s'

Faults: `servo N stuck`, `servo N silent`, `servo N hot`, `servo N error BITS`, `servo N reboot`,
`cable cut after N`, `drop P%`, `late TIME`, `noise`, `brownout`, `echo` and more (docs/cli.md);
each with `at TIME`, `for TIME` or `once`.";

/// Dynamixel servos on one line, with wire time, limits and faults
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Models and ids; may be given again
    #[arg(long = "servo", value_name = "MODEL:ID[-ID][,…]", required = true)]
    servos: Vec<String>,
    #[command(flatten)]
    place: PlaceArgs,
    /// Line speed the servos are set to; from the factory it is 57600
    #[arg(long, value_name = "N", default_value_t = 57_600)]
    baud: u32,
    /// Whether bytes take the time they take on a real wire
    #[arg(long, value_enum, default_value_t = Wire::Real)]
    wire: Wire,
    /// Something that goes wrong; may be given again
    #[arg(long = "fault", value_name = "TEXT")]
    faults: Vec<String>,
    /// Decides what random faults hit
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Keeps the servos' memories in this folder
    #[arg(long, value_name = "DIR")]
    eeprom: Option<PathBuf>,
    /// Writes down every byte
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
}

/// Whether bytes take time.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Wire {
    /// Ten bits a byte at the line speed, return delays, one speaker at a time.
    Real,
    /// Answers are there at once.
    None,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let refused = |error: &dyn std::fmt::Display| Failure::refused(error.to_string());
    let specs = ServoSpec::parse(&args.servos.join(",")).map_err(|error| refused(&error))?;
    let faults = args
        .faults
        .iter()
        .map(|text| {
            Fault::parse(text).map_err(|error| Failure::refused(format!("--fault '{text}': {error}")))
        })
        .collect::<Result<_, _>>()?;
    let wire = match args.wire {
        Wire::Real => WireTime::Real,
        Wire::None => WireTime::None,
    };
    let plan = BusPlan {
        baud: args.baud,
        wire,
        seed: args.seed,
        faults,
        eeprom: args.eeprom.clone(),
        ..BusPlan::new(specs)
    };
    let bus = plan
        .build(&*setup::profiles()?)
        .map_err(|error| refused(&error))?;
    let mut trace = args.trace.as_ref().map(Trace::create).transpose()?;
    serve(bus, &args.place, console, &mut |event| {
        if let Some(trace) = &mut trace {
            trace.note(event, console);
        }
    })
}
