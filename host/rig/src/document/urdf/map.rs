//! The mapping: which servo turns which joint of a URDF, and what the URDF does not say.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::document::fault::Findings;
use crate::document::source::Source;
use device_profiles::{Policy, PuppetBus};

/// A mapping file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Map {
    /// What people call the puppet; the robot's own name if left out.
    pub(super) name: Option<String>,
    /// Where the numbers are from.
    pub(super) source: Option<String>,
    /// The figure that its links follow, in words; left out: none.
    pub(super) figure: Option<String>,
    /// What the puppet does about trouble.
    pub(super) policy: Option<Policy>,
    /// The lines.
    #[serde(rename = "bus")]
    pub(super) buses: Vec<PuppetBus>,
    /// What holds for every joint that does not say otherwise.
    #[serde(default)]
    pub(super) defaults: Servo,
    /// Servos by the joint's name in the URDF.
    #[serde(rename = "joint", default)]
    pub(super) joints: BTreeMap<String, Servo>,
    /// Joints that turn in the URDF and have no servo: they stay at 0.
    #[serde(default)]
    pub(super) rigid: Vec<String>,
    /// What links of the URDF are called in figures.
    #[serde(rename = "link", default)]
    pub(super) links: BTreeMap<String, Names>,
    /// The file itself, for errors.
    #[serde(skip)]
    pub(super) source_file: Option<Source>,
}

/// The servo of a joint.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Servo {
    pub(super) id: Option<u8>,
    pub(super) bus: Option<String>,
    pub(super) model: Option<String>,
    pub(super) sign: Option<i8>,
    pub(super) zero_counts: Option<i32>,
    pub(super) min_rad: Option<f64>,
    pub(super) max_rad: Option<f64>,
    pub(super) speed_max_rad_per_s: Option<f64>,
    pub(super) accel_max_rad_per_s2: Option<f64>,
    pub(super) jerk_max_rad_per_s3: Option<f64>,
}

/// Another name of a link.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Names {
    /// The figure's link it follows.
    pub(super) name: Option<String>,
    /// What the same link is called in other figures.
    #[serde(default)]
    pub(super) also: Vec<String>,
}

impl Map {
    /// Reads a mapping; one syntax error at a time, as the parser tells them.
    pub(super) fn read(source: &Source, found: &mut Findings) -> Option<Self> {
        match toml::from_str::<Self>(source.text()) {
            Ok(map) => Some(Self {
                source_file: Some(source.clone()),
                ..map
            }),
            Err(error) => {
                let at = error.span().map_or(0, |span| span.start);
                let hint = "a mapping names buses ([[bus]]) and a servo for each joint ([joint.NAME])";
                found.error(source.error(at, error.message().to_owned()).with_hint(hint));
                None
            }
        }
    }

    /// An error in the mapping, at the first place that names `what`.
    pub(super) fn fault(&self, what: &str, message: impl Into<String>) -> crate::document::FileError {
        match &self.source_file {
            Some(source) => source.error(source.text().find(what).unwrap_or(0), message),
            None => crate::document::FileError::whole(std::path::Path::new("the mapping"), message),
        }
    }
}
