//! The network as a patch panel or a listing shows it.

use super::Machine;
use crate::intrinsic::Spec;
use crate::language::{Input, InputOf, Name};
use crate::names::Thing;
use crate::network::{Inlet, InstanceId, Numbered, Outlet, Role};
use crate::value::{Kinds, Value};

/// One function instance, variable or device.
#[derive(Clone, Debug)]
pub struct InstanceView<'a> {
    /// Its name.
    pub name: &'a Name,
    /// Its row of the function table.
    pub spec: &'static Spec,
    /// Of a sized type.
    pub size: Option<u8>,
    /// Function, variable or device.
    pub role: Role,
    /// From <1>.
    pub inputs: Vec<InputView<'a>>,
    /// From <1>.
    pub outputs: Vec<OutputView<'a>>,
}

/// One input.
#[derive(Clone, Debug)]
pub struct InputView<'a> {
    /// What it takes.
    pub kinds: Kinds,
    /// Whether firings leave its message in place.
    pub constant: bool,
    /// Messages waiting.
    pub waiting: usize,
    /// What the next firing sees here.
    pub front: Option<&'a Value>,
}

/// One output.
#[derive(Clone, Debug)]
pub struct OutputView<'a> {
    /// What it may send.
    pub kinds: Kinds,
    /// Where to, in the order of delivery.
    pub to: Vec<InputOf>,
    /// What it sent last.
    pub last: Option<&'a Value>,
}

/// One wire.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConnectionView {
    /// Who sends.
    pub from: Name,
    /// On which output, from 1.
    pub output: u8,
    /// Who takes it.
    pub to: InputOf,
}

impl Machine {
    /// Every device, variable and function, devices first, then in the order they were made. Nodes that send
    /// are not among them.
    pub fn instances(&self) -> Vec<InstanceView<'_>> {
        self.network
            .instances()
            .into_iter()
            .filter(|numbered| numbered.instance.role != Role::Node)
            .map(|numbered| self.instance_view(numbered))
            .collect()
    }

    /// What the next firing of a function sees at an input: a constant, or the message that waits longest.
    pub fn front(&self, name: &str, input: u8) -> Option<&Value> {
        let Thing::Instance(id) = self.names.named(name)? else {
            return None;
        };
        let instance = self.network.instance(id)?;
        let port = instance.input_ports().get(usize::from(input).checked_sub(1)?)?;
        port.front()
    }

    /// Every wire, by sender in the order they were made.
    pub fn connections(&self) -> Vec<ConnectionView> {
        let mut wires = Vec::new();
        for Numbered { id, instance } in self.network.instances() {
            for output in 1..=instance.output_count() as u8 {
                for to in self.destinations(id, output) {
                    wires.push(ConnectionView {
                        from: instance.name.clone(),
                        output,
                        to,
                    });
                }
            }
        }
        wires
    }

    pub(super) fn destinations(&self, from: InstanceId, output: u8) -> Vec<InputOf> {
        let to = self.network.destinations(Outlet { from, output });
        to.iter().map(|&inlet| self.input_of(inlet)).collect()
    }

    /// The things an output feeds, in the order of delivery.
    pub(super) fn things_fed(&self, from: InstanceId, output: u8) -> impl Iterator<Item = Thing> + '_ {
        self.network
            .destinations(Outlet { from, output })
            .iter()
            .map(|inlet| match *inlet {
                Inlet::Function { to, .. } => Thing::Instance(to),
                Inlet::Sink { to, .. } => Thing::Sink(to),
                Inlet::Node { to, .. } => Thing::Node(to),
            })
    }

    /// The name a program prints a thing under: `known`, or a spare one where that was forgotten.
    pub(super) fn spelt(&self, thing: Thing, known: &Name) -> Name {
        if self.names.thing(known) == Some(thing) {
            return known.clone();
        }
        let entry = self
            .names
            .defined()
            .into_iter()
            .find(|&entry| self.names.denoted(entry) == Some(thing));
        entry.map_or_else(|| known.clone(), |entry| self.names.spelling(entry))
    }

    fn input_of(&self, inlet: Inlet) -> InputOf {
        let nowhere = || Name::new("?");
        match inlet {
            Inlet::Function { to, input } => InputOf {
                name: self.name_of(Thing::Instance(to)).unwrap_or_else(nowhere),
                input: Input::Number(input.into()),
            },
            Inlet::Sink { to, input } => InputOf {
                name: self
                    .network
                    .sink(to)
                    .map_or_else(nowhere, |sink| sink.name.clone()),
                input: Input::Number(input.into()),
            },
            Inlet::Node { to, input } => InputOf {
                name: self.name_of(Thing::Node(to)).unwrap_or_else(nowhere),
                input,
            },
        }
    }

    /// The name a thing was defined under.
    fn name_of(&self, thing: Thing) -> Option<Name> {
        match thing {
            Thing::Instance(id) => self.network.instance(id).map(|instance| instance.name.clone()),
            Thing::Node(id) => self.structure.slot(id).map(|slot| slot.name.clone()),
            Thing::Sink(id) => self.network.sink(id).map(|sink| sink.name.clone()),
        }
    }

    fn instance_view<'a>(&'a self, Numbered { id, instance }: Numbered<'a>) -> InstanceView<'a> {
        let outputs = (1..=instance.output_count() as u8)
            .map(|output| OutputView {
                kinds: instance.output_kinds(output),
                to: self.destinations(id, output),
                last: instance.output_last(output),
            })
            .collect();
        InstanceView {
            name: instance.name,
            spec: instance.spec,
            size: instance.size,
            role: instance.role,
            inputs: instance.input_views(),
            outputs,
        }
    }
}
