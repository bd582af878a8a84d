//! Commands in, snapshots out: the one place where the other crates meet.
//!
//! *Knows* the show (figure, clips, network, puppet), the order in which one step happens, how network
//! parameters become commands, and how everything is journalled.
//! *Must not know* any window, any picture, or whether a device is real: transports come in through
//! [`Ports`].
//! *Start reading* at [`command`] and [`snapshot`] (what goes in and out), then [`rig`](mod@rig) (the order).

pub mod command;
pub mod document;
pub mod history;
pub mod snapshot;

pub use command::{
    Command, EditCommand, KineticsMode, PoseCommand, PuppetCommand, Side, Touch, TransportCommand,
    ViewCommand,
};
pub use snapshot::{
    DeskKeyView, DeskView, DeviceHealth, DeviceView, DialView, FigureView, JointView, KeyView, KineticsView,
    Note, NoteLevel, PuppetState, PuppetView, Snapshot, TransportView, ViewState,
};
