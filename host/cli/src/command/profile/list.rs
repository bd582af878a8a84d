//! `dialrig profile list`: every profile's name, kind, ids and status.

use rig::profile_look;
use serde::Serialize;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;
use crate::table::{Side, Table};

const EXAMPLES: &str = "\
Examples:
  dialrig profile list
  dialrig profile list --all --json";

/// Input devices that are known, with their ids and how far each was tried
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Servos and puppets too
    #[arg(long)]
    all: bool,
}

#[derive(Serialize)]
struct Record<'a> {
    profile: &'a str,
    kind: &'a str,
    ids: &'a [String],
    status: &'a str,
    name: &'a str,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let profiles = setup::profiles()?;
    let rows = profile_look::list(&profiles, args.all);
    if console.json() {
        for row in &rows {
            console.record(&Record {
                profile: &row.profile,
                kind: &row.kind,
                ids: &row.ids,
                status: row.status,
                name: &row.name,
            })?;
        }
        return Ok(Exit::Done);
    }
    let left = |heading| (heading, Side::Left);
    let mut table = Table::new(&[
        left("profile"),
        left("kind"),
        left("name"),
        left("ids"),
        left("status"),
    ]);
    for row in rows {
        table.row(vec![
            row.profile,
            row.kind,
            row.name,
            row.ids.join(", "),
            row.status.to_owned(),
        ]);
    }
    console.table(&table)?;
    Ok(Exit::Done)
}
