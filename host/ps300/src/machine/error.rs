//! Why a command, or a declaration of the host, was refused.

use crate::language::Name;
use crate::network::ConnectError;
use crate::value::{Kind, Kinds};

/// Why a command had no effect.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExecuteError {
    /// Nothing bears the name.
    #[error("there is no {name}{}", meant(alike))]
    Unknown {
        /// As written.
        name: Name,
        /// Names it might have been.
        alike: Vec<Name>,
    },
    /// The name denotes something else.
    #[error("{name} is {is}, not {wanted}")]
    NotA {
        /// As written.
        name: Name,
        /// What it is.
        is: &'static str,
        /// What the command needs.
        wanted: &'static str,
    },
    /// The table has no such function.
    #[error("there is no function F:{function}{}", meant(alike))]
    NoFunction {
        /// As written.
        function: Name,
        /// Functions it might have been.
        alike: Vec<Name>,
    },
    /// A function whose behaviour is not on record.
    #[error(
        "F:{function} is known by name only ({purpose}) and cannot be run; `dialrig net functions` lists what can"
    )]
    AbsentFunction {
        /// As in the table.
        function: &'static str,
        /// What it was for.
        purpose: &'static str,
    },
    /// A sized type without size, an unsized type with one, or a size out of range.
    #[error("F:{function} {wanted}")]
    Size {
        /// As in the table.
        function: &'static str,
        /// What would be right.
        wanted: String,
    },
    /// The name belongs to the machine or the host.
    #[error("{name} is {is} and cannot be redefined or deleted; choose another name")]
    Fixed {
        /// As written.
        name: Name,
        /// What it is.
        is: &'static str,
    },
    /// The ends do not go together.
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// A value of the wrong kind.
    #[error("input {input} of {name} takes {expected}, not {got}")]
    Kind {
        /// Whose input.
        name: Name,
        /// As written in a command.
        input: String,
        /// What it takes.
        expected: Kinds,
        /// What the command had.
        got: Kind,
    },
    /// A value that is infinite or not a number.
    #[error("the value for input {input} of {name} is not finite")]
    NotFinite {
        /// Whose input.
        name: Name,
        /// As written in a command.
        input: String,
    },
    /// A variable nothing was sent to.
    #[error("{name} holds no value yet; SEND or STORE one first")]
    Empty {
        /// The variable.
        name: Name,
    },
    /// SETUP STATE with values that are not of this function or node.
    #[error("{name} cannot be in that state; SETUP STATE takes what a program with state says of it")]
    State {
        /// As written.
        name: Name,
    },
    /// The definition would contain itself.
    #[error("{name} would contain itself")]
    Cycle {
        /// What was to be defined or included.
        name: Name,
    },
    /// A viewing node without a view.
    #[error("{name}: {why}")]
    NoView {
        /// What was to be defined.
        name: Name,
        /// As a clause.
        why: &'static str,
    },
    /// Structures inside structures beyond what is sensible.
    #[error("{name}: structures are nested too deeply; give the inner ones names of their own")]
    Depth {
        /// What was to be defined.
        name: Name,
    },
    /// The thing to be undone was never done.
    #[error("{what}")]
    Nothing {
        /// As a sentence without its full stop.
        what: String,
    },
    /// The machine is full.
    #[error("there are {max} instances already; delete some")]
    TooMany {
        /// The bound.
        max: usize,
    },
}

/// Why a host parameter was not declared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeclareError {
    /// Something bears the name already.
    #[error("{name} denotes something already; declare host parameters before loading programs")]
    Taken {
        /// As given.
        name: Name,
    },
    /// No command could write the name.
    #[error("{name:?} is not a name: a letter, then letters, digits, _ or $")]
    NotAName {
        /// As given.
        name: Name,
    },
    /// None, or more than can be numbered.
    #[error("{name} has {count} inputs; 1 to 127 are possible")]
    Inputs {
        /// As given.
        name: Name,
        /// How many were given.
        count: usize,
    },
    /// None, or more than can be numbered.
    #[error("{name} has {count} outputs; 1 to 127 are possible")]
    Outputs {
        /// As given.
        name: Name,
        /// How many were given.
        count: usize,
    },
    /// There are as many instances as there may be.
    #[error("there is no room for {name}: the network has as many functions as it may; delete some")]
    Full {
        /// As given.
        name: Name,
    },
}

fn meant(alike: &[Name]) -> String {
    if alike.is_empty() {
        return String::new();
    }
    let names: Vec<_> = alike.iter().map(Name::as_str).collect();
    format!("; did you mean {}?", names.join(" or "))
}
