//! `dialrig`: everything the project does, from a terminal or a script.
//!
//! *Knows* the commands and their options, exit codes, and how results are shown to people and programs.
//! *Must not know* how anything is computed: that is the other crates' affair; nor devices or servos beyond
//! what `rig` and `bench` offer.
//! *Start reading* at [`args`], then any file of [`command`]: one command a file, each an `Args` and a `run`.

mod args;
mod command;
mod console;
mod event_lines;
mod failure;
mod guard;
mod input;
mod interrupt;
mod number;
mod setup;
mod table;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};

use console::Console;

fn main() -> ExitCode {
    let args = args::Args::parse();
    if let Some(word) = args.show.as_ref().filter(|show| !show.exists()) {
        let message = format!(
            "`{}` is neither a command nor a show that is there",
            word.display()
        );
        args::Args::command()
            .error(ErrorKind::InvalidSubcommand, message)
            .exit();
    }
    if let (Some(show), Some(_)) = (&args.show, &args.command) {
        let message = format!(
            "a show to open (`{}`) and a command cannot be given together",
            show.display()
        );
        args::Args::command()
            .error(ErrorKind::ArgumentConflict, message)
            .exit();
    }
    let console = Console::new(args.showing);
    let result = match &args.command {
        Some(command) => command.run(&console),
        None => command::studio::run(args.show.as_ref(), &console),
    };
    console.finish(result).into()
}
