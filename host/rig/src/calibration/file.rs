//! The puppet's profile in the user's folder: where it is, its text, and putting it there whole.

use std::io::Write;
use std::path::{Path, PathBuf};

use device_profiles::PuppetProfile;

use super::CalibrationError;

/// Where the user's profile of a puppet is: the file that is there already, wherever below the folder, or a new one.
pub(super) fn place(folder: &Path, key: &str) -> PathBuf {
    let name = format!("{key}.toml");
    find(folder, &name).unwrap_or_else(|| folder.join("puppets").join(name))
}

fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .collect();
    entries.sort();
    let here = entries.iter().find(|path| {
        path.file_name()
            .is_some_and(|found| found.eq_ignore_ascii_case(name))
    });
    here.cloned().or_else(|| {
        let folders = entries.iter().filter(|path| path.is_dir());
        folders.into_iter().find_map(|inner| find(inner, name))
    })
}

/// A profile as a file has it.
pub fn profile_text(puppet: &PuppetProfile) -> Result<String, CalibrationError> {
    let text =
        toml::to_string(puppet).map_err(|error| CalibrationError::file(Path::new(&puppet.key), &error))?;
    Ok(format!(
        "# Written by `dialrig servo calibrate`. Zeros, signs and ranges are those of this very puppet.\n{text}"
    ))
}

/// Puts a file in its place whole: written beside it, flushed, renamed.
pub(super) fn put(path: &Path, text: &str) -> Result<(), CalibrationError> {
    let put = || -> std::io::Result<()> {
        let folder = path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder)?;
        let mut file = tempfile::NamedTempFile::new_in(folder)?;
        file.write_all(text.as_bytes())?;
        file.as_file().sync_all()?;
        file.persist(path).map_err(|error| error.error)?;
        Ok(())
    };
    put().map_err(|error| CalibrationError::file(path, &error))
}
