//! Instances coming and going.

use std::collections::BTreeSet;

use super::Network;
use super::connection::{Inlet, InstanceId, Outlet};
use super::instance::{Behaviour, Description, Role};
use super::output::OutputPort;
use super::port::InputPort;
use super::queues::Head;
use crate::intrinsic::{Does, Inputs, OutputSpec, Outputs, Spec};
use crate::language::Name;
use crate::structure::NodeId;
use crate::value::Kinds;

/// Vacant ports are left alone up to this many, and as long as they are the smaller part.
const VACANT_MAX: usize = 1024;

impl Network {
    /// How many more instances there may be.
    pub(crate) fn room(&self) -> usize {
        let there_are = self.descriptions.len() - self.vacant.len();
        self.limits.instances_max.saturating_sub(there_are)
    }

    /// Makes an instance with empty queues and no connections. Nothing if there are too many.
    pub(crate) fn add(
        &mut self,
        name: Name,
        spec: &'static Spec,
        size: Option<u8>,
        role: Role,
    ) -> Option<InstanceId> {
        let outputs: Vec<_> = spec.outputs_of(size.unwrap_or(0)).collect();
        self.add_with(name, spec, size, role, &outputs)
    }

    /// Makes a device of the host's, with these outputs. Nothing if there are too many instances.
    pub(crate) fn add_source(
        &mut self,
        name: Name,
        spec: &'static Spec,
        outputs: &[Kinds],
    ) -> Option<InstanceId> {
        let outputs: Vec<_> = outputs.iter().map(|&kinds| OutputSpec::of(kinds)).collect();
        self.add_with(name, spec, None, Role::Device, &outputs)
    }

    /// Whether an instance is a declared device with these outputs.
    pub(crate) fn sends_as_declared(&self, id: InstanceId, outputs: &[Kinds]) -> bool {
        self.instance(id).is_some_and(|instance| {
            let ports = instance.output_ports().iter().map(|port| port.kinds);
            instance.is_declared() && ports.eq(outputs.iter().copied())
        })
    }

    fn add_with(
        &mut self,
        name: Name,
        spec: &'static Spec,
        size: Option<u8>,
        role: Role,
        outputs: &[OutputSpec],
    ) -> Option<InstanceId> {
        if self.room() == 0 {
            return None;
        }
        let of = size.unwrap_or(0);
        let description = Some(Description {
            name,
            spec,
            size,
            role,
            made: self.making.clone(),
            serial: self.made,
        });
        self.made += 1;
        let head = self.add_ports(spec, of, outputs);
        let behaviour = Behaviour::of(spec, of);
        let id = if let Some(index) = self.vacant.pop() {
            let at = index as usize;
            self.descriptions[at] = description;
            self.behaviours[at] = behaviour;
            self.queues.heads[at] = head;
            InstanceId(index)
        } else {
            self.descriptions.push(description);
            self.behaviours.push(behaviour);
            self.queues.heads.push(head);
            self.queues.ready.reserve(self.descriptions.len());
            InstanceId(self.descriptions.len() as u32 - 1)
        };
        self.queues.recount(id);
        if matches!(spec.does, Does::Clock(_)) {
            self.clocks.push(id);
            self.start_clock(id);
        }
        Some(id)
    }

    fn add_ports(&mut self, spec: &'static Spec, size: u8, outputs: &[OutputSpec]) -> Head {
        let (first_input, first_output) = (self.queues.inputs.len(), self.outputs.len());
        self.queues
            .inputs
            .extend(spec.inputs_of(size).map(InputPort::new));
        self.outputs.extend(outputs.iter().copied().map(OutputPort::new));
        Head {
            scalar: spec.scalar.filter(|_| !spec.each),
            first_input: first_input as u32,
            first_output: first_output as u32,
            input_count: (self.queues.inputs.len() - first_input) as u8,
            output_count: (self.outputs.len() - first_output) as u8,
            size,
            each: spec.each,
            ..Head::default()
        }
    }

    fn start_clock(&mut self, id: InstanceId) {
        let inputs = Inputs::new(self.queues.ports(id), 0);
        if let Some(clock) = self.behaviours.get_mut(id.0 as usize) {
            // The first call only tells the clock what time it is.
            let _ = clock.advance(
                self.now,
                &inputs,
                &mut Outputs::new(&mut [], &mut self.sent, &mut self.errands),
            );
        }
        self.sent.clear();
        self.errands.clear();
    }

    /// Removes instances and every connection to them or to the nodes.
    pub(crate) fn remove(&mut self, instances: &BTreeSet<InstanceId>, nodes: &BTreeSet<NodeId>) {
        self.turn_away(instances, nodes);
        self.part_from(instances, nodes);
        for &id in instances {
            let Some(head) = self.queues.head(id).copied() else {
                continue;
            };
            self.vacant_ports += head.inputs().len() + head.outputs().len();
            for (at, output) in (1..).zip(head.outputs()) {
                let Some(port) = self.outputs.get_mut(output) else {
                    continue;
                };
                for &inlet in port.to() {
                    self.wires.remove(&(inlet, Outlet { from: id, output: at }));
                }
                *port = OutputPort::vacant();
            }
            if let Some(description) = self.descriptions.get_mut(id.0 as usize)
                && let Some(gone) = description.take()
            {
                self.vacant.push(id.0);
                if matches!(gone.spec.does, Does::Clock(_)) {
                    self.clocks.retain(|&clock| clock != id);
                }
            }
            if let Some(behaviour) = self.behaviours.get_mut(id.0 as usize) {
                *behaviour = Behaviour::Pure(|_, _| Ok(()));
            }
        }
        self.queues.clear(instances);
        if self.vacant_ports > VACANT_MAX
            && 2 * self.vacant_ports > self.queues.inputs.len() + self.outputs.len()
        {
            self.close_gaps();
        }
    }

    /// Parts everything that feeds the instances or nodes from them.
    fn part_from(&mut self, instances: &BTreeSet<InstanceId>, nodes: &BTreeSet<NodeId>) {
        let mut gone: Vec<(Inlet, Outlet)> = Vec::new();
        for &to in instances {
            gone.extend(self.feeding_instance(to));
        }
        for &to in nodes {
            gone.extend(self.feeding_node(to));
        }
        let feeding: BTreeSet<_> = gone.iter().map(|&(_, from)| from).collect();
        for from in feeding {
            if let Ok(output) = self.output_mut(from) {
                output.retain(|inlet| match inlet {
                    Inlet::Function { to, .. } => !instances.contains(&to),
                    Inlet::Node { to, .. } => !nodes.contains(&to),
                    Inlet::Sink { .. } => true,
                });
            }
        }
        for wire in gone {
            self.wires.remove(&wire);
        }
    }

    /// Moves all ports together, in the order of the instances' numbers.
    fn close_gaps(&mut self) {
        let mut inputs = Vec::with_capacity(self.queues.inputs.len() / 2);
        let mut outputs = Vec::with_capacity(self.outputs.len() / 2);
        for head in &mut self.queues.heads {
            let (from_inputs, from_outputs) = (head.inputs(), head.outputs());
            (head.first_input, head.first_output) = (inputs.len() as u32, outputs.len() as u32);
            let ports = self.queues.inputs.get_mut(from_inputs).unwrap_or_default();
            inputs.extend(
                ports
                    .iter_mut()
                    .map(|port| std::mem::replace(port, InputPort::vacant())),
            );
            let ports = self.outputs.get_mut(from_outputs).unwrap_or_default();
            outputs.extend(
                ports
                    .iter_mut()
                    .map(|port| std::mem::replace(port, OutputPort::vacant())),
            );
        }
        self.queues.inputs = inputs;
        self.outputs = outputs;
        self.vacant_ports = 0;
    }
}
