//! `dialrig profile show`: one profile as its file would have it.

use rig::profile_look;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig profile show sgi-dialbox
  dialrig profile show sgi-dialbox > ~/.config/dialrig/profiles/sgi-dialbox.toml   to begin one's own with";

/// One profile as text, an input device's layout behind it
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Key or name, as `dialrig profile list --all` has it
    name: String,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let profiles = setup::profiles()?;
    let text = profile_look::text(&profiles, &args.name).map_err(Failure::refused)?;
    console.line(text.trim_end())?;
    Ok(Exit::Done)
}
