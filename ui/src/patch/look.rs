//! What the patch panel is told of a network: its boxes and wires, and what moves on them.
//!
//! A [`Picture`] changes only when the network is edited, an [`Activity`] whenever messages move; so the dear
//! work (layout, routes) is done once a picture and the cheap work once a frame.

use std::sync::Arc;

use ps300::language::{Input, Name};
use ps300::{Kinds, Value};

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
    /// What went wrong lately: the box, by its place in the picture, and the words.
    pub reports: Arc<[(usize, String)]>,
}

/// Boxes and wires.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// Grows with every change of the network's shape.
    pub revision: u64,
    /// All that takes part in the network.
    pub boxes: Vec<BoxPicture>,
    /// Who sends to whom.
    pub wires: Vec<Wire>,
    /// What could be wired and is not: devices, displays, parameters, display nodes.
    pub others: Vec<BoxPicture>,
}

/// What a box stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// An instance of an intrinsic function.
    Function,
    /// A variable.
    Variable,
    /// What hands drive.
    Device,
    /// A node of the display tree.
    Node,
    /// A parameter of the host, or a read-out of the desk.
    Parameter,
}

/// One box.
#[derive(Clone, Debug)]
pub struct BoxPicture {
    /// As commands reach it.
    pub name: Name,
    /// What it stands for.
    pub role: Role,
    /// Its type: `F:ADDC`, `ROTATE`.
    pub what: Arc<str>,
    /// The structure around it.
    pub structure: Option<Name>,
    /// Lines shown under the name.
    pub labels: Vec<Arc<str>>,
    /// In order.
    pub inputs: Vec<PortPicture>,
    /// In order, from <1>.
    pub outputs: Vec<PortPicture>,
}

/// One port.
#[derive(Clone, Debug)]
pub struct PortPicture {
    /// Its number or name; outputs are numbered.
    pub input: Input,
    /// What it takes or sends.
    pub kinds: Kinds,
    /// Whether an input keeps its message.
    pub constant: bool,
}

/// One wire; boxes by their places in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wire {
    /// Who sends.
    pub from_box: usize,
    /// On which output, from 1.
    pub output: u8,
    /// Who takes it.
    pub to_box: usize,
    /// At which input.
    pub input: Input,
}

/// What moves; flat, in the order of the picture's boxes and of their ports.
#[derive(Clone, Debug, Default)]
pub struct Activity {
    /// Every input of every box.
    pub inputs: Vec<InputActivity>,
    /// Every output of every box.
    pub outputs: Vec<OutputActivity>,
    /// How often something went wrong at each box.
    pub reports: Vec<u64>,
}

/// One input.
#[derive(Clone, Debug, Default)]
pub struct InputActivity {
    /// Messages waiting.
    pub waiting: u32,
    /// What the next firing sees.
    pub front: Option<Value>,
}

/// One output.
#[derive(Clone, Debug, Default)]
pub struct OutputActivity {
    /// Messages sent so far.
    pub sent: u64,
    /// The last of them.
    pub last: Option<Value>,
    /// Whether it is held back.
    pub frozen: bool,
    /// What was held back.
    pub withheld: u64,
}

/// What a hand on the panel wants done with the network. Each is one step of undo.
#[derive(Clone, Debug, PartialEq)]
pub enum Ask {
    /// Commands, executed in order.
    Commands(String),
    /// The whole network as text; what differs is changed.
    Program(String),
    /// Takes the last edit back.
    Undo,
    /// Makes it again.
    Redo,
    /// Holds an output back, or lets it go.
    Freeze {
        /// Whose.
        name: Name,
        /// Which, from 1.
        output: u8,
        /// Held back.
        on: bool,
    },
}
