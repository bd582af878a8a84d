//! A robot's URDF and a short mapping file become a puppet profile: geometry, limits and masses from the one,
//! servos from the other.
//!
//! Every joint that turns must have a servo in the mapping or be named rigid there, so that nothing is left out
//! unsaid. Parts joined by fixed joints become one link; a mimic joint becomes a coupling.
//! Source: wiki.ros.org/urdf/XML (link, joint, mimic); frames are kept as they are, x forward, z up (REP 103).

mod build;
mod map;
mod tree;

use std::path::Path;

use device_profiles::{Profiles, PuppetProfile, read_file_among};

use super::fault::{FileError, FileErrors, Findings};
use super::source::{Source, cannot};
use map::Map;
use tree::Tree;

/// Most links of a robot; more is no puppet.
const LINKS_MAX: usize = 1000;

/// A robot read, and what was left out of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The profile, checked.
    pub profile: PuppetProfile,
    /// The same as a file.
    pub text: String,
    /// What was read differently from how it is written.
    pub warnings: Vec<FileError>,
}

/// Reads a URDF file with its mapping. Errors stand in the file where they can be mended.
/// `profiles` knows the servos.
pub fn import(urdf: &Path, map: &Path, profiles: &Profiles) -> Result<Imported, FileErrors> {
    let (urdf, map) = (Source::open(urdf)?, Source::open(map)?);
    let mut found = Findings::default();
    let mapping = Map::read(&map, &mut found);
    let tree = Tree::read(&urdf, &mut found);
    let profile = match (mapping, tree) {
        (Some(mapping), Some(tree)) => build::profile(&tree, &mapping, &mut found),
        _ => None,
    };
    let (profile, warnings) = found.accept(profile, urdf.path())?;
    let text = text(&profile, urdf.path(), map.path(), profiles)?;
    Ok(Imported {
        profile,
        text,
        warnings,
    })
}

/// The profile as a file that the program reads again.
fn text(profile: &PuppetProfile, urdf: &Path, map: &Path, profiles: &Profiles) -> Result<String, FileErrors> {
    let written = toml::to_string(profile)
        .map_err(|error| FileError::whole(urdf, format!("the profile cannot be written: {error}")))?;
    let name = |path: &Path| {
        path.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let text = format!(
        "# Made from {} and {}. zero_counts and sign are the mapping's word; calibrate before the first move.\n{written}",
        name(urdf),
        name(map)
    );
    // What a profile must be is judged by those who read it.
    let folder = tempfile::tempdir().map_err(|error| cannot(map, "check", &error))?;
    let path = folder.path().join("puppet.toml");
    std::fs::write(&path, &text).map_err(|error| cannot(&path, "write", &error))?;
    match read_file_among(&path, profiles) {
        Ok(_) => Ok(text),
        Err(errors) => Err(FileErrors(
            errors
                .iter()
                .map(|error| {
                    let words = error.to_string();
                    // The place is in a file that nobody sees.
                    let words = words
                        .split_once(": ")
                        .map_or(words.clone(), |(_, rest)| rest.to_owned());
                    FileError::whole(map, format!("this makes no puppet: {words}"))
                })
                .collect(),
        )),
    }
}
