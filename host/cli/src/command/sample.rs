//! `dialrig sample`: where everything is over time, as JSON lines.

use std::path::PathBuf;

use clap::ValueEnum;
use motion::{Clip, Figure, FigurePose};
use rig::document::convert::read_show;
use rig::puppet::{Body, Follower};
use serde::Serialize;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::number;
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig sample shows/salute --fps 30 > salute.jsonl
  dialrig sample walk.bvh --at 0,0.5,1
  dialrig sample walk.bvh --of joints --puppet marionette";

/// Where everything is over time, without drawing
///
/// One JSON object a line, `{"t":…,"name":…,"start":[…],"end":[…]}`, in the axes and units of the file; with
/// `--of joints` `{"t":…,"name":…,"angle_rad":…}`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A show folder, its show.toml, or a .bvh file
    #[arg(value_name = "SHOW")]
    show: PathBuf,
    /// Samples a second, from the first key to the last; as many as the clip's own frames if not given
    #[arg(long, value_name = "F", value_parser = number::positive, conflicts_with = "at")]
    fps: Option<f64>,
    /// Samples at these times, seconds; before the first key and after the last the figure stands still
    #[arg(long, value_name = "T,T…", value_delimiter = ',', value_parser = number::finite, allow_hyphen_values = true)]
    at: Vec<f64>,
    /// What is sampled
    #[arg(long, value_enum, default_value_t = Of::Links)]
    of: Of,
    /// Another puppet than the show's, for joints
    #[arg(long, value_name = "NAME")]
    puppet: Option<String>,
}

/// What can be sampled.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Of {
    /// Where each link of the figure starts and ends
    Links,
    /// The angle of each joint of the show's puppet as it follows the figure
    Joints,
}

/// One link at one time.
#[derive(Serialize)]
struct LinkRecord<'a> {
    t: f64,
    name: &'a str,
    start: [f64; 3],
    end: [f64; 3],
}

/// One joint at one time.
#[derive(Serialize)]
struct JointRecord<'a> {
    t: f64,
    name: &'a str,
    angle_rad: f64,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let (show, warnings) = read_show(&args.show)?;
    console.warn(&warnings);
    let still = |why: &str| {
        let message = format!("{}: {why}, so there is no motion to sample", args.show.display());
        Failure::refused(message)
    };
    let figure = show
        .figure
        .as_ref()
        .ok_or_else(|| still("this show has no figure"))?;
    let no_keys = || still("the clip has no keys").with_hint("pose the figure and store a key first");
    let doc = show.current_clip().ok_or_else(no_keys)?;
    let clip = doc.clip(&figure.figure);
    let clip = clip
        .map_err(|error| still(&error.to_string()))?
        .ok_or_else(no_keys)?;
    let fps = args.fps.unwrap_or_else(|| doc.export_frame_secs().recip());
    let times = Times::of(args, fps, &clip);
    match args.of {
        Of::Links => links(&figure.figure, &clip, &times, console),
        Of::Joints => {
            let body = Body::of_show(&show, args.puppet.as_deref(), &*setup::profiles()?)
                .map_err(|error| Failure::refused(error.to_string()))?;
            joints(&body, &clip, &times, console)
        }
    }
}

/// When to sample.
enum Times<'a> {
    At(&'a [f64]),
    Even { start_secs: f64, fps: f64, count: u64 },
}

impl<'a> Times<'a> {
    fn of(args: &'a Args, fps: f64, clip: &Clip) -> Self {
        if !args.at.is_empty() {
            return Self::At(&args.at);
        }
        // A frame on the last key counts, whatever the rounding: the tolerance exports use too.
        let last = (clip.duration_secs() * fps + 1e-6).floor();
        Self::Even {
            start_secs: clip.start_secs(),
            fps,
            count: last as u64 + 1,
        }
    }

    fn count(&self) -> u64 {
        match self {
            Self::At(times) => times.len() as u64,
            Self::Even { count, .. } => *count,
        }
    }

    fn secs(&self, index: u64) -> f64 {
        match self {
            Self::At(times) => times.get(index as usize).copied().unwrap_or_default(),
            Self::Even { start_secs, fps, .. } => start_secs + index as f64 / fps,
        }
    }
}

fn links(figure: &Figure, clip: &Clip, times: &Times<'_>, console: &Console) -> Result<Exit, Failure> {
    let interrupt = Interrupt::listen();
    let progress = console.progress(times.count(), "sampling");
    let (mut pose, mut placed) = (FigurePose::default(), Vec::new());
    for index in 0..times.count() {
        if interrupt.came() {
            return Err(Failure::interrupted());
        }
        let t = times.secs(index);
        clip.sample(t, &mut pose);
        figure.place(&pose, &mut placed);
        for (link, placed) in figure.links().iter().zip(&placed) {
            console.record(&LinkRecord {
                t,
                name: &link.name,
                start: placed.start.to_array(),
                end: placed.end.to_array(),
            })?;
        }
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(Exit::Done)
}

/// Each row begins near the one before, so that a joint does not jump between two answers.
fn joints(body: &Body, clip: &Clip, times: &Times<'_>, console: &Console) -> Result<Exit, Failure> {
    let interrupt = Interrupt::listen();
    let progress = console.progress(times.count(), "sampling");
    let (mut follower, mut placed) = (Follower::new(body), Vec::new());
    for index in 0..times.count() {
        if interrupt.came() {
            return Err(Failure::interrupted());
        }
        let t = times.secs(index);
        clip.place(t, &mut placed);
        let angles_rad = follower.follow(&placed);
        for (name, &angle_rad) in body.joints().iter().zip(angles_rad) {
            console.record(&JointRecord { t, name, angle_rad })?;
        }
        progress.inc(1);
    }
    progress.finish_and_clear();
    Ok(Exit::Done)
}
