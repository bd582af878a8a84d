//! `dialrig record`: a performance on real or simulated controls becomes a take and a clip of its keys.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

use bench::world::Equipment;
use rig::document::{Show, can_be_saved, is_file_name};
use rig::{Command, DeviceHealth, InputSpec, Live, NoteLevel, Snapshot, TakeCommand};

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::number;
use crate::setup::{self, LiveSetup};

const EXAMPLES: &str = "\
Examples:
  dialrig record shows/salute --device /dev/ttyUSB0 --take wave --out my-salute
  dialrig record my-salute --device /dev/ttyUSB0=sgi-dialbox --device /dev/ttyUSB1=graphire-serial --take again --secs 30";

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
/// can be done again through another network, and with a clip of its keys. SHOW itself is saved, as it is in the studio,
/// unless --out says where.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A show folder or its show.toml
    show: PathBuf,
    /// A device to be recorded and its profile; `sgi-dialbox` unless said
    #[arg(long = "device", value_name = "DEVICE[=PROFILE]", required = true)]
    devices: Vec<String>,
    /// What take and clip are called; an older take of that name is recorded over
    #[arg(long, value_name = "NAME", value_parser = name)]
    take: String,
    /// A folder for the show with the take; SHOW stays as it is
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// The take's keys may take the place of a clip that is no take's, or the show in --out that of another
    #[arg(long)]
    replace: bool,
    /// For how long; until Ctrl-C when left out
    #[arg(long, value_name = "N", value_parser = number::positive)]
    secs: Option<f64>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let (show, folder) = setup::show(Some(&args.show), console)?;
    let folder = target(args, &show, folder)?;
    console.remark(format_args!("the take will be saved into {}", folder.display()));
    let mut inputs: Vec<InputSpec> = (1..)
        .zip(&args.devices)
        .map(|(n, device)| spec(n, device))
        .collect();
    let equipment = equipment(&mut inputs);
    let wanted = equipment.inputs().into_iter().chain(inputs.iter().cloned());
    let names: Vec<String> = wanted.map(|spec| spec.name).collect();
    let setup = LiveSetup {
        show,
        folder: Some(folder),
        profiles: setup::profiles()?,
        equipment,
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
        names,
    };
    let recorded = perform(args, &live, &mut watch, &interrupt);
    live.close();
    recorded.map(|()| Exit::Done)
}

fn name(text: &str) -> Result<String, String> {
    if is_file_name(text) {
        Ok(text.to_owned())
    } else {
        Err("a take's name has letters, digits, spaces, - and _".to_owned())
    }
}

/// The folder that is saved. What would be refused after the performance is refused before it.
fn target(args: &Args, show: &Show, own: Option<PathBuf>) -> Result<PathBuf, Failure> {
    let clips = show.clips.contains_key(&args.take) || show.joint_clips.contains_key(&args.take);
    if clips && !show.takes.contains_key(&args.take) && !args.replace {
        let message = format!("the show has a clip {} that is no take's", args.take);
        return Err(Failure::refused(message).with_hint("give the take another name, or --replace"));
    }
    let folder = match (&args.out, own) {
        (Some(out), _) => {
            if out.join("show.toml").exists() && !args.replace {
                let message = format!("{}: there is a show already", out.display());
                return Err(Failure::refused(message).with_hint("name another folder, or give --replace"));
            }
            out.clone()
        }
        (None, Some(own)) => own,
        (None, None) => {
            return Err(Failure::refused("this show has no folder").with_hint("name one with --out"));
        }
    };
    can_be_saved(&folder).map_err(|error| match args.out {
        Some(_) => error,
        None => error.with_hint("name another folder with --out"),
    })?;
    Ok(folder)
}

/// Waits for the devices, records, and waits for the keys and for them to be saved.
fn perform(args: &Args, live: &Live, watch: &mut Watch<'_>, interrupt: &Interrupt) -> Result<(), Failure> {
    let begins = watch.until_ready(interrupt)?;
    live.send(Command::Take(TakeCommand::Start {
        name: args.take.clone(),
        devices: watch.names.clone(),
        tolerance: None,
    }));
    let mut seen = begins.clone();
    while seen.take.is_none() {
        seen = watch.next()?;
        if seen.at_secs > begins.at_secs + SETTLE_SECS {
            return Err(Failure::refused(format!("take {} did not come about", args.take)));
        }
    }
    watch.console.remark("recording; Ctrl-C ends it");
    let mut alone_since = None;
    while !interrupt.came() && args.secs.is_none_or(|secs| seen.at_secs - begins.at_secs < secs) {
        seen = watch.next()?;
        let alone = watch.mute(&seen).len() == watch.names.len();
        alone_since = alone.then_some(alone_since.unwrap_or(seen.at_secs));
        if alone_since.is_some_and(|since| seen.at_secs - since > ANSWER_SECS) {
            break;
        }
    }
    let lost = watch.mute(&seen);
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
    if lost.len() == watch.names.len() {
        let message = format!("{} did not come back; what came before is kept", lost.join(", "));
        return Err(Failure::device(message));
    }
    Ok(())
}

/// The rig's steps as they come, and its remarks told.
struct Watch<'c> {
    console: &'c Console,
    snapshots: Receiver<Arc<Snapshot>>,
    told: usize,
    /// The devices that were asked for.
    names: Vec<String>,
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

    /// Addresses of devices that were asked for and do not answer.
    fn mute(&self, seen: &Snapshot) -> Vec<String> {
        let asked = seen
            .devices
            .iter()
            .filter(|device| self.names.contains(&device.name));
        let mute = asked.filter(|device| device.health != DeviceHealth::Present);
        mute.map(|device| device.address.clone()).collect()
    }

    fn until_ready(&mut self, interrupt: &Interrupt) -> Result<Arc<Snapshot>, Failure> {
        loop {
            let seen = self.next()?;
            let mute = self.mute(&seen);
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
