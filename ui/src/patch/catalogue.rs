//! What can be added to a network: every intrinsic function, a variable, and whatever is there but not wired yet.

use ps300::intrinsic::{self, Spec};
use ps300::language::{Input, Name};
use ps300::{Kind, Kinds};

use super::look::{Picture, Role};

/// One thing that can be added.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What it is searched by.
    pub title: String,
    /// What adding it does.
    pub adds: Adds,
    /// What it does, in words.
    pub behaviour: String,
    /// Kinds each input takes.
    pub inputs: Vec<Kinds>,
    /// Kinds each output sends.
    pub outputs: Vec<Kinds>,
}

/// What adding an entry does.
#[derive(Clone, Debug)]
pub enum Adds {
    /// Makes an instance.
    Function(&'static Spec),
    /// Makes a variable.
    Variable,
    /// Lays a device, a parameter or a display node on the table.
    Guest(Name),
}

impl Entry {
    /// The least and the greatest size, for types that have one.
    pub fn sizes(&self) -> Option<(u8, u8)> {
        match self.adds {
            Adds::Function(spec) => spec.sizes,
            _ => None,
        }
    }

    /// The word before its behaviour.
    pub fn sort(&self) -> &'static str {
        match self.adds {
            Adds::Function(_) => "function",
            Adds::Variable => "variable",
            Adds::Guest(_) => "not wired yet",
        }
    }
}

/// Everything that can be added beside `picture`, functions in the order of the reference.
pub fn entries(picture: &Picture) -> Vec<Entry> {
    let functions = intrinsic::table().map(|spec| {
        // The least size stands for all: more ports are more of the same.
        let size = spec.sizes.map_or(0, |(least, _)| least);
        Entry {
            title: spec.name.to_owned(),
            adds: Adds::Function(spec),
            behaviour: spec.behaviour.to_owned(),
            inputs: spec.inputs_of(size).map(|input| input.kinds).collect(),
            outputs: spec.outputs_of(size).map(|output| output.kinds).collect(),
        }
    });
    let variable = Entry {
        title: String::from("VARIABLE"),
        adds: Adds::Variable,
        behaviour: String::from("Remembers the last message; FETCH and VALUE(name) read it."),
        inputs: vec![Kinds::ANY],
        outputs: vec![Kinds::ANY],
    };
    let guests = picture.unwired.iter().map(|other| Entry {
        title: other.name.to_string(),
        adds: Adds::Guest(other.name.clone()),
        behaviour: match other.role {
            Role::Device => String::from("Device."),
            Role::Parameter => {
                let first = meaning(other.name.as_str(), Input::Number(1));
                format!("Parameter: {}.", first.unwrap_or("of the host"))
            }
            _ => format!("Display node, {}.", other.what),
        },
        inputs: other.inputs.iter().map(|port| port.kinds).collect(),
        outputs: other.outputs.iter().map(|port| port.kinds).collect(),
    });
    functions.chain([variable]).chain(guests).collect()
}

/// What an inlet of a parameter does.
pub fn meaning(name: &str, input: Input) -> Option<&'static str> {
    let Input::Number(number) = input else {
        return None;
    };
    let mut parameters = rig::parameters::PARAMETERS.iter();
    let known = parameters.find(|parameter| parameter.name.eq_ignore_ascii_case(name))?;
    let inlet = known.inlets.get(usize::from(number).checked_sub(1)?)?;
    Some(inlet.meaning)
}

/// What an added box must be able to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Want {
    /// Anything.
    #[default]
    Any,
    /// Take one of these kinds.
    Takes(Kinds),
    /// Send one of these kinds.
    Sends(Kinds),
}

impl Want {
    /// The port of an entry that answers, from 0: the first that takes all, or else the first that takes any.
    pub fn port(self, entry: &Entry) -> Option<usize> {
        let (ports, kinds) = match self {
            Want::Any => return Some(0),
            Want::Takes(kinds) => (&entry.inputs, kinds),
            Want::Sends(kinds) => (&entry.outputs, kinds),
        };
        let all = |port: &Kinds| kinds.iter().all(|kind: Kind| port.has(kind));
        let whole = ports.iter().position(all);
        whole.or_else(|| ports.iter().position(|port| port.meets(kinds)))
    }
}
