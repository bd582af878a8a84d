//! Takes measures and prints them as JSON lines: `measure [NAME…] [--list]`.
//!
//! Without names all are taken. Run it with `--release` and on a quiet machine; everything but the lines goes to
//! standard error.

use std::io::Write;
use std::process::ExitCode;

use anyhow::{Context, bail};
use dialrig_tests::measure::{MEASURES, Measure, Row};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("measure: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--list") {
        for measure in &MEASURES {
            println!("{}\n    {}", measure.name, measure.about);
        }
        return Ok(());
    }
    for measure in chosen(&arguments)? {
        eprintln!("measuring {} …", measure.name);
        (measure.take)(&mut print).with_context(|| measure.name)?;
    }
    Ok(())
}

fn chosen(names: &[String]) -> anyhow::Result<Vec<&'static Measure>> {
    let known = || MEASURES.iter().map(|m| m.name).collect::<Vec<_>>().join(", ");
    for name in names {
        if !MEASURES.iter().any(|measure| measure.name == name) {
            bail!("no measure is called {name}; there are: {}", known());
        }
    }
    let wanted = |measure: &&Measure| names.is_empty() || names.iter().any(|name| name == measure.name);
    Ok(MEASURES.iter().filter(wanted).collect())
}

fn print(row: &Row) {
    let mut out = std::io::stdout().lock();
    // A reader that has gone away wants nothing more.
    let _ = writeln!(out, "{}", row.json());
    let _ = out.flush();
}
