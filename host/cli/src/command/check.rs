//! `dialrig check`: everything that is wrong with files, not only the first thing.
//!
//! With `--json` the findings are the result and go to standard output.

mod feasibility;

use std::path::{Path, PathBuf};

use bench::scenario::Scenario;
use rig::document::Findings;
use rig::document::check::check_file;
use rig::document::source::Source;

use crate::console::{Console, RemarkRecord, Weight};
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Examples:
  dialrig check shows/salute
  dialrig check walk.bvh networks/*.ps300 --json
  dialrig check shows/salute --puppet marionette   whether it can do the show, before anything moves";

/// Everything that is wrong with files
///
/// Checks show folders, show.toml, clips and hardware profiles (.toml), .str, .pri, .shp, .ps300, .bvh, journals
/// (.jsonl) and scenarios (.scn); exits with 1 if one of them has an error, or if a clip asks too much of the puppet.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Files and show folders
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Also whether this puppet can do each clip of the shows: speed, acceleration, reach and torque
    #[arg(long, value_name = "NAME")]
    puppet: Option<String>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let progress = console.progress(args.files.len() as u64, "checking");
    let mut found = Findings::default();
    for file in &args.files {
        let here = check_one(file);
        found.errors.extend(here.errors);
        found.warnings.extend(here.warnings);
        progress.inc(1);
    }
    progress.finish_and_clear();
    report(&found, console)?;
    let mut fits = true;
    if let Some(puppet) = &args.puppet {
        for file in args.files.iter().filter(|_| found.errors.is_empty()) {
            fits &= feasibility::check(file, puppet, console)?;
        }
    }
    if !fits {
        return Ok(Exit::Refused);
    }
    if found.errors.is_empty() {
        console.remark(format_args!(
            "{} in order{}",
            counted(args.files.len(), "file"),
            match found.warnings.len() {
                0 => String::new(),
                count => format!(", {}", counted(count, "warning")),
            }
        ));
        Ok(Exit::Done)
    } else {
        Ok(Exit::Refused)
    }
}

/// Scenarios belong to the bench; all other kinds are the rig's.
fn check_one(file: &Path) -> Findings {
    if file.extension().is_none_or(|extension| extension != "scn") {
        return check_file(file);
    }
    let mut found = Findings::default();
    match Source::open(file) {
        Err(error) => found.error(error),
        Ok(source) => {
            let folder = file.parent().unwrap_or(Path::new(""));
            for error in Scenario::parse("", folder, source.text())
                .err()
                .into_iter()
                .flatten()
            {
                found.error(source.error_at((error.line, error.column), error.message));
            }
        }
    }
    found
}

/// Shows findings: for programs as the result, for people beside it.
pub(super) fn report(found: &Findings, console: &Console) -> Result<(), Failure> {
    if !console.json() {
        console.warn(&found.warnings);
        console.errors(&found.errors);
        return Ok(());
    }
    for warning in &found.warnings {
        console.record(&RemarkRecord::of_file(Weight::Warning, warning))?;
    }
    for error in &found.errors {
        console.record(&RemarkRecord::of_file(Weight::Error, error))?;
    }
    Ok(())
}

fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}
