//! The function network: instances joined output to input, fired when their messages are complete.
//!
//! Not sorted by dependence: cycles are legal and useful, and bounds on queues and firings take the
//! place of a sort. The order of everything is fixed (see `run`), so the same messages give the same
//! results in every run.
//! Source: `docs/protocols/ps300.md`, "Execution model" and "What dialrig decides".

mod batch;
mod connection;
mod instance;
mod look;
mod made;
mod making;
mod output;
mod port;
mod queues;
mod rearrange;
mod report;
mod ring;
mod run;
mod send;
mod sink;
mod token;
mod wires;

pub(crate) use batch::Arrival;
pub use connection::{ConnectError, InstanceId, Outlet, SinkId};
pub(crate) use connection::{Inlet, input_text};
pub use instance::Role;
pub(crate) use instance::{Instance, Numbered};
pub use made::{Made, Places};
pub(crate) use output::OutputPort;
pub use port::InputPort;
pub(crate) use report::{About, Reports};
pub use report::{Cause, Report};
pub use run::Ran;
pub(crate) use run::{Refusal, Surroundings};
pub(crate) use sink::Sink;

use std::collections::{BTreeSet, VecDeque};

use batch::{Allowance, Arrivals};
use instance::{Behaviour, Description};
use queues::Queues;

use crate::intrinsic::{Errand, Now, Sent};
use crate::language::{Input, Name};
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
            instances_max: 1_000_000,
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
///
/// What belongs to an instance lies in several lists, by how often it is looked at: an instance is a number in
/// each. Inputs and outputs lie one behind the other in the order in which instances were made.
pub(crate) struct Network {
    queues: Queues,
    outputs: Vec<OutputPort>,
    behaviours: Vec<Behaviour>,
    descriptions: Vec<Option<Description>>,
    vacant: Vec<u32>,
    made: u64,
    /// Inputs and outputs whose instance is gone.
    vacant_ports: usize,
    /// Every wire from its far end, to find what feeds something without looking everywhere.
    wires: BTreeSet<(Inlet, Outlet)>,
    sinks: Vec<Sink>,
    clocks: Vec<InstanceId>,
    delivered: u64,
    arrivals: Arrivals,
    batch: Allowance,
    /// Whether the firings of the last batch let in are over.
    batch_over: bool,
    pub(crate) limits: Limits,
    pub(crate) now: Now,
    pub(crate) reports: Reports,
    /// The command that makes what is being made.
    pub(crate) making: Option<Made>,
    arrived: VecDeque<(SinkId, u8, Value)>,
    watched: VecDeque<Watched>,
    // Lent to each firing and given back, so that firing does not allocate.
    sent: Sent,
    errands: Vec<Errand>,
}

impl Network {
    pub(crate) fn new(limits: Limits) -> Self {
        Self {
            queues: Queues::new(&limits),
            outputs: Vec::new(),
            behaviours: Vec::new(),
            descriptions: Vec::new(),
            vacant: Vec::new(),
            made: 0,
            vacant_ports: 0,
            wires: BTreeSet::new(),
            sinks: Vec::new(),
            clocks: Vec::new(),
            delivered: 0,
            arrivals: Arrivals::default(),
            batch: Allowance::default(),
            batch_over: true,
            limits,
            now: Now::default(),
            reports: Reports::default(),
            making: None,
            arrived: VecDeque::new(),
            watched: VecDeque::new(),
            sent: Sent::default(),
            errands: Vec::new(),
        }
    }

    pub(crate) fn instance(&self, id: InstanceId) -> Option<Instance<'_>> {
        let at = id.0 as usize;
        let description = self.descriptions.get(at)?.as_ref()?;
        let head = self.queues.head(id)?;
        Some(Instance {
            name: &description.name,
            spec: description.spec,
            size: description.size,
            role: description.role,
            description,
            inputs: self.queues.ports(id),
            outputs: self.outputs.get(head.outputs())?,
            behaviour: self.behaviours.get(at)?,
        })
    }

    /// Every instance: devices, then what commands made in that order, then what sends for nodes.
    pub(crate) fn instances(&self) -> Vec<Numbered<'_>> {
        let mut all: Vec<_> = (0..self.descriptions.len() as u32)
            .map(InstanceId)
            .filter_map(|id| self.instance(id).map(|instance| Numbered { id, instance }))
            .collect();
        all.sort_by(|a, b| {
            a.instance
                .description
                .place()
                .cmp(&b.instance.description.place())
        });
        all
    }

    /// The instances that are ready to fire, in their turn.
    pub(crate) fn ready(&self) -> impl Iterator<Item = InstanceId> + '_ {
        self.queues.ready.iter()
    }

    /// What a constant or variable holds at its first input.
    pub(crate) fn held(&self, id: InstanceId) -> Option<&Value> {
        self.queues.ports(id).first()?.front()
    }

    /// What an input takes; nothing if there is no such input.
    pub(crate) fn accepts(&self, id: InstanceId, input: u8) -> Option<Kinds> {
        let port = self.queues.ports(id).get(usize::from(input).checked_sub(1)?)?;
        Some(port.kinds)
    }

    /// Makes an input constant or active; false if there is no such input.
    pub(crate) fn set_constant(&mut self, id: InstanceId, input: u8, constant: bool) -> bool {
        let Some(Some(description)) = self.descriptions.get(id.0 as usize) else {
            return false;
        };
        let mut specs = description.spec.inputs_of(description.size.unwrap_or(0));
        let Some(spec) = specs.nth(usize::from(input).wrapping_sub(1)) else {
            return false;
        };
        if let Some(behaviour) = self.behaviours.get_mut(id.0 as usize) {
            behaviour.constant_set(input);
        }
        self.queues.set_constant(id, input, constant, spec.preset)
    }

    /// See [`crate::intrinsic::Function::recall`]. False also where there is no such instance.
    pub(crate) fn recall(&mut self, id: InstanceId, state: &[Value]) -> bool {
        let behaviour = self.behaviours.get_mut(id.0 as usize);
        self.descriptions.get(id.0 as usize).is_some_and(Option::is_some)
            && behaviour.is_some_and(|behaviour| behaviour.recall(state))
    }

    pub(crate) fn report(&mut self, id: InstanceId, cause: Cause) {
        self.report_message(id, cause, || None);
    }

    /// The same with a message it happened to, and the input that came to.
    fn report_message(
        &mut self,
        id: InstanceId,
        cause: Cause,
        message: impl FnOnce() -> Option<(Option<Input>, Value)>,
    ) {
        if let Some(Some(description)) = self.descriptions.get(id.0 as usize) {
            let about = || About {
                what: description.what(),
                made: description.made.clone(),
                message: message(),
            };
            self.reports.note(&description.name, about, cause);
        }
    }
}
