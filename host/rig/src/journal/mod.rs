//! The journal: everything that entered the rig, so that it can happen again.
//!
//! It is cut at the [`crate::Ports`] boundary, the lowest place the rig has: which ports opened, every piece of
//! bytes each read returned, every failure, every command and the time of every step. The rig is a pure function
//! of these, so replaying them gives the same snapshots, the same bytes to every device and the same pictures.
//! One JSON object a line, in the order of events; `docs/formats.md` lists them.

mod record;
mod recorder;
mod replay;

pub use record::{Digest, Ending, Failure, Record};
pub use recorder::{Recorder, RecordingPorts};
pub use replay::{JournalError, ReplayPorts, Replayed, Script};
