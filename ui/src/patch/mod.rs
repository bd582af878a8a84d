//! The patch panel's model: what is shown of a function network, where, and what hands on it mean.
//!
//! *Knows* boxes, wires, kinds and commands. *Must not know* egui: everything here is plain numbers and can be
//! tested without a window; `panels::patch` draws it and passes the hands on.
//! *Start reading* at [`look`] (what comes in), then [`scene`] (what is shown of it), [`layout`] (where) and
//! [`edit`] (what goes out).

pub mod area;
pub mod camera;
pub mod catalogue;
pub mod duplicate;
pub mod edit;
pub mod fit;
pub mod hit;
pub mod layout;
pub mod look;
pub mod probe;
pub mod route;
pub mod scene;
pub mod search;
pub mod size;
pub mod source;
pub mod table;
pub mod token;
pub mod traffic;
