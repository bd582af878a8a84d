//! `dialrig figure`: a structure file's tree, warnings and totals.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use motion::{Figure, Freedom, LinkIndex};
use ps300::language::{self, Command, Definition, Name};
use rig::document::{FileError, Findings, structure};
use serde::Serialize;

use super::net::diagnostics;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::input;
use crate::number::short;
use crate::table::{Side, Table};

const EXAMPLES: &str = "\
Examples:
  dialrig figure shows/salute/figure/ar.str
  dialrig figure ar.str --pri ar.pri --shp ar.shp --json";

/// A figure's tree, warnings and totals
///
/// Shows the links of a structure file, parents first, with what is odd about them. With shape files, says which links
/// have no shape. JSON: `{"link":2,"name":"rua","parent":1,"at":[…],"dof":2,"length":0.2}`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The structure file; `-` is standard input
    #[arg(value_name = "FILE.str")]
    structure: PathBuf,
    /// Shapes that several links share
    #[arg(long, value_name = "F")]
    pri: Option<PathBuf>,
    /// The shape of each link, under the link's name
    #[arg(long, value_name = "F")]
    shp: Option<PathBuf>,
}

/// One link. `at`: where it starts in its parent's frame.
#[derive(Serialize)]
struct LinkRecord<'a> {
    link: u32,
    name: &'a str,
    parent: Option<u32>,
    at: [f64; 3],
    dof: u8,
    length: f64,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let source = input::read(&args.structure, console)?;
    let mut found = Findings::default();
    let figure = structure::read(&source, &mut found);
    if let Some(figure) = &figure {
        check_shapes(args, figure, console, &mut found);
    }
    let (figure, warnings) = found.accept(figure, &args.structure)?;
    console.warn(&warnings);
    if console.json() {
        for (index, _) in figure.links().iter().enumerate() {
            console.record(&record(&figure, index))?;
        }
    } else {
        console.table(&tree(&figure))?;
        console.line("")?;
        console.line(totals(&figure))?;
    }
    Ok(Exit::Done)
}

fn record(figure: &Figure, index: usize) -> LinkRecord<'_> {
    let link = &figure.links()[index];
    let parent = link.parent.and_then(|parent| figure.link(parent));
    LinkRecord {
        link: link.number,
        name: &link.name,
        parent: parent.map(|parent| parent.number),
        at: link.offset.to_array(),
        dof: freedoms(link.freedom),
        length: link.length,
    }
}

fn freedoms(freedom: Freedom) -> u8 {
    match freedom {
        Freedom::Two => 2,
        Freedom::Three => 3,
    }
}

/// How many links lie between each link and the root.
fn depths(figure: &Figure) -> Vec<usize> {
    let mut depths: Vec<usize> = Vec::with_capacity(figure.len());
    for link in figure.links() {
        // Parents come first.
        let above = link.parent.map(LinkIndex::index);
        depths.push(above.map_or(0, |parent| depths[parent] + 1));
    }
    depths
}

fn tree(figure: &Figure) -> Table {
    let mut table = Table::new(&[
        ("link", Side::Right),
        ("name", Side::Left),
        ("dof", Side::Right),
        ("length", Side::Right),
        ("at", Side::Left),
    ]);
    for ((index, link), depth) in figure.links().iter().enumerate().zip(depths(figure)) {
        let record = record(figure, index);
        let at = record.at.map(short).join(" ");
        table.row(vec![
            record.link.to_string(),
            format!("{}{}", "  ".repeat(depth), link.name),
            record.dof.to_string(),
            short(record.length),
            at,
        ]);
    }
    table
}

fn totals(figure: &Figure) -> String {
    let links = figure.links();
    let freedoms: u32 = links.iter().map(|link| u32::from(freedoms(link.freedom))).sum();
    let ends = links.iter().filter(|link| link.attachments.is_empty()).count();
    let depth = depths(figure).into_iter().max().map_or(0, |depth| depth + 1);
    let length: f64 = links.iter().map(|link| link.length).sum();
    format!(
        "{} links, {freedoms} degrees of freedom and the root's 3, {ends} ends, {depth} deep, lengths add up to {}",
        links.len(),
        short(length)
    )
}

/// Reads the shape files, if given; a link needs a shape of its own name to be drawn with one.
fn check_shapes(args: &Args, figure: &Figure, console: &Console, found: &mut Findings) {
    let mut defined = BTreeSet::new();
    for path in args.pri.iter().chain(&args.shp) {
        defined.extend(definitions(path, console, found));
    }
    let Some(shapes) = &args.shp else { return };
    for link in figure.links() {
        if !defined.contains(&Name::new(&link.name)) {
            let message = format!("link {} (`{}`) has no shape here", link.number, link.name);
            let warning = FileError::whole(shapes, message);
            found.warn(warning.with_hint(format!("add `{} := …;`, or it is drawn as a line", link.name)));
        }
    }
}

/// The names a file of commands defines.
fn definitions(path: &Path, console: &Console, found: &mut Findings) -> BTreeSet<Name> {
    let source = match input::read(path, console) {
        Ok(source) => source,
        Err(errors) => {
            errors.0.into_iter().for_each(|error| found.error(error));
            return BTreeSet::new();
        }
    };
    let (commands, remarks) = language::parse(source.text());
    diagnostics::note(&source, (1, 1), remarks, found);
    let name = |command| match command {
        Command::Define {
            name,
            definition: Definition::Node(_),
        } => Some(name),
        _ => None,
    };
    commands
        .into_iter()
        .filter_map(|located| name(located.what))
        .collect()
}
