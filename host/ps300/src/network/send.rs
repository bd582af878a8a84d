//! What is sent: from an output to everything it feeds, each with its own copy.

use super::connection::{Inlet, InstanceId, Outlet, SinkId, input_text};
use super::queues::{Full, Hindrance, Queues};
use super::run::{Refusal, Surroundings};
use super::token::Token;
use super::{About, Cause, Network, Watched};
use crate::intrinsic::Errand;
use crate::language::Input;
use crate::structure::NodeId;
use crate::value::Value;

/// Why a message was not simply taken where it went.
enum Rest {
    Hindered(InstanceId, u8, Hindrance),
    Sink(SinkId, u8),
    Refused(NodeId, Input, Refusal),
    /// Not tried.
    Untried(Inlet),
}

/// Hands a message to what takes it at once, as nearly everything does.
#[inline]
fn pass(
    queues: &mut Queues,
    inlet: Inlet,
    value: &Value,
    outside: &mut impl Surroundings,
) -> Result<(), Rest> {
    let (to, input) = match inlet {
        Inlet::Function { to, input } => (to, input),
        Inlet::Node { to, input } => match outside.feed(to, input, value) {
            Ok(None) => return Ok(()),
            Ok(Some(sender)) => (sender, 1),
            Err(refusal) => return Err(Rest::Refused(to, input, refusal)),
        },
        Inlet::Sink { to, input } => return Err(Rest::Sink(to, input)),
    };
    queues
        .deliver(to, input, value)
        .map_err(|hindrance| Rest::Hindered(to, input, hindrance))
}

/// Does so in the order of CONNECT, from the inlet at `from` up to one that does not take it, whose place is said.
#[inline]
fn pass_all(
    queues: &mut Queues,
    inlets: &[Inlet],
    from: usize,
    value: &Value,
    outside: &mut impl Surroundings,
) -> Option<(usize, Rest)> {
    for (place, &inlet) in inlets.iter().enumerate().skip(from) {
        if let Err(rest) = pass(queues, inlet, value, outside) {
            return Some((place, rest));
        }
    }
    None
}

/// The same for a real number, which functions take nearly always.
#[inline]
fn pass_real(queues: &mut Queues, inlets: &[Inlet], x: f64) -> Option<(usize, Rest)> {
    for (place, &inlet) in inlets.iter().enumerate() {
        let Inlet::Function { to, input } = inlet else {
            return Some((place, Rest::Untried(inlet)));
        };
        if let Err(hindrance) = queues.deliver(to, input, &x) {
            return Some((place, Rest::Hindered(to, input, hindrance)));
        }
    }
    None
}

impl Network {
    /// Sends on an output: to every destination in the order of CONNECT.
    pub(crate) fn send_out(&mut self, from: Outlet, value: Value, outside: &mut impl Surroundings) {
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
        message: impl Token,
        outside: &mut impl Surroundings,
    ) {
        if !message.is_finite() {
            return self.report_message(from.from, Cause::NotFinite, || Some((None, message.into_value())));
        }
        let Some(output) = self.outputs.get_mut(at) else {
            return;
        };
        if output.is_plain() {
            message.put(&mut output.last);
        } else if !self.look_at(from, at, message) {
            return;
        }
        self.send_last(at, outside);
    }

    /// Sends what an output holds as its last message.
    #[inline]
    pub(super) fn send_last(&mut self, at: usize, outside: &mut impl Surroundings) {
        let Some(output) = self.outputs.get_mut(at) else {
            return;
        };
        output.has_left();
        output.sent += 1;
        if !output.is_alone() {
            self.send_to_all(at, outside);
        }
    }

    #[inline(never)]
    fn send_to_all(&mut self, at: usize, outside: &mut impl Surroundings) {
        let Some(output) = self.outputs.get(at) else {
            return;
        };
        let inlets = output.to();
        self.delivered += inlets.len() as u64;
        let rest = match &output.last {
            Some(Value::Real(x)) => pass_real(&mut self.queues, inlets, *x),
            Some(value) => pass_all(&mut self.queues, inlets, 0, value, outside),
            None => None,
        };
        if let Some((place, rest)) = rest {
            self.send_on(at, place, rest, outside);
        }
    }

    /// Sees to the inlet that did not simply take the last message, and goes on behind it.
    #[inline(never)]
    fn send_on(&mut self, at: usize, place: usize, rest: Rest, outside: &mut impl Surroundings) {
        let Some(value) = self.outputs.get(at).and_then(|output| output.last.clone()) else {
            return;
        };
        let mut next = Some((place, rest));
        while let Some((place, rest)) = next {
            self.see_to(rest, &value, outside);
            let Some(output) = self.outputs.get(at) else {
                return;
            };
            next = pass_all(&mut self.queues, output.to(), place + 1, &value, outside);
        }
    }

    /// Withholds or records; true if the message goes on, which then is the output's last.
    #[cold]
    fn look_at(&mut self, from: Outlet, at: usize, token: impl Token) -> bool {
        let Some(output) = self.outputs.get_mut(at) else {
            return false;
        };
        if output.is_frozen() {
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
        if let Some(output) = self.outputs.get_mut(at) {
            token.put(&mut output.last);
        }
        true
    }

    /// Hands one message to one input; what does not fit is dropped and reported.
    pub(crate) fn deliver(&mut self, inlet: Inlet, value: &Value, outside: &mut impl Surroundings) {
        self.delivered += 1;
        if let Err(rest) = pass(&mut self.queues, inlet, value, outside) {
            self.see_to(rest, value, outside);
        }
    }

    fn see_to(&mut self, rest: Rest, value: &Value, outside: &mut impl Surroundings) {
        let rest = match rest {
            Rest::Untried(inlet) => match pass(&mut self.queues, inlet, value, outside) {
                Ok(()) => return,
                Err(rest) => rest,
            },
            rest => rest,
        };
        match rest {
            Rest::Untried(_) => {}
            Rest::Hindered(to, input, hindrance) => self.deliver_hindered(to, input, hindrance, value),
            Rest::Sink(to, input) => self.deliver_to_sink(to, input, value, outside),
            Rest::Refused(to, input, refusal) => {
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
                    Some(value) => self.send_out(Outlet { from, output }, value, outside),
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
