//! `dialrig record`: a performance on real or simulated controls becomes a take and a clip of its keys.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

use bench::world::Equipment;
use rig::{Command, DeviceHealth, InputSpec, Live, NoteLevel, Snapshot, TakeCommand};

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::number;
use crate::setup::{self, LiveSetup};

const EXAMPLES: &str = "\
Examples:
  dialrig record shows/salute --device /dev/ttyUSB0 --take wave
  dialrig record shows/salute --device /dev/ttyUSB0=sgi-dialbox --device /dev/ttyUSB1=graphire-serial --take wave --secs 30";

/// Control cycles.
const PERIOD: Duration = Duration::from_millis(10);
/// Devices that have not answered by then are told of.
const ANSWER_SECS: f64 = 10.0;
/// Snapshots that may wait to be looked at; ten seconds of them.
const WAITING: usize = 1024;
/// What was asked for has been begun by then.
const SETTLE_SECS: f64 = 1.0;
/// And saved by then.
const SAVE_SECS: f64 = 600.0;
/// A rig that steps no more is given up after this.
const PATIENCE: Duration = Duration::from_secs(5);

/// A performance, kept as what the devices said, with the keys that come of it
///
/// Begins when every device has answered, ends with Ctrl-C or after a while, and saves the show with the take, which
/// can be done again through another network, and with a clip of its keys.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A show folder or its show.toml
    show: PathBuf,
    /// A device to be recorded and its profile; `sgi-dialbox` unless said
    #[arg(long = "device", value_name = "DEVICE[=PROFILE]", required = true)]
    devices: Vec<String>,
    /// What take and clip are called
    #[arg(long, value_name = "NAME")]
    take: String,
    /// For how long; until Ctrl-C when left out
    #[arg(long, value_name = "N", value_parser = number::positive)]
    secs: Option<f64>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let (show, folder) = setup::show(Some(&args.show), console)?;
    let mut inputs: Vec<InputSpec> = (1..)
        .zip(&args.devices)
        .map(|(n, device)| spec(n, device))
        .collect();
    let setup = LiveSetup {
        show,
        folder,
        profiles: setup::profiles()?,
        equipment: equipment(&mut inputs),
        inputs,
        ports: Vec::new(),
        period: PERIOD,
        heartbeat: None,
    };
    let interrupt = Interrupt::listen();
    let (seen, snapshots) = sync_channel(WAITING);
    let live = setup.start(move |snapshot| {
        let _ = seen.try_send(Arc::clone(snapshot));
    })?;
    let mut watch = Watch {
        console,
        snapshots,
        told: 0,
    };
    let recorded = perform(args, &live, &mut watch, &interrupt);
    live.close();
    recorded.map(|()| Exit::Done)
}

/// Waits for the devices, records, and waits for the keys and for them to be saved.
fn perform(args: &Args, live: &Live, watch: &mut Watch<'_>, interrupt: &Interrupt) -> Result<(), Failure> {
    let begins = watch.until_ready(interrupt)?;
    live.send(Command::Take(TakeCommand::Start {
        name: args.take.clone(),
        devices: Vec::new(),
        tolerance: None,
    }));
    watch.console.remark("recording; Ctrl-C ends it");
    let mut seen = begins.clone();
    while !interrupt.came() && args.secs.is_none_or(|secs| seen.at_secs - begins.at_secs < secs) {
        seen = watch.next()?;
    }
    live.send(Command::Take(TakeCommand::Stop));
    watch.console.remark("working out the keys");
    let asked_secs = seen.at_secs;
    while seen.take.is_some() || seen.at_secs < asked_secs + SETTLE_SECS {
        seen = watch.next()?;
    }
    if !seen.takes.contains(&args.take) {
        return Err(Failure::refused(format!("take {} did not come about", args.take)));
    }
    live.send(Command::Save);
    while seen.unsaved {
        seen = watch.next()?;
        if seen.at_secs > asked_secs + SAVE_SECS {
            return Err(Failure::refused("the show could not be saved"));
        }
    }
    Ok(())
}

/// The rig's steps as they come, and its remarks told.
struct Watch<'c> {
    console: &'c Console,
    snapshots: Receiver<Arc<Snapshot>>,
    told: usize,
}

impl Watch<'_> {
    fn next(&mut self) -> Result<Arc<Snapshot>, Failure> {
        let seen = self
            .snapshots
            .recv_timeout(PATIENCE)
            .map_err(|_| Failure::refused("the rig has stopped"))?;
        for note in seen.notes.iter().skip(self.told) {
            if note.level == NoteLevel::Info {
                self.console.remark(&note.text);
            } else {
                self.console.remark(format_args!("warning: {}", note.text));
            }
        }
        self.told = seen.notes.len();
        Ok(seen)
    }

    fn until_ready(&mut self, interrupt: &Interrupt) -> Result<Arc<Snapshot>, Failure> {
        loop {
            let seen = self.next()?;
            let mute = seen
                .devices
                .iter()
                .filter(|device| device.health != DeviceHealth::Present);
            let mute: Vec<&str> = mute.map(|device| device.address.as_str()).collect();
            if mute.is_empty() {
                return Ok(seen);
            }
            if interrupt.came() {
                return Err(Failure::interrupted());
            }
            if seen.at_secs > ANSWER_SECS {
                let message = format!("no answer from {} for {ANSWER_SECS} s", mute.join(", "));
                return Err(Failure::device(message));
            }
        }
    }
}

fn spec(number: usize, device: &str) -> InputSpec {
    let (address, profile) = device.rsplit_once('=').unwrap_or((device, "sgi-dialbox"));
    InputSpec {
        name: format!("device-{number}"),
        profile: profile.to_owned(),
        address: address.to_owned(),
    }
}

/// Takes the bench's own devices out of a list and puts them up with the profile asked for.
fn equipment(inputs: &mut Vec<InputSpec>) -> Equipment {
    let mut asked = |address: &str| {
        let at = inputs.iter().position(|spec| spec.address == address)?;
        Some(inputs.remove(at).profile)
    };
    Equipment {
        knobs: asked("sim:dial-box"),
        tablet: asked("sim:tablet"),
        puppet: None,
        ..Equipment::default()
    }
}
