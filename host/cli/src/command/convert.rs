//! `dialrig convert`: one kind of file into another, chosen by their names.

use std::path::PathBuf;

use rig::document::convert::convert;
use serde::Serialize;

use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Examples:
  dialrig convert walk.bvh walk             a show folder made from motion capture
  dialrig convert shows/salute salute.bvh   and back
  dialrig convert shows/salute salute.csv   where every link is at every frame";

/// One kind of file into another, by their names
///
/// Show folders (no extension), .bvh and .str in; show folders, .bvh and .csv out. Nothing is written unless all could
/// be read.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A show folder, its show.toml, .bvh or .str
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// A show folder (no extension), .bvh or .csv
    #[arg(value_name = "OUT")]
    output: PathBuf,
}

/// What was written.
#[derive(Serialize)]
struct Wrote {
    wrote: String,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let converted = convert(&args.input, &args.output)?;
    console.warn(&converted.warnings);
    let wrote = args.output.display().to_string();
    if console.json() {
        console.record(&Wrote { wrote })?;
    } else {
        console.remark(format_args!("wrote {wrote}"));
    }
    Ok(Exit::Done)
}
