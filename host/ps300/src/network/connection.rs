//! Where messages leave and arrive. Functions, display nodes and the host are connected alike.

use crate::language::{Input, Name};
use crate::structure::NodeId;
use crate::value::Kinds;

/// A function instance, device or variable. Not reused while anything refers to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct InstanceId(pub(crate) u32);

/// A parameter of the host that networks can be connected to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SinkId(pub(crate) u32);

/// Where messages leave. Valid as long as the instance it was asked from exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Outlet {
    pub(crate) from: InstanceId,
    /// From 1.
    pub(crate) output: u8,
}

/// Where messages arrive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Inlet {
    /// Input of a function, from 1.
    Function { to: InstanceId, input: u8 },
    /// Input of a display node.
    Node { to: NodeId, input: Input },
    /// Input of the host, from 1.
    Sink { to: SinkId, input: u8 },
}

/// Why two ends were not joined.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConnectError {
    /// No message could ever pass.
    #[error("{from} sends {offered}, {to} takes {accepted}: nothing could ever pass")]
    Kinds {
        /// As written in a command.
        from: String,
        /// As written in a command.
        to: String,
        /// What the output sends.
        offered: Kinds,
        /// What the input takes.
        accepted: Kinds,
    },
    /// The instance has fewer outputs.
    #[error("{name} has no output <{output}>; it has {has}")]
    NoOutput {
        /// Whose output.
        name: Name,
        /// What was asked for.
        output: u8,
        /// How many there are.
        has: usize,
    },
    /// The thing has no such input.
    #[error("{name} has no input {input}; it has {has}")]
    NoInput {
        /// Whose input.
        name: Name,
        /// As written in a command.
        input: String,
        /// What there is.
        has: String,
    },
    /// An output feeds as many inputs as it may.
    #[error("{from} already feeds {max} inputs; pass the message on through F:NOP")]
    FanOut {
        /// As written in a command.
        from: String,
        /// The bound.
        max: usize,
    },
}

/// `<1>`, `<append>`: an input as commands write it.
pub(crate) fn input_text(input: Input) -> String {
    match input {
        Input::Number(number) => format!("<{number}>"),
        named => {
            let name = Input::NAMED
                .iter()
                .find(|(_, input)| *input == named)
                .map_or("", |(name, _)| name);
            format!("<{name}>")
        }
    }
}
