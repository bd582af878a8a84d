//! One instance of a function: a device, a variable or an `F:` of the user.

use super::connection::{Inlet, InstanceId};
use super::port::{InputPort, OutputPort};
use crate::intrinsic::{Does, Fault, Function, Inputs, Outputs, Spec};
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
    /// There from the start, sends what the hands do.
    Device,
}

enum Behaviour {
    Pure(fn(&Inputs<'_>, &mut Outputs<'_>) -> Result<(), Fault>),
    Stateful(Box<dyn Function>),
}

/// An instance, its queues and its connections.
pub(crate) struct Instance {
    pub(crate) name: Name,
    pub(crate) spec: &'static Spec,
    /// For sized types.
    pub(crate) size: Option<u8>,
    pub(crate) role: Role,
    /// Counts instances ever made; listings are in this order.
    pub(super) serial: u64,
    pub(super) inputs: Box<[InputPort]>,
    pub(super) outputs: Box<[OutputPort]>,
    /// How many inputs still keep it from firing.
    missing: usize,
    /// Whether any one message sets it off.
    each: bool,
    /// Whether it is in the run queue.
    pub(super) queued: bool,
    behaviour: Behaviour,
}

impl Instance {
    pub(super) fn new(name: Name, spec: &'static Spec, size: Option<u8>, role: Role, serial: u64) -> Self {
        let of = size.unwrap_or(0);
        let mut instance = Self {
            name,
            spec,
            size,
            role,
            serial,
            inputs: spec.inputs_of(of).map(InputPort::new).collect(),
            outputs: spec.outputs_of(of).map(OutputPort::new).collect(),
            missing: 0,
            each: spec.each,
            queued: false,
            behaviour: match spec.does {
                Does::Pure(fire) => Behaviour::Pure(fire),
                Does::Stateful(make) | Does::Clock(make) => Behaviour::Stateful(make(of)),
            },
        };
        instance.recount();
        instance
    }

    /// As reports name it.
    pub(crate) fn what(&self) -> String {
        match self.role {
            Role::Function => match self.size {
                Some(size) => format!("F:{}({size})", self.spec.name),
                None => format!("F:{}", self.spec.name),
            },
            Role::Variable => "variable".to_owned(),
            Role::Device => "device".to_owned(),
        }
    }

    pub(super) fn recount(&mut self) {
        self.missing = self.inputs.iter().filter(|port| !port.satisfied()).count();
        if self.inputs.iter().all(|port| port.constant) {
            self.missing += 1; // Nothing is left that could set it off.
        }
    }

    pub(super) fn ready(&self) -> bool {
        self.missing == 0
            || (self.each
                && self
                    .inputs
                    .iter()
                    .any(|port| !port.constant && port.waiting() > 0))
    }

    /// One input that kept it from firing no longer does.
    pub(super) fn satisfy_one(&mut self) {
        self.missing = self.missing.saturating_sub(1);
    }

    pub(super) fn fire(&mut self, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let inputs = Inputs::new(&self.inputs, self.size.unwrap_or(0));
        match &mut self.behaviour {
            Behaviour::Pure(fire) => fire(&inputs, outputs),
            Behaviour::Stateful(function) => function.fire(&inputs, outputs),
        }
    }

    pub(super) fn advance(
        &mut self,
        now: crate::intrinsic::Now,
        outputs: &mut Outputs<'_>,
    ) -> Result<(), Fault> {
        match &mut self.behaviour {
            Behaviour::Pure(_) => Ok(()),
            Behaviour::Stateful(function) => {
                function.advance(now, &Inputs::new(&self.inputs, self.size.unwrap_or(0)), outputs)
            }
        }
    }

    /// See [`Function::remembered`]; functions of the inputs alone remember nothing.
    pub(crate) fn remembered(&self) -> Vec<Value> {
        match &self.behaviour {
            Behaviour::Pure(_) => Vec::new(),
            Behaviour::Stateful(function) => function.remembered(),
        }
    }

    /// See [`Function::recall`].
    pub(super) fn recall(&mut self, state: &[Value]) -> bool {
        match &mut self.behaviour {
            Behaviour::Pure(_) => state.is_empty(),
            Behaviour::Stateful(function) => function.recall(state),
        }
    }

    pub(super) fn constant_set(&mut self, number: u8) {
        if let Behaviour::Stateful(function) = &mut self.behaviour {
            function.constant_set(number);
        }
    }

    /// Takes one message from every active queue; returns how many moved up from behind them.
    pub(super) fn consume(&mut self) -> usize {
        let mut moved = 0;
        if self.each {
            let first = self
                .inputs
                .iter()
                .position(|port| !port.constant && port.waiting() > 0);
            return first.map_or(0, |at| self.consume_offending(at as u8 + 1));
        }
        for port in self.inputs.iter_mut().filter(|port| !port.constant) {
            moved += port.pop();
            if port.waiting() == 0 {
                self.missing += 1;
            }
        }
        moved
    }

    /// Takes the one message that did not fit: at `input`, or, where that is a constant, at the first
    /// active input. Returns how many (0 or 1) moved up from behind it.
    pub(super) fn consume_offending(&mut self, input: u8) -> usize {
        let blamed = usize::from(input).wrapping_sub(1);
        let at = match self.inputs.get(blamed) {
            Some(port) if !port.constant => Some(blamed),
            _ => self.inputs.iter().position(|port| !port.constant),
        };
        let Some(port) = at.and_then(|at| self.inputs.get_mut(at)) else {
            return 0;
        };
        let moved = port.pop();
        if port.waiting() == 0 {
            self.missing += 1;
        }
        moved
    }

    /// How many messages wait behind another in all queues.
    pub(super) fn behind(&self) -> usize {
        self.inputs.iter().map(InputPort::behind).sum()
    }

    pub(crate) fn input_count(&self) -> usize {
        self.inputs.len()
    }

    pub(crate) fn output_count(&self) -> usize {
        self.outputs.len()
    }

    fn input(&self, number: u8) -> Option<&InputPort> {
        self.inputs.get(usize::from(number).checked_sub(1)?)
    }

    fn output(&self, number: u8) -> Option<&OutputPort> {
        self.outputs.get(usize::from(number).checked_sub(1)?)
    }

    /// What SETUP CNESS has made of an input, if it has changed it.
    pub(crate) fn changed_cness(&self, number: u8) -> Option<bool> {
        self.input(number)
            .filter(|port| !port.as_built)
            .map(|port| port.constant)
    }

    /// The constant somebody sent to an input.
    pub(crate) fn held_if_set(&self, number: u8) -> Option<&Value> {
        self.input(number).and_then(InputPort::held_if_set)
    }

    /// The messages waiting at an input, oldest first.
    pub(crate) fn queued(&self, number: u8) -> impl Iterator<Item = &Value> {
        self.input(number).into_iter().flat_map(InputPort::queued)
    }

    pub(crate) fn output_kinds(&self, number: u8) -> Kinds {
        self.output(number).map_or(Kinds::NONE, |port| port.kinds)
    }

    pub(crate) fn output_last(&self, number: u8) -> Option<&Value> {
        self.output(number).and_then(|port| port.last.as_ref())
    }

    /// The inputs, from <1>.
    pub(crate) fn input_ports(&self) -> &[InputPort] {
        &self.inputs
    }

    /// The outputs, from <1>.
    pub(crate) fn output_ports(&self) -> &[OutputPort] {
        &self.outputs
    }

    pub(crate) fn input_views<'a>(&'a self) -> Vec<InputView<'a>> {
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

    /// Drops connections; true keeps one.
    pub(super) fn retain(&mut self, mut keep: impl FnMut(Inlet) -> bool) {
        for output in &mut self.outputs {
            output.to.retain(|&inlet| keep(inlet));
        }
    }
}

/// An instance with the id it is addressed by.
#[derive(Clone, Copy)]
pub(crate) struct Numbered<'a> {
    pub(crate) id: InstanceId,
    pub(crate) instance: &'a Instance,
}
