//! What is sent: from an output to everything it feeds, each with its own copy.

use super::connection::{Inlet, InstanceId, Outlet, SinkId, input_text};
use super::queues::{Full, Hindrance};
use super::run::{Refusal, Surroundings};
use super::token::Token;
use super::{About, Cause, Network, Watched};
use crate::intrinsic::Errand;
use crate::language::Input;
use crate::value::Value;

impl Network {
    /// Sends on an output: to every destination in the order of CONNECT. The message may be another afterwards,
    /// of which only the memory is of use.
    pub(crate) fn send_out(&mut self, from: Outlet, value: &mut Value, outside: &mut impl Surroundings) {
        let Some(at) = self.output_at(from) else {
            return;
        };
        if let Value::Real(x) = value {
            self.send_at(from, at, x, outside);
        } else {
            self.send_at(from, at, value, outside);
        }
    }

    /// The same, knowing where the output lies.
    #[inline]
    pub(super) fn send_at(
        &mut self,
        from: Outlet,
        at: usize,
        token: &mut impl Token,
        outside: &mut impl Surroundings,
    ) {
        if !token.is_finite() {
            return self.report_message(from.from, Cause::NotFinite, || Some((None, token.value())));
        }
        let Some(output) = self.outputs.get_mut(at) else {
            return;
        };
        if (output.frozen || output.watched) && !self.look_at(from, at, token) {
            return;
        }
        let mut next = 0;
        while let Some((inlet, hindrance)) = self.deliver_some(at, &mut next, token) {
            token.lend(|value| self.deliver_otherwise(inlet, hindrance, value, outside));
        }
        if let Some(output) = self.outputs.get_mut(at) {
            self.delivered += output.to().len() as u64;
            output.sent += 1;
            token.leave(&mut output.last);
        }
    }

    /// Delivers to functions with empty queues, as nearly all are, up to the first inlet that is another.
    #[inline]
    fn deliver_some(
        &mut self,
        at: usize,
        next: &mut usize,
        token: &impl Token,
    ) -> Option<(Inlet, Option<Hindrance>)> {
        for &inlet in self.outputs.get(at)?.to().get(*next..)? {
            *next += 1;
            let Inlet::Function { to, input } = inlet else {
                return Some((inlet, None));
            };
            if let Err(hindrance) = self.queues.deliver(to, input, token) {
                return Some((inlet, Some(hindrance)));
            }
        }
        None
    }

    /// Withholds or records; true if the message goes on.
    #[cold]
    fn look_at(&mut self, from: Outlet, at: usize, token: &impl Token) -> bool {
        let Some(output) = self.outputs.get_mut(at) else {
            return false;
        };
        if output.frozen {
            output.withheld = output.withheld.saturating_add(1);
            return false;
        }
        if self.watched.len() >= self.limits.undrained_max {
            self.report(from.from, Cause::Unwatched);
        } else if let Some(Some(description)) = self.descriptions.get(from.from.0 as usize) {
            self.watched.push_back(Watched {
                secs: self.now.secs,
                name: description.name.clone(),
                output: from.output,
                value: token.value(),
            });
        }
        true
    }

    /// Hands one message to one input; what does not fit is dropped and reported.
    pub(crate) fn deliver(&mut self, inlet: Inlet, value: &Value, outside: &mut impl Surroundings) {
        self.delivered += 1;
        let hindrance = match inlet {
            Inlet::Function { to, input } => match self.queues.deliver(to, input, value) {
                Ok(()) => return,
                Err(hindrance) => Some(hindrance),
            },
            _ => None,
        };
        self.deliver_otherwise(inlet, hindrance, value, outside);
    }

    fn deliver_otherwise(
        &mut self,
        inlet: Inlet,
        hindrance: Option<Hindrance>,
        value: &Value,
        outside: &mut impl Surroundings,
    ) {
        match (inlet, hindrance) {
            (Inlet::Function { to, input }, Some(hindrance)) => {
                self.deliver_hindered(to, input, hindrance, value);
            }
            (Inlet::Function { .. }, None) => {}
            (Inlet::Sink { to, input }, _) => self.deliver_to_sink(to, input, value, outside),
            (Inlet::Node { to, input }, _) => {
                if let Err(refusal) = outside.feed(to, input, value) {
                    let (name, about) = outside.node(to);
                    let cause = match refusal {
                        Refusal::Kind(expected) => Cause::Kind {
                            input,
                            expected,
                            got: value.kind(),
                        },
                        Refusal::Domain(why) => Cause::Domain { why },
                    };
                    self.reports.note(&name, || about.message(input, value), cause);
                } else if let Some(sender) = outside.answers(to, input) {
                    self.deliver(Inlet::Function { to: sender, input: 1 }, value, outside);
                }
            }
        }
    }

    fn deliver_hindered(&mut self, to: InstanceId, input: u8, hindrance: Hindrance, value: &Value) {
        let at = Input::Number(input.into());
        let cause = match hindrance {
            Hindrance::Kind(expected) => Cause::Kind {
                input: at,
                expected,
                got: value.kind(),
            },
            Hindrance::Constant => {
                if let Some(behaviour) = self.behaviours.get_mut(to.0 as usize) {
                    behaviour.constant_set(input);
                }
                return self.queues.hold(to, input, value.clone());
            }
            Hindrance::Occupied => match self.queues.deliver_behind(to, input, value.clone()) {
                Ok(()) => return,
                Err(Full::Queue) => Cause::QueueFull { input: at },
                Err(Full::Network) => Cause::NetworkFull,
            },
        };
        self.report_message(to, cause, || Some((Some(at), value.clone())));
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
        self.report_sink(to, input, value, cause);
    }

    pub(super) fn report_sink(&mut self, to: SinkId, input: u8, value: &Value, cause: Cause) {
        if let Some(sink) = self.sinks.get(to.0 as usize) {
            let about = || About::new("host input").message(Input::Number(input.into()), value);
            self.reports.note(&sink.name, about, cause);
        }
    }

    /// Whether functions and sinks have as many inputs; nodes say themselves what they take.
    fn is_there(&self, inlet: Inlet) -> bool {
        match inlet {
            Inlet::Function { to, input } => self.accepts(to, input).is_some(),
            Inlet::Sink { to, input } => self
                .sink(to)
                .is_some_and(|sink| usize::from(input) <= sink.inputs.len()),
            Inlet::Node { .. } => true,
        }
    }

    pub(super) fn run_errand(&mut self, from: InstanceId, errand: Errand, outside: &mut impl Surroundings) {
        match errand {
            Errand::Look(look) => self.look(from, look, outside),
            Errand::Send { name, input, value } => match outside.inlet(&name, input) {
                Some(inlet) if self.is_there(inlet) => self.deliver(inlet, &value, outside),
                found => {
                    let name = if found.is_some() {
                        format!("input {} of {name}", input_text(input))
                    } else {
                        name.to_string()
                    };
                    self.report_message(from, Cause::Unknown { name }, || Some((None, value)));
                }
            },
            Errand::Fetch { name, output } => {
                match outside.variable(&name).and_then(|id| self.held(id)).cloned() {
                    Some(mut value) => self.send_out(Outlet { from, output }, &mut value, outside),
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
}
