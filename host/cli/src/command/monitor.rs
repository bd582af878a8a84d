//! `dialrig monitor`: decoded events of one input device, as they come.

use std::sync::Arc;
use std::time::Duration;

use bench::SimPorts;
use bench::world::Equipment;
use rig::listen::{Heard, InputEvent, Listener};
use rig::{SystemPorts, WithBench};

use crate::console::Console;
use crate::event_lines::EventLines;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig monitor /dev/hidraw0
  dialrig monitor /dev/ttyUSB0 --profile sgi-dialbox
  dialrig monitor /tmp/tablet --profile graphire-serial --json";

/// Longest silence before Ctrl-C is looked for again.
const PATIENCE: Duration = Duration::from_millis(100);

/// What an input device says
///
/// Dials, keys, pen and puck, in the device's own counts and numbers, until Ctrl-C.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A device path, tcp:HOST:PORT, usb:SERIAL or sim:NAME
    device: String,
    /// Profile of the device; what it is recognised as when left out, `sgi-dialbox` on a line that does not say
    #[arg(long, value_name = "NAME")]
    profile: Option<String>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let profiles = setup::profiles()?;
    let clock = rig::real_time();
    let stand = Equipment::default()
        .stand(Arc::clone(&clock), &profiles)
        .map_err(|error| Failure::refused(error.to_string()))?;
    let system = SystemPorts::knowing(Arc::clone(&clock), Arc::clone(&profiles), None);
    let mut ports = WithBench::beside(Box::new(SimPorts::new(stand)), system);
    let mut listener = Listener::open(
        &mut ports,
        &args.device,
        args.profile.as_deref(),
        &profiles,
        clock,
    )
    .map_err(|error| Failure::refused(error.to_string()))?;
    if args.profile.is_none() {
        let known = Some(listener.profile()).filter(|key| !key.is_empty());
        let taken = known.unwrap_or("a device of its own description");
        console.remark(format_args!("{} is heard as {taken}", args.device));
    }
    let interrupt = Interrupt::listen();
    let mut lines = EventLines::new(console, listener.teller());
    let mut ended = Ok(());
    while ended.is_ok() && !interrupt.came() {
        let mut heard = Vec::new();
        ended = listener.next(PATIENCE, &mut |one| heard.push(one));
        for Heard { at_secs, what } in heard {
            match what {
                InputEvent::Started => {
                    let name = listener.identity().map(|name| format!(": {name}"));
                    console.remark(format_args!("the device answers{}", name.unwrap_or_default()));
                }
                InputEvent::Restarted => console.remark("the device was switched off and on"),
                _ => lines.tell(at_secs, &what)?,
            }
        }
        console.flush()?;
    }
    let [reports, unknown, rejected] = listener.counted();
    console.remark(format_args!(
        "{reports} reports, {} events, {unknown} unknown bytes, {rejected} rejected",
        lines.tally().events
    ));
    match ended {
        Ok(()) => Ok(Exit::Done),
        Err(error) => Err(Failure::device(error.to_string())),
    }
}
