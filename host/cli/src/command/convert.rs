//! `dialrig convert`: one kind of file into another, chosen by their names.

use std::path::PathBuf;

use rig::document::convert::{convert, convert_robot};
use serde::Serialize;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig convert walk.bvh walk             a show folder made from motion capture
  dialrig convert shows/salute salute.bvh   and back
  dialrig convert shows/salute salute.csv   where every link is at every frame
  dialrig convert arm.urdf my-arm.toml --map arm-servos.toml   a puppet profile from a robot's description";

/// One kind of file into another, by their names
///
/// Show folders (no extension), .bvh and .str in; show folders, .bvh and .csv out. With --map a robot's .urdf becomes
/// a puppet profile. Nothing is written unless all could be read.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A show folder, its show.toml, .bvh, .str or .urdf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// A show folder (no extension), .bvh or .csv; for a .urdf the profile's .toml
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Which servo turns which joint of a .urdf
    #[arg(long, value_name = "MAP.toml")]
    map: Option<PathBuf>,
}

/// What was written.
#[derive(Serialize)]
struct Wrote {
    wrote: String,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let converted = match &args.map {
        Some(map) => convert_robot(&args.input, map, &args.output, &*setup::profiles()?)?,
        None => convert(&args.input, &args.output)?,
    };
    console.warn(&converted.warnings);
    let wrote = args.output.display().to_string();
    if console.json() {
        console.record(&Wrote { wrote })?;
    } else {
        console.remark(format_args!("wrote {wrote}"));
    }
    Ok(Exit::Done)
}
