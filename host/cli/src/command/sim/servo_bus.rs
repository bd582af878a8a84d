//! `dialrig sim servo-bus`: simulated servos on one line.

use std::path::PathBuf;

use bench::serve::{
    Absent, BadCrc, BusPlan, Fault, Gaps, Habits, InnerHeader, PlantKind, Precedence, ServoSpec, WireTime,
};
use clap::ValueEnum;

use super::{PlaceArgs, Trace, serve};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig sim servo-bus --servo XL430-W250:1-6,XL330-M288:10 --pty /tmp/bus --baud 1000000
  dialrig sim servo-bus --servo XL430-W250:1 --tcp 127.0.0.1:7000 --fault 'servo 1 stuck at 2s'
  dialrig sim servo-bus --servo STS3215:1-6,AX-12A:11-13 --baud 1000000 --pty /tmp/bus --eeprom ./memories

Orders may be typed while it runs, one a line: a fault, `mend` to end them all, `hand on 3 turns to 30 deg over 1s`,
`servos` for how the servos are.

Faults: `servo N stuck`, `servo N silent`, `servo N hot`, `servo N error BITS`, `servo N reboot`,
`cable cut after N`, `drop P%`, `late TIME`, `noise`, `brownout`, `echo` and more (docs/simulator.md);
each with `at TIME`, `for TIME` or `once`.";

/// Dynamixel and Feetech servos on one line, with wire time, limits and faults
///
/// Models and protocols can be mixed. `dialrig profile list` names the models.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Models and ids; may be given again
    #[arg(long = "servo", value_name = "MODEL:ID[-ID][,…]", required = true)]
    servos: Vec<String>,
    #[command(flatten)]
    place: PlaceArgs,
    /// Line speed the servos are set to; without it each has the one it comes with, 57600 or 1000000
    #[arg(long, value_name = "N")]
    baud: Option<u32>,
    /// Whether bytes take the time they take on a real wire
    #[arg(long, value_enum, default_value_t = Wire::Real)]
    wire: Wire,
    /// Something that goes wrong; may be given again
    #[arg(long = "fault", value_name = "TEXT")]
    faults: Vec<String>,
    /// Decides what random faults hit
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Whether shafts follow their trajectory, or are moved by motors with torque, inertia and friction
    #[arg(long, value_enum, default_value_t = Shafts::Ideal)]
    shafts: Shafts,
    /// What servos do behind one that does not answer its part of a group read: silence, or the time after which
    /// the next one answers
    #[arg(long, value_name = "silence|TIME", default_value = "silence", value_parser = absent)]
    absent: Absent,
    /// What a servo does with a packet whose checksum is wrong
    #[arg(long, value_enum, default_value_t = Spoilt::Silent)]
    bad_checksum: Spoilt,
    /// What a servo makes of an unstuffed header inside a packet of protocol 2.0
    #[arg(long, value_enum, default_value_t = Inner::Data)]
    inner_header: Inner,
    /// What a read of bytes that no register covers gives
    #[arg(long, value_enum, default_value_t = Uncovered::Zeros)]
    gaps: Uncovered,
    /// Which error is told when a write deserves several
    #[arg(long, value_enum, default_value_t = First::Address)]
    first_error: First,
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

/// What shafts are moved by.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shafts {
    /// Follow the trajectory smoothly, never faster.
    Ideal,
    /// Motors with torque, inertia and friction.
    Real,
}

/// A packet whose checksum is wrong.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Spoilt {
    /// Is dropped.
    Silent,
    /// Is answered with the error for it.
    Answer,
}

/// An unstuffed header inside a packet.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Inner {
    /// Is data like any other.
    Data,
    /// Begins a new packet.
    Restart,
}

/// Bytes that no register covers.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Uncovered {
    /// Read as zeros.
    Zeros,
    /// Cannot be read.
    Refused,
}

/// The error that is told.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum First {
    /// That of the register with the lowest address.
    Address,
    /// The one with the lowest number.
    Lowest,
    /// The one with the highest number.
    Highest,
}

impl Args {
    fn habits(&self) -> Habits {
        Habits {
            absent: self.absent,
            bad_crc: match self.bad_checksum {
                Spoilt::Silent => BadCrc::Silent,
                Spoilt::Answer => BadCrc::Answer,
            },
            inner_header: match self.inner_header {
                Inner::Data => InnerHeader::Data,
                Inner::Restart => InnerHeader::Restart,
            },
            gaps: match self.gaps {
                Uncovered::Zeros => Gaps::Zeros,
                Uncovered::Refused => Gaps::AccessError,
            },
            precedence: match self.first_error {
                First::Address => Precedence::FirstAddress,
                First::Lowest => Precedence::LowestNumber,
                First::Highest => Precedence::HighestNumber,
            },
        }
    }
}

/// `silence`, or a time such as `200us` or `3ms`.
fn absent(text: &str) -> Result<Absent, String> {
    if text == "silence" {
        return Ok(Absent::Silence);
    }
    let in_us = |unit: &str, us: u32| text.strip_suffix(unit)?.parse::<u32>().ok()?.checked_mul(us);
    in_us("us", 1)
        .or_else(|| in_us("ms", 1000))
        .map(Absent::GoOnAfter)
        .ok_or_else(|| "expected silence, or a time such as 200us or 3ms".to_owned())
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
        habits: args.habits(),
        shafts: match args.shafts {
            Shafts::Ideal => PlantKind::Ideal,
            Shafts::Real => PlantKind::Real,
        },
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
