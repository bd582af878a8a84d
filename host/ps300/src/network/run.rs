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

use std::sync::Arc;

use glam::DVec2;

use super::batch::Allowance;
use super::connection::{Inlet, InstanceId, Outlet, SinkId};
use super::instance::Behaviour;
use super::{About, Cause, Network};
use crate::intrinsic::{Fault, Inputs, Now, Outputs, Sent};
use crate::language::{Input, Name};
use crate::pick::Pick;
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
    /// Hands a message to a display node. Gives the instance that sends for it, if the message makes it send.
    fn feed(&mut self, to: NodeId, input: Input, value: &Value) -> Result<Option<InstanceId>, Refusal>;
    /// The name of a display node, and what reports say of it.
    fn node(&self, to: NodeId) -> (Name, About);
    /// Sees a message that reached the host.
    fn sink_arrived(&mut self, sink: SinkId, value: &Value);
    /// Looks up an input by name, for F:SEND.
    fn inlet(&self, name: &str, input: Input) -> Option<Inlet>;
    /// What is drawn in a window of the screen, given by its middle and half its size.
    fn picks(&self, window: [DVec2; 2], detailed: bool) -> Arc<[Pick]>;
    /// What an XFORM node marks, or why there is nothing.
    fn transform(&self, name: &str, part: [usize; 2]) -> Result<Value, &'static str>;
    /// A device by name.
    fn device(&self, name: &str) -> Option<InstanceId>;
    /// Looks up a variable by name, for F:FETCH.
    fn variable(&self, name: &str) -> Option<InstanceId>;
}

impl Network {
    /// Fires ready instances, oldest readiness first, `firings_max` at most, and lets in the batches whose
    /// turn it is. The sequence of firings does not depend on `firings_max`.
    pub(crate) fn run(&mut self, firings_max: u32, outside: &mut impl Surroundings) -> Ran {
        let mut slice = Allowance::new(firings_max, self.delivered);
        loop {
            if !self.batch_over {
                self.fire_ready(&mut slice, outside);
                if let Some(next) = self.queues.ready.front() {
                    if !self.batch.is_used_up(self.delivered) {
                        break;
                    }
                    self.report(next, Cause::OutOfBudget);
                }
            }
            self.batch_over = true;
            if !self.admit(outside) {
                break;
            }
        }
        let firings = firings_max - slice.firings_left;
        if self.queues.ready.is_empty() {
            Ran::Quiet { firings }
        } else {
            Ran::OutOfBudget {
                firings,
                waiting: self.queues.ready.len() as u32,
            }
        }
    }

    /// Fires until nothing is ready, or what the slice or the batch allows is used up.
    fn fire_ready(&mut self, slice: &mut Allowance, outside: &mut impl Surroundings) {
        let allowed = slice.firings_left.min(self.batch.firings_left);
        let deliveries_end = slice.deliveries_end.min(self.batch.deliveries_end);
        let mut fired = 0;
        while fired < allowed
            && self.delivered <= deliveries_end
            && let Some(id) = self.queues.ready.pop()
        {
            fired += 1;
            self.fire(id, outside);
        }
        slice.firings_left -= fired;
        self.batch.firings_left -= fired;
    }

    /// Moves network time and lets the clocks send; nothing fires yet.
    pub(super) fn advance(&mut self, now: Now, outside: &mut impl Surroundings) {
        self.now = now;
        for index in 0..self.clocks.len() {
            let id = self.clocks[index];
            if let Err(Fault::Domain { why }) =
                self.act(id, |clock, inputs, outputs| clock.advance(now, inputs, outputs))
            {
                self.report(id, Cause::Domain { why });
            }
            self.send_all(id, outside);
        }
    }

    #[inline]
    fn fire(&mut self, id: InstanceId, outside: &mut impl Surroundings) {
        let Some(head) = self.queues.heads.get_mut(id.0 as usize) else {
            return;
        };
        head.queued = false;
        if let Some((at, result)) = self.queues.fire_scalar(id) {
            self.send_at(Outlet { from: id, output: 1 }, at as usize, result, outside);
        } else if self.queues.is_ready(id) {
            // If not, SETUP CNESS has come between becoming ready and firing.
            self.fire_any(id, outside);
        }
    }

    #[inline(never)]
    fn fire_any(&mut self, id: InstanceId, outside: &mut impl Surroundings) {
        match self.act(id, Behaviour::fire) {
            Ok(()) => self.queues.consume(id),
            Err(Fault::Domain { why }) => {
                let message = self.queues.first_waiting(id);
                self.report_message(id, Cause::Domain { why }, || message);
                self.queues.consume(id);
            }
            Err(Fault::Kind { input, expected }) => {
                let port = self.queues.ports(id).get(usize::from(input).wrapping_sub(1));
                if let Some(offending) = port.and_then(|port| port.front()).cloned() {
                    let input = Input::Number(input.into());
                    let cause = Cause::Kind {
                        input,
                        expected,
                        got: offending.kind(),
                    };
                    self.report_message(id, cause, || Some((Some(input), offending)));
                }
                self.queues.consume_offending(id, input);
            }
        }
        self.send_all(id, outside);
    }

    /// Lets an instance compute what it sends.
    fn act(
        &mut self,
        id: InstanceId,
        act: impl FnOnce(&mut Behaviour, &Inputs<'_>, &mut Outputs<'_>) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let Some(behaviour) = self.behaviours.get_mut(id.0 as usize) else {
            return Ok(());
        };
        let Some(head) = self.queues.head(id) else {
            return Ok(());
        };
        let (inputs, outputs) = (
            self.queues.inputs.get(head.inputs()),
            self.outputs.get_mut(head.outputs()),
        );
        let (ports, outputs) = (inputs.unwrap_or_default(), outputs.unwrap_or_default());
        let inputs = Inputs::new(ports, head.size);
        let mut outputs = Outputs::new(outputs, &mut self.sent, &mut self.errands);
        act(behaviour, &inputs, &mut outputs)
    }

    /// Sends the next of the messages that lie apart.
    #[cold]
    fn send_apart(&mut self, from: InstanceId, output: u8, outside: &mut impl Surroundings) {
        if !self.sent.apart.is_empty() {
            let value = self.sent.apart.remove(0);
            self.send_out(Outlet { from, output }, value, outside);
        }
    }

    /// Delivers what an instance has computed.
    fn send_all(&mut self, id: InstanceId, outside: &mut impl Surroundings) {
        let first = self.queues.head(id).map_or(0, |head| head.first_output as usize);
        let mut place = 0;
        while let Some(&output) = self.sent.outputs.get(place) {
            place += 1;
            if output & Sent::APART == 0 {
                self.send_last(first + usize::from(output) - 1, outside);
            } else {
                self.send_apart(id, output as u8, outside);
            }
        }
        self.sent.outputs.clear();
        if !self.errands.is_empty() {
            let mut errands = std::mem::take(&mut self.errands);
            for errand in errands.drain(..) {
                self.run_errand(id, errand, outside);
            }
            self.errands = errands;
        }
    }
}
