//! `dialrig profile check`: everything that is wrong with profiles, also beside those there are.

use std::path::PathBuf;

use rig::document::Findings;
use rig::profile_look;

use crate::command::check::report;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

/// Everything that is wrong with a profile, also that it claims a device of another
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: dialrig profile check my-tablet.toml")]
pub(crate) struct Args {
    /// Files of profiles
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let profiles = setup::profiles()?;
    let mut found = Findings::default();
    for file in &args.files {
        let here = profile_look::check(file, &profiles);
        found.errors.extend(here.errors);
        found.warnings.extend(here.warnings);
    }
    report(&found, console)?;
    if found.errors.is_empty() {
        console.remark("in order");
        Ok(Exit::Done)
    } else {
        Ok(Exit::Refused)
    }
}
