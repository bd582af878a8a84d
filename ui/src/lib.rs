//! Pictures of the rig, with and without a window.
//!
//! *Knows* how a [`rig::Snapshot`] looks, and which [`rig::Command`] a hand on the window means.
//! *Must not know* devices, players or how the rig steps: only snapshots come in and only commands go out.
//! `render` must not know egui.
//! *Start reading* at [`render::stage`] (from snapshot to picture), then [`studio`] (from pictures to a
//! window) and [`panels`].

mod display;
pub mod panels;
pub mod patch;
pub mod render;
pub mod still;
pub mod studio;
mod watch;
