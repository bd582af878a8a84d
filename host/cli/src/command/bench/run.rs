//! `dialrig bench run`: plays scenarios.

use std::path::{Path, PathBuf};

use bench::scenario::{self, Outcome, RunOptions, Scenario};
use serde_json::json;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::{input, setup};

const EXAMPLES: &str = "\
Examples:
  dialrig bench run tests/scenarios/*.scn
  dialrig bench run tests/scenarios/noise-on-the-line.scn --seed 7 --junit report.xml";

/// Plays scenarios and says what did not come as expected
///
/// On the embedded bench, in virtual time; the same seed gives the same course.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Scenario files
    #[arg(required = true, value_name = "SCENARIO")]
    files: Vec<PathBuf>,
    /// Decides what random faults hit, instead of the scenarios' own
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Writes the outcome as JUnit XML
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let scenarios = args
        .files
        .iter()
        .map(|file| read(file, console))
        .collect::<Result<Vec<_>, _>>()?;
    let options = RunOptions {
        profiles: setup::profiles()?,
        seed: args.seed,
    };
    let bar = console.progress(scenarios.len() as u64, "scenarios");
    let mut outcomes = Vec::new();
    for (scenario, file) in scenarios.iter().zip(&args.files) {
        let outcome = scenario::run(scenario, &options);
        bar.inc(1);
        tell(&outcome, file, console)?;
        outcomes.push(outcome);
    }
    bar.finish_and_clear();
    if let Some(path) = &args.junit {
        std::fs::write(path, scenario::junit(&outcomes))
            .map_err(|error| Failure::refused(format!("cannot write {}: {error}", path.display())))?;
    }
    let failed = outcomes.iter().filter(|outcome| !outcome.passed()).count();
    console.remark(format_args!(
        "{} passed, {failed} failed",
        outcomes.len() - failed
    ));
    Ok(if failed == 0 { Exit::Done } else { Exit::Refused })
}

fn read(file: &Path, console: &Console) -> Result<Scenario, Failure> {
    let source = input::read(file, console)?;
    let name = file
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned())
        .unwrap_or_default();
    let folder = file.parent().unwrap_or(Path::new(""));
    Scenario::parse(&name, folder, source.text()).map_err(|errors| {
        let lines: Vec<String> = errors
            .iter()
            .map(|e| format!("{}:{}:{}: error: {}", file.display(), e.line, e.column, e.message))
            .collect();
        Failure::refused(lines.join("\n"))
    })
}

fn tell(outcome: &Outcome, file: &Path, console: &Console) -> Result<(), Failure> {
    if console.json() {
        let failures: Vec<_> = outcome
            .failures
            .iter()
            .map(|f| json!({"line": f.line, "column": f.column, "message": f.message}))
            .collect();
        return console.record(&json!({
            "scenario": outcome.name,
            "passed": outcome.passed(),
            "seed": outcome.seed,
            "checks": outcome.checks,
            "secs": outcome.secs,
            "failures": failures,
        }));
    }
    let word = if outcome.passed() { "ok  " } else { "FAIL" };
    console.line(format_args!(
        "{word} {} ({} checks, {:.2} s, seed {})",
        outcome.name, outcome.checks, outcome.secs, outcome.seed
    ))?;
    for failure in &outcome.failures {
        console.line(format_args!(
            "     {}:{}:{}: {}",
            file.display(),
            failure.line,
            failure.column,
            failure.message
        ))?;
    }
    Ok(())
}
