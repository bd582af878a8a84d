//! Commands about messages: CONNECT, DISCONNECT, SEND, SETUP CNESS.

use super::execute::Done;
use super::{ExecuteError, Machine, numbered_inputs};
use crate::language::{Disconnection, Input, InputOf, Name, OutputOf};
use crate::names::Thing;
use crate::network::{Cause, ConnectError, Inlet, Instance, Outlet, Role, input_text};
use crate::value::{Kinds, Value};

impl Machine {
    fn outlet_of(&self, from: &OutputOf) -> Result<Outlet, ExecuteError> {
        let thing = self.thing(&from.name)?;
        let Some(id) = self.sender(thing) else {
            return Err(ExecuteError::NotA {
                name: from.name.clone(),
                is: self.what_is(thing),
                wanted: "something that sends",
            });
        };
        self.network.outlet(id, from.output).ok_or_else(|| {
            let has = self.network.instance(id).map_or(0, Instance::output_count);
            ConnectError::NoOutput {
                name: from.name.clone(),
                output: from.output,
                has,
            }
            .into()
        })
    }

    /// Where messages to an input go, and what it takes.
    fn inlet_of(&self, name: &Name, input: Input) -> Result<(Inlet, Kinds), ExecuteError> {
        let thing = self.thing(name)?;
        let numbered = match input {
            Input::Number(number) => u8::try_from(number).ok(),
            _ => None,
        };
        let (found, has) = match thing {
            Thing::Instance(to) => {
                let kinds = numbered.and_then(|input| self.network.accepts(to, input));
                let inlet = numbered.map(|input| Inlet::Function { to, input });
                let count = self.network.instance(to).map_or(0, Instance::input_count);
                (inlet.zip(kinds), numbered_inputs(count))
            }
            Thing::Sink(to) => {
                let sink = self.network.sink(to);
                let port = numbered.and_then(|n| sink?.inputs.get(usize::from(n).checked_sub(1)?));
                let inlet = numbered.map(|input| Inlet::Sink { to, input });
                let count = sink.map_or(0, |sink| sink.inputs.len());
                (inlet.zip(port.map(|port| port.kinds)), numbered_inputs(count))
            }
            Thing::Node(to) => {
                let kinds = self.structure.accepts(to, input);
                (
                    kinds.map(|kinds| (Inlet::Node { to, input }, kinds)),
                    self.structure.inputs_text(to),
                )
            }
        };
        found.ok_or_else(|| {
            ConnectError::NoInput {
                name: name.clone(),
                input: input_text(input),
                has,
            }
            .into()
        })
    }

    pub(super) fn connect(&mut self, from: &OutputOf, to: &InputOf) -> Done {
        self.make_sender(&from.name)?;
        let outlet = self.outlet_of(from)?;
        let (inlet, accepted) = self.inlet_of(&to.name, to.input)?;
        if !self.network.connect(outlet, inlet, accepted)? {
            let other = format!("{}{}", input_text(to.input), to.name);
            self.note(
                &from.name,
                &format!("output <{}>", from.output),
                Cause::AlreadyConnected { to: other },
            );
        }
        Ok(())
    }

    pub(super) fn disconnect(&mut self, what: &Disconnection) -> Done {
        match what {
            Disconnection::Pair { from, to } => {
                let outlet = self.outlet_of(from)?;
                let (inlet, _) = self.inlet_of(&to.name, to.input)?;
                if !self.network.disconnect(outlet, inlet)? {
                    let what = format!(
                        "{}<{}> is not connected to {}{}",
                        from.name,
                        from.output,
                        input_text(to.input),
                        to.name
                    );
                    return Err(ExecuteError::Nothing { what });
                }
            }
            Disconnection::Output(from) => {
                let outlet = self.outlet_of(from)?;
                self.network.disconnect_output(outlet)?;
            }
            Disconnection::All(name) => match self.thing(name)? {
                Thing::Instance(id) => self.network.disconnect_all(id),
                other => {
                    let is = self.what_is(other);
                    let wanted = "something that sends";
                    return Err(ExecuteError::NotA {
                        name: name.clone(),
                        is,
                        wanted,
                    });
                }
            },
        }
        Ok(())
    }

    pub(super) fn variable(&self, name: &Name) -> Result<Value, ExecuteError> {
        match self.thing(name)? {
            Thing::Instance(id)
                if self
                    .network
                    .instance(id)
                    .is_some_and(|it| it.role == Role::Variable) =>
            {
                let held = self.network.held(id).cloned();
                held.ok_or_else(|| ExecuteError::Empty { name: name.clone() })
            }
            other => {
                let is = self.what_is(other);
                Err(ExecuteError::NotA {
                    name: name.clone(),
                    is,
                    wanted: "a variable",
                })
            }
        }
    }

    pub(super) fn deliver(&mut self, name: &Name, input: Input, value: &Value) -> Done {
        let inlet = self.inlet_for(name, input, value)?;
        super::with_network!(self, |network, around| network.deliver(inlet, value, around));
        Ok(())
    }

    /// Where a message to an input goes, if it is one that the input takes.
    pub(super) fn inlet_for(&self, name: &Name, input: Input, value: &Value) -> Result<Inlet, ExecuteError> {
        let (inlet, expected) = self.inlet_of(name, input)?;
        let (name, input) = (|| name.clone(), || input_text(input));
        if !expected.has(value.kind()) {
            return Err(ExecuteError::Kind {
                name: name(),
                input: input(),
                expected,
                got: value.kind(),
            });
        }
        if !value.is_finite() {
            return Err(ExecuteError::NotFinite {
                name: name(),
                input: input(),
            });
        }
        Ok(inlet)
    }

    pub(super) fn setup_cness(&mut self, constant: bool, input: &InputOf) -> Done {
        let refused = |is| {
            Err(ExecuteError::NotA {
                name: input.name.clone(),
                is,
                wanted: "a function instance",
            })
        };
        let Inlet::Function { to, input: number } = self.inlet_of(&input.name, input.input)?.0 else {
            return refused(self.what_is(self.thing(&input.name)?));
        };
        if self
            .network
            .instance(to)
            .is_some_and(|instance| instance.role == Role::Variable)
        {
            return refused("a variable");
        }
        self.network.set_constant(to, number, constant);
        Ok(())
    }
}
