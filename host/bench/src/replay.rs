//! Journals in memory, and playing them again without the devices.

use std::io::Write;
use std::sync::{Arc, Mutex, PoisonError};

use device::clock::{Clock, VirtualClock};
use device_profiles::Profiles;
use rig::controls_calibration::Store;
use rig::document::Show;
use rig::journal::{Digest, Ending, JournalError, Recorder, RecordingPorts, Script};

use crate::world::{Equipment, Kept, WorldError, start_rig};

/// A journal kept in memory. Clones are the same journal.
#[derive(Clone, Debug, Default)]
pub struct Journal(Arc<Mutex<Vec<u8>>>);

impl Journal {
    /// An empty journal.
    pub fn new() -> Self {
        Self::default()
    }

    /// What has been written.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.0.lock().unwrap_or_else(PoisonError::into_inner)).into_owned()
    }

    /// Digest of what has been written, 64 hexadecimal digits.
    pub fn hash(&self) -> String {
        let mut digest = Digest::default();
        digest.bytes(&self.0.lock().unwrap_or_else(PoisonError::into_inner));
        digest.hex()
    }
}

impl Write for Journal {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// A journal cannot be played again.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// It cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The rig cannot begin.
    #[error(transparent)]
    World(#[from] WorldError),
}

/// How a recording and its replay ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replay {
    /// As recorded; none if the recording was cut short.
    pub recorded: Option<Ending>,
    /// As played again.
    pub replayed: Option<Ending>,
}

impl Replay {
    /// Whether every snapshot and every byte written were the same.
    pub fn is_identical(&self) -> bool {
        self.recorded.is_some() && self.recorded == self.replayed
    }
}

/// Plays a journal into a rig that begins as the recorded one did, with the recorded bytes for devices.
pub fn replay(
    text: &str,
    show: Show,
    profiles: Arc<Profiles>,
    equipment: &Equipment,
) -> Result<Replay, ReplayError> {
    let mut script = Script::parse(text)?;
    let clock = VirtualClock::new();
    let journal = Journal::new();
    let recorder = Recorder::new(Box::new(journal.clone()), script.show.clone());
    let ports = Box::new(RecordingPorts::new(
        Box::new(script.take_ports()),
        recorder.clone(),
    ));
    let shared: Arc<dyn Clock> = Arc::new(clock.clone());
    let kept = Kept {
        recorder: Some(recorder),
        calibrations: Store::knowing(script.calibrated.clone()),
    };
    let mut rig = start_rig(&shared, ports, show, profiles, equipment, kept, None)?;
    for step in &script.steps {
        clock.sleep_until(step.now);
        rig.step(&mut step.commands.iter().cloned());
    }
    rig.close();
    let replayed = Script::parse(&journal.text())?.ending;
    Ok(Replay {
        recorded: script.ending,
        replayed,
    })
}
