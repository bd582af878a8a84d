//! `dialrig net dot`: a network as a drawing.

use std::path::PathBuf;

use rig::document::Findings;

use super::{diagnostics, program};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Examples:
  dialrig net dot networks/figure.ps300 | dot -Tsvg > figure.svg";

/// A drawing for graphviz
///
/// Functions, display nodes and connections as a digraph.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// Network files, loaded one after the other; `-` is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut found = Findings::default();
    let machine = program::load(&args.files, console, &mut found);
    diagnostics::settle(found, console)?;
    console.line(machine.dot().trim_end())?;
    Ok(Exit::Done)
}
