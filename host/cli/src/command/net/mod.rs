//! `dialrig net`: function networks without devices.

mod check;
pub(super) mod diagnostics;
mod dot;
mod events;
mod functions;
mod markdown;
mod message;
mod print;
mod program;
mod run;
mod trouble;

use clap::Subcommand;

use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Examples:
  dialrig net check networks/figure.ps300
  dialrig net dot networks/figure.ps300 | dot -Tsvg > figure.svg
  dialrig net functions ACCUMULATE";

/// Function networks without devices: run, check, print, draw, look up
///
/// Networks are written in the command language (docs/ps300/language.md).
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Args),
    Check(check::Args),
    Print(print::Args),
    Dot(dot::Args),
    Functions(functions::Args),
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    match &args.command {
        Command::Run(args) => run::run(args, console),
        Command::Check(args) => check::run(args, console),
        Command::Print(args) => print::run(args, console),
        Command::Dot(args) => dot::run(args, console),
        Command::Functions(args) => functions::run(args, console),
    }
}
