//! `dialrig play`: plays a show on servos, without a window.

mod report;

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

use bench::world::Equipment;
use rig::{
    Command, Live, NoteLevel, PuppetCommand, PuppetState, PuppetView, Reaction, Snapshot, TransportCommand,
};

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::guard::Guard;
use crate::interrupt::Interrupt;
use crate::number;
use crate::setup::{self, LiveSetup};
use report::Report;

const EXAMPLES: &str = "\
Examples:
  dialrig play shows/salute                                   on the simulated marionette
  dialrig play shows/salute --port /dev/ttyUSB0 --port /dev/ttyUSB1 --log run.csv
  dialrig play shows/salute --compensate-lag --report run.json";

/// Snapshots that may wait for the log; a second of them.
const WAITING: usize = 128;
/// A puppet that has not armed or let go by then never will.
const PATIENCE_SECS: f64 = 10.0;
/// Why servos cannot be armed is told by steps shortly after.
const REASONS_SECS: f64 = 0.1;

/// A show on a servo puppet, without a window
///
/// Plays a show's clip: starts softly from wherever the puppet stands, keeps every limit, and lets go at the end.
/// Ctrl-C stops safely.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A show folder or its show.toml
    show: PathBuf,
    /// Another puppet than the show's
    #[arg(long, value_name = "NAME")]
    puppet: Option<String>,
    /// Where the puppet's buses are, one for each in the profile's order; the simulated ones when left out
    #[arg(long = "port", value_name = "PORT")]
    ports: Vec<String>,
    /// Begin again at the end
    #[arg(long = "loop")]
    looped: bool,
    /// Where to begin
    #[arg(long, value_name = "SECS", default_value_t = 0.0, value_parser = number::secs)]
    from: f64,
    /// Playing speed; 1 is real time
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = number::positive)]
    speed: f64,
    /// Control cycles a second, 10 to 500
    #[arg(long, value_name = "HZ", default_value_t = 100.0, value_parser = rate)]
    rate: f64,
    /// Goals and readings: t_secs,joint,goal_rad,measured_rad
    #[arg(long, value_name = "FILE.csv")]
    log: Option<PathBuf>,
    /// Take goals ahead of the clip by as much as each joint lags
    #[arg(long)]
    compensate_lag: bool,
    /// How well the joints followed: tracking error, lag before and after compensation, limits kept
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
    /// Play only while a line comes on standard input at least this often
    #[arg(long, value_name = "MS", value_parser = clap::value_parser!(u64).range(20..=60_000))]
    heartbeat: Option<u64>,
}

fn rate(text: &str) -> Result<f64, String> {
    match number::finite(text) {
        Ok(hz) if (10.0..=500.0).contains(&hz) => Ok(hz),
        _ => Err("expected 10 to 500".to_owned()),
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let (show, _) = setup::show(Some(&args.show), console)?;
    let Some(puppet) = args.puppet.clone().or_else(|| show.puppet.clone()) else {
        return Err(
            Failure::refused("the show names no puppet").with_hint("name one with --puppet, or in show.toml")
        );
    };
    let keys_secs = show
        .current_clip()
        .map(|clip| clip.times_secs())
        .unwrap_or_default();
    if let Some(end_secs) = keys_secs.last().filter(|end_secs| args.from >= **end_secs) {
        let message = format!("--from {}: the clip ends at {end_secs} s", args.from);
        return Err(Failure::refused(message).with_hint("begin before its end"));
    }
    if args.ports.is_empty() {
        console.remark("no --port: playing on the simulated puppet");
    }
    let mut log = args.log.as_ref().map(Log::create).transpose()?;
    let setup = LiveSetup {
        show,
        folder: None,
        profiles: setup::profiles()?,
        equipment: Equipment {
            knobs: None,
            tablet: None,
            puppet: Some(puppet.clone()),
            ..Equipment::default()
        },
        inputs: Vec::new(),
        ports: args.ports.clone(),
        period: Duration::from_secs_f64(1.0 / args.rate),
        heartbeat: args.heartbeat.map(Duration::from_millis),
    };
    let guard = guard(args, &setup, &puppet, console)?;
    let profiles = Arc::clone(&setup.profiles);
    let interrupt = Interrupt::listen();
    let (seen, snapshots) = sync_channel(WAITING);
    let live = setup.start(move |snapshot| pass_on(&seen, snapshot))?;
    let mut show = Performance {
        console,
        args,
        log: log.as_mut(),
        notes_told: 0,
        report: Report::default(),
        beats: args.heartbeat.map(|_| beats()),
        beaten: false,
    };
    let played = show.play(&live, &snapshots, &interrupt);
    let released = live.close();
    if let (Some(guard), true) = (guard, released) {
        guard.dismiss();
    }
    if let Some(path) = &args.report {
        show.report
            .write(path, &profiles, &puppet, about(args, &puppet, &played))?;
    }
    if let Some(log) = log {
        log.finish()?;
    }
    match played {
        Ok(()) if released => Ok(Exit::Done),
        Ok(()) => Err(Failure::torque_unknown()),
        Err(failure) => Err(failure.after_release(released)),
    }
}

/// A guard, if the puppet is to be let go of when this program dies, and there is somebody to let go.
fn guard(args: &Args, setup: &LiveSetup, puppet: &str, console: &Console) -> Result<Option<Guard>, Failure> {
    // What is wrong with the puppet is told when it is set up.
    let Ok(profile) = setup.profiles.puppet(puppet) else {
        return Ok(None);
    };
    let Ok(profile) = setup.show.demands.of(profile) else {
        return Ok(None);
    };
    if args.ports.is_empty() || profile.policy.on_lost_host != Reaction::Release {
        return Ok(None);
    }
    let bauds = profile.buses.iter().map(|bus| bus.baud);
    let lines: Vec<(String, u32)> = args.ports.iter().cloned().zip(bauds).collect();
    let guard = Guard::start(&lines).map_err(|error| {
        Failure::refused(format!(
            "the guard that lets go of the puppet did not start: {error}"
        ))
    })?;
    console.remark("a guard lets go of the puppet if this program dies; it cannot if the cable goes");
    Ok(Some(guard))
}

/// Lines of standard input as they come.
fn beats() -> Receiver<()> {
    let (beat, beats) = sync_channel(WAITING);
    // Ends with its input, or with the program.
    std::thread::spawn(move || {
        let mut lines = std::io::stdin().lines();
        while let Some(Ok(_)) = lines.next() {
            let _ = beat.try_send(());
        }
    });
    beats
}

/// What the report says of the performance as a whole.
fn about(args: &Args, puppet: &str, played: &Result<(), Failure>) -> serde_json::Value {
    serde_json::json!({
        "show": args.show, "puppet": puppet, "simulated": args.ports.is_empty(), "rate_hz": args.rate,
        "speed": args.speed, "looped": args.looped, "compensated": args.compensate_lag, "played": played.is_ok(),
    })
}

/// A log that cannot keep up loses snapshots, never the rig its pace.
fn pass_on(seen: &SyncSender<Arc<Snapshot>>, snapshot: &Arc<Snapshot>) {
    let _ = seen.try_send(Arc::clone(snapshot));
}

/// What a performance waits for.
#[derive(Clone, Copy, Debug)]
enum Wanted {
    /// All lines of the puppet are open.
    Lines,
    /// The player is in this state.
    State(PuppetState),
}

impl Wanted {
    fn is_met(self, puppet: &PuppetView) -> bool {
        match self {
            // A puppet without lines says so as its fault.
            Self::Lines => puppet.fault.is_none(),
            Self::State(state) => puppet.state == state,
        }
    }
}

struct Performance<'a> {
    console: &'a Console,
    args: &'a Args,
    log: Option<&'a mut Log>,
    notes_told: usize,
    report: Report,
    /// Lines of standard input, where they are a heartbeat.
    beats: Option<Receiver<()>>,
    /// One has come.
    beaten: bool,
}

impl Performance<'_> {
    fn play(
        &mut self,
        live: &Live,
        snapshots: &Receiver<Arc<Snapshot>>,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        live.send(Command::Transport(TransportCommand::Seek {
            secs: self.args.from,
        }));
        live.send(Command::Transport(TransportCommand::Speed(self.args.speed)));
        live.send(Command::Transport(TransportCommand::Loop(self.args.looped)));
        let console = self.console;
        let compensate = self.args.compensate_lag;
        let mut until = |wanted, limit_secs| self.until(live, snapshots, interrupt, limit_secs, wanted);
        // Without lines there is nobody to arm.
        until(Wanted::Lines, Some(PATIENCE_SECS))?;
        live.send(Command::Puppet(PuppetCommand::Arm));
        until(Wanted::State(PuppetState::Holding), Some(PATIENCE_SECS))?;
        console.remark("armed: goals pinned to the measured pose");
        live.send(Command::Puppet(PuppetCommand::CompensateLag(compensate)));
        live.send(Command::Puppet(PuppetCommand::Play));
        until(Wanted::State(PuppetState::Playing), Some(PATIENCE_SECS))?;
        until(Wanted::State(PuppetState::Holding), None)?;
        console.remark("played; letting go");
        live.send(Command::Puppet(PuppetCommand::Release));
        until(Wanted::State(PuppetState::Released), Some(PATIENCE_SECS))
    }

    /// Follows what is seen until the puppet is as wanted.
    fn until(
        &mut self,
        live: &Live,
        snapshots: &Receiver<Arc<Snapshot>>,
        interrupt: &Interrupt,
        limit_secs: Option<f64>,
        wanted: Wanted,
    ) -> Result<(), Failure> {
        let (mut began_secs, mut refused_secs, mut arming) = (None, None, false);
        loop {
            if interrupt.came() {
                return Err(Failure::stopped(true));
            }
            let Ok(seen) = snapshots.recv_timeout(Duration::from_secs(1)) else {
                return Err(Failure::device("the rig has stopped"));
            };
            self.tell(&seen);
            self.pass_beats_on(live);
            let Some(puppet) = &seen.puppet else { continue };
            if let Some(log) = &mut self.log {
                log.rows(&seen)?;
            }
            self.report.see(puppet);
            let alive = self.beats.is_none() || self.beaten;
            if wanted.is_met(puppet) && alive {
                return Ok(());
            }
            if arming && puppet.state == PuppetState::Released {
                let since_secs = *refused_secs.get_or_insert(seen.at_secs);
                if seen.at_secs - since_secs > REASONS_SECS {
                    let message = format!("puppet {} cannot be armed as it is", puppet.name);
                    return Err(Failure::device(message));
                }
            }
            arming |= puppet.state == PuppetState::Arming;
            if puppet.state == PuppetState::Faulted {
                return Err(Failure::device(puppet.fault.clone().unwrap_or_default()));
            }
            let waited_secs = seen.at_secs - *began_secs.get_or_insert(seen.at_secs);
            if limit_secs.is_some_and(|limit| waited_secs > limit) {
                let why = puppet
                    .fault
                    .clone()
                    .unwrap_or_else(|| format!("nothing came of it in {PATIENCE_SECS} s"));
                return Err(Failure::device(format!("puppet {}: {why}", puppet.name)));
            }
        }
    }

    fn pass_beats_on(&mut self, live: &Live) {
        let beats = self.beats.iter().flat_map(Receiver::try_iter);
        if beats.count() > 0 {
            self.beaten = true;
            live.send(Command::Puppet(PuppetCommand::Heartbeat));
        }
    }

    /// Says what the rig has remarked since the last time.
    fn tell(&mut self, seen: &Snapshot) {
        if seen.notes.len() < self.notes_told {
            self.notes_told = 0;
        }
        for note in &seen.notes[self.notes_told..] {
            // A fault is told as what ended the command.
            let fault = seen.puppet.as_ref().and_then(|puppet| puppet.fault.as_ref());
            if note.level >= NoteLevel::Info
                && !fault.is_some_and(|fault| note.text.ends_with(fault.as_str()))
            {
                self.console.remark(&note.text);
            }
        }
        self.notes_told = seen.notes.len();
    }
}

/// The log file.
struct Log {
    path: PathBuf,
    out: BufWriter<File>,
    last_secs: f64,
}

impl Log {
    fn create(path: &PathBuf) -> Result<Self, Failure> {
        let cannot =
            |error: std::io::Error| Failure::refused(format!("cannot write {}: {error}", path.display()));
        let mut out = BufWriter::new(File::create(path).map_err(cannot)?);
        writeln!(out, "t_secs,joint,goal_rad,measured_rad").map_err(cannot)?;
        Ok(Self {
            path: path.clone(),
            out,
            last_secs: f64::NEG_INFINITY,
        })
    }

    fn rows(&mut self, seen: &Snapshot) -> Result<(), Failure> {
        let Some(puppet) = seen.puppet.as_ref().filter(|_| seen.at_secs > self.last_secs) else {
            return Ok(());
        };
        self.last_secs = seen.at_secs;
        for joint in &puppet.joints {
            if let (Some(goal_rad), Some(measured_rad)) = (joint.goal_rad, joint.measured_rad) {
                writeln!(
                    self.out,
                    "{:.6},{},{goal_rad:.6},{measured_rad:.6}",
                    seen.at_secs, joint.name
                )
                .map_err(|error| {
                    Failure::refused(format!("cannot write {}: {error}", self.path.display()))
                })?;
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(), Failure> {
        self.out
            .flush()
            .map_err(|error| Failure::refused(format!("cannot write {}: {error}", self.path.display())))
    }
}
