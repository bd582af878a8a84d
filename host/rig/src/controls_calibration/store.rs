//! Where calibrations are kept: `controls.toml` in the user's folder, one table for each device.
//!
//! Written beside its place and put there whole; what was there before stays as `controls.toml.old`. A file of a newer
//! version is left alone, and so is one that cannot be read: nobody's measurements are written over.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use super::ControlsCalibration;
use crate::document::FileError;
use crate::document::source::Source;

/// The version written.
const VERSION: u64 = 1;
/// The file's name in the user's folder.
pub const FILE: &str = "controls.toml";
/// What to do about a file that cannot be understood.
const HINT: &str = "it is left as it is, and nothing calibrated is kept; mend it or move it away";

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    version: u64,
    #[serde(default)]
    device: BTreeMap<String, Sound>,
}

/// A calibration that nothing is wrong with. Checked while it is read, so that the error has its place.
#[derive(Debug, Serialize)]
#[serde(transparent)]
struct Sound(ControlsCalibration);

impl<'de> Deserialize<'de> for Sound {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let read = ControlsCalibration::deserialize(from)?;
        match read.unsound() {
            Some(fault) => Err(D::Error::custom(fault)),
            None => Ok(Self(read)),
        }
    }
}

/// Calibrations cannot be kept or read.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file is there and cannot be understood.
    #[error(transparent)]
    Read(#[from] FileError),
    /// It cannot be written.
    #[error("{file}: cannot write: {source}; what was calibrated holds until the end of the session")]
    Write {
        /// The file.
        file: String,
        /// Why.
        source: std::io::Error,
    },
    /// It was not understood when it was read, so it is not written over.
    #[error("what was calibrated holds until the end of the session: {0}")]
    Unkept(String),
}

/// What is known of every device, by its identity: the profile's key and the serial number or place that tells it from
/// others of its kind.
#[derive(Debug, Default)]
pub struct Store {
    file: Option<PathBuf>,
    /// Why nothing is kept, where the file could not be understood.
    fault: Option<String>,
    devices: BTreeMap<String, ControlsCalibration>,
}

impl Store {
    /// In memory only: nothing is kept.
    pub fn in_memory() -> Self {
        Self::default()
    }

    /// In memory only, with what was known before.
    pub fn knowing(devices: BTreeMap<String, ControlsCalibration>) -> Self {
        Self {
            devices,
            ..Self::default()
        }
    }

    /// The one in the user's folder; one that cannot be understood is left alone, and nothing is kept.
    pub fn of_user(folder: Option<&Path>) -> Self {
        let Some(folder) = folder else {
            return Self::in_memory();
        };
        Self::open(folder).unwrap_or_else(|error| Self {
            fault: Some(error.to_string()),
            ..Self::default()
        })
    }

    /// Reads the file in a folder; one that is not there yet has nothing in it.
    pub fn open(folder: &Path) -> Result<Self, StoreError> {
        let file = folder.join(FILE);
        let devices = if file.exists() {
            read(&file).map_err(|error| error.with_hint(HINT))?
        } else {
            BTreeMap::new()
        };
        Ok(Self {
            file: Some(file),
            fault: None,
            devices,
        })
    }

    /// Why nothing is kept, where that is so.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// All that is known, by identity.
    pub fn devices(&self) -> &BTreeMap<String, ControlsCalibration> {
        &self.devices
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
        if let Some(fault) = &self.fault {
            return Err(StoreError::Unkept(fault.clone()));
        }
        let Some(file) = &self.file else { return Ok(()) };
        let devices = self.devices.clone();
        let stored = Stored {
            version: VERSION,
            device: devices.into_iter().map(|(key, it)| (key, Sound(it))).collect(),
        };
        write(file, &stored).map_err(|source| StoreError::Write {
            file: file.display().to_string(),
            source,
        })
    }
}

fn read(file: &Path) -> Result<BTreeMap<String, ControlsCalibration>, FileError> {
    #[derive(Deserialize)]
    struct Head {
        version: toml::Spanned<u64>,
    }
    let source = Source::open(file)?;
    let fault = |error: &toml::de::Error| {
        let at = error.span().map_or(0, |span| span.start);
        source.error(at, error.message())
    };
    // A newer file may have what is unknown here: its version is what to say of it.
    let head: Head = toml::from_str(source.text()).map_err(|error| fault(&error))?;
    if *head.version.get_ref() != VERSION {
        let found = head.version.get_ref();
        let words = format!("expected version {VERSION}, found {found}; a newer dialrig wrote it");
        return Err(source.error(head.version.span().start, words));
    }
    let stored: Stored = toml::from_str(source.text()).map_err(|error| fault(&error))?;
    Ok(stored.device.into_iter().map(|(key, it)| (key, it.0)).collect())
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
    fn files_that_cannot_be_understood_are_left_alone_and_told_with_their_place() {
        for (text, place) in [
            ("version = 2\n", ":1:11: expected version 1, found 2"),
            ("version = 1\nsomething = 3\n", ":2:1:"),
            ("not toml at all [", ":1:5:"),
            (
                "version = 1\n[device.\"box/A1\"]\ntablet = 3\n",
                ":3:10: invalid type",
            ),
            (
                "version = 1\n\n[device.\"box/A1\".dials]\n3 = 0.0\n",
                ":3:9: dial 3: counts in a turn",
            ),
        ] {
            let folder = tempfile::tempdir().expect("a folder");
            let file = folder.path().join(FILE);
            fs::write(&file, text).expect("written");
            let error = Store::open(folder.path()).expect_err(text).to_string();
            assert!(error.contains(FILE) && error.contains("left as it is"), "{error}");
            assert!(error.contains(place), "{error} has no {place}");
            let mut store = Store::of_user(Some(folder.path()));
            assert_eq!(store.fault(), Some(&*error));
            let kept = store.keep("box/A1", calibration());
            assert!(
                kept.expect_err("not kept")
                    .to_string()
                    .contains("end of the session")
            );
            assert_eq!(store.of("box/A1"), Some(&calibration()), "until the end it holds");
            assert_eq!(fs::read_to_string(&file).expect("it is there"), text);
        }
    }
}
