//! A show folder becomes a show.
//!
//! Reads `show.toml` and then every part it names; all faults of all files are collected before giving up.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use super::bvh;
use super::clip::{ClipDoc, JointClipDoc};
use super::clip_file;
use super::fault::{FileError, FileErrors, Findings};
use super::figure::{FigureDoc, FigureTexts};
use super::save::{AUTOSAVE, take_path};
use super::show::{NetworkFile, Show};
use super::show_file::{self, Named, ShowText};
use super::source::Source;
use crate::take::Take;

/// A show that has been read.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The show.
    pub show: Show,
    /// The folder it was read from.
    pub folder: PathBuf,
    /// What was read differently from how it is written.
    pub warnings: Vec<FileError>,
    /// A folder with a newer state, kept by [`autosave`](super::autosave) and never saved; [`load`] reads
    /// it. Saving the show removes it.
    pub autosave: Option<PathBuf>,
}

/// The show folder meant by a path: the folder itself or its `show.toml`.
pub fn folder_of(path: &Path) -> PathBuf {
    if path.file_name().is_some_and(|name| name == show_file::FILE) {
        return path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty())
            .unwrap_or(Path::new("."))
            .to_path_buf();
    }
    path.to_path_buf()
}

/// Reads a show from its folder or its `show.toml`.
pub fn load(path: &Path) -> Result<Loaded, FileErrors> {
    let folder = folder_of(path);
    let file = folder.join(show_file::FILE);
    let mut found = Findings::default();
    let show = read(&folder, &file, &mut found);
    let (show, warnings) = found.accept(show, &file)?;
    let autosave = newer_autosave(&folder);
    Ok(Loaded {
        show,
        folder,
        warnings,
        autosave,
    })
}

/// Where the networks that a show folder names lie, in order.
pub(super) fn network_paths(folder: &Path) -> Vec<PathBuf> {
    let text = Source::open(&folder.join(show_file::FILE))
        .ok()
        .and_then(|source| show_file::read(&source, &mut Findings::default()));
    text.map(|text| {
        text.networks
            .iter()
            .map(|named| folder.join(&named.name))
            .collect()
    })
    .unwrap_or_default()
}

/// The name of the figure that a `show.toml` names.
pub(super) fn figure_name(show: &Path) -> Option<String> {
    let source = Source::open(show).ok()?;
    let text = show_file::read(&source, &mut Findings::default())?;
    text.figure.map(|named| named.name)
}

fn read(folder: &Path, file: &Path, found: &mut Findings) -> Option<Show> {
    let source = match Source::open(file) {
        Ok(source) => source,
        Err(error) => {
            found.error(error.with_hint("a show is a folder with a show.toml in it"));
            return None;
        }
    };
    let text = show_file::read(&source, found)?;
    let figure = text
        .figure
        .as_ref()
        .and_then(|named| read_figure(folder, named, &source, found));
    let (clips, joint_clips) = read_clips(folder, &text, figure.as_ref(), &source, found);
    let takes = read_takes(folder, &text, &source, found);
    let networks = read_networks(folder, &text, &source, found);
    let patches = text
        .patches
        .as_ref()
        .and_then(|named| open_part(&folder.join(&named.name), named, &source, found));
    let clip = current_clip(&text, &source, found);
    Some(Show {
        name: text.name,
        figure: figure.map(Arc::new),
        clips,
        joint_clips,
        clip,
        takes,
        networks,
        patches: patches.map_or_else(|| Arc::from(""), |source| Arc::from(source.text())),
        puppet: text.puppet,
        demands: text.demands,
        view: text.view,
    })
}

/// Opens a file that the show names; when it is missing, the error stands where it is named.
fn open_part(path: &Path, named: &Named, show: &Source, found: &mut Findings) -> Option<Source> {
    if !path.exists() {
        found.error(show.error(named.at, format!("there is no file {}", path.display())));
        return None;
    }
    match Source::open(path) {
        Ok(source) => Some(source),
        Err(error) => {
            found.error(error);
            None
        }
    }
}

fn read_figure(folder: &Path, named: &Named, show: &Source, found: &mut Findings) -> Option<FigureDoc> {
    let file = |extension: &str| folder.join("figure").join(format!("{}.{extension}", named.name));
    let structure = open_part(&file("str"), named, show, found)?;
    let mut optional = |extension: &str| {
        let path = file(extension);
        if path.exists() {
            open_part(&path, named, show, found)
        } else {
            None
        }
    };
    let (primitives, shapes, skeleton) = (optional("pri"), optional("shp"), optional("bvh"));
    let skeleton = skeleton.and_then(|source| match bvh::read(&source) {
        Ok((file, _)) => Some((file.skeleton, source)),
        Err(errors) => {
            errors.0.into_iter().for_each(|error| found.error(error));
            None
        }
    });
    let texts = FigureTexts {
        primitives: primitives
            .map(|source| source.text().to_owned())
            .unwrap_or_default(),
        shapes: shapes.map(|source| source.text().to_owned()).unwrap_or_default(),
    };
    let mut figure = FigureDoc::read(&named.name, &structure, texts, found)?;
    if let Some((skeleton, source)) = skeleton
        && let Err(message) = figure.set_skeleton(skeleton)
    {
        let hint = "exports will build a skeleton from the figure; delete the .bvh to be rid of this";
        found.warn(source.error(0, message).with_hint(hint));
    }
    Some(figure)
}

type Clips = (
    BTreeMap<String, Arc<ClipDoc>>,
    BTreeMap<String, Arc<JointClipDoc>>,
);

fn read_clips(
    folder: &Path,
    text: &ShowText,
    figure: Option<&FigureDoc>,
    show: &Source,
    found: &mut Findings,
) -> Clips {
    let (mut clips, mut joint_clips) = Clips::default();
    for named in &text.clips {
        let path = folder.join("clips").join(format!("{}.toml", named.name));
        let Some(source) = open_part(&path, named, show, found) else {
            continue;
        };
        let mut own = Findings::default();
        let of_joints = clip_file::is_of_joints(&source);
        if !of_joints && text.figure.is_none() {
            found.error(show.error(named.at, "a clip needs a figure; this show names none"));
            continue;
        }
        let name = named.name.clone();
        let twice = if of_joints {
            let clip = clip_file::read_joints(&source, &mut own);
            joint_clips
                .insert(name, Arc::new(clip.unwrap_or_default()))
                .is_some()
        } else {
            let clip = clip_file::read(&source, figure.map(|figure| &*figure.figure), &mut own);
            clips.insert(name, Arc::new(clip.unwrap_or_default())).is_some()
        };
        own.errors.into_iter().for_each(|error| found.error(error));
        own.warnings.into_iter().for_each(|warning| found.warn(warning));
        if twice {
            found.error(show.error(named.at, format!("clip `{}` is named twice", named.name)));
        }
    }
    warn_of_unlisted(&folder.join("clips"), text, found);
    (clips, joint_clips)
}

fn read_takes(
    folder: &Path,
    text: &ShowText,
    show: &Source,
    found: &mut Findings,
) -> BTreeMap<String, Arc<Take>> {
    let mut takes = BTreeMap::new();
    for named in &text.takes {
        let path = take_path(folder, &named.name);
        let Some(source) = open_part(&path, named, show, found) else {
            continue;
        };
        match crate::take::read(&path, source.text()) {
            Ok(take) => drop(takes.insert(named.name.clone(), Arc::new(take))),
            Err(error) => found.error(error),
        }
    }
    takes
}

/// A clip file that the show does not name is not read; that may not be meant.
fn warn_of_unlisted(clips: &Path, text: &ShowText, found: &mut Findings) {
    let mut unlisted: Vec<PathBuf> = fs::read_dir(clips)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .filter(|path| {
            !text
                .clips
                .iter()
                .any(|named| path.file_stem().is_some_and(|stem| stem == named.name.as_str()))
        })
        .collect();
    unlisted.sort();
    for path in unlisted {
        let warning = FileError::whole(&path, "this clip is not named in show.toml and is not read");
        found.warn(warning.with_hint("add it to `clips` there, or delete it"));
    }
}

fn read_networks(
    folder: &Path,
    text: &ShowText,
    show: &Source,
    found: &mut Findings,
) -> Vec<Arc<NetworkFile>> {
    let mut networks: Vec<Arc<NetworkFile>> = Vec::new();
    for named in &text.networks {
        let path = folder.join(&named.name);
        let Some(source) = open_part(&path, named, show, found) else {
            continue;
        };
        let name = path
            .file_stem()
            .map(|stem| stem.to_string_lossy().into_owned())
            .unwrap_or_default();
        if networks.iter().any(|network| network.name == name) {
            found.error(show.error(named.at, format!("two networks are called `{name}`")));
            continue;
        }
        networks.push(Arc::new(NetworkFile {
            name,
            text: source.text().to_owned(),
        }));
    }
    networks
}

fn current_clip(text: &ShowText, show: &Source, found: &mut Findings) -> String {
    match &text.clip {
        Some(named) if !text.clips.iter().any(|clip| clip.name == named.name) => {
            let known: Vec<&str> = text.clips.iter().map(|clip| clip.name.as_str()).collect();
            let error = show.error(named.at, format!("there is no clip `{}`", named.name));
            found.error(error.with_hint(format!("`clips` names: {}", known.join(", "))));
            String::new()
        }
        Some(named) => named.name.clone(),
        None => text
            .clips
            .first()
            .map(|clip| clip.name.clone())
            .unwrap_or_default(),
    }
}

/// The autosave folder if it holds a whole show written after the last save.
fn newer_autosave(folder: &Path) -> Option<PathBuf> {
    let autosave = folder.join(AUTOSAVE);
    let kept = modified(&autosave.join(show_file::FILE))?;
    let parts = [
        folder.join(show_file::FILE),
        folder.join("clips"),
        folder.join("figure"),
        folder.join("networks"),
    ];
    let saved = parts.iter().filter_map(|path| modified(path)).max()?;
    (kept >= saved).then_some(autosave)
}

fn modified(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|facts| facts.modified()).ok()
}
