//! Converting between the kinds of file a show can come from or become, chosen by their names.

use std::path::{Path, PathBuf};

use device_profiles::Profiles;

use super::bvh;
use super::csv;
use super::disk;
use super::fault::{FileError, FileErrors, Findings};
use super::figure::{FigureDoc, FigureTexts};
use super::folder::{self, folder_of};
use super::frames::ExportError;
use super::save::save;
use super::show::{Show, is_file_name};
use super::source::Source;
use super::urdf;

/// What a conversion did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Converted {
    /// What was written: a file, or a show folder.
    pub wrote: PathBuf,
    /// What was ignored in the input or cannot be said in the output.
    pub warnings: Vec<FileError>,
}

/// Reads `input` and writes `output`. Inputs: a show folder or its `show.toml`, `.bvh`, `.str`. Outputs:
/// a show folder (no extension), `.bvh`, `.csv`. Nothing is written unless all could be read.
pub fn convert(input: &Path, output: &Path) -> Result<Converted, FileErrors> {
    if extension(input) == "urdf" {
        let error = FileError::whole(input, "a URDF says nothing about servos");
        let hint = "give a mapping of its joints with --map, see docs/puppets.md";
        return Err(error.with_hint(hint).into());
    }
    let (show, mut warnings) = read_show(input)?;
    let unwritten = |error: ExportError| FileError::whole(input, error.to_string());
    match extension(output).as_str() {
        "" => {
            refuse_foreign_folder(output)?;
            save(&show, output)?;
        }
        "bvh" => {
            let exported = bvh::export(&show).map_err(unwritten)?;
            warnings.extend(
                exported
                    .warnings
                    .into_iter()
                    .map(|text| FileError::whole(output, text)),
            );
            disk::put(output, exported.text)?;
        }
        "csv" => disk::put(output, csv::export(&show).map_err(unwritten)?)?,
        other => {
            let error = FileError::whole(output, format!("cannot write a `.{other}` file"));
            return Err(error
                .with_hint("a show folder (no extension), .bvh or .csv")
                .into());
        }
    }
    Ok(Converted {
        wrote: output.to_path_buf(),
        warnings,
    })
}

/// Reads a robot's URDF with its mapping and writes a puppet profile. Nothing is written unless all could be read.
pub fn convert_robot(
    input: &Path,
    map: &Path,
    output: &Path,
    profiles: &Profiles,
) -> Result<Converted, FileErrors> {
    if extension(input) != "urdf" {
        let error = FileError::whole(input, "a mapping belongs to a .urdf file");
        return Err(error.with_hint("leave --map out for other files").into());
    }
    if extension(output) != "toml" {
        let error = FileError::whole(output, "a puppet profile is a .toml file");
        return Err(error
            .with_hint("its name without .toml is what --puppet asks for")
            .into());
    }
    let imported = urdf::import(input, map, profiles)?;
    disk::put(output, imported.text)?;
    Ok(Converted {
        wrote: output.to_path_buf(),
        warnings: imported.warnings,
    })
}

/// Any file a show can be made from, as a show, with warnings.
pub fn read_show(input: &Path) -> Result<(Show, Vec<FileError>), FileErrors> {
    match extension(input).as_str() {
        "" | "toml" => folder::load(input).map(|loaded| (loaded.show, loaded.warnings)),
        "bvh" => {
            let imported = bvh::import(&Source::open(input)?, &name_from(input))?;
            Ok((imported.show, imported.warnings))
        }
        "str" => read_structure(input),
        _ if input.is_dir() => folder::load(input).map(|loaded| (loaded.show, loaded.warnings)),
        other => {
            let error = FileError::whole(input, format!("cannot read a `.{other}` file as a show"));
            Err(error
                .with_hint("a show folder, its show.toml, .bvh or .str")
                .into())
        }
    }
}

/// A structure file with the shape files beside it that bear its name.
fn read_structure(input: &Path) -> Result<(Show, Vec<FileError>), FileErrors> {
    let source = Source::open(input)?;
    let beside = |extension: &str| {
        let path = input.with_extension(extension);
        if path.exists() {
            Source::open(&path).map(|source| source.text().to_owned())
        } else {
            Ok(String::new())
        }
    };
    let texts = FigureTexts {
        primitives: beside("pri")?,
        shapes: beside("shp")?,
    };
    let mut found = Findings::default();
    let name = name_from(input);
    let figure = FigureDoc::read(&name, &source, texts, &mut found);
    let (figure, warnings) = found.accept(figure, input)?;
    Ok((
        Show {
            name,
            figure: Some(figure.into()),
            ..Show::default()
        },
        warnings,
    ))
}

/// A show is written over a show or into an empty place, never among a person's other files.
fn refuse_foreign_folder(output: &Path) -> Result<(), FileError> {
    let occupied = |folder: &Path| {
        folder
            .read_dir()
            .is_ok_and(|mut entries| entries.next().is_some())
    };
    if output.is_file() || (occupied(output) && !folder_of(output).join("show.toml").exists()) {
        let error = FileError::whole(output, "there is something else here already");
        return Err(error.with_hint("give a new folder's name, or an extension for another format"));
    }
    Ok(())
}

fn extension(path: &Path) -> String {
    if path.is_dir() {
        return String::new();
    }
    path.extension()
        .map(|extension| extension.to_string_lossy().to_ascii_lowercase())
        .unwrap_or_default()
}

/// The file's name without extension, made fit to name parts of a show.
fn name_from(path: &Path) -> String {
    let stem = path
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned())
        .unwrap_or_default();
    let fit = |letter: char| {
        if letter.is_alphanumeric() || "-_.".contains(letter) {
            letter
        } else {
            '_'
        }
    };
    let name: String = stem.chars().map(fit).take(60).collect();
    if is_file_name(&name) {
        name
    } else {
        "imported".to_owned()
    }
}
