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

/// Function networks in the command language (docs/ps300/language.md), without devices.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run in virtual time and watch messages
    Run(run::Args),
    /// Everything that is wrong with network files
    Check(check::Args),
    /// The canonical text of network files
    Print(print::Args),
    /// A drawing for graphviz
    Dot(dot::Args),
    /// The reference table of functions
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
