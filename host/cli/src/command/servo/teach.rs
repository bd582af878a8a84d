//! `dialrig servo teach`: the puppet is posed by hand, and Enter stores each pose as a key of a show.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use bench::world::Equipment;
use rig::document::Show;
use rig::{Command, Live, NoteLevel, Snapshot, TeachCommand, TransportCommand};

use super::typed::Typed;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::number;
use crate::setup::{self, LiveSetup};

const EXAMPLES: &str = "\
Examples:
  dialrig servo teach shows/mine --port /dev/ttyUSB0 --puppet starter
  dialrig servo teach shows/mine --every 0.5 --from 4

Torque is off throughout: hold the puppet. Enter stores the pose it is in, `u` and Enter takes the last one back,
`q` and Enter saves the show and ends, Ctrl-C ends without saving. A folder that is not there becomes a show.";

/// How often the terminal is looked at.
const EVERY: Duration = Duration::from_millis(30);
/// Control cycles.
const PERIOD: Duration = Duration::from_millis(10);

/// Poses stored from the puppet itself
///
/// As poses of the show's figure where the puppet follows it, else of its joints.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A show folder; a new one is made
    show: PathBuf,
    /// The puppet, if the show names none
    #[arg(long, value_name = "NAME")]
    puppet: Option<String>,
    /// Where the puppet's buses are, one for each in the profile's order; the simulated ones when left out
    #[arg(long = "port", value_name = "PORT")]
    ports: Vec<String>,
    /// Animation time from one key to the next
    #[arg(long, value_name = "SECS", default_value_t = 1.0, value_parser = number::positive)]
    every: f64,
    /// Animation time of the first key
    #[arg(long, value_name = "SECS", default_value_t = 0.0, value_parser = number::secs)]
    from: f64,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let (mut show, folder) = if args.show.exists() {
        setup::show(Some(&args.show), console)?
    } else {
        let name = args
            .show
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let show = Show {
            name,
            ..Show::default()
        };
        (show, Some(args.show.clone()))
    };
    show.puppet = args.puppet.clone().or(show.puppet);
    let Some(puppet) = show.puppet.clone() else {
        return Err(Failure::refused("the show names no puppet").with_hint("name one with --puppet"));
    };
    let setup = LiveSetup {
        show,
        folder,
        profiles: setup::profiles()?,
        equipment: Equipment {
            knobs: None,
            tablet: None,
            puppet: Some(puppet),
            ..Equipment::default()
        },
        inputs: Vec::new(),
        ports: args.ports.clone(),
        period: PERIOD,
        heartbeat: None,
    };
    let interrupt = Interrupt::listen();
    let live = setup.start(|_| ())?;
    console.remark(
        "torque goes off: hold the puppet; Enter stores its pose, u takes the last back, q saves and ends",
    );
    let saved = teach(args, &live, console, &interrupt);
    let released = live.close();
    match (saved, released) {
        (_, false) => Err(Failure::torque_unknown()),
        (true, true) => Ok(Exit::Done),
        (false, true) => {
            console.remark("nothing was saved");
            Ok(Exit::Refused)
        }
    }
}

/// Stores until the end is asked for. Gives whether the show was saved.
fn teach(args: &Args, live: &Live, console: &Console, interrupt: &Interrupt) -> bool {
    let typed = Typed::listen();
    let mut told = Told::default();
    let mut begun = false;
    while !interrupt.came() {
        let seen = live.snapshot();
        told.tell(&seen, console);
        // Lines are opened by the first steps; before that there is nobody to let go.
        let there = seen.puppet.as_ref().is_some_and(|puppet| puppet.fault.is_none());
        if there && !begun {
            begun = true;
            live.send(Command::Transport(TransportCommand::Seek { secs: args.from }));
            live.send(Command::Teach(TeachCommand::Begin));
        }
        match typed.next().as_deref().map(str::trim) {
            Some("q") => {
                live.send(Command::Teach(TeachCommand::End));
                live.send(Command::Save);
                return until_saved(live, console, interrupt, &mut told);
            }
            Some("u") => live.send(Command::Undo),
            Some(_) => live.send(Command::Teach(TeachCommand::Store {
                step_secs: args.every,
            })),
            None => interrupt.wait(EVERY),
        }
    }
    false
}

/// Waits until the show is on disk, or was refused.
fn until_saved(live: &Live, console: &Console, interrupt: &Interrupt, told: &mut Told) -> bool {
    while !interrupt.came() {
        let seen = live.snapshot();
        let refused = told.tell(&seen, console);
        if !seen.unsaved {
            return true;
        }
        if refused {
            return false;
        }
        interrupt.wait(EVERY);
    }
    false
}

/// What has been said already.
#[derive(Default)]
struct Told {
    until_secs: Option<f64>,
    keys: usize,
}

impl Told {
    /// Says what is new. Gives whether anything of it was a warning.
    fn tell(&mut self, seen: &Arc<Snapshot>, console: &Console) -> bool {
        let mut warned = false;
        for note in &seen.notes {
            if self.until_secs.is_none_or(|until| note.at_secs > until) {
                warned |= note.level >= NoteLevel::Warning;
                console.remark(&note.text);
            }
        }
        self.until_secs = seen.notes.last().map(|note| note.at_secs).or(self.until_secs);
        if seen.keys.len() != self.keys {
            self.keys = seen.keys.len();
            console.remark(format_args!("{} keys", self.keys));
        }
        warned
    }
}
