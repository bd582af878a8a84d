//! Facts about hardware as data: servos, puppets, knob boxes, tablets.
//!
//! Knows: the shape of the TOML files beside `src/`, how to read them (an embedded copy and the user's own
//! folder), and what makes one wrong. Must not know: bytes on a wire, units of anybody's screen, or any
//! Rust path; a profile outlives the code that reads it. The host's drivers and the simulated firmware share
//! this crate and nothing else.
//!
//! Start at [`Profiles`], then [`ServoProfile`] and [`PuppetProfile`].

mod error;
mod knobs;
mod policy;
mod profiles;
mod puppet;
mod read;
mod servo;
mod status;
mod tablet;

pub use error::ProfileError;
pub use knobs::{KnobsProfile, Labels};
pub use policy::{Policy, Reaction};
pub use profiles::{Kind, Profiles};
pub use puppet::{Coupling, PuppetBus, PuppetGroup, PuppetJoint, PuppetProfile};
pub use read::{read_file, read_file_among};
pub use servo::{
    Access, Area, HardwareFault, Motor, Register, Role, ServoProfile, ServoProtocol, Unit, Variant, WordOrder,
};
pub use status::Status;
pub use tablet::{Identify, SerialTool, Surface, TabletProfile, Tool};
