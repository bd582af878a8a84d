//! `dialrig replay`: an exchange played through the codec.

use std::path::PathBuf;

use rig::capture;
use rig::document::FileErrors;
use rig::listen::InputEvent;

use crate::console::Console;
use crate::event_lines::EventLines;
use crate::failure::{Exit, Failure};
use crate::{input, setup};

const EXAMPLES: &str = "\
Examples:
  dialrig replay box.txt
  dialrig replay box.txt --profile sgi-dialbox-display --json";

/// An exchange file, played back through the codec
///
/// Writes the events as `monitor` does. Where the file tells events or what the host says, they must be the same; else
/// the differences are told with their lines, and it ends with 1.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The exchange; `-` is standard input
    file: PathBuf,
    /// Another profile than the file's
    #[arg(long, value_name = "NAME")]
    profile: Option<String>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let profiles = setup::profiles()?;
    let source = input::read(&args.file, console)?;
    let played =
        capture::replay(&args.file, source.text(), args.profile.as_deref(), &profiles).map_err(FileErrors)?;
    let mut lines = EventLines::new(console, played.teller);
    for heard in &played.events {
        match heard.what {
            InputEvent::Started => console.remark("the device answers"),
            InputEvent::Restarted => console.remark("the device was switched off and on"),
            _ => lines.tell(heard.at_secs, &heard.what)?,
        }
    }
    console.flush()?;
    if played.differences.is_empty() {
        return Ok(Exit::Done);
    }
    Err(FileErrors(played.differences).into())
}
