//! `dialrig curve`: curves through and along points.

mod fit;
mod kind;
mod length;
mod points;
mod sample;

use std::path::PathBuf;

use clap::Subcommand;

use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Examples:
  dialrig curve fit points.csv
  dialrig curve fit points.csv --order 4 --json | dialrig curve sample - --count 20
  printf '0,0\\n1,2\\n3,1\\n' | dialrig curve sample - --count 5";

/// Curves through and along points
///
/// Without `--order`, the natural cubic that passes through the points over chord length; with it, the uniform B-spline
/// of that order with the points as control points.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Fit(fit::Args),
    Sample(sample::Args),
    Length(length::Args),
}

/// Which curve.
#[derive(Debug, clap::Args)]
struct CurveArgs {
    /// Points, one to three coordinates each: CSV, a JSON array, or what `curve fit --json` wrote; `-` is
    /// standard input
    #[arg(value_name = "POINTS")]
    points: PathBuf,
    /// The B-spline of this order (degree plus one) instead of the curve through the points
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=64))]
    order: Option<u32>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    match &args.command {
        Command::Fit(args) => fit::run(args, console),
        Command::Sample(args) => sample::run(args, console),
        Command::Length(args) => length::run(args, console),
    }
}
