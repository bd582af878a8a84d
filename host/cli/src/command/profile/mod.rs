//! `dialrig profile`: what is known about hardware.

mod check;
mod list;
mod show;

use clap::Subcommand;

use crate::console::Console;
use crate::failure::{Exit, Failure};

/// Hardware profiles: those shipped and one's own
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: `dialrig profile list` names them all")]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Profile,
}

#[derive(Debug, Subcommand)]
enum Profile {
    List(list::Args),
    Show(show::Args),
    Check(check::Args),
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    match &args.command {
        Profile::List(args) => list::run(args, console),
        Profile::Show(args) => show::run(args, console),
        Profile::Check(args) => check::run(args, console),
    }
}
