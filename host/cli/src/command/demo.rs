//! `dialrig demo`: the whole chain without hardware or display, told as a film.

use std::fs::{self, File};
use std::io::BufWriter;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bench::demo::{self, Chapter, Demo, DemoError, DemoOptions, Scene};
use rig::Snapshot;
use rig::document::{self, Show};
use ui::render::film::{GifFilm, write_png};
use ui::render::stage::{self, Look};
use ui::render::{sheet, story};

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig demo
  dialrig demo --seconds 12 --out my-demo
  dialrig demo --puppet so-101       an arm that follows no figure: twice, the second time with its lag made up for";

/// The film's size and rate: small enough for a page, large enough to read the labels.
const FILM_SIZE: [u32; 2] = [768, 480];
const FILM_FPS: f64 = 12.5;
/// Every so many steps of the story one is kept for the film.
const KEEP_EVERY: u64 = 4;
/// Shares of the film's length: entering the keys, retiming and playing on screen, the puppet.
const SHARES: [f64; 3] = [0.4, 0.25, 0.35];

/// The whole chain without hardware or display, as a film
///
/// Simulated hands pose the printed human through the bytes of a dial box and a tablet; the clip is retimed, played
/// on screen and performed by a simulated puppet. A puppet that follows no figure performs by itself. Writes film.gif, poses.png, servo.csv, report.json and journal.jsonl.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Length of the film
    #[arg(long, value_name = "N", default_value_t = 24.0, value_parser = crate::number::positive)]
    seconds: f64,
    /// Another puppet than the marionette
    #[arg(long, value_name = "NAME")]
    puppet: Option<String>,
    /// Where to write; made if need be
    #[arg(long, value_name = "DIR", default_value = "demo-out")]
    out: PathBuf,
}

/// One kept moment of the story.
struct Moment {
    chapter: Chapter,
    snapshot: Arc<Snapshot>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    fs::create_dir_all(&args.out).map_err(|error| cannot("make", &args.out, &error))?;
    let profiles = setup::profiles()?;
    let show = show_for(args.puppet.as_deref(), &profiles)?;
    let interrupt = Interrupt::listen();
    let mut moments = Vec::new();
    let options = DemoOptions {
        show,
        profiles,
        keys_max: None,
    };
    let told = demo::run(options, &mut |scene| {
        keep(&mut moments, &scene, console);
        if interrupt.came() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let told = told.map_err(|error| match error {
        DemoError::Stopped { torque_off } => Failure::stopped(torque_off),
        other => Failure::refused(other.to_string()),
    })?;
    console.remark("drawing the film");
    write_film(args, &moments, console)?;
    write_sheet(args, &moments)?;
    write_texts(args, &told)?;
    say(&told, args, console)
}

/// The show that suits a puppet: the human's for one that follows a figure, the arm's for one with those joints, else
/// one joint after the other.
fn show_for(puppet: Option<&str>, profiles: &rig::Profiles) -> Result<Show, Failure> {
    let salute = document::from_texts(&rig::shipped::salute())?;
    let Some(name) = puppet else { return Ok(salute) };
    let profile = profiles
        .puppet(name)
        .map_err(|error| Failure::refused(error.to_string()))?;
    let arm = document::from_texts(&rig::shipped::arm())?;
    let keys = arm
        .current_joint_clip()
        .map(|clip| clip.keys.clone())
        .unwrap_or_default();
    let mut named = keys.iter().flat_map(|key| key.angles_rad.keys());
    let show = if profile.figure.is_some() {
        salute
    } else if named.all(|joint| profile.joint(joint).is_some()) {
        arm
    } else {
        rig::shipped::sweep(profile)
    };
    Ok(Show {
        puppet: Some(name.to_owned()),
        ..show
    })
}

fn keep(moments: &mut Vec<Moment>, scene: &Scene<'_>, console: &Console) {
    let said = moments.last().map(|m: &Moment| m.chapter);
    if said != Some(scene.chapter) {
        console.remark(format_args!(
            "{:7.2} s  {}",
            scene.snapshot.at_secs,
            caption(scene.chapter)
        ));
    }
    if scene.snapshot.step.is_multiple_of(KEEP_EVERY) || said != Some(scene.chapter) || scene.key_stored {
        moments.push(Moment {
            chapter: scene.chapter,
            snapshot: Arc::clone(scene.snapshot),
        });
    }
}

fn caption(chapter: Chapter) -> String {
    match chapter {
        Chapter::Beginning => "dial box and tablet introduce themselves".to_owned(),
        Chapter::Posing { key, of } => format!("key {} of {of}, entered through the devices' bytes", key + 1),
        Chapter::Retiming => "the kinetic curve: timing changes, the path does not".to_owned(),
        Chapter::Playing => "playing on screen".to_owned(),
        Chapter::Arming => "the puppet: measured, pinned, torque on".to_owned(),
        Chapter::Performing => "the puppet approaches softly, then performs".to_owned(),
        Chapter::Ending => "hold, and let go".to_owned(),
    }
}

/// Which part of the film a chapter belongs to.
fn part(chapter: Chapter) -> usize {
    match chapter {
        Chapter::Beginning | Chapter::Posing { .. } => 0,
        Chapter::Retiming | Chapter::Playing => 1,
        Chapter::Arming | Chapter::Performing | Chapter::Ending => 2,
    }
}

fn write_film(args: &Args, moments: &[Moment], console: &Console) -> Result<(), Failure> {
    let path = args.out.join("film.gif");
    let chosen = choose(moments, args.seconds);
    let bar = console.progress(chosen.len() as u64, "film");
    let [width, height] = FILM_SIZE;
    let failed =
        |error: ui::render::film::FilmError| Failure::refused(format!("{}: {error}", path.display()));
    let file = File::create(&path).map_err(|error| cannot("write", &path, &error))?;
    let mut film = GifFilm::new(BufWriter::new(file), width, height, FILM_FPS).map_err(failed)?;
    for moment in chosen {
        let look = Look {
            onion: part(moment.chapter) == 1,
            ..Look::film()
        };
        let look = if part(moment.chapter) == 0 {
            Look {
                editing: true,
                ticks: false,
                ..look
            }
        } else {
            look
        };
        let picture = story::draw(&moment.snapshot, &look, &caption(moment.chapter), width, height);
        film.frame(&picture).map_err(failed)?;
        bar.inc(1);
    }
    film.finish().map_err(failed)?;
    bar.finish_and_clear();
    Ok(())
}

/// The moments shown: each part evenly spread over its share of the film, so that entering the keys is a time lapse.
fn choose(moments: &[Moment], seconds: f64) -> Vec<&Moment> {
    let frames = (seconds * FILM_FPS).round().max(3.0);
    let mut chosen = Vec::new();
    for (index, share) in SHARES.iter().enumerate() {
        let of_part: Vec<&Moment> = moments.iter().filter(|m| part(m.chapter) == index).collect();
        let Some(last) = of_part.len().checked_sub(1) else {
            continue;
        };
        let count = (frames * share).round().max(1.0) as usize;
        chosen.extend((0..count).map(|i| of_part[i * last / count.saturating_sub(1).max(1)]));
    }
    chosen
}

fn write_sheet(args: &Args, moments: &[Moment]) -> Result<(), Failure> {
    let path = args.out.join("poses.png");
    let Some(seen) = moments.last().map(|m| &m.snapshot) else {
        return Ok(());
    };
    let (Some(clip), Some(figure)) = (&seen.clip, &seen.figure) else {
        return Ok(());
    };
    let key_secs: Vec<f64> = seen.keys.iter().map(|key| key.secs).collect();
    let camera = stage::camera(&seen.view);
    let title = format!(
        "{}: {} keys entered by hand, and what lies between them",
        seen.show,
        key_secs.len()
    );
    let picture = sheet::draw(
        clip,
        &figure.shapes,
        &key_secs,
        &camera,
        &sheet::Layout::default(),
        &title,
    );
    let file = File::create(&path).map_err(|error| cannot("write", &path, &error))?;
    write_png(&picture, BufWriter::new(file))
        .map_err(|error| Failure::refused(format!("{}: {error}", path.display())))
}

fn write_texts(args: &Args, told: &Demo) -> Result<(), Failure> {
    let report = serde_json::to_string_pretty(&told.report).map_err(|error| Failure::Output(error.into()))?;
    let texts = [
        ("servo.csv", demo::csv(&told.rows, &told.joints)),
        ("report.json", report + "\n"),
        ("journal.jsonl", told.journal.clone()),
    ];
    for (name, text) in texts {
        let path = args.out.join(name);
        fs::write(&path, text).map_err(|error| cannot("write", &path, &error))?;
    }
    Ok(())
}

fn say(told: &Demo, args: &Args, console: &Console) -> Result<Exit, Failure> {
    if console.json() {
        console.record(&told.report)?;
    } else {
        let report = &told.report;
        let out = args.out.display();
        if report.keys_entered > 0 {
            console.line(format_args!(
                "{} keys entered through device bytes",
                report.keys_entered
            ))?;
        }
        console.line(format_args!(
            "journal replays identically: {}",
            report.journal_replay_identical
        ))?;
        console.line(format_args!(
            "puppet: start jump {:.3} deg, RMS error {:.2} deg, speed {:.3} and acceleration {:.3} of the limits, {} stale reads",
            report.servo.start_jump_deg,
            report.servo.rms_error_deg,
            report.servo.max_speed_ratio,
            report.servo.max_accel_ratio,
            report.stale_reads,
        ))?;
        if let (Some(before), Some(after)) = (
            report.servo.clip_rms_error_before_deg,
            report.servo.clip_rms_error_after_deg,
        ) {
            console.line(format_args!(
                "RMS error against the clip {before:.2} deg, {after:.2} deg with lag made up for"
            ))?;
        }
        for (joint, lag) in &report.servo.lag {
            let ms = |lag: Option<f64>| lag.map_or("-".to_owned(), |ms| format!("{ms:.1} ms"));
            console.line(format_args!(
                "lag of {joint}: {}, {} made up for",
                ms(lag.before_ms),
                ms(lag.after_ms)
            ))?;
        }
        // Without a figure there are no key pictures.
        let poses = if report.keys_entered > 0 {
            format!(", {out}/poses.png")
        } else {
            String::new()
        };
        console.line(format_args!(
            "look at {out}/film.gif{poses}, {out}/servo.csv, {out}/report.json"
        ))?;
    }
    Ok(Exit::Done)
}

fn cannot(what: &str, path: &Path, error: &std::io::Error) -> Failure {
    Failure::refused(format!("cannot {what} {}: {error}", path.display()))
}
