//! `dialrig decode`: recorded reports to events, without hardware.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rig::Profiles;
use rig::decode::{Decoding, Recording, Totals};
use rig::document::FileError;
use serde_json::{Map, Value, json};

use crate::console::Console;
use crate::event_lines::record_of;
use crate::failure::{Exit, Failure};
use crate::{input, setup};

const EXAMPLES: &str = "\
Examples:
  dialrig decode pen.hid
  dialrig decode --profile hs610 pen_coords.txt
  hid-recorder /dev/hidraw3 | dialrig decode --profile my-tablet.toml -

Without a profile the report descriptor in the recording is used, or the profile that an exchange names.";

/// Recorded reports to events
///
/// Reads hid-recorder text, usbhid-dump text and exchange files; writes one JSON object per event, and totals last.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Profile of the device: a name, or a file with layouts beside the built-in ones
    #[arg(long, value_name = "NAME|FILE")]
    profile: Option<String>,
    /// The recording; `-` is standard input
    #[arg(value_name = "IN", default_value = "-")]
    recording: PathBuf,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut profiles = setup::profiles()?;
    let key = match args.profile.as_deref() {
        Some(name) if Path::new(name).is_file() => Some(add(Path::new(name), &mut profiles)?),
        name => name.map(str::to_owned),
    };
    let profile = key
        .map(|key| profiles.input(&key).cloned())
        .transpose()
        .map_err(|error| Failure::refused(error.to_string()))?;
    let source = input::read(&args.recording, console)?;
    let recording = Recording::read(source.text());
    let warnings: Vec<FileError> = recording
        .flaws
        .iter()
        .map(|flaw| FileError {
            file: args.recording.clone(),
            line: flaw.line,
            column: flaw.column,
            message: flaw.message.clone(),
            hint: None,
        })
        .collect();
    console.warn(&warnings);
    let mut decoding = Decoding::new(&recording, profile.as_ref(), &profiles)
        .map_err(|error| FileError::whole(&args.recording, error.to_string()))?;
    let began = recording
        .reports
        .first()
        .map_or(0.0, |first| first.at.as_secs_f64());
    for report in &recording.reports {
        let mut lines = Vec::new();
        decoding.take(report, &mut |at_secs, told| {
            lines.push(record_of(at_secs - began, &told));
        });
        for line in lines {
            console.record(&line)?;
        }
    }
    let mut totals = decoding.totals();
    totals.counters.rejected += recording.flaws.len() as u64;
    console.record(&last_line(&totals))?;
    Ok(Exit::Done)
}

/// Puts a profile's file among the others and gives its key.
fn add(file: &Path, profiles: &mut Arc<Profiles>) -> Result<String, Failure> {
    let read = rig::decode::with_file(file, profiles).map_err(|errors| {
        let lines: Vec<String> = errors.iter().map(ToString::to_string).collect();
        Failure::refused(lines.join("\n"))
    })?;
    let (key, with) = read;
    *profiles = Arc::new(with);
    Ok(key)
}

fn last_line(totals: &Totals) -> Map<String, Value> {
    let axes: Map<String, Value> = totals
        .axes
        .iter()
        .map(|(name, [min, max])| (name.clone(), json!({ "min": min, "max": max })))
        .collect();
    let mut line = Map::new();
    line.insert("event".into(), json!("totals"));
    line.insert("reports".into(), json!(totals.counters.reports));
    line.insert("events".into(), json!(totals.events));
    line.insert("unknown".into(), json!(totals.counters.unknown));
    line.insert("rejected".into(), json!(totals.counters.rejected));
    line.insert("axes".into(), Value::Object(axes));
    line.insert("edges".into(), json!(totals.edges));
    line
}
