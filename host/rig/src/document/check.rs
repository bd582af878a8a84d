//! Checking a file without opening it in the rig: everything that is wrong with it at once.

use std::path::Path;

use device_profiles::{ProfileError, Profiles};
use ps300::language::{self, Diagnostic, Severity};

use super::bvh;
use super::clip_file;
use super::fault::{FileError, FileErrors, Findings};
use super::figure::{FigureDoc, FigureTexts};
use super::folder;
use super::show::Show;
use super::source::Source;
use super::structure;
use crate::controls::assumed::assume_devices;
use crate::journal::{JournalError, Script};
use crate::wiring::machine_for;

/// Checks a show folder, `show.toml`, `.str`, `.pri`, `.shp`, `.ps300`, `.bvh`, a journal, or the `.toml` of a clip or
/// a hardware profile.
pub fn check_file(path: &Path) -> Findings {
    let mut found = Findings::default();
    let extension = path
        .extension()
        .map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        _ if path.is_dir() => check_show(path, &mut found),
        Some("toml") if path.file_name().is_some_and(|name| name == "show.toml") => {
            check_show(path, &mut found);
        }
        Some("toml") => with_source(path, &mut found, check_toml),
        Some("str") => with_source(path, &mut found, |source, found| {
            structure::read(source, found);
        }),
        Some("pri" | "shp" | "ps300") => with_source(path, &mut found, check_network),
        Some("bvh") => with_source(path, &mut found, check_bvh),
        Some("jsonl") => with_source(path, &mut found, check_journal),
        _ => {
            let error = FileError::whole(path, "this is no kind of file that is known here");
            found.error(error.with_hint("known: a show folder, .toml (clip, profile), .str, .pri, .shp, .ps300, .bvh, .jsonl (journal), .scn"));
        }
    }
    found
        .errors
        .sort_by_key(|error| (error.file.clone(), error.line, error.column));
    found
}

fn with_source(path: &Path, found: &mut Findings, check: impl FnOnce(&Source, &mut Findings)) {
    match Source::open(path) {
        Ok(source) => check(&source, found),
        Err(error) => found.error(error),
    }
}

fn take(errors: FileErrors, found: &mut Findings) {
    errors.0.into_iter().for_each(|error| found.error(error));
}

fn check_show(path: &Path, found: &mut Findings) {
    match folder::load(path) {
        Ok(loaded) => {
            found.warnings.extend(loaded.warnings);
            check_parts(&loaded.show, &loaded.folder, found);
        }
        Err(errors) => take(errors, found),
    }
}

/// What is only judged when a show is played: its networks, and whether its clips can be built.
fn check_parts(show: &Show, folder: &Path, found: &mut Findings) {
    check_networks(show, folder, found);
    if let Some(figure) = &show.figure {
        for (extension, text) in [("pri", &*figure.primitives), ("shp", &*figure.shapes)] {
            let path = folder.join("figure").join(format!("{}.{extension}", figure.name));
            check_network(&Source::from_text(&path, text), found);
        }
    }
    let Some(figure) = &show.figure else { return };
    for (name, clip) in &show.clips {
        let path = folder.join("clips").join(format!("{name}.toml"));
        match clip.clip(&figure.figure) {
            Err(error) => found.error(FileError::whole(&path, error.to_string())),
            Ok(None) => found.warn(FileError::whole(&path, "this clip has no keys")),
            Ok(Some(built)) => {
                built
                    .warnings()
                    .iter()
                    .for_each(|warning| found.warn(FileError::whole(&path, warning.to_string())));
                for stretch in built.kinetics().reversals() {
                    let message = format!(
                        "the motion runs backwards from {:.3} s to {:.3} s",
                        stretch.start, stretch.end
                    );
                    let hint = "use kinetics = \"monotone\", or move the keys";
                    found.warn(FileError::whole(&path, message).with_hint(hint));
                }
            }
        }
    }
}

/// The networks as the rig loads them, one after the other into one machine: names and kinds are judged too.
fn check_networks(show: &Show, folder: &Path, found: &mut Findings) {
    let (mut machine, _) = machine_for(show);
    let paths = folder::network_paths(folder);
    let networks = paths
        .into_iter()
        .zip(show.networks.iter().map(|network| network.text.as_str()));
    let texts: Vec<_> = networks
        .chain([(folder.join("patches.ps300"), &*show.patches)])
        .collect();
    // Which devices the show will meet, and what its puppet's joints are called, is not known here.
    let commands: Vec<_> = texts
        .iter()
        .flat_map(|(_, text)| language::parse(text).0)
        .collect();
    assume_devices(&mut machine, &commands);
    for (path, text) in texts {
        let remarks = machine.load(text);
        note(&Source::from_text(&path, text), remarks, found);
    }
}

/// A text of the language by itself. What it refers to may be defined elsewhere.
fn check_network(source: &Source, found: &mut Findings) {
    let (_, diagnostics) = language::parse(source.text());
    note(source, diagnostics, found);
}

fn note(source: &Source, diagnostics: Vec<Diagnostic>, found: &mut Findings) {
    for diagnostic in diagnostics {
        let mut message = diagnostic.message;
        if let Some(expected) = diagnostic.expected {
            message.push_str("; expected ");
            message.push_str(&expected);
        }
        let mut error = source.error_at((diagnostic.line, diagnostic.column), message);
        error.hint = diagnostic.hint;
        match diagnostic.severity {
            Severity::Error => found.error(error),
            Severity::Warning => found.warn(error),
        }
    }
}

fn check_bvh(source: &Source, found: &mut Findings) {
    match bvh::import(source, "checked") {
        Ok(imported) => found.warnings.extend(imported.warnings),
        Err(errors) => take(errors, found),
    }
}

/// Clips and shows carry a version; hardware profiles are known by their tables.
fn check_toml(source: &Source, found: &mut Findings) {
    // With a broken profile among the user's own, that one is what he is told of when he checks it.
    let known = crate::shipped::profiles(crate::shipped::user_profiles_folder().as_deref())
        .unwrap_or_else(|_| Profiles::builtin());
    match device_profiles::read_file_among(source.path(), &known) {
        Ok(_) => {}
        Err(errors)
            if errors
                .iter()
                .any(|e| matches!(e, ProfileError::UnknownKind { .. })) =>
        {
            check_clip(source, found);
        }
        // A text that is no TOML at all is judged as what its folder says it is.
        Err(_)
            if source
                .path()
                .parent()
                .is_some_and(|folder| folder.ends_with("clips")) =>
        {
            check_clip(source, found);
        }
        Err(errors) => errors
            .iter()
            .for_each(|error| found.error(of_profile(source, error))),
    }
}

fn of_profile(source: &Source, error: &ProfileError) -> FileError {
    match error {
        ProfileError::Syntax {
            line,
            column,
            message,
            ..
        }
        | ProfileError::Contradiction {
            line,
            column,
            message,
            ..
        } => source.error_at((*line as u32, *column as u32), message.clone()),
        other => FileError::whole(source.path(), other.to_string()),
    }
}

fn check_journal(source: &Source, found: &mut Findings) {
    match Script::parse(source.text()) {
        Ok(script) if script.ending.is_none() => {
            let words = "the journal has no end record: it was cut, or is still being written";
            found.warn(FileError::whole(source.path(), words));
        }
        Ok(_) => {}
        Err(JournalError::Line { line, found: what }) => {
            found.error(source.error_at(
                (line as u32, 1),
                format!("expected a journal record, found {what}"),
            ));
        }
        Err(other) => found.error(FileError::whole(source.path(), other.to_string())),
    }
}

/// A clip is checked against the figure of the show it lies in, if it lies in one.
fn check_clip(source: &Source, found: &mut Findings) {
    let show = source
        .path()
        .parent()
        .and_then(Path::parent)
        .map(|folder| folder.join("show.toml"));
    if clip_file::is_of_joints(source) {
        clip_file::read_joints(source, found);
        return;
    }
    let figure = show
        .filter(|show| show.exists())
        .and_then(|show| figure_beside(&show));
    if figure.is_none() {
        let warning = source.error_at((1, 1), "there is no readable show around this clip");
        found.warn(warning.with_hint("the names of its links are not checked"));
    }
    clip_file::read(source, figure.as_ref().map(|figure| &*figure.figure), found);
}

/// The figure a show names, for its link names; faults in it are the show's affair.
fn figure_beside(show: &Path) -> Option<FigureDoc> {
    let name = folder::figure_name(show)?;
    let structure = Source::open(&show.parent()?.join("figure").join(format!("{name}.str"))).ok()?;
    FigureDoc::read(
        &name,
        &structure,
        FigureTexts::default(),
        &mut Findings::default(),
    )
}
