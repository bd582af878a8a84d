//! The simulated bench: firmware behind the rig's ports, hands on it, and the stories and scenarios played there.
//!
//! *Knows* the rig's commands and snapshots, simulated devices, and both ends of every cable between them.
//! *Must not know* windows, pictures or files of the command line; and the rig must not know it: everything
//! here reaches the rig as bytes through [`rig::Ports`] or as [`rig::Command`]s.
//! *Start reading* at [`stand`] (the devices), then [`World`] (devices, hands and a rig on one clock),
//! [`scenario`] (what one would say at the bench), [`demo`] (the whole chain as one story) and [`serve`]
//! (devices for other programs, in real time).

mod calibrating;
pub mod demo;
pub mod dut;
pub mod hands;
pub mod replay;
pub mod scenario;
pub mod serve;
pub mod stand;
pub mod world;

pub use hands::{Hands, Movement};
pub use stand::{PuppetPlan, SimPorts, Stand};
pub use world::{World, WorldOptions};
