//! Putting files in place so that a reader sees the old text or the new one, never a piece.
//!
//! Every file is first written beside its final place and flushed; only when all of them are there are
//! they renamed. A rename that fails undoes the ones before it. Behind a trait so that tests can fail the
//! n-th operation.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::fault::FileError;
use super::source::cannot;

/// The operations saving needs. [`RealDisk`] is the only implementation outside tests.
pub trait Disk {
    /// Makes a folder and those above it.
    fn make_folder(&mut self, folder: &Path) -> io::Result<()>;
    /// Writes a new file in `folder` under a name of its own, flushed to the device.
    fn write_aside(&mut self, folder: &Path, text: &str) -> io::Result<PathBuf>;
    /// Moves a file onto another in the same folder, replacing it in one go.
    fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()>;
    /// Removes a file.
    fn remove(&mut self, file: &Path) -> io::Result<()>;
}

/// The file system.
#[derive(Clone, Copy, Debug, Default)]
pub struct RealDisk;

impl Disk for RealDisk {
    fn make_folder(&mut self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)
    }

    fn write_aside(&mut self, folder: &Path, text: &str) -> io::Result<PathBuf> {
        let mut file = tempfile::Builder::new().prefix(".writing-").tempfile_in(folder)?;
        readable_by_others(file.as_file())?;
        file.write_all(text.as_bytes())?;
        file.as_file().sync_all()?;
        let (_, path) = file.keep().map_err(|error| error.error)?;
        Ok(path)
    }

    fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)?;
        sync_folder(to)
    }

    fn remove(&mut self, file: &Path) -> io::Result<()> {
        fs::remove_file(file)
    }
}

/// Temporary files are private by default; a show is a document like any other.
#[cfg(unix)]
fn readable_by_others(file: &fs::File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_others(_: &fs::File) -> io::Result<()> {
    Ok(())
}

/// A rename is only safe from a power cut once the folder itself is flushed.
#[cfg(unix)]
fn sync_folder(file: &Path) -> io::Result<()> {
    fs::File::open(folder_of(file))?.sync_all()
}

/// The folder a file is in; a bare name is in the working folder.
fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// A file to be put in place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NewFile {
    pub(super) path: PathBuf,
    pub(super) text: String,
}

/// A file written beside its place, with what it will replace.
struct Aside {
    path: PathBuf,
    temporary: PathBuf,
    before: Option<String>,
}

/// What to do with files that hold the right text already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unchanged {
    /// Leave them alone.
    Keep,
    /// Write them again, so that their times say when.
    Rewrite,
}

/// Puts all files in place or none; `files` are renamed in the order given. After an error the folder is as it was, unless undoing failed as well; even then every
/// file is whole, old or new.
pub(super) fn put_all(
    disk: &mut dyn Disk,
    files: Vec<NewFile>,
    unchanged: Unchanged,
) -> Result<(), FileError> {
    let differs = |file: &NewFile| fs::read(&file.path).ok().as_deref() != Some(file.text.as_bytes());
    let wanted = |file: &NewFile| unchanged == Unchanged::Rewrite || differs(file);
    let mut aside = Vec::new();
    for file in files.into_iter().filter(wanted) {
        match write_one(disk, &file) {
            Ok(written) => aside.push(written),
            Err(error) => {
                discard(disk, &aside);
                return Err(cannot(&file.path, "write", &error).with_hint("nothing has been changed on disk"));
            }
        }
    }
    for (done, file) in aside.iter().enumerate() {
        if let Err(error) = disk.rename(&file.temporary, &file.path) {
            discard(disk, &aside[done..]);
            restore(disk, &aside[..=done]);
            return Err(cannot(&file.path, "replace", &error).with_hint("what was on disk before is kept"));
        }
    }
    Ok(())
}

fn write_one(disk: &mut dyn Disk, file: &NewFile) -> io::Result<Aside> {
    let folder = folder_of(&file.path);
    disk.make_folder(folder)?;
    let before = fs::read_to_string(&file.path).ok();
    let temporary = disk.write_aside(folder, &file.text)?;
    Ok(Aside {
        path: file.path.clone(),
        temporary,
        before,
    })
}

/// Takes temporary files away again. A failure leaves a stray hidden file and harms nothing.
fn discard(disk: &mut dyn Disk, aside: &[Aside]) {
    for file in aside {
        if file.temporary.exists() {
            let _ = disk.remove(&file.temporary);
        }
    }
}

/// Brings back what had been replaced, last first. The error that led here is the one reported.
fn restore(disk: &mut dyn Disk, replaced: &[Aside]) {
    for file in replaced.iter().rev() {
        match &file.before {
            Some(text) => {
                let folder = folder_of(&file.path);
                if let Ok(temporary) = disk.write_aside(folder, text) {
                    let _ = disk.rename(&temporary, &file.path);
                }
            }
            None if file.path.exists() => {
                let _ = disk.remove(&file.path);
            }
            None => {}
        }
    }
}

/// Puts one file in place, whole or not at all.
pub(super) fn put(path: &Path, text: String) -> Result<(), FileError> {
    let file = NewFile {
        path: path.to_path_buf(),
        text,
    };
    put_all(&mut RealDisk, vec![file], Unchanged::Keep)
}
