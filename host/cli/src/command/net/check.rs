//! `dialrig net check`: everything that is wrong with network files.
//!
//! More than `dialrig check` says of one: the files are loaded, so that names and kinds are checked too.

use std::path::PathBuf;

use rig::document::Findings;

use super::trouble::Troubles;
use super::{diagnostics, program};
use crate::command::check::report;
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Examples:
  dialrig net check networks/figure.ps300
  dialrig net check first.ps300 second.ps300 --json";

/// Everything that is wrong with network files
///
/// Loads them one after the other into one machine; exits with 1 if there is an error.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// Network files, in the order they are loaded; `-` is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut found = Findings::default();
    let mut machine = program::load(&args.files, console, &mut found);
    diagnostics::sort(&mut found);
    report(&found, console)?;
    let mut troubles = Troubles::default();
    troubles.add(machine.secs(), machine.reports());
    troubles.show(console);
    if found.errors.is_empty() {
        console.remark("in order");
        Ok(Exit::Done)
    } else {
        Ok(Exit::Refused)
    }
}
