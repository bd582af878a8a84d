//! Where calibrations are kept: `controls.toml` in the user's folder, one table for each device.
//!
//! Written beside its place and put there whole; what was there before stays as `controls.toml.old`. A file of a newer
//! version is left alone, and so is one that cannot be read: nobody's measurements are written over.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::ControlsCalibration;

/// The version written.
const VERSION: u64 = 1;
/// The file's name in the user's folder.
pub const FILE: &str = "controls.toml";

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    version: u64,
    #[serde(default)]
    device: BTreeMap<String, ControlsCalibration>,
}

/// Calibrations cannot be kept or read.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file is there and cannot be understood.
    #[error("{file}: {found}; it is left as it is, and nothing calibrated is kept. Mend it or move it away")]
    Read {
        /// The file.
        file: String,
        /// What was wrong.
        found: String,
    },
    /// It cannot be written.
    #[error("{file}: cannot write: {source}")]
    Write {
        /// The file.
        file: String,
        /// Why.
        source: std::io::Error,
    },
}

/// What is known of every device, by its identity: the profile's key and the serial number or place that tells it from
/// others of its kind.
#[derive(Debug, Default)]
pub struct Store {
    file: Option<PathBuf>,
    devices: BTreeMap<String, ControlsCalibration>,
}

impl Store {
    /// In memory only: nothing is kept.
    pub fn in_memory() -> Self {
        Self::default()
    }

    /// What a folder holds; a file that is not there holds nothing yet.
    pub fn open(folder: &Path) -> Result<Self, StoreError> {
        let file = folder.join(FILE);
        let read = |found: String| StoreError::Read {
            file: file.display().to_string(),
            found,
        };
        let devices = match fs::read_to_string(&file) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => BTreeMap::new(),
            Err(error) => return Err(read(error.to_string())),
            Ok(text) => {
                let stored: Stored = toml::from_str(&text).map_err(|error| read(error.to_string()))?;
                if stored.version != VERSION {
                    return Err(read(format!(
                        "it has version {}, and version {VERSION} is known here",
                        stored.version
                    )));
                }
                stored.device
            }
        };
        let file = Some(file);
        Ok(Self { file, devices })
    }

    /// What was calibrated on a device.
    pub fn of(&self, identity: &str) -> Option<&ControlsCalibration> {
        self.devices.get(identity)
    }

    /// Keeps what was calibrated on a device; nothing calibrated is nothing kept. On an error the file is as it was,
    /// and the calibration holds until the end of the session.
    pub fn keep(&mut self, identity: &str, calibration: ControlsCalibration) -> Result<(), StoreError> {
        if calibration.is_empty() {
            self.devices.remove(identity);
        } else {
            self.devices.insert(identity.to_owned(), calibration);
        }
        let Some(file) = &self.file else { return Ok(()) };
        let stored = Stored {
            version: VERSION,
            device: self.devices.clone(),
        };
        write(file, &stored).map_err(|source| StoreError::Write {
            file: file.display().to_string(),
            source,
        })
    }
}

fn write(file: &Path, stored: &Stored) -> std::io::Result<()> {
    let text = toml::to_string_pretty(stored).map_err(std::io::Error::other)?;
    let folder = file.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut part = tempfile::NamedTempFile::new_in(folder)?;
    part.write_all(text.as_bytes())?;
    part.as_file().sync_all()?;
    if file.exists() {
        let mut old = file.as_os_str().to_owned();
        old.push(".old");
        fs::copy(file, PathBuf::from(old))?;
    }
    part.persist(file).map_err(|error| error.error)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controls_calibration::{Area, AxisCalibration, TabletMapping};

    fn calibration() -> ControlsCalibration {
        ControlsCalibration {
            tablet: Some(TabletMapping {
                area: Some(Area {
                    corner_mm: [1.5, 2.0],
                    size_mm: [100.25, 60.0],
                }),
                turned_deg: 90.0,
                mirrored: [true, false],
                aspect: Some(1.6),
                pressure: <_>::default(),
            }),
            dials: BTreeMap::from([(0, 200.0), (7, -255.5)]),
            axes: BTreeMap::from([(
                2,
                AxisCalibration {
                    ends: [1010, 4],
                    rest: Some(512),
                    dead_counts: 6,
                },
            )]),
        }
    }

    #[test]
    fn what_was_kept_is_there_again_and_what_was_before_too() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut store = Store::open(folder.path()).expect("nothing yet");
        store.keep("sgi-dialbox/A1", calibration()).expect("it is kept");
        let first = fs::read_to_string(folder.path().join(FILE)).expect("a file");
        store
            .keep("ctl-472/B2", ControlsCalibration::default())
            .expect("it is kept");
        let again = Store::open(folder.path()).expect("it reads");
        assert_eq!(again.of("sgi-dialbox/A1"), Some(&calibration()));
        assert_eq!(again.of("ctl-472/B2"), None);
        let old = fs::read_to_string(folder.path().join("controls.toml.old")).expect("the old one");
        assert_eq!(old, first);
    }

    #[test]
    fn files_that_cannot_be_understood_are_left_alone() {
        for text in [
            "version = 2\n",
            "version = 1\nsomething = 3\n",
            "not toml at all [",
        ] {
            let folder = tempfile::tempdir().expect("a folder");
            let file = folder.path().join(FILE);
            fs::write(&file, text).expect("written");
            let error = Store::open(folder.path()).expect_err(text).to_string();
            assert!(error.contains(FILE) && error.contains("left as it is"), "{error}");
            assert_eq!(fs::read_to_string(&file).expect("it is there"), text);
        }
    }
}
