//! Batches: what the host sent between two ticks, let in one after the other.
//!
//! A batch is let in when the firings of the one before are over, and not earlier: so the sequence of firings
//! depends on the messages alone, and not on how many firings the host allows in a tick. A batch is also over when
//! its share of firings is used up, so that a cycle without end goes on for ever and keeps nobody waiting.
//! Source: `docs/protocols/ps300.md`, "What dialrig decides".

use std::collections::{BTreeSet, VecDeque};

use super::connection::{Inlet, InstanceId, Outlet};
use super::report::{About, Cause};
use super::run::Surroundings;
use super::{Network, Ran};
use crate::intrinsic::Now;
use crate::language::{Input, Name};
use crate::structure::NodeId;
use crate::value::Value;

/// Firings are what hosts count, deliveries are what costs time: more of them than this for each firing allowed
/// end a run or batch early.
const DELIVERIES_PER_FIRING: u64 = 64;

/// How much may still happen.
#[derive(Clone, Copy, Default)]
pub(super) struct Allowance {
    pub(super) firings_left: u32,
    /// The count of deliveries after which it ends.
    pub(super) deliveries_end: u64,
}

impl Allowance {
    pub(super) fn new(firings: u32, delivered: u64) -> Self {
        Self {
            firings_left: firings,
            deliveries_end: delivered + DELIVERIES_PER_FIRING * u64::from(firings),
        }
    }

    pub(super) fn is_used_up(&self, delivered: u64) -> bool {
        self.firings_left == 0 || delivered > self.deliveries_end
    }
}

/// Where a message of the host goes.
#[derive(Clone, Copy)]
pub(crate) enum Arrival {
    /// To all that an output feeds.
    Output(Outlet),
    /// To one input.
    Input(Inlet),
    /// To what was removed meanwhile.
    Nowhere,
}

struct Batch {
    /// How many messages.
    count: usize,
    /// Network time once they are delivered; nothing: as before.
    now: Option<Now>,
}

/// What the host sent and the network has not yet taken.
#[derive(Default)]
pub(super) struct Arrivals {
    /// Those of the closed batches, then those of the open one.
    messages: VecDeque<(Arrival, Value)>,
    closed: VecDeque<Batch>,
    /// Messages of the open batch that wait.
    open: usize,
    /// Whether the open batch has any message, waiting or delivered at once.
    begun: bool,
}

impl Network {
    /// Takes a message of the host: at once if nothing is in its way, otherwise in its turn.
    pub(crate) fn arrive(&mut self, to: Arrival, value: Value, outside: &mut impl Surroundings) {
        self.arrivals.begun = true;
        if self.batch_over && self.arrivals.closed.is_empty() && self.arrivals.open == 0 {
            self.take_in(to, value, outside);
        } else if self.arrivals.messages.len() < self.limits.arrivals_max {
            self.arrivals.messages.push_back((to, value));
            self.arrivals.open += 1;
        } else {
            self.report_backlog(to, value, outside);
        }
    }

    fn report_backlog(&mut self, to: Arrival, value: Value, outside: &mut impl Surroundings) {
        let cause = Cause::BacklogFull;
        match to {
            Arrival::Output(Outlet { from: id, .. }) => {
                self.report_message(id, cause, || Some((None, value)));
            }
            Arrival::Input(Inlet::Function { to: id, input }) => {
                let input = Input::Number(input.into());
                self.report_message(id, cause, || Some((Some(input), value)));
            }
            Arrival::Input(Inlet::Sink { to, input }) => self.report_sink(to, input, &value, cause),
            Arrival::Input(Inlet::Node { to, input }) => {
                let (name, about) = outside.node(to);
                self.reports.note(&name, || about.message(input, &value), cause);
            }
            Arrival::Nowhere => {}
        }
    }

    fn take_in(&mut self, to: Arrival, value: Value, outside: &mut impl Surroundings) {
        match to {
            Arrival::Output(from) => self.send_out(from, value, outside),
            Arrival::Input(inlet) => self.deliver(inlet, &value, outside),
            Arrival::Nowhere => {}
        }
    }

    /// Lets nothing arrive any more at what is removed.
    pub(super) fn turn_away(&mut self, instances: &BTreeSet<InstanceId>, nodes: &BTreeSet<NodeId>) {
        for (to, _) in &mut self.arrivals.messages {
            let gone = match to {
                Arrival::Output(Outlet { from: id, .. }) | Arrival::Input(Inlet::Function { to: id, .. }) => {
                    instances.contains(id)
                }
                Arrival::Input(Inlet::Node { to, .. }) => nodes.contains(to),
                Arrival::Input(Inlet::Sink { .. }) | Arrival::Nowhere => false,
            };
            if gone {
                *to = Arrival::Nowhere;
            }
        }
    }

    /// Ends the open batch: at its turn its messages are delivered, then network time moves to `now`.
    pub(crate) fn close_batch(&mut self, now: Option<Now>) {
        let arrivals = &mut self.arrivals;
        if now.is_none() && !arrivals.begun {
            return;
        }
        if arrivals.closed.len() >= self.limits.batches_max {
            let name = Name::new("network");
            return self.reports.note(&name, || About::new("network"), Cause::Behind);
        }
        let count = std::mem::take(&mut arrivals.open);
        arrivals.begun = false;
        arrivals.closed.push_back(Batch { count, now });
    }

    /// Runs until every message that came before is over; bounded, since the batches that wait are.
    pub(crate) fn catch_up(&mut self, outside: &mut impl Surroundings) -> Ran {
        let mut ran = self.run(u32::MAX, outside);
        if self.arrivals.begun {
            self.close_batch(None);
            ran = self.run(u32::MAX, outside);
        }
        ran
    }

    /// Lets what a command did run, without the host's messages, `firings` at most. Returns how many there were.
    pub(crate) fn run_command(&mut self, firings: u32, outside: &mut impl Surroundings) -> u32 {
        self.batch = Allowance::new(firings, self.delivered);
        self.batch_over = false;
        self.run(u32::MAX, outside);
        firings - self.batch.firings_left
    }

    /// Lets the next batch in; false if there is none.
    pub(super) fn admit(&mut self, outside: &mut impl Surroundings) -> bool {
        let Some(Batch { count, now }) = self.arrivals.closed.pop_front() else {
            return false;
        };
        for _ in 0..count {
            if let Some((to, value)) = self.arrivals.messages.pop_front() {
                self.take_in(to, value, outside);
            }
        }
        if let Some(now) = now {
            self.advance(now, outside);
        }
        self.batch = Allowance::new(self.limits.firings_per_batch, self.delivered);
        self.batch_over = false;
        true
    }
}
