//! `dialrig bench`: scenarios on a whole rig.

mod run;

use clap::Subcommand;

use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Example:
  dialrig bench run tests/scenarios/*.scn";

/// Scenarios on a whole rig
///
/// What one would say at the bench, played in virtual time (docs/scenarios.md).
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

/// What can be done with scenarios.
#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Args),
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    match &args.command {
        Command::Run(args) => run::run(args, console),
    }
}
