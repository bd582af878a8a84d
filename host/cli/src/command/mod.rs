//! The commands: one a file, each with its `Args` (options, help, example) and a `run`.

mod check;
mod convert;
mod curve;
mod figure;
mod net;
mod sample;

use clap::Subcommand;

use crate::console::Console;
use crate::failure::{Exit, Failure};

/// Everything that can be asked for.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Where everything is over time, without drawing
    Sample(sample::Args),
    /// Everything that is wrong with files
    Check(check::Args),
    /// One kind of file into another, by their names
    Convert(convert::Args),
    /// A figure's tree, warnings and totals
    Figure(figure::Args),
    /// Curves through and along points
    Curve(curve::Args),
    /// Function networks without devices: run, check, print, draw, look up
    Net(net::Args),
}

impl Command {
    /// Does what was asked for.
    pub(crate) fn run(&self, console: &Console) -> Result<Exit, Failure> {
        match self {
            Self::Sample(args) => sample::run(args, console),
            Self::Check(args) => check::run(args, console),
            Self::Convert(args) => convert::run(args, console),
            Self::Figure(args) => figure::run(args, console),
            Self::Curve(args) => curve::run(args, console),
            Self::Net(args) => net::run(args, console),
        }
    }
}
