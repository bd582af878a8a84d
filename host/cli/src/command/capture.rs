//! `dialrig capture`: everything said on the line of one input device, as an exchange file.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use bench::SimPorts;
use bench::world::Equipment;
use rig::capture::{Capture, CaptureError};
use rig::{SystemPorts, WithBench};

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{number, setup};

const EXAMPLES: &str = "\
Examples:
  dialrig capture /dev/hidraw0 --out knob.txt
  dialrig capture /dev/ttyUSB0 --out box.txt
  dialrig capture sim:tablet --profile graphire-serial --out pen.txt --secs 10";

/// Longest silence before Ctrl-C is looked for again.
const PATIENCE: Duration = Duration::from_millis(100);

/// What a device and dialrig say to each other, into a file
///
/// Bytes or reports of both sides with their times, and the events they mean, until Ctrl-C or for a while. The file is
/// an exchange: `replay` plays it, and a test can.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A device path, tcp:HOST:PORT, usb:SERIAL or sim:NAME
    device: String,
    /// Where it is written
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Profile of the device; what it is recognised as when left out, `sgi-dialbox` on a line that does not say
    #[arg(long, value_name = "NAME")]
    profile: Option<String>,
    /// For how long; until Ctrl-C when left out
    #[arg(long, value_name = "N", value_parser = number::positive)]
    secs: Option<f64>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let profiles = setup::profiles()?;
    let clock = rig::real_time();
    let refused = |error: &dyn std::fmt::Display| Failure::refused(error.to_string());
    let stand = Equipment::default()
        .stand(Arc::clone(&clock), &profiles)
        .map_err(|error| refused(&error))?;
    let system = SystemPorts::knowing(Arc::clone(&clock), Arc::clone(&profiles), None);
    let mut ports = WithBench::beside(Box::new(SimPorts::new(stand)), system);
    let interrupt = Interrupt::listen();
    let mut capture = Capture::open(
        &mut ports,
        &args.device,
        args.profile.as_deref(),
        &profiles,
        clock,
        &args.out,
    )
    .map_err(|error| refused(&error))?;
    let (mut events, mut ended) = (0_u64, Ok(()));
    while ended.is_ok() && !interrupt.came() && args.secs.is_none_or(|secs| capture.secs() < secs) {
        ended = capture.next(PATIENCE, &mut |_| events += 1);
    }
    // What came before a device was lost is worth keeping.
    let lines = capture.finish().map_err(|error| refused(&error))?;
    console.remark(format_args!(
        "{}: {lines} lines, {events} events",
        args.out.display()
    ));
    match ended {
        Ok(()) => Ok(Exit::Done),
        Err(CaptureError::Listen(error)) => Err(Failure::device(error.to_string())),
        Err(error) => Err(refused(&error)),
    }
}
