//! Firing and delivering: the order in which everything happens.
//!
//! 1. The run queue holds the instances that became ready, oldest first.
//! 2. A firing first consumes its messages; if more are complete behind them the instance goes to the
//!    end of the queue; then its outputs are delivered, destination by destination, before anything
//!    else fires.
//! 3. When the firings allowed are used up the queue stays as it is and goes on at the next run, so how
//!    the firings are portioned does not change what comes out.
//! 4. Setting a constant sets nothing off. It can complete the inputs of an instance at whose active
//!    inputs messages were waiting for it.

use super::batch::Allowance;
use super::connection::{Inlet, InstanceId, Outlet, SinkId};
use super::port::copy;
use super::{Cause, Network, Watched};
use crate::intrinsic::{Errand, Fault, Now, Outputs};
use crate::language::Input;
use crate::language::Name;
use crate::structure::NodeId;
use crate::value::{Kinds, Value};

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ran {
    /// Nothing is left to fire.
    Quiet {
        /// How many instances fired.
        firings: u32,
    },
    /// The firings allowed were used up, those of this run or those of the batches it was given.
    OutOfBudget {
        /// How many instances fired.
        firings: u32,
        /// How many instances are ready and wait for the next run.
        waiting: u32,
    },
}

impl Ran {
    /// How many instances fired.
    pub fn firings(self) -> u32 {
        match self {
            Self::Quiet { firings } | Self::OutOfBudget { firings, .. } => firings,
        }
    }
}

/// Why something outside the network did not take a message.
pub(crate) enum Refusal {
    Kind(Kinds),
    Domain(&'static str),
}

/// What the network reaches beyond its instances.
pub(crate) trait Surroundings {
    /// Hands a message to a display node.
    fn node(&mut self, to: NodeId, input: Input, value: &Value) -> Result<(), Refusal>;
    /// The name of a display node and what kind of node it is.
    fn node_name(&self, to: NodeId) -> (Name, &'static str);
    /// Sees a message that reached the host.
    fn sink_arrived(&mut self, sink: SinkId, value: &Value);
    /// Looks up an input by name, for F:SEND.
    fn inlet(&self, name: &str, input: Input) -> Option<Inlet>;
    /// Looks up a variable by name, for F:FETCH.
    fn variable(&self, name: &str) -> Option<InstanceId>;
}

impl Network {
    /// Fires ready instances, oldest readiness first, `firings_max` at most, and lets in the batches whose
    /// turn it is. The sequence of firings does not depend on `firings_max`.
    pub(crate) fn run(&mut self, firings_max: u32, outside: &mut impl Surroundings) -> Ran {
        let slice = Allowance::new(firings_max, self.delivered);
        let mut firings = 0;
        loop {
            while !self.batch_over {
                let Some(&id) = self.ready.front() else {
                    break;
                };
                if self.batch.is_used_up(self.delivered) {
                    self.report(id, Cause::OutOfBudget);
                    break;
                }
                if firings == firings_max || slice.is_delivered(self.delivered) {
                    return self.interrupted(firings);
                }
                self.ready.pop_front();
                firings += 1;
                self.batch.firings_left -= 1;
                self.fire(id, outside);
            }
            self.batch_over = true;
            if !self.admit(outside) {
                break;
            }
        }
        if self.ready.is_empty() {
            Ran::Quiet { firings }
        } else {
            self.interrupted(firings)
        }
    }

    fn interrupted(&self, firings: u32) -> Ran {
        Ran::OutOfBudget {
            firings,
            waiting: self.ready.len() as u32,
        }
    }

    /// Moves network time and lets the clocks send; nothing fires yet.
    pub(super) fn advance(&mut self, now: Now, outside: &mut impl Surroundings) {
        self.now = now;
        for index in 0..self.clocks.len() {
            let id = self.clocks[index];
            let advance =
                |instance: &mut super::Instance, outputs: &mut Outputs<'_>| instance.advance(now, outputs);
            self.act(id, outside, advance, Self::note_fault);
        }
    }

    fn fire(&mut self, id: InstanceId, outside: &mut impl Surroundings) {
        let Some(instance) = self.instance_mut(id) else {
            return;
        };
        instance.queued = false;
        // SETUP CNESS may have come between becoming ready and firing.
        if instance.ready() {
            self.act(id, outside, super::Instance::fire, Self::consume);
        }
    }

    /// Lets an instance send, settles its inputs, and delivers what it sent.
    fn act<S: Surroundings>(
        &mut self,
        id: InstanceId,
        outside: &mut S,
        act: impl FnOnce(&mut super::Instance, &mut Outputs<'_>) -> Result<(), Fault>,
        settle: fn(&mut Self, InstanceId, &Result<(), Fault>),
    ) {
        let mut sent = std::mem::take(&mut self.sent);
        let mut errands = std::mem::take(&mut self.errands);
        if let Some(instance) = self.instance_mut(id) {
            let result = act(instance, &mut Outputs::new(&mut sent, &mut errands));
            settle(self, id, &result);
        }
        for (output, value) in &sent {
            self.send_out(
                Outlet {
                    from: id,
                    output: *output,
                },
                value,
                outside,
            );
        }
        sent.clear();
        for errand in errands.drain(..) {
            self.run_errand(id, errand, outside);
        }
        self.sent = sent;
        self.errands = errands;
    }

    fn note_fault(&mut self, id: InstanceId, result: &Result<(), Fault>) {
        if let Err(Fault::Domain { why }) = *result {
            self.report(id, Cause::Domain { why });
        }
    }

    fn consume(&mut self, id: InstanceId, result: &Result<(), Fault>) {
        let Some(instance) = self.slots.get_mut(id.0 as usize).and_then(Option::as_mut) else {
            return;
        };
        let mut cause = None;
        let taken = match *result {
            Ok(()) => instance.consume(),
            Err(Fault::Domain { why }) => {
                cause = Some(Cause::Domain { why });
                instance.consume()
            }
            Err(Fault::Kind { input, expected }) => {
                let port = instance.inputs.get(usize::from(input).wrapping_sub(1));
                if let Some(got) = port.and_then(|port| port.front()).map(Value::kind) {
                    cause = Some(Cause::Kind {
                        input: Input::Number(input.into()),
                        expected,
                        got,
                    });
                }
                instance.consume_offending(input)
            }
        };
        let again = instance.ready();
        self.behind -= taken;
        if let Some(cause) = cause {
            self.report(id, cause);
        }
        if again {
            self.enqueue(id);
        }
    }

    pub(super) fn enqueue(&mut self, id: InstanceId) {
        if let Some(instance) = self.instance_mut(id)
            && !instance.queued
        {
            instance.queued = true;
            self.ready.push_back(id);
        }
    }

    /// Sends on an output: to every destination in the order of CONNECT.
    pub(crate) fn send_out(&mut self, from: Outlet, value: &Value, outside: &mut impl Surroundings) {
        if !value.is_finite() {
            self.report(from.from, Cause::NotFinite);
            return;
        }
        let port = usize::from(from.output).wrapping_sub(1);
        let Some(output) = self
            .instance_mut(from.from)
            .and_then(|it| it.outputs.get_mut(port))
        else {
            return;
        };
        if output.frozen {
            output.withheld += 1;
            return;
        }
        output.sent += 1;
        copy(value, &mut output.last);
        let watched = output.watched;
        let to = std::mem::take(&mut output.to);
        if watched {
            self.record(from, value);
        }
        for &inlet in &to {
            self.deliver(inlet, value, outside);
        }
        // Delivering only queues: nothing ran that could have changed the connections.
        if let Some(output) = self
            .instance_mut(from.from)
            .and_then(|it| it.outputs.get_mut(port))
        {
            output.to = to;
        }
    }

    fn record(&mut self, from: Outlet, value: &Value) {
        let Some(instance) = self.instance(from.from) else {
            return;
        };
        if self.watched.len() >= self.limits.undrained_max {
            return self.report(from.from, Cause::Unwatched);
        }
        let (secs, name) = (self.now.secs, instance.name.clone());
        self.watched.push_back(Watched {
            secs,
            name,
            output: from.output,
            value: value.clone(),
        });
    }

    /// Hands one message to one input; what does not fit is dropped and reported.
    pub(crate) fn deliver(&mut self, inlet: Inlet, value: &Value, outside: &mut impl Surroundings) {
        self.delivered += 1;
        match inlet {
            Inlet::Function { to, input } => self.deliver_to_function(to, input, value),
            Inlet::Sink { to, input } => self.deliver_to_sink(to, input, value, outside),
            Inlet::Node { to, input } => {
                if let Err(refusal) = outside.node(to, input, value) {
                    let (name, what) = outside.node_name(to);
                    let cause = match refusal {
                        Refusal::Kind(expected) => Cause::Kind {
                            input,
                            expected,
                            got: value.kind(),
                        },
                        Refusal::Domain(why) => Cause::Domain { why },
                    };
                    self.reports.note(&name, || format!("{what} node"), cause);
                }
            }
        }
    }

    fn deliver_to_function(&mut self, to: InstanceId, input: u8, value: &Value) {
        let full = self.behind >= self.limits.behind_max;
        let queue_max = self.limits.queue_max;
        let Some(instance) = self.slots.get_mut(to.0 as usize).and_then(Option::as_mut) else {
            return;
        };
        let Some(port) = instance.inputs.get_mut(usize::from(input).wrapping_sub(1)) else {
            return;
        };
        let at = Input::Number(input.into());
        if !port.kinds.has(value.kind()) {
            let cause = Cause::Kind {
                input: at,
                expected: port.kinds,
                got: value.kind(),
            };
            return self.report(to, cause);
        }
        let satisfied = port.satisfied();
        if port.constant {
            port.hold(value);
            instance.constant_set(input);
        } else if port.waiting() == 0 {
            port.push(value);
        } else if full {
            return self.report(to, Cause::NetworkFull);
        } else if port.waiting() >= queue_max {
            return self.report(to, Cause::QueueFull { input: at });
        } else {
            port.push(value);
            self.behind += 1;
        }
        if !satisfied {
            instance.satisfy_one();
            if instance.ready() && !instance.queued {
                instance.queued = true;
                self.ready.push_back(to);
            }
        }
    }

    fn deliver_to_sink(&mut self, to: SinkId, input: u8, value: &Value, outside: &mut impl Surroundings) {
        let Some(port) = self.sink_input_mut(to, input) else {
            return;
        };
        let (expected, fits) = (port.kinds, port.kinds.has(value.kind()));
        if fits {
            port.last = Some(value.clone());
            outside.sink_arrived(to, value);
        }
        let at = Input::Number(input.into());
        let cause = if !fits {
            Cause::Kind {
                input: at,
                expected,
                got: value.kind(),
            }
        } else if self.arrived.len() >= self.limits.undrained_max {
            Cause::QueueFull { input: at }
        } else {
            return self.arrived.push_back((to, input, value.clone()));
        };
        if let Some(sink) = self.sinks.get(to.0 as usize) {
            self.reports.note(&sink.name, || "host input".to_owned(), cause);
        }
    }

    fn run_errand(&mut self, from: InstanceId, errand: Errand, outside: &mut impl Surroundings) {
        match errand {
            Errand::Send { name, input, value } => match outside.inlet(&name, input) {
                Some(inlet) => self.deliver(inlet, &value, outside),
                None => self.report(
                    from,
                    Cause::Unknown {
                        name: name.to_string(),
                    },
                ),
            },
            Errand::Fetch { name, output } => {
                match outside.variable(&name).and_then(|id| self.held(id)).cloned() {
                    Some(value) => self.send_out(Outlet { from, output }, &value, outside),
                    None => self.report(
                        from,
                        Cause::Unknown {
                            name: name.to_string(),
                        },
                    ),
                }
            }
        }
    }

    pub(crate) fn report(&mut self, id: InstanceId, cause: Cause) {
        if let Some(instance) = self.slots.get(id.0 as usize).and_then(Option::as_ref) {
            self.reports.note(&instance.name, || instance.what(), cause);
        }
    }
}
