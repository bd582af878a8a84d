//! The command line as a whole: options every command has, and the list of commands.

use std::path::PathBuf;

use clap::{ArgAction, Parser};

use crate::command::Command;

const EXAMPLES: &str = "\
Examples:
  dialrig                             the studio, with the shipped example and simulated hardware
  dialrig demo                        the whole chain as a film, no display needed
  dialrig play shows/salute --port /dev/ttyUSB0 --port /dev/ttyUSB1
  dialrig figure shows/salute/figure/ar.str
  dialrig sample shows/salute --fps 30 > salute.jsonl
  dialrig net run networks/figure.ps300 --dial 1:0.25@0.5 --watch 'turn<1>'

Exit codes: 0 done; 1 refused or failed; 2 wrong usage; 3 ended by a device fault, safely;
4 ended by a device fault, and it is not known whether torque is off.";

/// Either a show or a command; options go before or behind it.
const USAGE: &str = "dialrig [OPTIONS] [SHOW]\n       dialrig [OPTIONS] <COMMAND>";

/// Pose articulated figures with physical controls; play them on screen and on servo puppets.
#[derive(Debug, Parser)]
#[command(name = "dialrig", version, after_help = EXAMPLES, override_usage = USAGE)]
pub(crate) struct Args {
    /// A show folder or its show.toml, opened in the studio; the shipped example when left out
    #[arg(value_name = "SHOW")]
    pub(crate) show: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) showing: Showing,
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

/// How results and remarks are shown.
#[derive(Clone, Copy, Debug, clap::Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct Showing {
    /// One JSON object a line on standard output; errors as JSON too
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// No progress, warnings or remarks; errors only
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// More about what is done, on standard error; twice for debugging
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub(crate) verbose: u8,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn every_command_shows_an_example() {
        fn visit(command: &clap::Command) {
            let help = command.get_after_help().map(ToString::to_string);
            let name = command.get_name();
            assert!(
                help.is_some_and(|help| help.contains("dialrig")),
                "`{name} --help` has no example"
            );
            command.get_subcommands().for_each(visit);
        }
        visit(&Args::command());
    }
}
