//! Facts about hardware as data: servos, puppets, and input devices of all kinds.
//!
//! Knows: the shape of the TOML files beside `src/`, how to read them (an embedded copy and the user's own
//! folder), and what makes one wrong. Must not know: bytes on a wire, units of anybody's screen, or any
//! Rust path; a profile outlives the code that reads it. The host's drivers and the simulated firmware share
//! this crate and nothing else.
//!
//! Start at [`Profiles`], then [`ServoProfile`], [`PuppetProfile`] and [`InputProfile`].

mod error;
mod input;
mod policy;
mod profiles;
mod puppet;
mod read;
mod servo;
mod status;

pub use error::ProfileError;
pub use input::{
    Bus, ByteMatch, ByteOrder, CalComp, Control, ControlClass, ControlKind, ControlUnit, Emits, Encoding,
    FORMATS, Field, FieldName, Firmata, HexBytes, HpDials, Identify, InitAction, InitStep, InputKind,
    InputProfile, Layout, Line, Lines, Match, MidiAddress, Mm, MmFraming, Osc, Output, OutputKind, Parity,
    Piece, PixelCoding, Place, Quirk, RangeFrom, Repeat, Report, Reports, RingCoding, Sgi, Slots, Surface,
    Tool, ToolProfile, Used, WacomSerial,
};
pub use policy::{Policy, Reaction};
pub use profiles::{Kind, Profiles};
pub use puppet::{Coupling, PuppetBus, PuppetGroup, PuppetJoint, PuppetProfile};
pub use read::{read_file, read_file_among};
pub use servo::{
    Access, Area, HardwareFault, Motor, Register, Role, ServoProfile, ServoProtocol, Unit, Variant, WordOrder,
};
pub use status::Status;
