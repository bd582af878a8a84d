//! `dialrig net print`: the canonical text of network files.

use std::path::PathBuf;

use ps300::language;
use rig::document::Findings;
use serde::Serialize;

use super::diagnostics;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::input;

const EXAMPLES: &str = "\
Examples:
  dialrig net print old.ps300 > tidy.ps300
  echo 'a:=f:addc;conn a<1>:<1>a;' | dialrig net print -";

/// The canonical text of network files
///
/// Commands one by one as the language writes them: keywords whole, names as given. Comments are lost. Nothing is
/// printed unless all could be read.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// Network files; `-` is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

/// One command and where it was read.
#[derive(Serialize)]
struct Record {
    file: String,
    line: u32,
    column: u32,
    command: String,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut found = Findings::default();
    let mut records = Vec::new();
    for path in &args.files {
        let source = match input::read(path, console) {
            Ok(source) => source,
            Err(errors) => {
                errors.0.into_iter().for_each(|error| found.error(error));
                continue;
            }
        };
        let (commands, remarks) = language::parse(source.text());
        diagnostics::note(&source, (1, 1), remarks, &mut found);
        records.extend(commands.into_iter().map(|located| Record {
            file: path.display().to_string(),
            line: located.at.line,
            column: located.at.column,
            command: language::print(&located.what),
        }));
    }
    diagnostics::settle(found, console)?;
    for record in &records {
        if console.json() {
            console.record(record)?;
        } else {
            console.line(&record.command)?;
        }
    }
    Ok(Exit::Done)
}
