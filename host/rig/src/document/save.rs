//! A show becomes a folder again, whole or not at all.
//!
//! What is saved stands on its own: networks that were shared by reference are written into the show.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use super::bvh;
use super::clip_file;
use super::disk::{Disk, NewFile, RealDisk, Unchanged, put_all};
use super::fault::{FileError, FileErrors};
use super::show::{Show, is_file_name};
use super::show_file;
use super::source::cannot;

/// Folder inside a show for the state that has not been saved.
pub(super) const AUTOSAVE: &str = ".autosave";

/// Writes the show to `folder`, making it if need be, and removes the autosave. On an error the folder is
/// as it was.
pub fn save(show: &Show, folder: &Path) -> Result<(), FileErrors> {
    save_through(&mut RealDisk, show, folder)
}

/// Whether something can be written into a folder, which is made if need be: to be asked before hours of work, not after.
pub fn can_be_saved(folder: &Path) -> Result<(), FileError> {
    let mut disk = RealDisk;
    let tried = disk.make_folder(folder).and_then(|()| {
        let aside = disk.write_aside(folder, "")?;
        disk.remove(&aside)
    });
    tried.map_err(|error| cannot(folder, "write into", &error))
}

/// The files a show is saved as: path inside the show folder, with forward slashes, to text.
pub fn texts(show: &Show) -> Result<BTreeMap<String, String>, FileErrors> {
    let file = |file: NewFile| (file.path.to_string_lossy().replace('\\', "/"), file.text);
    Ok(files(show, Path::new(""))?.into_iter().map(file).collect())
}

/// The show that such files make; they are put into a folder of their own for the reading.
pub fn from_texts(texts: &BTreeMap<String, String>) -> Result<Show, FileErrors> {
    let nowhere = Path::new("the files of a show");
    let folder = tempfile::tempdir().map_err(|error| cannot(nowhere, "unpack", &error))?;
    let unpack = |(path, text): (&String, &String)| {
        let inside = Path::new(path)
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if !inside {
            return Err(FileError::whole(
                Path::new(path),
                "a file of a show must lie inside its folder",
            ));
        }
        let path = folder.path().join(path);
        let parent = path.parent().unwrap_or(folder.path());
        fs::create_dir_all(parent)
            .and_then(|()| fs::write(&path, text))
            .map_err(|error| cannot(&path, "write", &error))
    };
    texts.iter().try_for_each(unpack)?;
    super::load(folder.path()).map(|loaded| loaded.show)
}

/// The same through a given [`Disk`].
pub fn save_through(disk: &mut dyn Disk, show: &Show, folder: &Path) -> Result<(), FileErrors> {
    put_all(disk, files(show, folder)?, Unchanged::Keep)?;
    // The show is safe now. An autosave that cannot be removed is older than it and is not offered again.
    let _ = fs::remove_dir_all(folder.join(AUTOSAVE));
    Ok(())
}

/// Keeps the show inside its own folder without touching what was saved; [`load`](super::load) offers it
/// if the show is never saved.
pub fn autosave(show: &Show, folder: &Path) -> Result<(), FileErrors> {
    let kept = folder.join(AUTOSAVE);
    // The time of its `show.toml`, which comes last, says when the autosave was made.
    put_all(&mut RealDisk, files(show, &kept)?, Unchanged::Rewrite)?;
    Ok(())
}

/// Throws the autosave away, for a person who does not want it.
pub fn discard_autosave(folder: &Path) -> Result<(), FileErrors> {
    let kept = folder.join(AUTOSAVE);
    if !kept.exists() {
        return Ok(());
    }
    fs::remove_dir_all(&kept).map_err(|error| cannot(&kept, "remove", &error).into())
}

/// All files of a show; `show.toml`, which names the others, comes last.
fn files(show: &Show, folder: &Path) -> Result<Vec<NewFile>, FileErrors> {
    check_names(show, folder)?;
    let mut files = Vec::new();
    let mut add = |path: PathBuf, text: String| files.push(NewFile { path, text });
    if let Some(figure) = &show.figure {
        let path = |extension: &str| folder.join("figure").join(format!("{}.{extension}", figure.name));
        add(path("str"), figure.structure.to_string());
        for (extension, text) in [("pri", &figure.primitives), ("shp", &figure.shapes)] {
            if !text.is_empty() {
                add(path(extension), text.to_string());
            }
        }
        if let Some(skeleton) = &figure.skeleton {
            add(path("bvh"), bvh::skeleton_text(skeleton));
        }
        for (name, clip) in &show.clips {
            let text = clip_file::write(clip, &figure.figure);
            add(folder.join("clips").join(format!("{name}.toml")), text);
        }
    }
    for (name, clip) in &show.joint_clips {
        add(
            folder.join("clips").join(format!("{name}.toml")),
            clip_file::write_joints(clip),
        );
    }
    for (name, take) in &show.takes {
        add(take_path(folder, name), crate::take::write(take));
    }
    for network in &show.networks {
        add(
            folder.join("networks").join(format!("{}.ps300", network.name)),
            network.text.clone(),
        );
    }
    if !show.patches.is_empty() {
        add(folder.join(show_file::PATCHES), show.patches.to_string());
    }
    add(folder.join(show_file::FILE), show_file::write(show));
    Ok(files)
}

/// Where a take is kept.
pub(super) fn take_path(folder: &Path, name: &str) -> PathBuf {
    folder.join("takes").join(format!("{name}.toml"))
}

/// Names become file names; a name that cannot is refused before anything is written.
fn check_names(show: &Show, folder: &Path) -> Result<(), FileErrors> {
    let figure = show.figure.iter().map(|figure| figure.name.as_str());
    let clips = show.clip_names().chain(show.takes.keys().map(String::as_str));
    let networks = show.networks.iter().map(|network| network.name.as_str());
    let fault = |name: &str| {
        let error = FileError::whole(folder, format!("`{name}` cannot be the name of a file"));
        error.with_hint("rename it: letters, digits, spaces, `-`, `_` and inner dots are allowed")
    };
    let bad: Vec<FileError> = figure
        .chain(clips)
        .chain(networks)
        .filter(|name| !is_file_name(name))
        .map(fault)
        .collect();
    if bad.is_empty() {
        Ok(())
    } else {
        Err(FileErrors(bad))
    }
}
