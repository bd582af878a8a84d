//! `dialrig servo factory-reset`: a servo as it left the factory.

use clap::ValueEnum;
use rig::maintenance::Keep;

use super::{LineArgs, failed, tell};
use crate::console::Console;
use crate::failure::{Exit, Failure};

const EXAMPLES: &str = "\
Examples:
  dialrig servo factory-reset --port /dev/ttyUSB0 --baud 1000000 3 --keep id-and-baud --yes
  dialrig servo factory-reset --port /dev/ttyUSB0 --protocol sts 3 --keep id --yes";

/// A servo as it left the factory: settings, limits and offsets are lost
///
/// Switches torque off on the line. Says where the servo is then.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    line: LineArgs,
    /// Its id
    #[arg(value_name = "ID", value_parser = super::id())]
    id: u8,
    /// What stays; DYNAMIXEL 1.0 can keep nothing, Feetech keeps the id
    #[arg(long, value_enum, default_value_t = Kept::IdAndBaud)]
    keep: Kept,
    /// Yes, lose its settings
    #[arg(long)]
    yes: bool,
}

/// What stays, as it is typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kept {
    Nothing,
    Id,
    IdAndBaud,
}

impl From<Kept> for Keep {
    fn from(kept: Kept) -> Self {
        match kept {
            Kept::Nothing => Self::Nothing,
            Kept::Id => Self::Id,
            Kept::IdAndBaud => Self::IdAndBaud,
        }
    }
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    if !args.yes {
        return Err(Failure::refused(format!(
            "this erases every setting of servo {}, its limits and homing offset among them",
            args.id
        ))
        .with_hint("give --yes if that is wanted; `dialrig servo read` prints what would be lost"));
    }
    let mut line = args.line.open()?;
    let found = line.factory_reset(args.id, args.keep.into()).map_err(failed)?;
    tell(&found, console)
}
