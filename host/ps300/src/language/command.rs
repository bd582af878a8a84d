//! Commands as values: what the parser makes, the printer writes and the machine executes.
//!
//! Source: the command language of the PS 300 (`docs/protocols/ps300.md`, section "Commands"). A form
//! that is equivalent to another has no variant of its own: `THEN a` and `APPLIED TO a` are the same
//! command, `SCALE BY 2` is a scale by three equal factors.

use std::sync::Arc;

use super::{Name, Node, Operation};
use crate::value::Value;

/// One command, up to its semicolon (or to the one after `END_STRUCTURE`).
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// `name := …;` binds the name anew, whatever it denoted before.
    Define {
        /// What is bound.
        name: Name,
        /// What it is bound to.
        definition: Definition,
    },
    /// `CONNECT a<1>:<2>b;`
    Connect {
        /// Where messages leave.
        from: OutputOf,
        /// Where they arrive.
        to: InputOf,
    },
    /// `DISCONNECT …;`
    Disconnect(Disconnection),
    /// `SEND 0.5 TO <2>b;`
    Send {
        /// What arrives.
        payload: Payload,
        /// Where.
        to: InputOf,
    },
    /// `STORE 0.5 IN <1>v;`: as SEND, the usual spelling for variables.
    Store {
        /// What arrives.
        payload: Payload,
        /// Where.
        to: InputOf,
    },
    /// `VARIABLE v,w;` makes instances that remember the last message of input 1. Never empty.
    Variable(Vec<Name>),
    /// `SETUP CNESS TRUE <2>f;` makes one input constant, `FALSE` active.
    SetupCness {
        /// True for constant.
        constant: bool,
        /// Which input.
        input: InputOf,
    },
    /// `INCLUDE a IN n;`
    Include {
        /// What the instance node gains.
        member: Name,
        /// The instance node.
        instance: Name,
    },
    /// `REMOVE a FROM n;`
    RemoveFrom {
        /// What the instance node loses.
        member: Name,
        /// The instance node.
        instance: Name,
    },
    /// `DISPLAY n;`
    Display(Name),
    /// `REMOVE n;` takes off the screen what DISPLAY put there.
    Remove(Name),
    /// `DELETE n;`
    Delete(Name),
    /// `DELETE prefix*;`: every name that begins so.
    DeleteAll {
        /// How the names begin.
        prefix: Name,
    },
    /// `FORGET n;` drops the name and keeps the thing where it is referenced.
    Forget(Name),
    /// `FOLLOW n WITH op;` puts an operation directly below the operation `n`.
    Follow {
        /// The operation that is followed.
        name: Name,
        /// What comes below it.
        with: Operation,
    },
    /// `PREFIX n WITH op;` puts an operation directly above `n`.
    Prefix {
        /// What is prefixed.
        name: Name,
        /// What comes above it.
        with: Operation,
    },
    /// `INITIALIZE …;`
    Initialize(Initialization),
    /// `SETUP STATE v,v,… IN f;` gives a function instance what it remembered. This project's own: the PS 300
    /// could not write a running network down.
    SetupState {
        /// A function instance.
        name: Name,
        /// What the function said it remembers, in its order; none is as new.
        values: Vec<Value>,
    },
    /// `PATTERN list WITH p;` dashes a data node.
    PatternWith {
        /// A vector list or curve.
        list: Name,
        /// A [`super::Pattern`] node.
        pattern: Name,
    },
    /// `BEGIN` … : commands up to END take effect in one update.
    BeginGroup,
    /// `END;`
    EndGroup,
    /// `OPTIMIZE STRUCTURE;`: on the PS 300, structures made up to END OPTIMIZE were stored compactly.
    Optimize,
    /// `END OPTIMIZE;`
    EndOptimize,
    /// `RESERVE_WORKING_STORAGE n;`: memory for rendering.
    ReserveWorkingStorage {
        /// As asked for.
        bytes: u32,
    },
    /// `COMMAND STATUS;` reports on groups and structures that are open.
    CommandStatus,
    /// `!RESET;` ends whatever is open.
    Reset,
}

/// The right-hand side of `name := …;`.
#[derive(Clone, Debug, PartialEq)]
pub enum Definition {
    /// `F:TYPE` or `F:TYPE(k)`: an instance of an intrinsic function.
    Function {
        /// The type without `F:`, for example `ADDC`.
        function: Name,
        /// The number of inputs or outputs, for the types that have it, for example `ROUTE(4)`.
        size: Option<u16>,
    },
    /// Part of the display tree.
    Node(Node),
}

/// What is undone by a DISCONNECT.
#[derive(Clone, Debug, PartialEq)]
pub enum Disconnection {
    /// `DISCONNECT a<1>:<2>b;`
    Pair {
        /// Where messages left.
        from: OutputOf,
        /// Where they arrived.
        to: InputOf,
    },
    /// `DISCONNECT a<1>:ALL;`
    Output(OutputOf),
    /// `DISCONNECT a:ALL;`: every output of `a`.
    All(Name),
}

/// How much INITIALIZE clears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Initialization {
    /// Names, connections and the screen.
    Everything,
    /// User-made connections.
    Connections,
    /// What is displayed.
    Display,
    /// User-made names.
    Names,
}

/// What SEND and STORE carry.
#[derive(Clone, Debug, PartialEq)]
pub enum Payload {
    /// A literal.
    Value(Value),
    /// `VALUE(v)`: what the variable holds when the command is executed.
    Variable(Name),
    /// `VL(name)`: the vectors of that list as they are when the command is executed.
    VectorsOf(Name),
}

/// `name<output>`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputOf {
    /// The instance or device.
    pub name: Name,
    /// From 1.
    pub output: u8,
}

/// `<input>name`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputOf {
    /// The instance, node, device or host parameter.
    pub name: Name,
    /// Which of its inputs.
    pub input: Input,
}

/// One input of a function or of a display node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Input {
    /// From 1. On a vector list it is the number of the vector that is replaced, hence the range.
    Number(u16),
    /// `<append>` adds a vector or text at the end.
    Append,
    /// `<delete>` takes n from the end.
    Delete,
    /// `<clear>` empties.
    Clear,
    /// `<step>` sets the spacing of characters.
    Step,
    /// `<position>` moves the origin of characters.
    Position,
    /// `<last>` replaces the final element.
    Last,
    /// `<substitute>` replaces the element whose number was sent with it.
    Substitute,
}

impl Input {
    /// The inputs with names, in the order of their codes 0 to -6 in the vendor's constants file.
    pub const NAMED: [(&'static str, Self); 7] = [
        ("append", Self::Append),
        ("delete", Self::Delete),
        ("clear", Self::Clear),
        ("step", Self::Step),
        ("position", Self::Position),
        ("last", Self::Last),
        ("substitute", Self::Substitute),
    ];
}

/// Text in a command: quoted pieces and `CHAR(n)` joined.
pub type Text = Arc<str>;
