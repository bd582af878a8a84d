//! What the patch panel is told of a network: its boxes and wires, and what moves on them.
//!
//! A [`Picture`] changes only when the network is edited, an [`Activity`] whenever messages move; so the dear
//! work (layout, routes) is done once a picture and the cheap work once a frame.

use std::sync::Arc;

use ps300::Diagnostic;
pub use ps300::machine::picture::{BoxPicture, BoxRole as Role, Picture, PortPicture, Wire};
pub use ps300::machine::{Activity, InputActivity, OutputActivity};
pub use rig::NetworkEdit;
use rig::Snapshot;

/// The network at one moment.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// Boxes and wires.
    pub picture: Arc<Picture>,
    /// What moves, in the picture's order.
    pub activity: Arc<Activity>,
    /// The whole network as text.
    pub text: Arc<str>,
    /// Whether an edit can be taken back.
    pub can_undo: bool,
    /// Whether one that was taken back can be made again.
    pub can_redo: bool,
    /// What was wrong with the last edit.
    pub diagnostics: Arc<[Diagnostic]>,
    /// Remarks, oldest first; those of a box begin with its name.
    pub remarks: Vec<String>,
}

impl Look {
    /// What a snapshot tells; nothing while it does not carry the network.
    pub fn of(seen: &Snapshot) -> Option<Look> {
        let network = seen.network.as_ref()?;
        Some(Look {
            picture: network.picture.clone(),
            activity: network.activity.clone(),
            text: network.text.clone(),
            can_undo: network.can_undo,
            can_redo: network.can_redo,
            diagnostics: network.diagnostics.clone(),
            remarks: seen.notes.iter().map(|note| note.text.clone()).collect(),
        })
    }
}
