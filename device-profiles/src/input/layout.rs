//! Layouts: what reports mean, shared between the devices of a family.

use super::{InputProfile, Report};
use crate::{ProfileError, Profiles, Status};
use serde::{Deserialize, Serialize};

/// A family's reports.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Layout {
    /// The file's name without its ending; what profiles ask for.
    #[serde(skip)]
    pub key: String,
    /// What it is.
    pub name: String,
    /// How far it was tried.
    pub status: Status,
    /// Where it is from.
    pub source: String,
    /// As in a profile; a profile's own takes its place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leave_after_ms: Option<u32>,
    /// What each report means.
    #[serde(rename = "report")]
    pub reports: Vec<Report>,
}

/// What a profile's reports mean, wherever that was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reports<'a> {
    /// Each kind of report; bytes count from after those skipped.
    pub reports: &'a [Report],
    /// Bytes to leave out at the beginning of every report.
    pub skip_bytes: u16,
    /// A tool not heard of for so long has left, milliseconds.
    pub leave_after_ms: Option<u32>,
}

impl InputProfile {
    /// What its reports mean, for a profile that came out of [`Profiles`]; none of a profile that stands alone and
    /// names a layout.
    pub fn tables(&self) -> Reports<'_> {
        let layout = self.of_layout.as_deref().filter(|_| self.layout.is_some());
        Reports {
            reports: layout.map_or(&self.own_reports, |l| &l.reports),
            skip_bytes: self.skip_bytes,
            leave_after_ms: self.leave_after_ms.or(layout.and_then(|l| l.leave_after_ms)),
        }
    }

    /// What its reports mean: its own tables, or those of its layout.
    ///
    /// # Errors
    /// When the layout it names is not there.
    pub fn reports<'a>(&'a self, profiles: &'a Profiles) -> Result<Reports<'a>, ProfileError> {
        let layout = self
            .layout
            .as_deref()
            .map(|key| profiles.layout(key))
            .transpose()?;
        Ok(Reports {
            reports: layout.map_or(&self.own_reports, |l| &l.reports),
            skip_bytes: self.skip_bytes,
            leave_after_ms: self.leave_after_ms.or(layout.and_then(|l| l.leave_after_ms)),
        })
    }
}
