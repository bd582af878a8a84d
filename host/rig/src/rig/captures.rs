//! Captures on the running rig: begun and ended by command, written at the end of each step.
//!
//! They are about files, not about the rig: no journal has them, and nothing but the devices' views shows them.

use std::path::PathBuf;
use std::time::Duration;

use super::Rig;
use crate::capture::Subject;
use crate::controls::instance::Instance;
use crate::snapshot::NoteLevel;

/// The folder of captures in that of a show.
const FOLDER: &str = "captures";

impl Rig {
    /// Where captures go as long as the show has no folder of its own.
    pub fn keep_captures_in(&mut self, folder: PathBuf) {
        self.captures_folder = Some(folder);
    }

    pub(super) fn start_captures(&mut self, devices: &[String]) -> Result<(), String> {
        let folder = match &self.folder {
            Some(show) => show.join(FOLDER),
            None => self
                .captures_folder
                .clone()
                .ok_or("a capture needs a place, and this show has no folder yet; save it, or start dialrig with one")?,
        };
        let names = if devices.is_empty() {
            self.inputs.devices().map(|(name, _)| name.to_owned()).collect()
        } else {
            devices.to_vec()
        };
        let mut wrong = Vec::new();
        for name in names {
            if !self.captures.runs(&name) {
                wrong.extend(self.start_capture(&name, &folder).err());
            }
        }
        if wrong.is_empty() {
            Ok(())
        } else {
            Err(wrong.join("; "))
        }
    }

    fn start_capture(&mut self, name: &str, folder: &std::path::Path) -> Result<(), String> {
        let place = self.place_of(name)?;
        let shows = self
            .controls
            .instances
            .get(place)
            .map(Instance::shows)
            .unwrap_or_default();
        let now = self.since_began();
        let Some((profile, described)) = self.inputs.profile(name) else {
            return Err(format!("there is no input device {name}"));
        };
        let subject = Subject {
            name,
            address: self.inputs.address(name).unwrap_or_default(),
            profile: &profile,
            described,
            shows,
        };
        let started = self.captures.start(&subject, folder, &mut self.takes.tapes, now);
        started.map_err(|error| error.to_string())
    }

    pub(super) fn stop_captures(&mut self, devices: &[String]) -> Result<(), String> {
        let running = self.captures.running();
        let names = if devices.is_empty() {
            running.clone()
        } else {
            devices.to_vec()
        };
        if names.is_empty() {
            return Err("nothing is captured".into());
        }
        let mut wrong = Vec::new();
        for name in names {
            if !running.contains(&name) {
                wrong.push(format!("{name} is not captured"));
                continue;
            }
            self.captures.take_in(&self.takes.tapes);
            let stopped = self.captures.stop(&name, &self.takes.tapes, self.since_began());
            wrong.extend(stopped.err().map(|error| error.to_string()));
        }
        if wrong.is_empty() {
            Ok(())
        } else {
            Err(wrong.join("; "))
        }
    }

    /// The end of a step, as far as captures go.
    pub(super) fn write_captures(&mut self) {
        if self.captures.is_idle() {
            return;
        }
        self.captures.take_in(&self.takes.tapes);
        for trouble in self.captures.write_out(&self.takes.tapes, self.since_began()) {
            self.note(NoteLevel::Error, trouble);
        }
    }

    pub(super) fn since_began(&self) -> Duration {
        self.now.since(self.began)
    }
}
