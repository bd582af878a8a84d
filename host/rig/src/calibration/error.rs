//! Why a calibration does not go on.

use std::path::PathBuf;

use device::servo::calibrate::Refusal;
use device::servo::maintenance::MaintenanceError;
use device::transport::TransportError;
use device_profiles::{ProfileError, PuppetProfile};

/// A calibration cannot begin, or cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// A profile is missing; the message lists what there is.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A line failed.
    #[error(transparent)]
    Line(#[from] TransportError),
    /// A servo did, or refused a setting.
    #[error(transparent)]
    Servo(#[from] MaintenanceError),
    /// No such joint.
    #[error("puppet {puppet} has no joint {joint}; it has: {known}")]
    NoSuchJoint {
        /// The puppet.
        puppet: String,
        /// As asked for.
        joint: String,
        /// All joints.
        known: String,
    },
    /// Another servo than the profile says.
    #[error(
        "joint {joint}: the profile has a {wanted}, a servo with model number {found} answers; correct the profile first \
         (`dialrig servo doctor` shows all of them)"
    )]
    OtherModel {
        /// The joint.
        joint: String,
        /// The profile's model.
        wanted: String,
        /// What answers.
        found: u16,
    },
    /// Torque did not go off.
    #[error("joint {joint} still has torque; close every other program on this bus and try again")]
    StillHolds {
        /// The joint.
        joint: String,
    },
    /// A joint cannot be calibrated from this sweep.
    #[error("joint {joint}: {refusal}")]
    Refused {
        /// The joint.
        joint: String,
        /// Why.
        refusal: Refusal,
    },
    /// Some settings were written, then one failed.
    #[error("{source}; some settings were written: `dialrig servo calibrate --restore {backup}` takes them back", backup = .backup.display())]
    HalfDone {
        /// What was there before.
        backup: PathBuf,
        /// What failed.
        source: MaintenanceError,
    },
    /// A file could not be read or written.
    #[error("{path}: {why}", path = .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
}

impl CalibrationError {
    pub(super) fn no_joint(puppet: &PuppetProfile, joint: &str) -> Self {
        let known: Vec<&str> = puppet.joints().map(|joint| joint.name.as_str()).collect();
        Self::NoSuchJoint {
            puppet: puppet.name.clone(),
            joint: joint.to_owned(),
            known: known.join(", "),
        }
    }

    pub(super) fn file(path: &std::path::Path, why: &dyn std::fmt::Display) -> Self {
        Self::File {
            path: path.to_owned(),
            why: why.to_string(),
        }
    }

    /// Whether line or servo are at fault, rather than what was asked for.
    pub fn is_of_device(&self) -> bool {
        matches!(
            self,
            Self::Line(_) | Self::Servo(_) | Self::StillHolds { .. } | Self::HalfDone { .. }
        )
    }
}
