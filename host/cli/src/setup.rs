//! What live commands begin with: the show, hardware knowledge, a bench beside the machine's ports.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use bench::SimPorts;
use bench::world::Equipment;
use rig::controls_calibration::Store;
use rig::document::{self, Show};
use rig::{InputSpec, Live, Pace, Profiles, PuppetSpec, Rig, RigOptions, Snapshot, SystemPorts, WithBench};

use crate::console::Console;
use crate::failure::Failure;

/// Shipped profiles and the user's own. Files of the user's that are wrong are told of and left out.
pub(crate) fn profiles() -> Result<Arc<Profiles>, Failure> {
    let folder = rig::shipped::user_profiles_folder();
    if let Some(folder) = folder.as_deref().filter(|folder| folder.is_dir())
        && let Err(error) = std::fs::read_dir(folder)
    {
        let message = format!("{}: {error}", folder.display());
        return Err(Failure::refused(message)
            .with_hint("profiles of your own are kept there; grant the right to read it"));
    }
    let (profiles, errors) = rig::shipped::right_profiles(folder.as_deref());
    let mut stderr = std::io::stderr();
    for error in &errors {
        // Who cannot be told cannot be told that either.
        let _ = writeln!(stderr, "{error}");
    }
    if !errors.is_empty() {
        let _ = writeln!(
            stderr,
            "these profiles are left out, and nothing stands in for them; `dialrig check FILE` looks at one of them"
        );
    }
    Ok(Arc::new(profiles))
}

/// A show and where it is saved; the shipped one, without a folder, when none is given.
pub(crate) fn show(path: Option<&Path>, console: &Console) -> Result<(Show, Option<PathBuf>), Failure> {
    let Some(path) = path else {
        return Ok((document::from_texts(&rig::shipped::salute())?, None));
    };
    let loaded = document::load(path)?;
    console.warn(&loaded.warnings);
    if let Some(autosave) = &loaded.autosave {
        console.remark(format_args!(
            "unsaved work is kept in {}; open that folder to take it over, or save to discard it",
            autosave.display()
        ));
    }
    Ok((loaded.show, Some(loaded.folder)))
}

/// A rig in real time.
pub(crate) struct LiveSetup {
    /// The show.
    pub(crate) show: Show,
    /// Where it is saved.
    pub(crate) folder: Option<PathBuf>,
    /// Hardware knowledge.
    pub(crate) profiles: Arc<Profiles>,
    /// What is simulated.
    pub(crate) equipment: Equipment,
    /// Real devices beside it.
    pub(crate) inputs: Vec<InputSpec>,
    /// Addresses of the puppet's buses, in the profile's order; empty for the simulated ones.
    pub(crate) ports: Vec<String>,
    /// Control cycles.
    pub(crate) period: Duration,
    /// The puppet is played only while heartbeats come at least this often.
    pub(crate) heartbeat: Option<Duration>,
}

impl LiveSetup {
    /// Starts it. `seen` gets every step on the rig's own thread.
    pub(crate) fn start(self, seen: impl FnMut(&Arc<Snapshot>) + Send + 'static) -> Result<Live, Failure> {
        let refused = |error: &dyn std::fmt::Display| Failure::refused(error.to_string());
        let clock = rig::real_time();
        let stand = self
            .equipment
            .stand(Arc::clone(&clock), &self.profiles)
            .map_err(|e| refused(&e))?;
        let puppet = self
            .equipment
            .puppet(&self.profiles, Pace::OwnThread, self.period)
            .map_err(|e| refused(&e))?
            .map(|spec| self.addressed(spec))
            .transpose()?
            .map(|mut spec| {
                spec.config.heartbeat_max = self.heartbeat;
                spec
            });
        let system = SystemPorts::knowing(
            Arc::clone(&clock),
            Arc::clone(&self.profiles),
            rig::shipped::user_folder().as_deref(),
        );
        let system = system.watching().map_err(|e| refused(&e))?;
        let mut inputs = self.equipment.inputs();
        inputs.extend(self.inputs);
        let options = RigOptions {
            show: self.show,
            folder: self.folder,
            profiles: self.profiles,
            inputs,
            calibrations: Store::of_user(rig::shipped::user_folder().as_deref()),
            puppet,
            recorder: None,
        };
        let ports = Box::new(WithBench::beside(Box::new(SimPorts::new(stand)), system));
        let mut rig = Rig::new(Arc::clone(&clock), ports, options).map_err(|e| refused(&e))?;
        if let Some(user) = rig::shipped::user_folder() {
            rig.keep_captures_in(user.join("captures"));
        }
        Live::start(rig, clock, seen).map_err(|e| refused(&e))
    }

    /// Puts the puppet's buses on the ports given, in order.
    fn addressed(&self, mut spec: PuppetSpec) -> Result<PuppetSpec, Failure> {
        if self.ports.is_empty() {
            return Ok(spec);
        }
        let profile = self
            .profiles
            .puppet(&spec.profile)
            .map_err(|error| Failure::refused(error.to_string()))?;
        let buses: Vec<&str> = profile.buses.iter().map(|bus| bus.name.as_str()).collect();
        if self.ports.len() != buses.len() {
            let message = format!(
                "puppet {} has {} buses ({}), but {} ports were given",
                profile.name,
                buses.len(),
                buses.join(", "),
                self.ports.len()
            );
            return Err(Failure::refused(message).with_hint("give one --port for each bus, in that order"));
        }
        spec.ports = buses
            .iter()
            .zip(&self.ports)
            .map(|(bus, port)| ((*bus).to_owned(), port.clone()))
            .collect();
        Ok(spec)
    }
}
