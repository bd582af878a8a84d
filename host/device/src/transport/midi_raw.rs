//! A raw MIDI node of Linux (`/dev/snd/midiC1D0`, `/dev/midi1`): bytes of MIDI in both directions, no library, no
//! sequencer.
//!
//! One program has a node at a time. Nodes with one direction only are taken too: what nobody hears is not sent.
//! Source: Linux `sound/core/rawmidi.c`, `Documentation/sound/designs/midi-2.0.rst`.

use super::intake::{Intake, Reading, gone};
use super::{Boundary, Transport, TransportError, descriptor};
use crate::clock::{Clock, Instant};
use rustix::fd::{AsFd, BorrowedFd, OwnedFd};
use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// What grants the right to open a node: Debian, Fedora and their kin give sound devices to `audio` and to whoever
/// sits at the screen.
pub const MIDI_HINT: &str =
    "add yourself to the group of the sound devices (`sudo usermod -aG audio $USER`) and log in again";

/// An open node.
#[derive(Debug)]
pub struct MidiRaw {
    address: String,
    /// The direction to the device, where there is one.
    out: Option<OwnedFd>,
    /// The direction from it, where there is one.
    intake: Option<Intake>,
}

/// Whether a path is a raw MIDI node, by its name.
pub fn is_node(path: &str) -> bool {
    let name = Path::new(path).file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| {
        name.starts_with("midi") || name.starts_with("amidi") || name.starts_with("dmmidi")
    })
}

/// Opens a node; arrivals are noted by `clock`.
pub fn open(path: &str, clock: Arc<dyn Clock>) -> Result<MidiRaw, TransportError> {
    let sort = |e: Errno| TransportError::from_io(path, MIDI_HINT, e.into());
    let opened =
        |flags: OFlags| rustix::fs::open(path, flags | OFlags::NONBLOCK | OFlags::CLOEXEC, Mode::empty());
    // The kernel answers "no such device" where a direction is missing.
    let (fd, reads, writes) = match opened(OFlags::RDWR) {
        Err(Errno::NXIO) => match opened(OFlags::RDONLY) {
            Err(Errno::NXIO) => (opened(OFlags::WRONLY).map_err(sort)?, false, true),
            other => (other.map_err(sort)?, true, false),
        },
        other => (other.map_err(sort)?, true, true),
    };
    let intake = reads
        .then(|| {
            let name = path.rsplit('/').next().unwrap_or(path);
            Intake::spawn(name, clock, Box::new(Node(fd.try_clone()?)))
        })
        .transpose()
        .map_err(|source: io::Error| TransportError::Io {
            address: path.to_owned(),
            source,
        })?;
    Ok(MidiRaw {
        address: path.to_owned(),
        out: writes.then_some(fd),
        intake,
    })
}

struct Node(OwnedFd);

impl Reading for Node {
    fn read(&mut self, buffer: &mut [u8], limit: Duration) -> io::Result<usize> {
        descriptor::read_within(self.0.as_fd(), buffer, limit)
    }
}

impl Transport for MidiRaw {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        match &mut self.intake {
            Some(intake) => intake.read(buffer).ok_or_else(|| gone(&self.address)),
            None => Ok(0),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let Some(out) = &self.out else { return Ok(()) };
        descriptor::write(out.as_fd(), bytes)
            .map_err(|e| TransportError::from_io(&self.address, MIDI_HINT, e))
    }

    fn arrived(&self) -> Option<Instant> {
        self.intake.as_ref().and_then(Intake::arrived)
    }

    fn dropped(&self) -> u64 {
        self.intake.as_ref().map_or(0, Intake::dropped)
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        match &self.intake {
            Some(intake) => intake.wait(clock, until),
            None => clock.sleep_until(until),
        }
    }

    fn ready(&mut self) -> bool {
        self.intake.as_ref().is_some_and(Intake::ready)
    }

    /// None: the thread has the node's descriptor, and what it has read is not seen by waiting for it.
    fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::MonotonicClock;

    fn pipe() -> (tempfile::TempDir, String) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("midiC0D0");
        rustix::fs::mkfifoat(rustix::fs::CWD, &path, Mode::RUSR | Mode::WUSR).expect("a pipe");
        let path = path.to_str().expect("text").to_owned();
        (folder, path)
    }

    #[test]
    fn bytes_go_out_and_come_in_with_their_times() {
        let clock = Arc::new(MonotonicClock::new());
        let (_folder, path) = pipe();
        // A pipe opened both ways gives back what is put in.
        let mut node = open(&path, clock.clone()).expect("it is there");
        node.write(&[0x90, 60, 100]).expect("room");
        let mut heard = Vec::new();
        let until = clock.now().after(Duration::from_secs(5));
        while heard.len() < 3 && clock.now() < until {
            node.wait(clock.as_ref(), until);
            let mut buffer = [0; 16];
            let count = node.read(&mut buffer).expect("it is open");
            heard.extend_from_slice(&buffer[..count]);
        }
        assert_eq!(heard, [0x90, 60, 100]);
        assert!(node.arrived().is_some_and(|at| at <= clock.now()));
        assert_eq!(node.boundary(), Boundary::Stream);
    }

    #[test]
    fn nodes_are_known_by_name_and_missing_ones_are_said_so() {
        for (path, is) in [
            ("/dev/snd/midiC1D0", true),
            ("/dev/midi2", true),
            ("/dev/snd/pcmC0D0p", false),
            ("/dev/ttyUSB0", false),
        ] {
            assert_eq!(is_node(path), is, "{path}");
        }
        let clock = Arc::new(MonotonicClock::new());
        let error = open("/dev/snd/midiC99D9", clock).expect_err("nothing is there");
        assert!(matches!(error, TransportError::NotFound { .. }), "{error}");
    }
}
