//! One instance of a function: a device, a variable or an `F:` of the user.

use super::connection::InstanceId;
use super::made::Made;
use super::output::OutputPort;
use super::port::InputPort;
use crate::intrinsic::{Does, Fault, Fire, Function, Inputs, Now, Outputs, Spec};
use crate::language::Name;
use crate::machine::InputView;
use crate::value::{Kinds, Value};

/// What an instance is to the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Made by `name := F:TYPE`.
    Function,
    /// Made by `VARIABLE name`.
    Variable,
    /// There from the start or declared by the host; sends what the hands do.
    Device,
    /// Sends for a display node, and has its name.
    Node,
}

/// How an instance computes what it sends.
pub(super) enum Behaviour {
    Pure(Fire),
    Stateful(Box<dyn Function>),
}

impl Behaviour {
    pub(super) fn of(spec: &Spec, size: u8) -> Self {
        match spec.does {
            Does::Pure(fire) => Self::Pure(fire),
            Does::Stateful(make) | Does::Clock(make) => Self::Stateful(make(size)),
        }
    }

    pub(super) fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        match self {
            Self::Pure(fire) => fire(inputs, outputs),
            Self::Stateful(function) => function.fire(inputs, outputs),
        }
    }

    pub(super) fn advance(
        &mut self,
        now: Now,
        inputs: &Inputs<'_>,
        outputs: &mut Outputs<'_>,
    ) -> Result<(), Fault> {
        match self {
            Self::Pure(_) => Ok(()),
            Self::Stateful(function) => function.advance(now, inputs, outputs),
        }
    }

    pub(super) fn found(&mut self) {
        if let Self::Stateful(function) = self {
            function.found();
        }
    }

    pub(super) fn constant_set(&mut self, number: u8) {
        if let Self::Stateful(function) = self {
            function.constant_set(number);
        }
    }

    /// See [`Function::recall`].
    pub(super) fn recall(&mut self, state: &[Value]) -> bool {
        match self {
            Self::Pure(_) => state.is_empty(),
            Self::Stateful(function) => function.recall(state),
        }
    }
}

/// What is known of an instance and no message touches.
pub(super) struct Description {
    pub(super) name: Name,
    pub(super) spec: &'static Spec,
    /// For sized types.
    pub(super) size: Option<u8>,
    pub(super) role: Role,
    /// The command that made it.
    pub(super) made: Option<Made>,
    /// Counts instances ever made; listings are in this order.
    pub(super) serial: u64,
}

impl Description {
    /// See [`Instance::is_declared`].
    pub(super) fn is_declared(&self) -> bool {
        self.role == Role::Device && std::ptr::eq(self.spec, &raw const crate::machine::DECLARED)
    }

    /// Its place in listings: devices of the machine, those of the host by name (which comes first is chance),
    /// what commands made, and last what sends for nodes, since a program makes that with its wires.
    pub(super) fn place(&self) -> (u8, Option<&Name>, u64) {
        match self.role {
            Role::Device if self.is_declared() => (1, Some(&self.name), 0),
            Role::Device => (0, None, self.serial),
            Role::Function | Role::Variable => (2, None, self.serial),
            Role::Node => (3, None, self.serial),
        }
    }

    /// As reports name it.
    pub(super) fn what(&self) -> String {
        match self.role {
            Role::Function => match self.size {
                Some(size) => format!("F:{}({size})", self.spec.name),
                None => format!("F:{}", self.spec.name),
            },
            Role::Variable => "variable".to_owned(),
            Role::Device => "device".to_owned(),
            Role::Node => "node".to_owned(),
        }
    }
}

/// An instance, its queues and its connections, to look at.
#[derive(Clone, Copy)]
pub(crate) struct Instance<'a> {
    pub(crate) name: &'a Name,
    pub(crate) spec: &'static Spec,
    /// For sized types.
    pub(crate) size: Option<u8>,
    pub(crate) role: Role,
    pub(super) description: &'a Description,
    pub(super) inputs: &'a [InputPort],
    pub(super) outputs: &'a [OutputPort],
    pub(super) behaviour: &'a Behaviour,
}

impl<'a> Instance<'a> {
    /// As reports name it.
    pub(crate) fn what(self) -> String {
        self.description.what()
    }

    /// See [`Function::remembered`]; functions of the inputs alone remember nothing.
    pub(crate) fn remembered(self) -> Vec<Value> {
        match self.behaviour {
            Behaviour::Pure(_) => Vec::new(),
            Behaviour::Stateful(function) => function.remembered(),
        }
    }

    /// Whether the host declared it, rather than the machine having it from the start.
    pub(crate) fn is_declared(self) -> bool {
        self.description.is_declared()
    }

    pub(crate) fn input_count(self) -> usize {
        self.inputs.len()
    }

    pub(crate) fn output_count(self) -> usize {
        self.outputs.len()
    }

    fn input(self, number: u8) -> Option<&'a InputPort> {
        self.inputs.get(usize::from(number).checked_sub(1)?)
    }

    fn output(self, number: u8) -> Option<&'a OutputPort> {
        self.outputs.get(usize::from(number).checked_sub(1)?)
    }

    /// What SETUP CNESS has made of an input, if it has changed it.
    pub(crate) fn changed_cness(self, number: u8) -> Option<bool> {
        self.input(number)
            .filter(|port| !port.as_built)
            .map(|port| port.constant)
    }

    /// The constant somebody sent to an input.
    pub(crate) fn held_if_set(self, number: u8) -> Option<&'a Value> {
        self.input(number).and_then(InputPort::held_if_set)
    }

    /// The messages waiting at an input, oldest first.
    pub(crate) fn queued(self, number: u8) -> impl Iterator<Item = &'a Value> {
        self.input(number).into_iter().flat_map(InputPort::queued)
    }

    pub(crate) fn output_kinds(self, number: u8) -> Kinds {
        self.output(number).map_or(Kinds::NONE, |port| port.kinds)
    }

    pub(crate) fn output_last(self, number: u8) -> Option<&'a Value> {
        self.output(number).and_then(|port| port.last.as_ref())
    }

    /// The inputs, from <1>.
    pub(crate) fn input_ports(self) -> &'a [InputPort] {
        self.inputs
    }

    /// The outputs, from <1>.
    pub(crate) fn output_ports(self) -> &'a [OutputPort] {
        self.outputs
    }

    pub(crate) fn input_views(self) -> Vec<InputView<'a>> {
        let view = |port: &'a InputPort| {
            let InputPort { kinds, constant, .. } = *port;
            InputView {
                kinds,
                constant,
                waiting: port.waiting(),
                front: port.front(),
            }
        };
        self.inputs.iter().map(view).collect()
    }
}

/// An instance with the id it is addressed by.
#[derive(Clone, Copy)]
pub(crate) struct Numbered<'a> {
    pub(crate) id: InstanceId,
    pub(crate) instance: Instance<'a>,
}
