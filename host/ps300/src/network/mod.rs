//! The function network: instances joined output to input, fired when their messages are complete.
//!
//! Not sorted by dependence: cycles are legal and useful, and bounds on queues and firings take the
//! place of a sort. The order of everything is fixed (see `run`), so the same messages give the same
//! results in every run.
//! Source: `docs/protocols/ps300.md`, "Execution model" and "What dialrig decides".

mod batch;
mod connection;
mod instance;
mod port;
mod report;
mod run;
mod sink;

pub(crate) use batch::Arrival;
pub use connection::{ConnectError, InstanceId, Outlet, SinkId};
pub(crate) use connection::{Inlet, input_text};
pub use instance::Role;
pub(crate) use instance::{Instance, Numbered};
pub use port::InputPort;
pub(crate) use port::OutputPort;
pub(crate) use report::Reports;
pub use report::{Cause, Report};
pub use run::Ran;
pub(crate) use run::{Refusal, Surroundings};
pub(crate) use sink::Sink;

use std::collections::{BTreeSet, VecDeque};

use batch::{Allowance, Arrivals};

use crate::intrinsic::{Errand, Now, Outputs, Spec};
use crate::language::Name;
use crate::structure::NodeId;
use crate::value::{Kinds, Value};

/// What bounds a network. The defaults leave room for everything meant and end everything runaway.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Messages waiting at one input.
    pub queue_max: usize,
    /// Messages waiting behind another in the whole network. The first message at an input is not counted, so
    /// that no part of a network can keep another from going on.
    pub behind_max: usize,
    /// Inputs fed by one output.
    pub fan_out_max: usize,
    /// Messages for the host, and watched messages, between two drains.
    pub undrained_max: usize,
    /// Messages of the host that wait for the firings of earlier ones.
    pub arrivals_max: usize,
    /// Batches that wait so; ticks beyond are taken together.
    pub batches_max: usize,
    /// Firings after which the messages of the next batch are let in although those of the last are not over.
    /// What goes round for ever takes as much of every batch, so it cannot shut out the host.
    pub firings_per_batch: u32,
    /// Firings after each command.
    pub firings_per_command: u32,
    /// Firings of all commands of one text together; when they are used up each further command gets a few.
    pub firings_per_load: u32,
    /// Instances, devices and variables.
    pub instances_max: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            queue_max: 1024,
            behind_max: 65_536,
            fan_out_max: 16_384,
            undrained_max: 65_536,
            arrivals_max: 65_536,
            batches_max: 256,
            firings_per_batch: 4096,
            firings_per_command: 10_000,
            firings_per_load: 2_000_000,
            instances_max: 100_000,
        }
    }
}

/// A message seen by [`crate::Machine::watch`].
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// Network time of the sending, as of the last tick.
    pub secs: f64,
    /// Who sent.
    pub name: Name,
    /// On which output, from 1.
    pub output: u8,
    /// What.
    pub value: Value,
}

/// All instances, their queues and connections, and who fires next.
pub(crate) struct Network {
    slots: Vec<Option<Instance>>,
    vacant: Vec<u32>,
    made: u64,
    sinks: Vec<Sink>,
    /// Instances that became ready, oldest first.
    ready: VecDeque<InstanceId>,
    clocks: Vec<InstanceId>,
    /// Messages waiting behind another.
    behind: usize,
    delivered: u64,
    arrivals: Arrivals,
    batch: Allowance,
    /// Whether the firings of the last batch let in are over.
    batch_over: bool,
    pub(crate) limits: Limits,
    pub(crate) now: Now,
    pub(crate) reports: Reports,
    arrived: VecDeque<(SinkId, u8, Value)>,
    watched: VecDeque<Watched>,
    // Lent to each firing and given back, so that firing does not allocate.
    sent: Vec<(u8, Value)>,
    errands: Vec<Errand>,
}

impl Network {
    pub(crate) fn new(limits: Limits) -> Self {
        Self {
            slots: Vec::new(),
            vacant: Vec::new(),
            made: 0,
            sinks: Vec::new(),
            ready: VecDeque::new(),
            clocks: Vec::new(),
            behind: 0,
            delivered: 0,
            arrivals: Arrivals::default(),
            batch: Allowance::default(),
            batch_over: true,
            limits,
            now: Now::default(),
            reports: Reports::default(),
            arrived: VecDeque::new(),
            watched: VecDeque::new(),
            sent: Vec::new(),
            errands: Vec::new(),
        }
    }

    /// How many more instances there may be.
    pub(crate) fn room(&self) -> usize {
        self.limits
            .instances_max
            .saturating_sub(self.slots.len() - self.vacant.len())
    }

    /// Makes an instance with empty queues and no connections. Nothing if there are too many.
    pub(crate) fn add(
        &mut self,
        name: Name,
        spec: &'static Spec,
        size: Option<u8>,
        role: Role,
    ) -> Option<InstanceId> {
        if self.room() == 0 {
            return None;
        }
        let instance = Instance::new(name, spec, size, role, self.made);
        self.made += 1;
        let id = if let Some(index) = self.vacant.pop() {
            self.slots[index as usize] = Some(instance);
            InstanceId(index)
        } else {
            self.slots.push(Some(instance));
            InstanceId(self.slots.len() as u32 - 1)
        };
        if matches!(spec.does, crate::intrinsic::Does::Clock(_)) {
            self.clocks.push(id);
            self.start_clock(id);
        }
        Some(id)
    }

    fn start_clock(&mut self, id: InstanceId) {
        let now = self.now;
        let mut sent = std::mem::take(&mut self.sent);
        let mut errands = std::mem::take(&mut self.errands);
        if let Some(clock) = self.instance_mut(id) {
            // The first call only tells the clock what time it is.
            let _ = clock.advance(now, &mut Outputs::new(&mut sent, &mut errands));
        }
        sent.clear();
        errands.clear();
        self.sent = sent;
        self.errands = errands;
    }

    /// Removes instances and every connection to them or to the nodes.
    pub(crate) fn remove(&mut self, instances: &BTreeSet<InstanceId>, nodes: &BTreeSet<NodeId>) {
        if instances.is_empty() && nodes.is_empty() {
            return;
        }
        for id in instances {
            if let Some(instance) = self.slots.get_mut(id.0 as usize).and_then(Option::take) {
                self.behind -= instance.behind();
                self.vacant.push(id.0);
            }
        }
        self.ready.retain(|id| !instances.contains(id));
        self.clocks.retain(|id| !instances.contains(id));
        for instance in self.slots.iter_mut().flatten() {
            instance.retain(|inlet| match inlet {
                Inlet::Function { to, .. } => !instances.contains(&to),
                Inlet::Node { to, .. } => !nodes.contains(&to),
                Inlet::Sink { .. } => true,
            });
        }
    }

    /// Removes every connection.
    pub(crate) fn disconnect_everything(&mut self) {
        for instance in self.slots.iter_mut().flatten() {
            instance.retain(|_| false);
        }
    }

    pub(crate) fn instance(&self, id: InstanceId) -> Option<&Instance> {
        self.slots.get(id.0 as usize).and_then(Option::as_ref)
    }

    fn instance_mut(&mut self, id: InstanceId) -> Option<&mut Instance> {
        self.slots.get_mut(id.0 as usize).and_then(Option::as_mut)
    }

    /// Every instance, in the order they were made.
    pub(crate) fn instances(&self) -> Vec<Numbered<'_>> {
        let number =
            |(index, slot): (usize, &'_ Option<Instance>)| slot.as_ref().map(|_| InstanceId(index as u32));
        let mut all: Vec<_> = self
            .slots
            .iter()
            .enumerate()
            .filter_map(number)
            .filter_map(|id| self.instance(id).map(|instance| Numbered { id, instance }))
            .collect();
        all.sort_by_key(|numbered| numbered.instance.serial);
        all
    }

    /// Whether any output leads to `to`.
    pub(crate) fn is_fed(&self, to: InstanceId) -> bool {
        self.slots
            .iter()
            .flatten()
            .flat_map(|instance| &instance.outputs)
            .flat_map(|output| &output.to)
            .any(|inlet| matches!(inlet, Inlet::Function { to: fed, .. } if *fed == to))
    }

    /// Joins two ends; false if they were joined already.
    pub(crate) fn connect(&mut self, from: Outlet, to: Inlet, accepted: Kinds) -> Result<bool, ConnectError> {
        let max = self.limits.fan_out_max;
        let output = self.output_mut(from)?;
        let offered = output.kinds;
        let joined = output.to.contains(&to);
        let full = output.to.len() >= max;
        if !offered.meets(accepted) {
            let to = self.inlet_text(to);
            return Err(ConnectError::Kinds {
                from: self.outlet_text(from),
                to,
                offered,
                accepted,
            });
        }
        if full && !joined {
            return Err(ConnectError::FanOut {
                from: self.outlet_text(from),
                max,
            });
        }
        if !joined {
            self.output_mut(from)?.to.push(to);
        }
        Ok(!joined)
    }

    /// Parts two ends; false if they were not joined. Messages already queued stay.
    pub(crate) fn disconnect(&mut self, from: Outlet, to: Inlet) -> Result<bool, ConnectError> {
        let output = self.output_mut(from)?;
        let before = output.to.len();
        output.to.retain(|&inlet| inlet != to);
        Ok(output.to.len() < before)
    }

    /// Parts an output from everything.
    pub(crate) fn disconnect_output(&mut self, from: Outlet) -> Result<(), ConnectError> {
        self.output_mut(from)?.to.clear();
        Ok(())
    }

    /// Parts every output of an instance.
    pub(crate) fn disconnect_all(&mut self, id: InstanceId) {
        if let Some(instance) = self.instance_mut(id) {
            instance.retain(|_| false);
        }
    }

    /// What an input takes; nothing if there is no such input.
    pub(crate) fn accepts(&self, id: InstanceId, input: u8) -> Option<Kinds> {
        let port = self
            .instance(id)?
            .inputs
            .get(usize::from(input).checked_sub(1)?)?;
        Some(port.kinds)
    }

    /// Makes an input constant or active; false if there is no such input.
    pub(crate) fn set_constant(&mut self, id: InstanceId, input: u8, constant: bool) -> bool {
        let Some(instance) = self.instance_mut(id) else {
            return false;
        };
        let Some(port) = usize::from(input)
            .checked_sub(1)
            .and_then(|at| instance.inputs.get_mut(at))
        else {
            return false;
        };
        let gone = port.make_constant(constant);
        instance.constant_set(input);
        instance.recount();
        let ready = instance.ready();
        let queued = instance.queued;
        self.behind -= gone;
        if ready && !queued {
            self.enqueue(id);
        }
        true
    }

    /// See [`crate::intrinsic::Function::recall`]. False also where there is no such instance.
    pub(crate) fn recall(&mut self, id: InstanceId, state: &[Value]) -> bool {
        self.instance_mut(id)
            .is_some_and(|instance| instance.recall(state))
    }

    /// The instances that are ready to fire, in their turn.
    pub(crate) fn ready(&self) -> impl Iterator<Item = InstanceId> + '_ {
        self.ready.iter().copied()
    }

    /// What a constant or variable holds at its first input.
    pub(crate) fn held(&self, id: InstanceId) -> Option<&Value> {
        self.instance(id)?.inputs.first()?.front()
    }

    pub(crate) fn outlet(&self, from: InstanceId, output: u8) -> Option<Outlet> {
        let port = usize::from(output).checked_sub(1)?;
        self.instance(from)?.outputs.get(port)?;
        Some(Outlet { from, output })
    }

    pub(crate) fn destinations(&self, from: Outlet) -> &[Inlet] {
        self.instance(from.from)
            .and_then(|instance| instance.outputs.get(usize::from(from.output).wrapping_sub(1)))
            .map_or(&[], |output| &output.to)
    }

    pub(crate) fn watch(&mut self, from: Outlet, on: bool) {
        if let Ok(output) = self.output_mut(from) {
            output.watched = on;
        }
    }

    /// Withholds what an output would send, or lets it send again.
    pub(crate) fn freeze(&mut self, from: Outlet, on: bool) {
        if let Ok(output) = self.output_mut(from) {
            output.frozen = on;
        }
    }

    fn output_mut(&mut self, from: Outlet) -> Result<&mut OutputPort, ConnectError> {
        let Some(instance) = self.slots.get_mut(from.from.0 as usize).and_then(Option::as_mut) else {
            let name = Name::new("(removed)");
            return Err(ConnectError::NoOutput {
                name,
                output: from.output,
                has: 0,
            });
        };
        let has = instance.outputs.len();
        match instance.outputs.get_mut(usize::from(from.output).wrapping_sub(1)) {
            Some(output) => Ok(output),
            None => Err(ConnectError::NoOutput {
                name: instance.name.clone(),
                output: from.output,
                has,
            }),
        }
    }

    pub(crate) fn outlet_text(&self, from: Outlet) -> String {
        let name = self
            .instance(from.from)
            .map_or("?", |instance| instance.name.as_str());
        format!("{name}<{}>", from.output)
    }

    fn inlet_text(&self, to: Inlet) -> String {
        match to {
            Inlet::Function { to, input } => {
                let name = self.instance(to).map_or("?", |instance| instance.name.as_str());
                format!("<{input}>{name}")
            }
            Inlet::Sink { to, input } => {
                let name = self.sink(to).map_or("?", |sink| sink.name.as_str());
                format!("<{input}>{name}")
            }
            Inlet::Node { input, .. } => format!("input {} of the node", input_text(input)),
        }
    }
}
