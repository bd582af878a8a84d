//! What a calibration replaced: settings of servos and the user's profile, in one file.

use std::path::{Path, PathBuf};

use device_profiles::PuppetProfile;
use serde::{Deserialize, Serialize};

use super::{CalibrationError, file};

/// Folder of backups, in the user's folder of profiles. Their ending is not that of profiles, which are read from
/// there as well.
const FOLDER: &str = "replaced";
/// More than anybody keeps.
const BACKUPS_MAX: u32 = 100_000;

/// What a calibration replaced.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Backup {
    /// The puppet's key.
    pub puppet: String,
    /// Its profile in the user's folder.
    pub profile: PathBuf,
    /// The text that was there; none: there was no such file.
    pub text: Option<String>,
    /// Settings of its servos.
    pub settings: Vec<Kept>,
}

/// One setting of one servo.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept {
    /// The joint.
    pub joint: String,
    /// Its bus.
    pub bus: String,
    /// Its servo's id.
    pub id: u8,
    /// The register, by what it is for.
    pub register: String,
    /// Its value, counts.
    pub value: i64,
}

impl Backup {
    pub(super) fn new(
        puppet: &PuppetProfile,
        profile: &Path,
        settings: Vec<Kept>,
    ) -> Result<Self, CalibrationError> {
        let text = match std::fs::read_to_string(profile) {
            Ok(text) => Some(text),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
            Err(error) => return Err(CalibrationError::file(profile, &error)),
        };
        Ok(Self {
            puppet: puppet.key.clone(),
            profile: profile.to_owned(),
            text,
            settings,
        })
    }

    /// Reads a backup.
    pub fn read(path: &Path) -> Result<Self, CalibrationError> {
        let text = std::fs::read_to_string(path).map_err(|error| CalibrationError::file(path, &error))?;
        serde_json::from_str(&text).map_err(|error| CalibrationError::file(path, &error))
    }

    /// Writes it under the next free number; none is ever written over.
    pub(super) fn write(&self, user_folder: &Path) -> Result<PathBuf, CalibrationError> {
        let folder = user_folder.join(FOLDER);
        let path = (1..=BACKUPS_MAX)
            .map(|number| folder.join(format!("{}-{number}.json", self.puppet)))
            .find(|path| !path.exists())
            .ok_or_else(|| CalibrationError::file(&folder, &"it is full of backups; remove old ones"))?;
        let text =
            serde_json::to_string_pretty(self).map_err(|error| CalibrationError::file(&path, &error))?;
        file::put(&path, &text)?;
        Ok(path)
    }

    /// Puts the profile back as it was; one that was not there goes.
    pub(super) fn restore_profile(&self) -> Result<(), CalibrationError> {
        match &self.text {
            Some(text) => file::put(&self.profile, text),
            None => match std::fs::remove_file(&self.profile) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    Err(CalibrationError::file(&self.profile, &error))
                }
                _ => Ok(()),
            },
        }
    }
}
