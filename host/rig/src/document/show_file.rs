//! `show.toml`: the file that makes a folder a show. It names the parts; the parts are files of their own.
//!
//! Version 0 named the figure by its file and had a single network; it is read, never written.

use std::fmt::Write as _;
use std::path::{Component, Path};

use super::demands::Demands;
use super::fault::Findings;
use super::fields::{self, Fields, Placed, quoted};
use super::limits::FILES_MAX;
use super::show::{Show, is_file_name};
use super::source::Source;
use crate::snapshot::ViewState;

/// The version written.
pub(super) const VERSION: u64 = 1;

/// Name of the file.
pub(super) const FILE: &str = "show.toml";

/// What the file says, names still unresolved. Strings keep their place in the file for later errors.
#[derive(Debug, Default)]
pub(super) struct ShowText {
    pub(super) name: String,
    pub(super) figure: Option<Named>,
    pub(super) clips: Vec<Named>,
    pub(super) clip: Option<Named>,
    pub(super) takes: Vec<Named>,
    pub(super) networks: Vec<Named>,
    pub(super) patches: Option<Named>,
    pub(super) puppet: Option<String>,
    pub(super) demands: Demands,
    pub(super) view: Option<ViewState>,
}

/// A name with the byte it stands at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Named {
    pub(super) name: String,
    pub(super) at: usize,
}

/// The `version` of a file; a newer one than is known here is refused.
pub(super) fn version(file: &mut Fields<'_>, found: &mut Findings) -> Option<u64> {
    let value = file.required("version", found)?;
    let version = value.count(found)?;
    if version > VERSION {
        let error = value.fault(format!(
            "this file has version {version}; versions 0 to {VERSION} are known here"
        ));
        found.error(error.with_hint("it was written by a newer dialrig: update this one"));
        return None;
    }
    Some(version)
}

/// Reads `show.toml`.
pub(super) fn read(source: &Source, found: &mut Findings) -> Option<ShowText> {
    let table = fields::parse(source, found);
    if !found.errors.is_empty() {
        return None;
    }
    let mut file = Fields::of_file(source, &table);
    let text = match version(&mut file, found)? {
        0 => read_0(file, found),
        _ => read_1(file, found),
    };
    Some(text)
}

fn read_1(mut file: Fields<'_>, found: &mut Findings) -> ShowText {
    let mut text = ShowText {
        name: file
            .required("name", found)
            .and_then(|v| v.text(found))
            .unwrap_or_default()
            .to_owned(),
        figure: file.optional("figure").and_then(|v| part_name(v, found)),
        clip: file.optional("clip").and_then(|v| part_name(v, found)),
        puppet: file
            .optional("puppet")
            .and_then(|v| v.text(found))
            .map(str::to_owned),
        view: file.optional("view").and_then(|v| read_view(v, found)),
        ..ShowText::default()
    };
    let clips = file.optional("clips").map(|v| list(v, found)).unwrap_or_default();
    text.clips = clips.into_iter().filter_map(|v| part_name(v, found)).collect();
    let networks = file
        .optional("networks")
        .map(|v| list(v, found))
        .unwrap_or_default();
    text.networks = networks
        .into_iter()
        .filter_map(|v| network_path(v, found))
        .collect();
    let takes = file.optional("takes").map(|v| list(v, found)).unwrap_or_default();
    text.takes = takes.into_iter().filter_map(|v| part_name(v, found)).collect();
    text.patches = file.optional("patches").and_then(|v| network_path(v, found));
    text.demands = Demands::read(&mut file, found);
    file.finish(found);
    text
}

fn read_0(mut file: Fields<'_>, found: &mut Findings) -> ShowText {
    let mut text = ShowText {
        name: file
            .required("name", found)
            .and_then(|v| v.text(found))
            .unwrap_or_default()
            .to_owned(),
        clip: file.optional("clip").and_then(|v| part_name(v, found)),
        puppet: file
            .optional("puppet")
            .and_then(|v| v.text(found))
            .map(str::to_owned),
        ..ShowText::default()
    };
    text.figure = file.optional("figure").and_then(|value| {
        let path = value.text(found)?;
        let stem = path
            .strip_prefix("figure/")
            .and_then(|file| file.strip_suffix(".str"));
        let Some(stem) = stem.filter(|stem| is_file_name(stem)) else {
            found.error(value.fault(format!("expected \"figure/NAME.str\", found `{path}`")));
            return None;
        };
        Some(Named {
            name: stem.to_owned(),
            at: value.at,
        })
    });
    let clips = file.optional("clips").map(|v| list(v, found)).unwrap_or_default();
    text.clips = clips.into_iter().filter_map(|v| part_name(v, found)).collect();
    text.networks = file
        .optional("network")
        .and_then(|v| network_path(v, found))
        .into_iter()
        .collect();
    file.finish(found);
    text
}

fn list<'t>(value: Placed<'t>, found: &mut Findings) -> Vec<Placed<'t>> {
    let members = value.array(found).unwrap_or_default();
    if members.len() > FILES_MAX {
        found.error(value.fault(format!("{} entries; at most {FILES_MAX} are read", members.len())));
        return Vec::new();
    }
    members
}

fn part_name(value: Placed<'_>, found: &mut Findings) -> Option<Named> {
    let name = value.text(found)?;
    if is_file_name(name) {
        return Some(Named {
            name: name.to_owned(),
            at: value.at,
        });
    }
    let error = value.fault(format!("`{name}` cannot be the name of a file"));
    found.error(error.with_hint("letters, digits, spaces, `-`, `_` and inner dots are allowed"));
    None
}

/// A path relative to the show's folder. It may lead out of it, so that shipped shows can share a
/// shipped network; an absolute one would not survive being moved.
fn network_path(value: Placed<'_>, found: &mut Findings) -> Option<Named> {
    let name = value.text(found)?;
    let path = Path::new(name);
    let relative = path.components().all(|part| {
        matches!(
            part,
            Component::Normal(_) | Component::ParentDir | Component::CurDir
        )
    });
    let stem = path
        .file_stem()
        .and_then(|stem| stem.to_str())
        .unwrap_or_default();
    if !relative || path.extension().is_none_or(|extension| extension != "ps300") || !is_file_name(stem) {
        let error = value.fault(format!("`{name}` is not a relative path of a .ps300 file"));
        found.error(error.with_hint("for example \"networks/figure.ps300\""));
        return None;
    }
    Some(Named {
        name: name.to_owned(),
        at: value.at,
    })
}

fn read_view(value: Placed<'_>, found: &mut Findings) -> Option<ViewState> {
    let mut table = value.fields(found)?;
    let azimuth = table.required("azimuth_deg", found).and_then(|v| v.number(found));
    let elevation = table
        .required("elevation_deg", found)
        .and_then(|v| v.number(found));
    let scale = table.required("scale", found).and_then(|v| v.above_zero(found));
    let centre = table.required("centre", found).and_then(|v| v.vector(found));
    table.finish(found);
    Some(ViewState {
        azimuth_rad: azimuth?.to_radians(),
        elevation_rad: elevation?.to_radians(),
        scale: scale?,
        centre: centre?,
    })
}

/// `show.toml` of a show whose networks lie in its own `networks` folder.
pub(super) fn write(show: &Show) -> String {
    let mut out = format!("version = {VERSION}\nname = {}\n", quoted(&show.name));
    let mut line = |key: &str, value: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{key} = {value}");
    };
    if let Some(figure) = &show.figure {
        line("figure", quoted(&figure.name));
    }
    line("clips", strings(show.clip_names().map(quoted)));
    if !show.clip.is_empty() {
        line("clip", quoted(&show.clip));
    }
    if !show.takes.is_empty() {
        line("takes", strings(show.takes.keys().map(|name| quoted(name))));
    }
    line(
        "networks",
        strings(
            show.networks
                .iter()
                .map(|file| quoted(&format!("networks/{}.ps300", file.name))),
        ),
    );
    if !show.patches.is_empty() {
        line("patches", quoted(PATCHES));
    }
    if let Some(puppet) = &show.puppet {
        line("puppet", quoted(puppet));
    }
    show.demands.write(&mut out);
    if let Some(view) = &show.view {
        let _ = write!(
            out,
            "\n[view]\nazimuth_deg = {:?}\nelevation_deg = {:?}\nscale = {:?}\ncentre = {}\n",
            view.azimuth_rad.to_degrees(),
            view.elevation_rad.to_degrees(),
            view.scale,
            fields::vector(view.centre)
        );
    }
    out
}

/// Where the commands given while a show ran are kept.
pub(super) const PATCHES: &str = "patches.ps300";

fn strings(quoted: impl Iterator<Item = String>) -> String {
    format!("[{}]", quoted.collect::<Vec<_>>().join(", "))
}
