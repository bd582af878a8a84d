//! Calibrating in a world: what a person does with `dialrig servo calibrate` while the rig is away.
//!
//! A calibration takes the puppet's lines for itself, as the command does; the rig loses them. When it is written, the
//! rig begins anew with the profile that was written, as after the next start.

use std::path::Path;
use std::sync::Arc;

use device::clock::Clock;
use device_profiles::Profiles;
use rig::calibration::{Calibrator, Proposal, Reading};
use rig::ward::Ward;

use crate::stand::{HandError, SCHEME, SimPorts, Stand};

/// A calibration, from its beginning to what came of it.
#[derive(Default)]
pub(crate) struct Calibrating {
    under_way: Option<Calibrator>,
    proposals: Vec<Proposal>,
    /// Stands in for the user's folder of profiles; kept as long as the world.
    folder: Option<tempfile::TempDir>,
}

fn refused(why: &dyn std::fmt::Display) -> HandError {
    HandError::Calibration { why: why.to_string() }
}

impl Calibrating {
    /// Torque goes off and the sweep begins; each joint's zero is where it stands.
    pub(crate) fn begin(
        &mut self,
        stand: &Stand,
        clock: &Arc<dyn Clock>,
        profiles: &Profiles,
        puppet: Option<&str>,
        joint: Option<&str>,
    ) -> Result<(), HandError> {
        let puppet = puppet.ok_or_else(|| refused(&"there is no puppet"))?;
        let buses = &profiles.puppet(puppet).map_err(|error| refused(&error))?.buses;
        let wards: Vec<Ward> = buses
            .iter()
            .map(|bus| Ward {
                bus: bus.name.clone(),
                address: format!("{SCHEME}{}", bus.name),
                baud: bus.baud,
            })
            .collect();
        let mut ports = SimPorts::new(stand.clone());
        let mut begun = Calibrator::begin(&mut ports, Arc::clone(clock), profiles, puppet, &wards, joint)
            .map_err(|error| refused(&error))?;
        begun.sample().map_err(|error| refused(&error))?;
        begun.mark_zero();
        self.under_way = Some(begun);
        self.proposals.clear();
        Ok(())
    }

    fn begun(&mut self) -> Result<&mut Calibrator, HandError> {
        self.under_way
            .as_mut()
            .ok_or_else(|| refused(&"none is under way; `calibrate begin` first"))
    }

    /// Reads every joint, if a sweep is under way.
    pub(crate) fn sample(&mut self) -> Result<(), HandError> {
        match &mut self.under_way {
            Some(calibrator) => calibrator.sample().map_err(|error| refused(&error)),
            None => Ok(()),
        }
    }

    pub(crate) fn mark_zero(&mut self) -> Result<(), HandError> {
        self.begun()?.mark_zero();
        Ok(())
    }

    /// Ends the sweep. What is proposed is written if nothing is refused; gives the profiles as they are then.
    pub(crate) fn end(
        &mut self,
        reading: Reading,
        profiles: &Profiles,
    ) -> Result<Option<Profiles>, HandError> {
        let proposals = self.begun()?.propose(reading);
        let possible = proposals.iter().all(|proposal| proposal.plan.is_ok());
        self.proposals = proposals;
        let mut done = None;
        if possible {
            let folder = self.folder()?.to_owned();
            let proposals = self.proposals.clone();
            self.begun()?
                .write(&proposals, &folder)
                .map_err(|error| refused(&error))?;
            done = Some(profiles.clone().with_user_folder(&folder).map_err(|errors| {
                let told: Vec<String> = errors.iter().map(ToString::to_string).collect();
                refused(&told.join("; "))
            })?);
        }
        self.under_way = None;
        Ok(done)
    }

    fn folder(&mut self) -> Result<&Path, HandError> {
        if self.folder.is_none() {
            self.folder = Some(tempfile::tempdir().map_err(|error| refused(&error))?);
        }
        self.folder
            .as_ref()
            .map(tempfile::TempDir::path)
            .ok_or_else(|| refused(&"no folder"))
    }

    /// What the last sweep told.
    pub(crate) fn proposals(&self) -> &[Proposal] {
        &self.proposals
    }
}
