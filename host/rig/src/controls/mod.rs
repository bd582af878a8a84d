//! Physical controls as part of the network: devices as instances, how their movements become messages, and what
//! they show.
//!
//! *Knows* profiles' controls and outputs, and which inlets of the network a control drives. *Must not know* wires,
//! transports or formats: events come in decoded, feedback goes out as values. *Start reading* at `pickup`, which is
//! pure, then at [`command`] and [`view`].

pub mod command;
pub mod gears;
pub mod pickup;
pub mod rhythm;
pub mod view;
