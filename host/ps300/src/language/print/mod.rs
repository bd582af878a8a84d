//! Commands to canonical text: keywords whole and in capitals, names as given, one form for each thing.
//!
//! Reading the text gives the command back, provided names are valid ([`Name::is_valid`]), numbers
//! finite, tables as long as the grammar wants them, and vectors marked as their class says. A list of picks
//! has no literal.
//! `tests/language_round_trip.rs` holds it to that.

mod data;
mod literal;
mod node;
mod operation;

use std::fmt;

use super::{Command, Definition, Disconnection, Initialization, Input, InputOf, Name, OutputOf, Payload};
use crate::value::Value;

pub use literal::literal;
use node::{Indent, Joined, print_function, print_node};

/// The canonical text of `command`, with its semicolon, without a line end after it.
pub fn print(command: &Command) -> String {
    command.to_string()
}

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Define { name, definition } => {
                write!(f, "{name} := ")?;
                print_definition(f, definition)?;
            }
            Self::Connect { from, to } => write!(f, "CONNECT {from}:{to}")?,
            Self::Disconnect(what) => print_disconnection(f, what)?,
            Self::Send { payload, to } => write!(f, "SEND {payload} TO {to}")?,
            Self::Store { payload, to } => write!(f, "STORE {payload} IN {to}")?,
            Self::Variable(names) => write!(f, "VARIABLE {}", Joined(names))?,
            Self::SetupCness { constant, input } => {
                write!(
                    f,
                    "SETUP CNESS {} {input}",
                    if *constant { "TRUE" } else { "FALSE" }
                )?;
            }
            Self::Include { member, instance } => write!(f, "INCLUDE {member} IN {instance}")?,
            Self::RemoveFrom { member, instance } => write!(f, "REMOVE {member} FROM {instance}")?,
            Self::Display(name) => write!(f, "DISPLAY {name}")?,
            Self::Remove(name) => write!(f, "REMOVE {name}")?,
            Self::Delete(name) => write!(f, "DELETE {name}")?,
            Self::DeleteAll { prefix } => write!(f, "DELETE {prefix}*")?,
            Self::Forget(name) => write!(f, "FORGET {name}")?,
            Self::Follow { name, with } => write!(f, "FOLLOW {name} WITH {with}")?,
            Self::Prefix { name, with } => write!(f, "PREFIX {name} WITH {with}")?,
            Self::Initialize(scope) => f.write_str(match scope {
                Initialization::Everything => "INITIALIZE",
                Initialization::Connections => "INITIALIZE CONNECTIONS",
                Initialization::Display => "INITIALIZE DISPLAY",
                Initialization::Names => "INITIALIZE NAMES",
            })?,
            Self::SetupState { name, values } => print_state(f, name, values)?,
            Self::PatternWith { list, pattern } => write!(f, "PATTERN {list} WITH {pattern}")?,
            Self::BeginGroup => f.write_str("BEGIN")?,
            Self::EndGroup => f.write_str("END")?,
            Self::Optimize => f.write_str("OPTIMIZE STRUCTURE")?,
            Self::EndOptimize => f.write_str("END OPTIMIZE")?,
            Self::ReserveWorkingStorage { bytes } => write!(f, "RESERVE_WORKING_STORAGE {bytes}")?,
            Self::CommandStatus => f.write_str("COMMAND STATUS")?,
            Self::Reset => f.write_str("!RESET")?,
        }
        f.write_str(";")
    }
}

fn print_state(f: &mut fmt::Formatter<'_>, name: &Name, values: &[Value]) -> fmt::Result {
    f.write_str("SETUP STATE ")?;
    for (index, value) in values.iter().enumerate() {
        let end = if index + 1 == values.len() { " " } else { "," };
        write!(f, "{}{end}", literal(value))?;
    }
    write!(f, "IN {name}")
}

fn print_definition(f: &mut fmt::Formatter<'_>, definition: &Definition) -> fmt::Result {
    match definition {
        Definition::Function { function, size } => print_function(f, function, *size),
        Definition::Node(node) => print_node(f, node, Indent::default()),
    }
}

fn print_disconnection(f: &mut fmt::Formatter<'_>, what: &Disconnection) -> fmt::Result {
    match what {
        Disconnection::Pair { from, to } => write!(f, "DISCONNECT {from}:{to}"),
        Disconnection::Output(from) => write!(f, "DISCONNECT {from}:ALL"),
        Disconnection::All(name) => write!(f, "DISCONNECT {name}:ALL"),
    }
}

impl fmt::Display for Payload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value(value) => f.write_str(&literal(value)),
            Self::Variable(name) => write!(f, "VALUE({name})"),
            Self::VectorsOf(name) => write!(f, "VL({name})"),
        }
    }
}

impl fmt::Display for OutputOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}<{}>", self.name, self.output)
    }
}

impl fmt::Display for InputOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<{}>{}", self.input, self.name)
    }
}

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Self::Number(number) = self {
            return write!(f, "{number}");
        }
        let named = Self::NAMED.iter().find(|(_, input)| input == self);
        f.write_str(named.expect("every input that is not a number is in the table").0)
    }
}

impl fmt::Display for Joined<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, name) in self.0.iter().enumerate() {
            let comma: &str = if index > 0 { "," } else { "" };
            let name: &Name = name;
            write!(f, "{comma}{name}")?;
        }
        Ok(())
    }
}
