//! Commands in, snapshots out: the one place where the other crates meet.
//!
//! *Knows* the show (figure, clips, network, puppet), the order in which one step happens, how network
//! parameters become commands, and how everything is journalled.
//! *Must not know* any window, any picture, or whether a device is real: transports come in through
//! [`Ports`].
//! *Start reading* at [`command`] and [`snapshot`] (what goes in and out), then [`Rig::step`] (the order).

pub mod calibration;
pub mod capture;
pub mod command;
pub mod controls;
pub mod controls_calibration;
pub mod decode;
mod desk;
pub mod doctor;
pub mod document;
pub mod feasibility;
pub mod history;
mod identities;
mod inputs;
pub mod journal;
pub mod lines;
pub mod listen;
pub mod live;
pub mod maintenance;
mod network_look;
mod network_steps;
mod notes;
pub mod parameters;
mod ports;
pub mod profile_look;
pub mod puppet;
mod rig;
pub mod shipped;
pub mod snapshot;
mod stage;
mod survey;
mod system;
pub mod take;
pub mod telling;
mod timeline;
mod view;
pub mod ward;
mod wiring;

pub use command::{
    Binding, CalibrateControl, Command, ControlCommand, EditCommand, KineticsMode, LearnCommand, NetworkEdit,
    PoseCommand, PuppetCommand, PuppetPose, Side, TakeCommand, TeachCommand, Touch, TransportCommand,
    ViewCommand,
};
pub use controls::view::{CaptureView, ControlView, DeviceHealth, DeviceView, LearningView, OutputView};
pub use controls_calibration::{CalibrationView, ControlsCalibration, TabletMapping};
pub use device_profiles::{Profiles, Reaction};
pub use feasibility::{FeasibilityView, StretchKind, StretchView};
pub use inputs::{InputError, InputSpec};
pub use live::{Live, LiveError};
pub use player::Tracking;
pub use ports::{Found, Held, Plug, Ports, TouchError};
pub use puppet::{EndHandle, JointHandle, Pace, PuppetPoseView, PuppetSpec};
pub use rig::{Rig, RigError, RigOptions};
pub use snapshot::{
    DeskKeyView, DeskView, DialView, FigureView, JointView, KeyView, KineticsView, NetworkLook, Note,
    NoteLevel, PuppetState, PuppetView, Snapshot, TakeView, TransportView, ViewState,
};
pub use system::{SystemPorts, WithBench, real_time};
